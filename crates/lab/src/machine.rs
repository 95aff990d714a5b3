//! The machine, the compilers and the commit behind measured times: `machine.json` beside them.

use crate::Any;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The name of the file.
pub const NAME: &str = "machine.json";

/// The first line that a command prints; none if there is no such command.
fn first_line(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).lines().next()?.to_owned())
}

/// The current machine. The load is that of the last minute: above some 0.3 at the start, other processes are running.
pub fn this() -> Value {
    let system = |file: &str| fs::read_to_string(Path::new("/proc").join(file)).unwrap_or_default();
    let processor = system("cpuinfo").lines().find_map(|line| {
        Some(line.strip_prefix("model name")?.trim_start_matches([' ', '\t', ':']).to_owned())
    });
    json!({
        "processor": processor,
        "cores": std::thread::available_parallelism().map_or(1, usize::from),
        "load": system("loadavg").split(' ').next(),
        "rustc": first_line("rustc", &["--version"]),
        "cc": first_line("cc", &["--version"]),
        "commit": first_line("git", &["describe", "--always", "--dirty"]),
    })
}

/// The machine of a directory of results, in words.
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
