//! The files of the reproduction.

use super::again;
use crate::artefact::{Content, Kind, artefact};
use crate::resolved;

/// The files of the reproduction.
pub static KIND: Kind = Kind {
    command: "reproduce",
    answer: "index.html",
    artefacts: &[
        artefact(resolved::SEVERAL, Content::Input),
        artefact("study.json", Content::Derived),
        artefact("table1-statements.json", Content::Whole(again::again)),
        artefact("table2-statements.json", Content::Whole(again::again)),
        artefact("figure*-statements.json", Content::Whole(again::again)),
        artefact("table1-*", Content::Derived),
        artefact("table2-*", Content::Derived),
        artefact("figure*", Content::Derived),
        artefact("index.html", Content::Derived),
    ],
};
