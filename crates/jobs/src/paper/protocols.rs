//! What the paper leaves out of Table 1, tried: for which radius, frequency and window do its four rows have their four energies?

use super::item::{Grid, Item, Verdict};
use super::measures::{Spread, energy, near};
use super::plan::Plan;
use crate::Error;
use rayon::prelude::*;
use retune_model::{Parameter, Scene};
use retune_optim::Objective;
use retune_solver::Window;
use retune_study::Setting;

/// The rows of the paper's Table 1: k2, c2, D, C and E1max.
pub const PAPER: [([f64; 4], f64); 4] = [
    ([150.0, 218.4, 0.06, 0.11], 666.2),
    ([210.0, 218.4, 0.06, 0.11], 661.1376),
    ([220.375, 233.45, 0.060375, 0.36225], 573.108),
    ([215.0, 232.0, 0.06, 0.36], 563.0),
];

/// Radii, m, distances from the frequency of the study, rad/s, and the share of a run that passes before the window of its maxima.
const RADII: [f64; 6] = [0.1, 0.5, 1.0, 2.0, 5.0, 10.0];
const BESIDE: [f64; 5] = [-0.02, -0.01, 0.0, 0.01, 0.02];
const BEFORE: [f64; 3] = [0.0, 0.25, 0.5];
/// Designs of each median.
const FEW: u32 = 51;
/// Protocols that the table shows.
const SHOWN: usize = 6;

/// A protocol, and what the rows have under it.
struct Protocol {
    radius: f64,
    omega: f64,
    window: Window,
    rows: Vec<Spread>,
    /// Root mean square of the relative differences of the medians from the paper's.
    misfit: f64,
    /// Rows whose printed energy lies within the spread.
    inside: usize,
}

/// Adds the table of protocols and the statement that it decides.
///
/// # Errors
/// A setting that no scene can have.
pub fn protocols(plan: &Plan, item: &mut Item) -> Result<(), Error> {
    let end = plan.window().to;
    let middle = plan.ssvi.scene.forcing.frequency.get();
    let mut asked = Vec::new();
    for radius in RADII {
        for omega in BESIDE.map(|beside| middle + beside) {
            asked.extend(BEFORE.map(|share| (radius, omega, Window { from: share * end, to: end })));
        }
    }
    let bar = plan.watch.progress("table 1, protocols", asked.len() as u64);
    let one = |&(radius, omega, window): &(f64, f64, Window)| {
        let found = look(plan, radius, omega, window);
        bar.inc(1);
        found
    };
    let mut all = asked.par_iter().map(one).collect::<Result<Vec<Protocol>, Error>>()?;
    bar.finish();
    all.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let own = |of: &Protocol| {
        let here = plan.ssvi.value_of(Parameter::R) == Some(of.radius)
            && plan.ssvi.value_of(Parameter::Omega) == Some(of.omega);
        here && of.window == plan.window()
    };
    let head = [
        "R, m",
        "ω, rad/s",
        "window, s",
        "row 1, J",
        "row 2, J",
        "row 3, J",
        "row 4, J",
        "misfit, %",
        "rows within ±0.1 %",
    ];
    let caption = format!(
        "Protocols that the paper may have used: medians of {FEW} designs within ±0.1 %, the {SHOWN} that fit best of {}, and ours",
        all.len()
    );
    let mut grid = Grid::new(&caption, &head);
    for (_, of) in all.iter().enumerate().filter(|(i, of)| *i < SHOWN || own(of)) {
        let mut row = vec![
            format!("{}", of.radius),
            format!("{:.2}", of.omega),
            format!("{}–{}", of.window.from, of.window.to),
        ];
        row.extend(of.rows.iter().map(|spread| format!("{:.1}", spread.median)));
        row.push(format!("{:.1}", 100.0 * of.misfit));
        row.push(format!("{} of 4", of.inside));
        grid.rows.push(row);
    }
    item.grids.push(grid);
    let most = all.iter().map(|of| of.inside).max().unwrap_or(0);
    let (best, ours) = (all.first(), all.iter().find(|of| own(of)));
    item.conjecture(
        "the four rows have their energies under some radius, frequency and window",
        "Holds if under one of these protocols each of the four printed energies lies within what designs within ±0.1 % have; in part if the medians are within 2 % (root mean square) under one.",
        match (most, best) {
            (4, _) => Verdict::Holds,
            (_, Some(best)) if best.misfit <= 0.02 => Verdict::Partly,
            _ => Verdict::Fails,
        },
        format!(
            "of {} protocols {} put {most} rows within the spread, and none more; the best fits the medians to {:.1} %, ours to {:.1} %",
            all.len(),
            all.iter().filter(|of| of.inside == most).count(),
            100.0 * best.map_or(f64::NAN, |of| of.misfit),
            100.0 * ours.map_or(f64::NAN, |of| of.misfit)
        ),
    );
    Ok(())
}

fn look(plan: &Plan, radius: f64, omega: f64, window: Window) -> Result<Protocol, Error> {
    let mut rows = Vec::new();
    let (mut squares, mut inside) = (0.0, 0);
    for ([k2, c2, d, c], printed) in PAPER {
        let settings = [
            (Parameter::K2, k2),
            (Parameter::C2, c2),
            (Parameter::D, d),
            (Parameter::C, c),
            (Parameter::R, radius),
            (Parameter::Omega, omega),
        ];
        let scene = plan.ssvi.scene_with(&settings.map(|(name, value)| Setting::new(name, value)))?;
        let value = |scene: &Scene| energy(scene, &Objective::default(), window, &plan.settings());
        let spread = near(FEW, &scene, value);
        squares += (spread.median / printed - 1.0).powi(2);
        inside += usize::from((spread.least..=spread.largest).contains(&printed));
        rows.push(spread);
    }
    Ok(Protocol { radius, omega, window, rows, misfit: (squares / 4.0).sqrt(), inside })
}
