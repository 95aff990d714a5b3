//! Runs that are stopped, killed, locked out or out of disk space: nothing is lost, and the final results
//! have the bytes of an uninterrupted run.

mod common;

use common::{Answer, Desk, assert_same, begun, count_lines, longer, started};
use serde_json::json;
use std::process::Command;
use std::time::{Duration, Instant};

/// A desk with that study and its results in `whole`.
fn desk() -> Desk {
    let desk = Desk::new();
    desk.write_json("study.json", &longer());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "whole"]);
    desk
}

const RUN: [&str; 5] = ["optimize", "study.json", "--quiet", "--out", "out"];

#[test]
fn contract_a_killed_run_resumes_and_ends_in_the_same_bytes() {
    let desk = desk();
    let mut child = begun(&desk, &RUN, "out", 200);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let kept = count_lines(&desk.path("out/unfinished/journal")) - 1;

    let Answer { code, stdout, stderr } = desk.run(&RUN);
    assert_eq!((code, stdout.as_str()), (Some(2), ""));
    let words = format!("error: out: unfinished work was found here ({kept} results are kept): ");
    assert_eq!(stderr, words + "--resume goes on with it, --restart begins anew\n");
    assert_eq!(count_lines(&desk.path("out/unfinished/journal")) - 1, kept, "it is still there");

    let said = desk.good(&["optimize", "study.json", "--out", "out", "--resume"]);
    assert!(said.starts_with(&format!("goes on: {kept} values are known\n")), "{said}");
    assert_same(&desk, "whole", "out");
}

/// A loop that retries until a run succeeds may run once more after it.
#[test]
fn contract_resuming_finished_work_computes_nothing() {
    let desk = desk();
    let before =
        std::fs::metadata(desk.path("whole/surf.csv")).and_then(|file| file.modified()).expect("a time");
    desk.write("whole/.lock", "4711 what a run that was killed as it ended left\n");
    let said = desk.good(&["optimize", "study.json", "--out", "whole", "--resume"]);
    assert!(said.starts_with("finished already: nothing to go on with\nresults in whole: "), "{said}");
    assert!(!desk.path("whole/.lock").exists());
    let after =
        std::fs::metadata(desk.path("whole/surf.csv")).and_then(|file| file.modified()).expect("a time");
    assert_eq!(before, after);
    let mut other = longer();
    other["window"] = json!({ "t0": 1, "T": 2 });
    desk.write_json("study.json", &other);
    let said = desk.good(&["optimize", "study.json", "--out", "whole", "--resume"]);
    assert!(said.starts_with("surf: "), "another study is not finished: {said}");
}

/// Not even root can write there.
#[cfg(target_os = "linux")]
#[test]
fn contract_a_directory_that_cannot_be_written_is_named() {
    let desk = Desk::new();
    desk.write_json("study.json", &longer());
    let Answer { code, stdout, stderr } = desk.run(&["optimize", "study.json", "--out", "/sys/kernel"]);
    assert_eq!((code, stdout.as_str()), (Some(2), ""));
    assert!(stderr.starts_with("error: /sys/kernel/.lock: cannot be written: "), "{stderr}");
}

#[test]
fn contract_unfinished_work_can_be_discarded() {
    let desk = desk();
    let mut child = begun(&desk, &RUN, "out", 50);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let said = desk.good(&["optimize", "study.json", "--out", "out", "--restart"]);
    assert!(said.starts_with("surf: "), "{said}");
    assert_same(&desk, "whole", "out");
}

/// The unfinished work of one study is neither mixed with that of another nor discarded for it.
#[test]
fn contract_unfinished_work_of_another_study_is_left_alone() {
    let desk = desk();
    let mut child = begun(&desk, &RUN, "out", 50);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let mut other = longer();
    other["scene"]["primary"]["k1"] = json!(3e4);
    desk.write_json("other.json", &other);
    for option in ["--quiet", "--resume"] {
        let Answer { code, stderr, .. } = desk.run(&["optimize", "other.json", "--out", "out", option]);
        assert_eq!(code, Some(2));
        assert!(stderr.contains("but it is of another study (SHA-256 "), "{stderr}");
        assert!(stderr.ends_with("or throw it away with --restart\n"), "{stderr}");
    }
    desk.good(&["optimize", "study.json", "--out", "out", "--resume", "--quiet"]);
    assert_same(&desk, "whole", "out");
}

#[test]
fn contract_two_runs_into_one_directory_are_refused() {
    let desk = desk();
    let mut child = begun(&desk, &RUN, "out", 20);
    for option in ["--quiet", "--resume", "--restart"] {
        let Answer { code, stderr, .. } = desk.run(&["optimize", "study.json", "--out", "out", option]);
        let words = format!(
            "error: out: another run (process {}) is at work here: wait for it, stop it, or choose another directory with --out\n",
            child.id()
        );
        assert_eq!((code, stderr), (Some(2), words));
    }
    assert!(child.wait().expect("the first run").success(), "it is not disturbed");
    assert_same(&desk, "whole", "out");
}

/// Until new results are complete, those of an earlier run stay unchanged.
#[test]
fn contract_earlier_results_outlive_a_run_that_is_killed_or_refused() {
    let desk = desk();
    let mut other = longer();
    other["scene"]["primary"]["k1"] = json!(3e4);
    desk.write_json("study.json", &other);
    let mut child = begun(&desk, &["optimize", "study.json", "--quiet", "--out", "whole"], "whole", 50);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let mut names = desk.names("whole");
    names.retain(|name| name != ".lock" && name != "unfinished");
    let manifest = desk.read_json("whole/manifest.json");
    let files = manifest["files"].as_object().expect("files");
    assert_eq!(names.len(), files.len() + 1);
    desk.write_json("study.json", &longer());
    desk.good(&["optimize", "study.json", "--quiet", "--out", "out"]);
    for name in files.keys() {
        assert_eq!(desk.read(&format!("whole/{name}")), desk.read(&format!("out/{name}")), "{name}");
    }
}

#[cfg(unix)]
#[test]
fn contract_ctrl_c_stops_within_a_second_and_says_how_to_resume() {
    for signal in ["INT", "TERM"] {
        let desk = desk();
        let mut child = begun(&desk, &RUN, "out", 100);
        let asked = Instant::now();
        let kill = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
        assert!(kill.expect("kill").success());
        let status = child.wait().expect("the run");
        assert!(asked.elapsed() < Duration::from_secs(1), "{:?}", asked.elapsed());
        assert_eq!(status.code(), Some(130), "{signal}");
        let mut said = String::new();
        std::io::Read::read_to_string(&mut child.stderr.take().expect("stderr"), &mut said).expect("text");
        let command = said.lines().last().expect("a line").trim();
        assert!(said.starts_with("\nstopped; what was computed is kept. To go on:\n"), "{said}");
        assert!(command.ends_with(" optimize study.json --quiet --out out --resume"), "{said}");
        let again = Command::new("sh").args(["-c", command]).current_dir(desk.path(".")).output();
        assert!(again.expect("the command it names").status.success());
        assert_same(&desk, "whole", "out");
    }
}

/// A run started through just resumes through just, whose recipes are named like the commands.
#[cfg(unix)]
#[test]
fn contract_a_run_through_just_goes_on_through_just() {
    let desk = Desk::new();
    desk.write_json("study.json", &longer());
    let mut command = desk.command(&RUN);
    command.env("RETUNE_RUN_AS", "just");
    let mut child = started(command, &desk, "out", 100);
    let kill = Command::new("kill").args(["-s", "INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill").success());
    assert_eq!(child.wait().expect("the run").code(), Some(130));
    let mut said = String::new();
    std::io::Read::read_to_string(&mut child.stderr.take().expect("stderr"), &mut said).expect("text");
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
    assert_same(&desk, "other", "whole");
}

#[test]
fn contract_table2_resumes_where_it_was_killed() {
    let desk = Desk::new();
    for name in ["ssvi.json", "tmd.json", "table2.json"] {
        desk.write(name, std::fs::read_to_string(common::studies().join(name)).expect(name));
    }
    let mut study = desk.read_json("ssvi.json");
    study["window"] = json!({ "t0": 50, "T": 150 });
    study["optimize"]["refine"] = json!({ "MaxFunEvals": 400, "TolX": 1e-9, "TolFun": 1e-9 });
    desk.write_json("ssvi.json", &study);
    desk.good(&["table2", "table2.json", "--quiet", "--out", "whole"]);
    let run = ["table2", "table2.json", "--quiet", "--out", "out"];
    let mut child = begun(&desk, &run, "out/ssvi", 30);
    child.kill().and_then(|()| child.wait()).expect("killed");
    let Answer { code, stderr, .. } = desk.run(&run);
    assert_eq!(code, Some(2));
    assert!(stderr.starts_with("error: out: unfinished work was found here ("), "{stderr}");
    desk.good(&["table2", "table2.json", "--quiet", "--out", "out", "--resume"]);
    assert_eq!(desk.names("whole"), desk.names("out"));
    for place in ["ssvi", "tmd"] {
        assert_same(&desk, &format!("whole/{place}"), &format!("out/{place}"));
    }
    assert_eq!(desk.read("whole/table2.csv"), desk.read("out/table2.csv"));
}

/// The global search resumes as well, with the counts of an uninterrupted one.
#[test]
fn contract_a_global_search_resumes_where_it_was_killed() {
    let desk = Desk::new();
    let mut study = longer();
    study["optimize"]["surf"] = json!(null);
    study["optimize"]["bounds"] =
        json!({ "k2": [50, 800], "c2": [50, 400], "D": [0.02, 0.2], "C": [0.05, 0.6] });
    study["optimize"]["global"] = json!({ "samples": 256, "searches": 2, "evaluations": 200 });
    desk.write_json("study.json", &study);
    desk.good(&["optimize", "study.json", "--quiet", "--out", "whole"]);
    for lines in [100, 400] {
        let mut child = begun(&desk, &RUN, "out", lines);
        child.kill().and_then(|()| child.wait()).expect("killed");
        desk.good(&["optimize", "study.json", "--quiet", "--out", "out", "--resume"]);
        assert_same(&desk, "whole", "out");
        std::fs::remove_dir_all(desk.path("out")).expect("the results");
    }
}
