//! What a study file of any kind asks for.

use crate::paper::kind::KIND;
use crate::paper::plan::Plan;
use crate::{Error, Silent, artefact, describe, table2, tune};
use crate::{fronts, retention};
use retune_study::{self as study, Kind};
use std::path::Path;

/// Checks a study file of any kind: what it asks for in words, and the jobs whose files it makes.
///
/// # Errors
/// It, or a file that it names, is wrong.
pub fn describe(path: &Path) -> Result<(String, Vec<&'static artefact::Kind>), Error> {
    Ok(match study::kind_of(path)? {
        Kind::Table2 => (describe::table2(&study::read_table2(path)?), vec![&table2::KIND, &retention::KIND]),
        Kind::Fronts => (describe::fronts(&study::read_fronts(path)?), vec![&fronts::KIND]),
        Kind::Paper => {
            Plan::read(path, &Silent)?;
            ("every table and figure of the paper".to_owned(), vec![&KIND])
        }
        Kind::Study => {
            let study = study::read(path)?;
            let jobs = if study.optimize.is_some() { vec![&tune::KIND] } else { Vec::new() };
            (describe::study(&study), jobs)
        }
    })
}
