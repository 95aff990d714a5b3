//! A table or figure of the paper, made again: what the paper says, what was found, and a verdict on each statement.

use serde::Serialize;

/// What becomes of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It holds under our settings.
    Holds,
    /// It holds in part, or in a sense that the paper does not state.
    Partly,
    /// It does not hold under our settings.
    Fails,
}

impl Verdict {
    /// The verdict in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Partly => "holds in part",
            Self::Fails => "does not hold",
        }
    }

    /// Holds or fails.
    pub const fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Fails }
    }
}

/// A statement of the paper beside what was found.
#[derive(Clone, Debug, Serialize)]
pub struct Statement {
    /// The paper's words, or nearly.
    pub paper: String,
    /// What becomes of it.
    pub verdict: Verdict,
    /// The numbers it rests on.
    pub found: String,
}

/// A table to be read.
#[derive(Clone, Debug)]
pub struct Grid {
    /// What it shows.
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
        let quoted = |text: &String| {
            if text.contains([',', '"']) {
                format!("\"{}\"", text.replace('"', "\"\""))
            } else {
                text.clone()
            }
        };
        let line = |cells: &Vec<String>| cells.iter().map(quoted).collect::<Vec<_>>().join(",") + "\n";
        std::iter::once(&self.head).chain(&self.rows).map(line).collect()
    }
}

/// A picture with its words.
#[derive(Clone, Debug)]
pub struct Picture {
    /// File name without its ending.
    pub name: String,
    /// The SVG.
    pub svg: String,
    /// What there is to see, and how it was made.
    pub caption: String,
}

/// A table or figure of the paper, made again.
#[derive(Clone, Debug)]
pub struct Item {
    /// `table1`, `figure4`.
    pub name: String,
    /// "Table 1. ..."
    pub title: String,
    /// What the paper shows here.
    pub paper: String,
    /// The settings that made ours.
    pub made_by: String,
    /// Ours.
    pub pictures: Vec<Picture>,
    /// Ours.
    pub grids: Vec<Grid>,
    /// The paper's statements, one by one.
    pub statements: Vec<Statement>,
    /// What a reader should know besides.
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

    /// Adds a picture.
    pub fn picture(&mut self, name: &str, svg: String, caption: &str) {
        self.pictures.push(Picture { name: name.to_owned(), svg, caption: caption.to_owned() });
    }

    /// Adds a statement.
    pub fn statement(&mut self, paper: &str, verdict: Verdict, found: String) {
        self.statements.push(Statement { paper: paper.to_owned(), verdict, found });
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
