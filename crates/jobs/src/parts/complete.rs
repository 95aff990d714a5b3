//! Whether parts are of one work, disjoint and complete.

use super::part::{Head, PARTS, Shared, list, read};
use crate::{Error, Observer};
use retune_store::Directory;
use retune_study::counted;
use std::path::{Path, PathBuf};

/// Most shares that a message names.
const NAMED: usize = 5;

impl Shared<'_> {
    /// Takes the numbers of all rows from the files `parts`, or from all in the directory of parts if there are none, into the journal.
    pub fn merge(
        &self,
        parts: &[PathBuf],
        results: &mut Directory,
        watch: &dyn Observer,
    ) -> Result<(), Error> {
        let place = self.out.join(PARTS);
        let paths = if parts.is_empty() { list(&place)? } else { parts.to_owned() };
        let width = self.rows.width();
        let mut heads = Vec::new();
        for path in &paths {
            let mut head = read(path, |_, _| {})?;
            if let Some(difference) = self.identity.difference(&head.identity) {
                return Err(Error::Part { path: path.clone(), problem: format!("it is {difference}") });
            }
            head.points = head.points.start / width..head.points.end / width;
            heads.push(head);
        }
        check(&mut heads, self.rows.len(), &self.command, &place)?;
        watch.log(&format!(
            "{}, {}: complete, disjoint, of this study",
            counted(heads.len() as u64, "part"),
            counted(self.rows.len() as u64, "point")
        ))?;
        for head in heads {
            read(&head.path, |number, value| results.know(number, value))?;
        }
        Ok(())
    }
}

/// Checks that the parts are disjoint and contain every point.
fn check(heads: &mut [Head], len: usize, command: &str, place: &Path) -> Result<(), Error> {
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
        command: command.to_owned(),
        place: place.to_owned(),
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
