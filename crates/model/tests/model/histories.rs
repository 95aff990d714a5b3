//! Forces and accelerations of the base that are given in time.

use retune_model::{Bare, Coupled, History, Of, Samples, Shape, Side};
use retune_testkit::histories::{pulse, record};
use retune_testkit::scenes::{LOSSY, Numbers, SSVI, Spread, TWO_SIDED, rigid, slope};

/// One of every kind, each smooth about t = 0.5.
fn histories() -> Vec<History> {
    let of = [Of::Force, Of::BaseAcceleration];
    of.into_iter()
        .zip([900.0, 1.3])
        .flat_map(|(of, size)| {
            let line = Samples::at(vec![0.0, 0.3, 0.9], vec![0.0, -0.4 * size, size]).expect("a record");
            [pulse(of, Shape::HalfSine, size, 0.8), pulse(of, Shape::Rectangle, -size, 0.8), record(of, line)]
        })
        .collect()
}

const T: f64 = 0.5;

fn coupled(numbers: &Numbers, history: History) -> Coupled {
    let scene = numbers.under(history);
    Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper"))
}

#[test]
fn exact_the_force_of_every_history() {
    let at = |history, t: f64| {
        let system = coupled(&SSVI, history);
        let forces: [f64; 2] = slope(1e-3, |s| [system.excitation(t + s)[0], 0.0]);
        let [omega, _] = system.bare().turning();
        let [force, partner] = system.excitation(t);
        assert!((forces[0] + omega * partner).abs() < 1e-9 * (1.0 + forces[0].abs()), "its slope");
        force
    };
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} {b}");
    let half = pulse(Of::Force, Shape::HalfSine, 5.0, 0.8);
    close(at(half, 0.3), 5.0 * (std::f64::consts::PI * 0.3 / 0.8).sin());
    close(at(half, 0.9), 0.0);
    close(at(pulse(Of::BaseAcceleration, Shape::Rectangle, 5.0, 0.8), 0.3), -5.0 * SSVI.m1);
    let samples = Samples::at(vec![0.5, 1.0, 2.0], vec![1.0, 3.0, -1.0]).expect("a record");
    for (t, value) in [(0.25, 0.0), (0.75, 2.0), (1.5, 1.0), (2.5, 0.0)] {
        let samples = Samples::at((0..3).map(|i| samples.time(i)).collect(), samples.values().collect());
        close(at(record(Of::Force, samples.expect("a record")), t), value);
    }
}

/// In coordinates that move with the base every body is accelerated by -a more than by the forces on it.
#[test]
fn exact_an_accelerated_base_takes_its_acceleration_from_every_body() {
    let mut spread = Spread::new(3);
    let history = pulse(Of::BaseAcceleration, Shape::Rectangle, 2.5, 1.0);
    for numbers in [SSVI, TWO_SIDED, LOSSY] {
        let system = coupled(&numbers, history);
        for r in [0.5 * system.wall(Side::Obstacle), -2e-3] {
            let y = spread.state(r);
            let with = system.derivative(system.excitation(T), &y);
            let without = system.derivative([0.0; 2], &y);
            let added: [f64; 4] = std::array::from_fn(|i| with[i] - without[i]);
            let size = without[1].abs().max(without[3].abs()).max(1.0);
            for (added, expected) in added.iter().zip([0.0, -2.5, 0.0, -2.5]) {
                assert!((added - expected).abs() < 1e-14 * size, "{added} {expected}");
            }
            let bare = Bare::new(&numbers.primary(), &numbers.under(history).forcing);
            let added = bare.derivative(bare.excitation(T), &[0.1, 0.2])[1]
                - bare.derivative([0.0; 2], &[0.1, 0.2])[1];
            assert!((added + 2.5).abs() < 1e-14 * 10.0, "{added}");
        }
    }
}

/// A wall holds the damper: both are one body, and the force between them is what the damper needs beside its spring.
#[test]
fn exact_a_held_damper_on_an_accelerated_base() {
    let numbers = Numbers { rigid: Some(0.5), ..SSVI };
    assert!(rigid(0.5).rigid().is_some());
    let system = coupled(&numbers, pulse(Of::BaseAcceleration, Shape::Rectangle, 2.5, 1.0));
    let y = [0.01, 0.3, 0.01, 0.3];
    let excitation = system.excitation(T);
    let Numbers { m1, m2, c1, k1, k2, d, .. } = numbers;
    // The springs between them are at -D; absolute accelerations follow from forces alone.
    let absolute = -(k1 * 0.01 + c1 * 0.3) / (m1 + m2);
    assert!((system.held_acceleration(excitation, &y) - (absolute - 2.5)).abs() < 1e-13);
    let force = system.wall_reactions(excitation, &y)[0];
    assert!((force - (m2 * absolute - k2 * d).max(0.0)).abs() < 1e-11, "{force}");
}

/// Rates of every quantity by finite differences along the motion.
#[test]
fn exact_rates_under_every_history() {
    type Rates<'a> = dyn Fn([f64; 2], &[f64; 4]) -> [f64; 3] + 'a;
    let mut spread = Spread::new(5);
    for (numbers, history) in [SSVI, TWO_SIDED, LOSSY]
        .into_iter()
        .flat_map(|numbers| histories().into_iter().map(move |history| (numbers, history)))
    {
        let system = coupled(&numbers, history);
        for r in [0.5 * system.wall(Side::Obstacle), -2e-3, system.wall(Side::Obstacle) + 3e-3] {
            let y = spread.state(r);
            let f = system.derivative(system.excitation(T), &y);
            let h = 3e-5 / f[3].abs().max(f[1].abs()).max(3.0);
            let moved = |s: f64| -> [f64; 4] { std::array::from_fn(|i| y[i] + s * f[i]) };
            let check = |name: &str, rates: &Rates<'_>| {
                let differences: [f64; 3] = slope(h, |s| rates(system.excitation(T + s), &moved(s)));
                let found = rates(system.excitation(T), &y);
                for i in 0..2 {
                    let size = found[i + 1].abs() + found[i].abs();
                    let off = (found[i + 1] - differences[i]).abs();
                    assert!(off <= 1e-7 * size, "{name} {i} at {y:?}: {found:?} {differences:?}");
                }
            };
            check("E1", &|force, y| system.primary_energy_rates(force, y));
            check("E2", &|force, y| system.damper_energy_rates(force, y));
            check("r", &|force, y| system.relative_position_rates(force, y));
            check("x1", &|force, y| [0, 1, 2].map(|i| system.primary_motion(force, y)[i]));
            check("a1", &|force, y| [2, 3, 4].map(|i| system.primary_motion(force, y)[i]));
            for side in Side::BOTH {
                check("F", &|force, y| system.contact_force_rates(force, y, side));
                let mut equations = system.regularised_contact(side);
                equations.set_excitation(0.0, system.excitation(T));
                if system.indentation(&y)[side as usize] > 0.0 {
                    let rate = equations.acceleration(&equations.regularise(&y));
                    let expected = side.sign() * (f[3] - f[1]);
                    assert!((rate - expected).abs() < 1e-10 * expected.abs().max(1.0), "{rate} {expected}");
                }
            }
            let expected: [f64; 4] = slope(1e-3, |s| system.derivative(system.excitation(T + s), &y));
            let found = system.time_derivative(system.excitation(T));
            (0..4).for_each(|i| assert!((found[i] - expected[i]).abs() < 1e-9 * (1.0 + found[i].abs())));
            let (a, b) = system.linear_part();
            let deviation = nalgebra::SVector::from(y) - nalgebra::SVector::from(system.rest());
            let flying = system.derivative_under(system.excitation(T), &y, 0.0);
            for i in 0..4 {
                let value = (a * deviation)[i] + b[i] * system.excitation(T)[0];
                assert!((value - flying[i]).abs() < 1e-12 * 100.0, "{value} {}", flying[i]);
            }
        }
    }
}

/// The work of an accelerated base: √(2E) grows by at most its bound.
#[test]
fn invariant_no_history_supplies_more_than_its_bound() {
    let mut spread = Spread::new(8);
    for history in histories() {
        let system = coupled(&Numbers { c1: 0.0, c2: 0.0, ..SSVI }, history);
        let mut nearest: f64 = 0.0;
        for _ in 0..2000 {
            // Nearly all energy that of the motion: the bound is near where both bodies move alike.
            let [_, v1, _, v2] = spread.state(0.0);
            let y = [1e-3 * v1, v1, 1e-3 * v1 + system.rest_distance(), v2];
            let [force, _] = system.excitation(T);
            let [m1, m2] = system.masses();
            let lift = if system.bare().moves_with_base() { m2 / m1 } else { 0.0 };
            // d√(2E)/dt = power / √(2E).
            let growth = force * (y[1] + lift * y[3]) / (2.0 * system.total_energy(&y)).sqrt();
            let share = force.abs() / system.bare().force_bounds()[0];
            nearest = nearest.max(growth.abs() / (share * system.energy_norm_growth()));
        }
        assert!(nearest <= 1.0 && nearest > 0.95, "{nearest}");
    }
}
