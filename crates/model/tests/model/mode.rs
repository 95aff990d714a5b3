//! A building of five storeys by its modes: A. K. Chopra, Dynamics of Structures, the uniform shear building of examples 13.2.6 and 13.2.7.

use nalgebra::{Complex, DMatrix, DVector};
use retune_model::{Coupled, Damper, Forcing, Mode, NonNegative, Positive, left_out, most_felt};
use std::f64::consts::{PI, TAU};

const STOREYS: usize = 5;
/// 100 kips and 31.54 kips/in in kg and N/m.
const M: f64 = 100.0 * 4_448.221_615 / 9.80665;
const K: f64 = 31.54 * 4_448.221_615 / 0.0254;
const ZETA: f64 = 0.05;

fn positive(value: f64) -> Positive {
    Positive::new(value).expect("above 0")
}

/// Shape of a mode at a storey (1 to 5): `sin(j (2n - 1) π / 11)`.
fn shape(mode: usize, storey: usize) -> f64 {
    ((storey * (2 * mode - 1)) as f64 * PI / (2 * STOREYS + 1) as f64).sin()
}

fn sum(mode: usize, power: i32) -> f64 {
    (1..=STOREYS).map(|storey| shape(mode, storey).powi(power)).sum()
}

/// Modes with their shape on the roof.
fn modes() -> Vec<Mode> {
    let omega = |n: usize| 2.0 * (K / M).sqrt() * ((2 * n - 1) as f64 * PI / (4 * STOREYS + 2) as f64).sin();
    let mode = |n: usize| Mode {
        omega: positive(omega(n)),
        zeta: NonNegative::new(ZETA).expect("not below 0"),
        mass: positive(M * sum(n, 2)),
        shape: shape(n, STOREYS),
    };
    (1..=STOREYS).map(mode).collect()
}

/// Chopra's periods (s) and effective masses (of m): T1 = 2 s; 4.398, 0.436, 0.121, 0.037 and 0.008 m.
#[test]
fn paper_the_modes_of_chopras_building() {
    let periods = modes().iter().map(|mode| TAU / mode.omega.get()).collect::<Vec<_>>();
    for (found, known) in periods.iter().zip([2.0, 0.6852, 0.4346, 0.3383, 0.2966]) {
        assert!((found / known - 1.0).abs() < 1e-3, "{found} {known}");
    }
    for (n, known) in (1..).zip([4.398, 0.436, 0.121, 0.037, 0.008]) {
        let effective = sum(n, 1).powi(2) / sum(n, 2);
        assert!((effective - known).abs() < 1e-3, "{effective} {known}");
    }
}

/// Masses, dampings by modes and stiffnesses of the building with its penthouse; the dynamic stiffness at `omega`, a force on the roof.
fn whole(omega: f64, [m2, k2, c2]: [f64; 3]) -> DVector<Complex<f64>> {
    let size = STOREYS + 1;
    let mut stiffness = DMatrix::<Complex<f64>>::zeros(size, size);
    for i in 0..STOREYS {
        let above = if i + 1 < STOREYS { K } else { 0.0 };
        stiffness[(i, i)] += Complex::from(K + above - omega * omega * M);
        if i + 1 < STOREYS {
            stiffness[(i, i + 1)] -= Complex::from(K);
            stiffness[(i + 1, i)] -= Complex::from(K);
        }
    }
    // M Φ diag(2ζω / Mn) Φᵀ M, the same damping in each mode.
    for (n, mode) in (1..).zip(modes()) {
        let rate = 2.0 * ZETA * mode.omega.get() / mode.mass.get() * M * M;
        for i in 0..STOREYS {
            for j in 0..STOREYS {
                let part = rate * shape(n, i + 1) * shape(n, j + 1);
                stiffness[(i, j)] += Complex::new(0.0, omega * part);
            }
        }
    }
    let joint = Complex::new(k2, omega * c2);
    let (roof, house) = (STOREYS - 1, STOREYS);
    stiffness[(roof, roof)] += joint;
    stiffness[(house, house)] += joint - omega * omega * m2;
    stiffness[(roof, house)] -= joint;
    stiffness[(house, roof)] -= joint;
    let mut force = DVector::<Complex<f64>>::zeros(size);
    force[roof] = Complex::from(1.0);
    stiffness.lu().solve(&force).expect("a solution")
}

/// All modes together are the building; one of them with a penthouse of 0.01 m is the building with its penthouse near that mode's
/// frequency, but for what the other modes add.
#[test]
fn exact_a_mode_is_the_building_but_for_the_other_modes() {
    let all = modes();
    assert_eq!(most_felt(&all), Some(0));
    let first = all[0];
    for omega in [0.7, 1.0, 2.9, 7.0].map(|times| times * first.omega.get()) {
        let sum: Complex<f64> = all.iter().map(|mode| mode.flexibility(omega)).sum();
        let building = whole(omega, [1e-9, 0.0, 0.0])[STOREYS - 1];
        assert!((sum - building).norm() < 1e-9 * building.norm(), "{sum} {building}");
    }
    let left_out = left_out(&all, 0);
    assert!((0.01..0.05).contains(&left_out), "{left_out}");
    // At its own frequency one without damping goes beyond all bounds, and others add nothing to that.
    let mut undamped = modes();
    undamped[1].zeta = NonNegative::default();
    assert_eq!(most_felt(&undamped), Some(1));
    assert_eq!(retune_model::left_out(&undamped, 1), 0.0);
    let primary = first.primary().expect("a structure");
    let (m2, omega2) = (0.01 * M, first.omega.get());
    let damper = [m2, m2 * omega2 * omega2, 2.0 * ZETA * m2 * omega2];
    let [mass, stiffness, damping] = damper;
    let reduced = Damper {
        mass: positive(mass),
        stiffness: NonNegative::new(stiffness).expect("not below 0"),
        damping: NonNegative::new(damping).expect("not below 0"),
        rest_distance: NonNegative::default(),
        clearance: NonNegative::default(),
        contact: None,
    };
    let unit = NonNegative::new(1.0).expect("not below 0");
    for times in [0.9, 0.95, 1.0, 1.05] {
        let omega = times * first.omega.get();
        let forcing = Forcing::force(unit, NonNegative::new(omega).expect("not below 0"));
        let found = Coupled::new(&primary, &forcing, &reduced).steady(omega);
        let building = whole(omega, damper);
        let penthouse = (found.x2.norm() / building[STOREYS].norm() - 1.0).abs();
        let roof = (found.x1.norm() / building[STOREYS - 1].norm() - 1.0).abs();
        assert!(penthouse < 2.5 * left_out && roof < 2.5 * left_out, "{penthouse} {roof} {left_out}");
    }
}
