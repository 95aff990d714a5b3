//! Searches for scenes where the hybrid is slowest relative to general methods.

use crate::decades;
use crate::runs::{self, way, ways};
use crate::scenes::{Numbers, SSVI};
use cpu_time::ThreadTime;
use rayon::prelude::*;
use retune_jobs::methods::settings;
use retune_model::Scene;
use retune_optim::{Bounds, Options, Side, Space, minimize};
use retune_solver::{Contacts, Method, Settings, Window, e1_max, touch_downs};
use retune_testkit::hunt::Hunt;
use std::ops::ControlFlow;

/// The relative error of E1max that all methods must reach.
const LEVEL: f64 = 1e-6;
const WINDOW: Window = Window { from: 0.0, to: 10.0 };
/// The explicit methods that were the best on some scene of `just lab accuracy`.
const GENERAL: [Method; 3] = [Method::Dop853, Method::Ode45, Method::Rk4];
/// Most steps of a general method: with more it would be far slower than the hybrid.
const MOST_STEPS: u64 = 30_000;
/// Number of scenes that are refined and reported, and most evaluations of each simplex.
const CLIMBS: usize = 2;
const MAX_VALUES: u64 = 60;

/// Practical dampers and forces, with contacts a hundredth to a hundred times as stiff as the paper's.
fn space() -> Space {
    let [m2, k2, c2] = [(10.0, 200.0), (50.0, 1e5), (5.0, 5000.0)];
    let [d, c, q] = [(0.0, 0.2), (0.01, 1.0), (0.01 * SSVI.q, 100.0 * SSVI.q)];
    let [omega, e, p] = [(4.0, 9.0), (0.3, 0.99), (300.0, 6000.0)];
    let side = |(from, to)| Side::natural(from, to);
    Space([m2, k2, c2, d, c, q, omega, e, p].map(side).into())
}

/// Rounded to three digits, so that the reported numbers define the scene.
fn numbers(u: &[f64], lossy: bool) -> Numbers {
    let x = space().point(u).into_iter().map(|value| format!("{value:.2e}").parse().unwrap_or(value));
    let x: Vec<f64> = x.collect();
    let e = if lossy { x[7] } else { 1.0 };
    Numbers { m2: x[0], k2: x[1], c2: x[2], d: x[3], c: x[4], q: x[5], omega: x[6], e, p: x[8], ..SSVI }
}

/// The hybrid also counts flight steps, so it has another limit.
fn of(method: Method, contacts: Contacts, tolerance: f64) -> Settings {
    let most = if method == Method::Hybrid { runs::MOST_STEPS } else { MOST_STEPS };
    settings(method, contacts, tolerance, most)
}

/// The loosest tolerance at which a method reaches the level, and the least CPU time of `times` runs, s. A tolerance counts only if the
/// next tighter one also reaches it, which excludes luck.
fn fit(scene: &Scene, reference: f64, (method, contacts): (Method, Contacts), times: u32) -> Option<Fit> {
    let tolerances = if method.has_fixed_step() { vec![3e-3, 1e-3, 3e-4] } else { decades(3, 9) };
    let run = |tolerance| e1_max(scene, WINDOW, &of(method, contacts, tolerance), f64::INFINITY);
    let meets_level =
        |tolerance| run(tolerance).is_ok_and(|found| (found.value / reference - 1.0).abs() <= LEVEL);
    let mut met = None;
    let tolerance = tolerances.into_iter().find_map(|tolerance| {
        let looser = std::mem::replace(&mut met, meets_level(tolerance).then_some(tolerance));
        met.and(looser)
    })?;
    let timed = |_| {
        let begun = ThreadTime::now();
        std::hint::black_box(run(tolerance)).ok();
        begun.elapsed().as_secs_f64()
    };
    Some((of(method, contacts, tolerance), (0..times).map(timed).fold(f64::INFINITY, f64::min)))
}
type Fit = (Settings, f64);

/// The hybrid and the best general method; none if no wall is touched, or if DOP853 does not confirm the hybrid at a tight tolerance, so
/// that the motion cannot be predicted.
fn both(scene: &Scene, times: u32) -> Option<[Fit; 2]> {
    let tight = |method| of(method, Contacts::Located, 1e-12);
    let value = |method| e1_max(scene, WINDOW, &tight(method), f64::INFINITY).ok().map(|found| found.value);
    let touches = touch_downs(scene, WINDOW, &tight(Method::Hybrid)).ok()?;
    let reference = value(Method::Hybrid)?;
    if touches.is_empty() || (value(Method::Dop853)? / reference - 1.0).abs() > 0.01 * LEVEL {
        return None;
    }
    let each =
        |method| ways(method).iter().filter_map(move |way| fit(scene, reference, (method, way.0), times));
    let best = GENERAL.into_iter().flat_map(each).min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some([each(Method::Hybrid).next()?, best])
}

/// Draws scenes without and with loss; a simplex search starts from the worst of each.
pub fn worst(draws: u32) -> Hunt {
    let mut hunt = Hunt::default();
    for lossy in [false, true] {
        climb(draws, lossy, &mut hunt);
    }
    hunt
}

fn climb(draws: u32, lossy: bool, hunt: &mut Hunt) {
    let log_ratio = |u: &[f64]| {
        both(&numbers(u, lossy).scene(), 3).map_or(f64::INFINITY, |both| (both[1].1 / both[0].1).ln())
    };
    let draw = |number| -> Vec<f64> { (0..9).map(|i| sobol_burley::sample(number, i, 1).into()).collect() };
    let mut drawn: Vec<_> =
        (0..draws).into_par_iter().map(|number| (log_ratio(&draw(number)), number)).collect();
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    let compared = drawn.iter().filter(|(log_ratio, _)| log_ratio.is_finite()).count();
    let slower = drawn.iter().filter(|(log_ratio, _)| *log_ratio < 0.0).count();
    let bounds = vec![Bounds { lower: Some(0.0), upper: Some(1.0) }; 9];
    let options = Options { max_fun_evals: Some(MAX_VALUES), bounds, ..Options::default() };
    let best = |&(_, number): &(f64, u32)| {
        let start = draw(number);
        minimize(|u, _| log_ratio(u), &start, options.clone(), |_| ControlFlow::Continue(()))
            .map_or(start, |found| found.x)
    };
    let climbed: Vec<_> = drawn[..CLIMBS.min(compared)].par_iter().map(best).collect();
    let loss = if lossy { "with a restitution" } else { "without loss" };
    hunt.row(format!(
        "\nOf {draws} draws {loss} {compared} touch a wall and can be predicted; the hybrid is slower on {slower}.\n\n{HEAD}"
    ));
    for u in &climbed {
        let numbers = numbers(u, lossy);
        let Some(both) = both(&numbers.scene(), 20) else { continue };
        let [of_hybrid, of_best] = both.each_ref().map(|(settings, seconds)| {
            let setting = settings.step.unwrap_or(settings.rtol);
            format!("{} {} {setting:e} | {:.2}", settings.method.name(), way(settings), 1e3 * seconds)
        });
        let Numbers { m2, k2, c2, d, c, q, omega, e, p, .. } = numbers;
        let damper = format!("{m2} | {k2} | {c2} | {d} | {c} | {q} | {omega} | {e} | {p}");
        hunt.row(format!("| {damper} | {of_hybrid} | {of_best} | {:.2} |", both[0].1 / both[1].1));
    }
}

const HEAD: &str = "| m2 | k2 | c2 | D | C | q | omega | e | P | hybrid | ms | best other | ms | ratio |
| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: | --- | ---: | ---: |";
