//! The damper.

use crate::{Contact, NonNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The damper: a mass on a spring and a dashpot in a cavity of the primary structure, or on the structure with no walls beside it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "InFile", into = "InFile")]
#[schemars(with = "InFile")]
pub struct Damper {
    /// m2, mass of the damper, kg.
    pub mass: Positive,
    /// k2, stiffness of the damper's spring, N/m.
    pub stiffness: NonNegative,
    /// c2, damping between damper and primary structure, N·s/m.
    pub damping: NonNegative,
    /// D, distance between the damper at rest and the primary structure, m; 0 without walls.
    pub rest_distance: NonNegative,
    /// C, clearance between the damper at rest and the obstacle, m; 0 without walls.
    pub clearance: NonNegative,
    /// The walls; none of a damper without, a tuned mass damper.
    pub contact: Option<Contact>,
}

/// The damper: a mass on a spring and a dashpot in a cavity of the primary structure. A tuned mass damper that has no walls leaves out
/// D, C and contact, all three.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Damper", extend("dependentRequired" = {
    "D": ["C", "contact"], "C": ["D", "contact"], "contact": ["D", "C"]
}))]
struct InFile {
    /// m2, mass of the damper, kg.
    #[serde(rename = "m2")]
    mass: Positive,
    /// k2, stiffness of the damper's spring, N/m.
    #[serde(rename = "k2")]
    stiffness: NonNegative,
    /// c2, damping between damper and primary structure, N·s/m.
    #[serde(rename = "c2")]
    damping: NonNegative,
    /// D, distance between the damper at rest and the primary structure, m.
    #[serde(rename = "D", default, skip_serializing_if = "Option::is_none")]
    rest_distance: Option<NonNegative>,
    /// C, clearance between the damper at rest and the obstacle, m.
    #[serde(rename = "C", default, skip_serializing_if = "Option::is_none")]
    clearance: Option<NonNegative>,
    /// The walls: the colliding surfaces, or `rigid`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    contact: Option<Contact>,
}

/// Why the fields of a file do not describe a damper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("missing field `{0}`: a damper in a cavity has D, C and contact, one without walls has none of them")]
struct Missing(&'static str);

impl Damper {
    /// Whether it has no spring. A periodic motion without contact can then be shifted freely, so it is not isolated.
    pub fn is_floating(&self) -> bool {
        self.stiffness.get() == 0.0
    }
}

impl TryFrom<InFile> for Damper {
    type Error = Missing;

    fn try_from(file: InFile) -> Result<Self, Missing> {
        let InFile { mass, stiffness, damping, rest_distance, clearance, contact } = file;
        let (rest_distance, clearance) = match (rest_distance, clearance, contact) {
            (None, None, None) => Default::default(),
            (Some(d), Some(c), Some(_)) => (d, c),
            (None, ..) => return Err(Missing("D")),
            (_, None, _) => return Err(Missing("C")),
            (.., None) => return Err(Missing("contact")),
        };
        Ok(Self { mass, stiffness, damping, rest_distance, clearance, contact })
    }
}

impl From<Damper> for InFile {
    fn from(damper: Damper) -> Self {
        let Damper { mass, stiffness, damping, rest_distance, clearance, contact } = damper;
        let walled = |gap| contact.is_some().then_some(gap);
        let (rest_distance, clearance) = (walled(rest_distance), walled(clearance));
        Self { mass, stiffness, damping, rest_distance, clearance, contact }
    }
}
