//! The derivatives of a value by the design, beside differences of the value.

use retune_model::{Measure, NonNegative, Positive, Scene};
use retune_optim::{
    DesignObjective, Ensemble, FrequencyBand, Goal, INFEASIBLE, Limit, Limits, Objective, Parameter, Part,
    Response, Statistic, StiffnessRange, Stiffnesses, Unusable,
};
use retune_solver::{Settings, Settle, Window};
use retune_testkit::scenes::{Numbers, SSVI, TMD};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// A few periods, in which the SSVI NES strikes and is not yet irregular.
const WINDOW: Window = Window { from: 2.0, to: 8.0 };
const TUNED: Numbers = Numbers { k2: 1900.0, c2: 150.0, ..TMD };

fn positive(value: f64) -> Positive {
    Positive::new(value).expect("above 0")
}

fn band(samples: usize) -> Option<FrequencyBand> {
    Some(FrequencyBand { from: positive(5.0), to: positive(8.0), samples, relative: false })
}

fn problem(scene: Scene, variables: &[Parameter], goal: Goal) -> DesignObjective {
    let settings = Settings { rtol: 1e-13, ..Settings::default() };
    DesignObjective::new(scene, scene.damper.expect("a damper"), variables.to_vec(), goal, settings)
}

fn goal(objective: Objective) -> Goal {
    Goal { objective, ..WINDOW.into() }
}

/// The derivatives by the logarithm of each parameter, and the same by Richardson's extrapolation of central differences with steps of
/// `share`, `share / 2` and `share / 4`; relative to the value.
fn both(objective: &DesignObjective, share: f64) -> [Vec<f64>; 2] {
    let damper = objective.damper(&[]).expect("the own one");
    let design: Vec<f64> = objective.variables().iter().map(|variable| variable.get(&damper)).collect();
    let (found, by) = objective.gradient(&design, &|| true).expect("a value");
    assert_eq!(
        found,
        objective.evaluate(&objective.scene(&design).expect("in range"), f64::INFINITY).expect("it")
    );
    let value = |i: usize, by: f64| {
        let mut design = design.clone();
        design[i] *= 1.0 + by;
        objective.value(&design, f64::INFINITY)
    };
    let difference = |i: usize, h: f64| (value(i, h) - value(i, -h)) / (2.0 * h);
    let richardson = |i: usize| {
        let [a, b, c] = [1.0, 0.5, 0.25].map(|part| difference(i, part * share));
        let [ab, bc] = [(4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0];
        (16.0 * bc - ab) / 15.0
    };
    let expected = (0..design.len()).map(|i| richardson(i) / found.ranked).collect();
    [by.iter().zip(&design).map(|(by, x)| by * x / found.ranked).collect(), expected]
}

fn agree(objective: &DesignObjective, share: f64, tolerance: f64) {
    let [found, expected] = both(objective, share);
    assert!(expected.iter().any(|by| by.abs() > 1e-3), "there is something to compare: {expected:?}");
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < tolerance, "{found} {expected} of {:?}", objective.goal());
    }
}

const ALL: [Parameter; 6] = Parameter::VARIED;
const LINEAR: [Parameter; 3] = [Parameter::K2, Parameter::C2, Parameter::M2];

#[test]
fn reference_a_steady_damper_of_every_measure() {
    for quantity in Measure::ALL.into_iter().filter(|measure| !measure.is_of_walls()) {
        for omega in [None, band(2)] {
            let objective = Objective { quantity, omega, response: Response::Steady, ..Objective::default() };
            agree(&problem(TUNED.open_scene(), &LINEAR, goal(objective)), 1e-3, 1e-9);
        }
    }
}

#[test]
fn reference_runs_of_every_measure() {
    for (numbers, variables) in [(TUNED, &LINEAR[..]), (SSVI, &ALL[..])] {
        for quantity in Measure::ALL {
            if quantity.is_of_walls() && numbers.k2 == TUNED.k2 {
                continue; // it touches nothing
            }
            let objective = Objective { quantity, ..Objective::default() };
            agree(&problem(numbers.scene(), variables, goal(objective)), 1e-5, 1e-6);
        }
    }
}

#[test]
fn reference_the_worst_over_a_band() {
    for (numbers, variables) in [(TUNED, &LINEAR[..]), (SSVI, &ALL[..])] {
        let objective = Objective { omega: band(31), ..Objective::default() };
        agree(&problem(numbers.scene(), variables, goal(objective)), 1e-4, 1e-6);
    }
    // The worst at an end of the band.
    let above = FrequencyBand { from: positive(6.9), ..band(9).expect("a band") };
    let objective = Objective { omega: Some(above), ..Objective::default() };
    agree(&problem(TUNED.scene(), &LINEAR, goal(objective)), 1e-4, 1e-6);
}

#[test]
fn reference_settled_motions() {
    let long = Window { from: 40.0, to: 400.0 };
    let settled =
        Objective { response: Response::Settled, settle: Settle::default(), ..Objective::default() };
    let goal = |objective| Goal { objective, ..long.into() };
    agree(&problem(TUNED.scene(), &LINEAR, goal(settled.clone())), 1e-4, 1e-9);
    // A damper that strikes once a period, tuned for 5 to 8 rad/s.
    let struck = Numbers { k2: 583.9, c2: 94.97, d: 0.02885, c: 1.105, omega: 6.631, ..SSVI };
    agree(&problem(struck.scene(), &ALL, goal(settled)), 1e-4, 1e-5);
}

#[test]
fn reference_compositions() {
    let ensemble = |statistic| Some(Ensemble { members: 5, phases: true, errors: 0.02, seed: 3, statistic });
    let term = Objective { omega: band(9), ..Objective::default() };
    for statistic in [Statistic::Mean, Statistic::Worst, Statistic::Quantile(0.5)] {
        let objective = Objective { ensemble: ensemble(statistic), ..Objective::default() };
        agree(&problem(SSVI.scene(), &ALL, goal(objective)), 1e-5, 1e-6);
    }
    let range = StiffnessRange { from: positive(3.6e4), to: positive(4.2e4), samples: 5 };
    for k1 in [Stiffnesses::Set(vec![positive(3.6e4), positive(4.1e4)]), Stiffnesses::Range(range)] {
        let objective = Objective { k1: Some(k1), ..Objective::default() };
        agree(&problem(TUNED.scene(), &LINEAR, goal(objective)), 1e-4, 1e-6);
    }
    let steady = Objective { omega: band(2), response: Response::Steady, ..Objective::default() };
    let part = |weight, objective| Part { weight: positive(weight), objective };
    let sum = vec![part(0.7, term), part(0.4, Objective { ensemble: ensemble(Statistic::Mean), ..steady })];
    agree(&problem(TUNED.open_scene(), &LINEAR, goal(Objective { sum, ..Objective::default() })), 1e-4, 1e-6);
}

/// A design that breaks limits has the derivatives of its violation, so that value and derivatives belong together everywhere.
#[test]
fn reference_broken_limits() {
    let [stroke, force] = [Measure::Stroke, Measure::ContactForce].map(Limit::Of);
    let limits = Limits::default().with(stroke, positive(0.2)).with(force, positive(1e4));
    let limits = limits.with(Limit::Cavity, positive(0.3)).since(NonNegative::new(1.0).ok());
    // No contact at the end, which would cut the largest force off; and the largest values come before the window.
    let window = Window { from: 8.2, to: 8.3 };
    for omega in [None, band(31)] {
        let objective = Objective { omega, ..Objective::default() };
        let objective = problem(SSVI.scene(), &ALL, Goal { objective, limits, ..window.into() });
        assert!(objective.value(&[], f64::INFINITY) > INFEASIBLE);
        agree(&objective, 1e-5, 1e-6);
    }
    let kept = Limits::default().with(stroke, positive(9.0));
    let free = goal(Objective::default());
    let by = |goal: Goal| both(&problem(SSVI.scene(), &ALL, goal), 1e-5)[0].clone();
    assert_eq!(by(Goal { limits: kept, ..free.clone() }), by(free), "limits that are kept change nothing");
}

/// Where both peaks of a lightly damped TMD are equally high the value has a kink. To either side the derivative is that of one peak.
#[test]
fn invariant_a_kink_has_a_subgradient() {
    let objective = Objective { omega: band(2), response: Response::Steady, ..Objective::default() };
    let objective = problem(Numbers { c2: 60.0, ..TUNED }.open_scene(), &[Parameter::K2], goal(objective));
    let at = |k2: f64| {
        let (found, by) = objective.gradient(&[k2], &|| true).expect("a value");
        (found.worst.scene.forcing.frequency.get(), by[0], found.ranked)
    };
    let (mut low, mut high) = (1500.0, 3000.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at(middle).0 > TMD.omega { low = middle } else { high = middle }
    }
    let ([upper, falls, value], [lower, rises, same]) =
        (<[f64; 3]>::from(at(low)), <[f64; 3]>::from(at(high)));
    assert!(
        upper > lower + 0.5 && (same / value - 1.0).abs() < 1e-12,
        "two peaks of one height: {lower} {upper}"
    );
    assert!(falls < 0.0 && rises > 0.0, "{falls} {rises}");
    for (from, to, by) in [(low, low - 0.01, falls), (high, high + 0.01, rises)] {
        let difference = (at(to).2 - at(from).2) / (to - from);
        assert!((difference / by - 1.0).abs() < 1e-3, "{difference} {by}");
    }
}

#[test]
fn contract_an_evaluation_ends_when_it_is_told_to() {
    let objective = Objective { omega: band(200), ..Objective::default() };
    let objective = problem(SSVI.scene(), &ALL, goal(objective));
    let runs = AtomicUsize::new(0);
    let first_ten = || runs.fetch_add(1, Relaxed) < 10;
    assert_eq!(objective.gradient(&[], &first_ten).map(|_| ()), Err(Unusable::Stopped));
    assert_eq!(runs.into_inner(), 200, "it was asked before each run");
}
