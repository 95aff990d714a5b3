//! The best SSVI NES near what is known: good designs of the studies of this repository, in dimensionless form, and the best TMD with its
//! walls within reach. Those that can come near the TMD are told by a few runs each, and descents go on from the best; under a shock or a
//! record, of which there are no derivatives, a simplex does.
//!
//! It is no global search: `retune optimize` of the study that is written makes one. It takes seconds.

use super::candidate::{Candidate, at_few_stiffnesses};
use super::resonance::about_resonance;
use super::settled::{settles_late, settling};
use super::tmd::simplex;
use super::words::sized;
use crate::tune::descent::descend;
use crate::tune::objective::{coarse, kept, loose, searched};
use crate::{Error, Observer, Progress};
use rayon::prelude::*;
use retune_model::{Coupled, Measure, Scene};
use retune_optim::{Bounds, INFEASIBLE, Parameter, Point};
use retune_store::Journal;
use retune_study::{Search, Study};
use std::sync::{Mutex, PoisonError};

/// Good designs, dimensionless: k2/(m2 ω1²); c2/(2 m2 ω1) times √(0.06/μ) of a mass ratio μ; D and C as shares of the stroke of the best TMD. Driven
/// off its resonance, the nearest frequency of the band takes the place of ω1.
/// From `results`: `ssvi`, `ssvi-global`, `ssvi-robust`, `ssvi-loss`, `table2` and the softest of `fronts`, each for μ = 0.06.
const KNOWN: [[f64; 4]; 6] = [
    [0.246, 0.126, 0.106, 4.05],
    [0.246, 0.126, 2.81, 0.101],
    [0.246, 0.129, 0.110, 3.99],
    [0.253, 0.056, 0.060, 4.84],
    [0.094, 0.304, 0.228, 1.37],
    [0.042, 0.321, 1.46, 0.0],
];
const RATIO: f64 = 0.06;
/// The best TMD with both gaps these shares of its stroke.
const NEAR: [f64; 3] = [0.5, 0.75, 0.95];
/// Dashpots and gaps of known designs are tried at these multiples; far from where they are known, as under a small damping, one is much stronger.
const DASHPOTS: [f64; 3] = [0.6, 1.0, 1.7];
const STRONG: f64 = 4.0;
const GAPS: [f64; 3] = [0.4, 1.0, 2.5];
/// A design with this many times the value of the TMD is not worth its runs.
const WORTH: f64 = 4.0;
/// A known design that breaks limits by more than these shares of them in all is too far from any that keeps them: a descent from there takes minutes.
const FAR: f64 = 2.0;
/// Descents: from the best of each of so many families of designs, those that came nearest, and half as many of families far from what is known.
const DESCENTS: usize = 4;
/// Most evaluations of each, so that the answer takes seconds on every machine and the same bytes on each: most need fewer than 60. Runs
/// whose contacts lose energy take several times as long.
const PATIENCE: u64 = 150;
const PATIENCE_WHERE_SLOW: u64 = 60;
/// Tolerance of slow runs, where a gain of 1e-5 is wanted of a step, samples of the band that a search looks at, with the peaks between
/// them, and periods after which it counts at most: what it comes to is measured on all samples of the study, at its tolerance, once it has settled.
const RTOL_WHERE_SLOW: f64 = 1e-7;
const SAMPLES_WHERE_SLOW: usize = 16;
const PASSED_IN_SEARCH: f64 = 300.0;

/// What a search for an SSVI NES comes to.
pub(super) struct Ends {
    /// Its ends, `[k2, c2, D, C]` each with its value, the best first; none where nothing that was tried comes near the TMD.
    pub ends: Vec<(f64, Vec<f64>)>,
    pub tried: usize,
}

/// A start with the number of its family.
type Start = (usize, Vec<f64>);

/// The starts: known designs and the TMD, within the bounds of the search.
fn starts(study: &Study, search: &Search, (tmd, strokes): (&Candidate, &[f64])) -> Vec<Start> {
    let Scene { primary, forcing, .. } = study.scene;
    // Off the resonance it is tuned to where the structure is driven, which is the frequency of the scene.
    let driven = if forcing.is_transient() { primary.natural_frequency() } else { forcing.frequency.get() };
    let (m2, own) = (search.damper.mass.get(), tmd.value(Measure::Stroke));
    let more = (m2 / primary.mass.get() / RATIO).sqrt();
    let near = |share: &f64| (0, [tmd.k2(), tmd.c2(), share * own, share * own]);
    let mut all: Vec<(usize, [f64; 4])> = NEAR.iter().map(near).collect();
    for (number, [k2, c2, d, c]) in KNOWN.into_iter().enumerate() {
        for dashpot in DASHPOTS.into_iter().chain([STRONG]) {
            for (i, stroke) in strokes.iter().enumerate() {
                // Farther from what is known: families of their own.
                let beside = if i > 0 || dashpot == STRONG { KNOWN.len() } else { 0 };
                let c2 = dashpot * c2 * more * 2.0 * m2 * driven;
                let with = |gap: f64| [k2 * m2 * driven * driven, c2, gap * d * stroke, gap * c * stroke];
                all.extend(GAPS.map(|gap| (number + 1 + beside, with(gap))));
            }
        }
    }
    let within = |(family, x): (usize, [f64; 4])| {
        let bounds = search.options.bounds.iter().zip(x);
        let one =
            |(own, x): (&Bounds, f64)| x.clamp(own.lower.unwrap_or(0.0), own.upper.unwrap_or(f64::INFINITY));
        (family, bounds.map(one).collect())
    };
    all.into_iter().map(within).collect()
}

/// Who tells the best so far, by its value as the table has it: runs of a search are looser, and those that tell known designs apart most of
/// all. Descents run side by side, and are told in the order in which they begin: the same lines for any number of threads.
struct Told<'a> {
    bar: Box<dyn Progress + 'a>,
    watch: &'a dyn Observer,
    study: &'a Study,
    /// Whether it is an answer to what was asked, which designs under other limits are not.
    asked: bool,
    ended: Mutex<Ended>,
}

/// What descents have come to.
struct Ended {
    /// By their number; none while one is on its way.
    all: Vec<Option<(f64, Vec<f64>)>>,
    /// How many have been told.
    told: usize,
    best: f64,
}

impl Told<'_> {
    /// A descent has come to this value.
    fn done(&self, number: usize, value: f64, x: &[f64]) -> Result<(), Error> {
        let mut ended = self.ended.lock().unwrap_or_else(PoisonError::into_inner);
        let Ended { all, told, best } = &mut *ended;
        all[number] = Some((value, x.to_vec()));
        let mut written = Ok(());
        while let Some(Some((value, x))) = all.get(*told) {
            *told += 1;
            if *value < *best {
                *best = *value;
                self.bar.best(&sized(*value, self.study.quantity().unit()));
                if self.asked && written.is_ok() {
                    self.bar.aside(&mut || written = self.watch.so_far(&so_far(self.study, *value, x)));
                }
            }
        }
        self.bar.inc(1);
        written
    }
}

/// The best of a stage, for who stops there.
fn so_far(study: &Study, value: f64, x: &[f64]) -> String {
    format!("SSVI NES so far: {}", words(study, value, x))
}

/// A design with its value.
fn words(study: &Study, value: f64, x: &[f64]) -> String {
    let quantity = study.quantity();
    let value = if value < INFEASIBLE {
        format!("{} {}", quantity.name(), sized(value, quantity.unit()))
    } else {
        "breaks a limit".to_owned()
    };
    let one = |(parameter, x): (&Parameter, &f64)| format!("{parameter} = {}", sized(*x, parameter.unit()));
    let design: Vec<String> = Parameter::PAPER.iter().zip(x).map(one).collect();
    format!("{value}, {}", design.join(", "))
}

/// Tells the one that is compared, and why, where it is not the best that was told; beside it the least goal of those that strike.
pub(super) fn tell_compared(
    found: &Ends,
    compared: Option<(&Candidate, f64)>,
    watch: &dyn Observer,
) -> Result<(), Error> {
    let Some((of, least)) = compared.filter(|(of, _)| of.feasible) else { return Ok(()) };
    let x = Parameter::PAPER.map(|parameter| of.damper().map_or(f64::NAN, |damper| parameter.get(&damper)));
    let compared = words(&of.study, of.goal, &x);
    let told = found.ends.first().map(|(value, end)| (words(&of.study, *value, end), end[..] == x));
    let why = match told {
        Some((words, _)) if words == compared => return Ok(()),
        Some((_, true)) => "settled",
        _ if of.goal == least => "the best that strikes its walls",
        _ => "nearly as good, and more certain",
    };
    watch.so_far(&format!("SSVI NES compared ({why}): {compared}"))
}

/// Whether contacts lose energy: runs then take several times as long.
pub(super) fn is_lossy(Scene { primary, forcing, damper }: &Scene) -> bool {
    damper.is_some_and(|damper| Coupled::new(primary, forcing, &damper).is_lossy())
}

/// The study by which a search goes, and whether its runs take several times as long as others: contacts lose energy, or the motion builds up for
/// hundreds of periods.
fn sought(study: &Study, tmd: &Candidate) -> (Study, bool) {
    let with_tmd = &tmd.study.scene;
    let slow = is_lossy(&study.scene) || settles_late(study, with_tmd);
    // Samples of a wide band say nothing of the resonance, at which an SSVI NES does its work.
    let narrow = about_resonance(study);
    let mut sought =
        at_few_stiffnesses(&settling(narrow.as_ref().unwrap_or(study), with_tmd, PASSED_IN_SEARCH));
    let band = sought.optimize.as_mut().and_then(|optimize| optimize.objective.omega.as_mut());
    if let Some(band) = band.filter(|_| slow) {
        band.samples = band.samples.min(SAMPLES_WHERE_SLOW);
    }
    (sought, slow)
}

/// Searches from what is known, its gaps scaled by each of some strokes; `beside` more starts, as the end of a search under other limits.
pub(super) fn best(
    study: &Study,
    (tmd, strokes): (&Candidate, &[f64]),
    beside: &[Vec<f64>],
    (journal, stage): (&Journal, &str),
    watch: &dyn Observer,
) -> Result<Ends, Error> {
    let search = study.search().map_err(Error::rule(study))?;
    debug_assert_eq!(search.variables, Parameter::PAPER);
    let (sought, slow) = sought(study, tmd);
    let objective = if slow {
        let loose = loose(&sought, &search, &search.variables, RTOL_WHERE_SLOW);
        loose.within(PATIENCE_WHERE_SLOW)
    } else {
        searched(&sought, &search, &search.variables).within(PATIENCE)
    };
    let coarse = coarse(&sought, &search, &search.variables);
    // Under other limits it is no answer to what was asked.
    let asked = beside.is_empty();
    let beside: Vec<Start> = beside.iter().cloned().enumerate().collect();
    let starts = if beside.is_empty() { starts(study, &search, (tmd, strokes)) } else { beside };
    let most = if tmd.feasible { WORTH * tmd.goal } else { f64::INFINITY };
    let name = format!("{stage} known");
    let value = kept(&coarse, journal, &name, || ());
    let bar = watch.progress("SSVI NES, known designs", starts.len() as u64);
    let tried = |start: &Start| {
        let value = value(&start.1, most);
        bar.inc(1);
        value
    };
    let values: Vec<f64> = starts.par_iter().map(tried).collect();
    let mut all: Vec<(f64, &Start)> = values.into_iter().zip(&starts).collect();
    bar.finish();
    journal.check()?;
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Of a value of the search that breaks no limit, the one of the table.
    let exactly = |value: f64, x: &[f64]| {
        let exact = || {
            let scene = objective.scene(x).ok()?;
            Candidate::goal_of(&Study { scene, ..study.clone() })
        };
        let of = || exact().unwrap_or(value);
        if value < INFEASIBLE {
            journal.value(&format!("{stage} exactly"), x, f64::INFINITY, of, |_| ())
        } else {
            value
        }
    };
    let mut ends: Vec<(f64, Vec<f64>)> = Vec::new();
    if let Some((_, (_, x))) = all.first().filter(|(value, _)| asked && *value < most) {
        let known = kept(&objective, journal, &format!("{stage} best known"), || ())(x, f64::INFINITY);
        let known = exactly(known, x);
        watch.so_far(&so_far(study, known, x))?;
        ends.push((known, x.clone()));
    }
    // Descents from outside limits are long.
    let descents = if tmd.feasible { DESCENTS } else { DESCENTS / 2 };
    let mut worth: Vec<&Start> = Vec::new();
    let within_reach = most.min(INFEASIBLE * (1.0 + FAR));
    for (_, start) in all.iter().filter(|(value, _)| *value < within_reach) {
        let is_far = |family: usize| family > KNOWN.len();
        let alike = worth.iter().filter(|(family, _)| is_far(*family) == is_far(start.0)).count();
        let room = if is_far(start.0) { descents.div_ceil(2) } else { descents };
        if alike < room && worth.iter().all(|(known, _)| *known != start.0) {
            worth.push(start);
        }
    }
    let known = ends.first().map_or(INFEASIBLE, |(value, _)| *value);
    let bar = watch.progress("SSVI NES", worth.len() as u64);
    if known < INFEASIBLE {
        bar.best(&sized(known, study.quantity().unit()));
    }
    let ended = Ended { all: vec![None; worth.len()], told: 0, best: known.min(INFEASIBLE) };
    let told = Told { bar, watch, study, asked, ended: Mutex::new(ended) };
    let descent = |(number, (_, x)): (usize, &&Start)| {
        let stage = format!("{stage} descent");
        let Point { x, value } = if study.scene.forcing.is_transient() {
            simplex(kept(&objective, journal, &stage, || ()), &search, x)
        } else {
            descend(&objective, &search, x, journal, &stage).end
        };
        let value = exactly(value, &x);
        told.done(number, value, &x).map(|()| (value, x))
    };
    let found: Result<Vec<(f64, Vec<f64>)>, Error> = worth.par_iter().enumerate().map(descent).collect();
    told.bar.finish();
    journal.check()?;
    let known = ends.first().map(|(_, x)| x.clone());
    ends.extend(found?.into_iter().filter(|(_, x)| known.as_ref() != Some(x)));
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let tried = objective.counts().evaluations + coarse.counts().evaluations;
    Ok(Ends { ends, tried: tried as usize })
}
