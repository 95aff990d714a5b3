//! `losses`: what a damper is worth when its contacts lose energy. One is tuned as if they lost nothing, one anew for each restitution, one for
//! the worst of all at once, and the paper's is kept; each is evaluated at every restitution, and where the energy goes is told.

mod compared;
mod draw;
mod page;

pub use compared::{Losses, Point, Tuning, Worth};

use crate::again::{Row, Source, broken};
use crate::artefact::{Content, Kind, artefact};
use crate::contacts::Powers;
use crate::job::{Done, Job, Made};
use crate::paper::TABLE_2;
use crate::resolved::{self, Resolved};
use crate::searches::Searches;
use crate::{Error, Observer, Request};
use compared::FILE;
use rayon::prelude::*;
use retune_model::{Design, Parameter, Scene};
use retune_optim::Unusable;
use retune_solver::{collisions, losses as losses_of};
use retune_study::{Rule, Setting, Study, clipped, read};
use serde_json::json;
use std::path::Path;

/// The files of the job.
pub static KIND: Kind = Kind {
    command: "losses",
    answer: FILE,
    artefacts: &[
        artefact(resolved::SEVERAL, Content::Input),
        artefact(FILE, Content::Rows(again)),
        artefact("losses.svg", Content::Derived),
        artefact("dashpot.svg", Content::Derived),
        artefact("powers.svg", Content::Derived),
        artefact("README.md", Content::Derived),
        artefact("report.html", Content::Derived),
    ],
};

/// Tunes dampers for the restitutions of the objective of a study, and compares them.
///
/// # Errors
/// The study is wrong or has no restitutions, nothing can be computed, or the results cannot be written.
pub fn losses(request: &Request, watch: &dyn Observer) -> Result<Done<Losses>, Error> {
    let study = read(&request.study)?;
    let restitutions = restitutions(&study)?;
    let job = Job::of_studies(&KIND, request, json!({}), [(study.name(), &study)].into_iter())?;
    job.run(request, watch, |directory| {
        let mut searches = Searches::new(directory, &job.order, watch);
        let mut designs: Vec<(Tuning, f64, Design)> = Vec::new();
        let mut before: Option<Design> = None;
        for e in &restitutions {
            watch.log(&format!("\nrestitution {e}"))?;
            let mut alone = at(&study, *e)?;
            if let (Some(optimize), Some(start)) = (&mut alone.optimize, before) {
                optimize.starts.push(clipped(&start, optimize));
            }
            let found = searches.tune(&alone, &format!("restitution-{e}"))?.damper.design;
            designs.push((Tuning::Anew, *e, found));
            before = Some(found);
        }
        let lossless = designs[0].2; // the first restitution is 1
        watch.log("\nall restitutions at once")?;
        let hedged = searches.tune(&study, "all")?.damper.design;
        let paper = Design::new(|parameter| {
            Parameter::PAPER.iter().position(|known| *known == parameter).map_or(f64::NAN, |i| TABLE_2[i])
        });
        let paper = paper.map_err(|(parameter, source)| {
            Error::from(Unusable::Value { parameter, source: source.into() })
        })?;
        for (tuning, design) in
            [(Tuning::Paper, paper), (Tuning::Lossless, lossless), (Tuning::Hedged, hedged)]
        {
            designs.extend(restitutions.iter().map(|e| (tuning, *e, design)));
        }
        let point = |(tuning, restitution, design): &(Tuning, f64, Design)| {
            let worth = worth(&study, *restitution, design)?;
            Ok(Point { tuning: *tuning, restitution: *restitution, design: *design, worth })
        };
        let points: Result<Vec<Point>, Error> = designs.par_iter().map(point).collect();
        let losses = Losses { points: points?, study: study.clone() };
        directory.write(FILE, &losses.table().csv())?;
        let report = page::write(&losses, directory)?;
        Ok(Made { report: format!("\n{report}"), answer: losses, parts: searches.results })
    })
}

/// The restitutions of the objective of a study, and 1, from the largest.
fn restitutions(study: &Study) -> Result<Vec<f64>, Error> {
    let set = study.objective().restitution.filter(|_| study.optimize.is_some());
    let set = set.ok_or_else(|| Error::rule(study)(Rule::NoRestitutions))?;
    let mut all: Vec<f64> = set.into_iter().map(|e| e.get()).chain([1.0]).collect();
    all.sort_by(|a, b| b.total_cmp(a));
    all.dedup();
    Ok(all)
}

/// The study for one restitution alone.
fn at(study: &Study, e: f64) -> Result<Study, Error> {
    let mut alone = study.with(&[Setting::new(Parameter::Restitution, e)])?;
    if let Some(optimize) = &mut alone.optimize {
        optimize.objective.restitution = None;
    }
    Ok(alone)
}

/// What a design is worth at a restitution.
fn worth(study: &Study, e: f64, design: &Design) -> Result<Worth, Error> {
    let alone = at(study, e)?;
    let scene: Scene = alone.scene_at(design).ok_or_else(|| Error::rule(study)(Rule::NoDamper))?;
    let (settings, window) = (alone.solver.settings(), alone.window.window());
    let found = alone.goal().evaluate(&scene, &settings, f64::INFINITY)?;
    let run = found.worst_run(scene, &alone.goal());
    let lost = losses_of(&run, window, &settings)?;
    let walls = collisions(&run, window, &settings)?;
    Ok(Worth {
        value: found.value,
        omega: run.forcing.frequency.get(),
        powers: Powers::new(lost, window.to - window.from),
        impact_speed: walls.iter().map(|wall| wall.speed).fold(0.0, f64::max),
    })
}

/// A row of the table, computed again from its design and its restitution.
fn again(place: &Path, _name: &str) -> Result<Source, Error> {
    let studies = Resolved::read(place)?.studies()?;
    let none = || broken(place, resolved::SEVERAL, "it names no study");
    let (_, study) = studies.into_iter().next().ok_or_else(none)?;
    let quantity = study.quantity().name();
    Ok(Source::new(move |row: Row| {
        let Worth { value, omega, powers, impact_speed } =
            worth(&study, row.number("restitution"), &row.design()?).ok()?;
        let [structure, damper, impacts] = powers.parts();
        let numbers = [
            (quantity, value),
            ("omega", omega),
            ("power_structure", structure),
            ("power_damper", damper),
            ("power_impacts", impacts),
            ("impact_speed", impact_speed),
        ];
        Some(numbers.map(|(name, number)| (name.to_owned(), number)).into())
    }))
}
