//! The crate `differential-equations`. Its cap on rejected steps in a row is raised: contacts exhaust the default.

use crate::motion::{Acting, Equations, Track};
use differential_equations::linalg::Matrix;
use differential_equations::prelude::*;

type State = [f64; 4];

impl ODE<f64, State> for Equations {
    fn diff(&self, t: f64, y: &State, out: &mut State) {
        *out = self.derivative(t, y);
    }
    fn jacobian(&self, _t: f64, y: &State, j: &mut Matrix<f64>) {
        for (i, row) in Equations::jacobian(self, y).into_iter().enumerate() {
            for (k, value) in row.into_iter().enumerate() {
                j[(i, k)] = value;
            }
        }
    }
}

/// The end of a phase: the first zero of its event functions.
struct Opening<'a>(&'a Equations);

impl Event<f64, State> for Opening<'_> {
    fn config(&self) -> EventConfig {
        EventConfig::new(CrossingDirection::Negative, Some(1))
    }
    fn event(&self, _t: f64, y: &State) -> f64 {
        let [a, b] = self.0.open(y);
        a.min(b)
    }
}

/// Passes each step to a track and keeps its end.
struct Control<'a, 'b> {
    equations: &'a Equations,
    track: Option<&'b mut Track>,
    shown: f64,
}

impl Solout<f64, State> for Control<'_, '_> {
    fn solout<I>(
        &mut self,
        t: f64,
        _before: f64,
        y: &State,
        _y_before: &State,
        interpolator: &mut I,
        solution: &mut Solution<f64, State>,
    ) -> ControlFlag<f64, State>
    where
        I: Interpolation<f64, State> + ?Sized,
    {
        if let (Some(track), true) = (self.track.as_deref_mut(), t > self.shown) {
            let open = self.equations.open(y);
            // A step beyond the end of the phase is truncated at the event and then passed on.
            if open[0] >= 0.0 && open[1] >= 0.0 {
                track.step(self.equations, [self.shown, t], |s| {
                    interpolator.interpolate(s).unwrap_or([f64::NAN; 4])
                });
            }
            self.shown = t;
        }
        solution.t.clear();
        solution.y.clear();
        solution.push(t, *y);
        ControlFlag::Continue
    }
}

macro_rules! method {
    ($name:ident, $method:expr) => {
        pub fn $name(
            equations: &Equations,
            (from, y): (f64, State),
            to: f64,
            rtol: f64,
            track: Option<&mut Track>,
        ) -> Result<(f64, State, bool), String> {
            let watch = Control { equations, track, shown: from };
            let ivp =
                IVP::ode(equations, from, to, y).solout(watch).method($method.rtol(rtol).atol(rtol * 1e-3));
            let opening = Opening(equations);
            let solution =
                if equations.acting == Acting::Any { ivp.solve() } else { ivp.event(&opening).solve() };
            let solution = solution.map_err(|e| format!("{e:?}"))?;
            match (solution.t.last(), solution.y.last()) {
                (Some(&t), Some(&y)) => Ok((t, y, matches!(solution.status, Status::Interrupted))),
                _ => Err(String::from("no output")),
            }
        }
    };
}

method!(dop853, ExplicitRungeKutta::dop853().max_steps(100_000).max_rejects(1000));
method!(radau5, ImplicitRungeKutta::radau5().max_steps(100_000).max_rejects(1000));
method!(kvaerno745, DiagonallyImplicitRungeKutta::kvaerno745().max_steps(100_000).max_rejects(1000));
