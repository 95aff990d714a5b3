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

/// The structure alone, in its undamped steady motion `X cos ωt`, and a damper of a mass that it does not feel: a damper before a wall that
/// moves as it is told.
fn driven(amplitude: f64, numbers: Numbers) -> Numbers {
    let (k1, m1) = (4.0 * numbers.omega * numbers.omega, 1.0);
    Numbers {
        m1,
        c1: 0.0,
        k1,
        p: amplitude * (k1 - m1 * numbers.omega * numbers.omega),
        m2: 1e-13,
        ..numbers
    }
}

/// The impacts of a run from this place and speed of the damper relative to the structure at the phase φ of its motion.
fn impacts_from(numbers: &Numbers, phase: f64, amplitude: f64, [r, w]: [f64; 2], to: f64) -> Vec<Impact<4>> {
    let system = numbers.coupled().with_phase(phase);
    let [x1, v1] = [amplitude * phase.cos(), -amplitude * numbers.omega * phase.sin()];
    let begin =
        Motion { t: 0.0, y: [x1, v1, x1 + r, v1 + w], phase: retune_solver::Phase::Leaving(Side::Primary) };
    let mut seen = Impacts::default();
    Hybrid::new(&system, 1e-10, to, 1_000_000).propagate(begin, to, &mut seen).expect("a run");
    seen.0
}

/// C. Budd and F. Dux, Chattering and related behaviour in impact oscillators, Phil. Trans. R. Soc. A 347 (1994) 365: `ü + u = cos ωt` over a
/// wall at `u = σ`, which turns `u'` into `-r u'`. Motions with one impact in n periods are closed forms: between impacts at the phase φ,
/// `u = γ cos(ωt + φ) + A cos t + B sin t` with `γ = 1/(1 - ω²)`, so with `u(0) = u(T) = σ`, `u'(0) = -r u'(T)`, `T = 2πn/ω`. Here `u = D - r`: the wall
/// is the structure, which moves by `-X cos(ωt + φ)`, and drives u by `X ω² cos(ωt + φ)`.
#[test]
fn paper_budd_and_duxs_motions_with_one_impact() {
    let mut tried = 0;
    for (n, omega, r, sigma) in [
        (1.0, 2.6, 0.8, 0.0),
        (1.0, 2.4, 0.6, 0.1),
        (2.0, 4.4, 0.8, 0.0),
        (3.0, 6.3, 0.8, 0.05),
        (2.0, 4.2, 0.5, 0.0),
    ] {
        let (period, gamma) = (std::f64::consts::TAU * n / omega, 1.0 / (1.0 - omega * omega));
        let ([c, s], (mut low, mut high)) = ([period.cos(), period.sin()], (0.0, std::f64::consts::TAU));
        // For a phase: A from the place, B from the place one period later, and by how much the speeds miss the law.
        let motion = |phase: f64| {
            let a = sigma - gamma * phase.cos();
            let b = a * (1.0 - c) / s;
            let own = -gamma * omega * phase.sin();
            ([a, b], [own + b, own - a * s + b * c])
        };
        let misses = |phase: f64| {
            let (_, [after, before]) = motion(phase);
            after + r * before
        };
        // Its zeros with an impact from above the wall: u' > 0 before it, and u below σ all the way.
        let whole: Vec<f64> = (0..4000).map(|k| low + (high - low) * f64::from(k) / 4000.0).collect();
        for pair in whole.windows(2) {
            (low, high) = (pair[0], pair[1]);
            if misses(low) * misses(high) > 0.0 {
                continue;
            }
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if misses(low) * misses(middle) <= 0.0 { high = middle } else { low = middle }
            }
            let ([a, b], [after, before]) = motion(low);
            let u = |t: f64| gamma * (omega * t + low).cos() + a * t.cos() + b * t.sin();
            let below = (1..2000).all(|k| u(period * f64::from(k) / 2000.0) < sigma);
            if before <= 0.0 || !below {
                continue;
            }
            tried += 1;
            // u = (D - r)/L with the length L = X ω²: the wall r = 0 is at σ = D/L.
            let (d, length) = (sigma, 1.0);
            let amplitude = length / (omega * omega);
            let one = Numbers { omega, k2: 1e-13, c2: 0.0, d, c: 1e3, rigid: Some(r), ..SSVI };
            let impacts = impacts_from(
                &driven(amplitude, one),
                low + std::f64::consts::PI,
                amplitude,
                [0.0, -after],
                1.5 * period,
            );
            let first = impacts.first().expect("an impact");
            let w = first.before.y[1] - first.before.y[3];
            assert_eq!(impacts.len(), 1, "{n} {omega}");
            assert!(
                (first.before.t - period).abs() < 1e-9 * period,
                "{n} {omega}: {:e}",
                first.before.t - period
            );
            assert!((w - before).abs() < 1e-9 * before, "{n} {omega}: {w} {before}");
        }
    }
    assert!(tried >= 4, "{tried}");
}

/// The slow invariant manifold of the vibro-impact NES with two impacts a period (T. Theurich, M. Gross and M. Krack, Nonlinear Dyn. 98 (2019);
/// Theurich, Krack and Weidemann's ρ = (2/π) (1 - e)/(1 + e)): before a wall that moves by `X cos ωt` the free mass crosses a cavity of the
/// length L at the speed V in half a period, so `X² = ((L - πV/ω)/2)² + (V (1 - e)/(1 + e) ω)²`.
#[test]
fn paper_vibro_impact_nes_on_its_slow_invariant_manifold() {
    let (e, omega, length) = (0.8, 1.0, 2.0);
    for share in [1.05, 1.2, 1.4] {
        let v = share * length * omega / std::f64::consts::PI;
        let place = 0.5 * (length - std::f64::consts::PI * v / omega);
        let speed = v * (1.0 - e) / (1.0 + e);
        // It leaves the near wall for the far one with the speed V, where the structure is at `place` and has `speed`.
        let (amplitude, phase) = (place.hypot(speed / omega), (-speed / omega).atan2(place));
        let rho = 2.0 / std::f64::consts::PI * (1.0 - e) / (1.0 + e);
        let crossing = std::f64::consts::PI * v / omega;
        let manifold = (0.5 * (length - crossing)).hypot(0.5 * rho * crossing);
        assert!((amplitude / manifold - 1.0).abs() < 1e-14, "in the symbols of the paper");
        let half = 0.5 * length;
        let free = Numbers { omega, k2: 0.0, c2: 0.0, d: half, c: half, rigid: Some(e), ..SSVI };
        let impacts = impacts_from(
            &driven(amplitude, free),
            phase,
            amplitude,
            [0.0, v - speed],
            12.5 * std::f64::consts::PI,
        );
        assert_eq!(impacts.len(), 12, "{share}");
        for (k, impact) in impacts.iter().enumerate() {
            let t = std::f64::consts::PI / omega * (k + 1) as f64;
            assert!((impact.after.t - t).abs() < 1e-9, "{share} {k}: {:e}", impact.after.t - t);
            assert!((impact.after.y[3].abs() - v).abs() < 1e-9, "{share} {k}");
            assert_eq!(impact.side, if k % 2 == 0 { Side::Obstacle } else { Side::Primary });
        }
    }
}

/// The impact oscillator of COCO's recipes (H. Dankowicz and F. Schilder, Recipes for Continuation, 2013), k = 1, c = 0.1, A = 1, ω = 1, a wall
/// at 1, e = 0.8: its motion with one impact a period, by the closed form of the damped flow and Newton's law at the wall.
#[test]
fn paper_cocos_impact_oscillator() {
    let (c, omega, e, d) = (0.1, 1.0, 0.8, 1.0);
    let period = std::f64::consts::TAU / omega;
    let nu = (1.0_f64 - 0.25 * c * c).sqrt();
    let flow = |t: f64, a: f64, b: f64, phase: f64| {
        // u'' + c u' + u = cos(t + φ) has the steady motion sin(t + φ)/c at ω = 1.
        let (decay, turn) = ((-0.5 * c * t).exp(), nu * t);
        let free = decay * (a * turn.cos() + b * turn.sin());
        let rate = decay * ((nu * b - 0.5 * c * a) * turn.cos() - (nu * a + 0.5 * c * b) * turn.sin());
        [free + (t + phase).sin() / c, rate + (t + phase).cos() / c]
    };
    let motion = |phase: f64| {
        let a = d - phase.sin() / c;
        let (decay, [cos, sin]) = ((-0.5 * c * period).exp(), [(nu * period).cos(), (nu * period).sin()]);
        let b = a * (1.0 / decay - cos) / sin;
        ([a, b], flow(0.0, a, b, phase)[1], flow(period, a, b, phase)[1])
    };
    let misses = |phase: f64| {
        let (_, after, before) = motion(phase);
        after + e * before
    };
    let mut found = 0;
    for k in 0..4000 {
        let [mut low, mut high] = [k, k + 1].map(|k| period * f64::from(k) / 4000.0);
        if misses(low) * misses(high) > 0.0 {
            continue;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if misses(low) * misses(middle) <= 0.0 { high = middle } else { low = middle }
        }
        let ([a, b], after, before) = motion(low);
        let stays = (1..2000).all(|k| flow(period * f64::from(k) / 2000.0, a, b, low)[0] < d);
        if before <= 0.0 || !stays {
            continue;
        }
        found += 1;
        let one = Numbers { omega, k2: 1e-13, c2: c * 1e-13, d, c: 1e3, rigid: Some(e), ..SSVI };
        let impacts =
            impacts_from(&driven(1.0, one), low + std::f64::consts::PI, 1.0, [0.0, -after], 1.5 * period);
        let first = impacts.first().expect("an impact");
        let w = first.before.y[1] - first.before.y[3];
        assert!((first.before.t - period).abs() < 1e-9, "{:e}", first.before.t - period);
        assert!((w - before).abs() < 1e-9 * before, "{w} {before}");
    }
    assert!(found >= 1, "{found}");
}

/// Found by the hunt: at e = 0 an impact changes the speed of the structure, and with it the force that would hold the damper.
#[test]
fn regress_what_holds_the_damper_is_the_force_after_the_impact() {
    let hunt = retune_testkit::hunt::rigid::beside(&[1238, 1395, 1409, 1456]);
    hunt.passes();
}
