//! The regularised equations of a contact against equation (1), and the undisturbed collision against quadrature.

mod scenes;

use retune_model::{Compressed, Side};
use scenes::{ROW1, SSVI, Spread, TWO_SIDED, slope};

const T: f64 = 1.21;

/// A random state pressed `z` (m) into a wall.
fn pressed(system: &retune_model::Coupled, side: Side, z: f64, spread: &mut Spread) -> [f64; 4] {
    let (x1, v1, v2) = (0.1 * spread.signed(), 0.6 * spread.signed(), 1.5 * spread.signed());
    [x1, v1, x1 + system.wall(side) + side.sign() * z, v2]
}

#[test]
fn exact_compressing_and_expanding_is_the_identity() {
    let mut spread = Spread::new(2);
    for numbers in [SSVI, ROW1] {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let equations = system.compression(side);
            assert_eq!(equations.side(), side);
            for z in [0.0, 1e-6, 1e-3, 0.02] {
                let y = pressed(&system, side, z, &mut spread);
                let compressed = equations.compress(system.drive(T), &y);
                assert!((compressed[0] - z.sqrt()).abs() < 1e-8, "{} {z}", compressed[0]);
                assert_eq!(compressed[6..], [0.0, 0.0]);
                let back = equations.expand(&compressed);
                for i in 0..4 {
                    assert!((back[i] - y[i]).abs() <= 1e-15, "{side:?} {z}: {back:?} {y:?}");
                }
            }
            let apart = equations.compress(system.drive(T), &pressed(&system, side, -0.01, &mut spread));
            assert_eq!(apart[0], 0.0, "a damper that is not in contact counts as touching");
        }
    }
}

/// The chain rule: the state that a regularised one stands for moves with `q` times equation (1).
#[test]
fn exact_regularised_equations_are_equation_1() {
    let mut spread = Spread::new(3);
    for numbers in [SSVI, ROW1, TWO_SIDED] {
        let system = numbers.coupled();
        for side in Side::BOTH {
            let equations = system.compression(side);
            for z in [1e-4, 1e-3, 5e-3] {
                let (y, drive) = (pressed(&system, side, z, &mut spread), system.drive(T));
                let compressed = equations.compress(drive, &y);
                let q = compressed[0];
                let rate = equations.derivative(&compressed);
                let expected = system.derivative(drive, &y);
                let moved = slope(1e-4, |s| {
                    let ahead: Compressed = std::array::from_fn(|i| compressed[i] + s * rate[i]);
                    equations.expand(&ahead)
                });
                for i in 0..4 {
                    let (found, expected) = (moved[i], q * expected[i]);
                    assert!((found - expected).abs() < 1e-10 * (1.0 + expected.abs()), "{side:?} {z} {i}");
                }
                let turned = slope(1e-3, |s| system.drive(T + s)).map(|d| q * d);
                assert!((rate[4] - turned[0]).abs() < 1e-7 && (rate[5] - turned[1]).abs() < 1e-7);
                assert_eq!(rate[6..], [q, 1.0], "dt = q dθ");
                let closing = side.sign() * (expected[3] - expected[1]);
                let found = equations.acceleration(&compressed);
                assert!((found - closing).abs() < 1e-10 * closing.abs(), "{found} {closing}");
            }
        }
    }
}

#[test]
fn exact_undisturbed_collision() {
    for side in Side::BOTH {
        let system = SSVI.coupled();
        let equations = system.compression(side);
        let kappa = system.hertz(side) * (1.0 / SSVI.m1 + 1.0 / SSVI.m2);
        assert!((equations.hertz_rate() / kappa - 1.0).abs() < 1e-15);
        assert!((equations.mass_ratio() / (1.0 + SSVI.m1 / SSVI.m2) - 1.0).abs() < 1e-15);
        for speed in [1e-3, 0.1, 1.0] {
            let (length, depth) = equations.collision(speed);
            assert!((equations.speed_at_depth(depth) / speed - 1.0).abs() < 1e-14);
            // Runge–Kutta on q' = w/2, w' = -κ q⁴ over half the length: there the damper is deepest and at rest.
            let steps = 2000;
            let h = 0.5 * length / f64::from(steps);
            let f = |[q, w]: [f64; 2]| [0.5 * w, -kappa * q.powi(4)];
            let add = |y: [f64; 2], s: f64, k: [f64; 2]| [y[0] + s * k[0], y[1] + s * k[1]];
            let mut y = [0.0, speed];
            for _ in 0..steps {
                let a = f(y);
                let b = f(add(y, 0.5 * h, a));
                let c = f(add(y, 0.5 * h, b));
                let d = f(add(y, h, c));
                let mean = [0, 1].map(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0);
                y = add(y, h, mean);
            }
            assert!((y[0] / depth - 1.0).abs() < 1e-10, "{} {depth}", y[0]);
            assert!(y[1].abs() < 1e-9 * speed, "{} {speed}", y[1]);
        }
    }
}

/// `∫₀¹ dx / √(1 - x⁵)` by Simpson's rule after `x = 1 - u²`, which takes the singularity away.
#[test]
fn exact_collision_integral() {
    let f = |u: f64| {
        let x = 1.0 - u * u;
        2.0 / (1.0 + x + x * x + x.powi(3) + x.powi(4)).sqrt() // 1 - x⁵ = u² (1 + x + x² + x³ + x⁴)
    };
    let n = 2000;
    let h = 1.0 / f64::from(n);
    let integral = (0..n)
        .map(|i| f64::from(i) * h)
        .map(|u| h / 6.0 * (f(u) + 4.0 * f(u + 0.5 * h) + f(u + h)))
        .sum::<f64>();
    let (length, depth) = SSVI.coupled().compression(Side::Primary).collision(0.5);
    let found = length * 0.5 / (4.0 * depth);
    assert!((found / integral - 1.0).abs() < 1e-13, "{found} {integral}");
}
