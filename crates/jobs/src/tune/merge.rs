//! Shares of the grid for many machines: `optimize --shard 3/64` computes one, `merge` joins all.

use super::surf::Designs;
use super::{Optimum, run, searched, tuned};
use crate::job::Done;
use crate::parts::{Shard, Shared};
use crate::resolved::identity_of;
use crate::{Error, Observer, Request};
use retune_store::Order;
use retune_study::{Rule, Study};
use std::path::{Path, PathBuf};

/// The grid of a study, whose shares are written to `out`.
fn shared<'a>(
    study: &Study,
    rows: &'a Designs,
    request: &Request,
    out: &'a Path,
    order: &'a Order,
) -> Result<Shared<'a>, Error> {
    let command = format!("retune optimize {}", request.study.display());
    Ok(Shared { rows, identity: identity_of(study)?, out, order, command })
}

/// Computes a share of the grid of a study file, for [`merge`].
///
/// # Errors
/// The study is wrong or has no grid, or the part cannot be written.
pub fn share(request: &Request, shard: Shard, watch: &dyn Observer) -> Result<(), Error> {
    let study = retune_study::read(&request.study)?;
    let (out, order) = (request.out_of(&study), request.order(super::KIND.command));
    let rows = Designs::of(&study, &searched(&study)?).ok_or_else(|| Error::rule(&study)(Rule::NoGrid))?;
    let shared = shared(&study, &rows, request, &out, &order)?;
    request.on_threads(|| shared.make(shard, watch))
}

/// Checks that the parts are of one study, one version and one arithmetic, disjoint and complete, and completes the search as
/// [`tune`] would have done. `parts` are files; by default all in the directory of parts.
///
/// # Errors
/// The study or a part is wrong, nothing can be computed, or the results cannot be written.
///
/// [`tune`]: super::tune()
pub fn merge(request: &Request, parts: &[PathBuf], watch: &dyn Observer) -> Result<Done<Optimum>, Error> {
    let study = retune_study::read(&request.study)?;
    let (out, order) = (request.out_of(&study), request.order(super::KIND.command));
    let search = searched(&study)?;
    let rows = Designs::of(&study, &search).ok_or_else(|| Error::rule(&study)(Rule::NoGrid))?;
    let shared = shared(&study, &rows, request, &out, &order)?;
    run(&study, request, watch, |results| {
        shared.merge(parts, results, watch)?;
        tuned(&study, &search, results, watch)
    })
}
