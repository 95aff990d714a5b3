use super::*;
use std::cell::Cell;

struct Desk(tempfile::TempDir);

impl Desk {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a directory"))
    }

    fn path(&self) -> PathBuf {
        self.0.path().join("journal")
    }

    /// Opens the journal as a run that goes on does.
    fn open(&self) -> Journal {
        let identity = Identity::of("study");
        let (known, length) = match read(&self.path()).expect("a journal") {
            Some((of, known, length)) => {
                assert_eq!(of, identity);
                (known, length)
            }
            None => (Known::default(), 0),
        };
        Journal::open(&self.path(), &identity, known, length).expect("a journal")
    }

    fn bytes(&self) -> Vec<u8> {
        std::fs::read(self.path()).expect("a journal")
    }
}

/// Asks for `count` values of two stages and of a grid; says how many had to be computed.
fn ask(journal: &Journal, count: usize) -> usize {
    let computed = Cell::new(0);
    let compute = |value: f64| {
        computed.set(computed.get() + 1);
        value
    };
    for i in 0..count {
        let x = i as f64;
        assert_eq!(journal.value("one", &[x, 1.0], f64::INFINITY, || compute(x), |_| {}), x);
        assert_eq!(
            journal.value("one", &[x, 1.0], 3.0, || compute(x + 0.5), |_| {}),
            x + 0.5,
            "another cutoff"
        );
        assert_eq!(
            journal.value("two", &[x, 1.0], 3.0, || compute(x + 0.25), |_| {}),
            x + 0.25,
            "another stage"
        );
        assert_eq!(journal.grid_value(i, || compute(-x), |_| {}), -x);
    }
    computed.get()
}

#[test]
fn exact_what_is_known_is_not_computed_again() {
    let desk = Desk::new();
    assert_eq!(ask(&desk.open(), 5), 20);
    let before = desk.bytes();
    let again = desk.open();
    assert_eq!((again.known(), ask(&again, 5)), (20, 0));
    assert_eq!(desk.bytes(), before, "no line is doubled");
    assert_eq!(ask(&desk.open(), 7), 8);
    assert_eq!(ask(&desk.open(), 7), 0);
}

#[test]
fn exact_a_journal_cut_anywhere_goes_on() {
    let desk = Desk::new();
    ask(&desk.open(), 3);
    let whole = desk.bytes();
    for length in 0..=whole.len() {
        std::fs::write(desk.path(), &whole[..length]).expect("a file");
        let lines = whole[..length].iter().filter(|byte| **byte == b'\n').count();
        assert_eq!(ask(&desk.open(), 3), 12 - lines.saturating_sub(1), "cut at byte {length}");
        assert_eq!(desk.bytes(), whole, "cut at byte {length}");
    }
}

#[test]
fn exact_a_flipped_bit_costs_what_follows_it_and_is_never_believed() {
    let desk = Desk::new();
    ask(&desk.open(), 3);
    let whole = desk.bytes();
    let first = whole.iter().position(|byte| *byte == b'\n').expect("a line") + 1;
    for place in first..whole.len() {
        let mut flipped = whole.clone();
        flipped[place] ^= 1;
        std::fs::write(desk.path(), &flipped).expect("a file");
        assert!(ask(&desk.open(), 3) > 0, "byte {place}");
        assert_eq!(desk.bytes(), whole, "byte {place}");
    }
}

#[test]
fn exact_what_could_not_be_computed_is_tried_again_but_written_once() {
    let desk = Desk::new();
    let fail = |journal: &Journal| {
        let tries = Cell::new(0);
        let compute = || {
            tries.set(tries.get() + 1);
            f64::INFINITY
        };
        assert_eq!(journal.value("one", &[1.0], 2.0, compute, |_| {}), f64::INFINITY);
        assert_eq!(journal.grid_value(7, compute, |_| {}), f64::INFINITY);
        tries.get()
    };
    assert_eq!(fail(&desk.open()), 2);
    let before = desk.bytes();
    assert_eq!(fail(&desk.open()), 2);
    assert_eq!(desk.bytes(), before);
}

#[test]
fn exact_marks_are_kept() {
    let desk = Desk::new();
    desk.open().mark("figure3");
    let again = desk.open();
    assert!(again.is_marked("figure3") && !again.is_marked("figure4"));
}

#[test]
fn exact_a_file_that_is_no_journal_is_none() {
    let desk = Desk::new();
    assert!(read(&desk.path()).expect("no file").is_none());
    std::fs::write(desk.path(), "something else\n").expect("a file");
    assert!(read(&desk.path()).expect("a file").is_none());
}
