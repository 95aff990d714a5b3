//! Time and memory of a `surf` of a million points, each a run of 100 s of the paper's SSVI NES, and its speed-up by threads: as exact as it need
//! be to say where a search starts, and as exact as results.
//! `just lab bench-surf`.
#![expect(clippy::print_stdout, reason = "a measurement is printed")]

use retune_optim::{Axis, DesignObjective, Grid, Parameter, Scale, surf};
use retune_solver::{Settings, Window};
use retune_testkit::scenes::SSVI;
use std::time::Instant;

/// Points along each axis of the large surf, and of the small one that is timed with one thread and with all.
const LARGE: usize = 32;
const SMALL: usize = 10;
const PAIRS: usize = 5;

/// The ranges of `studies/ssvi-resonance.json`, in the order of [`Parameter::VARIED`]: N/m, N·s/m, m, m.
const RANGES: [(f64, f64, Scale); 4] = [
    (50.0, 1600.0, Scale::Log),
    (10.0, 400.0, Scale::Log),
    (0.02, 0.26, Scale::Linear),
    (0.06, 0.78, Scale::Linear),
];

/// Relative tolerance, and E1max above which a run ends, J: an eighth of what the structure has without a damper.
const COARSE: (f64, f64) = (1e-4, 200.0);
const EXACT: (f64, f64) = (1e-10, f64::INFINITY);

fn main() {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    for (name, how) in [("coarse", COARSE), ("exact", EXACT)] {
        let mut least = [f64::INFINITY; 2];
        for _ in 0..PAIRS {
            for (least, threads) in least.iter_mut().zip([1, threads]) {
                *least = least.min(timed(SMALL, threads, how).0);
            }
        }
        let [one, all] = least;
        println!(
            "{name} surf of {} runs of 100 s: {one:.2} s on one thread, {all:.2} s on {threads}, {:.2} x",
            SMALL.pow(4),
            one / all
        );
    }
    let (seconds, failed) = timed(LARGE, threads, COARSE);
    let runs = LARGE.pow(4);
    println!("coarse surf of {runs} runs of 100 s on {threads} threads: {seconds:.1} s");
    println!("{:.3} ms a run and thread; {failed} runs failed", 1e3 * seconds * threads as f64 / runs as f64);
    match peak_memory_kib() {
        Some(kib) => println!("largest memory {:.1} MB", kib as f64 * 1.024e-3),
        None => println!("largest memory not known on this system (read from Linux's /proc)"),
    }
}

/// Time of a surf, s, and how many of its runs failed.
fn timed(points: usize, threads: usize, (rtol, most): (f64, f64)) -> (f64, u64) {
    let axis = |(from, to, scale)| Axis::new(from, to, points, scale).expect("a range");
    let grid = Grid::new(RANGES.map(axis).to_vec(), points.pow(4)).expect("a grid");
    let window = Window { from: 50.0, to: 100.0 };
    let settings = Settings { rtol, ..Settings::default() };
    let objective =
        DesignObjective::new(SSVI.scene(), SSVI.damper(), Parameter::VARIED.to_vec(), window, settings);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let begun = Instant::now();
    pool.install(|| surf(&grid, |design| objective.value_up_to(design, most), |_| ()));
    (begun.elapsed().as_secs_f64(), objective.failures().count)
}

/// Largest resident memory of this process so far, KiB.
fn peak_memory_kib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse().ok()
}
