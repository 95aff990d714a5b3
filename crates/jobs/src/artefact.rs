//! The files that each kind of job makes. From this list follow the files that a job may replace, and how `verify` computes each
//! of them again.

use crate::again::{Rows, Whole};

/// The contents of a file of results, and so how they are computed again.
#[derive(Clone, Copy, Debug)]
pub enum Content {
    /// The complete input that all the other files follow from; the manifest holds its hash.
    Input,
    /// A table, whose rows can be computed one by one.
    Rows(Rows),
    /// What is made again as a whole.
    Whole(Whole),
    /// Numbers of the other files as text or figure, the log of a search, the manifest: checked by their hash alone.
    Derived,
}

/// A file of results.
#[derive(Clone, Copy, Debug)]
pub struct Artefact {
    /// Its name; `*` stands for any text.
    pub name: &'static str,
    /// Its contents.
    pub content: Content,
}

/// A kind of job.
#[derive(Debug)]
pub struct Kind {
    /// The command that asks for it, by which manifests name it.
    pub command: &'static str,
    /// The file without which its results are not complete.
    pub answer: &'static str,
    /// All files that it makes, in the order in which `verify` reports on them.
    pub artefacts: &'static [Artefact],
}

/// A file of these contents.
pub const fn artefact(name: &'static str, content: Content) -> Artefact {
    Artefact { name, content }
}

impl Artefact {
    /// Whether a file of this name is one of these.
    pub fn is(&self, name: &str) -> bool {
        match self.name.split_once('*') {
            None => name == self.name,
            Some((head, tail)) => {
                name.strip_prefix(head).is_some_and(|rest| rest.len() > tail.len() && rest.ends_with(tail))
            }
        }
    }
}

impl Kind {
    /// Its files in words: those that it makes of any study, some of them only where the study asks for it.
    pub fn files(&self) -> String {
        let names: Vec<&str> = self.artefacts.iter().map(|artefact| artefact.name).collect();
        format!("`retune {}` makes {}", self.command, names.join(" "))
    }

    /// Whether this job makes files of this name.
    pub fn makes(&self, name: &str) -> bool {
        self.artefacts.iter().any(|artefact| artefact.is(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_star_stands_for_any_text() {
        let one = artefact("surf-*.svg", Content::Derived);
        assert!(one.is("surf-k2-c2.svg"));
        for name in ["surf-.svg", "surf.svg", "surf-k2.csv", "my-surf-k2.svg"] {
            assert!(!one.is(name), "{name}");
        }
        assert!(
            artefact("a.csv", Content::Input).is("a.csv") && !artefact("a.csv", Content::Input).is("a.csvx")
        );
    }
}
