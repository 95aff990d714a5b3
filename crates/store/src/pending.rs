//! Files that get their name only when they are complete: written under a temporary name, then renamed.

use super::plain::{self, names};
use crate::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Removes temporary files of `path` left by killed processes. The caller must hold the lock of the directory.
pub fn clear(path: &Path) -> std::io::Result<()> {
    let (Some(directory), Some(name)) = (path.parent(), path.file_name()) else { return Ok(()) };
    let begin = format!(".{}.", name.to_string_lossy());
    let is_temporary = |name: &String| {
        let process = name.strip_prefix(&begin).and_then(|rest| rest.strip_suffix(".tmp"));
        process.is_some_and(|process| process.parse::<u32>().is_ok())
    };
    for name in names(directory)?.iter().filter(|name| is_temporary(name)) {
        std::fs::remove_file(directory.join(name))?;
    }
    Ok(())
}

/// A file that is being written under a temporary name. Dropping it unfinished removes it.
#[derive(Debug)]
pub struct Pending {
    path: PathBuf,
    temporary: PathBuf,
    file: BufWriter<File>,
    finished: bool,
}

impl Pending {
    /// Begins the file at `path`.
    pub fn create(path: &Path) -> Result<Self, Error> {
        let refuse = |source| Error::Output { path: path.to_owned(), source };
        let name = path.file_name().ok_or_else(|| refuse(std::io::ErrorKind::IsADirectory.into()))?;
        if path.is_dir() {
            return Err(refuse(std::io::ErrorKind::IsADirectory.into()));
        }
        let temporary =
            path.with_file_name(format!(".{}.{}.tmp", name.to_string_lossy(), std::process::id()));
        let file = BufWriter::new(plain::create(&temporary).map_err(refuse)?);
        Ok(Self { path: path.to_owned(), temporary, file, finished: false })
    }

    /// Appends `text`.
    pub fn push(&mut self, text: &str) -> Result<(), Error> {
        self.file.write_all(text.as_bytes()).map_err(|source| self.refused(source))
    }

    /// Gives the file its name.
    pub fn finish(mut self) -> Result<(), Error> {
        let named = self.file.flush().and_then(|()| std::fs::rename(&self.temporary, &self.path));
        named.map_err(|source| self.refused(source))?;
        self.finished = true;
        Ok(())
    }

    /// Syncs the file to disk, then gives it its name.
    pub fn finish_on_disk(mut self) -> Result<(), Error> {
        let written = self.file.flush().and_then(|()| self.file.get_ref().sync_all());
        written.map_err(|source| self.refused(source))?;
        self.finish()
    }

    /// Syncs the file to disk, makes it read-only, then gives it its name.
    pub fn finish_for_good(mut self) -> Result<(), Error> {
        let settle = |file: &File| {
            let mut permissions = file.metadata()?.permissions();
            permissions.set_readonly(true);
            file.set_permissions(permissions)?;
            file.sync_all()
        };
        self.file
            .flush()
            .and_then(|()| settle(self.file.get_ref()))
            .map_err(|source| self.refused(source))?;
        self.finish()
    }

    fn refused(&self, source: std::io::Error) -> Error {
        Error::Output { path: self.path.clone(), source }
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        if !self.finished {
            let _ = std::fs::remove_file(&self.temporary); // nothing more can be done if this fails
        }
    }
}
