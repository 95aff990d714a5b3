//! The owner of the results in a directory, and the rules for replacing them.
//!
//! A run may replace what the same command made from the same study file, even if that was edited since: that is everyday work. Anything
//! else is replaced only with `--replace`: results of another study, a file that Retune did not make, or one that was changed afterwards.

use crate::error::Error;
use crate::identity::Identity;
use crate::manifest::{MadeBy, Manifest, NAME};
use crate::plain::{self, names};
use std::path::{Path, PathBuf};

/// What to do with unfinished work in the directory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Begin {
    /// It is kept, and the run is refused.
    #[default]
    New,
    /// The run resumes it.
    Resume,
    /// It is discarded.
    Restart,
}

/// A request for results.
#[derive(Clone, Debug)]
pub struct Order {
    /// The command that makes such results.
    pub command: &'static str,
    /// The study file.
    pub study: PathBuf,
    /// What to do with unfinished work.
    pub begin: Begin,
    /// Whether results of another owner may be replaced.
    pub replace: bool,
}

/// The part of the results in a directory that a run replaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// All of it.
    Whole,
    /// Some files; the others stay.
    Share,
    /// Some files, beside results of any other owner.
    Guest,
}

impl Order {
    /// The owner of the results that this request makes in `place`, which must exist.
    pub fn made_by(&self, place: &Path) -> MadeBy {
        // A study file that does not exist yet has no canonical path.
        let full = |path: &Path| {
            path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned())
        };
        let (study, place) = (full(&self.study), full(place));
        let study = pathdiff::diff_paths(&study, place).unwrap_or(study);
        let study = study.to_string_lossy().replace(std::path::MAIN_SEPARATOR, "/");
        MadeBy { command: self.command.to_owned(), study }
    }

    /// Checks that a run may put its results, whose names `is_ours` tells, into `place`.
    ///
    /// # Errors
    /// [`Error::Standing`] if there are results that it may not replace; [`Error::Protected`] if its own study file would be replaced;
    /// [`Error::Input`] if the manifest leads out of the directory.
    pub fn may_replace(
        &self,
        place: &Path,
        extent: Extent,
        identity: &Identity,
        is_ours: impl Fn(&str) -> bool,
    ) -> Result<(), Error> {
        let manifest = Manifest::read(place)?;
        let is_foreign = |name: &String| match &manifest {
            Some(manifest) => name != NAME && !manifest.has_made(place, name),
            None => true,
        };
        let entries = names(place).map_err(|source| Error::Output { path: place.to_owned(), source })?;
        let foreign: Vec<String> =
            entries.into_iter().filter(|name| is_ours(name)).filter(is_foreign).collect();
        if let Some(name) = foreign.iter().find(|name| is_same(&place.join(name), &self.study)) {
            let problem = "it is the study itself, and results of this name would take its place";
            return Err(Error::Protected { path: place.join(name), problem: problem.to_owned() });
        }
        if self.replace {
            return Ok(());
        }
        if extent != Extent::Guest
            && let Some(other_owner) = manifest.as_ref().and_then(|it| self.other_owner(place, identity, it))
        {
            return Err(Error::Standing { path: place.to_owned(), problem: other_owner });
        }
        if foreign.is_empty() {
            return Ok(());
        }
        let problem =
            format!("{} is in the way: Retune did not make it, or it was changed since", list(&foreign));
        Err(Error::Standing { path: place.to_owned(), problem })
    }

    /// Describes the owner if the results belong to another study or command.
    fn other_owner(&self, place: &Path, identity: &Identity, manifest: &Manifest) -> Option<String> {
        if manifest.identity() == *identity {
            return None;
        }
        let made_by = &manifest.made_by;
        (*made_by != self.made_by(place)).then(|| {
            format!(
                "the directory holds results of `retune {}` for {}",
                made_by.command,
                made_by.study_from_current_dir(place)
            )
        })
    }
}

impl MadeBy {
    /// The study file as seen from the working directory.
    fn study_from_current_dir(&self, place: &Path) -> String {
        let path = place.join(&self.study);
        let seen = || pathdiff::diff_paths(path.canonicalize().ok()?, std::env::current_dir().ok()?);
        seen().unwrap_or(path).display().to_string()
    }
}

/// Checks that a file may be written at `path`: an existing one may be replaced only if it is a plain file, is none of `inputs`, and
/// begins with `head`, as all such files of Retune do.
pub fn may_write(path: &Path, inputs: &[&Path], head: &str) -> Result<(), Error> {
    let protected = |problem: &str| Error::Protected { path: path.to_owned(), problem: problem.to_owned() };
    if inputs.iter().any(|input| is_same(path, input)) {
        return Err(protected("it is an input of this command"));
    }
    match plain::is_there(path) {
        Ok(false) => return Ok(()),
        Ok(true) => {}
        Err(error) => return Err(protected(&error.to_string())),
    }
    use std::io::Read;
    let mut found = Vec::new();
    let read = plain::open(path).and_then(|file| file.take(head.len() as u64).read_to_end(&mut found));
    match read {
        Ok(_) if found.is_empty() || found == head.as_bytes() => Ok(()),
        Ok(_) => Err(protected("there is a file that Retune did not make")),
        Err(source) => Err(Error::Output { path: path.to_owned(), source }),
    }
}

/// Whether both paths lead to the same existing file or directory.
pub fn is_same(one: &Path, other: &Path) -> bool {
    let [one, other] = [one, other].map(|path| path.canonicalize().ok());
    one.is_some() && one == other
}

/// The first few names.
fn list(names: &[String]) -> String {
    const NAMED: usize = 3;
    let more = if names.len() > NAMED { ", ..." } else { "" };
    names.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ") + more
}
