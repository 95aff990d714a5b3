//! What a damper needs: beside a plain scan, and beside closed forms.

use retune_model::{Amplitude, Measure, NonNegative, PerMeasure, Positive, Scene};
use retune_optim::{FrequencyBand, Goal, Objective, Response};
use retune_solver::{Settings, Window};
use retune_testkit::hunt::needs::{drawn, needs};
use retune_testkit::scenes::{Numbers, Spread, TMD};

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

/// A structure of 1 kg to 1000 t, driven in any of four ways over a band that may be far from its resonance, with a damper of 1 to 15 % of its mass that
/// is tuned anywhere; and the steady goal over the band.
fn driven(number: usize, seed: &mut Spread) -> (Scene, [f64; 2], Goal) {
    let (m1, natural, share) =
        (seed.logarithmic(1.0, 1e6), seed.logarithmic(0.5, 600.0), seed.logarithmic(0.01, 0.15));
    let m2 = share * m1;
    let numbers = Numbers {
        m1,
        c1: 2.0 * seed.logarithmic(0.001, 0.05) * m1 * natural,
        k1: m1 * natural * natural,
        p: 1.0,
        omega: natural,
        m2,
        k2: m2 * natural * natural,
        c2: 0.1 * m2 * natural,
        ..TMD
    };
    let low = seed.logarithmic(0.1, 5.0);
    let band = [low, low * seed.logarithmic(1.05, 4.0)];
    let [from, to] = band.map(|share| Positive::new(share * natural).expect("a frequency"));
    let of_structure = [
        Measure::Energy,
        Measure::Displacement,
        Measure::Velocity,
        Measure::Acceleration,
        Measure::GroundForce,
    ];
    let omega = Some(FrequencyBand { from, to, samples: 31, relative: false });
    let quantity = of_structure[number / 4 % 5];
    let objective = Objective { quantity, omega, response: Response::Steady, ..Objective::default() };
    let goal = Goal { objective, ..Window { from: 0.0, to: 1.0 }.into() };
    let mut scene = numbers.forced_by(Amplitude::ALL[number % 4]);
    scene.damper.as_mut().expect("a damper").contact = None;
    (scene, band, goal)
}

/// A force that is as good as constant, or constant, widens no grid without end.
#[test]
fn regress_a_band_that_begins_near_zero_is_searched_at_once() {
    for omega in [0.0, 1e-200, 1e-3] {
        let (mut scene, _, goal) = driven(0, &mut Spread::new(1));
        scene.forcing.frequency = NonNegative::new(omega).expect("a frequency");
        let objective = Objective { omega: None, ..goal.objective };
        let best = Goal { objective, ..goal }.best_linear(&scene, &Settings::default());
        assert!(best.is_some_and(|best| best.damper.is_some()), "{omega}");
    }
}

/// A structure that is driven off its resonance may have its best TMD where it is driven: no design of a fine grid is better by more than a thousandth.
#[test]
fn reference_the_best_linear_damper_beside_a_fine_grid() {
    let mut seed = Spread::new(14);
    for number in 0..60 {
        let (scene, [low, high], goal) = driven(number, &mut seed);
        let settings = Settings::default();
        let value = |scene: &Scene| goal.evaluate(scene, &settings, f64::INFINITY).expect("a value").ranked;
        let best = goal.best_linear(&scene, &settings).expect("a damper");
        let natural = scene.primary.natural_frequency();
        let (from, to) = (0.5 * low.min(1.0), 1.5 * high.max(1.0));
        let least = (0..60 * 20).map(|design| {
            let (tuning, zeta) = (design % 60, design / 60);
            let omega = natural * from * (to / from).powf(f64::from(tuning) / 59.0);
            let mut scene = scene;
            let damper = scene.damper.as_mut().expect("a damper");
            let m2 = damper.mass.get();
            damper.stiffness = NonNegative::new(m2 * omega * omega).expect("a stiffness");
            let zeta = 0.003 * 300.0_f64.powf(f64::from(zeta) / 19.0);
            damper.damping = NonNegative::new(2.0 * zeta * m2 * omega).expect("a damping");
            value(&scene)
        });
        let (own, least) = (value(&best), least.fold(f64::INFINITY, f64::min));
        assert!(own <= 1.001 * least, "{number}: {own} {least} of {scene:?} over {low} to {high}");
    }
}
