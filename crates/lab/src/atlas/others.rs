//! The difficulties under third-party integrators.

use super::{Cell, Truth, Verdict, judged, why_by_tolerance};
use crate::runs::{self, Row};
use crate::scenes::Case;
use crate::{comparison, system};
use retune_solver::Contacts;

/// A column: name, program (without its version), method, and treatment of contacts.
pub struct Other {
    pub name: &'static str,
    program: &'static str,
    method: &'static str,
    contacts: Contacts,
}

/// The tolerance of all runs.
const RTOL: f64 = 1e-6;

/// Three implicit methods, each with contacts located and stepped over, and two of CVODE, which locates
/// contacts as roots.
pub const OTHERS: [Other; 8] = {
    const fn other(
        name: &'static str,
        program: &'static str,
        method: &'static str,
        contacts: Contacts,
    ) -> Other {
        Other { name, program, method, contacts }
    }
    use Contacts::{Located, Stepped};
    [
        other("Radau5 located", "differential-equations", "Radau5", Located),
        other("Radau5 stepped", "differential-equations", "Radau5", Stepped),
        other("diffsol BDF located", "diffsol", "BDF", Located),
        other("diffsol BDF stepped", "diffsol", "BDF", Stepped),
        other("LSODA located", "ivp", "LSODA", Located),
        other("LSODA stepped", "ivp", "LSODA", Stepped),
        other("CVODE BDF", "SUNDIALS", "BDF", Located),
        other("CVODE Adams", "SUNDIALS", "Adams", Located),
    ]
};

/// A cell; `cvode` holds the runs of CVODE, if it is built.
pub fn cell(other: &Other, case: &Case, truth: &Truth, cvode: Option<&str>) -> Cell {
    let located = other.contacts == Contacts::Located;
    let run = match comparison::program(other.program) {
        Some(program) => {
            let contacts = if located { "located" } else { "stepped" };
            comparison::attempt(case, (program, other.method, contacts), RTOL, false)
        }
        None => {
            let Some(table) = cvode else { return not_run(truth, "it is not built") };
            let is_own = |row: &Row| row.method == other.method && row.is_at(RTOL);
            match runs::of_table(table, case, &truth.found).into_iter().find(is_own) {
                Some(row) => row.found,
                None => return not_run(truth, "its right-hand side has no such contact"),
            }
        }
    };
    let on_a_wall =
        || system(&case.scene).is_some_and(|system| system.indentation(&system.rest()).contains(&0.0));
    let why = if located && on_a_wall() {
        "the run begins on a wall, at a zero of the event function, which root finding does not report"
            .to_owned()
    } else {
        why_by_tolerance(other.contacts, RTOL, truth)
    };
    judged(run, case, truth, &why)
}

fn not_run(truth: &Truth, why: &str) -> Cell {
    let impacts = [0, truth.found.impacts];
    Cell { verdict: Verdict::NotRun, error: f64::NAN, impacts, evaluations: 0, cause: why.to_owned() }
}
