//! Recomputes the files of a search: the rows of its grid and its refinements, its band, the design that it found.

use super::band;
use super::log::{OPTIMUM, SEARCHED};
use super::objective::{coarse, objective, searched};
use crate::certify::certify;
use crate::needs::Needs;
use crate::recompute::{Recomputed, Row, Source, design, json};
use crate::summary::Summary;
use crate::{Error, resolved};
use retune_model::{NonNegative, Scene};
use retune_optim::{DesignObjective, Evaluation, Parameter};
use retune_study::{Search, Study};
use serde_json::json;
use std::path::Path;

/// The value of a design of the grid.
pub(super) fn grid(place: &Path, _name: &str) -> Result<Source, Error> {
    let study = study_of(place)?;
    let up_to = study.coarse().up_to();
    values(objective_of(&study, coarse)?, study, up_to)
}

/// The value of a design of a refinement, or of a basin.
pub(super) fn search(place: &Path, _name: &str) -> Result<Source, Error> {
    let study = study_of(place)?;
    values(objective_of(&study, searched)?, study, f64::INFINITY)
}

/// The minimised value, at most `up_to`; empty for a basin whose design breaks a limit.
fn values(objective: DesignObjective, study: Study, up_to: f64) -> Result<Source, Error> {
    Ok(Source::new(move |row: Row| {
        let name = objective.goal().objective.quantity().name();
        let basin = !row.text("basin").is_empty();
        if !(basin && row.text(name).is_empty()) && row.number(name).is_nan() {
            return None;
        }
        let scene = row.design().and_then(|design| study.scene_at(&design));
        let found = scene.and_then(|scene| objective.evaluate(&scene, up_to).ok());
        let value = found.map_or(f64::INFINITY, |found| found.ranked.min(up_to));
        Some(vec![(name.to_owned(), if basin { retune_optim::value_of(value) } else { value })])
    }))
}

/// The curves over the band: without a damper, with the study's damper, with the tuned damper.
pub(super) fn band(place: &Path, _name: &str) -> Result<Source, Error> {
    let study = study_of(place)?;
    let tuned = tuned(place, &study)?;
    Ok(Source::new(move |row: Row| {
        let omega = NonNegative::new(row.number("omega")).ok()?;
        let scenes = band::compared(&study, tuned?);
        let number = |mut scene: Scene| {
            scene.forcing.frequency = omega;
            band::at_own_frequency(&study, scene)
        };
        Some(band::columns(study.quantity()).into_iter().zip(scenes.map(number)).collect())
    }))
}

/// The tuned design, its run, its needs and its certificate.
pub(super) fn optimum(place: &Path, name: &str) -> Result<Recomputed, Error> {
    let study = study_of(place)?;
    let Some(tuned) = tuned(place, &study)? else {
        return Ok(Recomputed::Failed("its design cannot be run".to_owned()));
    };
    let objective = objective_of(&study, objective)?;
    let stored = json(place, name)?;
    let found = match objective.evaluate(&tuned, f64::INFINITY) {
        Err(error) => return Ok(Recomputed::Failed(format!("its design cannot be run: {error}"))),
        Ok(found) => found,
    };
    let mut recomputed = run(&study, &objective, tuned, &found)?;
    if let (Some(_), Ok(search)) = (stored.get("needs"), study.search()) {
        recomputed["needs"] = json!(Needs::new(&study, &search, &tuned, found.value));
    }
    if stored.get("certificate").is_some() {
        let certificate = certify(&Study { scene: tuned, ..study })?;
        recomputed["certificate"] = json!(certificate.short());
    }
    Ok(Recomputed::Part { what: "its design", stored, recomputed })
}

/// The fields of `optimum.json` that follow from the design alone, without its neighbourhood.
fn run(
    study: &Study,
    objective: &DesignObjective,
    tuned: Scene,
    found: &Evaluation,
) -> Result<serde_json::Value, Error> {
    let scene = found.worst_run(tuned, objective.goal());
    let response = retune_solver::simulate(&scene, study.window.window(), &study.solver.settings())?;
    let name = study.quantity().name();
    let mut recomputed = json!({
        name: found.value,
        format!("{name}_none"): study.energy_without_damper(),
        format!("{name}_study"): study.energy(&study.scene),
        "simulation": Summary::new(study, scene, &response) });
    if !objective.goal().limits.is_empty() {
        recomputed["limits"] = json!({ "violation": found.violation, "feasible": found.violation == 0.0 });
        for limit in objective.goal().limits.set() {
            recomputed["limits"][limit.name()] = json!(found.reached.get(limit));
        }
    }
    Ok(recomputed)
}

/// The certificate of the design in `optimum.json`; else of the design in the certificate itself, if there are other files of a search;
/// else of the study's damper.
pub(super) fn certificate(place: &Path, name: &str) -> Result<Recomputed, Error> {
    let study = study_of(place)?;
    let stored = json(place, name)?;
    let scene = if place.join(OPTIMUM).exists() {
        tuned(place, &study)?
    } else if SEARCHED.iter().any(|name| place.join(name).exists()) {
        design(&stored["design"]).and_then(|found| study.scene_at(&found))
    } else {
        Some(study.scene)
    };
    match scene {
        Some(scene) => Ok(crate::certify::recompute(&Study { scene, ..study }, stored)),
        None => Ok(Recomputed::Failed("its design cannot be run".to_owned())),
    }
}

fn study_of(place: &Path) -> Result<Study, Error> {
    Ok(retune_study::read(&place.join(resolved::ONE))?)
}

/// The scene with the tuned design; none without `optimum.json`, or where the design cannot be run.
fn tuned(place: &Path, study: &Study) -> Result<Option<Scene>, Error> {
    if !place.join(OPTIMUM).exists() {
        return Ok(None);
    }
    Ok(design(&json(place, OPTIMUM)?).and_then(|found| study.scene_at(&found)))
}

fn objective_of(
    study: &Study,
    of: fn(&Study, &Search, &[Parameter]) -> DesignObjective,
) -> Result<DesignObjective, Error> {
    Ok(of(study, &study.search().map_err(Error::rule(study))?, &Parameter::VARIED))
}
