//! The files of a search, computed again: the rows of its grid and its refinements, its band, the design that it found.

use super::band;
use super::log::{OPTIMUM, SEARCHED};
use super::objective::{coarse, objective, searched};
use crate::again::{Made, Row, Source, design, json};
use crate::certify::certify;
use crate::needs::Needs;
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

/// The minimised value, `up_to` if it is above that; of a basin nothing where its design breaks a limit.
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

/// The curves over the band: without damper, with that of the study, with the best.
pub(super) fn band(place: &Path, _name: &str) -> Result<Source, Error> {
    let study = study_of(place)?;
    let tuned = tuned(place, &study)?;
    Ok(Source::new(move |row: Row| {
        let omega = NonNegative::new(row.number("omega")).ok()?;
        let scenes = band::compared(&study, tuned?);
        let number = |mut scene: Scene| {
            scene.forcing.frequency = omega;
            band::at_its_own(&study, scene)
        };
        Some(band::columns(study.quantity()).into_iter().zip(scenes.map(number)).collect())
    }))
}

/// The design that was found, its run, what it needs, its certificate.
pub(super) fn optimum(place: &Path, name: &str) -> Result<Made, Error> {
    let study = study_of(place)?;
    let Some(tuned) = tuned(place, &study)? else {
        return Ok(Made::Not("its design cannot be run".to_owned()));
    };
    let objective = objective_of(&study, objective)?;
    let said = json(place, name)?;
    let found = match objective.evaluate(&tuned, f64::INFINITY) {
        Err(error) => return Ok(Made::Not(format!("its design cannot be run: {error}"))),
        Ok(found) => found,
    };
    let mut again = run(&study, &objective, tuned, &found)?;
    if let (Some(_), Ok(search)) = (said.get("needs"), study.search()) {
        again["needs"] = json!(Needs::new(&study, &search, &tuned, found.value));
    }
    if said.get("certificate").is_some() {
        let certificate = certify(&Study { scene: tuned, ..study })?;
        again["certificate"] = json!(certificate.short());
    }
    Ok(Made::Of { what: "its design", said, again })
}

/// What `optimum.json` says of its design without a look around it.
fn run(
    study: &Study,
    objective: &DesignObjective,
    tuned: Scene,
    found: &Evaluation,
) -> Result<serde_json::Value, Error> {
    let scene = found.worst_run(tuned, objective.goal());
    let response = retune_solver::simulate(&scene, study.window.window(), &study.solver.settings())?;
    let name = study.quantity().name();
    let mut again = json!({
        name: found.value,
        format!("{name}_none"): study.energy_without_damper(),
        format!("{name}_study"): study.energy(&study.scene),
        "simulation": Summary::new(study, scene, &response) });
    if !objective.goal().limits.is_empty() {
        again["limits"] = json!({ "violation": found.violation, "feasible": found.violation == 0.0 });
        for limit in objective.goal().limits.set() {
            again["limits"][limit.name()] = json!(found.reached.get(limit));
        }
    }
    Ok(again)
}

/// The certificate: of the design of `optimum.json`, of its own where a search left no other, or of the study's.
pub(super) fn certificate(place: &Path, name: &str) -> Result<Made, Error> {
    let study = study_of(place)?;
    let said = json(place, name)?;
    let scene = if place.join(OPTIMUM).exists() {
        tuned(place, &study)?
    } else if SEARCHED.iter().any(|name| place.join(name).exists()) {
        design(&said["design"]).and_then(|found| study.scene_at(&found))
    } else {
        Some(study.scene)
    };
    match scene {
        Some(scene) => Ok(crate::certify::again(&Study { scene, ..study }, said)),
        None => Ok(Made::Not("its design cannot be run".to_owned())),
    }
}

fn study_of(place: &Path) -> Result<Study, Error> {
    Ok(retune_study::read(&place.join(resolved::ONE))?)
}

/// The scene with the design that was found; none where there is none, or it cannot be run.
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
