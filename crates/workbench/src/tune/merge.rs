//! `merge`: merges the parts of a grid that many machines computed, and completes the search.

use super::shard::{self, Head, PARTS};
use super::{Optimum, run, searched, tuned};
use crate::job::Done;
use crate::resolved::identity_of;
use crate::{Error, Observer, Request};
use retune_study::Rule;
use retune_study::counted;
use std::path::{Path, PathBuf};

/// Most shares that a message names.
const NAMED: usize = 5;

/// Checks that the parts are of one study, one version and one arithmetic, disjoint and complete, and completes the search as
/// [`tune`] would have done. `parts` are files; by default all in the directory of parts.
///
/// # Errors
/// The study or a part is wrong, nothing can be computed, or the results cannot be written.
///
/// [`tune`]: super::tune()
pub fn merge(request: &Request, parts: &[PathBuf], watch: &dyn Observer) -> Result<Done<Optimum>, Error> {
    let study = retune_study::read(&request.study)?;
    let refuse = |rule| Error::Rule { name: study.name().to_owned(), rule };
    let search = searched(&study)?;
    let (_, grid) = search.surf.as_ref().ok_or_else(|| refuse(Rule::NoGrid))?;
    let (out, identity) = (request.out_of(&study), identity_of(&study)?);
    run(&study, request, watch, |results| {
        let paths = if parts.is_empty() { shard::list(&out.join(PARTS))? } else { parts.to_owned() };
        let mut heads = Vec::new();
        for path in &paths {
            let head = shard::read(path, |_, _| {})?;
            if let Some(difference) = identity.difference(&head.identity) {
                return Err(Error::Part { path: path.clone(), problem: format!("it is {difference}") });
            }
            heads.push(head);
        }
        check(&mut heads, grid.len(), &request.study, &out)?;
        watch.log(&format!(
            "{}, {}: complete, disjoint, of this study",
            counted(heads.len() as u64, "part"),
            counted(grid.len() as u64, "point")
        ))?;
        for head in &heads {
            shard::read(&head.path, |point, value| results.know(point, value))?;
        }
        tuned(&study, &search, results, watch)
    })
}

/// Checks that the parts are disjoint and contain every point.
fn check(heads: &mut [Head], len: usize, study: &Path, out: &Path) -> Result<(), Error> {
    heads.sort_by_key(|head| (head.points.start, head.points.end));
    let mut missing = Vec::new();
    let mut next = 0;
    let mut last: Option<&Head> = None;
    for head in heads.iter().filter(|head| !head.points.is_empty()) {
        if let Some(last) = last.filter(|_| head.points.start < next) {
            let problem =
                format!("it holds points that {} holds as well: keep one of the two", last.path.display());
            return Err(Error::Part { path: head.path.clone(), problem });
        }
        if head.points.start > next {
            missing.push(next..head.points.start);
        }
        (next, last) = (head.points.end, Some(head));
    }
    if next < len {
        missing.push(next..len);
    }
    if missing.is_empty() {
        return Ok(());
    }
    let named = |words: Vec<String>| {
        let more = if words.len() > NAMED { ", ..." } else { "" };
        words.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ") + more
    };
    let points = missing.iter().map(|points| format!("{} to {}", points.start, points.end - 1)).collect();
    Err(Error::MissingParts {
        points: named(points),
        len,
        shards: missing_shards(heads).map(named),
        study: study.to_owned(),
        place: out.join(PARTS),
    })
}

/// The missing shares, if all parts are of the same number of shares.
fn missing_shards(heads: &[Head]) -> Option<Vec<String>> {
    let count = heads.first()?.shard.count;
    let is_there = |index: usize| heads.iter().any(|head| head.shard.index == index);
    let missing = (1..=count).filter(|&index| !is_there(index));
    heads
        .iter()
        .all(|head| head.shard.count == count)
        .then(|| missing.map(|i| format!("{i}/{count}")).collect())
}
