//! Limits: the order they put designs in, what they are measured against, and that a cutoff changes nothing below it.

#[path = "../../model/tests/scenes/mod.rs"]
mod scenes;

use retune_model::Scene;
use retune_optim::{
    Bounds, Goal, INFEASIBLE, Limit, Options, PeakEnergy, PerLimit, Term, Variable, When, energy, minimize,
    ranked,
};
use retune_solver::{Settings, Window, simulate};
use scenes::{Numbers, SSVI, TMD};
use std::ops::ControlFlow;

const WINDOW: Window = Window { from: 2.0, to: 8.0 };

fn goal(stroke: Option<f64>, force: Option<f64>, cavity: Option<f64>) -> Goal {
    Goal { terms: vec![Term::new(WINDOW)], limits: PerLimit([stroke, force, cavity]) }
}

fn evaluate(goal: &Goal, scene: &Scene, cutoff: f64) -> retune_optim::Evaluation {
    goal.evaluate(scene, &Settings::default(), cutoff).expect("a run")
}

#[test]
fn exact_any_feasible_design_is_better_than_any_other() {
    assert_eq!(ranked(1e90, 0.0), 1e90);
    assert!(ranked(1e90, 0.0) < ranked(0.0, 1e-15));
    assert!(ranked(900.0, 0.2) < ranked(1.0, 0.2 + 1e-12), "the energy does not matter, the violation does");
    assert!(energy(ranked(5.0, 0.1)).is_nan() && energy(5.0) == 5.0 && energy(f64::INFINITY).is_nan());
}

/// The limits are measured against what a run shows, and the violation is the sum of shares.
#[test]
fn exact_violations_are_shares_of_the_limits() {
    let scene = SSVI.scene();
    let run = simulate(&scene, WINDOW, &Settings::default()).expect("a run");
    let force = run.force_max[0].max(run.force_max[1]);
    let free = evaluate(&goal(Some(1e3), Some(1e9), None), &scene, f64::INFINITY);
    assert_eq!((free.value, free.violation), (run.e1_max.value, 0.0));
    assert_eq!(free.reached.get(Limit::Force), force);
    let stroke = free.reached.get(Limit::Stroke);
    assert!(stroke > 0.05 && stroke < 0.5, "{stroke}");
    let broken =
        evaluate(&goal(Some(stroke / 2.0), Some(force / 1.5), Some(0.42 / 1.25)), &scene, f64::INFINITY);
    assert!((broken.violation - 1.75).abs() < 1e-12, "{}", broken.violation);
    assert_eq!(broken.value, INFEASIBLE * (1.0 + broken.violation));
    let limits = PerLimit([Some(stroke * 1.005), Some(force * 1.5), None]);
    assert_eq!(limits.active(&free.reached), [Limit::Stroke]);
    // Nothing is watched that no limit asks for.
    assert_eq!(evaluate(&goal(None, None, Some(1.0)), &scene, f64::INFINITY).reached.0, [0.0, 0.0, 0.42]);
}

#[test]
fn exact_a_steady_stroke_is_limited_in_closed_form() {
    let band = retune_optim::Band { from: 5.0, to: 8.0, samples: 2 };
    let term = Term { omega: Some(band.into()), ..Term::new(When::Steady) };
    let stroke = TMD.coupled().steady_stroke_max([5.0, 8.0]).value;
    for (allowed, violation) in [(1.01 * stroke, 0.0), (0.5 * stroke, 1.0)] {
        let limits = PerLimit([Some(allowed), Some(1.0), None]);
        let found = evaluate(&Goal { terms: vec![term.clone()], limits }, &TMD.scene(), f64::INFINITY);
        assert!((found.violation - violation).abs() < 1e-12 && found.reached.get(Limit::Force) == 0.0);
    }
}

/// At any cutoff a value is either the full one, or both are above the cutoff.
#[test]
fn exact_a_cutoff_hides_nothing_below_it() {
    let designs = [SSVI, Numbers { k2: 400.0, ..SSVI }, Numbers { c: 0.1, ..SSVI }].map(|n| n.scene());
    let stroke =
        evaluate(&goal(Some(1.0), None, None), &designs[0], f64::INFINITY).reached.get(Limit::Stroke);
    for goal in
        [goal(Some(stroke), None, Some(0.3)), goal(Some(stroke), None, None), goal(None, Some(30.0), None)]
    {
        let full = designs.map(|scene| evaluate(&goal, &scene, f64::INFINITY).value);
        for cutoff in
            full.iter().flat_map(|v| [v * (1.0 - 1e-9), *v, v * (1.0 + 1e-9)]).chain([0.0, 1.0, INFEASIBLE])
        {
            for (scene, full) in designs.iter().zip(full) {
                let cut = evaluate(&goal, scene, cutoff).value;
                assert!(cut == full || (cut > cutoff && full > cutoff), "{cut} {full} {cutoff}");
            }
        }
    }
}

/// The best c2 of a TMD whose steady stroke may not pass a limit lies on the limit: the same by halving on the closed form.
#[test]
fn exact_a_search_ends_on_an_active_limit() {
    let band = retune_optim::Band { from: 5.0, to: 8.0, samples: 2 };
    let of = |c2: f64| Numbers { k2: 2083.0, c2, ..TMD };
    let stroke = |c2: f64| of(c2).coupled().steady_stroke_max([5.0, 8.0]).value;
    let value = |c2: f64| of(c2).coupled().steady_e1_max([5.0, 8.0]).value;
    let (mut low, mut high) = (120.0, 500.0); // more damping moves less, and serves worse than the tuned one
    let limit = 0.7 * stroke(low);
    assert!(stroke(high) < limit && value(low) < value(high));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stroke(middle) < limit { high = middle } else { low = middle }
    }
    let goal = Goal {
        terms: vec![Term { omega: Some(band.into()), ..Term::new(When::Steady) }],
        limits: PerLimit([Some(limit), None, None]),
    };
    let numbers = of(150.0);
    let objective =
        PeakEnergy::new(numbers.scene(), numbers.damper(), vec![Variable::C2], WINDOW, Settings::default())
            .with(goal);
    for start in [130.0, 480.0] {
        let options =
            Options { tol_x: 1e-8, tol_fun: 1e-8, bounds: vec![Bounds::default()], ..Options::default() };
        let value = |x: &[f64], cutoff: f64| objective.value(x, cutoff);
        let found = minimize(value, &[start], options, |_| ControlFlow::Continue(())).expect("a start");
        assert!((found.x[0] - high).abs() < 1e-4 * high, "{start}: {} {high}", found.x[0]);
        assert!(found.value < INFEASIBLE);
    }
    assert!(
        objective.counts().infeasible > 0 && objective.counts().evaluations > objective.counts().infeasible
    );
}
