//! Contacts that lose energy: the law of Hunt and Crossley, and one restitution at every speed.

use crate::problems::{assert_close, assert_states};
use nalgebra::Matrix4;
use retune_model::{Coupled, Loss, NonNegative, Side};
use retune_solver::observe::{Knot, Observer, Segment};
use retune_solver::{Hybrid, Method, Motion, Phase, Response, Settings, Tangent, Window, simulate};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TWO_SIDED};
use serde::Deserialize;

fn restitution(lambda: f64, speed: f64) -> f64 {
    Loss::Damping(NonNegative::new(lambda).expect("a number")).restitution(speed)
}

/// Two bodies without spring, dashpot or force: the speed after over the speed before is that of the implicit relation.
#[test]
fn exact_restitution_of_the_undisturbed_collision() {
    let mut draw = Spread::new(11);
    for number in 0..100 {
        let free = Numbers { k1: 0.0, c1: 0.0, p: 0.0, k2: 0.0, c2: 0.0, c: 0.2, d: 0.1, ..SSVI };
        let speed = draw.logarithmic(1e-3, 10.0);
        let chi = draw.logarithmic(1e-3, 60.0);
        let numbers = Numbers {
            m2: draw.logarithmic(1.0, 3000.0),
            r: draw.logarithmic(0.2, 5.0),
            lambda: chi / speed,
            ..free
        };
        // Over six decades of speed.
        let numbers = if number < 25 { Numbers { e: 0.02 + 0.97 * draw.unit(), ..numbers } } else { numbers };
        let numbers = Numbers { e_obstacle: (number % 2 == 1).then(|| 0.02 + 0.97 * draw.unit()), ..numbers };
        let speed = if number < 25 { draw.logarithmic(1e-5, 10.0) } else { speed };
        let system = numbers.coupled();
        for side in Side::BOTH {
            let wall = system.wall(side);
            let v1 = 0.3 * draw.signed();
            let y = [0.1, v1, 0.1 + wall - side.sign() * 0.01, v1 + side.sign() * speed];
            let mut hybrid = Hybrid::new(&system, 1e-12, 1e9, 10_000_000);
            let begin = Motion { t: 0.0, y, phase: Phase::Flight };
            let mut last = After { side, system: &system, parted: None };
            hybrid.propagate(begin, 0.01 / speed + 1e4 / speed, &mut last).expect("a run");
            let found = last.parted.expect("a lift-off") / speed;
            let expected = match numbers.e_obstacle.filter(|_| side == Side::Obstacle) {
                Some(e) => e,
                None if numbers.e < 1.0 => numbers.e,
                None => restitution(numbers.lambda, speed),
            };
            let error = (found / expected - 1.0).abs();
            assert!(error < 1e-10 / expected, "{chi} {speed}: {found} {expected} {error:e}");
        }
    }
}

/// The speed at which a damper leaves a wall.
struct After<'a> {
    system: &'a Coupled,
    side: Side,
    parted: Option<f64>,
}

impl Observer<4> for After<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let [_, end] = segment.ends();
        if end.clock[0] == 0.0 && end.clock[1] < 0.0 {
            self.parted = Some(-2.0 * end.clock[1]);
            assert!(self.system.indentation(&end.y)[self.side as usize].abs() < 1e-12);
        }
    }
    fn satisfied(&self) -> bool {
        self.parted.is_some()
    }
}

/// What the force and the dashpots add to the energy of a motion, and what its contacts lose, by Gauss's rule in the coordinate in which
/// each segment is smooth.
struct Balance<'a> {
    system: &'a Coupled,
    numbers: Numbers,
    gained: f64,
    lost: f64,
    /// The integral of the trace of the Jacobian.
    shrunk: f64,
    parted: u32,
}

impl<'a> Balance<'a> {
    fn new(system: &'a Coupled, numbers: Numbers) -> Self {
        Self { system, numbers, gained: 0.0, lost: 0.0, shrunk: 0.0, parted: 0 }
    }
}

const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

impl Observer<4> for Balance<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        const PARTS: u32 = 4;
        let half = 0.5 * segment.length() / f64::from(PARTS);
        let contact = segment.ends()[0].clock != [1.0, 0.0];
        self.parted += u32::from(contact && segment.in_flight());
        for part in 0..PARTS {
            let middle = f64::from(2 * part + 1) * half;
            for (node, weight) in GAUSS {
                for place in [-node, node] {
                    let Knot { excitation: [force, _], y, clock: [rate, _], .. } =
                        segment.at(middle + half * place);
                    let seconds = half * weight * rate;
                    let Numbers { c1, c2, .. } = self.numbers;
                    self.gained += seconds * (force * y[1] - c1 * y[1] * y[1] - c2 * (y[3] - y[1]).powi(2));
                    self.lost += seconds * self.system.contact_loss(&y);
                    self.shrunk += seconds * self.system.jacobian(&y).trace();
                }
            }
        }
    }
}

/// A scene with a loss, and with both walls or one.
fn lossy(draw: &mut Spread) -> Numbers {
    let base = if draw.unit() < 0.5 { SSVI } else { TWO_SIDED };
    let mut about = |value: f64| value * (1.0 + 0.2 * draw.signed());
    let mut numbers = Numbers {
        k1: about(base.k1),
        c1: about(base.c1),
        k2: about(base.k2),
        c2: about(base.c2),
        m2: about(base.m2),
        d: about(base.d),
        c: about(base.c),
        r: about(base.r),
        omega: about(base.omega),
        ..base
    };
    match draw.unit() < 0.5 {
        true => numbers.lambda = draw.logarithmic(0.01, 30.0),
        false => numbers.e = 0.05 + 0.94 * draw.unit(),
    }
    numbers
}

#[test]
fn invariant_what_contacts_lose_is_missing_from_the_energy() {
    let mut draw = Spread::new(12);
    let (mut parted, mut worst) = (0, 0.0_f64);
    for _ in 0..60 {
        let numbers = lossy(&mut draw);
        let system = numbers.coupled();
        let mut balance = Balance::new(&system, numbers);
        let mut hybrid = Hybrid::new(&system, 1e-13, 10.0, 10_000_000);
        let y = [0.1, 0.5, 0.1 + numbers.d, -0.5];
        let begin = Motion { t: 0.0, y, phase: Phase::Flight };
        let end = hybrid.propagate(begin, 10.0, &mut balance).expect("a run");
        let change = system.total_energy(&end.y) - system.total_energy(&y);
        let error = (change - balance.gained + balance.lost).abs() / system.total_energy(&y);
        assert!(balance.lost > 0.0, "{numbers:?}");
        worst = worst.max(error);
        parted += balance.parted;
    }
    assert!(worst < 1e-12, "{worst:e}");
    assert!(parted > 20, "{parted}");
}

/// Liouville: the volume shrinks at the rate of the trace, which contacts with loss make larger.
#[test]
fn exact_the_determinant_is_that_of_dashpots_and_contacts() {
    let mut draw = Spread::new(14);
    for _ in 0..60 {
        let mut numbers = lossy(&mut draw);
        numbers.lambda = numbers.lambda.min(2.0);
        let system = numbers.coupled();
        let settings = Settings { rtol: 1e-13, ..Settings::default() };
        let y = draw.state(0.5 * numbers.d);
        let begin = Motion { t: 0.0, y, phase: Phase::Flight };
        let mut balance = Balance::new(&system, numbers);
        let mut tangent = Tangent::new(&system, &settings, 1.0, &[]);
        let by_state = tangent.propagate(begin, 1.0, &mut balance).expect("a run").by_state;
        let found = Matrix4::from_fn(|i, j| by_state[j][i]).determinant().ln();
        // The smaller it is the less is left of its digits.
        let allowed = 2e-9 + 1e-14 / balance.shrunk.exp();
        assert!((found - balance.shrunk).abs() < allowed, "{numbers:?}: {found} {}", balance.shrunk);
    }
}

fn run(numbers: &Numbers, to: f64, method: Method, rtol: f64) -> Response {
    let settings = Settings { method, rtol, atol: rtol * 1e-3, max_steps: 20_000_000, ..Settings::default() };
    simulate(&numbers.scene(), Window { from: 0.0, to }, &settings).expect("a run")
}

/// DOP853 integrates the law as it is written, in time, without knowing where it ends.
#[test]
fn reference_general_methods_agree() {
    let mut draw = Spread::new(13);
    for _ in 0..40 {
        let numbers = lossy(&mut draw);
        let (fast, slow) =
            (run(&numbers, 6.0, Method::Hybrid, 1e-12), run(&numbers, 6.0, Method::Dop853, 1e-12));
        assert_eq!(fast.impacts, slow.impacts, "{numbers:?}");
        for i in 0..4 {
            assert_close(fast.final_state[i], slow.final_state[i], 1.0, 1e-9, &format!("{numbers:?}"));
        }
        assert_close(fast.e1_max.value, slow.e1_max.value, slow.e1_max.value, 1e-9, "E1max");
        for side in 0..2 {
            assert_close(
                fast.force_max[side],
                slow.force_max[side],
                1e3,
                1e-7,
                &format!("force {numbers:?}"),
            );
        }
    }
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
    R: f64,
    lambda: f64,
    T: f64,
    E1max: f64,
    force_max_primary: f64,
    force_max_obstacle: f64,
    impacts_primary: u64,
    impacts_obstacle: u64,
    partings: u64,
    state_T: [f64; 4],
    /// How far SciPy's own integrations differ.
    measures_disagreement: f64,
    state_T_disagreement: f64,
}

/// SciPy's DOP853 with events (`tests/reference/loss_scenes.py`, which made the numbers without Retune).
#[test]
fn reference_scipys_dop853_with_events() {
    let file: File =
        serde_json::from_str(include_str!("../../../../tests/reference/loss_scenes.json")).expect("scenes");
    let (touching, parting) = file.scenes.iter().fold((0, 0), |(touching, parting), scene| {
        let touches = scene.impacts_primary + scene.impacts_obstacle > 0;
        (touching + u32::from(touches), parting + u32::from(scene.partings > 0))
    });
    assert!(file.scenes.len() >= 40 && touching >= 40 && parting >= 10, "{touching} {parting}");
    for scene in &file.scenes {
        let Reference { name, m1, c1, k1, m2, k2, c2, D: d, C: c, P: p, omega, R: r, lambda, .. } = scene;
        let numbers = Numbers {
            m1: *m1,
            c1: *c1,
            k1: *k1,
            m2: *m2,
            k2: *k2,
            c2: *c2,
            d: *d,
            c: *c,
            p: *p,
            omega: *omega,
            r: *r,
            lambda: *lambda,
            ..SSVI
        };
        let found = run(&numbers, scene.T, Method::Hybrid, 1e-12);
        assert_eq!(found.impacts, [scene.impacts_primary, scene.impacts_obstacle], "{name}");
        let allowed = 1e-9 + 10.0 * scene.measures_disagreement;
        assert_close(found.e1_max.value, scene.E1max, scene.E1max, allowed, name);
        for (found, expected) in
            found.force_max.into_iter().zip([scene.force_max_primary, scene.force_max_obstacle])
        {
            assert_close(found, expected, expected.max(1.0), allowed, &format!("force of {name}"));
        }
        let allowed = 1e-9 + 10.0 * scene.state_T_disagreement;
        assert_states(found.final_state, scene.state_T, [1.0, 1.0], allowed, name);
    }
}

/// The smallest loss changes the numbers by as little.
#[test]
fn exact_a_vanishing_loss_gives_the_numbers_without() {
    for numbers in [SSVI, TWO_SIDED] {
        let without = run(&numbers, 6.0, Method::Hybrid, 1e-12);
        let with = run(&Numbers { lambda: 1e-12, ..numbers }, 6.0, Method::Hybrid, 1e-12);
        assert!(without.impacts[0] > 0 && with.impacts == without.impacts);
        assert_close(with.e1_max.value, without.e1_max.value, without.e1_max.value, 1e-10, "E1max");
        for side in 0..2 {
            assert_close(with.force_max[side], without.force_max[side], 1e3, 1e-9, "force");
        }
    }
}
