//! Rigid walls: impacts that jump, chatter that ends, and dampers that a wall holds.

use crate::problems::{assert_close, assert_states};
use retune_model::{Coupled, Side};
use retune_solver::observe::{Impact, Observer};
use retune_solver::{Hybrid, Method, Motion, Settings, SolverError, Window, simulate};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TWO_SIDED};
use serde::Deserialize;

/// All impacts of a run.
#[derive(Default)]
pub struct Impacts(pub Vec<Impact<4>>);

impl Observer<4> for Impacts {
    fn impact(&mut self, impact: &Impact<4>) {
        self.0.push(*impact);
    }
}

/// A run from its start, its impacts and its end.
pub fn run(system: &Coupled, to: f64) -> (Vec<Impact<4>>, Motion) {
    let mut seen = Impacts::default();
    let mut hybrid = Hybrid::new(system, 1e-10, to, 20_000_000);
    let end = hybrid.propagate(Motion::start(system), to, &mut seen).expect("a run");
    (seen.0, end)
}

/// Under a constant force the structure comes up to a damper that nothing else moves: `r'' = -α`, α = P/m1. From the gap h it strikes after
/// `√(2h/α)` with the speed `v = √(2hα)`, then after flights of `2 eᵏ v/α`, which last `2 e v / (α (1 - e))` in all. From then on both
/// bodies are one; their common momentum is `P t` all the time.
#[test]
fn exact_chatter_on_a_wall_is_a_geometric_series() {
    for e in [0.0, 0.05, 0.3, 0.7, 0.9, 0.99] {
        let numbers = Numbers {
            c1: 0.0,
            k1: 0.0,
            omega: 0.0,
            p: 300.0,
            k2: 0.0,
            c2: 0.0,
            d: 0.05,
            c: 1e3,
            rigid: Some(e),
            ..SSVI
        };
        let (h, alpha, [m1, m2]) = (numbers.d, numbers.p / numbers.m1, [numbers.m1, numbers.m2]);
        let (first, speed) = ((2.0 * h / alpha).sqrt(), (2.0 * h * alpha).sqrt());
        let last = first + 2.0 * e * speed / (alpha * (1.0 - e));
        let (impacts, end) = run(&numbers.coupled(), last + 3.0);
        // A speed is known to the last place of those of the bodies, and the rest of the chatter is in proportion to it.
        let fastest = numbers.p / numbers.m1 * last;
        let within = 5e-14 * (last + fastest / (alpha * (1.0 - e)));
        let mut expected = first;
        for (k, impact) in impacts.iter().enumerate() {
            assert_eq!((impact.side, impact.caught), (Side::Primary, k + 1 == impacts.len()), "{e} {k}");
            let off = impact.before.t - expected;
            assert!(off.abs() < within, "{e} {k}: {off:e}, {within:e}");
            expected += 2.0 * e.powi(k as i32 + 1) * speed / alpha;
        }
        // Ended by rounding of the speeds, not before and not much later: 64 units in the last place.
        let caught = impacts.last().expect("a catch");
        let off = caught.after.t - last;
        assert!(caught.caught && off.abs() < 2.0 * within, "{e}: {off:e}, {within:e}");
        let least = if e == 0.0 { 1.0 } else { (1e-15_f64.ln() / e.ln()).ceil() };
        assert!(impacts.len() as f64 <= least + 2.0, "{e}: {} impacts", impacts.len());
        // The rest is one body: the centre of mass moves by P t² / 2M.
        let (t, y, m) = (end.t, end.y, m1 + m2);
        let centre = (m1 * y[0] + m2 * (y[2] - h)) / m;
        assert!((centre - numbers.p * t * t / (2.0 * m)).abs() < 1e-12 * centre, "{e}");
        assert!((y[1] - numbers.p * t / m).abs() < 1e-12 * y[1], "{e}: {:e}", y[1] - numbers.p * t / m);
        assert_eq!((y[1], (y[2] - y[0]).abs() < 1e-14), (y[3], true), "{e}");
    }
}

/// The energy that impacts lose is `(1 - e²) w² / 2(1/m1 + 1/m2)` each, momentum is kept, and the relative speed is `-e` times itself.
#[test]
fn exact_impacts_lose_what_newtons_law_says() {
    let mut draw = Spread::new(3);
    let mut seen = 0;
    for _ in 0..40 {
        let e = draw.unit();
        let numbers = Numbers { p: 800.0, omega: 5.0 + 3.0 * draw.unit(), rigid: Some(e), ..TWO_SIDED };
        let system = numbers.coupled();
        let (impacts, _) = run(&system, 20.0);
        for Impact { side, before, after, caught, .. } in &impacts {
            let [w, parted] = [before, after].map(|at| side.sign() * (at.y[3] - at.y[1]));
            let e = if *caught { 0.0 } else { e };
            let size = before.y[1].abs() + before.y[3].abs();
            assert!((parted + e * w).abs() <= 4e-16 * size, "{e} {w} {parted}");
            let momentum = system.momentum(&after.y) - system.momentum(&before.y);
            assert!(momentum.abs() <= 1e-14 * numbers.m1 * size, "{momentum:e}");
            let lost = system.total_energy(&before.y) - system.total_energy(&after.y);
            let expected = 0.5 * (1.0 - e * e) * w * w / system.inverse_effective_mass();
            assert!((lost - expected).abs() <= 1e-12 * system.total_energy(&before.y), "{lost} {expected}");
        }
        seen += impacts.len();
    }
    assert!(seen > 1000, "{seen}");
}

#[derive(Deserialize)]
struct File {
    scenes: Vec<Reference>,
}

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "the paper's symbols, as in the file")]
struct Reference {
    name: String,
    m1: f64,
    c1: f64,
    k1: f64,
    m2: f64,
    k2: f64,
    c2: f64,
    D: f64,
    C: f64,
    P: f64,
    omega: f64,
    e: f64,
    T: f64,
    E1max: f64,
    v1max: f64,
    stroke: f64,
    lost: f64,
    holds: u64,
    impacts_primary: u64,
    impacts_obstacle: u64,
    state_T: [f64; 4],
}

/// SciPy's DOP853 with events (`tests/reference/rigid_scenes.py`, which made the numbers without Retune).
#[test]
fn reference_scipys_dop853_with_events() {
    let file: File =
        serde_json::from_str(include_str!("../../../../tests/reference/rigid_scenes.json")).expect("scenes");
    let both = |s: &&Reference| s.impacts_primary > 0 && s.impacts_obstacle > 0;
    let held = file.scenes.iter().filter(|s| s.holds > 0).count();
    assert!(file.scenes.iter().filter(both).count() >= 20 && held >= 10);
    for s in &file.scenes {
        let numbers = Numbers {
            m1: s.m1,
            c1: s.c1,
            k1: s.k1,
            m2: s.m2,
            k2: s.k2,
            c2: s.c2,
            d: s.D,
            c: s.C,
            p: s.P,
            omega: s.omega,
            rigid: Some(s.e),
            ..SSVI
        };
        let window = Window { from: 0.0, to: s.T };
        let found = simulate(&numbers.scene(), window, &Settings::default()).expect("a run");
        let name = &s.name;
        assert_close(found.e1_max.value, s.E1max, s.E1max, 1e-9, name);
        assert_close(found.structure.velocity.value, s.v1max, s.v1max, 1e-9, name);
        assert_close(found.spring_deflection_max, s.stroke, s.stroke, 1e-9, name);
        assert_states(found.final_state, s.state_T, [1.0, 1.0], 1e-9, name);
        let (impacts, _) = run(&numbers.coupled(), s.T);
        let system = numbers.coupled();
        let lost = |i: &Impact<4>| system.total_energy(&i.before.y) - system.total_energy(&i.after.y);
        assert_close(impacts.iter().map(lost).sum(), s.lost, s.lost, 1e-9, name);
        assert_eq!(impacts.iter().filter(|i| i.caught).count() as u64, s.holds, "{name}");
        if s.holds == 0 {
            assert_eq!(found.impacts, [s.impacts_primary, s.impacts_obstacle], "{name}");
        }
    }
}

/// A damper that starts on a wall, D = 0, is held by it until the structure's acceleration, `P cos(ωt)` over both masses, changes its sign. e = 1
/// works, too.
#[test]
fn exact_a_held_damper_leaves_where_the_force_changes_its_sign() {
    for e in [0.0, 0.5, 1.0] {
        let numbers = Numbers {
            c1: 0.0,
            k1: 0.0,
            omega: 2.0,
            k2: 40.0,
            c2: 30.0,
            d: 0.0,
            c: 9.0,
            rigid: Some(e),
            ..SSVI
        };
        let (system, half) = (numbers.coupled(), std::f64::consts::FRAC_PI_4);
        let (impacts, before) = run(&system, 0.999_999 * half);
        assert!(impacts.is_empty());
        let v = numbers.p / (numbers.m1 + numbers.m2) / 2.0 * (2.0 * before.t).sin();
        assert!((before.y[1] - v).abs() < 1e-15 && before.y[1] == before.y[3], "{e}");
        let (_, after) = run(&system, 1.1 * half);
        assert!(after.y[2] - after.y[0] > 1e-6, "{e}: {:?}", after.y);
        // Gap of a free flight from there: the cubic of its first derivative, P ω (t - t0)³ / 6 m1.
        let (_, soon) = run(&system, half + 1e-3);
        let (gap, cubic) = (soon.y[2] - soon.y[0], 800.0 * 2.0 * 1e-9 / 6.0 / numbers.m1);
        assert!((gap / cubic - 1.0).abs() < 1e-3, "{e}: {gap:e} {cubic:e}");
    }
}

/// Hertz's contacts without loss become rigid ones with e = 1 as they stiffen, at the rate of their duration, `K^(-2/5)`.
#[test]
fn order_stiff_contacts_tend_to_rigid_ones() {
    let window = Window { from: 0.0, to: 3.0 };
    let of = |numbers: Numbers| simulate(&numbers.scene(), window, &Settings::default()).expect("a run");
    let rigid = of(Numbers { rigid: Some(1.0), ..TWO_SIDED });
    let apart = |factor: f64| {
        let young = TWO_SIDED.young.map(|modulus| modulus * factor);
        let found = of(Numbers { young, ..TWO_SIDED });
        assert_eq!(found.impacts, rigid.impacts);
        (found.e1_max.value / rigid.e1_max.value - 1.0).abs()
    };
    let [coarse, fine] = [1e5, 1e10].map(apart);
    assert!(fine < 2e-5 && (30.0..300.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
}

#[test]
fn contract_general_methods_are_refused() {
    let numbers = Numbers { rigid: Some(0.7), ..TWO_SIDED };
    for method in [Method::Ode23s, Method::Dop853, Method::Rk4] {
        let settings = Settings { method, ..Settings::default() };
        let error = simulate(&numbers.scene(), Window { from: 0.0, to: 1.0 }, &settings).expect_err("a jump");
        assert_eq!(error, SolverError::RigidWalls { t: 0.0 });
    }
}
