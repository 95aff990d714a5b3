//! `reproduce`, computed again: an item is made again, from the designs that its searches came to, and compared with its files.

use super::item::Item;
use super::items::{ITEMS, Maker, SEARCHES, statements};
use super::plan::{PaperPlan, Plan};
use crate::again::{Made, broken, design, json, text};
use crate::resolved::{Resolved, SEVERAL};
use crate::tune::OPTIMUM;
use crate::{Error, Silent};
use retune_model::Design;
use retune_study::Study;
use serde_json::{Map, Value, json};
use std::path::Path;

/// The statements of an item, and with them its tables and data.
///
/// # Errors
/// A file cannot be read.
pub(super) fn again(place: &Path, name: &str) -> Result<Made, Error> {
    let said = json(place, name)?;
    let Some((_, make)) = ITEMS.into_iter().find(|(item, _)| statements(item) == name) else {
        return Ok(Made::Not("is of no item of the page".to_owned()));
    };
    let resolved = Resolved::read(place)?;
    let file = serde_json::from_value::<PaperPlan>(resolved.plan.clone());
    let studies = resolved.studies()?.into_iter().map(|(_, study)| study).collect::<Vec<Study>>();
    let (Ok(file), Ok([ssvi, tmd])) = (file, <[Study; 2]>::try_from(studies)) else {
        return Err(broken(place, SEVERAL, "it is no plan of the paper with its two dampers"));
    };
    let plan = Plan { file, ssvi, tmd, watch: &Silent, is_brief: false };
    let item = match made(make, &plan, place) {
        Ok(item) => item,
        Err(error) => return Ok(Made::Not(format!("cannot be made again: {error}"))),
    };
    let made = item.files();
    let read =
        |(name, _): &(String, String)| (name.clone(), text(place, name).map_or(Value::Null, Value::from));
    let files: Map<String, Value> = made.iter().map(read).collect();
    let made: Map<String, Value> = made.into_iter().map(|(name, text)| (name, text.into())).collect();
    Ok(Made::Of {
        what: "with its tables and data",
        said: json!({ "statements": said, "files": files }),
        again: json!({ "statements": item.statements, "files": made }),
    })
}

/// The item, with the designs of the searches that stand in the directory.
fn made(make: Maker, plan: &Plan, place: &Path) -> Result<Item, Error> {
    make(plan, &mut |study: &Study| -> Result<Design, Error> {
        let place = place.join(SEARCHES).join(study.name());
        design(&json(&place, OPTIMUM)?)
            .ok_or_else(|| broken(&place, OPTIMUM, "it holds no design of a damper"))
    })
}
