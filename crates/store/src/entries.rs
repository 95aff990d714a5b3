//! The entries of a directory: listed, and waited for until they are on the disk.

use std::fs::File;
use std::path::Path;

pub fn names(directory: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(directory)? {
        names.extend(entry?.file_name().into_string());
    }
    names.sort();
    Ok(names)
}

/// Waits until the names in a directory are on the disk.
#[cfg(unix)]
pub fn sync_directory(path: &Path) -> std::io::Result<()> {
    File::open(path)?.sync_all()
}

/// Elsewhere a directory cannot be waited for.
#[cfg(not(unix))]
pub fn sync_directory(_path: &Path) -> std::io::Result<()> {
    Ok(())
}
