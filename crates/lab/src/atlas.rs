//! Atlas of failures: every method of Retune on every difficult scene, with its verdict and the cause.

pub mod difficulties;
pub mod draw;
pub mod energy;
pub mod missed;
pub mod objective;
#[cfg(feature = "integrators")]
pub mod others;
pub mod rigid;
pub mod stable;

use crate::runs::{self, Found, errors};
use crate::scenes::Case;
use crate::system;
use difficulties::Difficulty;
use retune_model::Side;
use retune_solver::observe::{Observer, Segment};
use retune_solver::{Contacts, Method, Settings};

/// The result of a method on a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// An error of at most [`WORKS`], every impact counted.
    Works,
    /// An error of at most [`WORKS`], but impacts miscounted: those missed or found twice are too shallow to matter.
    Miscounts,
    /// An error of at most [`INACCURATE`], and at most one impact, or one in ten, miscounted.
    Inaccurate,
    /// An error was returned.
    ReportsError,
    /// A wrong answer without an error.
    Silent,
    /// The program has no such contact.
    NotRun,
}

/// Largest error of a cell that works.
pub const WORKS: f64 = 1e-3;
/// Largest error of an inaccurate cell: a larger one means another motion.
pub const INACCURATE: f64 = 5e-2;

impl Verdict {
    pub const fn name(self) -> &'static str {
        match self {
            Verdict::Works => "works",
            Verdict::Miscounts => "miscounts",
            Verdict::Inaccurate => "inaccurate",
            Verdict::ReportsError => "says it fails",
            Verdict::Silent => "fails silently",
            Verdict::NotRun => "not run",
        }
    }

    /// The verdict from an error and the impacts found and expected.
    pub fn of(error: f64, [found, expected]: [usize; 2]) -> Self {
        let missed = found.abs_diff(expected);
        match () {
            () if error <= WORKS && missed == 0 => Verdict::Works,
            () if error <= WORKS => Verdict::Miscounts,
            () if error <= INACCURATE && missed <= 1.max(expected / 10) => Verdict::Inaccurate,
            () => Verdict::Silent,
        }
    }
}

/// A column of the atlas: a method as a user would run it.
#[derive(Clone, Copy)]
pub struct Way {
    pub name: &'static str,
    pub method: Method,
    pub contacts: Contacts,
    /// Relative tolerance, or step (s).
    pub setting: f64,
}

/// Most steps of a run.
pub const MOST_STEPS: u64 = 400_000;
/// The tolerance of the reference.
pub const REFERENCE: f64 = 1e-12;

impl Way {
    /// The settings of a run, with a bound on the work.
    pub fn settings(&self) -> Settings {
        Settings { max_steps: MOST_STEPS, ..runs::settings(self.method, self.contacts, self.setting) }
    }
}

/// The methods with careful settings (rtol 1e-6; a step of 1 ms), and the paper's method with MATLAB's default (rtol 1e-3).
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

pub struct Cell {
    pub verdict: Verdict,
    /// The larger of the relative errors of E1max and of the final state; in the energy row, the error of the energy.
    pub error: f64,
    /// Impacts found and expected.
    pub impacts: [usize; 2],
    pub evaluations: u64,
    /// Its error message, or the cause of its failure; empty if it works.
    pub cause: String,
}

/// The reference for the cells of a difficulty.
pub struct Truth {
    /// The hybrid at rtol 1e-12.
    pub found: Found,
    /// Its shortest contact, s.
    pub shortest_contact: Option<f64>,
}

impl Truth {
    /// The duration of the shortest contact, in words.
    fn contact(&self) -> Option<String> {
        self.shortest_contact.map(|s| format!("{:.2} ms", s * 1e3))
    }
}

/// Measures the shortest contact.
#[derive(Default)]
struct Durations {
    began: Option<f64>,
    shortest: Option<f64>,
}

impl Durations {
    fn ended(&mut self, t: f64) {
        if let Some(lasted) = self.began.map(|began| t - began).filter(|lasted| *lasted > 0.0) {
            self.shortest = Some(self.shortest.map_or(lasted, |s| s.min(lasted)));
            self.began = None;
        }
    }
}

impl Observer<4> for Durations {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let [from, to] = segment.ends();
        // A uniform clock marks flight: the contact has ended.
        if from.clock == [1.0, 0.0] && to.t > from.t {
            self.ended(from.t);
        }
    }
    fn touch_down(&mut self, t: f64, _side: Side) {
        self.ended(t); // contacts with the two walls may follow without flight
        self.began = Some(t);
    }
}

/// The reference of a difficulty.
pub fn truth(difficulty: &Difficulty) -> Result<Truth, String> {
    let settings = runs::settings(Method::Hybrid, Contacts::Located, REFERENCE);
    let case = &difficulty.case;
    let mut durations = Durations::default();
    if let Some(system) = system(&case.scene) {
        runs::follow(&system, system.rest(), case.to, &settings, &mut durations)
            .map_err(|error| error.to_string())?;
    }
    Ok(Truth { found: runs::run(case, &settings, false)?, shortest_contact: durations.shortest })
}

/// One cell of the atlas.
pub fn cell(way: &Way, case: &Case, truth: &Truth) -> Cell {
    judged(runs::run(case, &way.settings(), false), case, truth, &why(way, truth))
}

/// The cell of a run; `why` is the reason why such a run may fail.
fn judged(run: Result<Found, String>, case: &Case, truth: &Truth, why: &str) -> Cell {
    let expected = truth.found.impacts;
    let found = match run {
        Ok(found) => found,
        Err(said) => {
            let cause = format!("it says \"{said}\": {why}");
            return Cell {
                verdict: Verdict::ReportsError,
                error: f64::NAN,
                impacts: [0, expected],
                evaluations: 0,
                cause,
            };
        }
    };
    let [e1, state, _] = errors(&found, &truth.found, case.omega());
    let error = e1.max(state);
    let impacts = [found.impacts, expected];
    let verdict = Verdict::of(error, impacts);
    let counted = format!("{} touch-downs instead of {}", impacts[0], impacts[1]);
    let cause = match (verdict, impacts[0] == impacts[1]) {
        (Verdict::Works, _) => String::new(),
        (_, true) => why.to_owned(),
        (Verdict::Miscounts, _) => format!(
            "{counted}, and the motion is right all the same: a contact is shallower than the error of a position, or shorter \
             than a step at whose ends alone it could be seen"
        ),
        (_, false) => format!("{counted}: {why}"),
    };
    Cell { verdict, error, impacts, evaluations: found.evaluations, cause }
}

/// The reason why a method loses accuracy on a scene.
fn why(way: &Way, truth: &Truth) -> String {
    let step = way.setting * 1e3;
    match (way.method.has_fixed_step(), truth.contact()) {
        (true, Some(contact)) => format!(
            "steps of {step} ms through contacts as short as {contact}, and no error estimate that could tell"
        ),
        (true, None) => {
            format!("every step of {step} ms has an error that no estimate sees, and the run adds them up")
        }
        (false, _) => why_by_tolerance(way.contacts, way.setting, truth),
    }
}

/// Like [`why`], for a method with a tolerance.
fn why_by_tolerance(contacts: Contacts, rtol: f64, truth: &Truth) -> String {
    match (truth.contact(), contacts) {
        (Some(contact), Contacts::Stepped) => format!(
            "the force z^1.5 has no second derivative at touch-down, which the estimate of a step over one takes for granted, \
             and each contact (as short as {contact}) magnifies what the last one left"
        ),
        (Some(contact), Contacts::Located) => format!(
            "the tolerance {rtol:e} bounds the error of one step; contacts as short as {contact} magnify what steps leave"
        ),
        (None, _) => {
            format!("the tolerance {rtol:e} bounds the error of one step, not their sum over the run")
        }
    }
}

/// The row of the energy over 1,000 lossless impacts.
pub fn energy_cell(way: &Way) -> Cell {
    let drift = energy::drift(way.method, way.contacts, way.setting);
    let impacts = [drift.impacts as usize, energy::IMPACTS as usize];
    let (verdict, error, cause) = match drift.change {
        Err(said) => (Verdict::ReportsError, f64::NAN, said),
        Ok(change) => {
            let verdict = Verdict::of(change.abs(), impacts);
            let sign = if change < 0.0 { "lost" } else { "gained" };
            let cause = format!(
                "{sign} {:.1e} of the energy: what each contact leaves has one sign and adds up over {} impacts",
                change.abs(),
                impacts[0]
            );
            (verdict, change.abs(), if verdict == Verdict::Works { String::new() } else { cause })
        }
    };
    Cell { verdict, error, impacts, evaluations: 0, cause }
}
