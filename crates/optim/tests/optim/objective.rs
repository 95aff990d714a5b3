//! The objective over a run of the paper's scene.

use retune_optim::{DesignObjective, Failures, INFEASIBLE, Parameter};
use retune_solver::{Settings, Window};
use retune_testkit::scenes::TMD;

fn objective(variables: Vec<Parameter>, to: f64, settings: Settings) -> DesignObjective {
    DesignObjective::new(TMD.scene(), TMD.damper(), variables, Window { from: 0.0, to }, settings)
}

#[test]
fn contract_design_sets_the_named_parameters_and_no_other() {
    let objective = objective(Parameter::VARIED.to_vec(), 1.0, Settings::default());
    let damper = objective.damper(&[1.0, 2.0, 3.0, 4.0]).expect("a damper");
    assert_eq!(Parameter::PAPER.map(|variable| variable.get(&damper)), [1.0, 2.0, 3.0, 4.0]);
    let original = TMD.damper();
    assert_eq!((damper.mass, damper.contact), (original.mass, original.contact));
}

#[test]
fn contract_value_is_that_of_a_run_of_the_scene() {
    let objective = objective(vec![Parameter::C2], 5.0, Settings::default());
    let window = Window { from: 0.0, to: 5.0 };
    let run =
        retune_solver::e1_max(&TMD.scene(), window, &Settings::default(), f64::INFINITY).expect("a run");
    assert_eq!(objective.value(&[262.0], f64::INFINITY).to_bits(), run.value.to_bits());
    assert_eq!(objective.failures(), Failures::default());
}

#[test]
fn contract_failures_are_infinite_counted_and_one_is_kept() {
    let objective = objective(vec![Parameter::C2, Parameter::D], 5.0, Settings::default());
    for design in [[1.0, -2.0], [-1.0, 0.0], [f64::NAN, 1.0]] {
        assert_eq!(objective.value(&design, f64::INFINITY), f64::INFINITY);
    }
    let failures = objective.failures();
    assert_eq!(failures.count, 3);
    let (design, reason) = *failures.example.expect("an example");
    assert_eq!(design, [-1.0, 0.0]);
    assert_eq!(reason.to_string(), "c2: -1 is not allowed here: give a finite number not below 0");
}

/// A feasible value is at most [`INFEASIBLE`]; a recalled value counts like a computed one.
#[test]
fn contract_recalled_values_are_counted_as_when_they_were_found() {
    let objective = objective(vec![Parameter::C2], 5.0, Settings::default());
    for value in [1.0, INFEASIBLE, 1.5 * INFEASIBLE, f64::INFINITY] {
        objective.recall(value);
    }
    let counts = objective.counts();
    assert_eq!((counts.evaluations, counts.infeasible), (4, 2));
}
