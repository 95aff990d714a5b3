//! Shares of a computation of many points, for many machines: `--shard 3/64` computes the third of 64 shares and writes it as one part,
//! whose name holds the hash of its content. A part never changes: it exists complete or not at all.
//!
//! Points are those of a grid, with one number each, or of a sweep, with several; a part holds the numbers in sequence.

use crate::rows::{Rows, compute};
use crate::{Error, Observer, job};
use retune_store::identity::{Identity, hexadecimal};
use retune_store::journal::{Seal, grid_text, grid_value};
use retune_store::{Begin, Directory, Extent, Order, plain};
use retune_study::counted;
use sha2::{Digest, Sha256};
use std::io::{BufRead, BufReader, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The first words of a part.
const TITLE: &str = "retune-part-1";

/// Longest line of a part, bytes.
const LONGEST: u64 = 1024;

/// The directory of parts, in that of the results.
pub const PARTS: &str = "parts";

/// The end of the message on a damaged part.
const DAMAGED: &str = ": make it again";

/// The ending of a part.
const ENDING: &str = ".part";

/// Share number `index`, from 1, of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub index: usize,
    /// The number of shares.
    pub count: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err("give i/N with 1 <= i <= N, for instance 3/64".to_owned()),
        }
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl Shard {
    fn points(self, len: usize) -> Range<usize> {
        let end = |shares: usize| (shares as u128 * len as u128 / self.count as u128) as usize;
        end(self.index - 1)..end(self.index)
    }

    /// The prefix of the part's name.
    fn name(self) -> String {
        format!("{:05}-of-{:05}", self.index, self.count)
    }
}

/// The first line of a part.
#[derive(Clone, Debug)]
struct Head {
    /// The file of the part.
    pub path: PathBuf,
    /// The identity of its study and program.
    pub identity: Identity,
    /// Its share.
    pub shard: Shard,
    /// The range of its numbers in the whole computation.
    pub points: Range<usize>,
}

/// Rows that are computed in shares, with the directory of their results.
pub struct Shared<'a> {
    /// The rows to share.
    pub rows: &'a dyn Rows,
    /// The identity of the whole computation.
    pub identity: Identity,
    /// The directory of its results; parts are in [`PARTS`] in it.
    pub out: &'a Path,
    /// The order to open that directory.
    pub order: &'a Order,
    /// The command that makes a part, without `--shard`.
    pub command: String,
}

impl Shared<'_> {
    /// Computes a share and writes it as a part, unless that exists; a damaged part is replaced.
    pub fn make(&self, shard: Shard, watch: &dyn Observer) -> Result<(), Error> {
        let Self { rows, ref identity, out, order, .. } = *self;
        let (len, width, parts) = (rows.len(), rows.width(), out.join(PARTS));
        let place = parts.join(shard.name());
        if let Some(path) = find(&parts, shard)? {
            let head = match read(&path, |_, _| {}) {
                Ok(head) => head,
                Err(Error::Part { problem, .. }) if problem.ends_with(DAMAGED) => {
                    watch.warn(&format!("{}: {problem}", path.display()));
                    let refuse = |source| retune_store::Error::Output { path: path.clone(), source };
                    std::fs::remove_file(&path).map_err(refuse)?;
                    return self.make(shard, watch);
                }
                Err(other) => return Err(other),
            };
            return match identity.difference(&head.identity) {
                None => {
                    // The process that made it may have been killed before it removed its working directory.
                    if let Some(work) = place.exists().then(|| {
                        open(&place, &Order { begin: Begin::Restart, ..order.clone() }, identity, watch)
                    }) {
                        discard(work?, &place);
                    }
                    watch.result(&format!("{} is there already", path.display()))
                }
                Some(difference) => Err(Error::Part { path, problem: format!("it is {difference}") }),
            };
        }
        let work = open(&place, order, identity, watch)?;
        let some = shard.points(len);
        let (Range { start, end }, known) = (some.clone(), work.journal().known() / width as u64);
        watch.log(&format!("shard {shard}: points {start} to {end} of {len}, {known} of them known"))?;
        let bar = watch.progress("shard", some.len() as u64);
        let found = compute(rows, some.clone(), work.journal(), &*bar);
        bar.finish();
        work.journal().check()?;
        let values: Vec<f64> = found.into_iter().flat_map(|(numbers, _)| numbers).collect();
        let path = write(&work, shard, identity, width * some.start, &values, &parts)?;
        discard(work, &place);
        watch.result(&format!("wrote {}", path.display()))
    }
}

/// Writes a part that begins with number `first` of the whole computation; returns its path.
fn write(
    work: &Directory,
    shard: Shard,
    identity: &Identity,
    first: usize,
    values: &[f64],
    parts: &Path,
) -> Result<PathBuf, Error> {
    let end = first + values.len();
    let head = format!("{TITLE} {} shard={shard} points={first}-{end}", identity.words());
    let seal = Seal::plain();
    let lines = || {
        let rest = (first..end).zip(values).map(|(i, value)| grid_text(i, *value));
        std::iter::once(head.clone()).chain(rest).map(|text| seal.close(&text))
    };
    let mut hash = Sha256::new();
    lines().for_each(|line| hash.update(line));
    let hash = hexadecimal(&hash.finalize()[..8]);
    let name = format!("{}-{hash}{ENDING}", shard.name());
    let mut part = work.file(&name)?;
    lines().try_for_each(|line| part.push(&line))?;
    part.finish_for_good()?;
    let path = parts.join(&name);
    std::fs::rename(work.whole_path(&name), &path)
        .map_err(|source| retune_store::Error::Output { path: path.clone(), source })?;
    Ok(path)
}

/// Opens the working directory of a part; it has no results of its own.
fn open(place: &Path, order: &Order, identity: &Identity, watch: &dyn Observer) -> Result<Directory, Error> {
    job::open(place, order, identity, Extent::Share, |_| false, watch)
}

fn discard(work: Directory, place: &Path) {
    work.discard();
    drop(work); // removes the lock
    let _ = std::fs::remove_dir(place); // empty by now; otherwise it is not ours
}

fn find(parts: &Path, shard: Shard) -> Result<Option<PathBuf>, Error> {
    let prefix = format!("{}-", shard.name());
    Ok(list(parts)?.into_iter().find(|path| {
        path.file_name().and_then(|name| name.to_str()).is_some_and(|name| name.starts_with(&prefix))
    }))
}

/// The parts in a directory, sorted; an empty list if there is no directory.
fn list(parts: &Path) -> Result<Vec<PathBuf>, Error> {
    if !parts.is_dir() {
        return Ok(Vec::new());
    }
    let refuse = |source| retune_store::Error::Input { path: parts.to_owned(), source };
    let is_part = |name: &String| name.ends_with(ENDING) && !name.starts_with('.');
    Ok(plain::names(parts)
        .map_err(refuse)?
        .iter()
        .filter(|name| is_part(name))
        .map(|name| parts.join(name))
        .collect())
}

/// Reads a part and calls `visit` with the index and value of each of its numbers.
fn read(path: &Path, mut visit: impl FnMut(usize, f64)) -> Result<Head, Error> {
    let refuse = |source| retune_store::Error::Input { path: path.to_owned(), source };
    let broken = |problem: &str| Error::Part { path: path.to_owned(), problem: problem.to_owned() };
    let mut lines = BufReader::new(plain::open(path).map_err(refuse)?);
    let mut hash = Sha256::new();
    let mut line = Vec::new();
    let mut next = |line: &mut Vec<u8>| -> Result<bool, Error> {
        line.clear();
        (&mut lines).take(LONGEST).read_until(b'\n', line).map_err(refuse)?;
        hash.update(&*line);
        Ok(!line.is_empty())
    };
    next(&mut line)?;
    let head = Seal::plain().open(&line).and_then(|text| head(path, text));
    let head = head.ok_or_else(|| broken("it is no part: its first line is not that of one"))?;
    for expected in head.points.clone() {
        let there = next(&mut line)?;
        match Seal::plain().open(&line).and_then(grid_value) {
            Some((point, value)) if point == expected => visit(point, value),
            _ if there => return Err(broken(&format!("it is damaged at number {expected}{DAMAGED}"))),
            _ => return Err(broken(&format!("it ends before number {expected}{DAMAGED}"))),
        }
    }
    if next(&mut line)? {
        return Err(broken(&format!("it has more numbers than it says{DAMAGED}")));
    }
    let name = format!("-{}{ENDING}", hexadecimal(&hash.finalize()[..8]));
    match path.file_name().and_then(|file| file.to_str()) {
        Some(file) if file.ends_with(&name) => Ok(head),
        _ => Err(broken("its name does not hold the hash of its content: it was changed or renamed")),
    }
}

fn head(path: &Path, text: &str) -> Option<Head> {
    let words = text.strip_prefix(TITLE)?.strip_prefix(' ')?;
    let (rest, points) = words.rsplit_once(" points=")?;
    let (identity, shard) = rest.rsplit_once(" shard=")?;
    let (start, end) = points.split_once('-')?;
    Some(Head {
        path: path.to_owned(),
        identity: Identity::parse(identity)?,
        shard: shard.parse().ok()?,
        points: start.parse().ok()?..end.parse().ok()?,
    })
}

/// Most missing ranges or shares that a message names.
const NAMED: usize = 5;

impl Shared<'_> {
    /// Reads the numbers of all rows into the journal, from the files `parts` or, if there are none, from all in the directory of parts.
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
        let command = format!("{} --out {}", self.command, self.out.display());
        check(&mut heads, self.rows.len(), &command, &place)?;
        let [parts, points] = [(heads.len(), "part"), (self.rows.len(), "point")]
            .map(|(count, noun)| counted(count as u64, noun));
        watch.log(&format!("{parts}, {points}: complete, disjoint, of this study"))?;
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

/// The missing shares, if all parts have the same number of shares.
fn missing_shards(heads: &[Head]) -> Option<Vec<String>> {
    let count = heads.first()?.shard.count;
    let is_there = |index: usize| heads.iter().any(|head| head.shard.index == index);
    let missing = (1..=count).filter(|&index| !is_there(index));
    heads
        .iter()
        .all(|head| head.shard.count == count)
        .then(|| missing.map(|i| format!("{i}/{count}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_shares_are_disjoint_and_complete() {
        for (len, count) in [(10, 3), (7, 7), (3, 5), (10_000_000, 999), (0, 2)] {
            let mut next = 0;
            for index in 1..=count {
                let points = Shard { index, count }.points(len);
                assert_eq!(points.start, next, "{len} {count}");
                assert!(points.len() <= len / count + 1, "{len} {count}");
                next = points.end;
            }
            assert_eq!(next, len);
        }
    }

    #[test]
    fn contract_invalid_shares_are_refused() {
        assert_eq!("3/64".parse(), Ok(Shard { index: 3, count: 64 }));
        for text in ["0/3", "4/3", "3", "a/b", "1/0", "-1/3", ""] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
