//! The motions that runs from many starts settle on.

use super::forced::Forced;
use super::seen::{Seen, seen};
use super::shooting::{Shooting, Solution};
use crate::parameter::{Error, evenly};
use crate::poincare::PoincareMap;
use crate::record::{coordinates, distance};
use nalgebra::DVector;
use retune_model::{Bare, Coupled, Parameter, Scene, Side};
use retune_solver::observe::Unobserved;
use retune_solver::{Motion, Phase, Settings};
use std::cell::OnceCell;
use std::f64::consts::TAU;

/// Periods of the force after which a run is checked for repetition; one that has not settled by the last is irregular.
pub(super) const CHECKS: [usize; 4] = [60, 120, 240, 480];
/// Periods of the force at resonance that limit the energy taken as reachable.
const AT_RESONANCE: f64 = 60.0;
/// Number of values at which the reachable energy is evaluated.
const REACHED: usize = 129;
/// Points of a Sobol sequence.
const LENGTH: usize = 1 << 16;
/// Most periods after which a motion may repeat.
pub const MOST_PERIODS: usize = 12;
/// A run that repeats to this share of its size is near enough for Newton's iteration.
pub(super) const NEAR: f64 = 1e-4;
/// Two motions nearer than this share of their size are the same.
pub(super) const SAME: f64 = 1e-6;
/// Periods over which an irregular motion's largest values are taken.
const WATCHED: usize = 100;

/// The motion that a run settles on.
#[derive(Clone, Debug)]
pub enum Settled {
    /// A stable periodic motion.
    On(usize, Solution),
    /// None was found: the largest values over its last periods.
    Irregular(Seen),
}

/// Follows a run from a state at a crest of the force.
///
/// # Errors
/// The run cannot be finished.
pub fn settle(shooting: &Shooting, value: f64, y: [f64; 4]) -> Result<Settled, Error> {
    let scene = shooting.scene_at(value)?;
    let system = shooting.system(value)?;
    let mut map = PoincareMap::new(&system, &Settings { rtol: 1e-10, ..*shooting.settings() });
    let mut motion = Motion { t: 0.0, y, phase: Phase::of(&system, &y) };
    let mut taken = 0;
    for check in CHECKS {
        let mut last = Vec::new();
        while taken < check {
            motion = map.next(motion, &mut Unobserved)?;
            taken += 1;
            if taken + MOST_PERIODS >= check {
                last.push(motion.y);
            }
        }
        if let Some((periods, solution)) = repeated(shooting, &scene, value, &last) {
            return Ok(Settled::On(periods, solution));
        }
    }
    Ok(Settled::Irregular(seen(&scene, shooting.settings(), WATCHED, &[motion.y])?))
}

/// The periodic motion that the run of a scene from its start settles on: after how many periods of the force it repeats, and its state at a
/// crest of the force; none if it settles on none.
///
/// # Errors
/// The run cannot be finished.
pub fn settled(scene: &Scene, settings: &Settings) -> Result<Option<(usize, [f64; 4])>, Error> {
    let omega = scene.forcing.frequency.get();
    let size = (2.0 * most_energy(scene)).sqrt().max(f64::MIN_POSITIVE);
    let shooting = Shooting::new(*scene, Parameter::Omega, 1, (omega, size), settings);
    let start = shooting.system(omega)?.start();
    Ok(match settle(&shooting, omega, start)? {
        Settled::Irregular(_) => None,
        Settled::On(periods, solution) => {
            shooting.of_periods(periods).states(&solution.x).first().map(|state| (periods, *state))
        }
    })
}

/// The stable motion that the latest states of a run repeat, by the least number of periods.
fn repeated(shooting: &Shooting, scene: &Scene, value: f64, last: &[[f64; 4]]) -> Option<(usize, Solution)> {
    let end = last.len().checked_sub(1)?;
    let at = |i: usize| coordinates(scene, &last[i]);
    let size = distance(&at(end), &[0.0; 4]).max(f64::MIN_POSITIVE);
    // A damper without a spring has a tiny one here and comes to rest in the middle, but not within a run.
    let afloat = OnceCell::new();
    let is_afloat =
        || *afloat.get_or_init(|| shooting.is_floating && touches_nothing(shooting, scene, &last[end]));
    let rest = scene.damper.map_or(0.0, |damper| damper.rest_distance.get());
    for periods in 1..=MOST_PERIODS.min(end) {
        if distance(&at(end), &at(end - periods)) > NEAR * size {
            continue;
        }
        let equations = shooting.of_periods(periods);
        let mut states = last[end - periods + 1..].to_vec();
        if is_afloat() {
            states.iter_mut().for_each(|y| y[2] = y[0] + rest);
        }
        let start = equations.unknowns(&states, value);
        let Some(solution) = equations.correct_at_value(&start) else { continue };
        let multipliers = super::orbit::multipliers(&solution.at.monodromy());
        let moved = equations.norm(&(&solution.x - &start));
        if multipliers[0].norm() < 1.0 && (moved < 100.0 * NEAR || is_afloat()) {
            return shortest(&equations, solution);
        }
    }
    None
}

/// Whether a run touches no wall over a period from a state on.
fn touches_nothing(shooting: &Shooting, scene: &Scene, y: &[f64; 4]) -> bool {
    seen(scene, shooting.settings(), 1, &[*y]).is_ok_and(|seen| seen.impacts.is_empty())
}

/// Whether two motions are the same, whatever crest of the force each begins at.
pub fn is_same(shooting: &Shooting, a: &Solution, b: &Solution) -> bool {
    a.x.len() == b.x.len() && shooting.nearest(&a.x, &b.x).1 < SAME
}

/// The least number of periods after which a motion repeats.
pub(super) fn least_periods(shooting: &Shooting<impl Forced>, x: &DVector<f64>) -> usize {
    let (n, share) = (shooting.periods, shooting.segments / shooting.periods);
    let repeats = |periods: &usize| (shooting.shifted(x, periods * share) - x).amax() < SAME;
    let mut shares = (1..n).filter(|periods| n.is_multiple_of(*periods));
    if n * share == shooting.segments { shares.find(repeats).unwrap_or(n) } else { n }
}

/// A motion reduced to the least number of periods after which it repeats.
fn shortest(shooting: &Shooting, solution: Solution) -> Option<(usize, Solution)> {
    let periods = least_periods(shooting, &solution.x);
    if periods == shooting.periods {
        return Some((periods, solution));
    }
    let equations = shooting.of_periods(periods);
    let start = equations.unknowns(&shooting.states(&solution.x)[..periods], shooting.value(&solution.x));
    Some((periods, equations.correct_at_value(&start)?))
}

/// The energy that the structure reaches without damper, J: the lesser of that of its steady motion and that reached at resonance from rest
/// in [`AT_RESONANCE`] periods. Without damping there is no steady motion at resonance.
pub(super) fn most_energy(scene: &Scene) -> f64 {
    let bare = Bare::new(&scene.primary, &scene.forcing);
    let omega = bare.frequency();
    bare.steady(omega).e1_max.min(bare.resonant_energy(AT_RESONANCE * TAU / omega))
}

/// Starts of runs: states that the force can bring the structure to without damper, at values in a range of a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Starts {
    /// The largest speed of the structure there, m/s.
    pub reach: f64,
    range: [f64; 2],
}

impl Starts {
    /// Over a range of a parameter.
    ///
    /// # Errors
    /// A value in the range is out of the parameter's.
    pub fn over(scene: &Scene, parameter: Parameter, range: [f64; 2]) -> Result<Self, Error> {
        let [from, to] = range;
        let natural = scene.primary.natural_frequency();
        let resonance = match parameter {
            Parameter::Omega => natural,
            Parameter::K1 => scene.primary.mass.get() * scene.forcing.frequency.get().powi(2),
            _ => from,
        };
        let mut most = 0.0;
        for value in evenly(from, to, REACHED).into_iter().chain([resonance.clamp(from, to)]) {
            most = f64::max(most, most_energy(&parameter.at(*scene, value)?));
        }
        Ok(Self { reach: (2.0 * most / scene.primary.mass.get()).sqrt(), range })
    }

    /// The value of the parameter of a start: a Sobol sequence covers values and states at once.
    pub fn value(&self, number: usize) -> f64 {
        let [from, to] = self.range;
        from + (to - from) * sobol(number, 0)
    }

    /// The state of a start: the structure within its reach, the damper between its walls.
    pub fn state(&self, number: usize, system: &Coupled) -> [f64; 4] {
        let (reach, omega) = (self.reach, system.bare().frequency());
        let [near, far] = [system.wall(Side::Primary), system.wall(Side::Obstacle)];
        let (near, far) = if system.has_walls() {
            (near, far.min(near + 10.0 * reach / omega))
        } else {
            (system.rest_distance() - 3.0 * reach / omega, system.rest_distance() + 3.0 * reach / omega)
        };
        let signed = |dimension: u32| 2.0 * sobol(number, dimension) - 1.0;
        let x1 = reach / omega * signed(1);
        [x1, reach * signed(2), x1 + near + (far - near) * sobol(number, 3), 2.0 * reach * signed(4)]
    }
}

/// A coordinate of a point of a Sobol sequence; each sequence has [`LENGTH`] points.
fn sobol(number: usize, dimension: u32) -> f64 {
    f64::from(sobol_burley::sample((number % LENGTH) as u32, dimension, 1 + (number / LENGTH) as u32))
}
