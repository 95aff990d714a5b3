//! The damper and the surfaces that it may strike.

use crate::{Loss, NonNegative, OutOfRange, PoissonRatio, Positive, hertz_stiffness};
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
    /// The colliding surfaces; none of a damper without walls, a tuned mass damper.
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
    /// The colliding surfaces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    contact: Option<Contact>,
}

/// Why what a file says is no damper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("missing field `{0}`: a damper in a cavity has D, C and contact, one without walls has none of them")]
struct Missing(&'static str);

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

/// The four colliding surfaces: the damper's are spheres of one large radius, the structure's and the obstacle's are flat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// R, radius of the damper's surfaces, m (not given in the paper).
    #[serde(rename = "R")]
    pub radius: Positive,
    /// q, geometrical coefficient of Hertz's theory; 0.318 for a sphere on a plane (not given in the paper).
    #[serde(rename = "q")]
    pub coefficient: Positive,
    /// E1, Young's modulus of the primary structure's surface, N/m².
    #[serde(rename = "E1")]
    pub young_1: Positive,
    /// nu1, Poisson's ratio of the primary structure's surface.
    #[serde(rename = "nu1")]
    pub poisson_1: PoissonRatio,
    /// E2, Young's modulus of the damper's surface that meets the primary structure, N/m².
    #[serde(rename = "E2")]
    pub young_2: Positive,
    /// nu2, Poisson's ratio of the damper's surface that meets the primary structure.
    #[serde(rename = "nu2")]
    pub poisson_2: PoissonRatio,
    /// E3, Young's modulus of the obstacle's surface, N/m².
    #[serde(rename = "E3")]
    pub young_3: Positive,
    /// nu3, Poisson's ratio of the obstacle's surface.
    #[serde(rename = "nu3")]
    pub poisson_3: PoissonRatio,
    /// E4, Young's modulus of the damper's surface that meets the obstacle, N/m².
    #[serde(rename = "E4")]
    pub young_4: Positive,
    /// nu4, Poisson's ratio of the damper's surface that meets the obstacle.
    #[serde(rename = "nu4")]
    pub poisson_4: PoissonRatio,
    /// What a contact loses; left out, contacts lose nothing.
    #[serde(default, skip_serializing_if = "Loss::is_none")]
    pub loss: Loss,
}

impl Contact {
    /// The walls of a damper for which none are given: the surfaces of the paper's damper of 60 kg, their moduli in proportion to the mass
    /// (kg). A contact then lasts as long, and is as deep, as one of the paper's at the same speed.
    ///
    /// # Errors
    /// A modulus is beyond the numbers.
    #[expect(clippy::approx_constant, reason = "the paper's studies have 0.318, not 1/π")]
    pub fn for_mass(mass: Positive) -> Result<Self, OutOfRange> {
        let young = |paper: f64| Positive::new(paper * (mass.get() / 60.0));
        let (steel, soft) = (PoissonRatio::new(0.3)?, PoissonRatio::new(0.4)?);
        Ok(Self {
            radius: Positive::new(2.0)?,
            coefficient: Positive::new(0.318)?,
            young_1: young(2.1e11)?,
            poisson_1: steel,
            young_2: young(2.21e7)?,
            poisson_2: soft,
            young_3: young(2.1e11)?,
            poisson_3: steel,
            young_4: young(2.05e7)?,
            poisson_4: soft,
            loss: Loss::default(),
        })
    }

    /// Hertz stiffnesses `[K1, K3]` of the contacts with the primary structure and with the obstacle, N/m^1.5.
    pub fn stiffness(&self) -> [f64; 2] {
        let pair =
            |young_a: Positive, poisson_a: PoissonRatio, young_b: Positive, poisson_b: PoissonRatio| {
                hertz_stiffness(
                    self.coefficient.get(),
                    self.radius.get(),
                    [(young_a.get(), poisson_a.get()), (young_b.get(), poisson_b.get())],
                )
            };
        [
            pair(self.young_1, self.poisson_1, self.young_2, self.poisson_2),
            pair(self.young_3, self.poisson_3, self.young_4, self.poisson_4),
        ]
    }
}
