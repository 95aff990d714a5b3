//! Unfinished work in a directory: found, resumed or discarded.

use crate::error::Error;
use crate::identity::Identity;
use crate::journal::{self, Damage, Journal, Known, State};
use crate::lock::Lock;
use crate::manifest::{Manifest, NAME};
use crate::order::Begin;
use crate::plain::{self, names};
use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The subdirectory in which new results are written.
pub const UNFINISHED: &str = "unfinished";

/// The journal, in [`UNFINISHED`].
pub const JOURNAL: &str = "journal";

/// How a run starts, given the unfinished work in its directory.
#[derive(Debug)]
pub enum Unfinished {
    /// The run resumes the work with this journal.
    Resume(Known, Damage),
    /// The run starts afresh and discards the work in these subdirectories.
    Fresh(BTreeSet<String>),
}

impl Unfinished {
    /// Finds unfinished work in a directory and decides whether a run of this identity resumes it.
    ///
    /// # Errors
    /// There is some and `begin` neither resumes nor discards it; it is of another work; or its journal cannot be identified or
    /// leads out of the directory.
    pub fn find(place: &Path, begin: Begin, identity: &Identity) -> Result<Self, Error> {
        let unfinished = place.join(UNFINISHED);
        let path = unfinished.join(JOURNAL);
        let refuse = |source| Error::Input { path: path.clone(), source };
        check(&unfinished)?;
        let (found_identity, known, damage) = match journal::read(&path, identity).map_err(refuse)? {
            State::Nothing => return Ok(Self::Fresh(BTreeSet::new())),
            State::Unclear(_) if begin == Begin::Restart => return Ok(Self::Fresh(BTreeSet::new())),
            State::Unclear(problem) => return Err(Error::Journal { path, problem }),
            State::Work(found_identity, known, damage) => (found_identity, *known, damage),
        };
        for part in &known.parts {
            plain::below(place, part).map_err(refuse)?;
        }
        let kept = known.lines
            + known.parts.iter().map(|part| kept(&place.join(part), &found_identity)).sum::<u64>();
        if begin == Begin::Restart {
            return Ok(Self::Fresh(known.parts));
        }
        if kept == 0 && damage.is_none() && found_identity != *identity {
            return Ok(Self::Fresh(known.parts)); // nothing was computed
        }
        let difference = identity.difference(&found_identity);
        let is_work = kept > 0 || !damage.is_none();
        if difference.is_some() || begin == Begin::New && is_work {
            let damaged = damage.lines + u64::from(damage.head);
            return Err(Error::Unfinished { path: place.to_owned(), lines: kept, damaged, difference });
        }
        Ok(Self::Resume(known, damage))
    }

    /// Starts the run in its directory. Returns the journal, the subdirectories whose work is discarded, and a warning if the
    /// journal was damaged.
    pub fn start(
        self,
        unfinished: &Path,
        identity: &Identity,
    ) -> Result<(Journal, BTreeSet<String>, Option<String>), Error> {
        let path = unfinished.join(JOURNAL);
        let refuse = |source| Error::Output { path: unfinished.to_owned(), source };
        std::fs::create_dir_all(unfinished).map_err(refuse)?;
        match self {
            Self::Resume(known, damage) => {
                clear(unfinished, |name| name == JOURNAL || name.ends_with(".item")).map_err(refuse)?;
                let warning = (!damage.is_none()).then(|| damaged(&path, known.lines, damage));
                Ok((Journal::resume(&path, identity, known, damage)?, BTreeSet::new(), warning))
            }
            Self::Fresh(parts) => {
                clear(unfinished, |name| name == JOURNAL)
                    .and_then(|()| clear(unfinished, |_| false))
                    .map_err(refuse)?;
                let journal = Journal::begin(&path, identity)?;
                // A run stopped before it has removed these must find them again when resumed.
                parts.iter().for_each(|part| journal.note_part(part));
                Ok((journal, parts, None))
            }
        }
    }
}

fn damaged(path: &Path, kept: u64, Damage { head, lines }: Damage) -> String {
    let first = "its first line is damaged, but its records are of this study";
    let rest = format!(
        "{lines} of its lines {} damaged, and what {} held is computed again; {kept} results are kept",
        if lines == 1 { "is" } else { "are" },
        if lines == 1 { "it" } else { "they" },
    );
    let words = match (head, lines) {
        (true, 0) => format!("{first}; {kept} results are kept"),
        (true, _) => format!("{first}; {rest}"),
        (false, _) => rest,
    };
    format!("{}: {words}", path.display())
}

/// The number of results in the unfinished work of a subdirectory.
fn kept(place: &Path, identity: &Identity) -> u64 {
    match journal::read(&place.join(UNFINISHED).join(JOURNAL), identity) {
        Ok(State::Work(_, known, _)) => known.lines,
        _ => 0,
    }
}

/// Checks that a directory of this name was made by Retune: it has a journal, or nothing but temporary files.
fn check(unfinished: &Path) -> Result<(), Error> {
    let protected =
        |problem: &str| Error::Protected { path: unfinished.to_owned(), problem: problem.to_owned() };
    let refuse = |source| Error::Input { path: unfinished.to_owned(), source };
    match unfinished.symlink_metadata() {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(refuse(error)),
        Ok(metadata) if !metadata.is_dir() => {
            return Err(protected("it is no directory, and Retune keeps its unfinished work there"));
        }
        Ok(_) => {}
    }
    let names = names(unfinished).map_err(refuse)?;
    let is_temporary = |name: &String| name.starts_with('.') && name.ends_with(".tmp");
    if names.iter().any(|name| name == JOURNAL) || names.iter().all(is_temporary) {
        return Ok(());
    }
    Err(protected(
        "it holds files but no journal, so Retune did not make it, and its unfinished work needs this place",
    ))
}

/// Removes the files in a directory for which `keep` is false.
fn clear(directory: &Path, keep: impl Fn(&str) -> bool) -> std::io::Result<()> {
    for name in names(directory)?.iter().filter(|name| !keep(name)) {
        std::fs::remove_file(directory.join(name))?;
    }
    Ok(())
}

/// Removes unfinished work, its journal last: without it the directory is not recognised as Retune's.
pub fn remove(unfinished: &Path) -> std::io::Result<()> {
    clear(unfinished, |name| name == JOURNAL)?;
    clear(unfinished, |_| false)?;
    std::fs::remove_dir(unfinished)
}

/// Removes the results that Retune made in a directory, and the directory if nothing else is in it. Removes nothing if there is
/// unfinished work that must be kept, or if another process is at work.
pub fn remove_results(place: &Path, with_unfinished: bool) -> std::io::Result<()> {
    let is_directory = place.symlink_metadata().is_ok_and(|metadata| metadata.is_dir());
    let Some(lock) = is_directory.then(|| Lock::take(place).ok()).flatten() else { return Ok(()) };
    let unfinished: PathBuf = place.join(UNFINISHED);
    if unfinished.exists() {
        if !with_unfinished || check(&unfinished).is_err() {
            return Ok(());
        }
        remove(&unfinished)?;
    }
    if let Ok(Some(manifest)) = Manifest::read(place) {
        let files = manifest.files.keys().chain(manifest.earlier.keys()).collect::<BTreeSet<_>>();
        for name in files.into_iter().filter(|name| manifest.has_made(place, name)) {
            std::fs::remove_file(place.join(name))?;
        }
        if plain::is_there(&place.join(NAME))? {
            std::fs::remove_file(place.join(NAME))?;
        }
    }
    drop(lock);
    let _ = std::fs::remove_dir(place); // it stays if anything else is in it
    Ok(())
}
