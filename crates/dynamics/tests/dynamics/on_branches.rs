//! Runs from rest at many frequencies: what settles lies on a branch that was found.

use retune_dynamics::Parameter;
use retune_dynamics::periodic::branches::{Control, Plan};
use retune_dynamics::periodic::{End, branches};
use retune_solver::Settings;
use retune_testkit::hunt::branches::{DAMPERS, from_rest, periods};

/// Without the paper's damper, which takes longest: `just lab hunt-branches` has it.
#[test]
fn invariant_what_settles_lies_on_a_branch() {
    from_rest(&DAMPERS[1..], 31).passes();
}

/// The isola on which 15 to 25 % of all starts end, and none from rest: Newton's iteration, kept away from what is known, finds it too.
#[test]
fn invariant_deflation_finds_an_isola_that_no_run_from_rest_leads_to() {
    let isola = |apart: usize| {
        let plan = Plan { samples: 7, apart, ..Plan::over(Parameter::Omega, [5.0, 8.0]) };
        let found =
            branches(&DAMPERS[3].scene(), plan, &Settings::default(), Control::default()).expect("branches");
        found.branches.iter().filter(|branch| branch.ends.contains(&End::Closed)).count()
    };
    assert_eq!([0, 4].map(isola), [0, 1]);
}

/// In this part of the band one goes over to a shorter period where nothing is done about it.
#[test]
fn invariant_branches_keep_their_period() {
    periods(&[4.5e4], [1.05, 1.25]).passes();
}
