//! The regularised equations of a contact against equation (1), and the undisturbed collision against quadrature.

use retune_model::{RegularisedContact, RegularisedState, Side};
use retune_testkit::scenes::{LOSSY, Numbers, ROW1, SSVI, Spread, TWO_SIDED, advance, slope};

const T: f64 = 1.21;

/// A random state with the indentation `z` (m) of a wall.
fn in_contact(system: &retune_model::Coupled, side: Side, z: f64, spread: &mut Spread) -> [f64; 4] {
    spread.state(system.wall(side) + side.sign() * z)
}

#[test]
fn exact_compressing_and_expanding_is_the_identity() {
    let mut spread = Spread::new(2);
    for numbers in [SSVI, ROW1] {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let equations = system.regularised_contact(side);
            assert_eq!(equations.side(), side);
            for z in [0.0, 1e-6, 1e-3, 0.02] {
                let y = in_contact(&system, side, z, &mut spread);
                let regularised = equations.regularise(&y);
                assert!((regularised[0] - z.sqrt()).abs() < 1e-8, "{} {z}", regularised[0]);
                assert_eq!(regularised[4], 0.0, "no time has passed");
                let back = equations.physical(&regularised);
                for i in 0..4 {
                    assert!((back[i] - y[i]).abs() <= 1e-15, "{side:?} {z}: {back:?} {y:?}");
                }
            }
            let apart = equations.regularise(&in_contact(&system, side, -0.01, &mut spread));
            assert_eq!(apart[0], 0.0, "a damper that is not in contact counts as touching");
        }
    }
}

/// The chain rule: the state that a regularised one stands for moves with `q` times equation (1).
#[test]
fn exact_regularised_equations_are_equation_1() {
    let mut spread = Spread::new(3);
    for numbers in [SSVI, ROW1, TWO_SIDED, LOSSY] {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let mut equations = system.regularised_contact(side);
            equations.set_excitation(0.0, system.excitation(T));
            for z in [1e-4, 1e-3, 5e-3] {
                let (y, excitation) = (in_contact(&system, side, z, &mut spread), system.excitation(T));
                let regularised = equations.regularise(&y);
                let q = regularised[0];
                let rate = equations.derivative(&regularised);
                let expected = system.derivative(excitation, &y);
                let moved = slope(1e-4, |s| {
                    let ahead: RegularisedState = std::array::from_fn(|i| regularised[i] + s * rate[i]);
                    equations.physical(&ahead)
                });
                for i in 0..4 {
                    let (found, expected) = (moved[i], q * expected[i]);
                    assert!((found - expected).abs() < 1e-10 * (1.0 + expected.abs()), "{side:?} {z} {i}");
                }
                assert_eq!(rate[4], q, "dt = q dθ");
                let closing = side.sign() * (expected[3] - expected[1]);
                let found = equations.acceleration(&regularised);
                assert!((found - closing).abs() < 1e-10 * closing.abs(), "{found} {closing}");
            }
        }
    }
}

/// Two bodies and nothing else.
const COLLISION: Numbers = Numbers { k1: 0.0, c1: 0.0, p: 0.0, k2: 0.0, c2: 0.0, ..SSVI };

/// The damper turns where the energy of its approach is in the contact.
#[test]
fn exact_undisturbed_collision() {
    let system = COLLISION.coupled();
    for side in Side::BOTH {
        let equations = system.regularised_contact(side);
        let kappa = system.hertz(side) * (1.0 / SSVI.m1 + 1.0 / SSVI.m2);
        assert!((equations.hertz_rate() / kappa - 1.0).abs() < 1e-15);
        assert!((equations.mass_ratio() / (1.0 + SSVI.m1 / SSVI.m2) - 1.0).abs() < 1e-15);
        for speed in [1e-3, 0.1, 1.0] {
            let depth = equations.greatest_depth(speed);
            assert!((equations.speed_at_depth(depth) / speed - 1.0).abs() < 1e-14);
            let wall = system.wall(side);
            let mut y = equations.regularise(&[0.0, 0.0, wall, side.sign() * speed]);
            let mut deepest: f64 = 0.0;
            while y[1] > -0.5 * speed {
                y = advance(&equations, &y, 1e-3 * depth / speed);
                deepest = deepest.max(y[0]);
            }
            assert!((deepest / depth - 1.0).abs() < 1e-6, "{deepest} {depth}");
            // Half the reduced mass times the speed squared: w² = v² - (4/5) κ q⁵ all the way.
            let kept = y[1] * y[1] + 0.8 * kappa * y[0].powi(5);
            assert!((kept / (speed * speed) - 1.0).abs() < 1e-9, "{kept}");
        }
    }
}

/// The prediction of the lift-off is exact in the limit at the wall and good from well inside.
#[test]
fn exact_prediction_of_the_lift_off() {
    for (numbers, from, allowed) in
        [(COLLISION, 0.7, 2e-3), (COLLISION, 0.3, 1e-6), (SSVI, 0.3, 2e-3), (SSVI, 0.03, 3e-6)]
    {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let mut equations = system.regularised_contact(side);
            equations.set_excitation(0.0, system.excitation(T));
            let speed = 0.5;
            let q = from * equations.greatest_depth(speed);
            let w = (speed * speed - equations.speed_at_depth(q).powi(2)).sqrt();
            let z = side.sign() * q * q;
            let mut y =
                equations.regularise(&[0.01, 0.1, 0.01 + system.wall(side) + z, 0.1 - side.sign() * w]);
            let predicted = equations.theta_to_wall(&y);
            let h = predicted / 400.0;
            let mut theta = 0.0;
            while y[0] > 0.0 {
                y = advance(&equations, &y, h);
                theta += h;
            }
            theta -= y[0] / (0.5 * y[1]); // back to the wall, along q' = w/2
            assert!((theta / predicted - 1.0).abs() < allowed, "{side:?} {from} {theta} {predicted}");
        }
    }
}

/// The force is a polynomial of the time since it was set, exact to rounding over the turn that is allowed.
#[test]
fn exact_force_during_a_contact() {
    let system = SSVI.coupled();
    let mut equations = system.regularised_contact(Side::Primary);
    assert_eq!(equations.frequency(), SSVI.omega);
    let since = 0.003;
    for (far, turn) in [(false, RegularisedContact::TURN), (true, 0.5), (false, RegularisedContact::TURN)] {
        equations.set_excitation(since, system.excitation(T));
        if far {
            equations.carry_excitation();
        }
        assert_eq!(equations.turn(), turn);
        for share in [-1.0, -0.5, 0.0, 0.3, 1.0] {
            let later = share * turn / SSVI.omega;
            let [cos, sin] = equations.excitation(&[0.01, 0.0, 0.0, 0.0, since + later]);
            let [c, s] = system.excitation(T + later);
            let allowed = 8e-15 * SSVI.p;
            assert!((cos - c).abs() < allowed && (sin - s).abs() < allowed, "{far} {share}");
        }
    }
}

/// Where all terms push one way the structure is accelerated by their size; elsewhere by less.
#[test]
fn exact_size_of_terms_is_the_acceleration_when_nothing_cancels() {
    let mut spread = Spread::new(11);
    for numbers in [SSVI, ROW1, TWO_SIDED] {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let s = side.sign();
            let mut equations = system.regularised_contact(side);
            for z in [0.0, 1e-4, 3e-3] {
                let q = f64::sqrt(z);
                let [w, x1, v1] = [1.5, 0.1, 0.6].map(|size| size * spread.unit());
                // Pressed, closing, and the structure driven away from where its spring and its dashpot hold it.
                equations.set_excitation(0.0, [s * numbers.p, 0.0]);
                let size = equations.size_of_terms(&[q, w, -s * x1, -s * v1, 0.0]);
                let along = equations.size_of_terms(&[q, w, s * x1, v1, 0.0]);
                let contact = system.hertz(side) * z.powf(1.5);
                let spring = numbers.k2 * (z + s * (system.wall(side) - numbers.d));
                let terms = [numbers.p, numbers.c1 * v1, numbers.k1 * x1, contact, numbers.c2 * w, spring];
                let expected = terms.iter().sum::<f64>() / numbers.m1;
                assert!((size / expected - 1.0).abs() < 1e-13, "{side:?} {z}: {size} {expected}");
                assert_eq!(size, along, "signs do not matter");
                if q > 0.0 {
                    let accelerated = equations.derivative(&[q, w, -s * x1, -s * v1, 0.0])[3] / q;
                    assert!((accelerated / (s * size) - 1.0).abs() < 1e-12, "{side:?} {accelerated} {size}");
                }
                // The size of the force does not depend on its phase.
                equations.set_excitation(0.0, [0.6 * numbers.p, -0.8 * numbers.p]);
                let turned = equations.size_of_terms(&[q, w, -s * x1, -s * v1, 0.0]);
                assert!((turned / size - 1.0).abs() < 1e-14);
            }
        }
    }
}

/// The series for the lift-off, term by term: what it leaves out is of third order in the steady acceleration's share `y`, of fifth in
/// the contact's share `x` alone, and of third in both together.
#[test]
fn exact_series_of_the_lift_off_against_quadrature() {
    for side in Side::BOTH {
        for (x, y) in [(0.2, 0.0), (0.0, 0.02), (0.0, -0.02), (0.04, 0.02), (0.04, -0.02), (0.08, -0.01)] {
            // Only the force accelerates beside the contact; the shares say how deep and how strongly.
            let speed = 0.5;
            let system = COLLISION.coupled();
            let (m1, kappa) = (COLLISION.m1, system.hertz(side) * (1.0 / COLLISION.m1 + 1.0 / COLLISION.m2));
            let q = (x * speed * speed / (0.8 * kappa)).powf(0.2).max(1e-2);
            let x = 0.8 * kappa * q.powi(5) / (speed * speed);
            let steady = y * speed * speed / (2.0 * q * q);
            let mut equations = system.regularised_contact(side);
            equations.set_excitation(0.0, [-side.sign() * m1 * steady, 0.0]);
            let w = -(speed * speed * (1.0 - x + y)).sqrt();
            let state = [q, w, 0.0, 0.0, 0.0];
            let beside = equations.acceleration(&state) + equations.hertz_rate() * q.powi(3);
            assert!((beside - steady).abs() <= 1e-9 * (1.0 + steady.abs()), "{beside} {steady}");
            // Simpson's rule for ∫ 2 dq / |w|.
            let n = 2000;
            let rate = |i: u32| {
                let p = q * f64::from(i) / f64::from(n);
                2.0 / (speed * speed - 0.8 * kappa * p.powi(5) + 2.0 * steady * p * p).sqrt()
            };
            let weight = |i: u32| if i == 0 || i == n { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
            let expected = (0..=n).map(|i| weight(i) * rate(i)).sum::<f64>() * q / f64::from(3 * n);
            let found = equations.theta_to_wall(&state);
            let allowed =
                1e-12 + 0.05 * y.abs().powi(3) + 0.02 * x.powi(5) + 0.2 * (x * y).abs() * (x + y.abs());
            assert!(
                (found / expected - 1.0).abs() < allowed,
                "{side:?} {x} {y}: {found} {expected} {allowed}"
            );
        }
    }
}
