//! What makes the structure move: a harmonic force, a rotating imbalance, a moving base, or a start away from rest. `docs/theory.md`
//! has the equations of each; all but the last are a harmonic force on the structure.

use crate::{Finite, NonNegative};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The harmonic force and its quarter-turn: `[P cos(ωt + φ), P sin(ωt + φ)]`, N.
///
/// The formulas of this crate take this pair instead of `t`, so that a caller who steps in time may turn it by a rotation instead
/// of calling `cos` at every step.
pub type Excitation = [f64; 2];

/// What makes the primary structure move, and how fast.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "InFile", into = "InFile")]
#[schemars(with = "InFile")]
pub struct Forcing {
    /// Its kind and size.
    pub source: Source,
    /// omega, its angular frequency, rad/s; 0 of a free decay.
    pub frequency: NonNegative,
    /// Where a motion under a force starts; at rest if there is none. A free decay has its own.
    pub start: Option<Start>,
}

/// The kinds of forcing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A force P cos ωt on the structure: P, N.
    Force(NonNegative),
    /// A rotating imbalance of the structure: m e, the mass (part of m1) times its distance from the axis, kg·m. It is the force
    /// m e ω² cos ωt.
    Imbalance(NonNegative),
    /// A base that moves by Y cos ωt: Y, m. On the structure it acts as the force k1 y + c1 dy/dt.
    Base(NonNegative),
    /// Nothing but a start away from rest.
    Decay(Start),
}

/// A state at t = 0, SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Start {
    /// x1, displacement of the structure, m.
    pub x1: Finite,
    /// v1, its velocity, m/s.
    pub v1: Finite,
    /// x2, position of the damper, m; x1 + D if left out, where its spring is at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x2: Option<Finite>,
    /// v2, its velocity, m/s.
    pub v2: Finite,
}

impl Forcing {
    /// A force P cos ωt on the structure: P, N, and ω, rad/s.
    pub const fn force(amplitude: NonNegative, frequency: NonNegative) -> Self {
        Self { source: Source::Force(amplitude), frequency, start: None }
    }

    /// Where the motion starts; none at rest.
    pub fn start(&self) -> Option<Start> {
        match self.source {
            Source::Decay(start) => Some(start),
            _ => self.start,
        }
    }

    /// Begins elsewhere.
    pub fn begin(&mut self, at: Start) {
        match &mut self.source {
            Source::Decay(start) => *start = at,
            _ => self.start = Some(at),
        }
    }

    /// The transmissibility of a motion with these largest values (m, N): the force on the ground over the amplitude of the force on
    /// the structure; on a moving base the displacement of the structure over that of the base. NaN or infinite where nothing moves it.
    pub fn transmissibility(&self, displacement: f64, ground_force: f64) -> f64 {
        let omega = self.frequency.get();
        match self.source {
            Source::Force(force) => ground_force / force.get(),
            Source::Imbalance(imbalance) => ground_force / (imbalance.get() * omega * omega),
            Source::Base(base) => displacement / base.get(),
            Source::Decay(_) => f64::NAN,
        }
    }
}

/// What makes the primary structure move: one of `P`, `imbalance` and `base` with its `omega`, from rest or from `start`; or `start` alone.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Forcing", extend("oneOf" = [
    { "required": ["P", "omega"] }, { "required": ["imbalance", "omega"] }, { "required": ["base", "omega"] },
    { "required": ["start"], "properties": { "omega": false } }
]))]
struct InFile {
    /// P, amplitude of the force on the primary structure, N: P cos(omega t).
    #[serde(rename = "P", default, skip_serializing_if = "Option::is_none")]
    force: Option<NonNegative>,
    /// imbalance, rotating imbalance, mass times its distance from the axis, kg·m: the force imbalance omega² cos(omega t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    imbalance: Option<NonNegative>,
    /// base, amplitude of the moving base, m: base cos(omega t).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    base: Option<NonNegative>,
    /// The state at t = 0, rest if left out; alone it is a free decay, without any force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<Start>,
    /// omega, angular frequency of the forcing, rad/s: of the force, of the rotation or of the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    omega: Option<NonNegative>,
}

impl From<Forcing> for InFile {
    fn from(Forcing { source, frequency, start }: Forcing) -> Self {
        let none = Self { force: None, imbalance: None, base: None, start, omega: Some(frequency) };
        match source {
            Source::Force(amplitude) => Self { force: Some(amplitude), ..none },
            Source::Imbalance(amplitude) => Self { imbalance: Some(amplitude), ..none },
            Source::Base(amplitude) => Self { base: Some(amplitude), ..none },
            Source::Decay(start) => Self { start: Some(start), omega: None, ..none },
        }
    }
}

/// Why what a file says is no forcing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Refused {
    #[error("give one of `P`, `imbalance` and `base`, or `start` alone, not {0} of them")]
    Count(usize),
    #[error("missing field `omega`: the angular frequency, rad/s")]
    NoFrequency,
    #[error("`omega` has no meaning beside `start`: a free decay has no force")]
    FreeFrequency,
}

impl TryFrom<InFile> for Forcing {
    type Error = Refused;

    fn try_from(file: InFile) -> Result<Self, Refused> {
        let InFile { force, imbalance, base, start, omega } = file;
        let sources = [force.map(Source::Force), imbalance.map(Source::Imbalance), base.map(Source::Base)];
        let given: Vec<Source> = sources.into_iter().flatten().collect();
        match (given.as_slice(), start, omega) {
            ([], Some(_), Some(_)) => Err(Refused::FreeFrequency),
            ([], Some(start), None) => {
                Ok(Self { source: Source::Decay(start), frequency: NonNegative::default(), start: None })
            }
            ([source], start, Some(frequency)) => Ok(Self { source: *source, frequency, start }),
            ([_], _, None) => Err(Refused::NoFrequency),
            (others, ..) => Err(Refused::Count(others.len())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Forcing, String> {
        serde_json::from_str(text).map_err(|error| error.to_string())
    }

    #[test]
    fn contract_one_kind_of_forcing_and_what_it_needs() {
        for text in [
            r#"{"P":800.0,"omega":6.28}"#,
            r#"{"imbalance":0.5,"omega":6.28}"#,
            r#"{"base":0.01,"omega":6.28}"#,
            r#"{"P":800.0,"start":{"x1":0.1,"v1":0.0,"x2":0.2,"v2":0.0},"omega":6.28}"#,
            r#"{"start":{"x1":0.1,"v1":0.0,"v2":0.0}}"#,
        ] {
            let forcing = read(text).expect(text);
            assert_eq!(serde_json::to_string(&forcing).expect("JSON"), text);
        }
        for (text, said) in [
            (r#"{"omega":6.28}"#, "give one of `P`, `imbalance` and `base`, or `start` alone, not 0 of them"),
            (r#"{"P":1,"base":1,"omega":6.28}"#, "not 2 of them"),
            (r#"{"P":1}"#, "missing field `omega`"),
            (r#"{"start":{},"omega":1}"#, "`omega` has no meaning beside `start`"),
            (r#"{"base":-1,"omega":1}"#, "-1 is not allowed here"),
        ] {
            let error = read(text).expect_err(text);
            assert!(error.contains(said), "{error}");
        }
    }
}
