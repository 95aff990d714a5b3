//! Runs of other programs (GNU Octave, SciPy, SUNDIALS), from the tables that their scripts wrote.

use crate::record::{Found, Row, errors};
use crate::scenes::Case;
use std::path::Path;
use std::{fs, io};

/// The tables, made by `just lab accuracy-external`.
const TABLES: [&str; 2] = ["tests/reference/external/octave.csv", "tests/reference/external/scipy.csv"];

/// The runs of a scene. The scripts give the number of contacts, not their times.
///
/// # Errors
/// A table that cannot be read; a missing one is an empty one.
pub fn rows(root: &Path, case: &Case, reference: &Found) -> io::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for table in TABLES {
        let text = match fs::read_to_string(root.join(table)) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            Err(error) => return Err(error),
        };
        rows.extend(text.lines().skip(1).filter_map(|line| parse(line, case, reference)));
    }
    Ok(rows)
}

fn parse(line: &str, case: &Case, reference: &Found) -> Option<Row> {
    let fields: Vec<&str> = line.split(',').collect();
    let [program, method, scene, setting, seconds, evaluations, e1_max, x1, v1, x2, v2, impacts, failure] =
        fields[..].try_into().ok()?;
    if scene != case.name {
        return None;
    }
    let number = |text: &str| text.parse::<f64>().unwrap_or(f64::NAN);
    let mut found = Found {
        e1_max: number(e1_max),
        final_state: [x1, v1, x2, v2].map(number),
        touches: None,
        impacts: number(impacts) as usize,
        evaluations: number(evaluations) as u64,
        seconds: number(seconds),
    };
    if case.scene.damper.is_none() {
        (found.final_state[2], found.final_state[3]) = (0.0, 0.0);
    }
    let (method, contacts) = match method.strip_suffix(" located") {
        Some(method) => (method, "located"),
        None if program.starts_with("GNU") => (method, "stepped"),
        None => (method, "located"),
    };
    Some(Row {
        scene: case.name,
        program: program.trim_start_matches("GNU ").to_string(),
        method: method.to_string(),
        contacts,
        setting: number(setting),
        errors: errors(&found, reference, case.scene.forcing.frequency.get()),
        found: if failure.is_empty() { Ok(found) } else { Err(failure.to_string()) },
        expected_impacts: reference.impacts,
    })
}
