//! What a damper needs: beside a plain scan, and beside closed forms.

use retune_model::{Measure, NonNegative, PerMeasure};
use retune_optim::{Goal, Objective, Response};
use retune_solver::Settings;
use retune_testkit::hunt::needs::{drawn, needs};

#[test]
fn reference_needs_beside_a_scan() {
    needs(2, 30.0, 76, 1e-6).passes();
}

/// A steady response is told in closed form, with the transient before it from a run.
#[test]
fn exact_needs_of_a_steady_response_are_its_closed_form_or_the_run_before_it() {
    let (scene, omega, window) = drawn(1, false, 30.0);
    let objective = Objective { omega: Some(omega), response: Response::Steady, ..Objective::default() };
    let goal = Goal { objective, ..window.into() };
    let needs = goal.needs(&scene, &Settings::default(), &|| true).expect("a value");
    let damper = scene.damper.expect("a damper");
    let system = retune_model::Coupled::new(&scene.primary, &scene.forcing, &damper);
    for measure in Measure::ALL {
        let worst = system.steady_max(measure, [omega.from.get(), omega.to.get()]);
        let own = needs.own.get(measure);
        assert_eq!(own.value, worst.value, "{}", measure.name());
        if worst.value > 0.0 {
            assert_eq!(own.omega, worst.frequency, "{}", measure.name());
        }
        assert!(needs.whole.get(measure).value >= worst.value);
    }
}

/// Peaks from rest on that are told not to matter are not searched: those of the stroke, which do, are the same, and no value is larger.
#[test]
fn invariant_needs_whose_peaks_do_not_matter_are_samples_at_most_as_large() {
    let (scene, omega, window) = drawn(2, true, 30.0);
    let objective = Objective { omega: Some(omega), quantity: Measure::Stroke, ..Objective::default() };
    let goal = Goal { objective, ..window.into() };
    let (settings, mut matters) = (Settings::default(), PerMeasure::all(f64::INFINITY));
    matters.set(Measure::Velocity, f64::NEG_INFINITY);
    let all = goal.needs(&scene, &settings, &|| true).expect("a value");
    let asked = (&all.own, matters);
    let some = goal.needs_from_rest(&scene, &settings, asked, &|| true).expect("a value");
    for measure in Measure::ALL {
        let [few, many] = [&some, &all.whole].map(|whole| whole.get(measure).value);
        assert!(few <= many && few > 0.9 * many, "{} {few} {many}", measure.name());
    }
    for measure in [Measure::Stroke, Measure::Velocity] {
        let [few, many] = [&some, &all.whole].map(|whole| whole.get(measure).value);
        assert!((few / many - 1.0).abs() < 1e-9, "{} {few} {many}", measure.name());
    }
    let less = |measure: &Measure| some.get(*measure).value < all.whole.get(*measure).value;
    assert!(Measure::ALL.iter().any(less), "some peak was not searched");
}

/// No linear damper of the same mass near the best has a smaller value.
#[test]
fn exact_no_neighbour_of_the_best_linear_damper_is_better() {
    let (scene, omega, window) = drawn(2, true, 30.0);
    let objective = Objective { omega: Some(omega), response: Response::Steady, ..Objective::default() };
    let goal = Goal { objective, ..window.into() };
    let best = goal.best_linear(&scene, &Settings::default()).expect("a damper");
    let value = |k2: f64, c2: f64| {
        let mut scene = best;
        let damper = scene.damper.as_mut().expect("a damper");
        damper.stiffness = NonNegative::new(k2 * damper.stiffness.get()).expect("a stiffness");
        damper.damping = NonNegative::new(c2 * damper.damping.get()).expect("a damping");
        goal.evaluate(&scene, &Settings::default(), f64::INFINITY).expect("a value").ranked
    };
    let own = value(1.0, 1.0);
    for (k2, c2) in [(1.01, 1.0), (0.99, 1.0), (1.0, 1.05), (1.0, 0.95), (1.01, 1.05), (0.99, 0.95)] {
        assert!(value(k2, c2) > own, "{k2} {c2}");
    }
}
