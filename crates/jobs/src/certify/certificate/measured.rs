//! The measurements that a certificate rests on.

use super::limits::Kept;
use super::motions::{Margin, Motions};
use crate::amount::Amount;
use retune_dynamics::{Kind, Regime};
use retune_solver::Method;
use serde::Serialize;

/// Refinement of the sampled bands for `finer`.
pub const FINER: usize = 4;
/// The quantiles of the neighbours that bound their width.
const WITHIN: [f64; 2] = [0.05, 0.95];

#[derive(Clone, Copy, Debug, Serialize)]
pub struct WorstRun {
    #[serde(flatten)]
    pub value: Amount,
    pub omega: f64,
    pub k1: f64,
    /// φ of the force P cos(ωt + φ), rad.
    pub phase: f64,
}

/// The value of the worst run by a method; null where it could not finish it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Run {
    pub method: Method,
    pub rtol: f64,
    #[serde(flatten)]
    pub value: Amount,
}

#[derive(Clone, Debug, Serialize)]
pub struct Motion {
    pub regime: String,
    /// The regime in words.
    #[serde(skip)]
    pub sentence: String,
    /// Whether it is chaotic, became periodic through chaos, or shows no period.
    pub irregular: bool,
    /// Largest Lyapunov exponent with its standard error, 1/s.
    pub exponent: f64,
    pub exponent_error: f64,
    /// Contacts with the structure and with the obstacle in a period of the force.
    pub contacts_per_period: [f64; 2],
    pub confidence: f64,
}

/// The sensitivity of the objective to an error of one parameter.
#[derive(Clone, Debug, Serialize)]
pub struct Sensitivity {
    pub parameter: &'static str,
    pub value: f64,
    /// Slope, the change for 1 % more of the parameter.
    pub slope_per_percent: f64,
    /// The largest value within 1 % of the parameter, and its error; null if a design there cannot be run.
    pub worst: f64,
    pub worst_at_percent: f64,
}

/// The distribution of the objective among designs within manufacturing errors.
#[derive(Clone, Debug, Serialize)]
pub struct Neighbourhood {
    pub members: usize,
    /// Largest relative error of k1, k2, c2, D and C.
    pub errors: f64,
    /// 5 %, 50 % and 95 % of the members have less; null where they cannot be run.
    pub low: f64,
    pub median: f64,
    pub high: f64,
}

/// All measurements of a design that a certificate rests on.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// The limits at the design and near it, where the study has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits: Option<Kept>,
    /// Whether the damper has walls: without them no motion is chaotic.
    #[serde(skip)]
    pub has_walls: bool,
    /// The run with the largest value of those behind the value.
    pub worst_run: WorstRun,
    pub convergence: Vec<Run>,
    /// The objective with four times the samples of its bands and ranges, if it has sampled ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finer: Option<f64>,
    pub motion: Motion,
    /// Every motion that was found, from rest and from other starts, where the damper can strike and the force has a period.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motions: Option<Motions>,
    /// How far the force and the parameters can change before another motion has 5 % more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<Margin>,
    pub sensitivity: Vec<Sensitivity>,
    pub neighbourhood: Neighbourhood,
}

impl Run {
    pub fn is_finished(&self) -> bool {
        self.value.value.is_finite()
    }

    /// Difference to the worst run by the study's method.
    pub fn error(&self, worst: &WorstRun) -> f64 {
        (self.value.value - worst.value.value).abs()
    }
}

impl Motion {
    /// A motion without a period to classify it by, as `regime` and `sentence` say: a free decay, the response to a pulse or record, or a
    /// random motion.
    pub fn without_period(regime: &str, sentence: &str) -> Self {
        Self {
            regime: regime.to_owned(),
            sentence: sentence.to_owned(),
            irregular: false,
            exponent: f64::NAN,
            exponent_error: f64::NAN,
            contacts_per_period: [f64::NAN; 2],
            confidence: 1.0,
        }
    }

    pub fn new(regime: &Regime) -> Self {
        let periods = match (regime.kind, regime.period) {
            (Kind::Periodic, Some(n)) => n as f64,
            _ => 1.0,
        };
        Self {
            regime: regime.label(),
            sentence: regime.sentence(),
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
    pub fn new(parameter: &'static str, value: f64, errors: &[f64], energies: &[f64]) -> Self {
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
    pub fn new(errors: f64, mut energies: Vec<f64>) -> Self {
        energies.sort_by(f64::total_cmp);
        let members = energies.len();
        let at = |share: f64| {
            let place = (share * members as f64).ceil() as usize;
            energies.get(place.clamp(1, members.max(1)) - 1).copied().unwrap_or(f64::NAN)
        };
        Self { members, errors, low: at(WITHIN[0]), median: at(0.5), high: at(WITHIN[1]) }
    }

    pub fn width(&self) -> f64 {
        self.high - self.low
    }
}
