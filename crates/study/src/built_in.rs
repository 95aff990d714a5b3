//! The plans of the paper, and the studies that they name, for a program that is installed without its repository.

use super::file::{StudyError, read_text};
use std::path::Path;

/// The directory in which plans are looked for first.
pub(super) const PLACE: &str = "studies";

/// Copies of the files in [`PLACE`] of the repository, which packages do not contain. A test compares them.
const PLANS: [(&str, &str); 12] = [
    ("table2.json", include_str!("plans/table2.json")),
    ("table2-ssvi.json", include_str!("plans/table2-ssvi.json")),
    ("tmd.json", include_str!("plans/tmd.json")),
    ("retune.json", include_str!("plans/retune.json")),
    ("retune-ssvi.json", include_str!("plans/retune-ssvi.json")),
    ("retune-tmd.json", include_str!("plans/retune-tmd.json")),
    ("retune-ssvi-free.json", include_str!("plans/retune-ssvi-free.json")),
    ("retune-tmd-free.json", include_str!("plans/retune-tmd-free.json")),
    ("fronts.json", include_str!("plans/fronts.json")),
    ("fronts-ssvi.json", include_str!("plans/fronts-ssvi.json")),
    ("fronts-tmd.json", include_str!("plans/fronts-tmd.json")),
    ("paper.json", include_str!("plans/paper.json")),
];

/// Whether a plan is the one built into this program, because there is no file of its name.
pub fn is_built_in(path: &Path) -> bool {
    !path.exists() && text(path).is_some()
}

/// Like [`read_text`], for a plan or a study that a plan names: uses the one built in if there is no such file.
pub(super) fn read_plan_text(path: &Path) -> Result<String, StudyError> {
    match text(path) {
        Some(text) if !path.exists() => Ok(text.to_owned()),
        _ => read_text(path),
    }
}

/// The text of a plan, or of a study that one names.
pub(super) fn text(path: &Path) -> Option<&'static str> {
    let name = path.strip_prefix(PLACE).ok()?;
    PLANS.into_iter().find(|(plan, _)| Path::new(plan) == name).map(|(_, text)| text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{read_fronts, read_table2};

    #[test]
    fn contract_the_plans_built_in_are_those_of_the_repository() {
        let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
        for (name, text) in PLANS {
            let file = std::fs::read_to_string(studies.join(name)).expect(name);
            assert_eq!(file, text, "copy studies/{name} to crates/study/src/plans");
        }
    }

    /// Tests run in the directory of their crate, where there are no studies, so the built-in copies are read.
    #[test]
    fn contract_every_plan_built_in_is_complete() {
        for name in ["table2", "retune", "fronts"] {
            let path = Path::new(PLACE).join(name).with_extension("json");
            assert!(is_built_in(&path), "{name}");
            let read =
                if name == "fronts" { read_fronts(&path).map(drop) } else { read_table2(&path).map(drop) };
            read.unwrap_or_else(|error| panic!("{error}"));
        }
        assert!(!is_built_in(Path::new("studies/ssvi.json")) && !is_built_in(Path::new("table2.json")));
    }
}
