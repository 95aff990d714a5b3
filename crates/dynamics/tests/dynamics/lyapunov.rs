//! Exponents of systems whose exponents are known.
#![allow(clippy::approx_constant, reason = "6.28 and 0.318 are the paper's inputs, not 2π and 1/π")]

use crate::common::{ROW1, TMD, scene};
use retune_dynamics::lyapunov::{Exponent, Neighbours, Pair};
use retune_dynamics::{Stretch, follow};
use retune_model::Coupled;
use retune_solver::Settings;
use std::convert::Infallible;

/// A map of the plane.
struct Plane<F>(F);

impl<F: FnMut([f64; 3]) -> [f64; 3]> Neighbours for Plane<F> {
    type State = [f64; 3];
    type Error = Infallible;
    fn step(&mut self, state: [f64; 3]) -> Result<[f64; 3], Infallible> {
        Ok((self.0)(state))
    }
    fn distance(&self, a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }
    fn between(&self, a: [f64; 3], b: [f64; 3], share: f64) -> [f64; 3] {
        std::array::from_fn(|i| a[i] + share * (b[i] - a[i]))
    }
}

/// Logarithms of growth over `steps` steps after `settle` steps in which the neighbour finds the fastest direction.
fn growth<N: Neighbours>(
    system: &mut N,
    mut pair: Pair<N::State>,
    settle: usize,
    steps: usize,
) -> Result<Vec<f64>, N::Error> {
    let mut rates = Vec::with_capacity(steps);
    for i in 0..settle + steps {
        let motion = system.step(pair.motion)?;
        let rate = pair.advance(system, motion)?;
        if i >= settle {
            rates.push(rate);
        }
    }
    Ok(rates)
}

fn exponent(map: impl FnMut([f64; 3]) -> [f64; 3], start: [f64; 3], steps: usize, duration: f64) -> Exponent {
    let distance = 1e-8;
    let neighbour = [start[0] + distance, start[1], start[2]];
    let rates = growth(&mut Plane(map), Pair { motion: start, neighbour, distance }, 200, steps);
    Exponent::of(&rates.unwrap_or_else(|never| match never {}), duration)
}

#[test]
fn exact_logistic_map_at_4_has_ln_2() {
    let found = exponent(|[x, ..]| [4.0 * x * (1.0 - x), 0.0, 0.0], [0.3, 0.0, 0.0], 100_000, 1.0);
    assert!((found.value - 2.0_f64.ln()).abs() < 3.0 * found.error.max(1e-3), "{found:?}");
}

/// J. C. Sprott, Chaos and Time-Series Analysis (2003), table A: 0.41922.
#[test]
fn reference_henon_map() {
    let found = exponent(|[x, y, _]| [1.0 - 1.4 * x * x + y, 0.3 * x, 0.0], [0.1, 0.1, 0.0], 100_000, 1.0);
    assert!((found.value - 0.41922).abs() < 3.0 * found.error.max(1e-3), "{found:?}");
}

/// Sprott (2003), table A: 0.9056 at σ = 10, ρ = 28, β = 8/3.
#[test]
fn reference_lorenz_equations() {
    let rate = |[x, y, z]: [f64; 3]| [10.0 * (y - x), x * (28.0 - z) - y, x * y - 8.0 / 3.0 * z];
    let h = 0.01;
    let rk4 = |y: [f64; 3]| {
        let along = |k: [f64; 3], s: f64| std::array::from_fn(|i| y[i] + s * k[i]);
        let k1 = rate(y);
        let k2 = rate(along(k1, 0.5 * h));
        let k3 = rate(along(k2, 0.5 * h));
        let k4 = rate(along(k3, h));
        std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    };
    let found = exponent(rk4, [1.0, 1.0, 20.0], 200_000, h);
    assert!((found.value - 0.9056).abs() < 3.0 * found.error.max(3e-3), "{found:?}");
    assert!(found.error < 0.03, "{found:?}");
}

/// With a linear damper the transient decays at the rate of the slowest mode, about -0.353 /s for the paper's TMD.
#[test]
fn exact_tmd_has_its_slowest_mode() {
    let scene = scene(3.95e4, 6.28, Some(TMD));
    let system = Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper"));
    let slowest =
        system.linear_part().0.complex_eigenvalues().iter().map(|mode| mode.re).fold(f64::MIN, f64::max);
    assert!((slowest + 0.353).abs() < 1e-3, "{slowest}");
    let record =
        follow(&scene, None, Stretch { settle: 50, observe: 400 }, &Settings::default()).expect("a run");
    let found = record.exponent();
    assert!((found.value - slowest).abs() < 2e-3, "{found:?} {slowest}");
}

/// Row 1 of Table 1; an independent program found about +0.9 /s.
#[test]
fn reference_row_1_of_table_1_is_strongly_chaotic() {
    let record = follow(
        &scene(3.95e4, 6.28, Some(ROW1)),
        None,
        Stretch { settle: 100, observe: 1000 },
        &Settings::default(),
    );
    let found = record.expect("a run").exponent();
    assert!((found.value - 0.9).abs() < 0.1 && found.error < 0.1, "{found:?}");
}
