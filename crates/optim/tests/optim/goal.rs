//! Composed objectives: stiffnesses, ensembles and sums agree with their single runs, and a cutoff changes no value below it.

use retune_model::{Forcing, Of, Positive, Scene, Shape};
use retune_optim::{
    Ensemble, Evaluation, FrequencyBand, Goal, Objective, Part, Response, Statistic, StiffnessRange,
    Stiffnesses,
};
use retune_solver::{Ask, Settings, Settle, Window, extremes};
use retune_testkit::histories::pulse;
use retune_testkit::scenes::{Numbers, SSVI, TMD};

const WINDOW: Window = Window { from: 2.0, to: 8.0 };

fn positive(value: f64) -> Positive {
    Positive::new(value).expect("above 0")
}

fn band() -> Option<FrequencyBand> {
    Some(FrequencyBand { from: positive(5.5), to: positive(7.0), samples: 4, relative: false })
}

fn set(stiffnesses: &[f64]) -> Option<Stiffnesses> {
    Some(Stiffnesses::Set(stiffnesses.iter().map(|k1| positive(*k1)).collect()))
}

fn goal(objective: Objective, window: Window) -> Goal {
    Goal { objective, ..window.into() }
}

fn evaluate(objective: Objective, scene: &Scene, cutoff: f64) -> Evaluation {
    goal(objective, WINDOW).evaluate(scene, &Settings::default(), cutoff).expect("a value")
}

fn value(objective: &Objective, scene: &Scene) -> f64 {
    evaluate(objective.clone(), scene, f64::INFINITY).ranked
}

fn ensemble(statistic: Statistic) -> Ensemble {
    Ensemble { members: 12, phases: true, errors: 0.01, seed: 3, statistic }
}

/// The worst, the mean and a quantile over records are those of the single runs; the worst run has its record; a cutoff changes nothing below.
#[test]
fn exact_a_statistic_over_records_is_that_of_single_runs() {
    let under = |peak, duration| SSVI.under(pulse(Of::Force, Shape::HalfSine, peak, duration));
    let scenes = [under(4000.0, 0.3), under(9000.0, 0.2), under(2000.0, 0.7), under(-6000.0, 0.2)];
    let records: Vec<Forcing> = scenes.iter().map(|scene| scene.forcing).collect();
    let each = scenes.map(|scene| value(&Objective::default(), &scene));
    let (worst, mean) = (each.iter().copied().fold(0.0, f64::max), each.iter().sum::<f64>() / 4.0);
    assert!(worst == each[1] && mean < 0.9 * worst, "{each:?}");
    let of = |records_by| Objective { records: records.clone(), records_by, ..Objective::default() };
    let found = evaluate(of(None), &scenes[0], f64::INFINITY);
    assert_eq!((found.value, found.runs), (worst, 4));
    assert_eq!(found.worst_run(scenes[0], &goal(of(None), WINDOW)), scenes[1]);
    assert_eq!(value(&of(Some(Statistic::Mean)), &scenes[0]), mean);
    let mut sorted = each;
    sorted.sort_by(f64::total_cmp);
    assert_eq!(value(&of(Some(Statistic::Quantile(0.5))), &scenes[0]), sorted[1]);
    for (objective, value) in [(of(None), worst), (of(Some(Statistic::Mean)), mean)] {
        assert_eq!(evaluate(objective.clone(), &scenes[0], 1.01 * value).value, value);
        assert!(evaluate(objective, &scenes[0], 0.5 * value).value > 0.5 * value);
    }
}

#[test]
fn exact_the_worst_over_stiffnesses_is_the_worst_of_its_bands() {
    let term = Objective { omega: band(), ..Objective::default() };
    let stiffnesses = [3e4, 5e4, SSVI.k1];
    let each = stiffnesses.map(|k1| value(&term, &Numbers { k1, ..SSVI }.scene()));
    let found = evaluate(Objective { k1: set(&stiffnesses), ..term.clone() }, &SSVI.scene(), f64::INFINITY);
    let worst = each.iter().copied().fold(0.0, f64::max);
    assert!(
        found.ranked == worst && each[1] == worst,
        "the worst is neither the first nor the last: {each:?}"
    );
    let k1 = found.worst.scene.primary.stiffness.get();
    assert_eq!(each[stiffnesses.iter().position(|other| *other == k1).expect("one of them")], worst);
    // A range includes its ends and is refined between them: of the bare structure at ω = 6, in closed form, k1 = m1 ω².
    let range = Stiffnesses::Range(StiffnessRange { from: positive(3e4), to: positive(5e4), samples: 5 });
    let bare = Numbers { omega: 6.0, ..TMD }.bare_scene();
    let found = evaluate(
        Objective { k1: Some(range), response: Response::Steady, ..Objective::default() },
        &bare,
        f64::INFINITY,
    );
    let near = 0.5 * (TMD.p / (TMD.c1 * 6.0)).powi(2) * 3.6e4;
    assert!((found.ranked / near - 1.0).abs() < 0.01 && found.ranked >= near, "{} {near}", found.ranked);
    assert!((found.worst.scene.primary.stiffness.get() / 3.6e4 - 1.0).abs() < 0.02);
}

#[test]
fn exact_a_relative_band_moves_with_the_structure() {
    let relative = FrequencyBand { from: positive(0.9), to: positive(1.1), samples: 3, relative: true };
    for k1 in [2e4, TMD.k1] {
        let scene = Numbers { k1, ..TMD }.scene();
        let natural = (k1 / TMD.m1).sqrt();
        let found = value(
            &Objective { omega: Some(relative), response: Response::Steady, ..Objective::default() },
            &scene,
        );
        let steady = Numbers { k1, ..TMD }.coupled().steady_e1_max([0.9 * natural, 1.1 * natural]);
        assert!((found / steady.value - 1.0).abs() < 1e-14, "{found} {steady:?}");
    }
}

#[test]
fn exact_statistics_are_those_of_the_members() {
    let each: Vec<f64> = (0..12)
        .map(|i| {
            let (scene, phase) = ensemble(Statistic::Mean).member(&SSVI.scene(), i).expect("a member");
            let ask = Ask { phase, ..Ask::default() };
            extremes(&scene, WINDOW, &Settings::default(), ask).expect("a run").largest.value
        })
        .collect();
    let mut sorted = each.clone();
    sorted.sort_by(f64::total_cmp);
    assert!(sorted[0] < 0.95 * sorted[11], "the members differ: {sorted:?}");
    let of = |statistic| {
        value(&Objective { ensemble: Some(ensemble(statistic)), ..Objective::default() }, &SSVI.scene())
    };
    assert!((of(Statistic::Mean) / (each.iter().sum::<f64>() / 12.0) - 1.0).abs() < 1e-14);
    assert_eq!(of(Statistic::Worst), sorted[11]);
    // 0.75 of 12 members are 9; a little more needs a tenth.
    assert_eq!([of(Statistic::Quantile(0.75)), of(Statistic::Quantile(0.76))], [sorted[8], sorted[9]]);
    assert_eq!([of(Statistic::Quantile(1e-9)), of(Statistic::Quantile(1.0))], [sorted[0], sorted[11]]);
}

#[test]
fn invariant_members_fill_their_space_and_stay_within_their_errors() {
    let all = Ensemble { members: 64, ..ensemble(Statistic::Mean) };
    let mut phases = Vec::new();
    for i in 0..64 {
        let (scene, phase) = all.member(&SSVI.scene(), i).expect("a member");
        let damper = scene.damper.expect("a damper");
        for (value, own) in [
            (scene.primary.stiffness.get(), SSVI.k1),
            (damper.stiffness.get(), SSVI.k2),
            (damper.damping.get(), SSVI.c2),
            (damper.rest_distance.get(), SSVI.d),
            (damper.clearance.get(), SSVI.c),
        ] {
            assert!((value / own - 1.0).abs() <= 0.01 && value != own, "{value} {own}");
        }
        phases.push(phase / std::f64::consts::TAU);
    }
    phases.sort_by(f64::total_cmp);
    // A Sobol sequence has one of its first 64 points in each 64th of every axis.
    assert!(phases.iter().enumerate().all(|(i, p)| (p * 64.0).floor() == i as f64), "{phases:?}");
    let exact = Ensemble { phases: false, errors: 0.0, ..all };
    assert_eq!(exact.member(&SSVI.scene(), 5), Ok((SSVI.scene(), 0.0)));
}

#[test]
fn contract_a_sum_is_weighted_and_exact_below_a_cutoff() {
    let [one, two] = [band(), None].map(|omega| Objective { omega, ..Objective::default() });
    let robust = |statistic| Objective { ensemble: Some(ensemble(statistic)), ..Objective::default() };
    let scene = SSVI.scene();
    let [a, b] = [&one, &two].map(|objective| value(objective, &scene));
    let part =
        |weight, objective: &Objective| Part { weight: positive(weight), objective: objective.clone() };
    // A sum within a sum: its weights are products.
    let inner = Objective { sum: vec![part(0.5, &two)], ..Objective::default() };
    let goals = [
        Objective { sum: vec![part(0.25, &one), part(4.0, &inner)], ..Objective::default() },
        robust(Statistic::Mean),
        robust(Statistic::Worst),
        robust(Statistic::Quantile(0.6)),
        one,
        Objective { k1: set(&[3e4, 4e4]), ..Objective::default() },
    ]
    .map(|objective| goal(objective, WINDOW));
    let of =
        |goal: &Goal, cutoff| goal.evaluate(&scene, &Settings::default(), cutoff).expect("a value").ranked;
    assert!((of(&goals[0], f64::INFINITY) / (0.25 * a + 2.0 * b) - 1.0).abs() < 1e-14);
    for goal in &goals {
        let full = of(goal, f64::INFINITY);
        for share in [0.0, 0.3, 0.9, 1.0 - 1e-12, 1.0, 1.0 + 1e-12, 1.1] {
            let (cutoff, cut) = (share * full, of(goal, share * full));
            assert!(if full <= cutoff { cut == full } else { cut > cutoff }, "{share}: {cut} {full}");
        }
    }
}

/// A settled objective without contacts equals the steady one; with contacts it counts the runs that have not settled.
#[test]
fn exact_settled_is_steady_where_nothing_touches() {
    let window = Window { from: 20.0, to: 60.0 };
    let settled = |settle| {
        let objective =
            Objective { omega: band(), response: Response::Settled, settle, ..Objective::default() };
        move |scene: &Scene| {
            goal(objective.clone(), window)
                .evaluate(scene, &Settings::default(), f64::INFINITY)
                .expect("a value")
        }
    };
    let found = settled(Settle::default())(&TMD.scene());
    let steady = Objective { omega: band(), response: Response::Steady, ..Objective::default() };
    let steady = value(&steady, &TMD.scene());
    assert!((found.ranked / steady - 1.0).abs() < 1e-7 && found.unsettled == 0);
    let never = Settle { tolerance: 1e-300, ..Settle::default() };
    let found = settled(never)(&SSVI.scene());
    assert!(found.unsettled == found.runs && found.runs >= 4, "{found:?}");
}

/// Evaluation stops once a value is known to exceed the cutoff: after each stiffness, and after each group of eight members.
#[test]
fn contract_nothing_is_run_beyond_a_cutoff() {
    let set = Objective { k1: set(&[3e4, 4e4, 5e4]), ..Objective::default() };
    let scene = SSVI.scene();
    let [first, _, last] =
        [3e4, 4e4, 5e4].map(|k1| value(&Objective::default(), &Numbers { k1, ..SSVI }.scene()));
    assert!(first < last);
    for (cutoff, runs) in [(0.0, 1), (0.5 * first, 1), (f64::INFINITY, 3)] {
        assert_eq!(evaluate(set.clone(), &scene, cutoff).runs, runs, "{cutoff}");
    }
    for (statistic, cutoff, expected) in [
        (Statistic::Mean, 0.28, 7),
        (Statistic::Mean, 0.3, 15),
        (Statistic::Mean, 0.5, 15),
        (Statistic::Mean, 2.0, 24),
        (Statistic::Worst, 0.9, 1),
        (Statistic::Worst, 1.0, 24),
        (Statistic::Quantile(0.5), 0.9, 15),
        (Statistic::Quantile(0.5), 1.0, 24),
    ] {
        let ensemble = Ensemble { members: 24, ..ensemble(statistic) };
        let run = std::sync::atomic::AtomicU32::new(0);
        let one = |_, _| {
            run.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            Ok::<f64, ()>(1.0)
        };
        let found = ensemble.over(one, cutoff).expect("no failures");
        assert_eq!(run.into_inner(), expected, "{statistic:?} {cutoff}");
        assert!(if cutoff < 1.0 { found > cutoff } else { found == 1.0 }, "{statistic:?} {cutoff} {found}");
    }
}
