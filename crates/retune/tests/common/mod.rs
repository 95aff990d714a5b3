//! Runs the program as a user would, in a directory of its own.

#![allow(dead_code, reason = "each test file uses a part of this")]

use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A directory to work in.
pub struct Desk(TempDir);

/// The output of the program.
pub struct Answer {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Desk {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary directory"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a directory")).expect("a directory");
        std::fs::write(path, text).expect("a file");
    }

    pub fn write_json(&self, name: &str, value: &Value) {
        self.write(name, serde_json::to_string_pretty(value).expect("JSON"));
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn read_json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("JSON")
    }

    /// All files and directories below, sorted.
    pub fn names(&self, below: &str) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.path(below))
            .expect("a directory")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_retune"));
        // A `just test` must not be told from the tests.
        command.args(arguments).current_dir(self.0.path()).env_remove("RETUNE_RUN_AS");
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Answer {
        let Output { status, stdout, stderr } = self.command(arguments).output().expect("the program");
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Answer { code: status.code(), stdout: text(stdout), stderr: text(stderr) }
    }

    /// Runs a command that must succeed.
    pub fn good(&self, arguments: &[&str]) -> String {
        let Answer { code, stdout, stderr } = self.run(arguments);
        assert_eq!((code, stderr.as_str()), (Some(0), ""), "{arguments:?}");
        stdout
    }
}

/// A study of a few runs of a few seconds, with contacts.
pub fn tiny() -> Value {
    let mut study: Value = serde_json::from_str(
        &std::fs::read_to_string(studies().join("ssvi.json")).expect("the study of the paper"),
    )
    .expect("JSON");
    study["window"] = json!({ "t0": 1, "T": 4 });
    study["optimize"] = json!({
        "vary": ["k2", "c2", "D", "C"],
        "bounds": { "k2": [10, 1000] },
        "surf": {
            "k2": { "from": 100, "to": 400, "points": 3, "scale": "log" },
            "c2": { "from": 100, "to": 300, "points": 2 },
            "D": { "from": 0.05, "to": 0.1, "points": 2 },
            "C": { "from": 0.1, "to": 0.4, "points": 2 }
        },
        "refine": { "starts": 2, "apart": 1, "MaxFunEvals": 30 }
    });
    study
}

/// The text with the third decimal changed in its first number of six decimals or more.
pub fn altered(text: &str) -> String {
    let decimals = |rest: &str| rest.bytes().take_while(u8::is_ascii_digit).count();
    let mut points = text.match_indices('.').map(|(at, _)| at + 1);
    let at = 2 + points.find(|&at| decimals(&text[at..]) >= 6).expect("a number with decimals");
    let other = if &text[at..=at] == "7" { "3" } else { "7" };
    [&text[..at], other, &text[at + 1..]].concat()
}

/// The studies of the repository.
pub fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

/// A study whose search takes about a second.
pub fn longer() -> Value {
    let mut study = tiny();
    study["window"] = json!({ "t0": 10, "T": 40 });
    for axis in study["optimize"]["surf"].as_object_mut().expect("axes").values_mut() {
        axis["points"] = json!(6);
    }
    study
}

#[track_caller]
pub fn assert_same(desk: &Desk, one: &str, other: &str) {
    assert_eq!(desk.names(one), desk.names(other));
    for name in desk.names(one) {
        assert!(desk.read(&format!("{one}/{name}")) == desk.read(&format!("{other}/{name}")), "{name}");
    }
}

/// Starts a run and waits until its journal has `lines` lines.
pub fn begun(desk: &Desk, arguments: &[&str], out: &str, lines: usize) -> Child {
    started(desk.command(arguments), desk, out, lines)
}

/// The same for any command.
pub fn started(mut command: Command, desk: &Desk, out: &str, lines: usize) -> Child {
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program");
    let journal = desk.path(out).join("unfinished/journal");
    let patience = Instant::now();
    while count_lines(&journal) < lines {
        assert!(patience.elapsed() < Duration::from_secs(60), "the run does not begin");
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}

pub fn count_lines(path: &Path) -> usize {
    std::fs::read(path).map_or(0, |bytes| bytes.iter().filter(|byte| **byte == b'\n').count())
}
