//! `table2`: the same search for several dampers, from the paper's own designs.

use crate::designs::Table;
use crate::tune::optimize;
use crate::{Error, Observer, Request};
use retune_study::{PaperStudy, read_table2};
use serde_json::json;

/// Re-optimises each row of Table 2 from the paper's own design, and shows both rows.
///
/// # Errors
/// A study is wrong, nothing can be computed, or the results cannot be written.
pub fn table2(request: &Request, watch: &dyn Observer) -> Result<(), Error> {
    let mut rows = read_table2(&request.study)?;
    let (out, order) = (request.out_of_file()?, request.order("table2"));
    for PaperStudy { study, .. } in &mut rows {
        if let Some(optimize) = &mut study.optimize {
            optimize.surf = None; // the refinement then starts at the damper of the scene, the paper's
        }
    }
    let mut table = Table::new(["table2", "origin"], &[], &out, &order, json!({}), &rows, watch)?;
    request.on_threads(|| {
        for PaperStudy { damper, study } in rows {
            watch.log(&format!("\n{damper}: re-optimised from the paper's design"))?;
            let (optimum, results) = optimize(&study, &table.directory().part(study.name()), &order, watch)?;
            table.push("paper", &damper, optimum.start());
            table.push("re-optimised", &damper, optimum.found());
            table.keep(&study, &optimum, results);
        }
        table.finish(watch)
    })
}
