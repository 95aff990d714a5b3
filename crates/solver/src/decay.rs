//! How long the motion of the structure takes to decay once the forcing has ended.

use crate::energy_bound;
use crate::error::SolverError;
use crate::motion::segment::Segment;
use crate::observe::falls::falls;
use crate::observe::observer::{Observer, Unobserved};
use crate::observe::quantity::{BareEnergy, PrimaryEnergy, Quantity, rates_in};
use crate::observe::search::{Place, Search, in_theta};
use crate::plan::{Plan, Request};
use crate::response::Extreme;
use crate::run::Follow;
use crate::settings::{Settings, Window};
use crate::simulate::e1_max;
use retune_model::{Bare, Coupled, Scene};

/// The share of the largest energy below which a motion has decayed.
pub const LEFT: f64 = 0.05;

/// Limit on maxima above the level that are located in one segment of the motion, which is shorter than a period of its fastest
/// part.
const MOST_MAXIMA: usize = 16;

/// The decay time, s: how long after the end of the forcing the energy of the structure exceeds a share [`LEFT`] of its largest value in the
/// run from t = 0 to `to` (s) for the last time; infinite if it does so at `to`. None if the forcing has no end before `to`.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn decay_time(scene: &Scene, to: f64, settings: &Settings) -> Result<Option<f64>, SolverError> {
    Ok(decay(scene, to, settings)?.map(|decay| decay.value))
}

/// [`decay_time`], and the time (s) at which the energy is at that share, at the latest `to`.
pub(crate) fn decay(scene: &Scene, to: f64, settings: &Settings) -> Result<Option<Extreme>, SolverError> {
    let end = scene.forcing.end();
    if end >= to {
        return Ok(None);
    }
    let level = LEFT * e1_max(scene, Window { from: 0.0, to }, settings, f64::INFINITY)?.value;
    let last = last_above(scene, level, Window { from: end, to }, settings)?;
    Ok(Some(Extreme { value: last - end, time: last.min(to) }))
}

/// When the energy of the structure exceeds a level (J) in a window for the last time, s: the beginning of the window if it never does, infinite
/// if it does at its end.
///
/// # Errors
/// [`SolverError`] with the time reached.
pub fn last_above(
    scene: &Scene,
    level: f64,
    window: Window,
    settings: &Settings,
) -> Result<f64, SolverError> {
    let found = match &scene.damper {
        None => {
            let system = Bare::new(&scene.primary, &scene.forcing);
            last_above_in(&system, BareEnergy::new(&system), level, window, settings)
        }
        Some(damper) => {
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            last_above_in(&system, PrimaryEnergy::new(&system), level, window, settings)
        }
    };
    found.map_err(|error| energy_bound::clamp_error_time(window, error))
}

fn last_above_in<S: Follow<N>, const N: usize>(
    system: &S,
    quantity: impl Quantity<N>,
    level: f64,
    window: Window,
    settings: &Settings,
) -> Result<f64, SolverError> {
    let mut above = LastAbove { search: Search::new(quantity), level, last: window.from, is_above: false };
    let plan = Plan::of(system, settings, Request::Motion);
    system.follow(plan, window, settings, &mut Unobserved, &mut above)?;
    Ok(if above.is_above { f64::INFINITY } else { above.last })
}

/// Finds the last time at which a quantity exceeds a level, proven as in the search for a largest value: see `docs/bounds.md`.
struct LastAbove<Q> {
    search: Search<Q>,
    level: f64,
    last: f64,
    /// Whether the quantity is above the level at the end of the latest segment.
    is_above: bool,
}

impl<Q> LastAbove<Q> {
    fn place<const N: usize>(&self, segment: &dyn Segment<N>, theta: f64) -> Place<N>
    where
        Q: Quantity<N>,
    {
        let [first, last] = segment.ends();
        let knot = if theta == 0.0 {
            *first
        } else if theta == segment.length() {
            *last
        } else {
            segment.at(theta)
        };
        (theta, knot, in_theta(rates_in(segment, &knot, &self.search.quantity), knot.clock))
    }
}

impl<const N: usize, Q: Quantity<N>> Observer<N> for LastAbove<Q> {
    fn segment(&mut self, segment: &dyn Segment<N>) {
        self.is_above = false;
        if self.search.quantity.form().upper_bound(segment.energy()) <= self.level {
            return;
        }
        let (mut from, to) = (self.place(segment, 0.0), self.place(segment, segment.length()));
        if to.2[0] > self.level {
            (self.last, self.is_above) = (to.1.t, true);
            return;
        }
        for _ in 0..MOST_MAXIMA {
            if from.2[0] > self.level {
                let excess = |theta: f64| self.place(segment, theta).2[0] - self.level;
                let theta = falls(excess, (from.0, from.2[0] - self.level), (to.0, to.2[0] - self.level));
                from = self.place(segment, theta);
                self.last = from.1.t;
            }
            // Whether the quantity rises above the level again, and where.
            self.search.restart(Extreme { value: self.level, time: f64::NAN });
            let remainder = self.search.quintic_error(segment, &from, &to, true);
            self.search.begin(segment, &from, &to, remainder);
            let Extreme { value, time } = self.search.record;
            if self.search.doubt() > 0.0 {
                break;
            }
            if value <= self.level {
                return;
            }
            let highest =
                falls(|theta| time - segment.at(theta).t, (from.0, time - from.1.t), (to.0, time - to.1.t));
            from = self.place(segment, highest);
            self.last = from.1.t;
        }
        // Undecided: it may be above the level up to the end of the segment.
        self.last = to.1.t;
    }

    fn search_work(&self) -> u64 {
        self.search.search_work
    }
}
