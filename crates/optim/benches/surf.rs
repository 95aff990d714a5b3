//! Time and memory of a `surf` of 20^4 points, each a run of 100 s of the paper's SSVI NES. `just bench-surf`.
#![expect(clippy::print_stdout, reason = "a measurement is printed")]

#[path = "../../model/tests/scenes/mod.rs"]
mod scenes;

use retune_optim::{Axis, Grid, PeakEnergy, Scale, Variable, surf};
use retune_solver::{Settings, Window};
use scenes::SSVI;
use std::time::Instant;

const POINTS: usize = 20;
/// The ranges of `studies/ssvi.json`, in the order of [`Variable::ALL`]: N/m, N·s/m, m, m.
const RANGES: [(f64, f64, Scale); 4] = [
    (50.0, 1600.0, Scale::Log),
    (10.0, 400.0, Scale::Log),
    (0.02, 0.26, Scale::Linear),
    (0.06, 0.78, Scale::Linear),
];

fn main() {
    let axis = |(from, to, scale)| Axis::new(from, to, POINTS, scale).expect("a range");
    let grid = Grid::new(RANGES.map(axis).to_vec(), POINTS.pow(4)).expect("a grid");
    let window = Window { from: 50.0, to: 100.0 };
    let objective =
        PeakEnergy::new(SSVI.scene(), SSVI.damper(), Variable::ALL.to_vec(), window, Settings::default());
    let begun = Instant::now();
    let values = surf(&grid, |design| objective.value(design, f64::INFINITY), |_| ());
    let seconds = begun.elapsed().as_secs_f64();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!("surf of {} runs of 100 s on {threads} threads: {seconds:.1} s", values.len());
    println!("{:.3} ms a run and thread", 1e3 * seconds * threads as f64 / values.len() as f64);
    println!("{} runs failed", objective.failures().count);
    match peak_memory_kib() {
        Some(kib) => println!("largest memory {:.1} MB", kib as f64 * 1.024e-3),
        None => println!("largest memory not known on this system (read from Linux's /proc)"),
    }
}

/// Largest resident memory of this process so far, KiB.
fn peak_memory_kib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse().ok()
}
