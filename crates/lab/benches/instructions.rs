//! Instructions of a run of 100 s, counted by valgrind: the same on a busy machine as on a quiet one; and the least time of many.
//! `just lab bench-instructions`.
//!
//! The program runs itself under callgrind, with many runs and with few; the difference is that of the runs alone.
#![expect(clippy::print_stdout, reason = "a measurement is printed")]

use retune_solver::{Settings, Window, e1_max};
use retune_testkit::scenes::{Numbers, ROW3, SSVI, TMD};
use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

const WHOLE: Window = Window { from: 0.0, to: 100.0 };
const SCENES: [(&str, Numbers); 8] = [
    ("SSVI, Table 2", SSVI),
    ("SSVI, Table 1 row 3", ROW3),
    ("TMD", TMD),
    ("SSVI, tuned", TUNED),
    ("the same, rigid", Numbers { rigid: Some(0.7), ..TUNED }),
    ("Table 2, lambda", Numbers { lambda: 0.45, ..SSVI }),
    ("Table 2, e = 0.7", Numbers { e: 0.7, ..SSVI }),
    ("Table 2, rigid", Numbers { rigid: Some(0.7), ..SSVI }),
];
/// The damper of `results/ssvi`.
const TUNED: Numbers = Numbers { k2: 583.9, c2: 94.97, d: 0.02885, c: 1.105, ..SSVI };
const RTOLS: [f64; 5] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
/// The two numbers of runs whose difference is taken. The first run of a program also computes the rules for contacts.
const FEW: u64 = 2;
const MANY: u64 = 12;
/// Runs of which the least time is taken.
const TIMED: u32 = 3000;

fn value(scene: usize, rtol: f64) -> f64 {
    let settings = Settings { rtol, ..Settings::default() };
    e1_max(black_box(&SCENES[scene].1.scene()), WHOLE, &settings, f64::INFINITY).expect("a run").value
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, flag, scene, rtol, runs] = &arguments[..]
        && flag == "--runs"
    {
        let (scene, rtol, runs): (usize, usize, u64) = (
            scene.parse().expect("a number"),
            rtol.parse().expect("a number"),
            runs.parse().expect("a number"),
        );
        for _ in 0..runs {
            black_box(value(scene, RTOLS[rtol]));
        }
        return;
    }
    println!("{:<22}{:>8}{:>10}{:>14}{:>14}", "scene", "rtol", "error", "instructions", "least, us");
    for (scene, (name, _)) in SCENES.iter().enumerate() {
        let converged = value(scene, 1e-12);
        for (number, rtol) in RTOLS.into_iter().enumerate() {
            let error = (value(scene, rtol) / converged - 1.0).abs();
            match (count(scene, number, FEW), count(scene, number, MANY)) {
                (Ok(few), Ok(many)) => {
                    let each = (many - few) / (MANY - FEW);
                    let least = 1e6 * least_time(|| value(scene, rtol));
                    println!("{name:<22}{rtol:>8e}{error:>10.0e}{each:>14}{least:>14.1}");
                }
                (Err(reason), _) | (_, Err(reason)) => {
                    println!("callgrind could not count (is valgrind installed?): {reason}");
                    std::process::exit(1);
                }
            }
        }
    }
    let tmd = TMD.coupled();
    let worst = least_time(|| tmd.steady_e1_max(black_box([5.0, 8.0])).value);
    println!("worst steady E1max of the TMD over 5 to 8 rad/s, closed form: {:.2} us", 1e6 * worst);
}

/// The least time of many runs, s.
fn least_time(run: impl Fn() -> f64) -> f64 {
    let timed = |_| {
        let begun = Instant::now();
        black_box(run());
        begun.elapsed().as_secs_f64()
    };
    (0..TIMED).map(timed).fold(f64::INFINITY, f64::min)
}

/// Instructions of this program when it makes `runs` runs.
fn count(scene: usize, rtol: usize, runs: u64) -> Result<u64, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(["--runs", &scene.to_string(), &rtol.to_string(), &runs.to_string()])
        .output()
        .map_err(|error| error.to_string())?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        return Err(format!("the program did not end well under it: {said}"));
    }
    let counted = said.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    counted.ok_or_else(|| said.into_owned())
}
