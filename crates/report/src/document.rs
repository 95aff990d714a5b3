//! A page of results as data: written once as Markdown, for readers of the repository, and once as HTML, which needs no network.

use crate::html::{Table, figure, head, link, with_code};
use crate::table::Column;
use crate::{Drawing, table};
use maud::{DOCTYPE, Markup, html};
use serde::{Deserialize, Serialize};

/// The verdict on a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It holds.
    Holds,
    /// It holds in part, or in a sense that it does not state.
    Partly,
    /// It does not hold.
    Fails,
    /// Practically equal cases disagree.
    Undecided,
}

impl Verdict {
    /// All, the best first.
    pub const ALL: [Self; 4] = [Self::Holds, Self::Partly, Self::Fails, Self::Undecided];

    /// The verdict in words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Partly => "holds in part",
            Self::Fails => "does not hold",
            Self::Undecided => "cannot be decided",
        }
    }

    /// Its colour on pages, by the name of its style.
    const fn style(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Partly => "partly",
            Self::Fails => "fails",
            Self::Undecided => "undecided",
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

/// A statement with a verdict.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Statement {
    /// Its words, from a paper, verbatim or nearly so.
    pub paper: String,
    /// The criterion for the verdict and its reason: where the words give no number, this says what is measured.
    pub rule: String,
    /// Whether it is our own conjecture on an open question, not a statement of the paper.
    #[serde(default)]
    pub conjecture: bool,
    /// The verdict.
    pub verdict: Verdict,
    /// The numbers behind the verdict.
    pub found: String,
}

/// A figure with its caption, which is also written to a file of its own.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Figure {
    /// The name of its file.
    pub file: String,
    /// What is drawn.
    pub drawing: Drawing,
    /// What it shows, and how it was made.
    pub caption: String,
}

/// A piece of a page.
#[derive(Debug)]
pub enum Block {
    /// A paragraph.
    Words(String),
    /// A paragraph that begins with its subject.
    About(&'static str, String),
    /// How the contents of a section were made.
    MadeBy(String),
    /// Statements with their verdicts.
    Statements(Vec<Statement>),
    /// A list with bullets.
    List(Vec<String>),
    /// A table: its caption, its head, its rows.
    Table(String, Vec<String>, Vec<Vec<String>>),
    /// A figure, which is a file of the page.
    Figure(Figure),
    /// A figure with a link to its file, which is written elsewhere.
    Linked(Figure),
    /// Links to files beside the page.
    Files(Vec<String>),
    /// HTML elements; Markdown omits them.
    Elements(Markup),
    /// A collapsed section: its subject and its blocks, none of them a [`Self::Figure`].
    Folded(String, Vec<Block>),
}

/// A page.
#[derive(Debug)]
pub struct Document {
    /// Its title.
    pub title: String,
    /// The command that made it.
    pub command: &'static str,
    /// The blocks before the first section.
    pub opening: Vec<Block>,
    /// The sections, in their order.
    pub sections: Vec<Section>,
}

/// A section: link target, heading, contents.
pub type Section = (&'static str, &'static str, Vec<Block>);

impl Document {
    /// The names and texts of its files: both forms and all figures.
    pub fn files(&self) -> Vec<(&str, String)> {
        let blocks = self.opening.iter().chain(self.sections.iter().flat_map(|(.., blocks)| blocks));
        let pages = [("README.md", self.markdown()), ("report.html", self.html())];
        blocks.filter_map(Block::file).chain(pages).collect()
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let mut text = format!("# {}\n\n", self.title);
        text += &self.opening.iter().map(Block::markdown).collect::<String>();
        for (_, title, blocks) in &self.sections {
            text += &format!("## {title}\n\n{}", blocks.iter().map(Block::markdown).collect::<String>());
        }
        text.trim_end().to_owned() + "\n"
    }

    /// As HTML.
    pub fn html(&self) -> String {
        let page: Markup = html! {
            (DOCTYPE)
            html lang="en" {
                (head(&self.title))
                body {
                    header {
                        h1 { (self.title) }
                        @for block in &self.opening { (block.html()) }
                        nav aria-label="Sections" { ul {
                            @for (id, title, _) in &self.sections { li { a href={ "#" (id) } { (title) } } }
                        } }
                    }
                    main.text { @for (id, title, blocks) in &self.sections {
                        section id=(id) aria-labelledby={ (id) "-title" } {
                            h2 id={ (id) "-title" } { (title) }
                            @for block in blocks { (block.html()) }
                        }
                    } }
                    footer { p { "Made by " code { (self.command) } ", Retune " (env!("CARGO_PKG_VERSION")) "." } }
                }
            }
        };
        page.into_string()
    }
}

impl Statement {
    fn html(&self) -> Markup {
        html! {
            li class=(self.verdict.style()) {
                span.says {
                    @if self.conjecture { b { "Our conjecture: " } }
                    (self.paper) small.rule { (self.rule) }
                }
                span.verdict { (self.verdict.words()) }
                span.found { (self.found) }
            }
        }
    }
}

impl Block {
    /// A paragraph.
    pub fn words(words: impl Into<String>) -> Self {
        Self::Words(words.into())
    }

    /// A table: its caption, its head, its rows.
    pub fn table<T: Into<String>>(
        caption: impl Into<String>,
        head: impl IntoIterator<Item = T>,
        rows: Vec<Vec<String>>,
    ) -> Self {
        Self::Table(caption.into(), head.into_iter().map(Into::into).collect(), rows)
    }

    /// A figure: its file, the drawing, its caption.
    pub fn figure(file: &str, drawing: impl Into<Drawing>, caption: impl Into<String>) -> Self {
        Self::Figure(Figure { file: file.to_owned(), drawing: drawing.into(), caption: caption.into() })
    }

    /// Links to files beside the page.
    pub fn files(files: &[&str]) -> Self {
        Self::Files(files.iter().map(|file| (*file).to_owned()).collect())
    }

    /// A table as a block.
    pub fn of_table(caption: impl Into<String>, table: &table::Table) -> Self {
        let texts = |row: &Vec<table::Cell>| row.iter().map(ToString::to_string).collect();
        Self::table(
            caption,
            table.columns.iter().map(Column::heading),
            table.rows.iter().map(texts).collect(),
        )
    }

    fn file(&self) -> Option<(&str, String)> {
        match self {
            Self::Figure(Figure { file, drawing, .. }) => Some((file, drawing.wide.clone())),
            _ => None,
        }
    }

    fn markdown(&self) -> String {
        match self {
            Self::Words(words) => format!("{words}\n\n"),
            Self::About(subject, words) => format!("**{subject}:** {words}\n\n"),
            Self::MadeBy(words) => format!("Made by: {words}\n\n"),
            Self::Statements(all) => {
                let item = |one: &Statement| {
                    let ours = if one.conjecture { "our conjecture: " } else { "" };
                    format!(
                        "- {ours}{} **{}** ({}) {}\n",
                        one.paper,
                        one.verdict.words(),
                        one.found,
                        one.rule
                    )
                };
                all.iter().map(item).collect::<String>() + "\n"
            }
            Self::List(all) => all.iter().map(|words| format!("- {words}\n")).collect::<String>() + "\n",
            Self::Table(caption, head, rows) => {
                let rule = vec!["---"; head.len()].join(" | ");
                let rows: String = rows.iter().map(|row| format!("| {} |\n", row.join(" | "))).collect();
                format!("{caption}\n\n| {} |\n| {rule} |\n{rows}\n", head.join(" | "))
            }
            Self::Figure(Figure { file, caption, .. }) | Self::Linked(Figure { file, caption, .. }) => {
                format!("![{caption}]({file})\n\n")
            }
            Self::Files(files) => {
                let links: Vec<String> = files.iter().map(|file| format!("[{file}]({file})")).collect();
                format!("{}\n\n", links.join(", "))
            }
            Self::Elements(_) => String::new(),
            Self::Folded(subject, inner) => {
                format!("**{subject}**\n\n{}", inner.iter().map(Self::markdown).collect::<String>())
            }
        }
    }

    fn html(&self) -> Markup {
        match self {
            Self::Words(words) => html! { p { (with_code(words)) } },
            Self::About(subject, words) => html! { p { b { (subject) ": " } (words) } },
            Self::MadeBy(words) => html! { p.made-by { b { "Made by: " } (words) } },
            Self::Statements(all) => html! { ul.statements { @for one in all { (one.html()) } } },
            Self::List(all) => html! { ul { @for words in all { li { (with_code(words)) } } } },
            Self::Table(caption, head, rows) => {
                let mut table = Table { head: head.clone(), ..Table::new(caption.as_str(), "") };
                rows.iter().for_each(|row| table.row(row));
                table.markup()
            }
            Self::Figure(Figure { drawing, caption, .. }) => figure(drawing, html! { (caption) }),
            Self::Linked(Figure { file, drawing, caption }) => {
                figure(drawing, html! { (caption) " " (link(file)) })
            }
            Self::Files(files) => {
                html! { p.files { b { "Files: " } @for file in files { (link(file)) " " } } }
            }
            Self::Elements(markup) => markup.clone(),
            Self::Folded(subject, inner) => {
                html! { details { summary { (subject) } @for block in inner { (block.html()) } } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_both_forms_say_the_same() {
        let rows = vec![vec!["TMD".to_owned(), "660.4".to_owned()]];
        let document = Document {
            title: "T < U".to_owned(),
            command: "retune retention",
            opening: vec![Block::words("First.")],
            sections: vec![(
                "one",
                "One",
                vec![
                    Block::List(vec!["a".to_owned()]),
                    Block::table("Designs", ["damper", "E1max, J"], rows),
                    Block::figure("a.svg", "<svg/>".to_owned(), "Fig"),
                    Block::Folded("More".to_owned(), vec![Block::files(&["a.csv"])]),
                ],
            )],
        };
        let table = "Designs\n\n| damper | E1max, J |\n| --- | --- |\n| TMD | 660.4 |\n\n";
        let markdown = format!(
            "# T < U\n\nFirst.\n\n## One\n\n- a\n\n{table}![Fig](a.svg)\n\n**More**\n\n[a.csv](a.csv)\n"
        );
        assert_eq!(document.markdown(), markdown);
        let names: Vec<&str> = document.files().iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["a.svg", "README.md", "report.html"]);
        let page = document.html();
        for part in [
            "T &lt; U",
            "<p>First.</p>",
            "<li>a</li>",
            "<caption>Designs</caption>",
            "660.4",
            "<details><summary>More</summary>",
            "href=\"a.csv\"",
        ] {
            assert!(page.contains(part), "{part}: {page}");
        }
    }

    #[test]
    fn contract_statements_tables_and_figures_in_both_forms() {
        let statement = Statement {
            paper: "It holds".to_owned(),
            rule: "Holds if so.".to_owned(),
            conjecture: true,
            verdict: Verdict::of_all(&[true, false]),
            found: "1 of 2".to_owned(),
        };
        let mut table = table::Table::new([Column::new("k1", "N/m"), Column::new("motion", "")]);
        table.push(crate::cells![2.5, "a, b"]);
        let drawing = Drawing::from("<svg></svg>".to_owned());
        let picture = Figure { file: "a.svg".to_owned(), drawing, caption: "A figure.".to_owned() };
        let document = Document {
            title: "T".to_owned(),
            command: "retune reproduce",
            opening: vec![Block::About("Finest", "of many".to_owned())],
            sections: vec![(
                "one",
                "One",
                vec![
                    Block::Statements(vec![statement]),
                    Block::Linked(picture),
                    Block::of_table("Motions", &table),
                    Block::MadeBy("runs".to_owned()),
                ],
            )],
        };
        let markdown = document.markdown();
        for part in [
            "**Finest:** of many",
            "- our conjecture: It holds **holds in part** (1 of 2) Holds if so.",
            "![A figure.](a.svg)",
            "| k1, N/m | motion |\n| --- | --- |\n| 2.5 | a, b |",
            "Made by: runs",
        ] {
            assert!(markdown.contains(part), "{part}: {markdown}");
        }
        let page = document.html();
        for part in [
            "<b>Finest: </b>of many",
            "<li class=\"partly\"><span class=\"says\"><b>Our conjecture: </b>It holds<small class=\"rule\">Holds if so.</small></span>",
            "<span class=\"verdict\">holds in part</span><span class=\"found\">1 of 2</span>",
            "<svg></svg></div><figcaption>A figure. <a href=\"a.svg\">a.svg</a>",
            "<th scope=\"col\">k1, N/m</th>",
            "<b>Made by: </b>runs",
        ] {
            assert!(page.contains(part), "{part}: {page}");
        }
        let verdicts = [&[][..], &[false], &[true, true]].map(Verdict::of_all);
        assert_eq!(verdicts, [Verdict::Fails, Verdict::Fails, Verdict::Holds]);
    }
}
