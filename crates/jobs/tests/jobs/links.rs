//! Places that cannot be written, and links that are not followed.

use crate::{request, restart};
use retune_jobs::tune::tune;
use retune_jobs::{Error, Silent};
use retune_store::Error as StoreError;
use retune_testkit::desk::{Desk, tiny};
use retune_testkit::observers::refused;

/// Not even root can write there.
#[cfg(target_os = "linux")]
#[test]
fn contract_a_directory_that_cannot_be_written_is_named() {
    let desk = Desk::with(&tiny());
    match refused(tune(&request(&desk, "study.json", "/sys/kernel"), &Silent)) {
        Error::Store(StoreError::Output { path, .. }) => {
            assert_eq!(path, std::path::Path::new("/sys/kernel/.lock"));
        }
        other => panic!("{other}"),
    }
}

/// The names of locks, journals and temporary files are predictable.
#[cfg(unix)]
#[test]
fn contract_no_link_is_followed() {
    use std::os::unix::fs::symlink;
    let desk = Desk::with(&tiny());
    desk.write("treasure", "mine");
    desk.write("chest/journal", "mine");
    std::fs::create_dir(desk.path("out")).expect("a directory");
    for (link, target) in [
        (".lock", "../treasure"),
        ("unfinished", "../chest"),
        ("surf.csv", "../treasure"),
        ("manifest.json", "../treasure"),
    ] {
        symlink(target, desk.path("out").join(link)).expect("a link");
        for request in [request(&desk, "study.json", "out"), restart(&desk, "study.json", "out")] {
            let error = refused(tune(&request, &Silent));
            assert!(matches!(error, Error::Store(_)), "{link}: {error}");
        }
        assert_eq!([desk.read("treasure"), desk.read("chest/journal")], ["mine", "mine"], "{link}");
        std::fs::remove_file(desk.path("out").join(link)).expect("the link");
    }
    std::fs::create_dir(desk.path("out/unfinished")).expect("a directory");
    symlink("../../treasure", desk.path("out/unfinished/journal")).expect("a link");
    match refused(tune(&request(&desk, "study.json", "out"), &Silent)) {
        Error::Store(StoreError::Input { path, source }) => {
            assert_eq!(path, desk.path("out/unfinished/journal"));
            assert!(
                source.to_string().starts_with("it is a symbolic link, and Retune follows none"),
                "{source}"
            );
        }
        other => panic!("{other}"),
    }
    assert_eq!(desk.read("treasure"), "mine");
}
