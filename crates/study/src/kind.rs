//! What a study file is: a study of one damper, or one of the three that name several.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The kind of a study file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// One structure with one damper.
    #[default]
    Study,
    /// A table of dampers, each with its study and a design of the paper.
    Table2,
    /// Dampers under ever looser bounds.
    Fronts,
    /// The whole paper.
    Paper,
}

impl Kind {
    /// Its name, as the field `kind` of a file has it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Study => "study",
            Self::Table2 => "table2",
            Self::Fronts => "fronts",
            Self::Paper => "paper",
        }
    }

    /// The commands that take it.
    pub const fn commands(self) -> &'static str {
        match self {
            Self::Study => "`retune optimize`, `certify`, `simulate`, `sweep` and `evaluate`",
            Self::Table2 => "`retune table2` and `retune retention`",
            Self::Fronts => "`retune fronts`",
            Self::Paper => "`retune reproduce`, `figure` and `table`",
        }
    }

    /// The field that only files of this kind have; a file without `kind` is recognised by it.
    const fn field(self) -> &'static str {
        match self {
            Self::Study => "scene",
            Self::Table2 => "rows",
            Self::Fronts => "dampers",
            Self::Paper => "table2",
        }
    }

    /// The kind of a JSON object, by its field `kind` or else by its other fields; none of anything else.
    pub(super) fn of(json: &Value) -> Option<Self> {
        match json.get("kind") {
            Some(kind) => Self::deserialize(kind).ok(),
            None => [Self::Study, Self::Table2, Self::Fronts, Self::Paper]
                .into_iter()
                .find(|kind| json.get(kind.field()).is_some()),
        }
    }

    /// Whether it is the default, which files need not say.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
    pub(super) fn is_study(&self) -> bool {
        *self == Self::Study
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn contract_a_file_says_its_kind_or_is_recognised_by_its_fields() {
        assert_eq!(Kind::of(&json!({ "kind": "fronts", "rows": [] })), Some(Kind::Fronts));
        assert_eq!(Kind::of(&json!({ "rows": [] })), Some(Kind::Table2));
        assert_eq!(Kind::of(&json!({ "scene": {}, "window": {} })), Some(Kind::Study));
        assert_eq!(Kind::of(&json!({ "kind": "fronst" })), None);
        assert_eq!(Kind::of(&json!([1])), None);
    }
}
