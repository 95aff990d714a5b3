//! Limits: the ranking of designs, the values that limits apply to, and that a cutoff changes no value below it.

use retune_model::{Measure, NonNegative, Of, Positive, Scene, Shape};
use retune_optim::{
    Bounds, DesignObjective, FrequencyBand, Goal, INFEASIBLE, Limit, Limits, Objective, Options, Parameter,
    Response, Stiffnesses, Unusable, minimize, ranked, value_of,
};
use retune_solver::{Settings, Window, decay_time, simulate};
use retune_testkit::histories::pulse;
use retune_testkit::scenes::{Numbers, SSVI, TMD};
use std::ops::ControlFlow;

const WINDOW: Window = Window { from: 2.0, to: 8.0 };

fn positive(value: f64) -> Positive {
    Positive::new(value).expect("above 0")
}

fn band(samples: usize) -> Option<FrequencyBand> {
    Some(FrequencyBand { from: positive(5.0), to: positive(8.0), samples, relative: false })
}

fn steady() -> Objective {
    Objective { omega: band(2), response: Response::Steady, ..Objective::default() }
}

fn limits(stroke: Option<f64>, force: Option<f64>, cavity: Option<f64>) -> Limits {
    let all = [Limit::Of(Measure::Stroke), Limit::Of(Measure::ContactForce), Limit::Cavity];
    let given = all.into_iter().zip([stroke, force, cavity]);
    given.fold(Limits::default(), |limits, (limit, most)| match most {
        Some(most) => limits.with(limit, positive(most)),
        None => limits,
    })
}

fn goal(stroke: Option<f64>, force: Option<f64>, cavity: Option<f64>) -> Goal {
    Goal { limits: limits(stroke, force, cavity), ..WINDOW.into() }
}

fn evaluate(goal: &Goal, scene: &Scene, cutoff: f64) -> retune_optim::Evaluation {
    goal.evaluate(scene, &Settings::default(), cutoff).expect("a run")
}

#[test]
fn contract_any_feasible_design_is_better_than_any_infeasible_one() {
    assert_eq!(ranked(1e90, 0.0), 1e90);
    assert!(ranked(1e90, 0.0) < ranked(0.0, 1e-15));
    assert!(ranked(900.0, 0.2) < ranked(1.0, 0.2 + 1e-12), "the energy does not matter, the violation does");
    assert!(value_of(ranked(5.0, 0.1)).is_nan() && value_of(5.0) == 5.0 && value_of(f64::INFINITY).is_nan());
}

/// The limits apply to the values of a run, and the violation is the sum of the relative excesses.
#[test]
fn exact_violations_are_shares_of_the_limits() {
    let scene = SSVI.scene();
    let run = simulate(&scene, WINDOW, &Settings::default()).expect("a run");
    let force = run.force_max[0].max(run.force_max[1]);
    let free = evaluate(&goal(Some(1e3), Some(1e9), None), &scene, f64::INFINITY);
    assert_eq!((free.ranked, free.violation), (run.e1_max.value, 0.0));
    assert_eq!(free.reached.get(Limit::Of(Measure::ContactForce)), force);
    let stroke = free.reached.get(Limit::Of(Measure::Stroke));
    assert!(stroke > 0.05 && stroke < 0.5, "{stroke}");
    let broken =
        evaluate(&goal(Some(stroke / 2.0), Some(force / 1.5), Some(0.42 / 1.25)), &scene, f64::INFINITY);
    assert!((broken.violation - 1.75).abs() < 1e-12, "{}", broken.violation);
    assert_eq!(broken.ranked, INFEASIBLE * (1.0 + broken.violation));
    let limits = limits(Some(stroke * 1.005), Some(force * 1.5), None);
    assert_eq!(limits.active(&free.reached), [Limit::Of(Measure::Stroke)]);
    // Quantities without a limit are not observed.
    let seen = evaluate(&goal(None, None, Some(1.0)), &scene, f64::INFINITY).reached;
    assert_eq!(seen.0, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.42]);
}

/// Every measure can be limited, to what the whole run from rest has of it.
#[test]
fn exact_each_measure_is_limited_by_what_the_run_has_of_it() {
    let scene = SSVI.scene();
    let run = simulate(&scene, Window { from: 0.0, ..WINDOW }, &Settings::default()).expect("a run");
    let structure = run.structure;
    let [displacement, velocity, acceleration, ground] =
        [structure.displacement, structure.velocity, structure.acceleration, structure.ground_force]
            .map(|largest| largest.value);
    let force = run.force_max[0].max(run.force_max[1]);
    let pressure = run.pressure_max[0].max(run.pressure_max[1]);
    let [energy, stroke] = [run.e1_max.value, run.spring_deflection_max];
    let most = [energy, displacement, velocity, acceleration, ground, stroke, force, pressure];
    for (measure, most) in Measure::ALL.into_iter().zip(most) {
        let limit = Limit::Of(measure);
        let limits = Limits::default().with(limit, positive(most / 1.25));
        let found = evaluate(&Goal { limits, ..WINDOW.into() }, &scene, f64::INFINITY);
        assert!((found.violation - 0.25).abs() < 1e-7, "{limit}: {}", found.violation);
        // What is of the damper is of one observer, and comes together.
        let of_the_damper = |measure: Measure| measure.is_of_damper();
        let mut others = Measure::ALL
            .into_iter()
            .filter(|other| *other != measure && !(of_the_damper(measure) && of_the_damper(*other)));
        assert!(others.all(|other| found.reached.get(Limit::Of(other)) == 0.0), "{limit}");
    }
}

#[test]
fn exact_a_steady_stroke_is_limited_in_closed_form() {
    let stroke = TMD.coupled().steady_stroke_max([5.0, 8.0]).value;
    for (allowed, violation) in [(1.01 * stroke, 0.0), (0.5 * stroke, 1.0)] {
        let limits = limits(Some(allowed), Some(1.0), None);
        let found =
            evaluate(&Goal { objective: steady(), limits, ..WINDOW.into() }, &TMD.scene(), f64::INFINITY);
        assert!(
            (found.violation - violation).abs() < 1e-12
                && found.reached.get(Limit::Of(Measure::ContactForce)) == 0.0
        );
    }
}

/// At any cutoff a value is either the full one, or both are above the cutoff.
#[test]
fn invariant_values_below_a_cutoff_are_exact() {
    let designs = [SSVI, Numbers { k2: 400.0, ..SSVI }, Numbers { c: 0.1, ..SSVI }].map(|n| n.scene());
    let stroke = evaluate(&goal(Some(1.0), None, None), &designs[0], f64::INFINITY)
        .reached
        .get(Limit::Of(Measure::Stroke));
    for goal in
        [goal(Some(stroke), None, Some(0.3)), goal(Some(stroke), None, None), goal(None, Some(30.0), None)]
    {
        let full = designs.map(|scene| evaluate(&goal, &scene, f64::INFINITY).ranked);
        for cutoff in
            full.iter().flat_map(|v| [v * (1.0 - 1e-9), *v, v * (1.0 + 1e-9)]).chain([0.0, 1.0, INFEASIBLE])
        {
            for (scene, full) in designs.iter().zip(full) {
                let cut = evaluate(&goal, scene, cutoff).ranked;
                assert!(cut == full || (cut > cutoff && full > cutoff), "{cut} {full} {cutoff}");
            }
        }
    }
}

/// The best c2 of a TMD whose steady stroke may not pass a limit lies on the limit: compared with bisection of the closed form.
#[test]
fn exact_a_search_ends_on_an_active_limit() {
    let of = |c2: f64| Numbers { k2: 2083.0, c2, ..TMD };
    let stroke = |c2: f64| of(c2).coupled().steady_stroke_max([5.0, 8.0]).value;
    let value = |c2: f64| of(c2).coupled().steady_e1_max([5.0, 8.0]).value;
    let (mut low, mut high) = (120.0, 500.0); // more damping reduces the stroke, but E1max is worse than with the tuned damping
    let limit = 0.7 * stroke(low);
    assert!(stroke(high) < limit && value(low) < value(high));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stroke(middle) < limit { high = middle } else { low = middle }
    }
    let goal = Goal { objective: steady(), limits: limits(Some(limit), None, None), ..WINDOW.into() };
    let numbers = of(150.0);
    let objective = DesignObjective::new(
        numbers.scene(),
        numbers.damper(),
        vec![Parameter::C2],
        goal,
        Settings::default(),
    );
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

/// Limits hold from the start unless they say otherwise: a design may keep them in the window and break them before it.
#[test]
fn contract_limits_hold_over_the_whole_run_or_from_when_they_say() {
    let scene = Numbers { c2: 100.0, ..SSVI }.scene();
    let window = Window { from: 4.0, to: 8.0 };
    let run = |from| simulate(&scene, Window { from, ..window }, &Settings::default()).expect("a run");
    let reached = |from| {
        let from = NonNegative::new(from).ok();
        let goal = Goal { limits: limits(Some(1.0), Some(1e9), None).since(from), ..window.into() };
        let found = evaluate(&goal, &scene, f64::INFINITY);
        assert_eq!(found.ranked, run(4.0).e1_max.value);
        [found.reached.get(Limit::Of(Measure::Stroke)), found.reached.get(Limit::Of(Measure::ContactForce))]
    };
    for from in [0.0, 2.0, 4.0, 6.0] {
        let run = run(from);
        let expected = [run.spring_deflection_max, run.force_max[0].max(run.force_max[1])];
        for (found, expected) in reached(from).into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-7, "{from}: {found} {expected}");
        }
    }
    assert_eq!(limits(Some(1.0), None, None).also().map(|also| also.from), Some(0.0));
    let [whole, late] = [0.0, 6.0].map(reached);
    assert!(whole[0] > late[0] || whole[1] > late[1], "{whole:?} {late:?}");
}

/// Between its samples a band hides peaks of stroke and force that E1max does not share. Each of these designs keeps a limit on all
/// 31 samples and breaks it between them, as 601 show.
#[test]
fn contract_peaks_of_stroke_and_force_are_searched_where_they_could_break_a_limit() {
    let designs = [
        (
            Limit::Of(Measure::Stroke),
            Numbers {
                k2: 874.395_581_926_651_5,
                c2: 65.136_152_543_454_94,
                d: 0.086_510_911_250_101_19,
                c: 0.651_346_567_938_503_7,
                ..SSVI
            },
        ),
        (
            Limit::Of(Measure::ContactForce),
            Numbers {
                k2: 2_127.631_338_208_155_3,
                c2: 241.080_355_226_635_87,
                d: 0.037_706_540_553_365_58,
                c: 0.157_243_520_995_425_68,
                ..SSVI
            },
        ),
    ];
    for (limit, numbers) in designs {
        let found = |samples, allowed: f64| {
            let objective = Objective { omega: band(samples), ..Objective::default() };
            let limits = Limits::default().since(NonNegative::new(50.0).ok());
            let limits = limits.with(limit, positive(allowed));
            let goal = Goal { objective, limits, ..Window { from: 50.0, to: 100.0 }.into() };
            evaluate(&goal, &numbers.scene(), f64::INFINITY)
        };
        // No peak can break so loose a limit, so none is searched.
        let [coarse, fine] = [31, 601].map(|samples| found(samples, 1e9).reached.get(limit));
        assert!(fine > 1.005 * coarse, "{limit}: {fine} {coarse}");
        let kept_on_samples = found(31, 0.5 * (coarse + fine));
        assert!(kept_on_samples.violation > 0.0, "{limit}: {kept_on_samples:?} {fine}");
        assert!(kept_on_samples.reached.get(limit) > 0.9999 * fine, "{limit}: {kept_on_samples:?} {fine}");
        assert!(kept_on_samples.runs < 31 + 12 * 8, "{kept_on_samples:?}");
    }
}

/// The decay time of an objective is the longest over its structures, which a limit may bound; where one is not within the run there is no value.
#[test]
fn exact_a_decay_time_is_the_longest_of_the_structures() {
    let window = Window { from: 0.0, to: 14.0 };
    let scene = SSVI.under(pulse(Of::Force, Shape::HalfSine, 9000.0, 0.4));
    let stiffnesses = [2e4, 3.95e4, 6e4];
    let times = stiffnesses.map(|k1| {
        let scene = Parameter::K1.at(scene, k1).expect("a scene");
        decay_time(&scene, window.to, &Settings::default()).expect("a run").expect("a time")
    });
    let longest = times.into_iter().fold(0.0, f64::max);
    assert!(longest > times[1] && longest.is_finite(), "{times:?}");
    let k1 = Some(Stiffnesses::Set(stiffnesses.map(positive).to_vec()));
    let goal = |quantity, limits, window: Window| Goal {
        objective: Objective { quantity, k1: k1.clone(), ..Objective::default() },
        limits,
        ..window.into()
    };
    let decay = goal(Measure::DecayTime, Limits::default(), window);
    let found = evaluate(&decay, &scene, f64::INFINITY);
    assert_eq!([found.value, found.worst.largest], [longest; 2]);
    let limits = Limits::default().with(Limit::Of(Measure::DecayTime), positive(longest / 1.25));
    let limited = evaluate(&goal(Measure::Energy, limits, window), &scene, f64::INFINITY);
    assert_eq!(limited.reached.get(Limit::Of(Measure::DecayTime)), longest);
    assert!((limited.violation - 0.25).abs() < 1e-12, "{}", limited.violation);
    let short = Window { to: 0.5 * (longest + times[1]), ..window };
    for goal in [goal(Measure::DecayTime, Limits::default(), short), goal(Measure::Energy, limits, short)] {
        let found = goal.evaluate(&scene, &Settings::default(), f64::INFINITY);
        assert_eq!(found.err(), Some(Unusable::NotDecayed { to: short.to }));
    }
    let objective = DesignObjective::new(
        scene,
        scene.damper.expect("a damper"),
        vec![Parameter::K2],
        decay.clone(),
        Settings::default(),
    );
    let by = objective.gradient(&[SSVI.k2], &|| true);
    assert_eq!((by.err(), decay.has_pieces()), (Some(Unusable::NoDerivatives), false));
}

#[test]
fn contract_limits_have_names_and_units() {
    let told = Limit::ALL.map(|limit| (limit.name(), limit.unit()));
    let cavity = format!("{:>7}", Limit::Cavity);
    assert_eq!((cavity.as_str(), told[1], told[9]), (" cavity", ("x1max", "m"), ("cavity", "m")));
    for limit in Limit::ALL {
        let text = format!("{{\"{limit}\": 2}}");
        let limits: Limits = serde_json::from_str(&text).expect("a limit by its name");
        assert_eq!((limits.get(limit), limits.set().count()), (Some(2.0), 1));
    }
}
