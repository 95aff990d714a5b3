//! One run of one method at one tolerance, and its line in `runs.csv`.

use retune_workbench::verify::methods;
use std::fmt::Write;

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Found {
    /// Largest E1, J.
    pub e1_max: f64,
    /// `[x1, v1, x2, v2]` at the end.
    pub final_state: [f64; 4],
    /// Touch-downs, s; `None` if only their number is known.
    pub touches: Option<Vec<f64>>,
    /// Number of touch-downs.
    pub impacts: usize,
    /// Evaluations of the right-hand side and its Jacobian (for the hybrid, each step counts as one).
    pub evaluations: u64,
    /// Time of a run, s.
    pub seconds: f64,
}

/// A run and its result, or the reason why it failed.
#[derive(Clone, Debug)]
pub struct Row {
    /// Scene.
    pub scene: &'static str,
    /// Name of the program.
    pub program: String,
    /// Method.
    pub method: String,
    /// `located`, `stepped` or, for the hybrid, `exact`.
    pub contacts: &'static str,
    /// Tolerance, or step of a method of fixed step (s).
    pub setting: f64,
    /// Its result.
    pub found: Result<Found, String>,
    /// Its errors against the reference: E1max, final state, impact times.
    pub errors: [f64; 3],
    /// Touch-downs of the reference.
    pub expected_impacts: usize,
}

/// Relative errors of E1max and of the final state (positions weighed by ω), and the largest error of an impact time (s), NaN
/// where the counts differ.
pub fn errors(found: &Found, reference: &Found, omega: f64) -> [f64; 3] {
    let states = [found.final_state, reference.final_state];
    let [e1, state] = methods::errors([found.e1_max, reference.e1_max], states, omega);
    let times = match (&found.touches, &reference.touches) {
        (Some(a), Some(b)) if a.len() == b.len() => {
            a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        }
        _ => f64::NAN,
    };
    [e1, state, times]
}

impl Row {
    /// The name of the method with its program, unless it is Retune's.
    pub fn name(&self) -> String {
        let program = self.program.split(' ').next().unwrap_or_default();
        match program {
            "retune" => self.method.clone(),
            _ => format!("{program} {}", self.method),
        }
    }

    /// Cost: seconds, or evaluations.
    pub fn cost(&self, in_time: bool) -> Option<f64> {
        let found = self.found.as_ref().ok()?;
        Some(if in_time { found.seconds } else { found.evaluations as f64 })
    }
}

/// The table.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "scene,program,method,contacts,setting,seconds,evaluations,E1max,E1max_error,state_error,impact_time_error,impacts,expected_impacts,failure\n",
    );
    for row in rows {
        let _ =
            write!(text, "{},{},{},{},{:e},", row.scene, row.program, row.method, row.contacts, row.setting);
        let _ = match &row.found {
            Ok(f) => writeln!(
                text,
                "{:.3e},{},{:?},{:.3e},{:.3e},{:.3e},{},{},",
                f.seconds,
                f.evaluations,
                f.e1_max,
                row.errors[0],
                row.errors[1],
                row.errors[2],
                f.impacts,
                row.expected_impacts
            ),
            Err(why) => writeln!(text, ",,,,,,,{},{}", row.expected_impacts, why.replace([',', '\n'], ";")),
        };
    }
    text
}

/// Reads [`csv`]'s table back, for the names of scenes given; states and times of touch-downs are not in it.
pub fn parse(text: &str, scenes: &[&'static str]) -> Vec<Row> {
    let number = |text: &str| text.parse::<f64>().unwrap_or(f64::NAN);
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [
            scene,
            program,
            method,
            contacts,
            setting,
            seconds,
            evaluations,
            e1_max,
            e0,
            e1,
            e2,
            impacts,
            expected,
            failure,
        ] = fields[..].try_into().ok()?;
        let found = Found {
            e1_max: number(e1_max),
            final_state: [f64::NAN; 4],
            touches: None,
            impacts: number(impacts) as usize,
            evaluations: number(evaluations) as u64,
            seconds: number(seconds),
        };
        Some(Row {
            scene: scenes.iter().find(|s| **s == scene)?,
            program: program.to_string(),
            method: method.to_string(),
            contacts: ["exact", "located", "stepped"].into_iter().find(|c| *c == contacts)?,
            setting: number(setting),
            found: if failure.is_empty() { Ok(found) } else { Err(failure.to_string()) },
            errors: [e0, e1, e2].map(number),
            expected_impacts: number(expected) as usize,
        })
    };
    text.lines().skip(1).filter_map(line).collect()
}
