//! The crate `ivp`: SciPy's `solve_ivp` in Rust.

use crate::motion::{Acting, Equations, Track};
use ivp::prelude::{EventConfig, FirstOrderSystem, Ivp, JacobianSource, Matrix, Method};

fn state(y: &[f64]) -> [f64; 4] {
    std::array::from_fn(|i| y[i])
}

impl FirstOrderSystem for Equations {
    fn derivative(&self, t: f64, y: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&Equations::derivative(self, t, &state(y)));
    }
    fn jac(&self, _t: f64, y: &[f64], j: &mut Matrix) {
        for (i, row) in self.jacobian(&state(y)).into_iter().enumerate() {
            for (k, value) in row.into_iter().enumerate() {
                j[(i, k)] = value;
            }
        }
    }
    fn events(&self, _t: f64, y: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.open(&state(y)));
    }
    fn n_events(&self) -> usize {
        if self.acting == Acting::Any { 0 } else { 2 }
    }
    fn event_config(&self, _index: usize) -> EventConfig {
        let mut config = EventConfig::new();
        config.terminal();
        config.negative();
        config
    }
}

fn piece(
    method: Method,
    equations: &Equations,
    (from, y): (f64, [f64; 4]),
    to: f64,
    rtol: f64,
    track: Option<&mut Track>,
) -> Result<(f64, [f64; 4], bool), String> {
    let solution = Ivp::first_order(equations, from, to, &y)
        .method(method)
        .rtol(rtol)
        .atol(rtol * 1e-3)
        .max_steps(100_000)
        .jacobian_source(JacobianSource::UserProvided)
        .dense_output(track.is_some())
        .solve()
        .map_err(|e| format!("{e:?}"))?;
    let event = solution
        .t_events
        .iter()
        .zip(&solution.y_events)
        .find_map(|(t, y)| Some((*t.last()?, state(y.last()?))));
    let end = match (event, solution.t.last(), solution.y.last()) {
        (Some((t, y)), ..) => (t, y, true),
        (None, Some(&t), Some(y)) if t >= to => (t, state(y), false),
        (_, t, _) => return Err(format!("{:?} at t = {t:?} s", solution.status)),
    };
    if let (Some(track), Some(dense)) = (track, &solution.continuous_sol) {
        let mut times: Vec<f64> = solution.t.iter().copied().filter(|&t| t < end.0).collect();
        times.push(end.0);
        for pair in times.windows(2) {
            let at = |t: f64| {
                if t == end.0 { end.1 } else { dense.evaluate(t).map_or([f64::NAN; 4], |y| state(&y)) }
            };
            track.step(equations, [pair[0], pair[1]], at);
        }
    }
    Ok(end)
}

macro_rules! method {
    ($name:ident, $method:expr) => {
        pub fn $name(
            equations: &Equations,
            from: (f64, [f64; 4]),
            to: f64,
            rtol: f64,
            track: Option<&mut Track>,
        ) -> Result<(f64, [f64; 4], bool), String> {
            piece($method, equations, from, to, rtol, track)
        }
    };
}

method!(dop853, Method::DOP853);
method!(rk23, Method::RK23);
method!(lsoda, Method::LSODA);
method!(bdf, Method::BDF);
