//! Continuation on a system whose answer is known: Duffing's oscillator, by the general propagator.

use nalgebra::{DVector, Matrix4, SMatrix, Vector4};
use retune_dynamics::Error;
use retune_dynamics::periodic::deflate::another;
use retune_dynamics::periodic::forced::Flow;
use retune_dynamics::periodic::seen::Seen;
use retune_dynamics::periodic::shooting::Solution;
use retune_dynamics::periodic::trace::trace;
use retune_dynamics::periodic::{Branch, End, Event, EventKind, Forced, Orbit, Shooting};
use retune_solver::methods::{Dop853, Run};
use retune_solver::observe::Unobserved;
use retune_solver::{Settings, System};
use serde::Deserialize;
use std::f64::consts::TAU;

/// `x'' + 2 zeta x' + x + gamma x³ = f cos θ`, `θ = ωt`, along ω. The other two of the four numbers of a state are 0 and stay so.
#[derive(Clone, Copy, Debug, Deserialize)]
struct Duffing {
    zeta: f64,
    gamma: f64,
    f: f64,
}

/// It with its variational equations, over θ: `x, v`, and their derivatives by the first `x`, by the first `v`, and by ω.
struct Variational {
    duffing: Duffing,
    omega: f64,
}

impl System<8> for Variational {
    fn derivative(&self, theta: f64, y: &[f64; 8]) -> [f64; 8] {
        let (Duffing { zeta, gamma, f }, omega) = (self.duffing, self.omega);
        let (x, v) = (y[0], y[1]);
        let own = [v, f * theta.cos() - 2.0 * zeta * v - x - gamma * x * x * x];
        let linear = |a: f64, b: f64| [b, -2.0 * zeta * b - (1.0 + 3.0 * gamma * x * x) * a];
        let [by_x, by_v, by_omega] = [linear(y[2], y[3]), linear(y[4], y[5]), linear(y[6], y[7])];
        let slower = own.map(|rate| rate / omega);
        let by_omega = [by_omega[0] - slower[0], by_omega[1] - slower[1]];
        let all = [own, by_x, by_v, by_omega];
        std::array::from_fn(|i| all[i / 2][i % 2] / omega)
    }
    fn jacobian(&self, _theta: f64, _y: &[f64; 8]) -> SMatrix<f64, 8, 8> {
        unreachable!("an explicit method")
    }
    fn time_derivative(&self, _theta: f64, _y: &[f64; 8]) -> [f64; 8] {
        unreachable!("an explicit method")
    }
}

impl Forced for Duffing {
    fn flows(&self, omega: f64, periods: usize, states: &[[f64; 4]]) -> Result<Vec<Flow>, Error> {
        let share = periods as f64 * TAU / states.len() as f64;
        let settings = Settings { rtol: 1e-13, atol: 1e-15, ..Settings::default() };
        let system = Variational { duffing: *self, omega };
        let flow = |(k, y): (usize, &[f64; 4])| {
            let start = [y[0], y[1], 1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
            let mut run = Run::new(&system, &settings, k as f64 * share, start, share);
            run.integrate::<Dop853>((k + 1) as f64 * share, &mut Unobserved)?;
            let [x, v, a, b, c, d, by_x, by_v] = run.state();
            let mut by_state = Matrix4::zeros();
            by_state.fixed_view_mut::<2, 2>(0, 0).copy_from_slice(&[a, b, c, d]);
            Ok(Flow { end: [x, v, 0.0, 0.0], by_state, by_value: Vector4::new(by_x, by_v, 0.0, 0.0) })
        };
        states.iter().enumerate().map(flow).collect()
    }
    fn seen(&self, _omega: f64, _periods: usize, _states: &[[f64; 4]]) -> Result<Seen, Error> {
        Ok(Seen::default())
    }
}

/// What harmonic balance says (`tests/reference/duffing.py`).
#[derive(Deserialize)]
struct Reference {
    system: Duffing,
    main: Known,
    subharmonic: Known,
}

#[derive(Deserialize)]
struct Known {
    periods: usize,
    motion: Place,
    folds: Vec<Place>,
}

#[derive(Deserialize)]
struct Place {
    omega: f64,
    x: f64,
    v: f64,
}

fn reference() -> Reference {
    serde_json::from_str(include_str!("../../../../tests/reference/duffing.json")).expect("reference values")
}

/// The branch through a motion that harmonic balance has found.
fn branch(duffing: Duffing, known: &Known) -> Branch<Duffing> {
    let Known { periods, motion, .. } = known;
    let scale = Vector4::new(0.2, 0.05, 1.0, 1.0);
    let one =
        Shooting { forced: duffing, periods: *periods, segments: 1, span: 6.5, scale, is_floating: false };
    let start = one.unknowns(&[[motion.x, motion.v, 0.0, 0.0]], motion.omega);
    let seed = one.correct_at_value(&start).expect("the motion");
    let away = (&seed.x - &start).amax();
    assert!(away < 1e-9, "{away:e} from the motion of harmonic balance");
    trace(&one, &seed, [1.5, 8.0], &|| true).expect("a branch")
}

/// The folds of a branch, by their frequencies.
fn folds(branch: &Branch<Duffing>) -> Vec<&Event> {
    let mut folds: Vec<_> = branch.events.iter().filter(|event| event.kind == EventKind::Fold).collect();
    folds.sort_by(|a, b| a.orbit.value.total_cmp(&b.orbit.value));
    folds
}

fn compare(branch: &Branch<Duffing>, known: &Known) {
    let found = folds(branch);
    assert_eq!(found.len(), known.folds.len(), "{:?}", found.iter().map(|fold| fold.orbit.value));
    for (fold, known) in found.iter().zip(&known.folds) {
        let [x, v, ..] = fold.orbit.states[0];
        let off = [fold.orbit.value / known.omega - 1.0, x - known.x, (v - known.v) / known.omega];
        assert!(off.iter().all(|off| off.abs() < 1e-10), "{off:?}");
    }
}

/// The main resonance bends over: between two folds there are three motions, the middle one unstable.
#[test]
fn reference_the_folds_of_duffings_resonance() {
    let Reference { system, main, .. } = reference();
    let branch = branch(system, &main);
    assert_eq!(branch.ends, [End::Range; 2]);
    compare(&branch, &main);
    let [low, high] = [main.folds[0].omega, main.folds[1].omega];
    let stable = |place: usize| branch.is_stable_at(place);
    let places = folds(&branch).iter().map(|fold| fold.place).collect::<Vec<_>>();
    let (first, last) = (places[0].min(places[1]), places[0].max(places[1]));
    for (place, orbit) in branch.points.iter().enumerate() {
        let expected = (-2.0 * system.zeta * TAU / orbit.value).exp();
        let [a, b, ..] = orbit.multipliers;
        assert!(((a * b).re / expected - 1.0).abs() < 1e-9, "{:?} for {expected}", a * b);
        if place > first && place < last {
            assert!(!stable(place) && orbit.value > low && orbit.value < high, "{}", orbit.value);
        }
    }
}

/// The subharmonic resonance of order 3 is an isola: closed, between two folds, with a stable and an unstable side.
#[test]
fn reference_duffings_isola_of_three_periods() {
    let Reference { system, subharmonic, .. } = reference();
    let branch = branch(system, &subharmonic);
    assert_eq!(branch.ends, [End::Closed; 2]);
    compare(&branch, &subharmonic);
    let stable = (0..branch.points.len()).filter(|place| branch.is_stable_at(*place)).count();
    assert!(stable > 20 && branch.points.len() - stable > 20, "{stable} of {}", branch.points.len());
}

/// Between two folds there are three motions. Newton's iteration leads from rest to one of them, and kept away from that to another; from
/// elsewhere to the third, and then to none.
#[test]
fn reference_deflation_finds_all_three_motions() {
    let Reference { system, main, .. } = reference();
    let omega = f64::midpoint(main.folds[0].omega, main.folds[1].omega);
    let branch = branch(system, &main);
    let shooting = &branch.shooting;
    let passing = |pair: &&[Orbit]| (pair[0].value - omega) * (pair[1].value - omega) <= 0.0;
    let motion = |pair: &[Orbit]| shooting.correct_at_value(&shooting.unknowns(&pair[0].states, omega));
    let all: Vec<Solution> = branch.points.windows(2).filter(passing).filter_map(motion).collect();
    assert_eq!(all.len(), 3);
    let mut found: Vec<DVector<f64>> = Vec::new();
    let [first, .., last] = [[0.0, 0.0], [-5.0, 0.0], [5.0, 0.0], [0.0, 5.0]].map(|[x, v]| {
        let start = shooting.unknowns(&[[x, v, 0.0, 0.0]], omega);
        while let Some(motion) = another(shooting, &start, &found) {
            found.push(motion.x);
        }
        found.len()
    });
    assert!(first > 1 && last == 3, "{first}, then {last}");
    for known in &all {
        let nearest = found.iter().map(|x| (x - &known.x).amax()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-9, "{nearest:e} from {:?}", shooting.states(&known.x));
    }
}
