//! How long the parts of an answer take, on all cores: `just lab bench-explore`.

#![expect(clippy::print_stdout, reason = "a measurement is printed")]

use retune_explore::protocol::{DamperKind, Place};
use retune_explore::start::Start;
use retune_explore::{kind, motion, response};
use retune_jobs::simulate::simulate;
use retune_solver::{Rows, Window, trajectory};
use std::time::Instant;

/// Median of the times of some calls, ms.
fn median(mut call: impl FnMut()) -> f64 {
    let time = |call: &mut dyn FnMut()| {
        let begun = Instant::now();
        call();
        1e3 * begun.elapsed().as_secs_f64()
    };
    let mut times: Vec<f64> = (0..31).map(|_| time(&mut call)).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() {
    let start = Start::read(None).expect("the built-in study");
    let place = Place { damper: DamperKind::Ssvi, set: std::collections::BTreeMap::default() };
    let study = start.at(&place).expect("a study");
    let curve = response::Curve::of(&study, study.quantity());
    let over = |samples: usize| {
        median(|| {
            curve.over(samples, &|| false).expect("not stale");
        })
    };
    let met = |holds| if holds { "met" } else { "MISSED" };
    let whole = over(101);
    println!(
        "response of the paper's SSVI NES at 101 frequencies: {whole:.1} ms (target 120 ms): {}",
        met(whole <= 120.0)
    );
    println!("response at 31 and at 301 frequencies: {:.1} ms and {:.1} ms", over(31), over(301));
    let look = median(|| drop(motion::look(&study, [50.0, 100.0], 900)));
    println!("run, time series and last periods: {look:.1} ms");
    let (run, series) = (
        median(|| drop(simulate(&study, None))),
        median(|| drop(motion::series(&study, [50.0, 100.0], 900))),
    );
    let rows = Rows::every((50.0 / 1800.0_f64).min(motion::period(&study) / 48.0));
    let window = Window { from: 50.0, to: 100.0 };
    let even = median(|| {
        let mut count = 0;
        trajectory(&study.scene, window, &study.solver.settings(), rows, &mut |_| count += 1).expect("a run");
        assert!(count > 1800);
    });
    println!(
        "of which, side by side: the run's figures {run:.1} ms, its time series with located peaks {series:.1} ms (its rows without: {even:.1} ms)"
    );
    println!("kind of motion: {:.1} ms", median(|| drop(kind::kind(&study))));
}
