//! The interface of a scene to third-party integrators, and the evaluation of their output.

use retune_model::{Bare, Coupled, Scene, Side};
use std::cell::Cell;

/// Evaluations after which a run is aborted: a hundred times those of the longest completed run.
pub const MOST_EVALUATIONS: u64 = 20_000_000;

/// Which contact forces act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acting {
    /// Those that follow from the state: steps may cross touch-downs.
    Any,
    /// None: in flight.
    None,
    /// One wall's, while the damper presses into it.
    Only(Side),
}

/// The right-hand side of a scene with four components (without a damper the last two are constant).
pub struct Equations {
    bare: Bare,
    coupled: Option<Coupled>,
    /// The force that acts.
    pub acting: Acting,
    /// Evaluations of the right-hand side and of its Jacobian so far.
    pub evaluations: Cell<u64>,
}

impl Equations {
    /// The equations of a scene, with contacts located or stepped over.
    pub fn new(scene: &Scene, located: bool) -> Self {
        let coupled = scene.damper.as_ref().map(|d| Coupled::new(&scene.primary, &scene.forcing, d));
        let acting = if located && coupled.is_some() { Acting::None } else { Acting::Any };
        let bare = Bare::new(&scene.primary, &scene.forcing);
        Self { bare, coupled, acting, evaluations: Cell::new(0) }
    }

    /// State at rest.
    pub fn rest(&self) -> [f64; 4] {
        self.coupled.as_ref().map_or([0.0; 4], |c| c.rest())
    }

    /// `y'`.
    pub fn derivative(&self, t: f64, y: &[f64; 4]) -> [f64; 4] {
        self.evaluations.set(self.evaluations.get() + 1);
        assert!(
            self.evaluations.get() < MOST_EVALUATIONS,
            "does not end: {MOST_EVALUATIONS} evaluations, at t = {t} s"
        );
        let Some(coupled) = &self.coupled else {
            let [v, a] = self.bare.derivative(self.bare.excitation(t), &[y[0], y[1]]);
            return [v, a, 0.0, 0.0];
        };
        let excitation = coupled.excitation(t);
        match self.acting {
            Acting::Any => coupled.derivative(excitation, y),
            Acting::None => coupled.derivative_under(excitation, y, 0.0),
            Acting::Only(side) => {
                let force = coupled.contact_forces(y)[side as usize];
                coupled.derivative_under(excitation, y, -side.sign() * force)
            }
        }
    }

    /// `∂f/∂y`, by rows.
    pub fn jacobian(&self, y: &[f64; 4]) -> [[f64; 4]; 4] {
        self.evaluations.set(self.evaluations.get() + 1);
        let Some(coupled) = &self.coupled else {
            let (a, _) = self.bare.linear_part();
            let mut rows = [[0.0; 4]; 4];
            (0..2).for_each(|i| (0..2).for_each(|j| rows[i][j] = a[(i, j)]));
            return rows;
        };
        let a = if self.acting == Acting::None { coupled.linear_part().0 } else { coupled.jacobian(y) };
        std::array::from_fn(|i| std::array::from_fn(|j| a[(i, j)]))
    }

    /// The event functions of the phase, which ends when one of them becomes negative.
    pub fn open(&self, y: &[f64; 4]) -> [f64; 2] {
        let Some(coupled) = &self.coupled else { return [1.0; 2] };
        let z = coupled.indentation(y);
        match self.acting {
            Acting::Any => [1.0; 2],
            Acting::None => [-z[0], -z[1]],
            Acting::Only(side) => [z[side as usize], 1.0],
        }
    }

    /// Changes the phase at an event and moves the damper slightly (1e-15 m) past the wall; true if it was a touch-down. At a rigid wall
    /// the damper rebounds at once.
    pub fn change(&mut self, y: &mut [f64; 4]) -> bool {
        let open = self.open(y);
        let nearest = if open[0] <= open[1] { Side::Primary } else { Side::Obstacle };
        if let Some((coupled, e)) = self.coupled.as_ref().and_then(|c| Some((c, c.restitution()?))) {
            *y = coupled.struck(e, y);
            y[2] = y[0] + coupled.wall(nearest) - nearest.sign() * 1e-15;
            return true;
        }
        let (next, direction) = match self.acting {
            Acting::Only(side) => (Acting::None, -side.sign()),
            _ => (Acting::Only(nearest), nearest.sign()),
        };
        if let (Some(coupled), Acting::Only(side)) =
            (&self.coupled, if next == Acting::None { self.acting } else { next })
        {
            y[2] = y[0] + coupled.wall(side) + direction * 1e-15;
        }
        self.acting = next;
        next != Acting::None
    }

    /// `[E1, dE1/dt, d²E1/dt²]`.
    fn energy(&self, t: f64, y: &[f64; 4]) -> [f64; 3] {
        match &self.coupled {
            Some(coupled) => coupled.primary_energy_rates(coupled.excitation(t), y),
            None => self.bare.primary_energy_rates(self.bare.excitation(t), &[y[0], y[1]]),
        }
    }

    /// The walls that a state presses into.
    fn pressed(&self, y: &[f64; 4]) -> [bool; 2] {
        self.coupled.as_ref().map_or([false; 2], |c| c.indentation(y).map(|z| z > 0.0))
    }
}

/// The largest E1 and the touch-downs of a motion that is given point by point.
pub struct Track {
    spacing: f64,
    last: Option<(f64, [f64; 3])>,
    pressed: [bool; 2],
    /// Largest E1 so far, J.
    pub e1_max: f64,
    /// Touch-downs, s.
    pub touches: Vec<f64>,
}

impl Track {
    /// A track that samples the interior of steps every `spacing` seconds.
    pub fn new(spacing: f64) -> Self {
        Self { spacing, last: None, pressed: [false; 2], e1_max: 0.0, touches: Vec::new() }
    }

    /// Samples a step, from its dense output.
    pub fn step(&mut self, equations: &Equations, [from, to]: [f64; 2], mut at: impl FnMut(f64) -> [f64; 4]) {
        let pieces = ((to - from) / self.spacing).ceil().max(1.0);
        for k in 1..=pieces as usize {
            let t = if k as f64 == pieces { to } else { from + (to - from) * k as f64 / pieces };
            self.moment(equations, t, &at(t));
        }
    }

    /// Adds a point. Between two points E1 is the quartic whose slope is the cubic Hermite interpolant.
    pub fn moment(&mut self, equations: &Equations, t: f64, y: &[f64; 4]) {
        let rates = equations.energy(t, y);
        self.e1_max = self.e1_max.max(rates[0]);
        if let Some((before, a)) = self.last
            && a[1] > 0.0
            && rates[1] < 0.0
        {
            let h = t - before;
            let (c0, c1) = (a[1], h * a[2]);
            let c2 = 3.0 * (rates[1] - a[1]) - h * (2.0 * a[2] + rates[2]);
            let c3 = 2.0 * (a[1] - rates[1]) + h * (a[2] + rates[2]);
            let mut s = a[1] / (a[1] - rates[1]);
            for _ in 0..4 {
                s -= (c0 + s * (c1 + s * (c2 + s * c3))) / (c1 + s * (2.0 * c2 + s * 3.0 * c3));
                s = s.clamp(0.0, 1.0);
            }
            let value = a[0] + h * s * (c0 + s * (c1 / 2.0 + s * (c2 / 3.0 + s * c3 / 4.0)));
            if value.is_finite() && h < 2.0 * self.spacing {
                self.e1_max = self.e1_max.max(value);
            }
        }
        self.last = Some((t, rates));
        let pressed = equations.pressed(y);
        if equations.acting == Acting::Any {
            (0..2).filter(|&i| pressed[i] && !self.pressed[i]).for_each(|_| self.touches.push(t));
        }
        self.pressed = pressed;
    }
}
