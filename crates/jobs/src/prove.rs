//! `prove`: a proof by interval arithmetic of the periodic motion of a scene. The solver only guesses the motion; `retune_proof` relies on
//! nothing else of it.

pub mod band;

use crate::Error;
use crate::recompute::json;
use crate::tune::OPTIMUM;
use band::{Band, LeftOut, steady_band};
use rayon::prelude::*;
use retune_dynamics::periodic::settle::settled;
use retune_model::{Parameter, Start};
use retune_proof::{Interval, Stability, Theorem};
use retune_study::{self as study, Setting, Study, counted};
use serde::Serialize;
use std::fmt;
use std::path::Path;

/// The guess of the motion.
#[derive(Clone, Debug, Default)]
pub struct Guess {
    /// Other values of parameters of the scene.
    pub settings: Vec<Setting>,
    /// The frequency of the force, rad/s; by default that of the worst run of a search's results, else the scene's.
    pub omega: Option<Setting>,
    /// A state at a crest of the force, and the number of periods after which the motion repeats; by default the motion on which a run of
    /// the scene settles.
    pub from: Option<(Start, usize)>,
}

/// A proven motion.
#[derive(Clone, Debug, Serialize)]
pub struct Proof {
    study: String,
    omega: f64,
    /// The theorem.
    #[serde(flatten)]
    pub theorem: Theorem,
}

/// Proves the periodic motion of a study's scene, or of the design that a search found.
///
/// # Errors
/// The input is wrong, no motion is found, or it cannot be proven.
pub fn prove(path: &Path, guess: &Guess) -> Result<Proof, Error> {
    let given = study::read(path)?;
    let is_set = guess.settings.iter().any(|setting| setting.what() == Parameter::Omega.into());
    let omega = match guess.omega {
        None if !is_set => worst(path)?,
        given => given,
    };
    let study = given.with(&guess.settings)?.with(&omega.into_iter().collect::<Vec<_>>())?;
    let (periods, start) = match guess.from {
        Some((start, periods)) => {
            let rest = study.scene.damper.map_or(0.0, |damper| damper.rest_distance.get());
            (periods, start.state(rest))
        }
        None => found(&study)?,
    };
    let theorem = retune_proof::prove(&study.scene, start, periods)
        .map_err(|failure| not_proven(&study, failure.to_string()))?;
    Ok(Proof { study: study.name().to_owned(), omega: study.scene.forcing.frequency.get(), theorem })
}

/// The error of a study of which nothing is proven.
fn not_proven(study: &Study, mut why: String) -> Error {
    if study.scene.damper.is_some_and(|damper| damper.is_floating()) {
        why += "; without a spring (k2 = 0) a damper that touches no wall repeats wherever it floats, and no such motion is alone";
    }
    Error::NotProven { name: study.name().to_owned(), why }
}

/// The frequency of the worst run of a search's results.
fn worst(path: &Path) -> Result<Option<Setting>, Error> {
    let Some(place) = study::found_in(path)? else { return Ok(None) };
    if !place.join(OPTIMUM).exists() {
        return Ok(None);
    }
    let worst = json(&place, OPTIMUM)?["objective"]["worst_omega"].as_f64();
    Ok(worst.map(|omega| Setting::new(Parameter::Omega, omega)))
}

/// The periodic motion on which the run settles: its periods and state.
fn found(study: &Study) -> Result<(usize, [f64; 4]), Error> {
    let none = || {
        let why = "none found: the run settles on no periodic motion; give --from and --periods, or another --omega";
        not_proven(study, why.to_owned())
    };
    // Without walls there is one periodic motion, whatever the guess; without a frequency the proof itself refuses the scene.
    let has_walls = study.scene.damper.is_some_and(|damper| damper.contact.is_some());
    if !has_walls || study.scene.forcing.frequency.get() <= 0.0 {
        return Ok((1, [0.0; 4]));
    }
    settled(&study.scene, &study.solver.settings())?.ok_or_else(none)
}

impl fmt::Display for Proof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { study, omega, theorem } = self;
        let Theorem { periods, impacts, alone_within, width, stability, largest, .. } = theorem;
        let strikes = if impacts.is_empty() { "no wall".to_owned() } else { impacts.clone() };
        writeln!(f, "study {study}, omega = {omega} rad/s: proven by interval arithmetic")?;
        writeln!(
            f,
            "exists        a motion that repeats after {} of the force and strikes {strikes}",
            counted(*periods as u64, "period")
        )?;
        // Two digits of 5 % less and more, since rounding the values themselves to nearest could overstate them.
        let other = alone_within.map_or("motion that touches no wall repeats".to_owned(), |within| {
            format!("such motion is in a box {:.1e} wide about its states at the events", 0.95 * within)
        });
        writeln!(f, "alone         no other {other}; it is within {:.1e} (m, m/s, rad)", 1.05 * width)?;
        match stability {
            Stability::Stable(bound) => writeln!(f, "stable        all multipliers are below {bound}")?,
            Stability::Unstable(largest) => writeln!(f, "unstable      a multiplier is above 1: {largest}")?,
            Stability::Open(largest) => writeln!(f, "stability     neither way is proven: {largest}")?,
        }
        let lines = largest.all().map(|(measure, value)| {
            format!("{:<14}from {} to {} {}", measure.name(), value.lo(), value.hi(), measure.unit())
        });
        f.write_str(&lines.join("\n"))
    }
}

/// A proof over a band of frequencies.
#[derive(Clone, Debug, Serialize)]
pub struct BandProof {
    study: String,
    omega: [f64; 2],
    /// Bounds on the largest E1max over the band, J.
    #[serde(rename = "E1max")]
    energy: Interval,
    /// The proven pieces, and the parts left out.
    #[serde(flatten)]
    pub band: Band,
}

/// Width, rad/s, of the shares of a band that are proven in parallel.
const SHARE: f64 = 0.1;

/// Proves stable motions with an E1max of at most `most` (J) over a band: the steady ones, if with them the damper touches no wall at any
/// frequency; else at each frequency one near that on which a run of the scene settles.
///
/// # Errors The input is wrong, or nothing can be proven over any part of the band.
pub fn prove_band(
    path: &Path,
    settings: &[Setting],
    [from, to]: [Setting; 2],
    most: f64,
) -> Result<BandProof, Error> {
    let study = study::read(path)?.with(settings)?.with(&[to])?.with(&[from])?;
    let [from, to] = [from.value(), to.value()];
    if to <= from {
        let problem = format!("{to} rad/s is not allowed here: give a number above that of --omega, {from}");
        return Err(Error::Argument { option: "--to", problem });
    }
    let not_proven = |why: String| Error::NotProven { name: study.name().to_owned(), why };
    let steady = steady_band(&study.scene, [from, to], most);
    let steady = steady.map_err(|failure| not_proven(failure.to_string()))?;
    let band = steady.unwrap_or_else(|| by_shares(&study, [from, to], most));
    match band.left_out.first() {
        Some(LeftOut { why, .. }) if band.pieces.is_empty() => Err(not_proven(why.to_string())),
        _ => Ok(BandProof { study: study.name().to_owned(), omega: [from, to], energy: band.energy(), band }),
    }
}

/// Proves the shares of a band in parallel.
fn by_shares(study: &Study, [from, to]: [f64; 2], most: f64) -> Band {
    let guess = |omega: f64| {
        let scene = Parameter::Omega.at(study.scene, omega).ok()?;
        settled(&scene, &study.solver.settings()).ok()?.map(|(periods, start)| (start, periods))
    };
    let shares = ((to - from) / SHARE).ceil().max(1.0) as usize;
    let end = |k: usize| if k == shares { to } else { from + (to - from) * (k as f64 / shares as f64) };
    let share = |k: usize| band::band(&study.scene, [end(k), end(k + 1)], most, &guess);
    Band::joined((0..shares).into_par_iter().map(share).collect())
}

impl BandProof {
    /// Whether it proves an E1max of at most `most` (J) at every frequency.
    ///
    /// # Errors [`Error::NotProven`], if it leaves some out.
    pub fn holds(&self, most: f64) -> Result<(), Error> {
        if most.is_infinite() || self.band.left_out.is_empty() {
            return Ok(());
        }
        let why = format!("an E1max of at most {most} J is not proven at every omega");
        Err(Error::NotProven { name: self.study.clone(), why })
    }
}

impl fmt::Display for BandProof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { study, omega: [from, to], energy, band } = self;
        let pieces = counted(band.pieces.len() as u64, "piece");
        writeln!(
            f,
            "study {study}, omega from {from} to {to} rad/s: proven by interval arithmetic in {pieces}"
        )?;
        write!(f, "every omega   has a stable motion with an E1max of at most {} J", energy.hi())?;
        for LeftOut { omega: [from, to], why, from_above } in &band.left_out {
            write!(f, "\nbut for       {from} to {to} rad/s: {why}")?;
            if let Some(why) = from_above {
                write!(f, "; from above, {why}")?;
            }
        }
        Ok(())
    }
}
