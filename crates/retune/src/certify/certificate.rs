//! What a certificate says, and the rule of its verdict.

mod text;

use crate::optimize::log::short;
use crate::study::Study;
use crate::summary::{Design, MadeBy};
use retune_atlas::{Kind, Regime};
use retune_optim::Evaluation;
use retune_solver::Method;
use serde::Serialize;

/// Largest error bar of a predictable E1max, as a share of it.
const PREDICTABLE: f64 = 1e-3;
/// Width of the neighbours' E1max, as a share of that of the design, above which it is wide; an error bar as wide counts as much.
const WIDE: f64 = 0.05;
/// Growth of E1max within 1 % of any one parameter above which an optimum is sharp.
const SHARP: f64 = 0.1;
/// How many times the samples of a band are taken to see what they missed.
pub(super) const FINER: usize = 4;
/// The shares of the neighbours between which the width is measured.
const WITHIN: [f64; 2] = [0.05, 0.95];

/// A certificate. SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    #[serde(flatten)]
    made_by: MadeBy,
    design: Design,
    /// The objective's value, J.
    #[serde(rename = "E1max")]
    e1_max: f64,
    /// Largest difference of a rung of the ladder to the worst run, or of `finer` to the value, J.
    error_bar: f64,
    predictable: bool,
    verdict: Verdict,
    /// The verdict in words.
    words: String,
    /// What the verdict means.
    rule: String,
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

/// A verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Small errors change little.
    Robust,
    /// Small errors change much, in a regular way or at an edge.
    Sharp,
    /// The motion is irregular, and the value one of many that equal designs have.
    Draw,
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

/// The short form that `optimum.json` has.
#[derive(Clone, Debug, Serialize)]
pub struct Short {
    verdict: Verdict,
    words: String,
    error_bar: f64,
    predictable: bool,
    regime: String,
    exponent: f64,
}

impl Verdict {
    /// Its word.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Robust => "robust",
            Self::Sharp => "sharp",
            Self::Draw => "draw",
        }
    }
}

impl Short {
    /// The verdict.
    pub fn verdict(&self) -> Verdict {
        self.verdict
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
    #[expect(clippy::too_many_arguments, reason = "each is a measurement of its own")]
    pub(super) fn new(
        study: &Study,
        made_by: MadeBy,
        own: &Evaluation,
        worst_run: WorstRun,
        ladder: Vec<Rung>,
        finer: Option<f64>,
        sensitivity: Vec<Sensitivity>,
        neighbourhood: Neighbourhood,
        motion: Motion,
    ) -> Self {
        let off = |rung: &Rung| (rung.e1_max - worst_run.e1_max).abs();
        let missed = finer.map_or(0.0, |finer| (finer - own.energy).abs());
        let error_bar = ladder.iter().map(off).fold(missed, f64::max);
        let mut certificate = Self {
            made_by,
            design: study.scene.damper.as_ref().map(Design::new).unwrap_or_default(),
            e1_max: own.energy,
            error_bar,
            predictable: error_bar <= PREDICTABLE * worst_run.e1_max,
            verdict: Verdict::Robust,
            words: String::new(),
            rule: rule(),
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

    fn judge(&self) -> (Verdict, String) {
        let Self { e1_max, error_bar, neighbourhood, .. } = self;
        let Neighbourhood { low, high, errors, .. } = neighbourhood;
        // Not a number is no evidence of anything small.
        let small = |value: f64| value <= WIDE * e1_max;
        let narrow = small(neighbourhood.width()) && small(*error_bar);
        let near =
            format!("designs within {} % of it have {} to {} J", 100.0 * errors, short(*low), short(*high));
        if !narrow && (self.motion.irregular || !self.predictable) {
            let width = short(neighbourhood.width().max(*error_bar));
            return (Verdict::Draw, format!("a draw from a distribution of width {width} J: {near}"));
        }
        if !narrow {
            return (Verdict::Sharp, format!("sharp: {near}"));
        }
        let worst = self.worst_error();
        let said =
            worst.map_or(String::new(), |Sensitivity { parameter, worst, worst_at_percent, .. }| {
                format!("{parameter} off by {worst_at_percent:+} % gives {} J", short(*worst))
            });
        match worst {
            Some(worst) if worst.worst > (1.0 + SHARP) * e1_max => {
                (Verdict::Sharp, format!("sharp: {said}, {} times as much", short(worst.worst / e1_max)))
            }
            _ => (Verdict::Robust, format!("robust: at worst {said}")),
        }
    }

    /// The parameter that 1 % of harms most.
    fn worst_error(&self) -> Option<&Sensitivity> {
        self.sensitivity.iter().max_by(|a, b| a.worst.total_cmp(&b.worst))
    }

    /// The short form.
    pub fn short(&self) -> Short {
        let Self { verdict, words, error_bar, predictable, motion, .. } = self.clone();
        let Motion { regime, exponent, .. } = motion;
        Short { verdict, words, error_bar, predictable, regime, exponent }
    }
}

fn rule() -> String {
    format!(
        "wide: the error bar, or the width of the middle 90 % of the neighbours, is above {} % of E1max; draw: wide, and the \
         motion of the worst run is irregular (chaotic, through a chaotic transient, or without a period) or not predictable; sharp: \
         wide, or 1 % of one parameter raises E1max by more than {} %; robust: none of these. predictable: the error bar is at most \
         {} % of the worst run's E1max",
        100.0 * WIDE,
        100.0 * SHARP,
        100.0 * PREDICTABLE
    )
}
