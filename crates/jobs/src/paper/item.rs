//! A table or figure of the paper, reproduced: the paper's statements, our results, and a verdict on each statement.

use retune_report::Drawing;
use retune_report::table::{Cell, line};
use serde::{Deserialize, Serialize};

/// The verdict on a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It holds under our settings.
    Holds,
    /// It holds in part, or in a sense that the paper does not state.
    Partly,
    /// It does not hold under our settings.
    Fails,
    /// Practically equal designs decide it differently.
    Undecided,
}

impl Verdict {
    /// The verdict in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Partly => "holds in part",
            Self::Fails => "does not hold",
            Self::Undecided => "cannot be decided",
        }
    }

    /// Holds or fails.
    pub const fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Fails }
    }

    /// Holds if all of `parts` do, fails if none does, else holds in part.
    pub fn of_all(parts: &[bool]) -> Self {
        match parts.iter().filter(|&&holds| holds).count() {
            0 => Self::Fails,
            count if count == parts.len() => Self::Holds,
            _ => Self::Partly,
        }
    }
}

/// A statement of the paper and our result.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Statement {
    /// The paper's words, or nearly.
    pub paper: String,
    /// The criterion for the verdict and its reason: where the paper is only verbal, this says what is measured.
    pub rule: String,
    /// Whether it is our conjecture about what the paper leaves open, not a statement of the paper: it does not count among these.
    #[serde(default)]
    pub conjecture: bool,
    /// The verdict.
    pub verdict: Verdict,
    /// The numbers behind the verdict.
    pub found: String,
}

/// A table for readers.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Grid {
    /// Its caption.
    pub caption: String,
    /// Names and units of its columns.
    pub head: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
}

impl Grid {
    /// An empty table.
    pub fn new(caption: &str, head: &[&str]) -> Self {
        Self {
            caption: caption.to_owned(),
            head: head.iter().map(|&name| name.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// The table as CSV.
    pub fn csv(&self) -> String {
        let texts = |cells: &Vec<String>| cells.iter().cloned().map(Cell::from).collect::<Vec<Cell>>();
        std::iter::once(&self.head).chain(&self.rows).map(|cells| line(&texts(cells))).collect()
    }
}

/// A picture with its caption.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Picture {
    /// File name without its ending.
    pub name: String,
    /// As SVG.
    pub drawing: Drawing,
    /// The contents of the picture, and how it was made.
    pub caption: String,
}

/// A table or figure of the paper, reproduced.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Item {
    /// `table1`, `figure4`.
    pub name: String,
    /// "Table 1. ..."
    pub title: String,
    /// The content of the paper's table or figure.
    pub paper: String,
    /// The settings of our results.
    pub made_by: String,
    /// Ours.
    pub pictures: Vec<Picture>,
    /// Ours.
    pub grids: Vec<Grid>,
    /// The paper's statements, one by one.
    pub statements: Vec<Statement>,
    /// Further remarks.
    pub notes: Vec<String>,
    /// Data files: name and content.
    pub data: Vec<(String, String)>,
}

impl Item {
    /// An item without content.
    pub fn new(name: &str, title: &str, paper: &str, made_by: String) -> Self {
        let [name, title, paper] = [name, title, paper].map(str::to_owned);
        Self {
            name,
            title,
            paper,
            made_by,
            pictures: Vec::new(),
            grids: Vec::new(),
            statements: Vec::new(),
            notes: Vec::new(),
            data: Vec::new(),
        }
    }

    /// Its tables and its data: the name and the text of each file.
    pub fn files(&self) -> Vec<(String, String)> {
        let table = |(i, grid): (usize, &Grid)| (format!("{}-table-{}.csv", self.name, i + 1), grid.csv());
        self.grids.iter().enumerate().map(table).chain(self.data.iter().cloned()).collect()
    }

    /// Adds a picture.
    pub fn picture(&mut self, name: &str, drawing: impl Into<Drawing>, caption: &str) {
        let [name, caption] = [name, caption].map(str::to_owned);
        self.pictures.push(Picture { name, drawing: drawing.into(), caption });
    }

    /// Adds a statement.
    pub fn statement(&mut self, paper: &str, rule: &str, verdict: Verdict, found: String) {
        let [paper, rule] = [paper, rule].map(str::to_owned);
        self.statements.push(Statement { paper, rule, conjecture: false, verdict, found });
    }

    /// Adds a conjecture of ours.
    pub fn conjecture(&mut self, ours: &str, rule: &str, verdict: Verdict, found: String) {
        self.statement(ours, rule, verdict, found);
        if let Some(last) = self.statements.last_mut() {
            last.conjecture = true;
        }
    }
}

/// Rows of numbers as CSV under `header`.
pub fn numbers(header: &str, rows: impl IntoIterator<Item = Vec<f64>>) -> String {
    let mut text = format!("{header}\n");
    for row in rows {
        text += &row.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        text.push('\n');
    }
    text
}
