//! Beyond the predictable horizon: a chaotic motion, where only statistics can be compared.

use crate::own;
use crate::scenes::{ROW1, scene};
use retune_model::Scene;
use retune_solver::{Contacts, Method, Rows, Settings, Window, simulate, trajectory};
use std::error::Error;

/// Table 1's row 1, whose largest Lyapunov exponent is about +0.9 1/s.
///
/// # Errors
/// A value out of range.
pub fn chaotic() -> Result<Scene, Box<dyn Error>> {
    Ok(scene(ROW1)?)
}

/// From t = 100 s for 2,000 s: some 2,000 periods and 1,800 Lyapunov times.
pub const WINDOW: Window = Window { from: 100.0, to: 2100.0 };
/// Time between two samples, s.
const INTERVAL: f64 = 0.02;
/// Blocks whose scatter gives the standard error.
const BLOCKS: usize = 20;

/// Long-run statistics of the motion by one method.
pub struct Statistics {
    /// The method and its settings.
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

/// Runs the chaotic motion and collects its statistics.
///
/// # Errors
/// A run that failed.
pub fn of(settings: Settings) -> Result<Statistics, Box<dyn Error>> {
    let scene = chaotic()?;
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
///
/// # Errors
/// A run that failed.
pub fn all() -> Result<Vec<Statistics>, Box<dyn Error>> {
    let located = |rtol| own::settings(Method::Hybrid, Contacts::Located, rtol);
    let stepped = |method, rtol| own::settings(method, Contacts::Stepped, rtol);
    [
        located(1e-4),
        located(1e-6),
        located(1e-10),
        own::settings(Method::Dop853, Contacts::Located, 1e-8),
        stepped(Method::Ode45, 1e-6),
        stepped(Method::Ode23s, 1e-3),
        stepped(Method::Ode23s, 1e-5),
        stepped(Method::Euler, 1e-3),
    ]
    .into_iter()
    .map(of)
    .collect()
}
