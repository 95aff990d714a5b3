//! One run at a time in a directory. The system holds the lock for as long as the process lives, so a crash leaves none
//! behind; the file that it leaves is harmless.

use crate::error::Error;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

/// The file that is locked.
pub const NAME: &str = ".lock";

/// A held lock. Its file is removed when it is dropped.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    _file: File,
}

impl Lock {
    /// Takes the lock of `directory`.
    ///
    /// # Errors
    /// [`Error::Busy`] where another process holds it; or the file cannot be made.
    pub fn take(directory: &Path) -> Result<Self, Error> {
        let path = directory.join(NAME);
        let refuse = |source| Error::Output { path: path.clone(), source };
        // Between opening and locking, the last holder may have removed the file: then it is not the one that others see.
        for attempt in 0_u32.. {
            let mut options = OpenOptions::new();
            let mut file = options.create(true).truncate(false).write(true).open(&path).map_err(refuse)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let holder = std::fs::read_to_string(&path).unwrap_or_default();
                    let holder = holder.split_whitespace().next().unwrap_or_default().parse().ok();
                    return Err(Error::Busy { path: directory.to_owned(), holder });
                }
                Err(TryLockError::Error(source)) => return Err(refuse(source)),
            }
            let token = format!("{} {attempt} {:?}\n", std::process::id(), std::time::SystemTime::now());
            let written = file
                .set_len(0)
                .and_then(|()| file.rewind())
                .and_then(|()| file.write_all(token.as_bytes()).and_then(|()| file.flush()));
            written.map_err(refuse)?;
            if std::fs::read_to_string(&path).is_ok_and(|text| text == token) {
                return Ok(Self { path, _file: file });
            }
        }
        Err(refuse(std::io::ErrorKind::TimedOut.into()))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path); // a lock file without a lock does no harm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_second_is_refused_until_the_first_is_gone() {
        let directory = tempfile::tempdir().expect("a directory");
        std::fs::write(directory.path().join(NAME), "4711 what a killed run left\n").expect("a file");
        let first = Lock::take(directory.path()).expect("a lock");
        match Lock::take(directory.path()) {
            Err(Error::Busy { holder, .. }) => assert_eq!(holder, Some(std::process::id())),
            other => panic!("{other:?}"),
        }
        drop(first);
        assert!(!directory.path().join(NAME).exists());
        Lock::take(directory.path()).expect("free again");
    }
}
