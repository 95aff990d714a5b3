//! The reference solutions, their uncertainty, and the horizon over which a motion can be predicted.

use crate::own;
use crate::record::{Found, errors};
use crate::scenes::Case;
use retune_dynamics::{Exponent, Stretch, follow};
use retune_solver::{Contacts, Method, Settings};
use std::error::Error;

/// The tolerance of the reference.
pub const REFERENCE: f64 = 1e-13;

/// The reference of a scene.
pub struct Reference {
    /// The hybrid at rtol 1e-13.
    pub found: Found,
    /// Difference of the hybrid at 1e-12 from it: E1max, final state, impact times (s).
    pub looser: [f64; 3],
    /// Difference of another method from it: DOP853 with located contacts at 1e-13.
    pub independent: [f64; 3],
    /// The largest Lyapunov exponent of the settled motion, 1/s; `None` without a damper (there it is `-c1 / (2 m1)`).
    pub exponent: Option<Exponent>,
    /// Mean rate (1/s) at which neighbouring motions diverge over the run itself.
    pub parting: Option<f64>,
}

impl Reference {
    /// Runs the scene by both methods.
    ///
    /// # Errors
    /// A run that failed.
    pub fn of(case: &Case) -> Result<Self, Box<dyn Error>> {
        let run = |method, rtol| own::run(case, &own::settings(method, Contacts::Located, rtol), false);
        let found = run(Method::Hybrid, REFERENCE)?;
        let omega = case.scene.forcing.frequency.get();
        let [looser, independent] = [run(Method::Hybrid, 1e-12)?, run(Method::Dop853, REFERENCE)?]
            .map(|other| errors(&other, &found, omega));
        let stretch = Stretch { settle: 100, observe: 200 };
        let exponent = match case.scene.damper {
            Some(_) => Some(follow(&case.scene, None, stretch, &Settings::default())?.exponent()),
            None => None,
        };
        let parting = crate::scenes::parting_rate(case)?;
        Ok(Self { found, looser, independent, exponent, parting })
    }

    /// The larger of the two differences for each measure: the uncertainty of the reference.
    pub fn uncertainty(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.looser[i].max(self.independent[i]))
    }

    /// Lyapunov time, s: in which neighbours diverge by a factor e, by the larger of the two rates; `None` if they converge.
    pub fn lyapunov_time(&self) -> Option<f64> {
        let rates = [self.parting, self.exponent.map(|e| e.value)];
        let rate = rates.into_iter().flatten().fold(f64::NEG_INFINITY, f64::max);
        (rate > 1e-3).then_some(1.0 / rate)
    }

    /// Time over which the motion can be predicted to 1e-6 in double precision: `ln 1e10` Lyapunov times, s.
    pub fn horizon(&self) -> f64 {
        self.lyapunov_time().map_or(f64::INFINITY, |time| 1e10_f64.ln() * time)
    }
}
