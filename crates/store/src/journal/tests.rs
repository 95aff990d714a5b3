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

    /// Opens the journal as a resumed run does; none if its work cannot be identified.
    fn try_open(&self) -> Option<(Journal, Damage)> {
        let identity = Identity::of("study");
        let journal = match read(&self.path(), &identity).expect("a journal") {
            State::Work(of, known, damage) => {
                assert_eq!(of, identity);
                (Journal::resume(&self.path(), &identity, *known, damage), damage)
            }
            State::Nothing => {
                let _ = std::fs::remove_file(self.path()); // an empty one
                (Journal::begin(&self.path(), &identity), Damage::default())
            }
            State::Unclear(_) => return None,
        };
        Some((journal.0.expect("a journal"), journal.1))
    }

    fn open(&self) -> Journal {
        self.try_open().expect("a journal of this study").0
    }

    fn put(&self, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(), bytes).expect("a file");
    }

    /// The lines, sorted, because recomputed values are appended at the end.
    fn lines(&self) -> Vec<String> {
        let mut lines: Vec<String> =
            String::from_utf8(self.bytes()).expect("text").lines().map(str::to_owned).collect();
        lines.sort();
        lines
    }

    fn bytes(&self) -> Vec<u8> {
        std::fs::read(self.path()).expect("a journal")
    }
}

/// Requests `count` values of two stages and of a grid; returns how many had to be computed.
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
fn contract_known_values_are_not_computed_again() {
    let desk = Desk::new();
    assert_eq!(ask(&desk.open(), 5), 20);
    let before = desk.bytes();
    let again = desk.open();
    assert_eq!((again.known(), ask(&again, 5)), (20, 0));
    assert_eq!(desk.bytes(), before, "no line is doubled");
    assert_eq!(ask(&desk.open(), 7), 8);
    assert_eq!(ask(&desk.open(), 7), 0);
}

/// A run of three designs, its journal, and its lines.
fn whole() -> (Desk, Vec<u8>, Vec<String>) {
    let desk = Desk::new();
    assert_eq!(ask(&desk.open(), 3), 12);
    let (bytes, lines) = (desk.bytes(), desk.lines());
    (desk, bytes, lines)
}

/// The positions whose damage is repaired, which takes time: both sides of each line end, and every third position.
fn is_looked_at(whole: &[u8], place: usize) -> bool {
    let ends = |place: usize| whole.get(place) == Some(&b'\n');
    place.is_multiple_of(3) || ends(place) || ends(place.wrapping_sub(1)) || place == whole.len()
}

#[test]
fn contract_a_journal_cut_anywhere_goes_on() {
    let (desk, whole, lines) = whole();
    let head = whole.iter().position(|byte| *byte == b'\n').expect("a line") + 1;
    for length in (0..=whole.len()).filter(|length| is_looked_at(&whole, *length)) {
        desk.put(&whole[..length]);
        let Some((journal, damage)) = desk.try_open() else {
            assert!((1..head).contains(&length), "cut at byte {length}");
            continue;
        };
        let kept = whole[..length].iter().filter(|byte| **byte == b'\n').count();
        assert_eq!(ask(&journal, 3), 12 - kept.saturating_sub(1), "cut at byte {length}");
        assert_eq!(damage.lines > 0, length > 0 && whole[length - 1] != b'\n', "cut at byte {length}");
        assert_eq!(desk.bytes(), whole, "cut at byte {length}");
    }
    for start in (1..whole.len()).filter(|start| is_looked_at(&whole, *start)) {
        desk.put(&whole[start..]);
        let Some((journal, damage)) = desk.try_open() else {
            assert!(whole.len() - start < 60, "only the last line: cut before byte {start}");
            continue;
        };
        assert!(damage.head, "cut before byte {start}");
        let kept = whole[start - 1..].iter().filter(|byte| **byte == b'\n').count() - 1;
        assert_eq!(ask(&journal, 3), 12 - kept.min(12), "cut before byte {start}");
        assert_eq!(desk.lines(), lines, "cut before byte {start}");
    }
}

/// A flipped bit costs at most the record it hits and, where it joins two lines, the next one; it is always reported.
#[test]
fn contract_any_flipped_bit_is_told_and_costs_no_more_than_its_record() {
    let (desk, whole, lines) = whole();
    let head = whole.iter().position(|byte| *byte == b'\n').expect("a line");
    for place in 0..whole.len() {
        for bit in 0..8 {
            let mut flipped = whole.clone();
            flipped[place] ^= 1 << bit;
            desk.put(&flipped);
            let found = read(&desk.path(), &Identity::of("study")).expect("a journal");
            let State::Work(_, known, damage) = found else { panic!("byte {place}, bit {bit}: {found:?}") };
            let most = if whole[place] == b'\n' { 2 } else { u64::from(place > head) };
            assert!(!damage.is_none() && known.lines + most >= 12, "byte {place}, bit {bit}");
            assert_eq!(damage.head, place <= head, "byte {place}, bit {bit}");
            if bit != place % 8 || !is_looked_at(&whole, place) {
                continue; // repair is slow
            }
            let (journal, _) = desk.try_open().expect("a journal");
            assert_eq!(ask(&journal, 3) as u64, 12 - known.lines, "byte {place}, bit {bit}");
            assert_eq!(desk.lines(), lines, "byte {place}, bit {bit}");
            let (_, damage) = desk.try_open().expect("mended");
            assert!(damage.is_none(), "byte {place}, bit {bit}: told once");
        }
    }
}

#[test]
fn contract_what_no_flip_makes_is_survived_as_well() {
    let (desk, whole, lines) = whole();
    let head = whole.iter().position(|byte| *byte == b'\n').expect("a line") + 1;
    let middle = head + whole[head..].len() / 2;
    let with = |what: &[u8]| [&whole[..middle], what, &whole[middle..]].concat();
    let (zeros, huge) = (vec![0_u8; 8192], vec![b'x'; 5_000_000]);
    for (name, bytes, most) in [
        ("pages of zeros in the middle", with(&zeros), 1),
        ("pages of zeros at the end", [&whole[..], &zeros].concat(), 0),
        ("a page of zeros instead of the end", [&whole[..middle], &zeros].concat(), 12),
        ("a huge line", with(&huge), 1),
        ("what is not UTF-8", with(&[0xff, 0xfe, b'\n', 0xc3]), 1),
        ("empty lines", with(b"\n\n"), 1),
        ("all twice, its first line, too", [&whole[..], &whole].concat(), 0),
        ("records twice", [&whole[..], &whole[head..]].concat(), 0),
        ("no first line", whole[head..].to_vec(), 0),
        ("zeros for a first line", [&vec![0; head][..], &whole[head..]].concat(), 1),
    ] {
        desk.put(&bytes);
        let (journal, damage) = desk.try_open().unwrap_or_else(|| panic!("{name}"));
        assert_eq!(damage.is_none(), name.contains("twice"), "{name}");
        assert!(journal.known() <= 12, "{name}: a record counts once");
        assert!(ask(&journal, 3) <= most, "{name}");
        let mut found = desk.lines();
        found.dedup();
        assert_eq!(found, lines, "{name}");
    }
}

/// Values are looked up by design, not by study: those of another study must never be returned.
#[test]
fn contract_the_work_of_another_study_is_never_believed() {
    let (desk, whole, _) = whole();
    let other = Identity::of("another study");
    let strange = Desk::new();
    let journal = Journal::begin(&strange.path(), &other).expect("a journal");
    journal.value("one", &[0.0, 1.0], f64::INFINITY, || 666.0, |_| {});
    let records = strange.bytes();
    let head = records.iter().position(|byte| *byte == b'\n').expect("a line") + 1;

    desk.put([&whole[..], &records].concat());
    assert!(desk.try_open().is_none(), "one after the other");
    desk.put([&records[..], &whole].concat());
    let found = read(&desk.path(), &Identity::of("study")).expect("a journal");
    assert!(matches!(found, State::Unclear(_)), "{found:?}");
    desk.put([&b"#"[..], &records[1..]].concat());
    assert!(desk.try_open().is_none(), "a damaged first line");
    desk.put([&whole[..], &records[head..]].concat());
    let (journal, damage) = desk.try_open().expect("a journal");
    assert_eq!((damage.lines, ask(&journal, 3)), (1, 0), "no first line: its records are damage");
}

#[test]
fn contract_failed_values_are_computed_again_but_written_once() {
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
fn contract_marks_are_kept() {
    let desk = Desk::new();
    desk.open().mark("figure3");
    let again = desk.open();
    assert!(again.is_marked("figure3") && !again.is_marked("figure4"));
}

#[test]
fn contract_parts_are_kept_and_are_no_results() {
    let desk = Desk::new();
    desk.open().note_part("k1-30000/ssvi");
    let again = desk.open();
    again.note_part("k1-30000/ssvi");
    assert_eq!(again.parts().iter().collect::<Vec<_>>(), ["k1-30000/ssvi"]);
    assert!(again.is_empty());
    assert_eq!(desk.lines().len(), 2);
}

#[test]
fn contract_a_file_that_is_no_journal_is_left_alone() {
    let desk = Desk::new();
    let identity = Identity::of("study");
    let found = || read(&desk.path(), &identity).expect("read");
    assert!(matches!(found(), State::Nothing), "no file");
    desk.put("");
    assert!(matches!(found(), State::Nothing), "an empty file");
    for text in [&b"something else\n"[..], b"x", b"\n", &[0; 4096], b"retune-journal-1 study=1\n"] {
        desk.put(text);
        assert!(matches!(found(), State::Unclear(_)), "{text:?}");
        assert_eq!(desk.bytes(), text);
    }
}

/// The file name of a journal can be guessed.
#[cfg(unix)]
#[test]
fn contract_no_link_is_followed() {
    let desk = Desk::new();
    let treasure = desk.0.path().join("treasure");
    std::fs::write(&treasure, "").expect("a file");
    std::os::unix::fs::symlink(&treasure, desk.path()).expect("a link");
    let identity = Identity::of("study");
    assert!(read(&desk.path(), &identity).is_err());
    assert!(Journal::begin(&desk.path(), &identity).is_err());
    assert!(Journal::resume(&desk.path(), &identity, Known::default(), Damage::default()).is_err());
    assert_eq!(std::fs::read(&treasure).expect("the file"), b"");
}
