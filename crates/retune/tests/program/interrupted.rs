//! Processes that are stopped, killed, locked out or out of disk space: nothing is lost, and the final results have the bytes of
//! an uninterrupted run. (Where a run may be cut off is tried in the tests of `jobs` and in `kills.rs`.)

use crate::common::{Answer, Desk, Program, begun, started};
use retune_testkit::desk::{count_lines, longer};
use serde_json::json;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

/// A desk with that study and its results in `whole`.
fn desk() -> Desk {
    let desk = Desk::with(&longer());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "whole"]);
    desk
}

const RUN: [&str; 5] = ["optimize", "study.json", "--quiet", "--out", "out"];

/// Sends a signal to a run that has to stop because of it; returns what it says.
#[cfg(unix)]
fn stop(mut child: Child, signal: &str) -> String {
    let begun = Instant::now();
    let kill = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
    assert!(kill.expect("kill").success());
    let status = child.wait().expect("the run");
    assert!(begun.elapsed() < Duration::from_secs(1), "{:?}", begun.elapsed());
    assert_eq!(status.code(), Some(130), "{signal}");
    let mut said = String::new();
    std::io::Read::read_to_string(&mut child.stderr.take().expect("stderr"), &mut said).expect("text");
    said
}

#[test]
fn contract_a_killed_run_resumes_and_ends_in_the_same_bytes() {
    let desk = desk();
    let mut child = begun(&desk, &RUN, "out", 200);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let kept = count_lines(&desk.path("out/unfinished/journal")) - 1;
    let words = format!("error: out: unfinished work was found here ({kept} results are kept): ");
    assert_eq!(desk.refused(&RUN), words + "--resume continues it, --restart discards it\n");
    assert_eq!(count_lines(&desk.path("out/unfinished/journal")) - 1, kept, "it is still there");
    let said = desk.good(&["optimize", "study.json", "--out", "out", "--resume"]);
    assert!(said.starts_with(&format!("resumed: {kept} values are known\n")), "{said}");
    desk.assert_same("whole", "out");
}

#[test]
fn contract_a_damaged_journal_is_a_warning() {
    let desk = desk();
    let mut child = begun(&desk, &RUN, "out", 50);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let journal = "out/unfinished/journal";
    let mut bytes = std::fs::read(desk.path(journal)).expect("a journal");
    let kept = count_lines(&desk.path(journal)) - 2;
    let place = bytes.len() - 3;
    bytes[place] ^= 1;
    desk.write(journal, bytes);
    let Answer { code, stderr, .. } = desk.run(&[&RUN[..], &["--resume"]].concat());
    let words = "1 of its lines is damaged, and what it held is computed again";
    assert_eq!((code, stderr), (Some(0), format!("warning: {journal}: {words}; {kept} results are kept\n")));
    desk.assert_same("whole", "out");
}

#[test]
fn contract_two_runs_into_one_directory_are_refused() {
    let desk = desk();
    let mut child = begun(&desk, &RUN, "out", 20);
    for option in ["--quiet", "--resume", "--restart"] {
        let words = format!(
            "error: out: another run (process {}) is at work here: wait for it, stop it, or choose another directory with --out\n",
            child.id()
        );
        assert_eq!(desk.refused(&["optimize", "study.json", "--out", "out", option]), words);
    }
    assert!(child.wait().expect("the first run").success(), "it is not disturbed");
    desk.assert_same("whole", "out");
}

#[cfg(unix)]
#[test]
fn contract_ctrl_c_stops_within_a_second_and_says_how_to_resume() {
    let desk = desk();
    for signal in ["INT", "TERM"] {
        let said = stop(begun(&desk, &RUN, "out", 100), signal);
        let command = said.lines().last().expect("a line").trim();
        assert!(said.starts_with("\nstopped; what was computed is kept. To resume:\n"), "{said}");
        assert!(command.ends_with(" optimize study.json --quiet --out out --resume"), "{said}");
        let again = Command::new("sh").args(["-c", command]).current_dir(desk.path(".")).output();
        assert!(again.expect("the command it names").status.success());
        desk.assert_same("whole", "out");
        desk.remove("out");
    }
}

/// A run started through just resumes through just, whose recipes are named like the commands.
#[cfg(unix)]
#[test]
fn contract_a_run_through_just_goes_on_through_just() {
    let desk = Desk::with(&longer());
    let mut command = desk.command(&RUN);
    command.env("RETUNE_RUN_AS", "just");
    let said = stop(started(command, &desk, "out", 100), "INT");
    let command = said.lines().last().expect("a line");
    assert_eq!(command, "  just optimize study.json --quiet --out out --resume");
}

/// A file size limit stands for a full disk: both make a write fail half-way through a line.
#[cfg(unix)]
#[test]
fn contract_a_full_disk_is_named_and_costs_nothing() {
    let desk = desk();
    let mut other = longer();
    other["scene"]["primary"]["k1"] = json!(3e4);
    desk.write_json("study.json", &other);
    desk.good(&["optimize", "study.json", "--quiet", "--out", "other"]);
    let program = env!("CARGO_BIN_EXE_retune");
    let script = format!(
        "trap '' XFSZ; ulimit -f 16; exec '{program}' optimize study.json --quiet --out whole --threads 2"
    );
    let limited = Command::new("sh").args(["-c", &script]).current_dir(desk.path(".")).output();
    let limited = limited.expect("the program");
    let said = String::from_utf8_lossy(&limited.stderr).into_owned();
    assert_eq!(limited.status.code(), Some(2), "{said}");
    assert!(said.starts_with("error: whole/unfinished/journal: cannot be written: File too large"), "{said}");
    let kept = desk.read_json("whole/manifest.json");
    assert_ne!(kept["study_sha256"], desk.read_json("other/manifest.json")["study_sha256"]);
    assert!(desk.path("whole/surf.csv").exists(), "earlier results are intact");
    let Answer { code, stderr, .. } =
        desk.run(&["optimize", "study.json", "--quiet", "--out", "whole", "--resume"]);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(
        stderr.is_empty() || stderr.contains("1 of its lines is damaged"),
        "half a line is told: {stderr}"
    );
    desk.assert_same("other", "whole");
}
