//! Every derivative that the model states, against finite differences of what it is the derivative of.

use retune_model::{Amplitude, Coupled, Measure, Parameter, Side};
use retune_testkit::scenes::{LOSSY, Numbers, ROW1, SSVI, Spread, TMD, TWO_SIDED, slope};

const T: f64 = 0.37;

/// Spacing of the differences, small beside an indentation of millimetres.
const H: f64 = 3e-5;

/// Random states: in flight, in contact with the structure, in contact with the obstacle.
fn states(system: &Coupled) -> Vec<[f64; 4]> {
    let mut spread = Spread::new(1);
    let mut states = Vec::new();
    for _ in 0..4 {
        for r in [0.5 * system.wall(Side::Obstacle), -2e-3, system.wall(Side::Obstacle) + 3e-3] {
            states.push(spread.state(r));
        }
    }
    states
}

fn along(y: &[f64; 4], direction: &[f64; 4], s: f64) -> [f64; 4] {
    std::array::from_fn(|i| y[i] + s * direction[i])
}

fn assert_close(found: f64, expected: f64, size: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * size, "{what}: {found} {expected} (size {size})");
}

#[test]
fn exact_jacobian_is_the_derivative_of_equation_1() {
    for numbers in [SSVI, ROW1, TWO_SIDED, LOSSY] {
        let system = numbers.coupled();
        let excitation = system.excitation(T);
        for y in states(&system) {
            let jacobian = system.jacobian(&y);
            for j in 0..4 {
                let unit: [f64; 4] = std::array::from_fn(|i| f64::from(i == j));
                let column = slope(H, |s| system.derivative(excitation, &along(&y, &unit, s)));
                for i in 0..4 {
                    let size = jacobian.row(i).amax();
                    assert_close(column[i], jacobian[(i, j)], size, 1e-7, &format!("J[{i}][{j}] at {y:?}"));
                }
            }
        }
    }
}

#[test]
fn exact_linear_part_is_the_jacobian_in_flight() {
    let system = SSVI.coupled();
    let (a, b) = system.linear_part();
    let y = [0.02, -0.3, 0.11, 0.4];
    assert_eq!(a, system.jacobian(&y));
    let excitation = system.excitation(T);
    let deviation = nalgebra::SVector::from(y) - nalgebra::SVector::from(system.rest());
    let expected = system.derivative(excitation, &y);
    for i in 0..4 {
        assert_close((a * deviation)[i] + b[i] * excitation[0], expected[i], 10.0, 1e-15, "A y + b P cos ωt");
    }

    let bare = SSVI.bare();
    let (a, b) = bare.linear_part();
    let (y, excitation) = ([0.02, -0.3], bare.excitation(T));
    for (i, expected) in bare.derivative(excitation, &y).into_iter().enumerate() {
        assert_close(
            (a * nalgebra::SVector::from(y))[i] + b[i] * excitation[0],
            expected,
            1.0,
            1e-15,
            "bare",
        );
    }
}

/// Of a damper that a rigid wall holds, `A y + b f` is the derivative of the state.
#[test]
fn exact_linear_part_while_a_wall_holds() {
    let system = Numbers { rigid: Some(0.5), ..TWO_SIDED }.coupled();
    let (a, b) = system.held_linear_part();
    for y in [[0.02, -0.3, 0.02, -0.3], [-0.05, 0.4, -0.05 + system.wall(Side::Obstacle), 0.4]] {
        let excitation = system.excitation(T);
        let common = system.held_acceleration(excitation, &y);
        for (i, expected) in [y[1], common, y[3], common].into_iter().enumerate() {
            let found = (a * nalgebra::SVector::from(y))[i] + b[i] * excitation[0];
            assert_close(found, expected, 10.0, 1e-14, "A y + b P cos ωt");
        }
    }
}

#[test]
fn exact_time_derivative_of_equation_1() {
    let (system, bare) = (SSVI.coupled(), SSVI.bare());
    let y = [0.02, -0.3, 0.11, 0.4];
    let found = system.time_derivative(system.excitation(T));
    let expected = slope(1e-3, |s| system.derivative(system.excitation(T + s), &y));
    (0..4).for_each(|i| assert_close(found[i], expected[i], 5.0, 1e-12, "coupled"));
    let found = bare.time_derivative(bare.excitation(T));
    let expected = slope(1e-3, |s| bare.derivative(bare.excitation(T + s), &[y[0], y[1]]));
    (0..2).for_each(|i| assert_close(found[i], expected[i], 5.0, 1e-12, "bare"));
}

/// The true energy changes only by the force, the two dampers and what contacts lose: contacts and springs hold what else they take.
#[test]
fn invariant_energy_balance() {
    for numbers in [SSVI, ROW1, TWO_SIDED, LOSSY] {
        let system = numbers.coupled();
        let excitation = system.excitation(T);
        for y in states(&system) {
            let f = system.derivative(excitation, &y);
            let h = H / f[3].abs().max(f[1].abs()).max(3.0); // velocities differ by H, positions by less
            let [rate] = slope(h, |s| [system.total_energy(&along(&y, &f, s))]);
            let [_, v1, _, v2] = y;
            let power = excitation[0] * v1
                - numbers.c1 * v1 * v1
                - numbers.c2 * (v2 - v1) * (v2 - v1)
                - system.contact_loss(&y);
            let size = numbers.m2 * (f[3] * v2).abs() + numbers.m1 * (f[1] * v1).abs() + power.abs();
            assert_close(rate, power, size, 1e-7, &format!("dE/dt at {y:?}"));
        }
    }
}

/// `[value, rate, rate of rate]` along the flow.
fn assert_rates(system: &Coupled, name: &str, rates: impl Fn([f64; 2], &[f64; 4]) -> [f64; 3]) {
    for y in states(system) {
        let f = system.derivative(system.excitation(T), &y);
        let h = H / f[3].abs().max(f[1].abs()).max(3.0);
        let differences = slope(h, |s| rates(system.excitation(T + s), &along(&y, &f, s)));
        let [value, first, second] = rates(system.excitation(T), &y);
        assert_close(first, differences[0], first.abs() + value.abs(), 1e-7, &format!("d{name}/dt at {y:?}"));
        assert_close(
            second,
            differences[1],
            second.abs() + first.abs(),
            1e-7,
            &format!("d²{name}/dt² at {y:?}"),
        );
    }
}

#[test]
fn exact_rates_of_the_observed_quantities() {
    for numbers in [SSVI, ROW1, TWO_SIDED, LOSSY] {
        let system = numbers.coupled();
        assert_rates(&system, "E1", |excitation, y| system.primary_energy_rates(excitation, y));
        assert_rates(&system, "E2", |excitation, y| system.damper_energy_rates(excitation, y));
        assert_rates(&system, "r", |excitation, y| system.relative_position_rates(excitation, y));
        let motion = |excitation, y: &[f64; 4]| system.primary_motion(excitation, y);
        assert_rates(&system, "x1", |excitation, y| [0, 1, 2].map(|i| motion(excitation, y)[i]));
        assert_rates(&system, "a1", |excitation, y| [2, 3, 4].map(|i| motion(excitation, y)[i]));
        for side in Side::BOTH {
            assert_rates(&system, "F", |excitation, y| system.contact_force_rates(excitation, y, side));
        }
    }
}

#[test]
fn exact_rates_of_the_bare_energy() {
    let bare = SSVI.bare();
    let y = [0.05, 0.4];
    let f = bare.derivative(bare.excitation(T), &y);
    let rates =
        |s: f64| bare.primary_energy_rates(bare.excitation(T + s), &std::array::from_fn(|i| y[i] + s * f[i]));
    let (found, differences) = (rates(0.0), slope(1e-3, rates));
    assert_close(found[0], 0.5 * (SSVI.m1 * 0.16 + SSVI.k1 * 0.0025), 1.0, 1e-12, "E1");
    assert_close(found[1], differences[0], found[1].abs(), 1e-10, "dE1/dt");
    assert_close(found[2], differences[1], found[2].abs(), 1e-10, "d²E1/dt²");
}

#[test]
fn exact_rates_of_the_bare_motion() {
    let bare = SSVI.bare();
    let y = [0.05, 0.4];
    let f = bare.derivative(bare.excitation(T), &y);
    let motion =
        |s: f64| bare.primary_motion(bare.excitation(T + s), &std::array::from_fn(|i| y[i] + s * f[i]));
    let (found, differences) = (motion(0.0), slope(1e-3, motion));
    assert_eq!(found[..3], [y[0], y[1], f[1]]);
    for order in 0..4 {
        assert_close(found[order + 1], differences[order], found[order + 1].abs(), 1e-10, "a rate");
    }
}

/// Every measure of the steady response by every parameter of the damper, below and above the structure's own frequency.
#[test]
fn exact_steady_derivatives() {
    let mut spread = Spread::new(4);
    for amplitude in Amplitude::ALL {
        for _ in 0..20 {
            let numbers = Numbers {
                k2: spread.logarithmic(200.0, 4000.0),
                c2: spread.logarithmic(20.0, 800.0),
                m2: spread.logarithmic(20.0, 100.0),
                omega: spread.logarithmic(4.0, 9.0),
                ..TMD
            };
            let scene = numbers.forced_by(amplitude);
            let damper = scene.damper.expect("a damper");
            let at = |variable: Parameter, value: f64| {
                let mut damper = damper;
                variable.set_damper(&mut damper, value).expect("in range");
                Coupled::new(&scene.primary, &scene.forcing, &damper)
            };
            for measure in Measure::ALL {
                for variable in Parameter::VARIED {
                    let value = variable.get(&damper);
                    let largest = |share: f64| {
                        let system = at(variable, value * (1.0 + share));
                        [system.steady(numbers.omega).largest(system.bare(), numbers.omega, measure)]
                    };
                    let [expected] = slope(1e-3, largest);
                    let found = value * at(variable, value).steady_by(measure, variable, numbers.omega);
                    let what = format!("{measure:?} by {variable:?}, {:?}", scene.forcing.source);
                    assert_close(found, expected, largest(0.0)[0].max(1e-300), 1e-10, &what);
                }
            }
        }
    }
}
