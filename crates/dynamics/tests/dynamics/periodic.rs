//! Periodic motions and their branches.

use nalgebra::{Complex, Vector4};
use retune_dynamics::Parameter;
use retune_dynamics::periodic::branches::{Control, Plan, equations};
use retune_dynamics::periodic::settle::{Settled, Starts, settle};
use retune_dynamics::periodic::shooting::Solution;
use retune_dynamics::periodic::{End, EventKind, Orbit, Shooting, branches, largest};
use retune_model::{Coupled, Measure};
use retune_solver::observe::Unobserved;
use retune_solver::{Follower, Method, Motion, Phase, Settings};
use retune_testkit::scenes::{Numbers, SSVI, TMD};
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};

/// One of the designs with 225.8 J from rest: in the middle of the band a motion of two periods coexists.
const WITH_ISOLA: Numbers = Numbers {
    k2: 597.2737982898645,
    c2: 95.72415913882642,
    d: 0.6072128825900359,
    c: 0.03740508433492577,
    ..SSVI
};

/// A state of that motion at a crest of the force, from a run at 6 rad/s.
fn on_isola(omega: f64) -> Option<(Shooting, Solution)> {
    let shooting = shooting(&WITH_ISOLA, omega);
    let scene = shooting.scene_at(omega).expect("a scene");
    let system = shooting.system(omega).expect("a system");
    let starts = Starts::over(&scene, Parameter::Omega, [omega; 2]).expect("starts");
    (0..16).map(|number| starts.state(number, &system)).find_map(|y| {
        match settle(&shooting, omega, y).expect("a run") {
            Settled::On(2, solution) => Some((shooting.of_periods(2), solution)),
            _ => None,
        }
    })
}

fn shooting(numbers: &Numbers, omega: f64) -> Shooting {
    let scene = Numbers { omega, ..*numbers }.scene();
    Shooting::new(scene, Parameter::Omega, 1, (3.0, 30.0), &Settings::default())
}

fn plan(samples: usize, starts: usize) -> Plan {
    Plan { samples, starts, passes: 2, ..Plan::over(Parameter::Omega, [5.0, 8.0]) }
}

/// Without a spring a damper repeats wherever it floats, if it touches no wall. Once such motions were called irregular.
#[test]
fn exact_a_damper_that_floats_repeats() {
    let floating = Numbers { k2: 0.0, c2: 60.0, d: 1.0, c: 1.0, p: 100.0, ..SSVI };
    let found = branches(&floating.scene(), plan(4, 4), &Settings::default(), Control::default());
    let found = found.expect("branches");
    let [branch] = &found.branches[..] else { panic!("{} branches", found.branches.len()) };
    assert_eq!(branch.ends, [End::Range; 2]);
    assert!(found.samples.iter().all(|sample| sample.irregular.is_empty()));
    assert!(found.is_reached_from_rest(0));
    for orbit in &branch.points {
        let steady = Numbers { omega: orbit.value, ..floating }.coupled().steady(orbit.value);
        let [own, exact] = [orbit.seen.largest(Measure::Energy), steady.e1_max];
        assert!((own / exact - 1.0).abs() < 1e-6, "{own} {exact} at {}", orbit.value);
    }
}

/// A damper that touches nothing: the branch is the steady response, its multipliers those of the linear flow.
#[test]
fn exact_the_branch_of_a_tmd() {
    let found =
        branches(&TMD.scene(), plan(4, 2), &Settings::default(), Control::default()).expect("branches");
    let [branch] = &found.branches[..] else { panic!("{} branches", found.branches.len()) };
    assert!(branch.events.is_empty() && branch.ends == [End::Range; 2]);
    assert_eq!([branch.points[0].value, branch.points[branch.points.len() - 1].value], [5.0, 8.0]);
    for orbit in &branch.points {
        let system = Numbers { omega: orbit.value, ..TMD }.coupled();
        let steady = system.steady(orbit.value);
        let velocity = Complex::new(0.0, orbit.value);
        let expected = [
            steady.x1.re,
            (steady.x1 * velocity).re,
            steady.x2.re + system.rest_distance(),
            (steady.x2 * velocity).re,
        ];
        for (found, expected) in orbit.states[0].iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{orbit:?} {expected}");
        }
        let period = TAU / orbit.value;
        let mut rates: Vec<Complex<f64>> =
            system.linear_part().0.complex_eigenvalues().iter().copied().collect();
        rates.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
        for (found, rate) in orbit.multipliers.iter().zip(&rates) {
            let expected = (rate * period).exp();
            // A pair may be in either order.
            let error = (found - expected).norm().min((found - expected.conj()).norm());
            // Newton's last change moves omega after they were computed, by less than 1e-10.
            assert!(error < 1e-10, "{found} {expected}");
        }
        assert!(
            (orbit.seen.largest(Measure::Energy) / steady.e1_max - 1.0).abs() < 1e-11,
            "{} {}",
            orbit.seen.largest(Measure::Energy),
            steady.e1_max
        );
    }
    let most = largest(branch, |orbit| orbit.seen.largest(Measure::Energy)).expect("a largest");
    let exact = TMD.coupled().steady_e1_max([5.0, 8.0]);
    assert!(
        (most.seen.largest(Measure::Energy) / exact.value - 1.0).abs() < 1e-10,
        "{} {}",
        most.seen.largest(Measure::Energy),
        exact.value
    );
}

/// Multipliers are those of the motion, into however many segments it is cut.
#[test]
fn invariant_multipliers_do_not_depend_on_the_segments() {
    let (own, solution) = on_isola(6.0).expect("the motion of two periods");
    let expected = Orbit::of(&own, &solution).expect("a motion");
    assert_eq!((expected.seen.impacts.as_str(), expected.is_stable()), ("OOS", true));
    let system = own.system(6.0).expect("a system");
    for segments in [1, 3, 5] {
        let cut = own.in_segments(segments);
        let share = 2.0 * TAU / 6.0 / segments as f64;
        let mut follower = Follower::new(&system, own.settings(), share);
        let mut states = vec![expected.states[0]];
        for k in 1..segments {
            let y = states[k - 1];
            let from = Motion { t: (k - 1) as f64 * share, y, phase: Phase::of(&system, &y) };
            states.push(follower.propagate(from, k as f64 * share, &mut Unobserved).expect("a run").y);
        }
        let solution = cut.correct_at_value(&cut.unknowns(&states, 6.0)).expect("a motion");
        let found = Orbit::of(&cut, &solution).expect("a motion");
        for (a, b) in found.multipliers.iter().zip(&expected.multipliers) {
            assert!((a - b).norm() < 1e-8, "{segments}: {a} {b}");
        }
        assert!(
            (found.seen.largest(Measure::Energy) - expected.seen.largest(Measure::Energy)).abs()
                < 1e-7 * expected.seen.largest(Measure::Energy)
        );
    }
    // Liouville: their product.
    let product: Complex<f64> = expected.multipliers.iter().product();
    let Numbers { m1, c1, m2, c2, .. } = WITH_ISOLA;
    let volume = (-2.0 * TAU / 6.0 * (c1 / m1 + c2 / m1 + c2 / m2)).exp();
    assert!((product.re / volume - 1.0).abs() < 1e-9 && product.im.abs() < 1e-12, "{product} {volume}");
}

/// An independent method: DOP853 with its own contacts brings the motion back to its first state.
#[test]
fn reference_a_periodic_motion_repeats_by_another_method() {
    let (own, solution) = on_isola(6.0).expect("the motion of two periods");
    let y = own.states(&solution.x)[0];
    let system: Coupled = own.system(6.0).expect("a system");
    let settings = Settings { method: Method::Dop853, rtol: 1e-12, atol: 1e-14, ..Settings::default() };
    let period = 2.0 * TAU / 6.0;
    let mut follower = Follower::new(&system, &settings, period);
    let from = Motion { t: 0.0, y, phase: Phase::of(&system, &y) };
    let end = follower.propagate(from, period, &mut Unobserved).expect("a run").y;
    let gap = (Vector4::from(end) - Vector4::from(y)).amax();
    assert!(gap < 1e-8, "{gap:e} {end:?} {y:?}");
}

/// The isola is closed; runs on either side of each of its folds stay on it, or leave it.
#[test]
fn invariant_the_folds_of_the_isola_are_bracketed_by_runs() {
    let (own, solution) = on_isola(6.0).expect("the motion of two periods");
    let branch =
        retune_dynamics::periodic::trace::trace(&own, &solution, [5.0, 8.0], &|| true).expect("a branch");
    assert_eq!(branch.ends, [End::Closed; 2]);
    let folds: Vec<&Orbit> = branch
        .events
        .iter()
        .filter(|event| event.kind == EventKind::Fold)
        .map(|event| &event.orbit)
        .collect();
    assert_eq!(folds.len(), 2, "{:?}", folds.iter().map(|orbit| orbit.value).collect::<Vec<_>>());
    let middle = 0.5 * (folds[0].value + folds[1].value);
    for fold in folds {
        assert!((fold.multipliers[0].re - 1.0).abs() < 1e-6, "{:?}", fold.multipliers);
        for (inward, stays) in [(1e-4, true), (-1e-4, false)] {
            let value = fold.value + inward * (middle - fold.value).signum();
            let single = shooting(&WITH_ISOLA, value);
            let stayed = match settle(&single, value, fold.states[0]).expect("a run") {
                Settled::On(periods, _) => periods == 2,
                Settled::Irregular(_) => false,
            };
            assert_eq!(stayed, stays, "{value}");
        }
    }
}

/// A nearly hard wall, an isola of three periods that comes close to the motion without impact where it grazes: steps that were too long for it
/// once left it there and went on along that motion, three times over, to the end of the range.
#[test]
fn regress_a_branch_is_not_left_at_a_grazing() {
    let omega = 5.769_055_381_949_458_5;
    let range = [0.8, 1.25].map(|share| share * 45_f64.sqrt());
    let scene = Numbers { k1: 4.5e4, ..SSVI }.scene();
    let single = equations(&scene, &Plan { range, ..plan(31, 16) }, &Settings::default()).expect("a scene");
    let y = [0.06457168485968567, 0.12152383649913526, 0.07098478068946441, 0.28044859432927244];
    let Settled::On(3, solution) = settle(&single, omega, y).expect("a run") else { panic!("three periods") };
    let own = single.of_periods(3);
    let branch = retune_dynamics::periodic::trace::trace(&own, &solution, range, &|| true).expect("a branch");
    assert_eq!(branch.ends, [End::Closed; 2]);
    for orbit in &branch.points {
        let moved = (orbit.states[0][3] - orbit.states[1][3]).abs();
        assert!(moved > 1e-6 && !orbit.seen.impacts.is_empty(), "{}: {:?}", orbit.value, orbit.seen);
    }
}

/// At a period doubling a motion of twice the period begins that settles on the one side, the single one on the other.
#[test]
fn invariant_a_period_doubling_is_bracketed_by_runs() {
    let found = branches(&WITH_ISOLA.scene(), plan(4, 0), &Settings::default(), Control::default())
        .expect("branches");
    let main = found.branches.iter().find(|branch| branch.shooting.periods == 1).expect("the main branch");
    let event = main.events.iter().find(|event| event.kind == EventKind::PeriodDoubling).expect("one");
    assert!((event.orbit.multipliers[0] + 1.0).norm() < 1e-7, "{:?}", event.orbit.multipliers);
    assert!(
        found.branches.iter().any(|branch| branch.shooting.periods == 2 && branch.ends[0] == End::Halved)
    );
    for (offset, expected) in [(-3e-3, 1), (3e-3, 2)] {
        let value = event.orbit.value + offset;
        match settle(&shooting(&WITH_ISOLA, value), value, event.orbit.states[0]).expect("a run") {
            Settled::On(periods, _) => assert_eq!(periods, expected, "{value}"),
            Settled::Irregular(_) => panic!("irregular at {value}"),
        }
    }
}

/// A search that is ended makes no more runs and motions, says so, and has what it found by then.
#[test]
fn contract_a_search_that_is_ended_says_so() {
    let search = |most: usize| {
        let asked = AtomicUsize::new(0);
        let proceed = || asked.fetch_add(1, SeqCst) < most;
        let control = Control { proceed: &proceed, ..Control::default() };
        let found =
            branches(&WITH_ISOLA.scene(), plan(4, 0), &Settings::default(), control).expect("branches");
        (found, asked.into_inner())
    };
    let (whole, all) = search(usize::MAX);
    assert!(!whole.ended && all > 150, "{all}");
    let (part, asked) = search(100);
    assert!(part.ended && part.branches.len() < whole.branches.len());
    assert!(asked < 110, "asked {asked} times");
    assert!(part.branches.iter().any(|branch| branch.ends.contains(&End::Ended)));
    let (none, _) = search(0);
    assert!(none.ended && none.samples.is_empty() && none.branches.is_empty());
}

/// Without damping the structure has no steady motion at its natural frequency: starts were infinite, and certificates went on for ever.
#[test]
fn regress_starts_at_the_resonance_of_an_undamped_structure_settle() {
    let numbers = Numbers { c1: 0.0, k2: 2100.0, c2: 112.0, ..TMD };
    let natural = (numbers.k1 / numbers.m1).sqrt();
    // The unit of states is that of the middle.
    for range in [[natural, 1.0001 * natural], [0.5 * natural, 1.5 * natural]] {
        let plan = Plan { range, ..plan(3, 8) };
        let found =
            branches(&numbers.scene(), plan, &Settings::default(), Control::default()).expect("branches");
        let [branch] = &found.branches[..] else { panic!("{} branches", found.branches.len()) };
        assert_eq!([branch.points[0].value, branch.points[branch.points.len() - 1].value], range);
        for sample in &found.samples {
            let settled = sample.attractors.iter().map(|attractor| attractor.starts).sum::<usize>();
            assert_eq!(settled, 1, "{sample:?}");
        }
    }
}

/// Of so many independent starts none falls onto a motion with the probability that is said, for the width that is said.
#[test]
fn exact_the_width_of_a_motion_that_starts_miss() {
    for (starts, share, missed) in [(496, 0.3, 0.01), (16, 0.05, 0.5), (1, 1.0, 0.25)] {
        let width = retune_dynamics::periodic::worst::width_missed(starts, share, missed);
        let probability = (1.0 - share * width).powi(starts as i32);
        assert!((probability / missed - 1.0).abs() < 1e-12, "{probability} {missed}");
    }
    let narrow = 3.0 * retune_dynamics::periodic::worst::width_missed(496, 0.3, 0.01);
    assert!((narrow - 0.0924).abs() < 1e-4, "{narrow}");
}
