//! The text on the charts' results: `results/accuracy/README.md`.

use crate::curves::{Curve, Measure, curves};
use crate::moreau_jean::STEPPER;
use crate::reference::Reference;
use crate::runs::{Row, way};
use crate::savings::Saving;
use crate::scenes::Case;
use crate::statistics::Statistics;
use retune_solver::Settings;
use std::fmt::Write;

/// A time, s, with a readable unit.
fn time(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.3} ms", s * 1e3),
        s if s < 1.0 => format!("{:.1} ms", s * 1e3),
        s => format!("{s:.1} s"),
    }
}

/// A factor, to two digits; below 0.1 to one.
fn factor(f: f64) -> String {
    match f {
        f if f < 0.001 => format!("{f:.0e}"),
        f if f < 0.01 => format!("{f:.3}"),
        f if f < 1.0 => format!("{f:.2}"),
        f if f < 10.0 => format!("{f:.1}"),
        f if f < 100.0 => format!("{f:.0}"),
        f => {
            let unit = 10f64.powf(f.log10().floor() - 1.0);
            let digits = format!("{:.0}", (f / unit).round() * unit);
            let grouped: Vec<&str> =
                digits.as_bytes().rchunks(3).rev().filter_map(|c| std::str::from_utf8(c).ok()).collect();
            grouped.join(",")
        }
    }
}

/// The whole text.
pub fn text(
    machine: &str,
    cases: &[Case],
    references: &[Reference],
    rows: &[Row],
    savings: &[Saving],
    chaos: &[Statistics],
) -> String {
    let mut out = String::from(
        "# Speed against accuracy\n\nWritten by `just lab accuracy` from `runs.csv`, where every run stands, failures with their reason.\n\n",
    );
    made(&mut out, machine, rows);
    out += "\n![error of E1max against time](time.svg)\n";
    in_short(&mut out, cases, rows);
    defaults(&mut out, cases, rows);
    paper_defaults(&mut out, cases, rows);
    out += HOW_TO_READ;
    reference(&mut out, cases, references);
    beyond(&mut out, chaos);
    digits(&mut out, cases, rows);
    stepper(&mut out, cases, rows);
    models(&mut out, savings);
    out
}

const HOW_TO_READ: &str = "\n## How to read the charts\n\nAn error counts only if no tighter setting of the same method exceeds it: a lucky run does not. Each \
    method is shown with the way to meet contacts, located or stepped over, that serves it better. A run's time is the least \
    of several. Retune's contains the search for E1max, that of all others does not. Evaluations are of right-hand sides \
    and Jacobians; the hybrid's exact flight steps count as one each. Every timed program is compiled, with its right-hand side: the Rust crates as part of `just lab accuracy`, \
    CVODE from `tests/reference/external/cvode_methods.c`. GNU Octave and SciPy (`just lab accuracy-external`) interpret their right-hand sides, so that their times would measure \
    an interpreter: they stand among the evaluations alone. Octave has no dense output: E1 between its \
    steps is that of the quintic that meets position, velocity and acceleration; from SciPy's dense output E1max is read to about 1e-8. \
    Between rigid walls contacts are always located, but by the time stepper.\n\n\
    ![error of E1max against evaluations](evaluations.svg)\n![error of the final state against time](state.svg)\n";

/// Machine, compilers, commit, and the scatter of times.
fn made(out: &mut String, machine: &str, rows: &[Row]) {
    let spreads = rows.iter().filter_map(|row| Some(row.found.as_ref().ok()?.time.spread));
    let mut spreads: Vec<f64> = spreads.filter(|spread| spread.is_finite()).collect();
    spreads.sort_by(f64::total_cmp);
    if !rows.iter().any(|row| row.program.starts_with("SUNDIALS")) {
        *out += "CVODE is left out: there was no C compiler, or no SUNDIALS.\n\n";
    }
    let share =
        |of: f64| 100.0 * spreads.get((of * spreads.len() as f64) as usize).copied().unwrap_or(f64::NAN);
    let _ = writeln!(
        out,
        "Times: {machine}. The median of a run's repetitions is above their least, which is its time, by {:.0} % in half of the runs, and by {:.0} % at most in nine of ten \
         (column `spread`). Errors, counts and evaluations do not depend on the machine's speed: `just lab accuracy check` runs every row again, `retune verify results/accuracy` a sample.",
        share(0.5),
        share(0.9)
    );
}

/// The least times in which compiled programs reach an error level, ascending, s.
fn costs<'a>(curves: &'a [Curve<'a>], level: f64) -> Vec<(f64, &'a Curve<'a>)> {
    let compiled = curves.iter().filter(|c| !c.is_interpreted());
    let mut costs: Vec<_> = compiled.filter_map(|c| Some((c.cost_at(level)?.0, c))).collect();
    costs.sort_by(|a, b| a.0.total_cmp(&b.0));
    costs
}

fn in_short(out: &mut String, cases: &[Case], rows: &[Row]) {
    *out += "\n## In short\n\n";
    for level in LEVELS {
        let (mut next, mut lost, mut paper, mut never) = (Vec::new(), Vec::new(), Vec::new(), 0);
        for case in cases {
            let curves = curves(rows, case, Measure::E1max);
            let costs = costs(&curves, level);
            let Some(&(hybrid, _)) = costs.iter().find(|c| c.1.name == "hybrid") else { continue };
            let rival = costs.iter().find(|c| c.1.name != "hybrid");
            match rival.map(|(cost, curve)| (cost / hybrid, curve)) {
                Some((share, curve)) if share < 1.0 => {
                    lost.push(format!("{} ({} in {} of its time)", case.label, curve.name, factor(share)));
                }
                rival => next.extend(rival.map(|(factor, _)| factor)),
            }
            match costs.iter().find(|c| c.1.name == "ode23s") {
                Some(c) => paper.push(c.0 / hybrid),
                None => never += 1,
            }
        }
        let span = |of: &[f64]| {
            let (least, most) =
                (of.iter().copied().fold(f64::INFINITY, f64::min), of.iter().copied().fold(0.0, f64::max));
            format!("{} to {} times", factor(least), factor(most))
        };
        let paper = match (paper.is_empty(), never) {
            (true, _) => String::from("the paper's ode23s does not get there on any, as far as it was run"),
            (_, 0) => format!("the paper's ode23s takes {}", span(&paper)),
            (_, never) => {
                format!("the paper's ode23s takes {}, and on {never} does not get there", span(&paper))
            }
        };
        let slower =
            if lost.is_empty() { String::new() } else { format!(" It is slower on: {}.", lost.join(", ")) };
        let _ = writeln!(
            out,
            "- To a relative error of E1max of {level:.0e} the hybrid is the fastest on {} of {} scenes. There the next best method takes {} its time; over all of them {paper}.{slower}",
            cases.len() - lost.len(),
            cases.len(),
            span(&next),
        );
    }
}

/// The loosest decade of rtol at which the hybrid's error of E1max stays below a level on all scenes, and its longest run there, s.
fn loosest(cases: &[Case], rows: &[Row], level: f64) -> (f64, f64) {
    let all: Vec<_> = cases.iter().map(|case| curves(rows, case, Measure::E1max)).collect();
    let hybrids = || all.iter().flatten().filter(|c| c.name == "hybrid");
    let rtol = hybrids()
        .map(|c| c.points.iter().filter(|p| p.0 <= level).map(|p| p.1.setting).fold(0.0, f64::max))
        .fold(1.0, f64::min);
    (rtol, time_at(cases, rows, rtol))
}

/// The hybrid's longest run at a tolerance, s.
fn time_at(cases: &[Case], rows: &[Row], rtol: f64) -> f64 {
    rows.iter()
        .filter(|r| r.name() == "hybrid" && cases.iter().any(|c| c.name == r.scene))
        .filter(|r| r.is_at(rtol))
        .filter_map(|r| r.cost(true))
        .fold(0.0, f64::max)
}

fn defaults(out: &mut String, cases: &[Case], rows: &[Row]) {
    *out += "\n## Which tolerance follows\n\nThe loosest decade of the hybrid's rtol whose error of E1max stays below the level on all scenes.\n\n\
        | stage | error of E1max allowed | rtol | longest run of the scenes |\n| --- | --- | --- | --- |\n";
    for (stage, level) in [("grid", 1e-4), ("refinement", 1e-6), ("certificate", 1e-9)] {
        let (rtol, longest) = loosest(cases, rows, level);
        let _ = writeln!(out, "| {stage} | {level:.0e} | {rtol:.0e} | {} |", time(longest));
    }
    let default = Settings::default().rtol;
    let (grid, at_grid) = loosest(cases, rows, 1e-4);
    let (certificate, _) = loosest(cases, rows, 1e-9);
    let verdict = if default <= certificate { "covers" } else { "does not cover" };
    let _ = writeln!(
        out,
        "\nThe code's one default, rtol {default:.0e}, {verdict} the certificate, whose {certificate:.0e} it is compared with. A run at it takes {} times as long as one at \
         {grid:.0e}, the loosest that serves a grid: the price of values that need no second look, and of one number instead of three.",
        factor(time_at(cases, rows, default) / at_grid)
    );
}

fn paper_defaults(out: &mut String, cases: &[Case], rows: &[Row]) {
    *out += "\n## What ode23s gives at its default tolerance\n\nRelTol 1e-3, forces stepped over, as in the paper: relative errors of E1max and of the final state, and impacts found.\n\n\
        | scene | ode23s | GNU Octave's ode23s | hybrid at rtol 1e-3 |\n| --- | --- | --- | --- |\n";
    for case in cases {
        let cell = |name: &str, contacts: &str| {
            let own = |r: &&Row| r.scene == case.name && r.name() == name && r.contacts == contacts;
            rows.iter().filter(own).find(|r| r.is_at(1e-3)).map_or(String::from("not run"), |r| {
                match &r.found {
                    Ok(f) => format!(
                        "{:.0e}, {:.0e}, {} of {}",
                        r.errors[0], r.errors[1], f.impacts, r.expected_impacts
                    ),
                    Err(why) => why.clone(),
                }
            })
        };
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} |",
            case.label,
            cell("ode23s", "stepped"),
            cell("Octave ode23s", "stepped"),
            cell("hybrid", "exact")
        );
    }
}

fn reference(out: &mut String, cases: &[Case], references: &[Reference]) {
    *out += "\n## The reference and its own uncertainty\n\nThe hybrid at rtol 1e-13, from t = 0 to T. Its uncertainty is the larger of two distances: from the hybrid at 1e-12, and from \
        another method, DOP853 with located contacts at 1e-13. Smaller errors than that mean nothing. The Lyapunov time is that in which neighbouring motions part by a factor e, by the larger of two rates: \
        the largest Lyapunov exponent of the settled motion (200 periods) and the mean rate over the run itself; rates below zero mean that they meet. \
        The predictable horizon is that of an error of 1e-6 in double precision, ln 10¹⁰ Lyapunov times. Every run ends inside it.\n\n\
        | scene | T, s | E1max, J | impacts | rate: settled, run, 1/s | Lyapunov time, s | horizon, s | uncertainty of E1max | of the final state | of the impact times, s |\n\
        | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (case, r) in cases.iter().zip(references) {
        let settled = r.exponent.map_or(String::from("-"), |e| format!("{:+.3} ± {:.3}", e.value, e.error));
        let run = r.parting.map_or(String::from("-"), |rate| format!("{rate:+.3}"));
        let lyapunov = r.lyapunov_time().map_or(String::from("none: motions meet"), |t| format!("{t:.1}"));
        let horizon = if r.horizon().is_finite() { format!("{:.0}", r.horizon()) } else { "any".into() };
        let [a, b, c] = r.uncertainty;
        let _ = writeln!(
            out,
            "| {} | {} | {:.9} | {} | {settled}, {run} | {lyapunov} | {horizon} | {a:.0e} | {b:.0e} | {c:.0e} |",
            case.label, case.to, r.found.e1_max, r.found.impacts
        );
    }
}

fn beyond(out: &mut String, chaos: &[Statistics]) {
    *out += "\n## Beyond the horizon\n\nTable 1's row 1 is chaotic (largest Lyapunov exponent about +0.9 1/s): after some 40 s no run in double precision is that of \
        its start, and only statistics can be compared. From 100 to 2,100 s:\n\n\
        | method | rtol, or step in s | mean of E1, J | exceeded 1 % of the time, J | impacts per second |\n| --- | --- | --- | --- | --- |\n";
    for s in chaos {
        let setting = s.settings.step.unwrap_or(s.settings.rtol);
        let _ = writeln!(
            out,
            "| {}, {} | {setting:.0e} | {:.1} ± {:.1} | {:.0} | {:.3} |",
            s.settings.method.name(),
            way(&s.settings),
            s.mean,
            s.error,
            s.exceeded,
            s.impacts
        );
    }
}

/// Errors whose costs are compared.
const LEVELS: [f64; 3] = [1e-3, 1e-6, 1e-9];

fn digits(out: &mut String, cases: &[Case], rows: &[Row]) {
    *out += "\n## What correct digits cost\n\nLeast time of a run to a relative error of E1max, ms, with the factor over the hybrid's; then the factor by which each digit between 1e-3 and 1e-9 \
        multiplies the time. \\*: faster than the hybrid. A dash: no setting that was run gets there.\n\n\
        | scene | error | hybrid | best other | next | ode23s | CVODE |\n| --- | --- | ---: | --- | --- | ---: | ---: |\n";
    for case in cases {
        let curves = curves(rows, case, Measure::E1max);
        for level in LEVELS {
            let costs = costs(&curves, level);
            let hybrid = costs.iter().find(|c| c.1.name == "hybrid").map_or(f64::NAN, |c| c.0);
            let show = |&&(cost, _): &&(f64, &Curve<'_>)| {
                format!(
                    "{:.3} ({}{})",
                    1e3 * cost,
                    factor(cost / hybrid),
                    if cost < hybrid { " \\*" } else { "" }
                )
            };
            let named = |c: Option<&(f64, &Curve<'_>)>| {
                c.map_or("-".into(), |c| format!("{} {}", c.1.name, show(&c)))
            };
            let mut others = costs.iter().filter(|c| c.1.name != "hybrid");
            let (first, second) = (named(others.next()), named(others.next()));
            let of =
                |is: fn(&Curve<'_>) -> bool| costs.iter().find(|c| is(c.1)).map_or("-".into(), |c| show(&c));
            let (paper, cvode) = (of(|c| c.name == "ode23s"), of(|c| c.program() == "SUNDIALS"));
            let _ = writeln!(
                out,
                "| {} | {level:.0e} | {:.3} | {first} | {second} | {paper} | {cvode} |",
                case.label,
                1e3 * hybrid
            );
        }
        let growth = |is: fn(&Curve<'_>) -> bool| {
            let at = |level| {
                let costs = curves.iter().filter(|c| is(c)).filter_map(|c| c.cost_at(level));
                costs.map(|c| c.0).reduce(f64::min)
            };
            let grown = Some((at(LEVELS[2])? / at(LEVELS[0])?).powf(1.0 / 6.0));
            grown.map(|factor| format!("× {factor:.2}"))
        };
        let text = |is| growth(is).unwrap_or("-".into());
        let (hybrid, paper, cvode) =
            (text(|c| c.name == "hybrid"), text(|c| c.name == "ode23s"), text(|c| c.program() == "SUNDIALS"));
        let other = text(|c| c.name != "hybrid" && !c.is_interpreted());
        let _ = writeln!(out, "| {} | a digit | {hybrid} | {other} | | {paper} | {cvode} |", case.label);
    }
}

fn stepper(out: &mut String, cases: &[Case], rows: &[Row]) {
    *out += "\n## Rigid walls by time stepping\n\nThe scheme of Moreau and Jean, that of Siconos (θ = 1/2, Newton's restitution, no events), written here in Rust, beside the hybrid at its loosest rtol, both between the \
        same rigid walls: Hertz's contacts are another model, to which it does not apply. Its order is one where there are impacts; chatter costs it nothing.\n\n\
        | scene | step, s | time, ms | error of E1max | of the final state | time of the hybrid, ms | its error of E1max |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    for case in cases {
        let of = |name: &'static str| {
            rows.iter().filter(move |r| r.scene == case.name && r.name().starts_with(name))
        };
        let Some(hybrid) = of("hybrid").max_by(|a, b| a.setting.total_cmp(&b.setting)) else { continue };
        for row in of(STEPPER) {
            let time = |row: &Row| 1e3 * row.cost(true).unwrap_or(f64::NAN);
            let _ = writeln!(
                out,
                "| {} | {:.0e} | {:.3} | {:.0e} | {:.0e} | {:.3} | {:.0e} |",
                case.label,
                row.setting,
                time(row),
                row.errors[0],
                row.errors[1],
                time(hybrid),
                hybrid.errors[0]
            );
        }
    }
}

fn models(out: &mut String, savings: &[Saving]) {
    let default = Settings::default().rtol;
    let _ = write!(
        out,
        "\n## No more model than a scene needs\n\nE1max at rtol {default:.0e} under the smallest model that is exact for the scene, which Retune picks by itself, and under the full contact model. \
         A scene whose damper touches needs the full model and saves nothing; a linear scene saves most where the maximum is taken after the transient, which the closed form skips.\n\n![models](models.svg)\n\n\
         | scene | smallest exact model | its time | full contact model | saving | difference of E1max |\n| --- | --- | --- | --- | --- | --- |\n"
    );
    for s in savings {
        let [small, full] = s.seconds;
        let difference = (s.e1_max[0] / s.e1_max[1] - 1.0).abs();
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {:.1} × | {difference:.0e} |",
            s.label,
            s.model,
            time(small),
            time(full),
            full / small
        );
    }
}
