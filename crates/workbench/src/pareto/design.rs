//! A design of `fronts`, evaluated on the samples of the study of fronts, and its comparison with others.

use retune_optim::{Evaluation, PerLimit};
use retune_study::{Setting, Study, Sweep};
use std::cmp::Ordering;

/// E1max that differs by less than this share is the same.
pub const SAME: f64 = 0.01;

/// A design, evaluated on the samples of the study of fronts.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The number of its damper.
    pub damper: usize,
    /// k2 (N/m), c2 (N·s/m), D (m), C (m).
    pub at: [f64; 4],
    /// The worst E1max over the band, J.
    pub e1_max: f64,
    /// The largest stroke (spring deflection |x2 - x1 - D|), m, and contact force, N, in any run.
    pub stroke: f64,
    pub force: f64,
    /// The verdict of its certificate.
    pub verdict: &'static str,
}

impl Design {
    /// By how much it is beyond a bound, as a share of it.
    pub fn excess(&self, sweep: Sweep, bound: f64) -> f64 {
        let reached = if sweep == Sweep::K2 { self.at[0] } else { self.stroke };
        (reached / bound - 1.0).max(0.0)
    }

    /// Whether it is of the same damper and has nearly the same E1max.
    pub fn is_like(&self, other: &Self) -> bool {
        self.damper == other.damper && (self.e1_max / other.e1_max - 1.0).abs() < SAME
    }

    /// Whether it dominates `other`: is as good in E1max, stroke, force and k2, and better in one of them.
    pub fn beats(&self, other: &Self) -> bool {
        let all = |design: &Self| [design.e1_max, design.stroke, design.force, design.at[0]];
        let pairs = || all(self).into_iter().zip(all(other));
        pairs().all(|(own, other)| own <= other) && pairs().any(|(own, other)| own < other)
    }

    /// Its fields in a table.
    pub fn fields(&self) -> String {
        let Self { at: [k2, c2, d, c], e1_max, stroke, force, verdict, .. } = self;
        format!("{e1_max},{k2},{c2},{d},{c},{stroke},{force},{verdict}")
    }
}

/// E1max of a design as it stands in the tables, J: the worst over the band of its study on so many samples.
pub fn energy(study: &Study, samples: usize, at: [f64; 4]) -> Option<f64> {
    Some(look(&finer(study, samples, at)?)?.energy)
}

/// A study with a design in its scene, its band on so many samples; none where there is no such scene.
pub fn finer(study: &Study, samples: usize, at: [f64; 4]) -> Option<Study> {
    let mut study = study.clone();
    study.scene = study.scene_with(&Setting::design(at)).ok()?;
    if let Some(band) = study.optimize.as_mut().and_then(|optimize| optimize.objective.omega.as_mut()) {
        band.samples = samples;
    }
    Some(study)
}

/// The worst of the scene of a study over its band; none where it cannot be run.
pub fn look(study: &Study) -> Option<Evaluation> {
    // Limits that every run breaks: they have the largest stroke and force searched for, peaks between samples included.
    let mut goal = study.goal();
    goal.limits.most = PerLimit([Some(f64::MIN_POSITIVE), Some(f64::MIN_POSITIVE), None]);
    goal.evaluate(&study.scene, &study.solver.settings(), f64::INFINITY).ok()
}

/// The design that keeps a bound first, then that which is beyond it by less.
pub fn by_excess(a: &Design, b: &Design, sweep: Sweep, bound: f64) -> Ordering {
    let [own, other] = [a, b].map(|design| design.excess(sweep, bound));
    own.total_cmp(&other).then(a.e1_max.total_cmp(&b.e1_max))
}
