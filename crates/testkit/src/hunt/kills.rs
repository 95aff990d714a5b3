//! Kills runs (SIGKILL) at random moments, repeatedly, until one completes. Its results must be identical to those of an uninterrupted
//! run, with no line lost or duplicated and no temporary file left.

use super::Hunt;
use crate::desk::{Desk, committed, tiny};
use retune_model::drawn_number;
use serde_json::json;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Random numbers in [0, 1), the same in every run of the tests.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        drawn_number(&mut self.0)
    }
}

/// A command that writes into `out`, with the directories of its journals.
struct Work {
    name: &'static str,
    arguments: &'static [&'static str],
    /// Directories of results with a journal.
    places: &'static [&'static str],
    /// Fraction of all kills.
    share: f64,
}

const WORKS: [Work; 4] = [
    Work { name: "optimize", arguments: &["optimize", "study.json"], places: &["out"], share: 0.4 },
    Work {
        name: "optimize --shard, merge",
        arguments: &["merge", "study.json"],
        places: &["out", "out/parts", "out/parts/00001-of-00002"],
        share: 0.2,
    },
    Work {
        name: "table2",
        arguments: &["table2", "table2.json"],
        places: &["out", "out/ssvi", "out/tmd"],
        share: 0.2,
    },
    Work {
        name: "figure 5",
        arguments: &["figure", "5", "--study", "paper.json"],
        places: &["out"],
        share: 0.2,
    },
];

/// Studies whose searches take a second or so.
fn desk() -> Desk {
    let desk = Desk::with_table2("table2.json", |_| {});
    let mut ssvi = desk.read_json("ssvi.json");
    ssvi["optimize"]["refine"] = json!({ "MaxFunEvals": 400, "TolX": 1e-9, "TolFun": 1e-9 });
    desk.write_json("ssvi.json", &ssvi);
    let mut study = tiny();
    study["window"] = json!({ "t0": 20, "T": 60 });
    for axis in study["optimize"]["surf"].as_object_mut().expect("axes").values_mut() {
        axis["points"] = json!(5);
    }
    study["optimize"]["refine"] = json!({ "starts": 3, "apart": 1, "MaxFunEvals": 300 });
    desk.write_json("study.json", &study);
    let mut plan = committed("paper.json");
    plan["omega"] = json!({ "from": 4, "to": 9, "points": 101 });
    plan["k1_range"] = json!({ "from": 2.0e4, "to": 6.0e4, "points": 21 });
    desk.write_json("paper.json", &plan);
    desk
}

/// The stage of a killed run, from the files it left.
fn stage(desk: &Desk, work: &Work) -> &'static str {
    let mut stage = "before anything was kept";
    for place in work.places {
        let unfinished = format!("{place}/unfinished");
        let Ok(journal) = std::fs::read_to_string(desk.path(&format!("{unfinished}/journal"))) else {
            continue;
        };
        let mut keys = HashSet::new();
        let whole = journal.lines().filter(|line| line.len() > 20);
        assert!(
            whole.skip(1).all(|line| keys.insert(line.rsplit_once(' ').map(|(text, _)| text))),
            "a line is doubled"
        );
        let written = desk.names(&unfinished);
        let has = |name: &str| written.iter().any(|other| other == name);
        let last = journal.lines().last().unwrap_or_default();
        stage = if has("manifest.json") || (has("journal") && !has("study.json") && last.starts_with('e')) {
            "putting results into place"
        } else if has("optimum.json") || has("fminsearch.csv") {
            "writing"
        } else {
            match last.get(..2) {
                Some("g ") => "grid",
                Some("e ") => "fminsearch",
                Some("m ") => "items of the paper",
                _ => stage,
            }
        };
    }
    stage
}

/// Starts the program in the directory of a desk.
fn start(program: &Path, desk: &Desk, arguments: &[&str], out: &[&str]) -> Child {
    let mut command = Command::new(program);
    command.current_dir(desk.path(".")).env_remove("RETUNE_RUN_AS").args(arguments);
    command.args(["--quiet", "--resume", "--out"]).args(out);
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program")
}

/// Waits for the end of a run, but kills it at `moment`; returns whether it ended before.
fn ends_before(child: &mut Child, moment: Duration) -> bool {
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("the program") {
            let mut said = String::new();
            let stderr = child.stderr.as_mut().expect("stderr");
            std::io::Read::read_to_string(stderr, &mut said).expect("text");
            assert!(status.success(), "{said}");
            return true;
        }
        if begun.elapsed() >= moment {
            child.kill().and_then(|()| child.wait()).expect("killed");
            return false;
        }
        std::thread::sleep(Duration::from_micros(200));
    }
}

/// Makes the parts that `merge` needs; these runs are killed as well.
fn make_parts(program: &Path, desk: &Desk, draw: &mut Draw, limit: Duration, count: &mut impl FnMut(&Desk)) {
    for shard in ["1/2", "2/2"] {
        loop {
            let mut child = start(program, desk, &["optimize", "study.json"], &["out", "--shard", shard]);
            if ends_before(&mut child, limit.mul_f64(draw.next())) {
                break;
            }
            count(desk);
        }
    }
}

/// Kills a program at least `kills` times.
pub fn kills(program: &Path, kills: usize) -> Hunt {
    let mut hunt = Hunt::default();
    let begin =
        |desk: &Desk, work: &Work, out: &str| start(program, desk, work.arguments, &[out, "--threads", "2"]);
    let desk = desk();
    let mut draw = Draw(20_261_121);
    let mut table: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    let mut endings = 0;
    for work in &WORKS {
        let is_merge = work.arguments[0] == "merge";
        if is_merge {
            make_parts(program, &desk, &mut draw, Duration::from_secs(600), &mut |_| {});
            std::fs::rename(desk.path("out/parts"), desk.path("whole/parts"))
                .or_else(|_| {
                    std::fs::create_dir_all(desk.path("whole"))
                        .and_then(|()| std::fs::rename(desk.path("out/parts"), desk.path("whole/parts")))
                })
                .expect("the parts");
        }
        let begun = Instant::now();
        assert!(ends_before(&mut begin(&desk, work, "whole"), Duration::from_secs(600)));
        let usual = begun.elapsed();
        let expected = desk.everything("whole");
        let wanted = (kills as f64 * work.share).ceil() as usize;
        let mut kills = 0;
        while kills < wanted {
            // Moments are uniform from the start of the program to somewhat beyond its whole duration.
            if is_merge {
                make_parts(program, &desk, &mut draw, usual, &mut |desk| {
                    kills += 1;
                    *table.entry((work.name, stage(desk, work))).or_default() += 1;
                });
            }
            loop {
                let mut child = begin(&desk, work, "out");
                // The last run may complete: work that no journal keeps could take nearly as long as the whole run, and would be cut off
                // forever.
                let moment =
                    if kills < wanted { usual.mul_f64(1.1 * draw.next()) } else { Duration::from_secs(600) };
                if ends_before(&mut child, moment) {
                    break;
                }
                kills += 1;
                *table.entry((work.name, stage(&desk, work))).or_default() += 1;
            }
            endings += 1;
            let found = desk.everything("out");
            let names = |of: &BTreeMap<String, Vec<u8>>| of.keys().cloned().collect::<Vec<_>>();
            hunt.check(names(&found) == names(&expected), || {
                format!("{}: {:?} instead of {:?}", work.name, names(&found), names(&expected))
            });
            for (name, bytes) in &expected {
                hunt.check(found.get(name).is_none_or(|found| found == bytes), || {
                    format!("{}: {name} has other bytes", work.name)
                });
            }
            std::fs::remove_dir_all(desk.path("out")).expect("the results");
        }
        std::fs::remove_dir_all(desk.path("whole")).expect("the results");
    }
    let total: usize = table.values().sum();
    for ((name, stage), count) in &table {
        hunt.row(format!("| {name} | {stage} | {count} |"));
    }
    hunt.row(format!(
        "\n{total} kills, {endings} runs that came to their end, every byte as in an unbroken run."
    ));
    hunt.check(total >= kills, || format!("{total} kills"));
    hunt
}
