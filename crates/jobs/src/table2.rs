//! `table2`: searches for several dampers, from the paper's designs.

use crate::artefact::Kind;
use crate::certify::judge;
use crate::designs::{self, Designs, Row};
use crate::job::{Done, Job, Made};
use crate::needs::Largest;
use crate::searches::Searches;
use crate::summary::TunedDamper;
use crate::{Error, Observer, Request, resolved};
use retune_model::Positive;
use retune_study::{PaperStudy, read_table2};
use serde_json::json;

/// The files of the table.
pub static KIND: Kind = Kind {
    command: "table2",
    answer: "table2.csv",
    input: resolved::SEVERAL,
    rows: &[("table2.csv", designs::recompute)],
    whole: &[],
    derived: &["table2.txt"],
};

/// Re-optimises each row of Table 2 from the paper's design, under the objective and the bounds of its study. The table has the paper's
/// row, with its printed E1max, and the re-optimised one.
///
/// # Errors
/// A study is wrong, nothing can be computed, or the results cannot be written.
pub fn table2(request: &Request, watch: &dyn Observer) -> Result<Done<Designs>, Error> {
    let mut rows = read_table2(&request.study)?;
    for PaperStudy { study, .. } in &mut rows {
        if let Some(optimize) = &mut study.optimize {
            optimize.surf = None; // the refinement then starts at the damper of the scene, the reference
        }
    }
    let studies = rows.iter().map(|row| (row.damper.as_str(), &row.study));
    let job = Job::of_studies(&KIND, request, json!({}), studies)?;
    job.run(request, watch, |directory| {
        let mut searches = Searches::new(directory, &job.order, watch);
        let mut table = Vec::new();
        for PaperStudy { damper, study, of_paper, printed } in &rows {
            let (label, start) = if *of_paper {
                ("paper", "the paper's design")
            } else {
                ("of the study", "the design that is given")
            };
            watch.log(&format!("\n{damper}: re-optimised from {start}"))?;
            let optimum = searches.tune(study, "")?;
            let reoptimised = Row::of_optimum("re-optimised", damper, study, &optimum);
            let settings = study.solver.settings();
            let paper = study.goal().evaluate(&study.scene, &settings, f64::INFINITY)?;
            let certificate = judge(study)?;
            let paper = Row {
                label: label.to_owned(),
                found: study
                    .scene
                    .damper
                    .map_or(reoptimised.found, |damper| TunedDamper::of(&damper, study.varied())),
                printed: printed.map(Positive::get),
                e1_max: paper.value,
                verdict: certificate.verdict(),
                reason: certificate.reason().to_owned(),
                needs: Largest::of(study, &study.scene),
                ..reoptimised.clone()
            };
            table.extend([paper, reoptimised]);
        }
        let Searches { results: parts, infeasible, .. } = searches;
        let table = Designs { column: "origin", rows: table, infeasible };
        table.write(KIND.command, directory)?;
        Ok(Made { report: format!("\n{}", table.text()), answer: table, parts })
    })
}
