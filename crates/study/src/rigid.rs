//! What a study with rigid walls may not ask for: their impacts are jumps of the state, with a force that has no bound.

use super::format::Study;
use super::rule::Rule;
use retune_model::{Coupled, Measure, Side};
use retune_optim::Limit;
use retune_solver::Method;

impl Study {
    /// Checks a study with rigid walls.
    pub(super) fn check_rigid(&self) -> Result<(), Rule> {
        let Some(damper) =
            self.scene.damper.filter(|damper| damper.contact.is_some_and(|walls| walls.rigid().is_some()))
        else {
            return Ok(());
        };
        let refuse = |field: &str, value: String, allowed| {
            Err(Rule::NotAllowed { field: field.to_owned(), value, allowed })
        };
        if self.solver.method != Method::Hybrid {
            let allowed = "hybrid: the walls are rigid, and a general method cannot follow impacts that take no time; or give Hertz's surfaces";
            return refuse("solver.method", self.solver.method.name().to_owned(), allowed);
        }
        const FORCE: &str = "no contact force or pressure: that of an impact with a rigid wall has no bound; limit the stroke, or give Hertz's surfaces";
        if self.quantity().is_of_walls() {
            return refuse("optimize.objective.quantity", self.quantity().name().to_owned(), FORCE);
        }
        for measure in Measure::ALL.into_iter().filter(|measure| measure.is_of_walls()) {
            if let Some(most) = self.goal().limits.get(Limit::Of(measure)) {
                return refuse(&format!("optimize.limits.{}", measure.name()), most.to_string(), FORCE);
            }
        }
        let system = Coupled::new(&self.scene.primary, &self.scene.forcing, &damper);
        let start = system.start();
        let inside = system.indentation(&start);
        if Side::BOTH.iter().any(|&side| inside[side as usize] > 0.0 && !system.rests_on(side, &start)) {
            let allowed = "a place from x1 to x1 + D + C: rigid walls let nothing in";
            return refuse("scene.forcing.start.x2", start[2].to_string(), allowed);
        }
        Ok(())
    }
}
