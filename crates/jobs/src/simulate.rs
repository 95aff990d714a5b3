//! `simulate`: one run.

use crate::Error;
use crate::contacts::{Contacts, Powers};
use crate::summary::{Summary, digits};
use retune_model::{Measure, Rms, Stationary};
use retune_solver::{LEFT, Rows, Sample, decay_time, simulate_in_detail, trajectory};
use retune_store::{Pending, order::may_write};
use retune_study::{Study, hertz_and_rpm};
use serde::Serialize;
use std::path::Path;

const MOST_ROWS: u32 = 100_000_000;

/// The beginning of every trajectory file, of this and earlier versions, by which it is recognised.
const HEAD: &str = "t,x1,v1,x2,v2,";

/// The output of the motion of a run.
#[derive(Clone, Copy, Debug)]
pub struct Trajectory<'a> {
    /// The file.
    pub file: &'a Path,
    /// Time between equidistant rows, s.
    pub interval: f64,
    /// Files that it must not replace.
    pub inputs: &'a [&'a Path],
}

/// Runs the scene of a study.
///
/// # Errors
/// The run fails, or the trajectory cannot be written.
pub fn simulate(study: &Study, trajectory: Option<Trajectory>) -> Result<Simulation, Error> {
    if let Some(Trajectory { file, inputs, .. }) = trajectory {
        may_write(file, inputs, HEAD)?;
    }
    let (window, settings) = (study.window.window(), study.solver.settings());
    let (response, losses, collisions) = simulate_in_detail(&study.scene, window, &settings)?;
    let contacts = Contacts::new(&study.scene, collisions);
    let decay_time = decay_time(&study.scene, window.to, &settings)?;
    if let Some(Trajectory { file, interval, .. }) = trajectory {
        write_trajectory(study, file, interval)?;
    }
    let summary = Summary::new(study, study.scene, &response);
    let [hertz, rpm] = hertz_and_rpm(summary.omega());
    let transmissibility = summary.transmissibility();
    let powers = Powers::new(losses, window.to - window.from);
    let warnings = contacts.iter().flat_map(Contacts::warnings).collect();
    let transient = study.transient();
    let stationary = Means::of(study);
    Ok(Simulation {
        summary,
        hertz,
        rpm,
        transmissibility,
        decay_time,
        contacts,
        powers,
        warnings,
        transient,
        stationary,
    })
}

/// One run as shown on the command line: its summary, with derived quantities in engineering units.
#[derive(Clone, Debug, Serialize)]
pub struct Simulation {
    /// The observations in the window.
    #[serde(flatten)]
    pub summary: Summary,
    /// Frequency of the force, Hz and revolutions per minute.
    #[serde(rename = "f_Hz")]
    hertz: f64,
    #[serde(rename = "n_rpm")]
    rpm: f64,
    /// As [`Summary::transmissibility`].
    transmissibility: Option<f64>,
    /// As [`retune_solver::decay_time`]; null if that is not within the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    decay_time: Option<f64>,
    /// The contacts; null if no wall is touched.
    contacts: Option<Contacts>,
    /// The dissipated powers, W.
    #[serde(rename = "power_lost")]
    powers: Powers,
    /// Warnings where the contact law is used outside its range of validity.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    warnings: Vec<String>,
    /// A note on the transient in the window.
    #[serde(skip_serializing_if = "Option::is_none")]
    transient: Option<String>,
    /// The stationary motion under the spectrum from which the force is drawn; none for other forcings or a damper with walls.
    #[serde(skip_serializing_if = "Option::is_none")]
    stationary: Option<Means>,
}

/// The mean energy and the root mean squares of a stationary random motion, SI units.
#[derive(Clone, Debug)]
struct Means(Stationary);

impl Means {
    fn of(study: &Study) -> Option<Self> {
        if study.scene.damper.is_some_and(|damper| damper.contact.is_some()) {
            return None;
        }
        Stationary::new(&study.scene, study.solver.rtol).map(Self)
    }

    fn each(&self) -> impl Iterator<Item = (Measure, f64)> + '_ {
        Rms::ALL.into_iter().map(|rms| (Measure::Stationary(rms), self.0.get(rms)))
    }
}

impl Serialize for Means {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let all = self.each().map(|(measure, value)| (measure.name(), value));
        serializer.collect_map(all.chain([("relative_error", self.0.error)]))
    }
}

impl std::fmt::Display for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.summary.fmt(f)?;
        if let Some(time) = self.decay_time {
            let level = format!("{} % of its largest value in the run", 100.0 * LEFT);
            if time.is_finite() {
                write!(
                    f,
                    "\ndecay       {time:<12.7} s from the end of the forcing until E1 stays below {level}"
                )?;
            } else {
                write!(f, "\ndecay       not within the run: at its end E1 exceeds {level}")?;
            }
        }
        for words in self.contacts.iter().flat_map(Contacts::words) {
            write!(f, "\ncontacts    {words}")?;
        }
        self.powers.words().iter().try_for_each(|words| write!(f, "\nlosses      {words}"))?;
        for words in &self.warnings {
            write!(f, "\nwarning     {words}")?;
        }
        self.transient.iter().try_for_each(|words| write!(f, "\nnote        {words}"))?;
        let Some(means) = &self.stationary else { return Ok(()) };
        for (measure, value) in means.each() {
            let (name, unit) = (measure.short_name(), measure.unit());
            if value.is_finite() {
                write!(f, "\n{name:<11} {:<12} {unit}", digits(value))?;
            } else {
                write!(f, "\n{name:<11} without bound")?;
            }
        }
        write!(f, "\nstationary  under the whole spectrum")?;
        if means.0.error == 0.0 {
            return Ok(());
        }
        write!(f, "; the sums of its integral differ by {:.0e}", means.0.error)
    }
}

/// Writes the motion in the window into a file.
fn write_trajectory(study: &Study, file: &Path, interval: f64) -> Result<(), Error> {
    let mut csv = Pending::create(file)?;
    write_rows(study, interval, &mut |row| Ok(csv.push(row)?))?;
    Ok(csv.finish()?)
}

/// Passes the motion in the window to `push` as CSV, line by line: a row every `interval` seconds, and one for each event between them. The
/// last column, `moment`, names the kind of row: `df[df.moment == "grid"]` are the equidistant ones.
///
/// # Errors
/// The interval is invalid, the run fails, or the first error of `push`.
pub fn write_rows(
    study: &Study,
    interval: f64,
    push: &mut dyn FnMut(&str) -> Result<(), Error>,
) -> Result<(), Error> {
    let window = study.window.window();
    let rows = (window.to - window.from) / interval;
    if !(interval > 0.0 && rows <= f64::from(MOST_ROWS)) {
        return Err(Error::Interval { value: interval, most: MOST_ROWS });
    }
    let mut written = push("t,x1,v1,x2,v2,E1,E2,FconL,FconR,moment\n");
    let mut row = |sample: &Sample| {
        let Sample { t, state: [x1, v1, x2, v2], e1, e2, forces: [left, right], moment, .. } = sample;
        if written.is_ok() {
            let moment = moment.name();
            written = push(&format!("{t},{x1},{v1},{x2},{v2},{e1},{e2},{left},{right},{moment}\n"));
        }
    };
    trajectory(&study.scene, window, &study.solver.settings(), Rows { interval, events: true }, &mut row)?;
    written
}
