//! The range of the relative displacement, from which stroke and contact forces follow.

use super::contact_forces::ContactForces;
use super::observer::{Impact, Observer, Path};
use super::quantity::RelativePosition;
use super::running_maximum::RunningMaximum;
use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::response::Extreme;
use retune_model::{Coupled, Measure, Side, hertz_force};

/// The ends of the relative displacement `x2 - x1`.
pub struct DisplacementRange<'a> {
    system: &'a Coupled,
    cutoff: f64,
    ends: [RunningMaximum<RelativePosition<'a>>; 2],
    /// The contact forces, where walls lose energy.
    forces: Option<ContactForces<'a>>,
    /// When a rigid wall was first struck, s.
    first_impact: Option<f64>,
}

impl<'a> DisplacementRange<'a> {
    /// Observes a damper; `cutoff` is kept for the reader of the range.
    pub fn new(system: &'a Coupled, cutoff: f64) -> Self {
        let end = |sign: f64| RunningMaximum::new(RelativePosition::new(system, sign), f64::INFINITY);
        Self {
            system,
            cutoff,
            ends: [1.0, -1.0].map(end),
            forces: ContactForces::of(system),
            first_impact: None,
        }
    }

    /// The value above which the reader of the range lets the run end.
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// The stroke, m, and when; `-∞` and NaN while no motion has been seen.
    pub fn stroke(&self) -> Extreme {
        let rest = self.system.rest_distance();
        self.larger_of_ends(|_, place| (place - rest).abs())
    }

    /// The largest contact force on either wall, N, and when; `-∞` and NaN while no motion has been seen. The force of an impact with a
    /// rigid wall is infinite.
    pub fn force(&self) -> Extreme {
        let system = self.system;
        if let Some(time) = self.first_impact {
            return Extreme { value: f64::INFINITY, time };
        }
        if let Some(forces) = &self.forces {
            let [near, far] = forces.records();
            let larger = if near.value > far.value { near } else { far };
            return if larger.value > 0.0 { larger } else { self.larger_of_ends(|_, _| 0.0) };
        }
        self.larger_of_ends(|side, place| {
            hertz_force(system.hertz(side), side.sign() * (place - system.wall(side)))
        })
    }

    /// The largest contact pressure on either wall, N/m², and when; `-∞` and NaN while no motion has been seen. The pressure of an impact
    /// with a rigid wall is infinite, as its force is.
    pub fn pressure(&self) -> Extreme {
        let system = self.system;
        if self.first_impact.is_some() {
            return self.force();
        }
        self.larger_of_ends(|side, place| {
            system.wall_pressure(side, side.sign() * (place - system.wall(side)))
        })
    }

    /// The largest value of a measure of the damper; for all other measures, the stroke.
    pub fn largest(&self, measure: Measure) -> Extreme {
        match measure {
            Measure::ContactForce => self.force(),
            Measure::ContactPressure => self.pressure(),
            _ => self.stroke(),
        }
    }

    /// The larger of the values at both ends of the range, each computed for the wall nearest to it.
    fn larger_of_ends(&self, value: impl Fn(Side, f64) -> f64) -> Extreme {
        let [farthest, nearest] = self.ends.each_ref().map(RunningMaximum::record);
        if farthest.value == f64::NEG_INFINITY {
            return farthest;
        }
        let far = Extreme { value: value(Side::Obstacle, farthest.value), ..farthest };
        let near = Extreme { value: value(Side::Primary, -nearest.value), ..nearest };
        if near.value > far.value { near } else { far }
    }
}

impl Observer<4> for DisplacementRange<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        self.ends.segment(segment);
        self.forces.segment(segment);
    }
    fn path(&mut self, path: &dyn Path<4>) {
        self.ends.path(path);
        self.forces.path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.ends.steps(steps);
        self.forces.steps(steps);
    }
    fn skips(&self, block: &Block<4>) -> bool {
        self.ends.skips(block)
    }
    fn impact(&mut self, impact: &Impact<4>) {
        self.ends.impact(impact);
        self.first_impact.get_or_insert(impact.after.t);
    }
    fn discontinuity(&mut self) {
        self.ends.discontinuity();
        self.forces.discontinuity();
    }
    fn search_work(&self) -> u64 {
        Observer::<4>::search_work(&self.ends) + self.forces.search_work()
    }
}
