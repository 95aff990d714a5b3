//! What a certificate says.

mod limits;
mod text;
mod verdict;

pub use limits::{Kept, Near};
pub use verdict::Verdict;

use crate::Error;
use crate::summary::{MadeBy, TunedDamper};
use retune_dynamics::{Kind, Regime};
use retune_model::Damper;
use retune_optim::Evaluation;
use retune_solver::Method;
use retune_study::Study;
use serde::Serialize;

/// How many times the samples of a band are taken to see what they missed.
pub(super) const FINER: usize = 4;
/// The shares of the neighbours between which the width is measured.
const WITHIN: [f64; 2] = [0.05, 0.95];

/// A certificate. SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    #[serde(flatten)]
    made_by: MadeBy,
    design: TunedDamper,
    /// The objective's value, J.
    #[serde(rename = "E1max")]
    e1_max: f64,
    /// Largest difference of a rung of the ladder to the worst run, or of `finer` to the value, J.
    error_bar: f64,
    predictable: bool,
    /// null where the design breaks a limit.
    verdict: Option<Verdict>,
    /// The verdict in words.
    words: String,
    /// What the verdict means.
    rule: String,
    /// How the design and those near it keep the limits, where the study has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    limits: Option<Kept>,
    /// The run with the largest E1max that the value is made of.
    worst_run: WorstRun,
    ladder: Vec<Rung>,
    /// The objective with four times the samples of its bands, J, where it has bands that are sampled.
    #[serde(skip_serializing_if = "Option::is_none")]
    finer: Option<f64>,
    motion: Motion,
    sensitivity: Vec<Sensitivity>,
    neighbourhood: Neighbourhood,
}

/// The run with the largest E1max.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct WorstRun {
    #[serde(rename = "E1max")]
    pub e1_max: f64,
    pub omega: f64,
    pub k1: f64,
    /// φ of the force P cos(ωt + φ), rad.
    pub phase: f64,
}

/// E1max of the worst run by a method.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Rung {
    pub method: Method,
    pub rtol: f64,
    #[serde(rename = "E1max")]
    pub e1_max: f64,
}

/// The motion of the worst run.
#[derive(Clone, Debug, Serialize)]
pub struct Motion {
    regime: String,
    /// Whether it is chaotic, became periodic through chaos, or shows no period.
    irregular: bool,
    /// Largest Lyapunov exponent with its standard error, 1/s.
    exponent: f64,
    exponent_error: f64,
    /// Contacts with the structure and with the obstacle in a period of the force.
    contacts_per_period: [f64; 2],
    confidence: f64,
}

/// How E1max takes an error of one parameter.
#[derive(Clone, Debug, Serialize)]
pub struct Sensitivity {
    parameter: &'static str,
    value: f64,
    /// Slope, J for 1 % more of the parameter.
    slope_per_percent: f64,
    /// The largest E1max within 1 % of it, J, and where; null if a design there cannot be run.
    worst: f64,
    worst_at_percent: f64,
}

/// How E1max is distributed among designs that nobody could tell apart.
#[derive(Clone, Debug, Serialize)]
pub struct Neighbourhood {
    members: usize,
    /// k1, k2, c2, D and C are off by at most this share.
    errors: f64,
    /// 5 %, 50 % and 95 % of the members have less, J; null where they cannot be run.
    low: f64,
    median: f64,
    high: f64,
}

/// All that was measured of a design; see [`Certificate`].
pub(super) struct Measured {
    pub worst_run: WorstRun,
    pub ladder: Vec<Rung>,
    pub finer: Option<f64>,
    pub motion: Motion,
    pub sensitivity: Vec<Sensitivity>,
    pub neighbourhood: Neighbourhood,
    pub limits: Option<Kept>,
}

/// The short form that `optimum.json` has.
#[derive(Clone, Debug, Serialize)]
pub struct Short {
    verdict: Option<Verdict>,
    words: String,
    error_bar: f64,
    predictable: bool,
    regime: String,
    exponent: f64,
}

impl Short {
    /// The verdict in a word.
    pub fn verdict(&self) -> &'static str {
        self.verdict.map_or("none", Verdict::name)
    }

    /// Refuses a design that breaks the limits of its study, for which there is no verdict.
    ///
    /// # Errors
    /// [`Error::Infeasible`].
    pub fn check_limits(&self, study: &str) -> Result<(), Error> {
        match self.verdict {
            Some(_) => Ok(()),
            None => Err(Error::Infeasible { name: study.to_owned(), words: self.words.clone() }),
        }
    }
}

impl Motion {
    pub(super) fn new(regime: &Regime) -> Self {
        let periods = match (regime.kind, regime.period) {
            (Kind::Periodic, Some(n)) => n as f64,
            _ => 1.0,
        };
        Self {
            regime: regime.label(),
            irregular: regime.transient.is_some()
                || !matches!(regime.kind, Kind::Periodic | Kind::AmplitudeModulated),
            exponent: regime.exponent.value,
            exponent_error: regime.exponent.error,
            contacts_per_period: regime.impacts.map(|impacts| impacts / periods),
            confidence: regime.confidence,
        }
    }
}

impl Sensitivity {
    /// From the energies at relative `errors`, which are symmetric about 0 and sorted.
    pub(super) fn new(parameter: &'static str, value: f64, errors: &[f64], energies: &[f64]) -> Self {
        let middle = errors.len() / 2;
        let slope = (energies[middle] - energies[middle - 1]) / (errors[middle] - errors[middle - 1]);
        let worst = (0..errors.len()).fold(0, |a, b| if energies[b] > energies[a] { b } else { a });
        Self {
            parameter,
            value,
            slope_per_percent: 0.01 * slope,
            worst: energies[worst],
            worst_at_percent: 100.0 * errors[worst],
        }
    }
}

impl Neighbourhood {
    pub(super) fn new(errors: f64, mut energies: Vec<f64>) -> Self {
        energies.sort_by(f64::total_cmp);
        let members = energies.len();
        let at = |share: f64| {
            let place = (share * members as f64).ceil() as usize;
            energies.get(place.clamp(1, members.max(1)) - 1).copied().unwrap_or(f64::NAN)
        };
        Self { members, errors, low: at(WITHIN[0]), median: at(0.5), high: at(WITHIN[1]) }
    }

    fn width(&self) -> f64 {
        self.high - self.low
    }
}

impl Certificate {
    pub(super) fn new(study: &Study, damper: &Damper, own: &Evaluation, measured: Measured) -> Self {
        let Measured { worst_run, ladder, finer, motion, sensitivity, neighbourhood, limits } = measured;
        let off = |rung: &Rung| (rung.e1_max - worst_run.e1_max).abs();
        let missed = finer.map_or(0.0, |finer| (finer - own.energy).abs());
        let error_bar = ladder.iter().map(off).fold(missed, f64::max);
        let mut certificate = Self {
            made_by: MadeBy::new(study),
            design: TunedDamper::of(damper),
            e1_max: own.energy,
            error_bar,
            predictable: verdict::is_predictable(error_bar, worst_run.e1_max),
            verdict: None,
            words: String::new(),
            rule: verdict::rule(limits.is_some()),
            limits,
            worst_run,
            ladder,
            finer,
            motion,
            sensitivity,
            neighbourhood,
        };
        (certificate.verdict, certificate.words) = certificate.judge();
        certificate
    }

    /// The short form.
    pub fn short(&self) -> Short {
        let Self { verdict, words, error_bar, predictable, motion, .. } = self.clone();
        let Motion { regime, exponent, .. } = motion;
        Short { verdict, words, error_bar, predictable, regime, exponent }
    }
}
