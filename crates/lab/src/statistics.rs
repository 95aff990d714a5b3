//! Beyond the predictable horizon: a chaotic motion, where only statistics can be compared.

use crate::Any;
use crate::runs::settings as with;
use crate::scenes::ROW1;
use retune_solver::{Contacts, Method, Rows, Settings, Window, simulate, trajectory};

/// From t = 100 s for 2,000 s: some 2,000 periods and 1,800 Lyapunov times.
pub const WINDOW: Window = Window { from: 100.0, to: 2100.0 };
/// Time between two samples, s.
const INTERVAL: f64 = 0.02;
/// Blocks whose scatter gives the standard error.
const BLOCKS: usize = 20;

/// Long-run statistics of the motion by one method.
pub struct Statistics {
    pub settings: Settings,
    /// Mean of E1 over time, J.
    pub mean: f64,
    /// Its standard error, from the scatter of blocks of time, J.
    pub error: f64,
    /// The value that E1 exceeds 1 % of the time, J.
    pub exceeded: f64,
    /// Impacts per second.
    pub impacts: f64,
}

/// Runs Table 1's row 1, whose largest Lyapunov exponent is about +0.9 1/s.
pub fn of(settings: Settings) -> Any<Statistics> {
    let scene = ROW1.scene();
    let mut samples = Vec::new();
    trajectory(&scene, WINDOW, &settings, Rows::every(INTERVAL), &mut |sample| samples.push(sample.e1))?;
    let average = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let mean = average(&samples);
    let blocks: Vec<f64> = samples.chunks_exact(samples.len() / BLOCKS).map(average).collect();
    let scatter: f64 = blocks.iter().map(|b| (b - mean).powi(2)).sum();
    let error = (scatter / (blocks.len() * (blocks.len() - 1)) as f64).sqrt();
    samples.sort_by(f64::total_cmp);
    let found = simulate(&scene, WINDOW, &settings)?;
    let impacts = (found.impacts[0] + found.impacts[1]) as f64 / (WINDOW.to - WINDOW.from);
    Ok(Statistics { settings, mean, error, exceeded: samples[samples.len() * 99 / 100], impacts })
}

/// The methods compared.
pub fn all() -> Any<Vec<Statistics>> {
    use Contacts::{Located, Stepped};
    [
        (Method::Hybrid, Located, 1e-4),
        (Method::Hybrid, Located, 1e-6),
        (Method::Hybrid, Located, 1e-10),
        (Method::Dop853, Located, 1e-8),
        (Method::Ode45, Stepped, 1e-6),
        (Method::Ode23s, Stepped, 1e-3),
        (Method::Ode23s, Stepped, 1e-5),
        (Method::Euler, Stepped, 1e-3),
    ]
    .into_iter()
    .map(|(method, contacts, setting)| of(with(method, contacts, setting)))
    .collect()
}
