//! Opening files at names that others can guess: only plain files, never what a symbolic link points to, a pipe or a device.

use crate::error::Error as Refused;
use std::fs::{File, OpenOptions};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::{Component, Path, PathBuf};

/// Opens a plain file to read it.
///
/// # Errors
/// It does not exist, is not a plain file, or may not be read.
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

/// The path of `name`, which was read from a file, below `directory`. Its components must be plain names, none of them a symbolic link.
///
/// # Errors
/// It would lead elsewhere: it is absolute or empty, contains `..`, or a component is a symbolic link.
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

/// Opens a plain file with `options`, which may create it.
///
/// # Errors
/// The name belongs to something else, or it may not be opened.
pub fn open_with(path: &Path, options: &mut OpenOptions) -> Result<File> {
    is_there(path)?;
    without_links(options).open(path)
}

/// Creates a new file, replacing one left by an earlier process.
pub fn create(path: &Path) -> Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true); // does not follow links
    match options.open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            std::fs::remove_file(path)?; // removes a link, not its target
            options.open(path)
        }
        other => other,
    }
}

/// Whether a plain file exists at the path.
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

/// Refuses to open a symbolic link, even one created between the check and the opening.
#[cfg(unix)]
fn without_links(options: &mut OpenOptions) -> &mut OpenOptions {
    use std::os::unix::fs::OpenOptionsExt;
    options.custom_flags(libc::O_NOFOLLOW)
}

/// Other systems have no such flag.
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

/// Waits until the entries of a directory are on disk.
#[cfg(unix)]
pub(crate) fn sync_directory(path: &Path) -> Result<()> {
    File::open(path)?.sync_all()
}

/// Other systems cannot sync a directory.
#[cfg(not(unix))]
pub(crate) fn sync_directory(_path: &Path) -> Result<()> {
    Ok(())
}
