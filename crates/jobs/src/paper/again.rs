//! `reproduce`, computed again: an item is made again, from the designs that its searches came to, and compared with its files.

use super::item::Item;
use super::items::{ITEMS, Maker, SEARCHES, statements};
use super::plan::{PaperPlan, Plan};
use crate::Error;
use crate::observer::Quiet;
use crate::resolved::{Resolved, SEVERAL};
use crate::tune::OPTIMUM;
use crate::verify::{Report, input, one};
use retune_model::Design;
use retune_study::Study;
use serde_json::{Map, Value, json};
use std::path::Path;

/// Checks the statements of an item, and with them its tables and data, by making it again.
///
/// # Errors
/// A file cannot be read, as of all checks; or a run fails.
pub fn again(place: &Path, name: &str, _most: usize, report: &mut Report<'_>) -> Result<(), Error> {
    let said = input::json(place, name)?;
    let Some((_, make)) = ITEMS.into_iter().find(|(item, _)| statements(item) == name) else {
        return report.fail(name, "is of no item of the page");
    };
    let quiet = Quiet(report.watch);
    let resolved = Resolved::read(place)?;
    let file = serde_json::from_value::<PaperPlan>(resolved.plan.clone());
    let studies = resolved.studies()?.into_iter().map(|(_, study)| study).collect::<Vec<Study>>();
    let (Ok(file), Ok([ssvi, tmd])) = (file, <[Study; 2]>::try_from(studies)) else {
        return report.fail(SEVERAL, "is no plan of the paper with its two dampers");
    };
    let plan = Plan { file, ssvi, tmd, watch: &quiet, is_brief: false };
    match made(make, &plan, place) {
        Ok(item) => {
            let made = item.files();
            let read = |(name, _): &(String, String)| {
                (name.clone(), input::text(place, name).map_or(Value::Null, Value::from))
            };
            let files: Map<String, Value> = made.iter().map(read).collect();
            let said = json!({ "statements": said, "files": files });
            let made: Map<String, Value> = made.into_iter().map(|(name, text)| (name, text.into())).collect();
            let again = json!({ "statements": item.statements, "files": made });
            report.compare(name, "with its tables and data", &said, &again)
        }
        Err(error) => report.fail(name, &format!("cannot be made again: {error}")),
    }
}

/// The item, with the designs of the searches that stand in the directory.
fn made(make: Maker, plan: &Plan, place: &Path) -> Result<Item, Error> {
    make(plan, &mut |study: &Study| -> Result<Design, Error> {
        let place = place.join(SEARCHES).join(study.name());
        let refuse = || std::io::Error::other("it holds no design of a damper");
        one::design(&input::json(&place, OPTIMUM)?)
            .ok_or_else(|| retune_store::Error::Input { path: place.join(OPTIMUM), source: refuse() }.into())
    })
}
