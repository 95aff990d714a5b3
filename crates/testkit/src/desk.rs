//! A directory to work in, and studies of a few runs.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A directory to work in.
pub struct Desk(TempDir);

impl Default for Desk {
    fn default() -> Self {
        Self::new()
    }
}

impl Desk {
    /// An empty directory.
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary directory"))
    }

    /// A directory with the study `study.json`.
    pub fn with(study: &Value) -> Self {
        let desk = Self::new();
        desk.write_json("study.json", study);
        desk
    }

    /// A directory with the paper's table and the studies of its two dampers at one frequency, each modified by `change`.
    pub fn with_table2(table: &str, change: impl Fn(&mut Value)) -> Self {
        let desk = Self::new();
        let mut rows = committed("table2.json");
        for (row, name) in ["ssvi", "tmd"].into_iter().enumerate() {
            let (mut study, file) = (committed(&format!("{name}-resonance.json")), format!("{name}.json"));
            change(&mut study);
            few_starts(&mut study);
            desk.write_json(&file, &study);
            rows["rows"][row]["study"] = json!(file);
        }
        desk.write_json(table, &rows);
        desk
    }

    /// The path of a file or directory.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, creating its directories.
    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a directory")).expect("a directory");
        std::fs::write(path, text).expect("a file");
    }

    /// Writes a JSON file.
    pub fn write_json(&self, name: &str, value: &Value) {
        self.write(name, serde_json::to_string_pretty(value).expect("JSON"));
    }

    /// The text of a file.
    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// The value in a JSON file.
    pub fn read_json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("JSON")
    }

    /// The fields of the lines of a table.
    pub fn rows(&self, name: &str) -> Vec<Vec<String>> {
        self.read(name).lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
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

    /// Every file below a directory with its bytes, and every directory.
    pub fn everything(&self, below: &str) -> BTreeMap<String, Vec<u8>> {
        let mut all = BTreeMap::new();
        for name in self.names(below) {
            let inner = format!("{below}/{name}");
            if self.path(&inner).is_dir() {
                let below = self.everything(&inner);
                all.extend(below.into_iter().map(|(rest, bytes)| (format!("{name}/{rest}"), bytes)));
                all.insert(name, Vec::new());
            } else {
                all.insert(name, std::fs::read(self.path(&inner)).expect("a file"));
            }
        }
        all
    }

    /// Removes a file, or a directory with all in it.
    pub fn remove(&self, name: &str) {
        let path = self.path(name);
        let removed = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
        removed.unwrap_or_else(|error| panic!("{name}: {error}"));
    }

    /// Asserts that both directories hold the same files.
    #[track_caller]
    pub fn assert_same(&self, one: &str, other: &str) {
        let [one, other] = [one, other].map(|below| self.everything(below));
        assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>());
        for (name, bytes) in &one {
            assert!(other[name] == *bytes, "{name} has other bytes");
        }
    }
}

/// The studies of the repository.
pub fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

/// A file among them.
pub fn committed(name: &str) -> Value {
    let text = std::fs::read_to_string(studies().join(name)).expect(name);
    serde_json::from_str(&text).expect("JSON")
}

/// Makes the certificate of a study quick: one start per frequency besides rest. The parts of a sum keep their own number.
pub fn few_starts(study: &mut Value) {
    let objective = &mut study["optimize"]["objective"];
    if objective.get("sum").is_none() {
        objective["starts"] = json!(1);
    }
}

/// A study of a few runs of a few seconds, with contacts.
pub fn tiny() -> Value {
    let mut study = committed("ssvi-resonance.json");
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
    few_starts(&mut study);
    study
}

/// The tiny study with another stiffness of the structure.
pub fn edited(k1: f64) -> Value {
    let mut study = tiny();
    study["scene"]["primary"]["k1"] = json!(k1);
    study
}

/// The tiny study with a global search instead of its grid.
pub fn global(objective: Value, limits: Value) -> Value {
    let mut study = tiny();
    study["optimize"] = json!({
        "vary": ["k2", "c2", "D", "C"],
        "bounds": { "k2": [10, 1000], "c2": [1, 500], "D": [0, 0.5], "C": [0, 0.5] },
        "objective": objective,
        "limits": limits,
        "global": { "samples": 24, "searches": 2, "evaluations": 40 },
        "refine": { "starts": 2, "MaxFunEvals": 30 }
    });
    few_starts(&mut study);
    study
}

/// A footbridge of 40 t and its TMD of 800 kg under a limit on the stroke, which makes a kink: a simplex alone stops there, at 16.66 J and
/// 26465 N/m.
pub fn footbridge() -> Value {
    json!({
        "name": "footbridge",
        "scene": {
            "primary": { "m1": 40000, "c1": 5027, "k1": 6.317e6 },
            "forcing": { "P": 280, "omega": 12.566 },
            "damper": { "m2": 800, "k2": 60000, "c2": 800 }
        },
        "window": { "t0": 0, "T": 10 },
        "optimize": {
            "vary": ["k2", "c2"],
            "objective": { "omega": { "from": 10, "to": 15 }, "response": "steady" },
            "limits": { "stroke": 0.0012 }
        }
    })
}

/// Its least E1max, J, at k2 = 120370 N/m: by SciPy's differential evolution of the closed form.
pub const FOOTBRIDGE: f64 = 13.934_90;

/// A study whose search takes about a second.
pub fn longer() -> Value {
    let mut study = tiny();
    study["window"] = json!({ "t0": 10, "T": 40 });
    for axis in study["optimize"]["surf"].as_object_mut().expect("axes").values_mut() {
        axis["points"] = json!(6);
    }
    study
}

/// The files that a search with a grid writes.
pub const RESULTS: [&str; 16] = [
    "certificate.json",
    "convergence.svg",
    "fminsearch-starts.csv",
    "fminsearch.csv",
    "fminsearch.txt",
    "manifest.json",
    "optimum.json",
    "report.html",
    "study.json",
    "surf-D-C.svg",
    "surf-c2-C.svg",
    "surf-c2-D.svg",
    "surf-k2-C.svg",
    "surf-k2-D.svg",
    "surf-k2-c2.svg",
    "surf.csv",
];

/// The number at a place in a JSON text.
#[track_caller]
pub fn number(json: &Value, path: &str) -> f64 {
    json.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path}: {json}"))
}

/// The text with the third decimal changed of the first number that has six or more.
pub fn altered(text: &str) -> String {
    let decimals = |rest: &str| rest.bytes().take_while(u8::is_ascii_digit).count();
    let mut points = text.match_indices('.').map(|(at, _)| at + 1);
    let at = 2 + points.find(|&at| decimals(&text[at..]) >= 6).expect("a number with decimals");
    let other = if &text[at..=at] == "7" { "3" } else { "7" };
    [&text[..at], other, &text[at + 1..]].concat()
}

/// Lines of a file; none where there is no file.
pub fn count_lines(path: &Path) -> usize {
    std::fs::read(path).map_or(0, |bytes| bytes.iter().filter(|byte| **byte == b'\n').count())
}

/// A text with its lines and paragraphs joined, so that line breaks do not matter.
pub fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
