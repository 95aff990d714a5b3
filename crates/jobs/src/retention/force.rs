//! The effect of a smaller force on a tuning: E1max of the nominal designs, as a share of that without a damper. A linear damper keeps its
//! share; one with gaps is tuned for one force, unless its gaps are in proportion to it.

use super::tuned::{Tuned, Tuning, bare, energy};
use crate::columns;
use rayon::prelude::*;
use retune_model::{Design, Measure, Parameter};
use retune_report::cells;
use retune_report::table::{Column, Table};
use retune_study::{Setting, Study};

/// Number of forces below that of the study, in steps of a factor of 2^(-1/4): down to an eighth.
const STEPS: i32 = 12;
/// Number of steps that halve it.
pub const HALF: usize = 4;
/// The names in the table of gaps kept as designed, and of gaps in proportion to the force.
pub const GAPS: [&str; 2] = ["kept", "in proportion"];
/// Relative difference of shares below which they count as independent of the force.
const SAME: f64 = 1e-3;

/// E1max of a design under smaller and smaller forces.
#[derive(Debug)]
pub struct Forced {
    /// The index of the damper whose nominal design it is.
    pub damper: usize,
    /// Whether D and C are in proportion to the force.
    pub proportional: bool,
    /// The amplitude of the forcing, SI unit, and E1max with and without the damper, J; that of the study first.
    pub points: Vec<(f64, [f64; 2])>,
}

impl Forced {
    /// E1max as a share of that without a damper, after `step` steps.
    pub fn share(&self, step: usize) -> f64 {
        self.points.get(step).map_or(f64::NAN, |(_, [with, without])| with / without)
    }

    /// Whether its share is the same under every force.
    pub fn is_constant(&self) -> bool {
        (0..self.points.len()).all(|step| (self.share(step) / self.share(0) - 1.0).abs() < SAME)
    }
}

/// The parameter of the forcing amplitude; none for a forcing given in time.
pub fn amplitude(study: &Study) -> Option<Parameter> {
    study.scene.forcing.amplitude().map(|(parameter, _)| parameter)
}

/// The nominal designs under smaller forces; those whose share changes also with gaps in proportion to the force.
pub fn forced(dampers: &[Tuned]) -> Vec<Forced> {
    let mut all = Vec::new();
    for (number, damper) in dampers.iter().enumerate() {
        let (at, study) = (damper.of(Tuning::Nominal), damper.study());
        let nominal = amplitude(study).and_then(|amplitude| study.value_of(amplitude));
        let Some((at, nominal)) = at.zip(nominal) else { continue };
        let series = |gaps: &str| {
            let one = |step: i32| {
                let force = nominal * 2_f64.powf(-0.25 * f64::from(step));
                (force, under(study, damper.samples, &at, gaps, force).unwrap_or([f64::NAN; 2]))
            };
            let proportional = gaps == GAPS[1];
            Forced { damper: number, proportional, points: (0..=STEPS).into_par_iter().map(one).collect() }
        };
        let kept = series(GAPS[0]);
        let depends = !kept.is_constant();
        all.push(kept);
        all.extend(depends.then(|| series(GAPS[1])));
    }
    all
}

/// E1max of a design under a force, and that without a damper, J.
pub fn under(study: &Study, samples: Option<usize>, at: &Design, gaps: &str, force: f64) -> Option<[f64; 2]> {
    let amplitude = amplitude(study)?;
    let ratio = force / study.value_of(amplitude)?;
    let share = |variable: Parameter| match variable {
        Parameter::D | Parameter::C if gaps == GAPS[1] => ratio,
        _ => 1.0,
    };
    let at = Design::new(|variable| share(variable) * at.get(variable)).ok()?;
    let study = study.with(&[Setting::new(amplitude, force)]).ok()?;
    let k1 = study.scene.primary.stiffness.get();
    Some([energy(&study, samples, &at, k1)?, bare(&study, k1)?])
}

pub fn table(dampers: &[Tuned], all: &[Forced]) -> Table {
    let amplitude = dampers.first().and_then(|damper| amplitude(damper.study())).unwrap_or(Parameter::P);
    let mut table = columns::table(&["damper", "gaps", amplitude.symbol(), "E1max"]);
    table.columns.push(Column::new("none", Measure::Energy.unit()));
    for of in all {
        let (name, gaps) = (dampers[of.damper].name.as_str(), GAPS[usize::from(of.proportional)]);
        for &(force, [with, without]) in &of.points {
            if with.is_finite() && without.is_finite() {
                table.push(cells![name, gaps, force, with, without]);
            }
        }
    }
    table
}
