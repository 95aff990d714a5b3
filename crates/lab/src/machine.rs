//! The machine, the compilers and the commit behind measured times: `machine.json` beside them.

use crate::Any;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Its file.
pub const NAME: &str = "machine.json";

/// The first line that a command prints; none where there is no such command.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).lines().next()?.to_owned())
}

/// What it is now. The load is that of the last minute: above some 0.3 before a start, others are at work.
pub fn this() -> Value {
    let system = |file: &str| fs::read_to_string(Path::new("/proc").join(file)).unwrap_or_default();
    let processor = system("cpuinfo").lines().find_map(|line| {
        Some(line.strip_prefix("model name")?.trim_start_matches([' ', '\t', ':']).to_owned())
    });
    json!({
        "processor": processor,
        "cores": std::thread::available_parallelism().map_or(1, usize::from),
        "load": system("loadavg").split(' ').next(),
        "rustc": said("rustc", &["--version"]),
        "cc": said("cc", &["--version"]),
        "commit": said("git", &["describe", "--always", "--dirty"]),
    })
}

/// That of a directory of results, in words.
pub fn words_of(folder: &Path) -> Any<String> {
    Ok(words(&serde_json::from_str(&fs::read_to_string(folder.join(NAME))?)?))
}

/// A machine in words.
pub fn words(machine: &Value) -> String {
    let text = |name: &str| machine[name].as_str().unwrap_or("not known").to_owned();
    format!(
        "{}, {} cores, load {} at the start; {}; {}; commit {}",
        text("processor"),
        machine["cores"],
        text("load"),
        text("rustc"),
        text("cc"),
        text("commit")
    )
}
