//! How much more force a damper bears before a motion appears that runs from rest do not lead to.
//!
//! The force is raised in steps until a branch of such motions is found. Each of them vanishes at a fold as the force falls again; the least
//! force of these folds over ω is where the branch is born, as an isola. Just below, the motions are looked for again, for another may be
//! born earlier.

use crate::Error;
use crate::branches::found::{Found, Margin};
use retune_dynamics::periodic::branches::{Control, branches};
use retune_dynamics::periodic::{Branch, Onset, onset};
use retune_model::Parameter;

/// The forces at which motions are looked for, as multiples of the scene's own.
const STEPS: [f64; 10] = [1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0];
/// How far below a birth another is looked for, as a share of the force, and how often.
const BELOW: f64 = 0.995;
const ROUNDS: usize = 4;
/// A branch counts whose largest energy is by this factor above that of all motions that runs from rest lead to.
const NOTABLE: f64 = 1.05;

/// Looks for it. None where the answer is not along ω, or nothing has an amplitude. Where there is such a motion already, nothing above the own force is
/// tried.
///
/// # Errors
/// A scene cannot be run.
pub fn margin(found: &Found) -> Result<Option<Margin>, Error> {
    let plan = found.branches.plan;
    let amplitude = found.study.scene.forcing.amplitude().map(|(amplitude, own)| (amplitude, own.get()));
    let amplitude = amplitude.filter(|(_, own)| *own > 0.0 && plan.parameter == Parameter::Omega);
    let Some((amplitude, own)) = amplitude else { return Ok(None) };
    if others(found).next().is_some() {
        return Ok(Some(Margin { own, birth: None, tried: own }));
    }
    let first_birth = |force: f64| -> Result<Option<Onset>, Error> {
        let scene = amplitude.at(found.study.scene, force).map_err(retune_dynamics::Error::from)?;
        let there = branches(&scene, plan, &found.study.solver.settings(), Control::default())?;
        let there = Found::new(found.study.clone(), there);
        let births =
            others(&there).filter_map(|branch| onset(&branch.seeds(|_| true), amplitude, own, &|_| true));
        Ok(births.min_by(|a, b| a.value.total_cmp(&b.value)))
    };
    for step in STEPS {
        let Some(mut born) = first_birth(step * own)? else { continue };
        for _ in 0..ROUNDS {
            let below = BELOW * born.value;
            match if below > own { first_birth(below)? } else { None } {
                Some(earlier) => born = earlier,
                None => break,
            }
        }
        return Ok(Some(Margin { own, birth: Some(born), tried: step * own }));
    }
    Ok(Some(Margin { own, birth: None, tried: STEPS[STEPS.len() - 1] * own }))
}

/// The branches that no run from rest leads to, with stable motions of much more energy than any on branches that runs from rest do.
fn others(found: &Found) -> impl Iterator<Item = &Branch> {
    let energy = |i: usize| found.largest[i].as_ref().map_or(0.0, |orbit| orbit.seen.e1_max);
    let from_rest = |i: &usize| found.branches.is_reached_from_rest(*i);
    let usual = (0..found.largest.len()).filter(from_rest).map(energy).fold(0.0, f64::max);
    let is_other = move |(i, _): &(usize, &Branch)| !from_rest(i) && energy(*i) > NOTABLE * usual;
    found.branches.branches.iter().enumerate().filter(is_other).map(|(_, branch)| branch)
}

impl Margin {
    /// In words.
    pub fn words(&self) -> String {
        let Self { own, birth, tried } = self;
        match birth {
            None if tried == own => {
                "A motion that no run from rest leads to, with much more energy, is there at the scene's own force already: it has no margin."
                    .to_owned()
            }
            None => format!(
                "No isola was found up to {} times the force, {} N.",
                retune_study::short(tried / own),
                retune_study::short(*tried)
            ),
            Some(Onset { value, omega, orbit }) => format!(
                "Up to {} times the force, {} N, no isola was found; with more, one begins at omega = {} rad/s, {} J ({} \
                 periods, impacts {}).",
                retune_study::rounded(value / own, 6),
                retune_study::rounded(*value, 8),
                retune_study::rounded(*omega, 6),
                retune_study::rounded(orbit.seen.e1_max, 5),
                orbit.periods,
                orbit.seen.impacts
            ),
        }
    }
}
