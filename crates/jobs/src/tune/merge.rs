//! `merge`: merges the parts of a grid that many machines computed, and completes the search.

use super::{Optimum, run, searched, tuned};
use crate::job::Done;
use crate::parts::{self, PARTS, Wanted, complete};
use crate::resolved::identity_of;
use crate::{Error, Observer, Request};
use retune_study::Rule;
use std::path::PathBuf;

/// Checks that the parts are of one study, one version and one arithmetic, disjoint and complete, and completes the search as
/// [`tune`] would have done. `parts` are files; by default all in the directory of parts.
///
/// # Errors
/// The study or a part is wrong, nothing can be computed, or the results cannot be written.
///
/// [`tune`]: super::tune()
pub fn merge(request: &Request, parts: &[PathBuf], watch: &dyn Observer) -> Result<Done<Optimum>, Error> {
    let study = retune_study::read(&request.study)?;
    let refuse = Error::rule(&study);
    let search = searched(&study)?;
    let (_, grid) = search.surf.as_ref().ok_or_else(|| refuse(Rule::NoGrid))?;
    let wanted = Wanted {
        identity: identity_of(&study)?,
        len: grid.len(),
        width: 1,
        place: request.out_of(&study).join(PARTS),
        command: format!("retune optimize {}", request.study.display()),
    };
    run(&study, request, watch, |results| {
        for head in complete(&wanted, parts, watch)? {
            parts::read(&head.path, |point, value| results.know(point, value))?;
        }
        tuned(&study, &search, results, watch)
    })
}
