//! What contacts are like: speed, depth and duration.

use crate::forcings::decay;
use crate::problems::assert_close;
use retune_model::{Finite, Scene, Side, Start};
use retune_solver::{
    Collisions, Method, Moment, Rows, Settings, Window, simulate, simulate_in_detail, trajectory,
};
use retune_testkit::scenes::{LOSSY, Numbers, SSVI, TWO_SIDED};

fn contacts(scene: &Scene, window: Window, settings: &Settings) -> [Collisions; 2] {
    let (_, _, walls) = simulate_in_detail(scene, window, settings).expect("a run");
    walls
}

/// An undisturbed Hertz collision at the speed v: `z = (5 μ v² / (4 K))^(2/5)` with the effective mass μ, and 2.9432751 z/v long
/// (Johnson, p. 353).
#[test]
fn exact_the_undisturbed_collision() {
    let number = |value: f64| Finite::new(value).expect("a number");
    let free = Numbers { k1: 0.0, c1: 0.0, k2: 0.0, c2: 0.0, c: 0.2, d: 0.1, ..SSVI };
    for speed in [0.01, 1.0, 3.0] {
        let start = Start { x2: Some(number(0.1)), v2: number(-speed), ..Start::default() };
        let scene = decay(free, start);
        let window = Window { from: 0.0, to: 0.1 / speed + 0.2 / speed };
        let [structure, obstacle] = contacts(&scene, window, &Settings::default());
        let system = free.coupled();
        let stiffness = system.hertz(Side::Primary);
        let depth = (1.25 * speed * speed / system.inverse_effective_mass() / stiffness).powf(0.4);
        assert_eq!((structure.count, obstacle.count, obstacle.indentation), (1, 0, 0.0));
        assert_close(structure.speed, speed, speed, 1e-12, "speed");
        assert_close(structure.indentation, depth, depth, 1e-10, "indentation");
        let duration = 2.943_275_1 * depth / speed;
        assert_close(structure.longest, duration, duration, 1e-7, "duration");
        assert_eq!(structure.shortest, structure.longest);
    }
}

/// The same as the events of a trajectory, and as the largest values of a run.
#[test]
fn reference_the_events_of_a_trajectory() {
    let (window, settings) = (Window { from: 3.0, to: 20.0 }, Settings::default());
    for numbers in [SSVI, TWO_SIDED, LOSSY, Numbers { lambda: 20.0, ..TWO_SIDED }] {
        let scene = numbers.scene();
        let system = numbers.coupled();
        let mut speeds = [0.0_f64; 2];
        trajectory(&scene, window, &settings, Rows { interval: 1.0, events: true }, &mut |sample| {
            if sample.moment == Moment::TouchDown {
                let [near, far] = system.indentation(&sample.state);
                let speed = &mut speeds[usize::from(far > near)];
                *speed = speed.max((sample.state[3] - sample.state[1]).abs());
            }
        })
        .expect("a run");
        let (run, _, found) = simulate_in_detail(&scene, window, &settings).expect("a run");
        assert!(run.impacts[0] > 5, "{run:?}");
        for side in Side::BOTH {
            let (i, wall) = (side as usize, found[side as usize]);
            assert_eq!(wall.count, run.impacts[i]);
            assert_close(wall.speed, speeds[i], 1.0, 1e-12, "speed");
            let pressure = system.wall_pressure(side, wall.indentation);
            assert_close(pressure, run.pressure_max[i], pressure.max(1.0), 1e-8, "pressure");
        }
    }
}

/// General methods end their pieces at lift-off only to rounding, and do not say that a piece is free.
#[test]
fn reference_general_methods_see_contacts_as_long() {
    let window = Window { from: 0.0, to: 5.0 };
    for numbers in [SSVI, LOSSY] {
        let scene = numbers.scene();
        let found = contacts(&scene, window, &Settings::default());
        for method in [Method::Dop853, Method::Ode45] {
            let general = Settings { method, rtol: 1e-11, ..Settings::default() };
            let other = contacts(&scene, window, &general);
            for (a, b) in found.iter().zip(&other) {
                assert_eq!(a.count, b.count, "{method:?}");
                assert_close(b.indentation, a.indentation, 1.0, 1e-8, "indentation");
                if a.count > 0 {
                    assert_close(b.shortest, a.shortest, a.shortest, 1e-5, "shortest");
                    assert_close(b.longest, a.longest, a.longest, 1e-5, "longest");
                }
            }
        }
    }
}

/// On walls so soft that the force turns by more than a radian during a contact.
#[test]
fn reference_contacts_in_which_the_force_turns() {
    let soft = Numbers { young: [2.1e11, 2e3, 2.1e11, 2e3], ..TWO_SIDED };
    let window = Window { from: 10.0, to: 20.0 };
    for numbers in [soft, Numbers { lambda: 0.4, ..soft }, Numbers { e: 0.5, ..soft }] {
        let scene = numbers.scene();
        let turns = |longest: f64| numbers.omega * longest;
        let walls = contacts(&scene, window, &Settings::default());
        assert!(walls.iter().all(|wall| turns(wall.longest) > 1.0), "{walls:?}");
        let run = simulate(&scene, window, &Settings::default()).expect("a run");
        let general = Settings { method: Method::Dop853, rtol: 1e-13, ..Settings::default() };
        let other = simulate(&scene, window, &general).expect("a run");
        assert_close(run.e1_max.value, other.e1_max.value, other.e1_max.value, 1e-11, "E1max");
        // 2700 while the force was carried over a turn of 0.05 alone.
        assert!(run.work.steps < 2000, "{:?}", run.work);
    }
}
