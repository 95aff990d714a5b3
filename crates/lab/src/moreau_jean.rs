//! The time stepper of Moreau and Jean, as in Siconos: the θ-method in velocities and impulses, with Signorini's condition and Newton's
//! restitution at the end of each step. It locates no impact, so chatter and holds cost no more than flight; its order is two without impacts
//! and one with them.
//!
//! M. Jean, The non-smooth contact dynamics method, Comput. Methods Appl. Mech. Engrg. 177 (1999), section 5; V. Acary & B. Brogliato,
//! Numerical Methods for Nonsmooth Dynamical Systems, Springer 2008, section 10.1, with θ = 1/2 and the gap predicted over half a step.

use crate::runs::{Found, Timing, timed};
use crate::scenes::Case;
use crate::system;
use nalgebra::{Matrix2, RowVector2, Vector2};

/// Its name in the column of programs.
pub const STEPPER: &str = "Moreau-Jean";

/// Weight of the forces at the end of a step.
const THETA: f64 = 0.5;

/// `M v' + C v + K q = f cos ωt + g` between rigid walls at `r = q2 - q1 = 0` and `r = width`.
struct Dynamics {
    mass: Vector2<f64>,
    damping: Matrix2<f64>,
    stiffness: Matrix2<f64>,
    amplitude: f64,
    omega: f64,
    /// The constant force of the spring, which is unstressed at `q2 - q1 = rest`.
    constant: Vector2<f64>,
    rest: f64,
    width: f64,
    restitution: f64,
    /// Stiffness of the structure alone, N/m.
    k1: f64,
}

impl Dynamics {
    /// The equations of a scene with rigid walls and a harmonic force.
    fn of(case: &Case) -> Option<Self> {
        let (primary, damper) = (&case.scene.primary, case.scene.damper?);
        let between = Matrix2::new(1.0, -1.0, -1.0, 1.0);
        let alone = |of: f64| Matrix2::new(of, 0.0, 0.0, 0.0);
        let (k1, k2, d) = (primary.stiffness.get(), damper.stiffness.get(), damper.rest_distance.get());
        Some(Self {
            mass: Vector2::new(primary.mass.get(), damper.mass.get()),
            damping: alone(primary.damping.get()) + between * damper.damping.get(),
            stiffness: alone(k1) + between * k2,
            amplitude: case.scene.forcing.amplitude()?.1.get(),
            omega: case.scene.forcing.frequency.get(),
            constant: Vector2::new(-k2 * d, k2 * d),
            rest: d,
            width: d + damper.clearance.get(),
            restitution: system(&case.scene)?.restitution()?,
            k1,
        })
    }

    fn force(&self, t: f64) -> Vector2<f64> {
        self.constant + Vector2::new(self.amplitude * (self.omega * t).cos(), 0.0)
    }
}

/// A run in equal steps of about `h` (s); E1max is the largest value at the ends of steps.
pub fn run(case: &Case, h: f64, is_timed: bool) -> Result<Found, String> {
    let dynamics = Dynamics::of(case).ok_or("only rigid walls and a harmonic force")?;
    let found = follow(&dynamics, case, h)?;
    let time = if is_timed { timed(|| follow(&dynamics, case, h)) } else { Timing::NONE };
    Ok(Found { time, ..found })
}

fn follow(d: &Dynamics, case: &Case, h: f64) -> Result<Found, String> {
    let steps = (case.to / h).round().max(1.0) as u64;
    let h = case.to / steps as f64;
    let gradient = RowVector2::new(-1.0, 1.0);
    let iteration = Matrix2::from_diagonal(&d.mass) + (d.damping + d.stiffness * (THETA * h)) * (THETA * h);
    let inverse = iteration.try_inverse().ok_or("the matrix of a step is singular")?;
    let (mut q, mut v) = (Vector2::new(0.0, d.rest), Vector2::zeros());
    let per_impulse = inverse * gradient.transpose();
    let mut found = Found {
        e1_max: 0.0,
        final_state: [0.0; 4],
        touches: None,
        impacts: 0,
        evaluations: steps,
        time: Timing::NONE,
    };
    let (mut force, mut pressed) = (d.force(0.0), false);
    for step in 1..=steps {
        let next = d.force(step as f64 * h);
        let total =
            next * THETA + force * (1.0 - THETA) - d.damping * v - d.stiffness * (q + v * (THETA * h));
        let free = v + inverse * total * h;
        // Bounds on the relative speed by Signorini's condition and Newton's restitution, at each wall that the predicted gap reaches.
        let [apart, apart_free] = [v, free].map(|v| v[1] - v[0]);
        let predicted = q[1] - q[0] + 0.5 * h * apart;
        let rebound = -d.restitution * apart;
        let low = if predicted <= 0.0 { rebound } else { f64::NEG_INFINITY };
        let high = if predicted >= d.width { rebound } else { f64::INFINITY };
        let after = apart_free.max(low).min(high);
        let impulse = (after - apart_free) / (gradient * per_impulse)[0];
        let ended = free + per_impulse * impulse;
        q += (ended * THETA + v * (1.0 - THETA)) * h;
        (v, force) = (ended, next);
        found.impacts += usize::from(impulse != 0.0 && !pressed);
        pressed = impulse != 0.0;
        found.e1_max = found.e1_max.max(0.5 * (d.mass[0] * v[0] * v[0] + d.k1 * q[0] * q[0]));
    }
    found.final_state = [q[0], v[0], q[1], v[1]];
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::{errors, settings};
    use crate::scenes::{Numbers, SSVI, cases};
    use retune_solver::{Contacts, Method};

    /// Errors of E1max and final state against the hybrid.
    fn against_the_hybrid(case: &Case, h: f64) -> [f64; 2] {
        let hybrid = settings(Method::Hybrid, Contacts::Located, 1e-12);
        let reference = crate::runs::run(case, &hybrid, false).expect("runs");
        let [e1, state, _] = errors(&run(case, h, false).expect("runs"), &reference, case.omega());
        [e1, state]
    }

    #[test]
    fn order_is_two_without_impacts() {
        let scene = Numbers { d: 2.0, c: 5.0, rigid: Some(0.7), ..SSVI }.scene();
        let case = Case { name: "", label: "", scene, to: 5.0 };
        let [coarse, fine] = [1e-2, 5e-3].map(|h| against_the_hybrid(&case, h)[1]);
        assert!(((coarse / fine).log2() - 2.0).abs() < 0.02, "{coarse:e} {fine:e}");
    }

    /// Impacts are detected up to a step late; chatter ends by itself.
    #[test]
    fn order_is_one_with_impacts() {
        let rigid = Numbers { rigid: Some(0.7), ..SSVI };
        // A spring presses the damper on a wall that recedes once a period: it chatters and is held again.
        let chatter = Numbers { k2: 2e4, c2: 100.0, d: 0.0, c: 5.0, rigid: Some(0.5), ..SSVI };
        for (name, numbers) in [("rigid", rigid), ("chatter", chatter)] {
            let case = Case { name, label: "", scene: numbers.scene(), to: 20.0 };
            for h in [1e-3, 1e-4] {
                let [e1, state] = against_the_hybrid(&case, h);
                assert!(e1 < 50.0 * h && state < 200.0 * h, "{name} {h:e}: {e1:e} {state:e}");
            }
        }
    }

    #[test]
    fn contract_other_scenes_are_refused() {
        for case in cases().into_iter().filter(|case| ["bare", "two-sided"].contains(&case.name)) {
            assert!(run(&case, 1e-3, false).is_err(), "{}", case.name);
        }
    }
}
