//! A search for scenes where the hybrid is worst beside general methods.

use crate::decades;
use crate::runs::{way, ways};
use crate::scenes::{Numbers, SSVI};
use cpu_time::ThreadTime;
use rayon::prelude::*;
use retune_jobs::methods::settings;
use retune_model::Scene;
use retune_optim::{Bounds, Options, Side, Space, minimize};
use retune_solver::{Contacts, Method, Settings, Window, e1_max, touch_downs};
use retune_testkit::hunt::Hunt;
use std::ops::ControlFlow;

/// The relative error of E1max that all come to.
const LEVEL: f64 = 1e-6;
const WINDOW: Window = Window { from: 0.0, to: 10.0 };
/// Those of explicit methods that were the best on some scene of `just lab accuracy`.
const GENERAL: [Method; 3] = [Method::Dop853, Method::Ode45, Method::Rk4];
/// With more of them they would be slower than the hybrid by far.
const MOST_STEPS: u64 = 30_000;
/// Scenes that are followed and told, and the values of each simplex.
const KEPT: usize = 2;
const VALUES: u64 = 60;

/// An engineer's dampers and forces, with contacts a hundredth to a hundred times as stiff as the paper's.
fn space() -> Space {
    let [m2, k2, c2] = [(10.0, 200.0), (50.0, 1e5), (5.0, 5000.0)];
    let [d, c, q] = [(0.0, 0.2), (0.01, 1.0), (0.01 * SSVI.q, 100.0 * SSVI.q)];
    let [omega, e, p] = [(4.0, 9.0), (0.3, 0.99), (300.0, 6000.0)];
    let side = |(from, to)| Side::natural(from, to);
    Space([m2, k2, c2, d, c, q, omega, e, p].map(side).into())
}

/// In three digits, so that what is told is the scene.
fn numbers(u: &[f64], lossy: bool) -> Numbers {
    let x = space().point(u).into_iter().map(|value| format!("{value:.2e}").parse().unwrap_or(value));
    let x: Vec<f64> = x.collect();
    let e = if lossy { x[7] } else { 1.0 };
    Numbers { m2: x[0], k2: x[1], c2: x[2], d: x[3], c: x[4], q: x[5], omega: x[6], e, p: x[8], ..SSVI }
}

/// A method with the loosest tolerance at which it comes to the level, and the least processor time of some runs, s.
struct Fit {
    settings: Settings,
    seconds: f64,
}

/// None where no tolerance serves. One that does by luck, while the next tighter one does not, serves not.
fn fit(scene: &Scene, reference: f64, method: Method, contacts: Contacts, times: u32) -> Option<Fit> {
    let tolerances = if method.has_fixed_step() { vec![3e-3, 1e-3, 3e-4] } else { decades(3, 9) };
    let run = |settings: &Settings| e1_max(scene, WINDOW, settings, f64::INFINITY);
    let serves = |tolerance: &f64| {
        let found = run(&settings(method, contacts, *tolerance, MOST_STEPS));
        found.is_ok_and(|found| (found.value / reference - 1.0).abs() <= LEVEL)
    };
    let mut last = tolerances.iter().map(|tolerance| (*tolerance, serves(tolerance)));
    let mut loose = last.next()?;
    let tolerance = last.find_map(|tight| {
        let found = (loose.1 && tight.1).then_some(loose.0);
        loose = tight;
        found
    })?;
    let settings = settings(method, contacts, tolerance, MOST_STEPS);
    let timed = |_| {
        let begun = ThreadTime::now();
        std::hint::black_box(run(&settings)).ok();
        begun.elapsed().as_secs_f64()
    };
    Some(Fit { settings, seconds: (0..times).map(timed).fold(f64::INFINITY, f64::min) })
}

/// The hybrid and the best of the general methods; none where no wall is touched, or where DOP853 does not confirm the hybrid at a tight tolerance: there
/// the motion cannot be predicted.
fn both(scene: &Scene, times: u32) -> Option<[Fit; 2]> {
    let tight = |method| settings(method, Contacts::Located, 1e-12, MOST_STEPS);
    let value = |method| e1_max(scene, WINDOW, &tight(method), f64::INFINITY).ok().map(|found| found.value);
    if touch_downs(scene, WINDOW, &tight(Method::Hybrid)).ok()?.is_empty() {
        return None;
    }
    let reference = value(Method::Hybrid)?;
    let confirmed = (value(Method::Dop853)? / reference - 1.0).abs() < 0.01 * LEVEL;
    let general = GENERAL.into_iter().filter(|_| confirmed);
    let fits = general.flat_map(|method| ways(method).iter().map(move |(contacts, _)| (method, *contacts)));
    let fits = fits.filter_map(|(method, contacts)| fit(scene, reference, method, contacts, times));
    let best = fits.min_by(|a, b| a.seconds.total_cmp(&b.seconds))?;
    Some([fit(scene, reference, Method::Hybrid, Contacts::Located, times)?, best])
}

/// How many times as long as the best of the others the hybrid takes.
fn ratio([hybrid, best]: &[Fit; 2]) -> f64 {
    hybrid.seconds / best.seconds
}

/// Random draws without loss and with it, from the worst of which a simplex climbs.
pub fn worst(draws: u32) -> Hunt {
    let mut hunt = Hunt::default();
    for lossy in [false, true] {
        climb(draws, lossy, &mut hunt);
    }
    hunt
}

fn climb(draws: u32, lossy: bool, hunt: &mut Hunt) {
    let rated =
        |u: &[f64]| both(&numbers(u, lossy).scene(), 3).map_or(f64::INFINITY, |both| -ratio(&both).ln());
    let draw = |number| -> Vec<f64> { (0..9).map(|i| sobol_burley::sample(number, i, 1).into()).collect() };
    let mut drawn: Vec<_> = (0..draws).into_par_iter().map(|number| (rated(&draw(number)), number)).collect();
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    let compared = drawn.iter().filter(|(rated, _)| rated.is_finite()).count();
    let slower = drawn.iter().filter(|(rated, _)| *rated < 0.0).count();
    let bounds = vec![Bounds { lower: Some(0.0), upper: Some(1.0) }; 9];
    let options = Options { max_fun_evals: Some(VALUES), bounds, ..Options::default() };
    let best = |&(_, number): &(f64, u32)| {
        let start = draw(number);
        minimize(|u, _| rated(u), &start, options.clone(), |_| ControlFlow::Continue(()))
            .map_or(start, |found| found.x)
    };
    let climbed: Vec<_> = drawn[..KEPT.min(compared)].par_iter().map(best).collect();
    let loss = if lossy { "with a restitution" } else { "without loss" };
    hunt.row(format!(
        "\nOf {draws} draws {loss} {compared} touch a wall and can be predicted; the hybrid is slower on {slower}.\n\n{HEAD}"
    ));
    for u in &climbed {
        let numbers = numbers(u, lossy);
        let Some(both) = both(&numbers.scene(), 20) else { continue };
        let [of_hybrid, of_best] = both.each_ref().map(|Fit { settings, seconds }| {
            let setting = settings.step.unwrap_or(settings.rtol);
            format!("{} {} {setting:e} | {:.2}", settings.method.name(), way(settings), 1e3 * seconds)
        });
        let Numbers { m2, k2, c2, d, c, q, omega, e, p, .. } = numbers;
        let damper = format!("{m2} | {k2} | {c2} | {d} | {c} | {q} | {omega} | {e} | {p}");
        hunt.row(format!("| {damper} | {of_hybrid} | {of_best} | {:.2} |", ratio(&both)));
    }
}

const HEAD: &str = "| m2 | k2 | c2 | D | C | q | omega | e | P | hybrid | ms | best other | ms | ratio |
| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: | --- | ---: | ---: |";
