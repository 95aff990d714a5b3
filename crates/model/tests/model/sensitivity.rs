//! Derivatives by the parameters of a scene, at a state and a time, against finite differences of what they are the derivatives of.

use retune_model::{Amplitude, Coupled, Measure, Parameter, Scene, Side};
use retune_testkit::scenes::{DRIVEN, LOSSY, Numbers, RESTORING, SSVI, Spread, TWO_SIDED, slope};

const T: f64 = 0.37;

/// Spacing of the differences, as a share of a parameter.
const H: f64 = 3e-4;

fn system(scene: &Scene) -> Coupled {
    Coupled::new(&scene.primary, &scene.forcing, scene.damper.as_ref().expect("a damper"))
}

/// The system with a parameter larger by a share.
fn changed(scene: &Scene, parameter: Parameter, value: f64, share: f64) -> Coupled {
    system(&parameter.at(*scene, value * (1.0 + share)).expect("in range"))
}

/// The parameters that the solver takes derivatives by, as far as the scene has them, each with its value.
fn parameters(scene: &Scene) -> Vec<(Parameter, f64)> {
    use Parameter::{C, C1, C2, D, K1, K2, Lambda, M2, Omega, R, Restitution};
    let all = [K1, C1, M2, K2, C2, D, C, R, Omega, Lambda, Restitution];
    let known = all.into_iter().chain(Parameter::AMPLITUDES).filter_map(|one| Some((one, one.of(scene)?)));
    known.filter(|(one, value)| *value != 0.0 && (*one, *value) != (Restitution, 1.0)).collect()
}

fn assert_close(found: f64, expected: f64, size: f64, what: &str) {
    assert!((found - expected).abs() <= 1e-9 * size, "{what}: {found} {expected} (size {size})");
}

/// In flight, in contact with the structure, and with the obstacle.
fn states(scene: &Scene) -> Vec<[f64; 4]> {
    let wall = system(scene).wall(Side::Obstacle);
    let mut spread = Spread::new(5);
    (0..9).map(|number| spread.state([0.4 * wall, -2e-3, wall + 3e-3][number % 3])).collect()
}

/// What a measure is the largest size of.
fn size_of(measure: Measure, system: &Coupled, y: &[f64; 4]) -> f64 {
    let [near, far] = system.indentation(y);
    let side = if near > far { Side::Primary } else { Side::Obstacle };
    match measure {
        Measure::Energy => system.primary_energy_rates(system.excitation(T), y)[0],
        Measure::Displacement => y[0].abs(),
        Measure::Velocity => y[1].abs(),
        Measure::Acceleration => system.derivative(system.excitation(T), y)[1].abs(),
        Measure::GroundForce => {
            let [k1, c1] = system.bare().ground_force_weights();
            let driven = if system.bare().is_on_moving_base() { system.excitation(T)[0] } else { 0.0 };
            (k1 * y[0] + c1 * y[1] - driven).abs()
        }
        Measure::Stroke => (y[2] - y[0] - system.rest_distance()).abs(),
        Measure::ContactForce => system.contact_forces(y)[side as usize],
        Measure::ContactPressure => system.wall_pressure(side, near.max(far).max(0.0)),
        other => panic!("{other:?} is not of a moment"),
    }
}

#[test]
fn exact_derivatives_of_every_measure_by_every_parameter() {
    let mut spread = Spread::new(7);
    let driven = |numbers: Numbers| DRIVEN.map(|(amplitude, p)| (Numbers { p, ..numbers }, amplitude));
    for (numbers, amplitude) in [SSVI, TWO_SIDED, LOSSY, RESTORING].into_iter().flat_map(driven) {
        let scene = numbers.forced_by(amplitude);
        for y in states(&scene) {
            for (parameter, value) in parameters(&scene) {
                // A change of the state by the parameter, as a run has it.
                let along: [f64; 4] = [0.02, 0.3, 0.02, 0.3].map(|size| size * spread.signed());
                for measure in Measure::ALL.into_iter().filter(|measure| *measure != Measure::DecayTime) {
                    let at = |share: f64| {
                        let there = std::array::from_fn(|i| y[i] + share * along[i]);
                        [size_of(measure, &changed(&scene, parameter, value, share), &there)]
                    };
                    let [expected] = slope(H, at);
                    let by = along.map(|along| along / value);
                    let found = value * system(&scene).measure_by(measure, parameter, T, &y, &by);
                    // A change by a percent moves a contact of millimetres by as much.
                    let size = 100.0 * at(0.0)[0] + expected.abs();
                    assert_close(
                        found,
                        expected,
                        size,
                        &format!("{measure:?} by {parameter:?} at {y:?}, {numbers:?}"),
                    );
                }
            }
        }
    }
}

#[test]
fn exact_slopes_of_the_force_of_a_wall() {
    for numbers in [SSVI, LOSSY, RESTORING] {
        let system = numbers.coupled();
        for side in Side::BOTH {
            for (z, w) in [(2e-3_f64, 0.4), (1e-4, -0.1), (1e-2, 0.0), (3e-3, -0.7)] {
                let force = |z: f64, w: f64| {
                    [-side.sign() * system.contact_force_by(Parameter::K1, side, z.sqrt(), w)[0]]
                };
                let found = system.contact_slopes(side, z.sqrt(), w);
                let [by_depth] = slope(H, |share| force(z * (1.0 + share), w));
                let [by_rate] = slope(H, |change| force(z, w + change));
                let size = 10.0 * force(z, w)[0];
                let what = format!("{side:?} {z} {w} {numbers:?}");
                assert_close(z * found[0], by_depth, size, &what);
                assert_close(found[1], by_rate, size, &what);
                assert!(found[0] > 0.0 && (found[1] > 0.0) == system.is_lossy(), "{what}: {found:?}");
            }
        }
    }
}

/// Of a force, an imbalance and a base, that is moved or accelerated.
#[test]
fn exact_derivatives_of_what_drives_the_structure() {
    for amplitude in Amplitude::ALL {
        let scene = SSVI.forced_by(amplitude);
        for parameter in [Parameter::K1, Parameter::C1, Parameter::Omega, amplitude.parameter()] {
            let value = parameter.of(&scene).expect("a parameter of the scene");
            let at = |share: f64| changed(&scene, parameter, value, share).excitation(T);
            let expected = slope(H, at);
            let found = system(&scene).bare().excitation_by(parameter, T);
            let size = 10.0 * at(0.0)[0].hypot(at(0.0)[1]);
            for i in 0..2 {
                assert_close(value * found[i], expected[i], size, &format!("{amplitude:?} by {parameter:?}"));
            }
        }
    }
}

/// Of a damper that a rigid wall holds.
#[test]
fn exact_derivatives_of_the_common_acceleration() {
    let scene = Numbers { rigid: Some(0.7), ..TWO_SIDED }.scene();
    let y = [0.03, 0.2, 0.03, 0.2];
    for parameter in [Parameter::K1, Parameter::C1, Parameter::M2, Parameter::K2, Parameter::C2] {
        let value = parameter.of(&scene).expect("a parameter of the scene");
        let excitation = system(&scene).excitation(T);
        let at = |share: f64| [changed(&scene, parameter, value, share).held_acceleration(excitation, &y)];
        let [expected] = slope(H, at);
        let found = value * system(&scene).held_acceleration_by(parameter, excitation, &y);
        assert_close(found, expected, 10.0 * at(0.0)[0].abs(), &format!("{parameter:?}"));
    }
}
