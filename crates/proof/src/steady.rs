//! The steady motion of a damper that touches no wall, and of a structure alone, in closed form.
//!
//! Equation (1) is linear then. A system that comes to rest without force has exactly one motion that repeats, and it is stable: `x1 = Re(X1 e^{iφ})`,
//! `r = D + Re(R e^{iφ})`, where the force is `Re(F e^{iφ})`. With `S = k1 - m1 ω² + iω c1`, `Q = k2 + iω c2`, `d = Q - m2 ω²` and `N = S d - m2 ω² Q`
//! they are `X1 = F d/N` and `R = F m2 ω²/N` (J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 3.2; `retune_model::Steady` has them in doubles).

use crate::largest::Largest;
use crate::{Equations, Event, Failure, Interval, Taylor};
use retune_model::Side;

/// Real part and imaginary part.
type Complex = [Taylor; 2];

fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

/// The square of the absolute value.
fn square([a, b]: Complex) -> Taylor {
    a * a + b * b
}

/// What is known of the motion, or of those at all frequencies of a family.
#[derive(Clone, Debug)]
pub struct Steady {
    /// `[x1, v1, x2, v2]` at a crest of the force.
    pub state: [Interval; 4],
    /// Its largest values.
    pub largest: Largest,
}

/// The motion that touches no wall.
///
/// # Errors
/// It may touch a wall.
pub fn steady(equations: &Equations) -> Result<Steady, Failure> {
    let [m1, c1, k1, m2, c2, k2, rest] = {
        let Equations { m1, c1, k1, m2, c2, k2, rest, .. } = *equations;
        [m1, c1, k1, m2, c2, k2, rest].map(Taylor::from)
    };
    let omega = equations.omega;
    let inertia = m2 * omega * omega;
    let (structure, spring) = ([k1 - m1 * omega * omega, omega * c1], [k2, omega * c2]);
    let dynamic = [k2 - inertia, omega * c2];
    let (whole, coupled) = (times(structure, dynamic), spring.map(|part| part * inertia));
    let [re, im] = [whole[0] - coupled[0], whole[1] - coupled[1]];
    let [cos, sin] = equations.force_per_mass::<Taylor>().map(|part| part * m1);
    // F/N.
    let scale = times([cos, -sin], [re, -im]).map(|part| part * square([re, im]).reciprocal());
    let (x1, r) = (times(scale, dynamic), scale.map(|part| part * inertia));

    // Both parts of (m1 v1² + k1 x1²)/2 are turns of one another, so the larger wins.
    let half = Taylor::point(0.5) * square(x1);
    let energy = (half * k1).hull().max((half * m1 * omega * omega).hull());
    // It is not negative, whatever is rounded.
    let stroke = square(r).hull().abs().sqrt();
    for side in Side::BOTH.into_iter().filter(|_| equations.has_walls()) {
        let gap = Interval::point(side.sign()) * (equations.walls[side as usize] - equations.rest);
        if !(gap - stroke).is_positive() {
            return Err(Failure::Graze(Event::Touch(side)));
        }
    }
    let [v1, w] = [x1, r].map(|amplitude| -(omega * amplitude[1]));
    let state = [x1[0], v1, x1[0] + rest + r[0], v1 + w].map(Taylor::hull);
    Ok(Steady { state, largest: Largest { energy, stroke, contact_force: Interval::ZERO } })
}
