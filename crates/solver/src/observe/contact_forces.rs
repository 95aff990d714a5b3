//! The largest contact forces of walls that lose energy. Without loss the force is largest where the indentation is: see
//! `displacement_range`.

use super::observer::Observer;
use super::quantity::Quantity;
use super::running_maximum::RunningMaximum;
use crate::linear::pieces::Block;
use crate::linear::steps::Steps;
use crate::motion::form::Form;
use crate::motion::segment::Segment;
use crate::response::Extreme;
use retune_model::{Coupled, Excitation, Side};
use wide::f64x4;

/// The force of one wall, N.
pub struct WallForce<'a> {
    system: &'a Coupled,
    side: Side,
    form: Form<4>,
}

impl<'a> WallForce<'a> {
    /// The force of one wall while the other is not touched: `F = -s (m2 a2 + c2 (v2 - v1) + k2 (x2 - x1 - D))` with the side's sign `s`.
    pub fn new(system: &'a Coupled, side: Side) -> Self {
        let ([_, m2], [k2, c2]) = (system.masses(), system.damper_force_weights());
        let [row, rated] =
            [[-k2, -c2, k2, c2], [0.0, 0.0, 0.0, m2]].map(|row| row.map(|weight| -side.sign() * weight));
        Self { system, side, form: Form::rated(system, row, rated) }
    }
}

impl Quantity<4> for WallForce<'_> {
    fn rates(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 3] {
        self.system.contact_force_rates(excitation, y, self.side)
    }
    fn rates_in_flight(&self, _: &[f64x4; 2], _: &[f64x4; 4]) -> [f64x4; 3] {
        [f64x4::ZERO; 3]
    }
    fn form(&self) -> &Form<4> {
        &self.form
    }
    fn is_forced(&self) -> bool {
        true
    }
    fn size(&self, y: &[f64; 4]) -> f64 {
        self.form.size(y) + self.system.masses()[0] * self.system.contact_size(y)
    }
}

/// The largest force of either wall.
pub struct ContactForces<'a> {
    system: &'a Coupled,
    walls: [RunningMaximum<WallForce<'a>>; 2],
}

impl<'a> ContactForces<'a> {
    /// Observes the walls of a system, if they lose energy.
    pub fn of(system: &'a Coupled) -> Option<Self> {
        let wall = |side| RunningMaximum::new(WallForce::new(system, side), f64::INFINITY);
        system.is_lossy().then(|| Self { system, walls: Side::BOTH.map(wall) })
    }

    /// The largest force of each wall, N, and when; `-∞` and NaN for a wall that was not touched.
    pub fn records(&self) -> [Extreme; 2] {
        self.walls.each_ref().map(RunningMaximum::record)
    }

    /// By how much a force may exceed the records, see [`RunningMaximum::doubt`].
    pub fn doubt(&self) -> f64 {
        self.walls.iter().map(RunningMaximum::doubt).fold(0.0, f64::max)
    }
}

impl Observer<4> for ContactForces<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        if segment.in_flight() {
            return;
        }
        // The wall in contact is the nearer one: at touch-down and lift-off the indentation is zero to rounding, between them positive.
        let [begin, end] = segment.ends().map(|knot| self.system.indentation(&knot.y));
        let side = if begin[0] + end[0] > begin[1] + end[1] { Side::Primary } else { Side::Obstacle };
        self.walls[side as usize].segment(segment);
    }
    fn steps(&mut self, _steps: &Steps<'_, 4>) {}
    fn skips(&self, _block: &Block<4>) -> bool {
        true
    }
    fn discontinuity(&mut self) {
        self.walls.discontinuity();
    }
    fn search_work(&self) -> u64 {
        Observer::<4>::search_work(&self.walls)
    }
}
