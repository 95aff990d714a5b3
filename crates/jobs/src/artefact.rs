//! The files that each kind of job makes. These lists determine which files a job may replace, and how `verify` recomputes each of them.

use crate::recompute::{Rows, Whole};

/// The kind of contents of a file of results, which determines how they are recomputed.
#[derive(Clone, Copy, Debug)]
pub enum Content {
    /// The complete input, from which all other files follow; the manifest holds its hash.
    Input,
    /// A table whose rows can be recomputed one by one.
    Rows(Rows),
    /// Files that are recomputed as a whole.
    Whole(Whole),
    /// Numbers of the other files as text or figure, the log of a search, the manifest: checked by their hash alone.
    Derived,
}

/// A kind of job, with all files that it makes: each list in the order in which `verify` reports on them, `*` in a name for any text.
#[derive(Debug)]
pub struct Kind {
    /// The command of the job, also its name in manifests.
    pub command: &'static str,
    /// The file without which its results are not complete.
    pub answer: &'static str,
    /// Its complete input.
    pub input: &'static str,
    /// Its tables.
    pub rows: &'static [(&'static str, Rows)],
    /// Files that are recomputed as a whole.
    pub whole: &'static [(&'static str, Whole)],
    /// Files derived from the others.
    pub derived: &'static [&'static str],
}

/// Whether a file has a name in which `*` stands for any text.
pub fn is_named(name: &str, pattern: &str) -> bool {
    match pattern.split_once('*') {
        None => name == pattern,
        Some((head, tail)) => {
            name.strip_prefix(head).is_some_and(|rest| rest.len() > tail.len() && rest.ends_with(tail))
        }
    }
}

impl Kind {
    /// The names of all its files, each with its contents.
    pub fn files(&self) -> impl Iterator<Item = (&'static str, Content)> {
        let input = [(self.input, Content::Input)].into_iter();
        let rows = self.rows.iter().map(|(name, rows)| (*name, Content::Rows(*rows)));
        let whole = self.whole.iter().map(|(name, whole)| (*name, Content::Whole(*whole)));
        input.chain(rows).chain(whole).chain(self.derived.iter().map(|name| (*name, Content::Derived)))
    }

    /// Its files in words, including those that it makes only where the study asks for them.
    pub fn words(&self) -> String {
        let names: Vec<&str> = self.files().map(|(name, _)| name).collect();
        format!("`retune {}` makes {}", self.command, names.join(" "))
    }

    /// Whether this job makes files of this name.
    pub fn makes(&self, name: &str) -> bool {
        self.files().any(|(pattern, _)| is_named(name, pattern))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_star_stands_for_any_text() {
        assert!(is_named("surf-k2-c2.svg", "surf-*.svg"));
        for name in ["surf-.svg", "surf.svg", "surf-k2.csv", "my-surf-k2.svg"] {
            assert!(!is_named(name, "surf-*.svg"), "{name}");
        }
        assert!(is_named("a.csv", "a.csv") && !is_named("a.csvx", "a.csv"));
    }
}
