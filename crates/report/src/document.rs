//! A page of results as data: written once as Markdown, for readers of the repository, and once as HTML, which needs no network.

use crate::Drawing;
use crate::html::{Section, Table, figure, head, link};
use maud::{DOCTYPE, Markup, html};

/// A piece of a page.
#[derive(Debug)]
pub enum Block {
    /// A paragraph.
    Words(String),
    /// A list of statements.
    List(Vec<String>),
    /// A table: its caption, its head, its rows.
    Table(String, Vec<String>, Vec<Vec<String>>),
    /// A figure: its file, the drawing, its caption.
    Figure(&'static str, Drawing, String),
    /// Links to files beside the page.
    Files(Vec<String>),
}

/// A page.
#[derive(Debug)]
pub struct Document {
    /// Its title.
    pub title: String,
    /// The command that made it.
    pub command: &'static str,
    /// What stands before the first section.
    pub opening: Vec<Block>,
    /// The target of links to a section, its heading, its contents.
    pub sections: Vec<(&'static str, &'static str, Vec<Block>)>,
}

impl Document {
    /// Its files, each with its name: both forms and all figures.
    pub fn files(&self) -> Vec<(&'static str, String)> {
        let blocks = self.opening.iter().chain(self.sections.iter().flat_map(|(.., blocks)| blocks));
        let figure = |block: &Block| match block {
            Block::Figure(file, drawing, _) => Some((*file, drawing.wide.clone())),
            _ => None,
        };
        let pages = [("README.md", self.markdown()), ("report.html", self.html())];
        blocks.filter_map(figure).chain(pages).collect()
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
                (head(&self.title, ""))
                body {
                    header {
                        h1 { (self.title) }
                        @for block in &self.opening { (block.html()) }
                        nav aria-label="Sections" { ul {
                            @for (id, title, _) in &self.sections { li { a href={ "#" (id) } { (title) } } }
                        } }
                    }
                    main { @for (id, title, blocks) in &self.sections {
                        (Section { id, title, body: html! { @for block in blocks { (block.html()) } } }.markup())
                    } }
                    footer { p { "Made by " code { (self.command) } ", Retune " (env!("CARGO_PKG_VERSION")) "." } }
                }
            }
        };
        page.into_string()
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
    pub fn figure(file: &'static str, drawing: impl Into<Drawing>, caption: impl Into<String>) -> Self {
        Self::Figure(file, drawing.into(), caption.into())
    }

    /// Links to files beside the page.
    pub fn files(files: &[&str]) -> Self {
        Self::Files(files.iter().map(|file| (*file).to_owned()).collect())
    }

    fn markdown(&self) -> String {
        match self {
            Self::Words(words) => format!("{words}\n\n"),
            Self::List(all) => all.iter().map(|words| format!("- {words}\n")).collect::<String>() + "\n",
            Self::Table(caption, head, rows) => {
                let rule = vec!["---"; head.len()].join(" | ");
                let rows: String = rows.iter().map(|row| format!("| {} |\n", row.join(" | "))).collect();
                format!("{caption}\n\n| {} |\n| {rule} |\n{rows}\n", head.join(" | "))
            }
            Self::Figure(file, _, caption) => format!("![{caption}]({file})\n\n"),
            Self::Files(files) => {
                let links: Vec<String> = files.iter().map(|file| format!("[{file}]({file})")).collect();
                format!("{}\n\n", links.join(", "))
            }
        }
    }

    fn html(&self) -> Markup {
        match self {
            Self::Words(words) => html! { p { (words) } },
            Self::List(all) => html! { ul { @for words in all { li { (words) } } } },
            Self::Table(caption, head, rows) => {
                let head: Vec<&str> = head.iter().map(String::as_str).collect();
                let mut table = Table::new(caption.as_str(), &head);
                rows.iter().for_each(|row| table.row(row.iter().cloned()));
                table.markup()
            }
            Self::Figure(_, drawing, caption) => figure(drawing, html! { (caption) }),
            Self::Files(files) => html! { p { @for file in files { (link(file)) " " } } },
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
                    Block::files(&["a.csv"]),
                ],
            )],
        };
        let table = "Designs\n\n| damper | E1max, J |\n| --- | --- |\n| TMD | 660.4 |\n\n";
        let markdown =
            format!("# T < U\n\nFirst.\n\n## One\n\n- a\n\n{table}![Fig](a.svg)\n\n[a.csv](a.csv)\n");
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
            "href=\"a.csv\"",
        ] {
            assert!(page.contains(part), "{part}: {page}");
        }
    }
}
