//! The steady response against a direct solution of the linear system, Den Hartog's fixed points, and known numbers.

use nalgebra::{Complex, SMatrix, SVector};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TMD, slope};

/// Solves `(iω - A) Y = b P` of the stated linear part.
fn solved<const N: usize>(a: SMatrix<f64, N, N>, b: [f64; N], omega: f64, p: f64) -> SVector<Complex<f64>, N>
where
    nalgebra::Const<N>: nalgebra::DimMin<nalgebra::Const<N>, Output = nalgebra::Const<N>>,
{
    let matrix = SMatrix::<Complex<f64>, N, N>::identity() * Complex::new(0.0, omega) - a.map(Complex::from);
    matrix.lu().solve(&SVector::from(b).map(|b| Complex::from(b * p))).expect("a regular matrix")
}

/// Largest `(m v² + k x²) / 2` over a period, by sampling it densely.
fn sampled(x: Complex<f64>, omega: f64, m: f64, k: f64) -> f64 {
    (0..20_000)
        .map(|i| {
            let turn = Complex::from_polar(1.0, f64::from(i) * std::f64::consts::TAU / 20_000.0);
            let (position, velocity) = ((x * turn).re, (x * turn * Complex::new(0.0, omega)).re);
            0.5 * (m * velocity * velocity + k * position * position)
        })
        .fold(0.0, f64::max)
}

/// At resonance, without damping, from rest: `x1 = P t sin(ωt) / (2 m1 ω)`, whose energy at the end of a period is all in its speed.
#[test]
fn exact_energy_that_a_force_brings_at_resonance() {
    let omega = (TMD.k1 / TMD.m1).sqrt();
    let numbers = Numbers { c1: 0.0, omega, ..TMD };
    let (bare, end) = (numbers.bare(), 5.0 * std::f64::consts::TAU / omega);
    let x1 = |t: f64| numbers.p * t * (omega * t).sin() / (2.0 * numbers.m1 * omega);
    let v1 = |t: f64| numbers.p * (t * (omega * t).cos() + (omega * t).sin() / omega) / (2.0 * numbers.m1);
    for t in [0.3, 2.0, end] {
        let [speed, acceleration] = bare.derivative(bare.excitation(t), &[x1(t), v1(t)]);
        let [found, rate] = slope(1e-3, |s| [x1(t + s), v1(t + s)]);
        assert!((speed - found).abs() < 1e-9 && (acceleration - rate).abs() < 1e-9, "{t}");
    }
    let energy = 0.5 * (numbers.m1 * v1(end).powi(2) + numbers.k1 * x1(end).powi(2));
    assert!((bare.resonant_energy(end) / energy - 1.0).abs() < 1e-12);
}

#[test]
fn exact_steady_response_solves_the_linear_system() {
    let mut spread = Spread::new(4);
    for _ in 0..50 {
        let numbers = Numbers {
            k1: spread.logarithmic(1e4, 1e5),
            m2: spread.logarithmic(1.0, 500.0),
            k2: spread.logarithmic(10.0, 1e4),
            c2: spread.logarithmic(1.0, 1e4),
            omega: spread.logarithmic(1.0, 20.0),
            ..TMD
        };
        let (system, omega) = (numbers.coupled(), numbers.omega);
        let (a, b) = system.linear_part();
        let expected = solved(a, b, omega, numbers.p);
        let found = system.steady(omega);
        for (found, expected) in [(found.x1, expected[0]), (found.x2, expected[2])] {
            assert!((found - expected).norm() < 1e-12 * expected.norm(), "{numbers:?}");
        }
        assert!((found.stroke() - (expected[2] - expected[0]).norm()).abs() < 1e-12 * expected.norm());
        let e1 = sampled(expected[0], omega, numbers.m1, numbers.k1);
        let e2 = sampled(expected[2], omega, numbers.m2, numbers.k2);
        assert!(
            (found.e1_max / e1 - 1.0).abs() < 1e-6 && (found.e2_max / e2 - 1.0).abs() < 1e-6,
            "{numbers:?}"
        );

        let bare = numbers.bare();
        let (a, b) = bare.linear_part();
        let (expected, found) = (solved(a, b, omega, numbers.p), bare.steady(omega));
        assert!((found.x1 - expected[0]).norm() < 1e-12 * expected.norm());
        assert!((found.e1_max / sampled(expected[0], omega, numbers.m1, numbers.k1) - 1.0).abs() < 1e-6);
        assert_eq!((found.e2_max, found.stroke()), (0.0, 0.0));
    }
}

/// Without damping of the structure every response curve passes through two points, whatever the damper's damping
/// (J. P. Den Hartog, Mechanical Vibrations, 4th ed. 1956, section 3.3).
#[test]
fn exact_den_hartog_fixed_points() {
    let numbers = Numbers { c1: 0.0, ..TMD };
    let omega_n = (numbers.k1 / numbers.m1).sqrt();
    for k2 in [600.0, 2083.2, 4000.0] {
        let mu = numbers.m2 / numbers.m1;
        let f2 = k2 / numbers.m2 / (omega_n * omega_n);
        // g⁴ - 2 g² (1 + f² + μ f²) / (2 + μ) + 2 f² / (2 + μ) = 0
        let half = (1.0 + f2 + mu * f2) / (2.0 + mu);
        let root = (half * half - 2.0 * f2 / (2.0 + mu)).sqrt();
        for g2 in [half - root, half + root] {
            let expected = numbers.p / numbers.k1 / (1.0 - g2 * (1.0 + mu)).abs();
            for c2 in [1.0, 50.0, 262.0, 5000.0] {
                let x1 = Numbers { k2, c2, ..numbers }.coupled().steady(g2.sqrt() * omega_n).x1.norm();
                assert!((x1 / expected - 1.0).abs() < 1e-10, "k2 {k2} c2 {c2} g² {g2}: {x1} {expected}");
            }
        }
    }
}

/// With Den Hartog's k2 both fixed points are √(1 + 2/μ) static deflections high, and with his c2 the curve rises hardly above them.
#[test]
fn exact_den_hartogs_damper_levels_the_fixed_points() {
    let numbers = Numbers { c1: 0.0, ..TMD };
    let scene = numbers.scene();
    let [k2, c2] = retune_model::den_hartog(&scene.primary, numbers.m2);
    let mu = numbers.m2 / numbers.m1;
    let height = numbers.p / numbers.k1 * (1.0 + 2.0 / mu).sqrt();
    let amplitude = |c2: f64, omega: f64| Numbers { k2, c2, ..numbers }.coupled().steady(omega).x1.norm();
    let omega_n = (numbers.k1 / numbers.m1).sqrt();
    let half = 1.0 / (1.0 + mu);
    let root = half * (mu / (2.0 + mu)).sqrt();
    for g2 in [half - root, half + root] {
        let x1 = amplitude(c2, g2.sqrt() * omega_n);
        assert!((x1 / height - 1.0).abs() < 1e-10, "{g2}: {x1} {height}");
    }
    let highest =
        |c2: f64| (0..4000).map(|i| amplitude(c2, omega_n * (0.6 + 2e-4 * f64::from(i)))).fold(0.0, f64::max);
    assert!(highest(c2) < 1.005 * height, "{} {height}", highest(c2));
    assert!(highest(0.7 * c2) > 1.01 * height && highest(1.4 * c2) > 1.01 * height);
}

/// With Warburton's damper the acceleration is hardly above its two fixed points, which are √(2 / (μ (1 + μ))) times P/m1 high.
#[test]
fn exact_warburtons_damper_levels_the_fixed_points_of_the_acceleration() {
    let numbers = Numbers { c1: 0.0, ..TMD };
    let [k2, c2] = retune_model::warburton(&numbers.scene().primary, numbers.m2);
    let mu = numbers.m2 / numbers.m1;
    let height = numbers.p / numbers.m1 * (2.0 / (mu * (1.0 + mu))).sqrt();
    let omega_n = (numbers.k1 / numbers.m1).sqrt();
    let highest = |c2: f64| {
        let at = |omega: f64| omega * omega * Numbers { k2, c2, ..numbers }.coupled().steady(omega).x1.norm();
        (0..4000).map(|i| at(omega_n * (0.6 + 2e-4 * f64::from(i)))).fold(0.0, f64::max)
    };
    let own = highest(c2);
    assert!((1.0 - 1e-6..1.01).contains(&(own / height)), "{own} {height}");
    assert!(highest(0.7 * c2) > 1.01 * height && highest(1.4 * c2) > 1.01 * height);
}

/// An undamped absorber tuned to the force holds an undamped structure still.
#[test]
fn exact_undamped_absorber() {
    let numbers = Numbers { c1: 0.0, c2: 0.0, k2: TMD.m2 * TMD.omega * TMD.omega, ..TMD };
    let steady = numbers.coupled().steady(SSVI.omega);
    assert!(steady.e1_max < 1e-20, "{}", steady.e1_max);
    assert!((steady.x2.norm() / (numbers.p / numbers.k2) - 1.0).abs() < 1e-12);
}

#[test]
fn paper_steady_energies() {
    // No damper, and Table 2's TMD, at ω = 6.28; the digits are those of three independent programs.
    let bare = SSVI.bare().steady(SSVI.omega).e1_max;
    assert!((bare - 1568.0).abs() < 0.05, "{bare}");
    let tmd = TMD.coupled().steady(SSVI.omega);
    assert!((tmd.e1_max - 635.1068).abs() < 1e-4, "{}", tmd.e1_max);
    // Its walls are out of reach, as Table 2 says.
    assert!(tmd.stroke() < TMD.d.min(TMD.c), "{}", tmd.stroke());
}

/// The natural frequency of section 2 of the paper, and the width of a sharp resonance: half the energy on either side of it.
#[test]
fn exact_natural_frequency_and_width_of_the_resonance() {
    for (m1, k1) in [(SSVI.m1, SSVI.k1), (2.7, 5.3e4), (300.0, 40.0)] {
        let natural = f64::sqrt(k1 / m1);
        let numbers = Numbers { m1, k1, c1: 2e-4 * natural * m1, ..SSVI };
        let (primary, bare) = (numbers.primary(), numbers.bare());
        assert!((primary.natural_frequency() / natural - 1.0).abs() < 1e-15);
        let width = primary.half_power_half_width();
        let top = bare.steady(natural).e1_max;
        for omega in [natural - width, natural + width] {
            let share = bare.steady(omega).e1_max / top;
            assert!((share - 0.5).abs() < 1e-3, "{share} of the energy at {omega}");
        }
    }
    assert!(
        (SSVI.primary().natural_frequency() / SSVI.omega - 1.0).abs() < 1e-3,
        "the paper drives at resonance"
    );
}
