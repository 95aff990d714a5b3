//! The undisturbed Hertz collision, to which most contacts are close.
//!
//! Two bodies that meet at speed `w` and feel nothing but Hertz's force obey `z'' = -κ z^(3/2)`. In units of the greatest depth
//! `Z = (5 w² / 4κ)^(2/5)` and the duration `T = 2.943 Z/w` every such collision is the same, `ζ'' = -Λ ζ^(3/2)` with
//! `ζ(0) = ζ(1) = 0`.

use super::quadrature::gauss;
use super::unit_law::UnitLaw;
use crate::methods::dop853;

/// Duration of the undisturbed collision, in units of greatest depth over touch-down speed: `(4/5) B(2/5, 1/2)`.
pub const DURATION: f64 = 2.943_275_184_324_705;

/// `τ` and `dτ/du` of the clock.
pub fn clock(u: f64) -> [f64; 2] {
    [u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u)]
}

/// Where, in terms of [`clock`], the clock of lossy collisions runs slowest, and the width of that region: chosen so that few nodes suffice
/// for most contacts drawn at random, also inside them.
fn slowest_point(law: &UnitLaw) -> [f64; 2] {
    match law {
        UnitLaw::Restoring(law) => [0.355 + 0.16 * law.restitution(), 0.21],
        UnitLaw::Damping(_) => [0.42, 0.24],
    }
}

/// `τ` and `dτ/du` of the clock of lossy collisions. Once one is disturbed the law of a restitution has a branch point (`D = 0`) near the
/// first half of the contact, from `0.20 ± 0.16 i` of [`clock`] for e = 0.3 to `0.32 ± 0.30 i` for 0.9 (`tests/reference/branch_point.py`).
/// A hyperbolic sine moves a pair of singularities as far away as can be (T. W. Tee and L. N. Trefethen, SIAM J. Sci. Comput. 28 (2006)
/// 1798).
pub fn lossy_clock(law: &UnitLaw) -> impl Fn(f64) -> [f64; 2] + Copy + use<> {
    let [place, width] = slowest_point(law);
    let [low, high] = [-place / width, (1.0 - place) / width].map(f64::asinh);
    move |u| {
        let at = low + (high - low) * u;
        let [time, rate] = clock(place + width * at.sinh());
        [time, rate * width * at.cosh() * (high - low)]
    }
}

/// Nodes on which the undisturbed collision is stored.
const NODES: usize = 40;

/// The force `ζ^(3/2)` of the undisturbed collision as a function of the clock, to rounding: `u³ (1 - u)³` times a polynomial
/// that meets it on 40 nodes.
pub fn undisturbed_force() -> impl Fn(f64) -> f64 {
    let (nodes, _) = gauss(NODES, 0);
    // In units of Z and Z/w the regularised collision is q' = w/2, w' = -(5/4) q⁴, t' = q (see `retune_model::RegularisedContact`).
    let slope = |&[q, w, _]: &[f64; 3]| [0.5 * w, -1.25 * q.powi(4), q];
    // The collision is symmetric in time.
    let mut values: Vec<f64> = states_at(slope, DURATION, clock, &nodes[..NODES / 2])
        .iter()
        .zip(&nodes)
        .map(|([q, ..], &u)| q.powi(3) / end_factor(u))
        .collect();
    values.extend(values.clone().into_iter().rev());
    interpolated(nodes, values, end_factor)
}

/// The undisturbed collision of a law of loss.
pub struct Lossy {
    /// Its duration, in units of the greatest depth *without loss* over the touch-down speed.
    pub duration: f64,
    nodes: Vec<f64>,
    states: Vec<[f64; 3]>,
}

impl Lossy {
    /// The undisturbed collision by a law.
    pub fn new(law: &UnitLaw) -> Self {
        let slope = |&[q, w, _]: &[f64; 3]| [0.5 * w, -1.25 * q.powi(4) * law.push(0.5 * q.powi(5), w), q];
        let duration = lift_off(slope);
        let (nodes, _) = gauss(NODES, 0);
        Self { duration, states: states_at(slope, duration, lossy_clock(law), &nodes), nodes }
    }

    /// The force over the clock, in units of `K Z^(3/2)`.
    pub fn force(&self, law: &UnitLaw) -> impl Fn(f64) -> f64 + use<> {
        let force = |&[q, w, _]: &[f64; 3]| q.powi(3) * law.push(0.5 * q.powi(5), w);
        let values = self.states.iter().zip(&self.nodes).map(|(y, &u)| force(y) / end_factor(u)).collect();
        interpolated(self.nodes.clone(), values, end_factor)
    }

    /// The depth over the clock, in units of Z.
    pub fn depth(&self) -> impl Fn(f64) -> f64 + use<> {
        // q ~ u at both ends
        let values = self.states.iter().zip(&self.nodes).map(|([q, ..], u)| q / (u * (1.0 - u))).collect();
        let root = interpolated(self.nodes.clone(), values, |u| u * (1.0 - u));
        move |u| root(u).powi(2)
    }
}

fn end_factor(u: f64) -> f64 {
    (u * (1.0 - u)).powi(3)
}

/// When a collision that begins at unit speed ends: `q = 0` again.
fn lift_off(slope: impl Fn(&[f64; 3]) -> [f64; 3]) -> f64 {
    let advance = |y: &[f64; 3], h: f64| dop853::step(&slope, y, &slope(y), h).y;
    let mut y = [0.0, 1.0, 0.0];
    // A step moves q by about 0.02 of the speed.
    while y[1] > 0.0 || y[0] > -0.03 * y[1] {
        y = advance(&y, 0.04);
    }
    let (mut h, mut end) = (0.0, y);
    for _ in 0..50 {
        let correction = -2.0 * end[0] / end[1];
        h += correction;
        end = advance(&y, h);
        if correction.abs() < 1e-16 {
            break;
        }
    }
    end[2]
}

/// The states `[q, w, t]` of a collision that begins at unit speed, at these places of its clock, from the first.
fn states_at(
    slope: impl Fn(&[f64; 3]) -> [f64; 3],
    duration: f64,
    clock: impl Fn(f64) -> [f64; 2],
    clocks: &[f64],
) -> Vec<[f64; 3]> {
    let advance = |y: &[f64; 3], h: f64| dop853::step(&slope, y, &slope(y), h).y;
    let mut y = [0.0, 1.0, 0.0];
    let mut states = Vec::new();
    for &u in clocks {
        let time = duration * clock(u)[0];
        // Newton's iteration for the end of the last of some short steps; time grows at the rate q.
        while time - y[2] > 0.05 * y[0].max(0.05) {
            y = advance(&y, 0.04);
        }
        let mut h = 0.0;
        let mut at = y;
        for _ in 0..50 {
            let correction = (time - at[2]) / at[0].max(1e-3);
            h += correction;
            at = advance(&y, h);
            if correction.abs() < 1e-16 {
                break;
            }
        }
        y = at;
        states.push(y);
    }
    states
}

/// `scale` times the polynomial that has these values on Gauss's nodes.
fn interpolated(nodes: Vec<f64>, values: Vec<f64>, scale: impl Fn(f64) -> f64) -> impl Fn(f64) -> f64 {
    let weights: Vec<f64> = (0..NODES)
        .map(|j| (0..NODES).filter(|&i| i != j).map(|i| 0.25 / (nodes[j] - nodes[i])).product())
        .collect();
    move |u| {
        let (mut above, mut below) = (0.0, 0.0);
        for ((node, weight), value) in nodes.iter().zip(&weights).zip(&values) {
            if u == *node {
                return scale(u) * value;
            }
            above += weight / (u - node) * value;
            below += weight / (u - node);
        }
        scale(u) * above / below
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_undisturbed_collision() {
        // (4/5) B(2/5, 1/2) by Γ(2/5), Γ(1/2), Γ(9/10)
        let beta = 2.218_159_543_757_688 * std::f64::consts::PI.sqrt() / 1.068_628_702_119_319;
        assert!((0.8 * beta / DURATION - 1.0).abs() < 1e-14, "{}", 0.8 * beta);
        let force = undisturbed_force();
        // At the deepest point ζ = 1; half-way in time back to it the energy law 1 - ζ^(5/2) = (dζ/dt)² holds.
        assert!((force(0.5) - 1.0).abs() < 1e-14, "{}", force(0.5));
        for u in [0.05, 0.2, 0.35] {
            let depth = |u: f64| force(u).powf(2.0 / 3.0);
            let h = 1e-4;
            let slope = (depth(u - 2.0 * h) - 8.0 * depth(u - h) + 8.0 * depth(u + h) - depth(u + 2.0 * h))
                / (12.0 * h);
            let speed = slope / (DURATION * clock(u)[1]);
            assert!((speed * speed + depth(u).powf(2.5) - 1.0).abs() < 1e-10, "{u}");
        }
    }
}
