//! Single runs of one method at one tolerance, by Retune and by other programs, and their rows in `runs.csv`.

use crate::scenes::Case;
use retune_jobs::methods;
use retune_model::{Coupled, Side};
use retune_solver::methods::{Dop853, Euler, Ode23, Ode23s, Ode45, Rk4, Run};
use retune_solver::observe::{Observer, Segment};
use retune_solver::{
    Contacts, Hybrid, Method, Motion, Phase, Settings, SolverError, Window, e1_max, simulate, touch_downs,
};
use std::fmt::Write;
use std::process::{Command, Stdio};
use std::time::Instant;
use std::{fs, io};

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Found {
    /// J.
    pub e1_max: f64,
    /// `[x1, v1, x2, v2]` at the end.
    pub final_state: [f64; 4],
    /// Touch-downs, s; `None` if only their number is known.
    pub touches: Option<Vec<f64>>,
    /// Number of touch-downs.
    pub impacts: usize,
    /// Evaluations of the right-hand side and its Jacobian (for the hybrid, each step counts as one).
    pub evaluations: u64,
    pub time: Timing,
}

/// The least time of several runs, s, and the relative excess of their median; the latter is NaN for one run, both for none.
#[derive(Clone, Copy, Debug)]
pub struct Timing {
    pub least: f64,
    pub spread: f64,
}

impl Timing {
    pub const NONE: Self = Self { least: f64::NAN, spread: f64::NAN };
}

/// A run and its result, or the reason why it failed.
#[derive(Clone, Debug)]
pub struct Row {
    pub scene: &'static str,
    pub program: String,
    pub method: String,
    /// `located`, `stepped` or, for the hybrid, `exact`.
    pub contacts: &'static str,
    /// Tolerance, or step of a method of fixed step (s).
    pub setting: f64,
    pub found: Result<Found, String>,
    /// Against the reference: E1max, final state, impact times.
    pub errors: [f64; 3],
    /// Touch-downs of the reference.
    pub expected_impacts: usize,
}

/// Relative errors of E1max and of the final state (positions weighted by ω), and the largest error of an impact time (s), NaN
/// if the counts differ.
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
    /// The row of a run.
    pub fn of(
        case: &Case,
        reference: &Found,
        (program, method, contacts): (&str, &str, &'static str),
        setting: f64,
        found: Result<Found, String>,
    ) -> Self {
        Self {
            scene: case.name,
            program: program.to_string(),
            method: method.to_string(),
            contacts,
            setting,
            errors: found.as_ref().map_or([f64::NAN; 3], |f| errors(f, reference, case.omega())),
            found,
            expected_impacts: reference.impacts,
        }
    }

    /// The name of the method with its program, unless it is Retune's.
    pub fn name(&self) -> String {
        match self.program.split(' ').next().unwrap_or_default() {
            "retune" => self.method.clone(),
            program => format!("{program} {}", self.method),
        }
    }

    /// Cost: seconds, or evaluations.
    pub fn cost(&self, in_time: bool) -> Option<f64> {
        let found = self.found.as_ref().ok()?;
        Some(if in_time { found.time.least } else { found.evaluations as f64 })
    }

    /// Whether its setting is this one.
    pub fn is_at(&self, setting: f64) -> bool {
        (self.setting / setting).ln().abs() < 0.1
    }
}

const HEAD: &str = "scene,program,method,contacts,setting,seconds,spread,evaluations,E1max,E1max_error,state_error,impact_time_error,impacts,\
                    expected_impacts,failure";

/// The table.
pub fn csv(rows: &[Row]) -> String {
    let mut text = format!("{HEAD}\n");
    for row in rows {
        let _ =
            write!(text, "{},{},{},{},{:e},", row.scene, row.program, row.method, row.contacts, row.setting);
        let _ = match &row.found {
            Ok(f) => writeln!(
                text,
                "{:.3e},{:.3},{},{:?},{:.3e},{:.3e},{:.3e},{},{},",
                f.time.least,
                f.time.spread,
                f.evaluations,
                f.e1_max,
                row.errors[0],
                row.errors[1],
                row.errors[2],
                f.impacts,
                row.expected_impacts
            ),
            Err(why) => writeln!(text, ",,,,,,,,{},{}", row.expected_impacts, why.replace([',', '\n'], ";")),
        };
    }
    text
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or(f64::NAN)
}

/// Reads a table written by [`csv`] for the given scene names; it has no states and no touch-down times.
pub fn parse(text: &str, scenes: &[&'static str]) -> Vec<Row> {
    let columns: Vec<&str> = HEAD.split(',').collect();
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let field = |name: &str| fields.get(columns.iter().position(|column| *column == name)?).copied();
        let count = |name: &str| field(name).map_or(f64::NAN, number);
        let found = Found {
            e1_max: count("E1max"),
            final_state: [f64::NAN; 4],
            touches: None,
            impacts: count("impacts") as usize,
            evaluations: count("evaluations") as u64,
            time: Timing { least: count("seconds"), spread: count("spread") },
        };
        let (scene, contacts, failure) = (field("scene")?, field("contacts")?, field("failure")?);
        Some(Row {
            scene: scenes.iter().find(|s| **s == scene)?,
            program: field("program")?.to_owned(),
            method: field("method")?.to_owned(),
            contacts: ["exact", "located", "stepped"].into_iter().find(|c| *c == contacts)?,
            setting: count("setting"),
            found: if failure.is_empty() { Ok(found) } else { Err(failure.to_owned()) },
            errors: ["E1max_error", "state_error", "impact_time_error"].map(count),
            expected_impacts: count("expected_impacts") as usize,
        })
    };
    text.lines().skip(1).filter_map(line).collect()
}

/// Times a run repeatedly: after a warm-up, 100 times if it takes less than a millisecond, else fewer.
pub fn timed<T>(mut run: impl FnMut() -> T) -> Timing {
    let mut once = || {
        let begun = Instant::now();
        std::hint::black_box(run());
        begun.elapsed().as_secs_f64()
    };
    let count = match once() {
        t if t < 1e-3 => 100,
        t if t < 0.02 => 6,
        t if t < 0.15 => 2,
        t => return Timing { least: t, ..Timing::NONE },
    };
    let mut times: Vec<f64> = (0..count).map(|_| once()).collect();
    times.sort_by(f64::total_cmp);
    Timing { least: times[0], spread: times[count / 2] / times[0] - 1.0 }
}

/// Most steps of a run.
pub const MOST_STEPS: u64 = 3_000_000;

/// Settings of a method at a tolerance, or at a step.
pub fn settings(method: Method, contacts: Contacts, setting: f64) -> Settings {
    methods::settings(method, contacts, setting, MOST_STEPS)
}

/// All results of one run; the time is that of computing E1max alone.
pub fn run(case: &Case, settings: &Settings, is_timed: bool) -> Result<Found, String> {
    let window = Window { from: 0.0, to: case.to };
    let response = simulate(&case.scene, window, settings).map_err(|e| e.to_string())?;
    let touches = touch_downs(&case.scene, window, settings).map_err(|e| e.to_string())?;
    let time =
        if is_timed { timed(|| e1_max(&case.scene, window, settings, f64::INFINITY)) } else { Timing::NONE };
    Ok(Found {
        e1_max: response.e1_max.value,
        final_state: response.final_state,
        impacts: touches.len(),
        touches: Some(touches.into_iter().map(|(t, _)| t).collect()),
        evaluations: methods::evaluations(settings.method, &response),
        time,
    })
}

/// Integrates a motion from a state of flight at t = 0 to time `to` (s) or until the observer is satisfied; returns the state
/// reached.
pub fn follow(
    system: &Coupled,
    start: [f64; 4],
    to: f64,
    settings: &Settings,
    observer: &mut dyn Observer<4>,
) -> Result<[f64; 4], SolverError> {
    let mut run = Run::new(system, settings, 0.0, start, settings.longest_step(to));
    match settings.method {
        Method::Hybrid => {
            let begin = Motion { t: 0.0, y: start, phase: Phase::Flight };
            let mut hybrid = Hybrid::new(system, settings.rtol, to, settings.max_steps);
            return Ok(hybrid.propagate(begin, to, observer)?.y);
        }
        Method::Ode23s => run.integrate::<Ode23s>(to, observer),
        Method::Ode45 => run.integrate::<Ode45>(to, observer),
        Method::Ode23 => run.integrate::<Ode23>(to, observer),
        Method::Dop853 => run.integrate::<Dop853>(to, observer),
        Method::Rk4 => run.integrate::<Rk4>(to, observer),
        Method::Euler => run.integrate::<Euler>(to, observer),
    }?;
    Ok(run.state())
}

/// Counts touch-downs, and is satisfied after `enough`.
pub struct Touches {
    pub count: u64,
    pub enough: u64,
}

impl Observer<4> for Touches {
    fn segment(&mut self, _segment: &dyn Segment<4>) {}
    fn touch_down(&mut self, _t: f64, _side: Side) {
        self.count += 1;
    }
    fn satisfied(&self) -> bool {
        self.count >= self.enough
    }
}

/// The treatments of contacts that a method supports, each with its name.
pub fn ways(method: Method) -> &'static [(Contacts, &'static str)] {
    match method {
        Method::Hybrid => &[(Contacts::Located, "exact")],
        _ => &[(Contacts::Located, "located"), (Contacts::Stepped, "stepped")],
    }
}

/// The name of the treatment of contacts.
pub fn way(settings: &Settings) -> &'static str {
    let own = ways(settings.method).iter().find(|(contacts, _)| *contacts == settings.contacts);
    own.map_or("exact", |(_, name)| name)
}

/// CVODE on the scenes of a file, compiled by the recipes from C.
const CVODE: &str = "target/cvode";

/// The output of CVODE for the scenes of a file; `None` if it has not been built.
pub fn cvode(scenes: &str) -> Option<String> {
    let output = Command::new(CVODE).arg(scenes).stderr(Stdio::null()).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Tables of the runs of interpreted programs, made by `just lab accuracy-external`.
const TABLES: [&str; 2] = ["tests/reference/external/octave.csv", "tests/reference/external/scipy.csv"];

/// The lines of those tables; a missing one is skipped.
pub fn external() -> io::Result<String> {
    let mut all = String::new();
    for table in TABLES {
        match fs::read_to_string(table) {
            Ok(text) => all += &text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
    }
    Ok(all)
}

/// The rows of a scene in a table of other programs, which give the number of contacts, not their times.
pub fn of_table(table: &str, case: &Case, reference: &Found) -> Vec<Row> {
    table.lines().filter_map(|line| external_row(line, case, reference)).collect()
}

fn external_row(line: &str, case: &Case, reference: &Found) -> Option<Row> {
    let fields: Vec<&str> = line.split(',').collect();
    let (fields, spread) = fields.split_at_checked(13)?;
    let [program, method, scene, setting, seconds, evaluations, e1_max, x1, v1, x2, v2, impacts, failure] =
        fields.try_into().ok()?;
    if scene != case.name.replace(',', ";") {
        return None;
    }
    let mut found = Found {
        e1_max: number(e1_max),
        final_state: [x1, v1, x2, v2].map(number),
        touches: None,
        impacts: number(impacts) as usize,
        evaluations: number(evaluations) as u64,
        time: Timing { least: number(seconds), spread: spread.first().map_or(f64::NAN, |text| number(text)) },
    };
    if case.scene.damper.is_none() {
        (found.final_state[2], found.final_state[3]) = (0.0, 0.0);
    }
    let (method, contacts) = match method.strip_suffix(" located") {
        Some(method) => (method, "located"),
        None if program.starts_with("GNU") => (method, "stepped"),
        None => (method, "located"),
    };
    Some(Row::of(
        case,
        reference,
        (program.trim_start_matches("GNU "), method, contacts),
        number(setting),
        if failure.is_empty() { Ok(found) } else { Err(failure.to_string()) },
    ))
}
