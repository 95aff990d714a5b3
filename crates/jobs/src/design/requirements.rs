//! The requirements on a design, in SI units, and the studies derived from them.
//!
//! Bounds and grids scale with the structure: stiffness and damping with those of Den Hartog's damper, gaps with the amplitude of the
//! structure without a damper.

use super::driving::Driving;
use crate::Error;
use retune_model::{
    Bare, Forcing, Loss, Measure, NonNegative, PerMeasure, PoissonRatio, Positive, Primary, Restitution,
    Scene, Surfaces, den_hartog,
};
use retune_optim::{Band, Limit, Limits, over_natural, springs_for};
use retune_solver::{Also, Ask, Settings, Window, extremes};
use retune_study::read::from_text;
use retune_study::{SLOWEST, Study};
use serde::Serialize;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// The requirements on a design. SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Requirements {
    /// Mass of the structure, kg.
    pub m1: f64,
    /// Its stiffness, N/m.
    pub k1: f64,
    /// Its damping, N·s/m.
    pub c1: f64,
    /// Its excitation.
    #[serde(flatten)]
    pub driving: Driving,
    /// The unit in which frequencies are reported: Hz, rpm or rad/s.
    pub frequencies: &'static str,
    /// Mass of the damper, kg.
    pub mass: f64,
    /// The quantity to minimise.
    pub goal: Measure,
    /// The largest allowed values of quantities.
    pub limits: Limits,
    /// Largest stiffness of the damper's spring, N/m.
    pub k2_max: Option<f64>,
    /// Share by which k1 may be off: values and limits are for the worst k1 within it.
    pub k1_error: Option<f64>,
    /// The dampers that are compared.
    pub dampers: Dampers,
    /// The walls of an SSVI NES.
    pub wall: Option<Wall>,
    /// Whether the structure is one of several modes, all of which the ground excites and all of which load it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub of_mode: bool,
}

/// The dampers that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Dampers {
    /// The TMD only.
    Tmd,
    /// The SSVI NES, and the TMD from which its search starts.
    Ssvi,
    /// Both, and the better one is recommended.
    Both,
}

impl Dampers {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Tmd, Self::Ssvi, Self::Both];

    /// Its word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tmd => "tmd",
            Self::Ssvi => "ssvi",
            Self::Both => "both",
        }
    }
}

/// The damper's surfaces at the walls; the walls are of steel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Wall {
    /// Radius, m.
    #[serde(rename = "R")]
    pub radius: f64,
    /// Young's modulus, N/m².
    #[serde(rename = "E")]
    pub modulus: f64,
    /// Poisson's ratio.
    #[serde(rename = "nu")]
    pub poisson: f64,
    /// Restitution of a contact at every speed; none for lossless contacts.
    #[serde(rename = "e", skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
}

/// A required limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constraint {
    /// On a quantity.
    Of(Limit),
    /// On the stiffness of the damper's spring.
    K2,
}

impl Constraint {
    /// Its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Of(limit) => limit.name(),
            Self::K2 => "k2",
        }
    }

    /// Its SI unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Of(limit) => limit.unit(),
            Self::K2 => "N/m",
        }
    }
}

/// Natural periods before the window of a run of an SSVI NES, and in all.
const PASSED: f64 = 50.0;
const PERIODS: f64 = 100.0;
/// Number of stiffnesses of a structure whose k1 may be off; for a TMD in closed form peaks between them are searched, too.
const STIFFNESSES: usize = 17;
/// Upper bounds of the spring and dashpot of a TMD, as multiples of Den Hartog's: large enough to lock the mass to the structure, for the
/// smallest stroke.
const STIFFEST: f64 = 200.0;
const LOCKED: f64 = 1e6;
/// Below this damping ratio the upper bound of the gaps grows in inverse proportion to it, at most by the factor [`MOST_ROOM`].
const HARDLY_DAMPED: f64 = 0.005;
const MOST_ROOM: f64 = 5.0;
/// Least damping ratio of the structure that scales gaps and tolerances.
const LEAST_DAMPING: f64 = 0.01;

impl Requirements {
    /// Refuses requirements that a single mode cannot answer.
    pub(super) fn check_mode(&self) -> Result<(), Error> {
        if !self.of_mode {
            return Ok(());
        }
        let refused = |problem: &str| {
            Err(Error::Requirement { place: "--modes".to_owned(), problem: problem.to_owned() })
        };
        let bare = Bare::new(&self.primary(true)?, &self.forcing()?);
        if bare.is_on_moving_base() || bare.moves_with_base() {
            return refused(
                "a base that moves excites a mode by its participation factor, which the table does not have: give a force at the damper",
            );
        }
        if self.goal == Measure::GroundForce || self.is_limited(Measure::GroundForce) {
            return refused(
                "the force on the ground is that of all modes: give another --goal or --limit than ground-force",
            );
        }
        Ok(())
    }

    /// The required limits, in the order of the catalogue.
    pub fn constraints(&self) -> Vec<Constraint> {
        self.limits.set().map(Constraint::Of).chain(self.k2_max.map(|_| Constraint::K2)).collect()
    }

    /// Whether a limit is on a quantity.
    pub fn is_limited(&self, measure: Measure) -> bool {
        self.limits.get(Limit::Of(measure)).is_some()
    }

    /// The largest value that a limit allows, in its SI unit; NaN where there is no such limit.
    pub fn allowed(&self, constraint: Constraint) -> f64 {
        match constraint {
            Constraint::Of(limit) => self.limits.get(limit).unwrap_or(f64::NAN),
            Constraint::K2 => self.k2_max.unwrap_or(f64::NAN),
        }
    }

    /// The requirements without one limit.
    #[must_use]
    pub fn without(&self, constraint: Constraint) -> Self {
        let mut free = self.clone();
        match constraint {
            Constraint::K2 => free.k2_max = None,
            Constraint::Of(limit) => {
                let kept = self.limits.set().filter(|other| *other != limit);
                free.limits = kept.fold(Limits::default(), |limits, other| {
                    let most = self.limits.get(other).and_then(|most| Positive::new(most).ok());
                    most.map_or(limits, |most| limits.with(other, most))
                });
            }
        }
        free
    }

    /// √(k1/m1), rad/s.
    pub fn natural_frequency(&self) -> f64 {
        (self.k1 / self.m1).sqrt()
    }

    /// The structure; with `damped`, its damping is at least [`LEAST_DAMPING`].
    fn primary(&self, damped: bool) -> Result<Primary, Error> {
        let least = if damped { 2.0 * LEAST_DAMPING * self.m1 * self.natural_frequency() } else { 0.0 };
        Ok(Primary {
            mass: Positive::new(self.m1)?,
            damping: NonNegative::new(self.c1.max(least))?,
            stiffness: NonNegative::new(self.k1)?,
        })
    }

    /// The band of a harmonic in multiples of the natural frequency; `[1, 1]` for a history.
    fn driven(&self) -> [f64; 2] {
        self.driving.band().map_or([1.0; 2], |band| over_natural(band, self.natural_frequency()))
    }

    /// The forcing; a harmonic has the frequency of the band nearest to the natural one.
    fn forcing(&self) -> Result<Forcing, Error> {
        self.driving.forcing(self.natural_frequency())
    }

    /// The run under a shock or a record; none under a harmonic.
    pub(super) fn run(&self) -> Option<Window> {
        self.driving.run(self.period())
    }

    /// Den Hartog's k2 (N/m) and c2 (N·s/m), and the largest displacement (m) and goal of the structure alone, steady over the band or in
    /// the run.
    fn scales(&self) -> Result<([f64; 2], f64, f64), Error> {
        let (primary, forcing) = (self.primary(true)?, self.forcing()?);
        let formula = den_hartog(&primary, self.mass);
        if let Some(run) = self.run() {
            let scene = Scene { primary, forcing, damper: None };
            let also = Some(Also { measures: PerMeasure::EVERY, from: 0.0 });
            let ask = Ask { measure: self.goal, also, ..Ask::default() };
            let found = extremes(&scene, run, &Settings::default(), ask)?;
            return Ok((formula, found.reached.get(Measure::Displacement), found.largest.value));
        }
        let (bare, band) = (Bare::new(&primary, &forcing), self.driving.band().unwrap_or_default());
        let reach = bare.steady_max(Measure::Displacement, band).value;
        Ok((formula, reach, bare.steady_max(self.goal, band).value))
    }

    /// The study of the TMD, k2 and c2 free, without walls: steady, in closed form, or the run under a shock or a record.
    pub fn tmd(&self) -> Result<Study, Error> {
        let ([k2, c2], _, size) = self.scales()?;
        let stiffest = |factor: f64| springs_for([1.0, factor], self.driven())[1];
        let most = self.k2_max.unwrap_or(stiffest(STIFFEST) * k2);
        let softest = springs_for([0.05, 1.0], self.driven())[0];
        let axis = |from: f64, to: f64| json!({ "from": from, "to": to, "points": 21, "scale": "log" });
        // A TMD touches no wall; its stroke may take half of the cavity.
        let mut limits = self.limits;
        let half = limits.get(Limit::Cavity).map(|cavity| 0.5 * cavity);
        let stroke = Limit::Of(Measure::Stroke);
        let least = limits.get(stroke).into_iter().chain(half).fold(f64::INFINITY, f64::min);
        if let Ok(least) = Positive::new(least) {
            limits = limits.with(stroke, least);
        }
        let of_walls = |limit: &Limit| match limit {
            Limit::Cavity => true,
            Limit::Of(measure) => measure.is_of_walls(),
        };
        let kept: Vec<Limit> = limits.set().filter(|limit| !of_walls(limit)).collect();
        let optimize = json!({
            "vary": ["k2", "c2"],
            "objective": self.objective(true),
            "bounds": { "k2": [0, most], "c2": [0, LOCKED * c2] },
            "limits": kept.into_iter().map(|limit| (limit.name().to_owned(), json!(limits.get(limit)))).collect::<serde_json::Map<_, _>>(),
            "surf": { "k2": axis(softest * k2.min(most), (stiffest(4.0) * k2).min(most)), "c2": axis(0.05 * c2, 20.0 * c2) },
            "refine": { "starts": 3, "scaled": true, "TolX": 1e-10, "TolFun": 1e-12 * size }
        });
        self.study("tmd", json!({ "m2": self.mass, "k2": k2.min(most), "c2": c2 }), optimize)
    }

    /// The study of the SSVI NES: runs from rest, all four parameters free.
    pub fn ssvi(&self) -> Result<Study, Error> {
        let ([k2, c2], reach, size) = self.scales()?;
        let most = self.k2_max.unwrap_or(springs_for([1.0, 4.0], self.driven())[1] * k2);
        let axis = |from: f64, to: f64, scale: &str, points: u32| json!({ "from": from, "to": to, "points": points, "scale": scale });
        let stiffest = k2.min(most);
        // Descents explore the whole range of a gap, so it is kept no wider than necessary.
        let zeta = self.c1 / (2.0 * self.m1 * self.natural_frequency());
        let most_gap = reach * (HARDLY_DAMPED / zeta).clamp(1.0, MOST_ROOM);
        let mut limits = json!(self.limits);
        if !self.limits.is_empty() && self.run().is_none() {
            limits["from"] = json!(self.steady().from);
        }
        let optimize = json!({
            "vary": ["k2", "c2", "D", "C"],
            "objective": self.objective(false),
            "bounds": { "k2": [0, most], "c2": [0, 50.0 * c2], "D": [0, 4.0 * most_gap], "C": [0, 8.0 * most_gap] },
            "limits": limits,
            "surf": {
                "k2": axis(0.08 * stiffest, stiffest, "log", 6),
                "c2": axis(0.2 * c2, 4.0 * c2, "log", 6),
                "D": axis(0.0, 0.8 * reach, "linear", 5),
                "C": axis(0.2 * reach, 2.6 * reach, "linear", 5)
            },
            "coarse": { "rtol": 1e-4, "peaks": false },
            "refine": { "starts": 2, "scaled": true, "TolX": 1e-3, "TolFun": 1e-5 * size, "MaxFunEvals": 300 }
        });
        let damper = json!({
            "m2": self.mass, "k2": (0.1 * k2).min(most), "c2": c2, "D": 0.2 * reach, "C": reach,
            "contact": self.contact()?
        });
        self.study("ssvi", damper, optimize)
    }

    /// The objective over the band, or in the run under a shock or a record, and over all k1.
    fn objective(&self, steady: bool) -> Value {
        let mut objective = json!({ "quantity": self.goal });
        if let Some(error) = self.k1_error {
            let [from, to] = [1.0 - error, 1.0 + error].map(|share| share * self.k1);
            let band = Band { from, to, samples: STIFFNESSES };
            objective["k1"] = match steady && self.driving.band().is_some() {
                true => json!({ "range": { "from": from, "to": to, "samples": STIFFNESSES } }),
                false => json!({ "set": (0..STIFFNESSES).map(|i| band.at(i)).collect::<Vec<_>>() }),
            };
        }
        if let Some([from, to]) = self.driving.band() {
            objective["omega"] = json!({ "from": from, "to": to, "samples": 31 });
            if steady {
                objective["response"] = json!("steady");
            }
        }
        objective
    }

    /// The window of a damper with walls under a harmonic: as long as the time before it, in periods of the structure, and at least
    /// [`SLOWEST`] periods of the slowest forcing.
    fn steady(&self) -> Window {
        let slowest = self.driving.band().map_or(0.0, |[from, _]| SLOWEST * TAU / from);
        let [from, length] = [PASSED, PERIODS - PASSED].map(|periods| (periods * self.period()).max(slowest));
        Window { from, to: from + length }
    }

    /// The natural period, s.
    fn period(&self) -> f64 {
        TAU / self.natural_frequency()
    }

    /// The walls of the damper; if none are given, the paper's, scaled to the structure.
    pub fn contact(&self) -> Result<Surfaces, Error> {
        let mass = Positive::new(self.mass)?;
        let Some(Wall { radius, modulus, poisson, restitution }) = self.wall else {
            let (_, reach, _) = self.scales()?;
            return Ok(Surfaces::for_motion(mass, self.natural_frequency(), reach)?);
        };
        let paper = Surfaces::for_mass(mass)?;
        let (radius, modulus, steel) =
            (Positive::new(radius)?, Positive::new(modulus)?, Positive::new(STEEL)?);
        let poisson = PoissonRatio::new(poisson)?;
        let loss = restitution.map(Restitution::new).transpose()?.map_or(paper.loss, Loss::Restoring);
        let walls = Surfaces { radius, young_1: steel, young_3: steel, loss, ..paper };
        Ok(Surfaces { young_2: modulus, young_4: modulus, poisson_2: poisson, poisson_4: poisson, ..walls })
    }

    /// A study whose window is that of the shock or record, or [`Self::steady`].
    fn study(&self, name: &str, damper: Value, optimize: Value) -> Result<Study, Error> {
        let Window { from, to } = self.run().unwrap_or_else(|| self.steady());
        let study = json!({
            "name": name,
            "scene": { "primary": self.primary(false)?, "forcing": self.forcing()?, "damper": damper },
            "window": { "t0": from, "T": to },
            "optimize": optimize
        });
        Ok(from_text(&study.to_string(), "design")?)
    }
}

/// Young's modulus of steel, N/m².
pub const STEEL: f64 = 2.1e11;
