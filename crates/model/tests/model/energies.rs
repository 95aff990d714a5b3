//! Energies, the norms made of them, and the bounds that the solver's step lengths rest on.

use nalgebra::{DMatrix, SMatrix, SVector};
use retune_model::{Side, energy_ratios};
use retune_testkit::scenes::{Numbers, SSVI, Spread, TMD};

fn random(spread: &mut Spread) -> Numbers {
    Numbers {
        m1: spread.logarithmic(1.0, 1e4),
        c1: spread.logarithmic(1e-2, 1e4),
        k1: spread.logarithmic(1.0, 1e6),
        m2: spread.logarithmic(1e-3, 1e4),
        k2: spread.logarithmic(1e-2, 1e6),
        c2: spread.logarithmic(1e-2, 1e6),
        omega: spread.logarithmic(1e-2, 1e3),
        ..SSVI
    }
}

/// From a deviation `[x1, v1, x2, v2]` from rest to coordinates in which twice the energy is the sum of squares.
fn energy_coordinates(n: &Numbers) -> SMatrix<f64, 4, 4> {
    #[rustfmt::skip]
    let rows = [
        n.k1.sqrt(), 0.0, 0.0, 0.0,
        0.0, n.m1.sqrt(), 0.0, 0.0,
        -n.k2.sqrt(), 0.0, n.k2.sqrt(), 0.0,
        0.0, 0.0, 0.0, n.m2.sqrt(),
    ];
    SMatrix::<f64, 4, 4>::from_row_slice(&rows)
}

#[test]
fn exact_energy_norm_is_the_norm_in_energy_coordinates() {
    let mut spread = Spread::new(5);
    for _ in 0..100 {
        let numbers = random(&mut spread);
        let system = numbers.coupled();
        let y: [f64; 4] = std::array::from_fn(|_| 0.03 * spread.signed());
        let deviation = SVector::from(y) - SVector::from(system.rest());
        let expected = (energy_coordinates(&numbers) * deviation).norm();
        let found = system.energy_norm(&y);
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        // In flight that is the whole mechanical energy.
        let flying = [y[0], y[1], y[0] + 0.3, y[3]];
        let (energy, norm) = (system.total_energy(&flying), system.energy_norm(&flying));
        assert!((0.5 * norm * norm / energy - 1.0).abs() < 1e-12, "{energy}");
        assert!((system.energy_norm_growth() - numbers.p / numbers.m1.sqrt()).abs() < 1e-12);
    }
}

/// No state of energy norm 1 exceeds the dual norm of a row, and one reaches it.
#[test]
fn exact_dual_energy_norm_is_the_largest_value_of_a_row() {
    let mut spread = Spread::new(6);
    for _ in 0..100 {
        let numbers = random(&mut spread);
        let system = numbers.coupled();
        let row = SVector::<f64, 4>::from_fn(|_, _| spread.signed());
        let bound = system.dual_energy_norm(&row.into());
        let back = energy_coordinates(&numbers).try_inverse().expect("springs and masses above zero");
        for _ in 0..20 {
            let u = SVector::<f64, 4>::from_fn(|_, _| spread.signed()).normalize();
            assert!((row.dot(&(back * u))).abs() <= bound * (1.0 + 1e-12));
        }
        let reached = row.dot(&(back * (back.transpose() * row).normalize()));
        assert!((reached / bound - 1.0).abs() < 1e-12, "{reached} {bound}");
    }
    // Of the bare structure, too: √(x²/k1 + v²/m1).
    let bare = SSVI.bare();
    for (row, expected) in [
        ([3.0, 0.0], 3.0 / SSVI.k1.sqrt()),
        ([0.0, -5.0], 5.0 / SSVI.m1.sqrt()),
        ([3.0, -5.0], (9.0 / SSVI.k1 + 25.0 / SSVI.m1).sqrt()),
    ] {
        assert!((bare.dual_energy_norm(&row) / expected - 1.0).abs() < 1e-14, "{row:?}");
    }
    // Nothing holds the damper: only a row that does not weigh its place has a bound.
    let free = Numbers { k2: 0.0, ..SSVI }.coupled();
    assert_eq!(free.dual_energy_norm(&[0.0, 0.0, 1.0, 0.0]), f64::INFINITY);
    assert!(free.dual_energy_norm(&[1.0, 1.0, 0.0, 1.0]).is_finite());
}

/// The rate bounds ω, every eigenvalue, and the norm of the linear part in energy coordinates.
#[test]
fn invariant_rate_bounds_the_linear_part() {
    let mut spread = Spread::new(7);
    let mut tightest = f64::INFINITY;
    for _ in 0..400 {
        let numbers = random(&mut spread);
        let system = numbers.coupled();
        let (a, _) = system.linear_part();
        let to = energy_coordinates(&numbers);
        let norm = (to * a * to.try_inverse().expect("regular")).singular_values().max();
        let eigenvalue = DMatrix::from_iterator(4, 4, a.iter().copied())
            .complex_eigenvalues()
            .iter()
            .map(|z| z.norm())
            .fold(0.0, f64::max);
        let rate = system.rate();
        assert!(norm <= rate * (1.0 + 1e-9), "{norm} {rate} {numbers:?}");
        assert!(
            eigenvalue <= rate * (1.0 + 1e-9) && numbers.omega <= rate,
            "{eigenvalue} {rate} {numbers:?}"
        );
        tightest = tightest.min(rate / norm.max(numbers.omega));

        let bare = numbers.bare();
        let (a, _) = bare.linear_part();
        let scale = SVector::<f64, 2>::new(numbers.k1.sqrt(), numbers.m1.sqrt());
        let scaled = SMatrix::<f64, 2, 2>::from_fn(|i, j| scale[i] * a[(i, j)] / scale[j]);
        assert!(scaled.singular_values().max() <= bare.rate() * (1.0 + 1e-9));
    }
    assert!(tightest < 1.01, "a bound that is never nearly reached wastes steps: {tightest}");
}

/// One spring or one dashpot alone, all else next to nothing: the rate is the norm, so no term of it is larger than it must be.
#[test]
fn exact_rate_of_a_single_cause() {
    let light = Numbers { c1: 1e-12, k1: 1e-12, k2: 1e-12, c2: 1e-12, omega: 1e-6, ..SSVI };
    for numbers in [
        Numbers { k1: SSVI.k1, ..light },
        Numbers { c1: SSVI.c1, ..light },
        Numbers { k2: SSVI.k2, ..light },
        Numbers { c2: SSVI.c2, ..light },
    ] {
        let system = numbers.coupled();
        let to = energy_coordinates(&numbers);
        let (a, _) = system.linear_part();
        let norm = (to * a * to.try_inverse().expect("regular")).singular_values().max();
        assert!((system.rate() / norm - 1.0).abs() < 1e-3, "{} {norm} {numbers:?}", system.rate());
    }
    let fast = Numbers { omega: 1e3, ..light };
    assert_eq!((fast.coupled().rate(), fast.bare().rate()), (1e3, 1e3));
}

#[test]
fn exact_momentum_and_ratios() {
    let system = TMD.coupled();
    assert_eq!(system.momentum(&[0.3, 2.0, 0.1, -5.0]), 2000.0 - 300.0);
    assert_eq!(energy_ratios(3.0, 1.0), [0.75, 0.25]);
    assert_eq!(system.damper_energy_weights(), [TMD.m2, TMD.k2]);
    assert!(energy_ratios(0.0, 0.0).iter().all(|r| r.is_nan()));
}

/// The energy of a contact is the work done against its force.
#[test]
fn exact_total_energy_counts_both_contacts() {
    let system = SSVI.coupled();
    let span = system.wall(Side::Obstacle);
    for (side, r) in [(Side::Primary, -2e-3), (Side::Obstacle, span + 2e-3)] {
        let work: f64 = {
            let n = 4000;
            let h = 2e-3 / f64::from(n);
            let force = |z: f64| system.hertz(side) * z.powf(1.5);
            (0..n).map(|i| h * force((f64::from(i) + 0.5) * h)).sum()
        };
        let spring = 0.5 * SSVI.k2 * (r - SSVI.d).powi(2);
        let found = system.total_energy(&[0.0, 0.0, r, 0.0]) - spring;
        assert!((found / work - 1.0).abs() < 1e-6, "{side:?} {found} {work}");
    }
}

/// "Large radii": R = 2 m is a contact stiffness of about 5e7 N/m^1.5, a little less at the softer obstacle side.
#[test]
fn paper_contact_stiffness() {
    let system = SSVI.coupled();
    let [primary, obstacle] = Side::BOTH.map(|side| system.hertz(side));
    assert!((primary / 5e7 - 1.0).abs() < 0.02, "{primary}");
    assert!((obstacle / primary / (2.05 / 2.21) - 1.0).abs() < 1e-4, "{obstacle}");
    for (radius, factor) in [(0.02, 0.1), (200.0, 10.0)] {
        let scaled = Numbers { r: radius, ..SSVI }.coupled().hertz(Side::Primary);
        assert!((scaled / primary / factor - 1.0).abs() < 1e-14);
    }
}
