//! A share of the grid, for many machines: `optimize --shard 3/64`.

use super::objective::coarse;
use crate::parts::{Shard, Work};
use crate::resolved::identity_of;
use crate::{Error, Observer};
use retune_store::Order;
use retune_study::{Rule, Study};
use std::path::Path;

/// Computes a share of the grid of a study and writes it into `out/parts`.
///
/// # Errors
/// The study has no grid, or the part cannot be written.
pub fn shard(
    study: &Study,
    shard: Shard,
    out: &Path,
    order: &Order,
    watch: &dyn Observer,
) -> Result<(), Error> {
    let refuse = Error::rule(study);
    let search = study.search().map_err(refuse)?;
    let (variables, grid) = search.surf.clone().ok_or_else(|| refuse(Rule::NoGrid))?;
    let (objective, most) = (coarse(study, &search, &variables), study.coarse().up_to());
    let work = Work { shard, len: grid.len(), width: 1, identity: identity_of(study)?, out, order };
    work.make(watch, |journal, points, bar| {
        let value = |i: usize, design: &[f64]| {
            journal.grid_value(i, || objective.value_up_to(design, most), |_| bar.known())
        };
        retune_optim::surf_part(&grid, points, value, |_| bar.inc(1))
    })
}
