//! Branches of dampers over an engineer's ranges, on structures that are not the paper's: whether each change of stability is named.

use retune_dynamics::Parameter;
use retune_dynamics::periodic::branches::{Control, Plan};
use retune_dynamics::periodic::{End, EventKind, branches};
use retune_solver::Settings;
use retune_testkit::hunt::dampers::{dampers, unnamed};
use retune_testkit::scenes::SSVI;

#[test]
fn invariant_each_change_of_stability_is_named() {
    dampers(1, 60).passes();
}

/// The motion of two periods of Table 2's damper that begins at 5.265928 rad/s loses its stability at 5.266316 rad/s, within 4e-4 rad/s of its beginning,
/// to one of four periods. The first motions of a branch were once added without a look for bifurcations, and this one was missed.
#[test]
fn regress_a_doubled_branch_begins_with_all_its_bifurcations() {
    let plan = Plan { samples: 2, starts: 0, ..Plan::over(Parameter::Omega, [5.25, 5.28]) };
    let found = branches(&SSVI.scene(), plan, &Settings::default(), Control::default()).expect("branches");
    let twice = found.branches.iter().find(|branch| branch.shooting.periods == 2).expect("a doubled branch");
    assert_eq!(twice.ends[0], End::Halved);
    assert!((twice.points[0].value - 5.265_928_357_57).abs() < 1e-9, "{}", twice.points[0].value);
    let first =
        twice.events.iter().find(|event| event.kind == EventKind::PeriodDoubling).expect("a doubling");
    assert!((first.orbit.value - 5.266_315_968_7).abs() < 1e-9, "{}", first.orbit.value);
    assert!(twice.is_stable_after(first.place - 2) && !twice.is_stable_after(first.place));
    assert!(unnamed(twice).is_empty());
    assert!(
        found.branches.iter().any(|branch| branch.shooting.periods == 4 && branch.ends[0] == End::Halved)
    );
}
