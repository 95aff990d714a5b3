//! A hunt for missed largest values over practical ranges: compares the search by bounds with a dense search of the same motion, and the
//! hybrid with DOP853.

use super::Hunt;
use super::draws::{ANYWHERE, DENSE, Draw, HELD, LOSSY, Scenes, drawn, under_history};
use rayon::prelude::*;
use retune_model::{Coupled, Scene, Side};
use retune_solver::observe::{
    ContactForces, DamperEnergy, Knot, Magnitude, Observer, PrimaryEnergy, Quantity, RelativePosition,
    RunningMaximum, Segment, StructureMotion, Unobserved, WallForce,
};
use retune_solver::{Hybrid, Method, Motion, Phase, Response, Settings, SolverError, Window, simulate};

/// The largest value by a dense search: many samples in each segment, and every sign change of the slope between them.
struct DenseSearch<Q> {
    quantity: Q,
    samples: usize,
    largest: f64,
}

impl<Q: Quantity<4>> DenseSearch<Q> {
    fn new(quantity: Q) -> Self {
        Self { quantity, samples: 24, largest: f64::NEG_INFINITY }
    }
    fn slope(&mut self, knot: &Knot<4>) -> f64 {
        let [value, slope, _] = self.quantity.rates(knot.excitation, &knot.y);
        self.largest = self.largest.max(value);
        slope
    }
}

impl<Q: Quantity<4>> Observer<4> for DenseSearch<Q> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let (h, [first, last]) = (segment.length(), segment.ends());
        // Segments in contact are a ninth of a contact, or less.
        let samples = if first.clock == [1.0, 0.0] { self.samples } else { self.samples / 3 };
        let mut before = (0.0, self.slope(first));
        for sample in 1..=samples {
            let theta = h * sample as f64 / samples as f64;
            let slope = if sample == samples { self.slope(last) } else { self.slope(&segment.at(theta)) };
            if before.1 > 0.0 && slope < 0.0 {
                let (mut low, mut high) = (before.0, theta);
                for _ in 0..30 {
                    let middle = 0.5 * (low + high);
                    if self.slope(&segment.at(middle)) > 0.0 { low = middle } else { high = middle }
                }
            }
            before = (theta, slope);
        }
    }
}

/// The most that a search may miss, relative to the largest value: the error of the contacts in a run at rtol 1e-6. If the value itself is
/// less exact, as with a strong dashpot, so are the samples inside a step: then a tenth of its change at a tenth of the tolerance is
/// allowed, but at most [`INEXACT`], since in chaos it changes by any amount.
const ALLOWED: f64 = 1e-9;
const INEXACT: f64 = 1e-8;

/// The search under test and a dense search.
type Pair<Q> = (RunningMaximum<Q>, DenseSearch<Q>);

fn pair<Q: Quantity<4>>(quantity: impl Fn() -> Q) -> Pair<Q> {
    (RunningMaximum::new(quantity(), f64::INFINITY), DenseSearch::new(quantity()))
}

/// What the search missed and what its bounds left undecided, both relative to the largest value, and the largest value.
type Missed = [f64; 3];

fn missed<Q: Quantity<4>>((search, dense): &Pair<Q>, size: f64) -> Missed {
    relative(dense.largest - search.record().value, search.doubt(), size)
}

/// Like [`Pair`], for a magnitude: one search for both signs, and a dense search for each.
type Sizes<'a> =
    (Magnitude<StructureMotion<'a, Coupled, 4>>, [DenseSearch<StructureMotion<'a, Coupled, 4>>; 2]);

fn sizes<'a>(
    system: &'a Coupled,
    quantity: fn(&'a Coupled, f64) -> StructureMotion<'a, Coupled, 4>,
) -> Sizes<'a> {
    let quantity = |sign: f64| quantity(system, sign);
    (Magnitude::new(quantity, f64::INFINITY), [1.0, -1.0].map(|sign| DenseSearch::new(quantity(sign))))
}

fn missed_size((search, dense): &Sizes<'_>) -> Missed {
    let largest = dense[0].largest.max(dense[1].largest);
    relative(largest - search.record().value, search.doubt(), largest)
}

fn relative(missed: f64, doubt: f64, size: f64) -> Missed {
    let [missed, doubt] = [missed, doubt].map(|share| if share <= 0.0 { 0.0 } else { share / size });
    [missed, doubt, size]
}

/// Counts the segments in contact.
#[derive(Default)]
struct ContactPieces(u64);

impl Observer<4> for ContactPieces {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        self.0 += u64::from(segment.ends()[0].clock != [1.0, 0.0]);
    }
}

/// What the search missed in a scene: E1, E2, both extremes of the relative displacement, the magnitudes of x1, v1, a1 and the force on the
/// ground, and the forces of walls that lose energy; and the number of segments in contact.
fn search(scene: &Scene, from: f64, rtol: f64) -> Result<([Missed; 10], u64), SolverError> {
    let damper = scene.damper.as_ref().expect("a damper");
    let system = Coupled::new(&scene.primary, &scene.forcing, damper);
    let energies = (pair(|| PrimaryEnergy::new(&system)), pair(|| DamperEnergy::new(&system)));
    let sides = [1.0, -1.0].map(|sign| pair(|| RelativePosition::new(&system, sign)));
    let structure = [
        sizes(&system, StructureMotion::displacement),
        sizes(&system, StructureMotion::velocity),
        sizes(&system, StructureMotion::acceleration),
        sizes(&system, StructureMotion::ground_force),
    ];
    // Without loss, contact forces follow from the relative displacement.
    let dense = || Side::BOTH.map(|side| DenseSearch::new(WallForce::new(&system, side)));
    let forces = ContactForces::of(&system).map(|forces| (forces, dense()));
    let mut all = (energies, ((sides, forces), (ContactPieces::default(), structure)));
    let mut hybrid = Hybrid::new(&system, rtol, 20.0, 20_000_000);
    let rest = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    let middle = if from > 0.0 { hybrid.propagate(rest, from, &mut Unobserved)? } else { rest };
    hybrid.propagate(middle, 20.0, &mut all)?;
    let ((e1, e2), (([far, near], forces), (ContactPieces(pieces), structure))) = all;
    let reach = far.1.largest.abs().max(near.1.largest.abs());
    let [x1, v1, a1, ground] = structure.each_ref().map(missed_size);
    let [e1, e2] = [missed(&e1, e1.1.largest), missed(&e2, e2.1.largest)];
    let [on_primary, on_obstacle] = forces.map_or([[0.0; 3]; 2], |(found, dense)| {
        let most = dense[0].largest.max(dense[1].largest).max(1.0);
        let missed = |side: usize| dense[side].largest - found.records()[side].value.max(0.0);
        [0, 1].map(|side| relative(missed(side), found.doubt(), most))
    });
    let [far, near] = [missed(&far, reach), missed(&near, reach)];
    Ok(([e1, e2, far, near, x1, v1, a1, ground, on_primary, on_obstacle], pieces))
}

/// What a search may miss of each quantity of a scene.
fn allowed(&(scene, from, rtol): &(Scene, f64, f64), missed: &[Missed; 10]) -> [f64; 10] {
    let near = |[missed, ..]: &Missed| *missed > ALLOWED;
    let tighter = missed.iter().any(near).then(|| search(&scene, from, 0.1 * rtol)).and_then(Result::ok);
    std::array::from_fn(|i| {
        let own = tighter.map_or(0.0, |(exact, _)| apart(exact[i][2], missed[i][2], exact[i][2]));
        ALLOWED.max((0.1 * own).min(INEXACT))
    })
}

/// A difference relative to a size; infinite instead of NaN.
fn apart(a: f64, b: f64, size: f64) -> f64 {
    let difference = ((a - b) / size).abs();
    if a == b {
        0.0
    } else if difference.is_nan() {
        f64::INFINITY
    } else {
        difference
    }
}

/// Runs a scene by a method at a relative tolerance; the absolute tolerance is a thousandth of it times `size`.
fn run(
    scene: &Scene,
    window: Window,
    (method, rtol, size): (Method, f64, f64),
) -> Result<Response, SolverError> {
    let atol = 1e-3 * rtol * size;
    simulate(scene, window, &Settings { method, rtol, atol, max_steps: 20_000_000, ..Settings::default() })
}

/// Below this displacement (m) of the structure, the absolute tolerances scale with the motion.
const SMALL: f64 = 5e-3;

/// The differences between the hybrid and DOP853 over 20 s, by quantity; `None` if their final states diverge, so that the motion cannot be
/// predicted that far, or if one of them gives up. If they differ, DOP853 runs again at tolerances ten and a hundred times as tight: after
/// tens of contacts its own error may show. Twice the difference of these two runs, at most [`MAX_REFERENCE_ERROR`], is subtracted.
fn compare(scene: &Scene, from: f64) -> Option<([f64; 11], Response)> {
    let window = Window { from, to: 20.0 };
    let hybrid = match run(scene, window, (Method::Hybrid, 1e-12, 1.0)) {
        Ok(found) => found,
        Err(SolverError::TooManySteps { .. } | SolverError::TooSlow { .. }) => return None,
        Err(error) => panic!("{error}: {scene:?}"),
    };
    let size = (hybrid.structure.displacement.value / SMALL).min(1.0);
    let reference = |rtol| run(scene, window, (Method::Dop853, rtol, size)).ok();
    let first = reference(1e-12)?;
    let apart = |i: usize| apart(hybrid.final_state[i], first.final_state[i], size);
    if (0..4).any(|i| apart(i) > 1e-10) {
        return None;
    }
    let mut found = differences(&hybrid, &first);
    if found.iter().any(|d| *d > TOLERANCE) {
        let [near, nearest] = [reference(1e-13)?, reference(1e-14)?];
        let own = differences(&near, &nearest);
        found = differences(&hybrid, &nearest);
        found.iter_mut().zip(own).for_each(|(found, own)| *found -= 2.0 * own.min(MAX_REFERENCE_ERROR));
    }
    Some((found, hybrid))
}

/// Largest difference of two runs of DOP853 that counts as its own error.
const MAX_REFERENCE_ERROR: f64 = 1e-7;

/// Largest difference allowed between the hybrid and DOP853.
const TOLERANCE: f64 = 1e-9;

fn differences(a: &Response, b: &Response) -> [f64; 11] {
    let force = b.force_max[0].max(b.force_max[1]).max(1.0);
    let stroke = b.spring_deflection_max;
    let late = apart(a.e1_max.time, b.e1_max.time, 1.0);
    let structure =
        |i: usize| apart(a.structure.all()[i].value, b.structure.all()[i].value, b.structure.all()[i].value);
    // The time of the maximum is undetermined if two maxima are equally high, or one is flat.
    let ignores_time = apart(a.e1_max.value, b.e1_max.value, b.e1_max.value) < 1e-13 || late < 1e-4;
    [
        apart(a.e1_max.value, b.e1_max.value, b.e1_max.value),
        apart(a.e2_max.value, b.e2_max.value, b.e2_max.value),
        apart(a.relative_displacement_max, b.relative_displacement_max, stroke),
        apart(a.spring_deflection_max, b.spring_deflection_max, stroke),
        apart(a.force_max[0], b.force_max[0], force).max(apart(a.force_max[1], b.force_max[1], force)),
        f64::from(u8::from(a.impacts != b.impacts)),
        if ignores_time { 0.0 } else { late },
        structure(0),
        structure(1),
        structure(2),
        structure(3),
    ]
}

/// Compares the search with a dense search on `count` scenes.
pub fn beside_everywhere(scenes: Scenes, count: u64) -> Hunt {
    let (what, scene): (_, Draw) = match scenes {
        Scenes::Any => ("search beside a look everywhere, any scene", ANYWHERE),
        Scenes::TwoMaxima => ("the same where two maxima in a step are common", DENSE),
        Scenes::Lossy => ("the same where contacts lose energy", LOSSY),
        Scenes::Held => ("the same where a stiff spring holds the damper to a wall", HELD),
        Scenes::Histories => ("the same under pulses and records", under_history),
    };
    let searched: Vec<_> = (0..count)
        .into_par_iter()
        .map(|number| {
            let (scene, from, rtol) = drawn(number, scene);
            (number, search(&scene, from, rtol))
        })
        .collect();
    let (mut pieces, mut contact_scenes, mut faults, mut undecided, mut long) = (0, 0, Vec::new(), 0, 0);
    for (number, found) in searched {
        let (missed, seen) = match found {
            Ok(found) => found,
            // The dense search also counts towards the limit on work.
            Err(SolverError::TooManySteps { .. } | SolverError::TooSlow { .. }) => {
                long += 1;
                continue;
            }
            Err(error) => panic!("{what} {number}: {error}"),
        };
        pieces += seen;
        contact_scenes += u64::from(seen > 0);
        let allowed = allowed(&drawn(number, scene), &missed);
        let beyond = |part: usize| {
            missed.iter().zip(allowed).any(|(missed, allowed)| {
                let allowed = if part == 0 { allowed } else { ALLOWED };
                missed[part].is_nan() || missed[part] > allowed
            })
        };
        // A loss factor that depends on the speed may change too fast for the bounds where the speed vanishes: the value is then right but
        // not proven.
        if matches!(scenes, Scenes::Lossy | Scenes::Held) && beyond(1) && !beyond(0) {
            undecided += 1;
        } else if beyond(0) || beyond(1) {
            faults.push(format!("{number} {missed:?} {:?}", drawn(number, scene)));
        }
    }
    let mut hunt = Hunt::default();
    hunt.row(format!(
        "| {what} | {}{count} | {contact_scenes} | {pieces} pieces of contacts | 1e-9 | {}{} |",
        if long > 0 { format!("{} of ", count - long) } else { String::new() },
        faults.len(),
        if undecided > 0 { format!("; {undecided} not proven") } else { String::new() }
    ));
    hunt.faults = faults;
    hunt.check(long <= count / 50, || format!("{long} of {count} scenes are beyond their limit on steps"));
    hunt.check(undecided <= count / 50, || format!("{undecided} of {count} scenes are not proven"));
    hunt.check(contact_scenes > count / 4, || format!("{contact_scenes} of {count} scenes have contacts"));
    hunt
}

/// Compares the hybrid with DOP853 on `count` scenes.
pub fn beside_dop853(scenes: Scenes, count: u64) -> Hunt {
    let (what, scene): (_, fn(u64) -> Draw) = match scenes {
        // One scene in three is of the kind with often two maxima in a step.
        Scenes::Any => ("hybrid beside DOP853", |number| if number % 3 == 0 { DENSE } else { ANYWHERE }),
        Scenes::TwoMaxima => ("the same where two maxima in a step are common", |_| DENSE),
        Scenes::Lossy => ("the same where contacts lose energy", |_| LOSSY),
        Scenes::Held => ("the same where a stiff spring holds the damper to a wall", |_| HELD),
        Scenes::Histories => ("the same under pulses and records", |_| under_history),
    };
    let compared: Vec<_> = (0..count)
        .into_par_iter()
        .filter_map(|number| {
            let (scene, from, _) = drawn(number, scene(number));
            let (differences, run) = compare(&scene, from)?;
            Some((number, differences, run.impacts[0] + run.impacts[1]))
        })
        .collect();
    let contact_scenes = compared.iter().filter(|(_, _, impacts)| *impacts > 0).count();
    let impacts: u64 = compared.iter().map(|(_, _, impacts)| impacts).sum();
    let faults: Vec<_> =
        compared.iter().filter(|(_, found, _)| found.iter().any(|d| *d > TOLERANCE)).collect();
    let mut hunt = Hunt::default();
    hunt.row(format!(
        "| {what}, the motion predictable | {} of {count} | {contact_scenes} | {impacts} impacts | 1e-9 | {} |",
        compared.len(),
        faults.len()
    ));
    let words = |(number, differences, _): &&(u64, _, _)| {
        format!("{number} {differences:?} {:?}", drawn(*number, scene(*number)).0)
    };
    hunt.faults = faults.iter().map(words).collect();
    hunt.check(contact_scenes as u64 > count / 5, || {
        format!("{contact_scenes} of {count} scenes have contacts")
    });
    hunt
}

/// What the search missed or left undecided in scene `number` of [`Scenes::Any`], and the most that is allowed.
pub fn missed_in(number: u64) -> ([f64; 10], f64) {
    let (scene, from, rtol) = drawn(number, ANYWHERE);
    let (missed, _) = search(&scene, from, rtol).expect("a run");
    (missed.map(|[missed, doubt, _]| missed.max(doubt)), ALLOWED)
}
