//! The contents of a page: the study, the stages of its search, and their results.

use crate::certify::Measured;
use crate::tune::band::{self, Rows};
use crate::tune::global::Explored;
use crate::tune::optimum::Optimum;
use crate::tune::refine::Refined;
use crate::tune::surf::Surf;
use retune_model::{Measure, Scene};
use retune_optim::{Evaluation, Goal, Limits, Unusable};
use retune_solver::Response;
use retune_study::{Search, Study};

/// The contents of a page.
pub(crate) struct Findings<'a> {
    pub study: &'a Study,
    pub search: &'a Search,
    pub surf: Option<&'a Surf>,
    pub explored: Option<&'a Explored>,
    pub refined: &'a Refined,
    pub optimum: &'a Optimum,
    pub evaluation: &'a Evaluation,
    /// The scene of the study with the tuned damper.
    pub tuned: Scene,
    /// The tuned scene at its worst frequency and stiffness.
    pub worst: Scene,
    pub response: &'a Response,
    /// The quantity over the band of the objective, if it has one.
    pub band: Option<Rows>,
    /// Refinements that start on the grid; they come before the others.
    pub on_grid: usize,
}

/// The alternatives to the tuned damper: the value of the objective, or why there is none.
pub(super) struct Compared {
    pub none: Result<Evaluation, Unusable>,
    pub study: Result<Evaluation, Unusable>,
}

impl Findings<'_> {
    /// The minimised quantity.
    pub fn quantity(&self) -> Measure {
        self.study.quantity()
    }

    pub fn measured(&self) -> &Measured {
        &self.optimum.certificate.measured
    }

    pub fn scenes(&self) -> [Scene; 3] {
        band::compared(self.study, self.tuned)
    }

    /// Evaluates the objective, regardless of limits, without a damper and with the study's damper.
    pub(super) fn compared(&self) -> Compared {
        let goal = Goal { limits: Limits::default(), ..self.study.goal() };
        let settings = self.study.solver.settings();
        let [none, study, _] = self.scenes();
        let value = |scene: &Scene| goal.evaluate(scene, &settings, f64::INFINITY);
        let (none, study) = rayon::join(|| value(&none), || value(&study));
        Compared { none, study }
    }

    /// The frequency of the worst run, rad/s.
    pub fn worst_omega(&self) -> f64 {
        self.worst.forcing.frequency.get()
    }

    /// Where a refinement began.
    pub fn origin(&self, run: usize) -> &'static str {
        if let Some(from) = self.refined.beyond(run) {
            return from.trim_start_matches("the ");
        }
        let explored = self.explored.map_or(0, |explored| explored.basins.len().min(self.search.starts));
        let ends = [self.on_grid, explored, self.search.given.len()];
        let names = ["grid", "global search", "given"];
        let mut before = 0;
        for (count, name) in ends.into_iter().zip(names) {
            before += count;
            if run < before {
                return name;
            }
        }
        "the study's damper"
    }
}
