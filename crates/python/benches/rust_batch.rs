//! A batch of designs without Python: `rust_batch STUDY THREADS REPEATS`, the designs one a line on standard input. Prints the least time
//! of a batch in seconds, and the sum of the values.
#![expect(clippy::print_stdout, reason = "a measurement is printed")]

use rayon::prelude::*;
use retune_optim::DesignObjective;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, study, threads, repeats] = arguments.as_slice() else {
        return Err("give a study, a number of threads and a number of repeats".into());
    };
    let study = retune_study::read(study.as_ref())?;
    let search = study.search()?;
    let settings = study.solver.settings();
    let objective =
        DesignObjective::new(study.scene, search.damper, search.variables, study.goal(), settings);
    let lines = std::io::stdin().lines().collect::<Result<Vec<_>, _>>()?;
    let design = |line: &String| line.split(' ').map(str::parse).collect::<Result<Vec<f64>, _>>();
    let designs = lines.iter().map(design).collect::<Result<Vec<_>, _>>()?;
    let value = |design: &Vec<f64>| {
        let scene = objective.scene(design).ok()?;
        Some(objective.evaluate(&scene, f64::INFINITY).ok()?.ranked)
    };
    let threads = threads.parse()?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let mut least = f64::INFINITY;
    let mut values = Vec::new();
    for _ in 0..repeats.parse::<u32>()? {
        let begun = Instant::now();
        values = match threads {
            1 => designs.iter().map(value).collect::<Vec<_>>(),
            _ => pool.install(|| designs.par_iter().map(value).collect()),
        };
        least = least.min(begun.elapsed().as_secs_f64());
    }
    println!("{least:e} {}", values.into_iter().flatten().sum::<f64>());
    Ok(())
}
