//! The crate `diffsol`. Its cap on the Newton failures of a whole run is raised: contacts exhaust the default of 50.

use crate::motion::{Acting, Equations, Track};
use diffsol::{
    MatrixCommon, NalgebraLU, NalgebraMat, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason,
};

type M = NalgebraMat<f64>;
type End = (f64, [f64; 4], bool);

fn state(y: &[f64]) -> [f64; 4] {
    std::array::from_fn(|i| y[i])
}

fn march<'a, E, S>(
    mut solver: S,
    equations: &Equations,
    to: f64,
    mut track: Option<&mut Track>,
) -> Result<End, String>
where
    E: OdeEquations<T = f64, M = M, V = <M as MatrixCommon>::V> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    let text = |e: diffsol::error::DiffsolError| e.to_string();
    solver.set_stop_time(to).map_err(text)?;
    for _ in 0..100_000 {
        let before = solver.state().t;
        let reason = solver.step().map_err(text)?;
        let event = match reason {
            OdeSolverStopReason::RootFound(t, _) => Some(t),
            _ => None,
        };
        let t = event.unwrap_or(solver.state().t);
        let at = |t: f64| solver.interpolate(t).map_or([f64::NAN; 4], |y| state(y.batch_as_slice(0)));
        if let Some(track) = track.as_deref_mut() {
            track.step(equations, [before, t], at);
        }
        match reason {
            OdeSolverStopReason::InternalTimestep => {}
            OdeSolverStopReason::RootFound(..) => return Ok((t, at(t), true)),
            OdeSolverStopReason::TstopReached => {
                return Ok((t, state(solver.state().y.batch_as_slice(0)), false));
            }
        }
    }
    Err(format!("more than 100000 steps at t = {} s", solver.state().t))
}

macro_rules! method {
    ($name:ident, $solver:ident) => {
        pub fn $name(
            equations: &Equations,
            (from, y): (f64, [f64; 4]),
            to: f64,
            rtol: f64,
            track: Option<&mut Track>,
        ) -> Result<End, String> {
            let text = |e: diffsol::error::DiffsolError| e.to_string();
            let builder = OdeBuilder::<M>::new()
                .t0(from)
                .rtol(rtol)
                .atol([rtol * 1e-3; 4])
                .rhs_implicit(
                    |y: &[f64], _p: &[f64], t: f64, out: &mut [f64]| {
                        out.copy_from_slice(&equations.derivative(t, &state(y)));
                    },
                    |y: &[f64], _p: &[f64], _t: f64, v: &[f64], out: &mut [f64]| {
                        for (out, row) in out.iter_mut().zip(equations.jacobian(&state(y))) {
                            *out = row.iter().zip(v).map(|(a, b)| a * b).sum();
                        }
                    },
                )
                .init(|_p: &[f64], _t: f64, out: &mut [f64]| out.copy_from_slice(&y), 4);
            if equations.acting == Acting::Any {
                let mut problem = builder.build().map_err(text)?;
                problem.ode_options.max_nonlinear_solver_failures = 1_000_000;
                let solver = problem.$solver::<NalgebraLU<f64>>().map_err(text)?;
                return march(solver, equations, to, track);
            }
            let root = |y: &[f64], _p: &[f64], _t: f64, out: &mut [f64]| {
                out.copy_from_slice(&equations.open(&state(y)))
            };
            let mut problem = builder.root(root, 2).build().map_err(text)?;
            problem.ode_options.max_nonlinear_solver_failures = 1_000_000;
            let solver = problem.$solver::<NalgebraLU<f64>>().map_err(text)?;
            march(solver, equations, to, track)
        }
    };
}

method!(bdf, bdf);
method!(tr_bdf2, tr_bdf2);
