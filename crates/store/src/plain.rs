//! Opening files at names that others can guess: only plain files, never what a symbolic link points to, a pipe or a device.

use crate::error::Error as Refused;
use std::fs::{File, OpenOptions};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::{Component, Path, PathBuf};

/// Opens a plain file to read it.
///
/// # Errors
/// There is none, it is something else, or it may not be read.
pub fn open(path: &Path) -> Result<File> {
    is_there(path)?;
    without_links(OpenOptions::new().read(true)).open(path)
}

/// Reads a plain file as text.
pub fn text(path: &Path) -> std::result::Result<String, Refused> {
    let mut text = String::new();
    let read = open(path).and_then(|mut file| file.read_to_string(&mut text));
    read.map(|_| text).map_err(|source| Refused::Input { path: path.to_owned(), source })
}

/// The path of `name`, which a file says, below `directory`: of plain names, none of them a symbolic link.
///
/// # Errors
/// It would lead elsewhere: it is absolute or empty, it has `..`, or a part of it is a symbolic link.
pub fn below(directory: &Path, name: &str) -> Result<PathBuf> {
    let elsewhere = |why: &str| Error::new(ErrorKind::InvalidData, format!("`{name}` {why}"));
    let mut path = directory.to_owned();
    let mut parts = Path::new(name).components().peekable();
    if parts.peek().is_none() {
        return Err(elsewhere("is no name"));
    }
    for part in parts {
        let Component::Normal(part) = part else {
            return Err(elsewhere("leads out of this directory: only names below it are allowed"));
        };
        path.push(part);
        if path.symlink_metadata().is_ok_and(|found| found.is_symlink()) {
            let link = path.display();
            return Err(elsewhere(&format!(
                "leads through {link}, a symbolic link, and Retune follows none"
            )));
        }
    }
    Ok(path)
}

/// Opens a plain file with `options`, which may make one.
///
/// # Errors
/// There is something else of this name, or it may not be opened.
pub fn open_with(path: &Path, options: &mut OpenOptions) -> Result<File> {
    is_there(path)?;
    without_links(options).open(path)
}

/// Makes a new file, in place of one that an earlier process left.
pub fn create(path: &Path) -> Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true); // which follows no link
    match options.open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            std::fs::remove_file(path)?; // a link itself, not what it points to
            options.open(path)
        }
        other => other,
    }
}

/// Whether a plain file stands there.
pub fn is_there(path: &Path) -> Result<bool> {
    let kind = match path.symlink_metadata() {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
        other => other?.file_type(),
    };
    let what = if kind.is_file() {
        return Ok(true);
    } else if kind.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    } else if kind.is_symlink() {
        "a symbolic link"
    } else {
        "no plain file"
    };
    Err(Error::other(format!("it is {what}, and Retune follows none: move it away")))
}

/// What happens between looking and opening must not matter either.
#[cfg(unix)]
fn without_links(options: &mut OpenOptions) -> &mut OpenOptions {
    use std::os::unix::fs::OpenOptionsExt;
    options.custom_flags(libc::O_NOFOLLOW)
}

/// Elsewhere there is no such flag.
#[cfg(not(unix))]
fn without_links(options: &mut OpenOptions) -> &mut OpenOptions {
    options
}

/// The names in a directory, sorted.
pub fn names(directory: &Path) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(directory)? {
        names.extend(entry?.file_name().into_string());
    }
    names.sort();
    Ok(names)
}

/// Waits until the names in a directory are on the disk.
#[cfg(unix)]
pub(crate) fn sync_directory(path: &Path) -> Result<()> {
    File::open(path)?.sync_all()
}

/// Elsewhere a directory cannot be waited for.
#[cfg(not(unix))]
pub(crate) fn sync_directory(_path: &Path) -> Result<()> {
    Ok(())
}
