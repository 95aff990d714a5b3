//! Allows one run at a time in a directory. The system releases the lock when the process ends, so a crash leaves none
//! behind; a left-over lock file is harmless.

use super::plain;
use crate::error::Error;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

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
    /// [`Error::Busy`] if another process holds it; or the file cannot be created.
    pub fn take(directory: &Path) -> Result<Self, Error> {
        let path = directory.join(NAME);
        let refuse = |source| Error::Output { path: path.clone(), source };
        // Between opening and locking, the previous holder may have removed the file: the lock is then on a file that no one else sees.
        for attempt in 0_u32.. {
            let mut options = OpenOptions::new();
            options.create(true).truncate(false).write(true);
            let mut file = plain::open_with(&path, &mut options).map_err(refuse)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let holder = std::fs::read_to_string(&path).unwrap_or_default();
                    let holder = holder.split_whitespace().next().unwrap_or_default().parse().ok();
                    return Err(Error::Busy { path: directory.to_owned(), holder });
                }
                Err(TryLockError::Error(source)) => return Err(refuse(source)),
            }
            if !is_ours(&std::fs::read(&path).unwrap_or_default()) {
                let words = "it is not a lock that Retune left behind: move it away";
                return Err(refuse(std::io::Error::other(words)));
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

/// Whether this is the content of a lock file: empty, or beginning with a process id.
fn is_ours(text: &[u8]) -> bool {
    text.is_empty()
        || text
            .split(|byte| *byte == b' ')
            .next()
            .is_some_and(|word| !word.is_empty() && word.iter().all(u8::is_ascii_digit))
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
    fn contract_a_second_lock_is_refused_until_the_first_is_released() {
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

    #[cfg(unix)]
    #[test]
    fn contract_what_is_no_lock_of_ours_is_left_alone() {
        let directory = tempfile::tempdir().expect("a directory");
        let (treasure, lock) = (directory.path().join("treasure"), directory.path().join(NAME));
        std::fs::write(&treasure, "mine").expect("a file");
        std::os::unix::fs::symlink(&treasure, &lock).expect("a link");
        let error = Lock::take(directory.path()).expect_err("a link").to_string();
        assert!(error.contains("it is a symbolic link"), "{error}");
        std::fs::remove_file(&lock).expect("the link");
        std::fs::write(&lock, "mine").expect("a file");
        let error = Lock::take(directory.path()).expect_err("no lock").to_string();
        assert!(error.contains("not a lock that Retune left"), "{error}");
        assert_eq!(
            [treasure, lock].map(|path| std::fs::read_to_string(path).ok()),
            [const { Some("mine") }; 2].map(|x| x.map(str::to_owned))
        );
    }
}
