//! Where methods fail: every method of Retune on every difficulty, and how it broke.

pub mod difficulties;
pub mod draw;
pub mod measures;

use crate::own;
use crate::record::{Found, errors};
use crate::scenes::Case;
use difficulties::Difficulty;
use retune_solver::{Contacts, Method, SolverError};

/// How a method fared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// E1max within 1e-4 and every impact counted.
    Works,
    /// E1max within 1 % and at most one impact, or one in ten, miscounted.
    Inaccurate,
    /// An error was returned.
    Says,
    /// A wrong answer and no word.
    Silent,
}

impl Verdict {
    /// Its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Verdict::Works => "works",
            Verdict::Inaccurate => "inaccurate",
            Verdict::Says => "says it fails",
            Verdict::Silent => "fails silently",
        }
    }
}

/// A column of the atlas: a method as a user would run it.
#[derive(Clone, Copy)]
pub struct Way {
    /// Its name.
    pub name: &'static str,
    /// The method.
    pub method: Method,
    /// How it meets contacts.
    pub contacts: Contacts,
    /// Relative tolerance, or step (s).
    pub setting: f64,
}

/// The methods at what a careful user sets (rtol 1e-6; a step of 1 ms), and the paper's as MATLAB sets it (rtol 1e-3).
pub const WAYS: [Way; 10] = {
    const fn way(name: &'static str, method: Method, contacts: Contacts, setting: f64) -> Way {
        Way { name, method, contacts, setting }
    }
    use Contacts::{Located, Stepped};
    [
        way("hybrid", Method::Hybrid, Located, 1e-6),
        way("dop853 located", Method::Dop853, Located, 1e-6),
        way("dop853 stepped", Method::Dop853, Stepped, 1e-6),
        way("ode45 located", Method::Ode45, Located, 1e-6),
        way("ode45 stepped", Method::Ode45, Stepped, 1e-6),
        way("ode23 stepped", Method::Ode23, Stepped, 1e-6),
        way("ode23s stepped", Method::Ode23s, Stepped, 1e-6),
        way("ode23s defaults", Method::Ode23s, Stepped, 1e-3),
        way("rk4 1 ms", Method::Rk4, Stepped, 1e-3),
        way("euler 1 ms", Method::Euler, Stepped, 1e-3),
    ]
};

/// One cell.
pub struct Cell {
    /// How the method fared.
    pub verdict: Verdict,
    /// Relative error of E1max.
    pub error: f64,
    /// Impacts found and expected.
    pub impacts: [usize; 2],
    /// Evaluations.
    pub evaluations: u64,
    /// What it said, or why it failed.
    pub cause: String,
}

/// Judges a run against a reference.
pub fn judge(found: Result<Found, String>, reference: &Found, omega: f64) -> Cell {
    match found {
        Err(said) => Cell {
            verdict: Verdict::Says,
            error: f64::NAN,
            impacts: [0, reference.impacts],
            evaluations: 0,
            cause: said,
        },
        Ok(found) => {
            let error = if reference.e1_max == 0.0 {
                found.e1_max.abs()
            } else {
                errors(&found, reference, omega)[0]
            };
            let missed = found.impacts.abs_diff(reference.impacts);
            let verdict = match () {
                () if error <= 1e-4 && missed == 0 => Verdict::Works,
                () if error <= 1e-2 && missed <= 1.max(reference.impacts / 10) => Verdict::Inaccurate,
                () => Verdict::Silent,
            };
            let cause = match verdict {
                Verdict::Works => String::new(),
                _ if missed > 0 => format!(
                    "{} touch-downs of {}: steps jump over contacts or contacts chatter",
                    found.impacts, reference.impacts
                ),
                _ => String::from("the error of each contact, seen by no error estimate, adds up"),
            };
            Cell {
                verdict,
                error,
                impacts: [found.impacts, reference.impacts],
                evaluations: found.evaluations,
                cause,
            }
        }
    }
}

/// The reference of a difficulty: the hybrid at rtol 1e-12.
///
/// # Errors
/// Why it could not be run.
pub fn reference(difficulty: &Difficulty) -> Result<Found, String> {
    own::run(&difficulty.case, &own::settings(Method::Hybrid, Contacts::Located, 1e-12), false)
}

/// One cell of the atlas.
pub fn cell(way: &Way, case: &Case, reference: &Found) -> Cell {
    let settings = own::settings(way.method, way.contacts, way.setting);
    let settings = retune_solver::Settings { max_steps: 400_000, ..settings };
    judge(own::run(case, &settings, false), reference, case.scene.forcing.frequency.get())
}

/// An error of a solver, in the words a user reads.
pub fn said(error: SolverError) -> String {
    error.to_string()
}
