//! Publication: the new results take the place of the earlier ones.

use super::Directory;
use crate::error::Error;
use crate::identity::json_text;
use crate::manifest::{Manifest, NAME, file_sha256};
use crate::order::Extent;
use crate::pending::Pending;
use crate::plain::{names, sync_directory};
use crate::{plain, unfinished};
use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;

impl Directory {
    /// Puts the new results into the place of the earlier ones. They are on the disk before an earlier one goes; the journal stays
    /// until [`Self::finish`].
    ///
    /// # Errors
    /// There is something in their place that may not be replaced, or a file cannot be written, moved or removed.
    pub fn publish(&self) -> Result<(), Error> {
        self.journal.check()?;
        let new = self.whole()?;
        if new.is_empty() {
            return Ok(()); // they are in their place already
        }
        // Someone may have put a file there since the work began.
        self.order
            .may_replace(&self.path, self.extent, &self.identity, |name| new.iter().any(|new| new == name))?;
        self.place(&new).map_err(|source| self.refused(source))
    }

    /// The process may end at any moment, so a manifest that names the old and the new files is written first.
    fn place(&self, new: &[String]) -> std::io::Result<()> {
        for name in new {
            File::open(self.unfinished.join(name))?.sync_all()?;
        }
        let old = Manifest::read(&self.path).map_err(std::io::Error::other)?;
        let mut standing = names(&self.path)?;
        standing.retain(|name| old.as_ref().is_some_and(|old| old.has_made(&self.path, name)));
        if let Some(mut between) = Manifest::read(&self.unfinished).map_err(std::io::Error::other)? {
            for name in &standing {
                let sha = file_sha256(&self.path.join(name)).map_err(std::io::Error::other)?;
                between.earlier.insert(name.clone(), sha);
            }
            let write = || {
                let mut file = Pending::create(&self.path.join(NAME))?;
                file.push(&json_text(&between, NAME)?)?;
                file.finish_on_disk()
            };
            write().map_err(std::io::Error::other)?;
        }
        standing.retain(|name| self.replaces(name));
        if self.order.replace {
            let is_ours = |name: &String| {
                (self.is_ours)(name) && plain::is_there(&self.path.join(name)).unwrap_or(false)
            };
            standing.extend(names(&self.path)?.into_iter().filter(is_ours));
        }
        let gone: BTreeSet<String> = standing.into_iter().filter(|name| !new.contains(name)).collect();
        for name in gone {
            std::fs::remove_file(self.path.join(name))?;
        }
        if let Some(old) = old.filter(|_| self.extent == Extent::Whole) {
            self.remove_parts(&old.parts, false)?;
        }
        self.remove_parts(self.journal.parts(), true)?;
        self.remove_parts(&self.thrown_away, true)?;
        let (manifest, files): (Vec<&String>, Vec<&String>) = new.iter().partition(|name| *name == NAME);
        for name in files.into_iter().chain(manifest) {
            std::fs::rename(self.unfinished.join(name), self.path.join(name))?;
        }
        sync_directory(&self.path)
    }

    /// Removes Retune's files from directories below that are no longer part of the work.
    fn remove_parts(&self, earlier: &BTreeSet<String>, with_unfinished: bool) -> std::io::Result<()> {
        let now = self.parts();
        for name in earlier.difference(&now) {
            // A link that was put there since the manifest was read leads to what is not ours.
            let Ok(part) = plain::below(&self.path, name) else { continue };
            unfinished::remove_results(&part, with_unfinished)?;
            let mut above = Path::new(name).parent();
            while let Some(name) = above.filter(|name| !name.as_os_str().is_empty()) {
                let _ = std::fs::remove_dir(self.path.join(name)); // it stays if anything else is in it
                above = name.parent();
            }
        }
        Ok(())
    }

    /// Puts the new results into place and removes what the work left behind.
    pub fn finish(self) -> Result<(), Error> {
        self.publish()?;
        unfinished::remove(&self.unfinished).map_err(|source| self.refused(source))
    }
}
