//! `design`: from a structure and what its damper may be to an answer. Both dampers are tuned for their worst E1max over a band of
//! frequencies, compared with none, certified, and tuned once more without each limit, which says what the limit costs.

mod answer;
mod designed;
mod requirements;

pub use designed::Designed;
pub use requirements::{Requirements, Wish};

use crate::artefact::{Content, Kind, artefact};
use crate::designs::{Designs, Row};
use crate::job::{Done, Job, Made};
use crate::searches::Searches;
use crate::{Error, Observer, Request, resolved};
use retune_model::{Measure, Parameter};
use retune_study::{Rule, Setting, Study, clipped};
use serde_json::json;

/// The files of an answer.
pub static KIND: Kind = Kind {
    command: "design",
    answer: "designs.csv",
    artefacts: &[
        artefact(resolved::SEVERAL, Content::Input),
        artefact("designs.csv", Content::Rows(crate::designs::again)),
        artefact("designs.txt", Content::Derived),
        artefact("answer.txt", Content::Derived),
        artefact("studies-*.json", Content::Derived),
    ],
};

/// Tunes both dampers for a structure, and compares them.
///
/// # Errors
/// A wish cannot be fulfilled, nothing can be computed, or the results cannot be written.
pub fn design(
    requirements: &Requirements,
    request: &Request,
    watch: &dyn Observer,
) -> Result<Done<Vec<Designed>>, Error> {
    requirements.check()?;
    let dampers = [("TMD", requirements.tmd()?), ("SSVI NES", requirements.ssvi()?)];
    let studies = dampers.iter().map(|(name, study)| (*name, study));
    let job = Job::of_studies(&KIND, request, json!(requirements), studies)?;
    job.run(request, watch, |directory| {
        let mut searches = Searches::new(directory, &job.order, watch);
        let designed = dampers
            .iter()
            .map(|(name, study)| one(requirements, name, study, &mut searches, watch))
            .collect::<Result<Vec<Designed>, Error>>()?;
        let rows = designed.iter().flat_map(|damper| damper.rows.clone()).collect();
        Designs { column: "limits", rows, infeasible: None }.write("designs", directory)?;
        for Designed { study, .. } in &designed {
            directory.write_json(&format!("studies-{}.json", study.name()), &study.resolved())?;
        }
        let answer = answer::answer(requirements, &designed, &job.out);
        directory.write("answer.txt", &(answer.clone() + "\n"))?;
        Ok(Made { answer: designed, report: format!("\n{answer}"), parts: searches.results })
    })
}

/// Tunes one damper under all limits, then without each of them.
fn one(
    requirements: &Requirements,
    name: &'static str,
    study: &Study,
    searches: &mut Searches,
    watch: &dyn Observer,
) -> Result<Designed, Error> {
    watch.log(&format!("\n{name}"))?;
    let found = searches.tune(study, "")?;
    let mut rows = vec![Row::of_optimum("all", name, study, &found)];
    for limit in requirements.limits() {
        let free = requirements.without(limit);
        let mut free = if name == "TMD" { free.tmd()? } else { free.ssvi()? };
        // What a limit costs is measured from a search that is at least as good as that under it.
        if let Some(optimize) = &mut free.optimize {
            let start = clipped(&found.found().damper.design, optimize);
            optimize.starts.push(start);
        }
        watch.log(&format!("\n{name}, without the limit on {}", limit.words()))?;
        let optimum = searches.tune(&free, &format!("without-{}", limit.name()))?;
        rows.push(Row::of_optimum(&format!("no {}", limit.name()), name, study, &optimum));
    }
    let scene = study
        .scene_at(&found.found().damper.design)
        .ok_or_else(|| Error::Rule { name: study.name().to_owned(), rule: Rule::NoDamper })?;
    let tuned = Study { scene, ..study.clone() };
    let off = |share: f64| -> Result<f64, Error> {
        let k1 = study.scene.primary.stiffness.get() * (1.0 + share);
        Ok(study.energy(&tuned.scene_with(&[Setting::new(Parameter::K1, k1)])?).unwrap_or(f64::NAN))
    };
    let detuned =
        requirements.k1_error.map(|error| Ok::<_, Error>([off(-error)?, off(error)?])).transpose()?;
    let needs = found.needs.as_ref().map_or([f64::NAN; 2], |needs| {
        [Measure::Stroke, Measure::ContactForce].map(|measure| needs.damper.value(measure))
    });
    Ok(Designed { name, study: study.clone(), rows, needs, feasible: found.check_limits().is_ok(), detuned })
}
