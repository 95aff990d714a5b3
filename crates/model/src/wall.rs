//! The walls that a damper may strike, by one of two laws: Hertz's surfaces, or rigid walls.

use crate::{Bounce, Loss, OutOfRange, PoissonRatio, Positive, hertz_stiffness};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The law of both walls.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "InFile", into = "Written")]
#[schemars(with = "Written")]
pub enum Contact {
    /// Elastic surfaces that indent one another.
    Hertz(Surfaces),
    /// Rigid walls.
    Rigid(Rigid),
}

/// Rigid walls: impacts take no time, and a damper at rest on a wall is held by it as long as it is pressed on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// e, restitution of an impact: relative speed after over that before it.
    pub restitution: Bounce,
}

/// The walls as a file has them: the surfaces, or `rigid`.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Contact")]
enum Written {
    Hertz(Surfaces),
    Rigid(RigidWalls),
}

/// Rigid walls in the place of colliding surfaces.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RigidWalls {
    /// Impacts that take no time.
    rigid: Rigid,
}

/// All fields that a file may have for the walls; `Written` has their valid combinations.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[rustfmt::skip]
struct InFile {
    #[serde(rename = "R")] radius: Option<Positive>,
    #[serde(rename = "q")] coefficient: Option<Positive>,
    #[serde(rename = "E1")] young_1: Option<Positive>,
    #[serde(rename = "nu1")] poisson_1: Option<PoissonRatio>,
    #[serde(rename = "E2")] young_2: Option<Positive>,
    #[serde(rename = "nu2")] poisson_2: Option<PoissonRatio>,
    #[serde(rename = "E3")] young_3: Option<Positive>,
    #[serde(rename = "nu3")] poisson_3: Option<PoissonRatio>,
    #[serde(rename = "E4")] young_4: Option<Positive>,
    #[serde(rename = "nu4")] poisson_4: Option<PoissonRatio>,
    loss: Option<Loss>,
    loss_obstacle: Option<Loss>,
    strength: Option<Positive>,
    density: Option<Positive>,
    rigid: Option<Rigid>,
}

/// Why the fields of a file do not describe a law of the walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
enum Refused {
    #[error("missing field `{0}`: give all of R, q, E1, nu1 to E4, nu4 (Hertz's surfaces), or `rigid` alone")]
    Missing(&'static str),
    #[error(
        "two laws: `rigid` and `{0}`: give `rigid` alone, or Hertz's surfaces (R, q, E1, nu1 to E4, nu4, loss, loss_obstacle, strength, density) without it"
    )]
    Both(&'static str),
}

impl TryFrom<InFile> for Contact {
    type Error = Refused;

    #[rustfmt::skip]
    fn try_from(file: InFile) -> Result<Self, Refused> {
        if let Some(rigid) = file.rigid {
            let given = [
                ("R", file.radius.is_some()), ("q", file.coefficient.is_some()),
                ("E1", file.young_1.is_some()), ("nu1", file.poisson_1.is_some()),
                ("E2", file.young_2.is_some()), ("nu2", file.poisson_2.is_some()),
                ("E3", file.young_3.is_some()), ("nu3", file.poisson_3.is_some()),
                ("E4", file.young_4.is_some()), ("nu4", file.poisson_4.is_some()),
                ("loss", file.loss.is_some()), ("loss_obstacle", file.loss_obstacle.is_some()),
                ("strength", file.strength.is_some()), ("density", file.density.is_some()),
            ];
            return match given.into_iter().find(|(_, given)| *given) {
                Some((name, _)) => Err(Refused::Both(name)),
                None => Ok(Self::Rigid(rigid)),
            };
        }
        Ok(Self::Hertz(Surfaces {
            radius: file.radius.ok_or(Refused::Missing("R"))?,
            coefficient: file.coefficient.ok_or(Refused::Missing("q"))?,
            young_1: file.young_1.ok_or(Refused::Missing("E1"))?,
            poisson_1: file.poisson_1.ok_or(Refused::Missing("nu1"))?,
            young_2: file.young_2.ok_or(Refused::Missing("E2"))?,
            poisson_2: file.poisson_2.ok_or(Refused::Missing("nu2"))?,
            young_3: file.young_3.ok_or(Refused::Missing("E3"))?,
            poisson_3: file.poisson_3.ok_or(Refused::Missing("nu3"))?,
            young_4: file.young_4.ok_or(Refused::Missing("E4"))?,
            poisson_4: file.poisson_4.ok_or(Refused::Missing("nu4"))?,
            loss: file.loss.unwrap_or_default(),
            loss_obstacle: file.loss_obstacle,
            strength: file.strength,
            density: file.density,
        }))
    }
}

impl From<Contact> for Written {
    fn from(contact: Contact) -> Self {
        match contact {
            Contact::Hertz(surfaces) => Self::Hertz(surfaces),
            Contact::Rigid(rigid) => Self::Rigid(RigidWalls { rigid }),
        }
    }
}

impl Contact {
    /// Hertz's surfaces, if that is the law.
    pub fn surfaces(&self) -> Option<&Surfaces> {
        match self {
            Self::Hertz(surfaces) => Some(surfaces),
            Self::Rigid(_) => None,
        }
    }

    /// Rigid walls, if that is the law.
    pub fn rigid(&self) -> Option<Rigid> {
        match self {
            Self::Hertz(_) => None,
            Self::Rigid(rigid) => Some(*rigid),
        }
    }
}

/// The four colliding surfaces: the damper's are spheres of one large radius, the structure's and the obstacle's are flat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Surfaces {
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
    /// What a contact with the obstacle loses, where that is not what one with the primary structure does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loss_obstacle: Option<Loss>,
    /// strength, yield strength of the weakest of the colliding surfaces, N/m². No motion depends on it: an answer warns of contacts whose
    /// pressure is above 1.6 times it, where a surface begins to yield.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength: Option<Positive>,
    /// density, density of the damper, kg/m³. No motion depends on it: an answer warns of contacts shorter than five times what a wave takes
    /// through the damper and back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<Positive>,
}

/// √(k1/m1) of the paper's structure, rad/s, and its largest displacement without a damper over 5 to 8 rad/s, m, both to 0.1 %.
const PAPER_OMEGA: f64 = 6.285;
const PAPER_REACH: f64 = 0.2816;

impl Surfaces {
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
            loss_obstacle: None,
            strength: None,
            density: None,
        })
    }

    /// [`Self::for_mass`] for a structure unlike the paper's: `omega` is its √(k1/m1), rad/s, and `reach` its largest displacement without
    /// a damper, m. The ratio of `K z^1.5` to `m ω² z` is the paper's at equal `z / reach`.
    ///
    /// # Errors
    /// A modulus is beyond the numbers.
    pub fn for_motion(mass: Positive, omega: f64, reach: f64) -> Result<Self, OutOfRange> {
        let scale = (omega / PAPER_OMEGA).powi(2) / (reach / PAPER_REACH).sqrt();
        Self::for_mass(Positive::new(mass.get() * scale)?)
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

    /// What contacts with the primary structure and with the obstacle lose.
    pub fn losses(&self) -> [Loss; 2] {
        [self.loss, self.loss_obstacle.unwrap_or(self.loss)]
    }

    /// The times that a longitudinal wave takes through a damper of `mass` (kg) and back, s, for the contacts with the primary structure
    /// and with the obstacle: `2 L / c` with the size `L = (m2/ρ)^(1/3)` and the speed `c = √(E/ρ)` of a wave in a rod, with the E of the
    /// softer of the two surfaces that meet. None if no density is given.
    pub fn waves(&self, mass: f64) -> Option<[f64; 2]> {
        let density = self.density?.get();
        let softer =
            [(self.young_1, self.young_2), (self.young_3, self.young_4)].map(|(a, b)| a.get().min(b.get()));
        Some(softer.map(|young| 2.0 * (mass / density).cbrt() / (young / density).sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bare, Forcing, Measure, NonNegative, Primary};

    /// A cube of 8 kg with 1000 kg/m³ is 0.2 m wide; with 10 MPa the softer modulus, waves travel at 100 m/s.
    #[test]
    fn exact_a_wave_passes_a_cube_and_comes_back() {
        let number = |value| Positive::new(value).expect("above 0");
        let mut surfaces = Surfaces::for_mass(number(60.0)).expect("surfaces");
        (surfaces.young_2, surfaces.young_3) = (number(1e7), number(4e7));
        surfaces.young_4 = number(1e8);
        assert_eq!(surfaces.waves(8.0), None);
        surfaces.density = Some(number(1000.0));
        for (time, expected) in surfaces.waves(8.0).expect("times").into_iter().zip([4e-3, 2e-3]) {
            assert!((time / expected - 1.0).abs() < 1e-14, "{time} {expected}");
        }
    }

    /// Equation (1) with the numbers of the paper's section 3.
    #[test]
    fn paper_walls_are_scaled_from_its_structure() {
        let number = |value| NonNegative::new(value).expect("not below 0");
        let mass = Positive::new(1000.0).expect("above 0");
        let primary = Primary { mass, damping: number(452.0), stiffness: number(39500.0) };
        let bare = Bare::new(&primary, &Forcing::force(number(800.0), number(6.0)));
        let reach = bare.steady_max(Measure::Displacement, [5.0, 8.0]).value;
        for (own, paper) in [(primary.natural_frequency(), PAPER_OMEGA), (reach, PAPER_REACH)] {
            assert!((own / paper - 1.0).abs() < 1e-3, "{own} {paper}");
        }
    }

    const HERTZ: &str = r#"{"R":2.0,"q":0.318,"E1":210000000000.0,"nu1":0.3,"E2":22100000.0,"nu2":0.4,"E3":210000000000.0,"nu3":0.3,"E4":20500000.0,"nu4":0.4}"#;

    #[test]
    fn contract_the_walls_have_one_of_two_laws() {
        let read = |text: &str| serde_json::from_str::<Contact>(text).map_err(|error| error.to_string());
        let known = HERTZ.replace('}', r#","strength":20000000.0,"density":1200.0}"#);
        let two = HERTZ.replace('}', r#","loss":{"restitution":0.9},"loss_obstacle":{"lambda":0.0}}"#);
        for text in [HERTZ, &known, &two, r#"{"rigid":{"restitution":0.7}}"#] {
            let contact = read(text).expect("a law");
            assert_eq!(serde_json::to_string(&contact).expect("JSON"), text);
            assert_eq!(contact.rigid().is_some(), contact.surfaces().is_none());
        }
        for end in ["0", "1"] {
            assert!(read(&format!(r#"{{"rigid":{{"restitution":{end}}}}}"#)).is_ok(), "{end}");
        }
        for (text, said) in [
            (
                "{}",
                "missing field `R`: give all of R, q, E1, nu1 to E4, nu4 (Hertz's surfaces), or `rigid` alone",
            ),
            (&HERTZ.replace(r#","nu4":0.4"#, ""), "missing field `nu4`"),
            (r#"{"rigid":{"restitution":0.7},"R":2}"#, "two laws: `rigid` and `R`: give `rigid` alone, or"),
            (r#"{"rigid":{"restitution":0.7},"loss":{"lambda":0.1}}"#, "two laws: `rigid` and `loss`"),
            (&HERTZ.replace('{', r#"{"rigid":{"restitution":1},"#), "two laws: `rigid` and `R`"),
            (
                r#"{"rigid":{"restitution":0.7},"loss_obstacle":{"lambda":0.1}}"#,
                "two laws: `rigid` and `loss_obstacle`",
            ),
            (r#"{"rigid":{"restitution":0.7},"strength":1e7}"#, "two laws: `rigid` and `strength`"),
            (r#"{"rigid":{"restitution":0.7},"density":1e3}"#, "two laws: `rigid` and `density`"),
            (&HERTZ.replace('{', r#"{"strength":0,"#), "0 is not allowed here: give a finite number above 0"),
            (
                &HERTZ.replace('{', r#"{"density":-1,"#),
                "-1 is not allowed here: give a finite number above 0",
            ),
            (r#"{"rigid":{"restitution":1.1}}"#, "1.1 is not allowed here: give a number from 0 to 1"),
            (r#"{"rigid":{"restitution":-0.1}}"#, "-0.1 is not allowed here: give a number from 0 to 1"),
            (r#"{"rigid":{}}"#, "missing field `restitution`"),
            (r#"{"rigid":{"e":0.7}}"#, "unknown field `e`"),
            (r#"{"stiff":1}"#, "unknown field `stiff`"),
        ] {
            let error = read(text).expect_err(text);
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
