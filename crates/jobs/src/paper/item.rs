//! A table or figure of the paper, reproduced: our results, and the paper's statements with a verdict on each.

use retune_report::document::{Figure, Statement, Verdict};
use retune_report::table::Table;
use retune_report::{Sheet, drawing};
use serde::{Deserialize, Serialize};

/// A table or figure of the paper, reproduced.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Item {
    /// The settings of our results.
    pub made_by: String,
    pub pictures: Vec<Figure>,
    /// Tables for readers, each with its caption.
    pub tables: Vec<(String, Table)>,
    pub statements: Vec<Statement>,
    pub notes: Vec<String>,
    /// Data: the name of each file and its table.
    pub data: Vec<(String, Table)>,
}

impl Item {
    pub fn new(made_by: String) -> Self {
        Self { made_by, ..Self::default() }
    }

    /// The files of its tables and data: name and text of each.
    pub fn files(&self, item: &str) -> Vec<(String, String)> {
        let table =
            |(i, (_, table)): (usize, &(_, Table))| (format!("{item}-table-{}.csv", i + 1), table.csv());
        let data = self.data.iter().map(|(name, table)| (name.clone(), table.csv()));
        self.tables.iter().enumerate().map(table).chain(data).collect()
    }

    /// Adds a figure, whose file is `name.svg`.
    pub fn picture(&mut self, name: &str, sheet: &Sheet, caption: &str) {
        let [file, caption] = [format!("{name}.svg"), caption.to_owned()];
        self.pictures.push(Figure { file, drawing: drawing(sheet), caption });
    }

    pub fn table(&mut self, caption: &str, table: Table) {
        self.tables.push((caption.to_owned(), table));
    }

    /// Adds data, whose file is `name.csv`.
    pub fn data(&mut self, name: &str, table: Table) {
        self.data.push((format!("{name}.csv"), table));
    }

    pub fn statement(&mut self, paper: &str, rule: &str, verdict: Verdict, found: String) {
        let [paper, rule] = [paper, rule].map(str::to_owned);
        self.statements.push(Statement { paper, rule, conjecture: false, verdict, found });
    }

    /// Adds a conjecture of ours.
    pub fn conjecture(&mut self, ours: &str, rule: &str, verdict: Verdict, found: String) {
        self.statement(ours, rule, verdict, found);
        self.statements.iter_mut().rev().take(1).for_each(|last| last.conjecture = true);
    }
}
