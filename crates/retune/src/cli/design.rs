//! The arguments of `design`.

use super::named::Named;
use super::running::Running;
use clap::Args;
use retune_jobs::Error;
use retune_jobs::design::{Specification, Typed};
use retune_model::Measure;
use serde::Serialize;
use serde_json::{from_value, to_value};
use std::path::PathBuf;

/// What is typed after most options: a number in the SI unit, or one with its unit.
#[derive(Debug, Args, Serialize)]
#[command(after_help = EXAMPLES)]
pub struct Design {
    /// A file of requirements, whose fields are the options below; options replace its fields
    #[serde(skip)]
    pub file: Option<PathBuf>,
    /// A table of the modes of a structure of many degrees of freedom, one of which takes the place of m1, f1 and zeta, under forces at the
    /// damper: CSV with the columns f (Hz), zeta (a share), M (modal mass, kg) and phi (mode shape at the damper)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["m1", "f1", "k1", "zeta", "c1"])]
    #[serde(skip)]
    pub modes: Option<PathBuf>,
    /// The mode of the table, from 1 [default: the one that a force at the damper moves most]
    #[arg(long, value_name = "NUMBER", requires = "modes")]
    #[serde(skip)]
    pub mode: Option<usize>,
    /// Mass of the structure, e.g. 40t
    #[arg(long, value_name = "MASS")]
    pub m1: Option<String>,
    /// Its natural frequency, e.g. 2Hz; or --k1
    #[arg(long, value_name = "FREQUENCY")]
    pub f1: Option<String>,
    /// Its stiffness, e.g. 20kN/m; or --f1
    #[arg(long, value_name = "STIFFNESS")]
    pub k1: Option<String>,
    /// Its damping as a share of critical, e.g. 0.5%; or --c1
    #[arg(long, value_name = "SHARE")]
    pub zeta: Option<String>,
    /// Its damping, N·s/m; or --zeta
    #[arg(long, value_name = "DAMPING")]
    pub c1: Option<String>,
    /// Amplitude of a force on it, e.g. 280N
    #[arg(long, visible_alias = "P", value_name = "FORCE")]
    pub force: Option<String>,
    /// A rotating imbalance, mass times radius, e.g. 0.02kg·m: its force grows with the square of the frequency
    #[arg(long, value_name = "IMBALANCE")]
    pub imbalance: Option<String>,
    /// Amplitude of a moving base, e.g. 1mm
    #[arg(long, value_name = "LENGTH")]
    pub base: Option<String>,
    /// Amplitude of the acceleration of a moving base, the same at every frequency, e.g. 0.1g
    #[arg(long, value_name = "ACCELERATION")]
    pub base_acceleration: Option<String>,
    /// A shock: its shape (half-sine, versed-sine, rectangle), how long it lasts, and its peak, an acceleration of the base or a force: half-sine,20ms,5g or rectangle,0.1s,300N
    #[arg(long, value_name = "SHAPE,DURATION,PEAK", allow_hyphen_values = true)]
    pub shock: Option<String>,
    /// A record: a CSV or AT2 file, then what is not of=base-acceleration, unit=m/s², column=2, scale=1, e.g. quake.csv,unit=g
    #[arg(long, value_name = "FILE")]
    pub record: Option<String>,
    /// From when on largest values count under a shock or a record, e.g. 5s: what a shock leaves then [default: the whole run]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub after: Option<String>,
    /// The frequencies of the forcing, e.g. 1.8Hz..2.2Hz, 1500rpm±5%, ±10% [default: within 10 % of the natural frequency]
    #[arg(long, num_args = 1..=2, value_name = "BAND")]
    #[serde(skip)]
    pub band: Vec<String>,
    /// Mass of the damper, e.g. 2% (of the structure's) or 800kg
    #[arg(long, value_name = "MASS")]
    pub mass: Option<String>,
    /// What is made small: E1max, x1max, v1max, a1max, ground-force [default: E1max]
    #[arg(long, value_name = "NAME", value_parser = Named::<String>::new(goals), hide_possible_values = true)]
    pub goal: Option<String>,
    /// The largest value allowed of a quantity (repeatable), e.g. stroke=15mm, x1max=2mm, a1max=0.5m/s2, ground-force=2kN, k2=600N/m
    #[arg(long, value_name = "NAME=VALUE", value_parser = Named::<String>::new(limits), hide_possible_values = true)]
    #[serde(skip)]
    pub limit: Vec<String>,
    /// The same as --limit stroke=...
    #[arg(long, value_name = "LENGTH", hide = true)]
    pub stroke: Option<String>,
    /// The same as --limit k2=...
    #[arg(long, value_name = "STIFFNESS", hide = true)]
    pub k2_max: Option<String>,
    /// Share by which k1 may be off, e.g. 10%: the damper is tuned for the worst k1 within it, and limits hold for all
    #[arg(long, value_name = "SHARE")]
    pub k1_error: Option<String>,
    /// Which dampers: tmd (at once), ssvi, both [default: both, and the better one is recommended]
    #[arg(long, value_name = "WHICH", value_parser = Named::<String>::new(dampers), hide_possible_values = true)]
    pub damper: Option<String>,
    /// The walls of an SSVI NES: radius and Young's modulus of the damper's surfaces, e.g. R=20mm,E=5MPa, or rubber or steel for E, and a restitution e=0.7 [default: scaled from the paper's, without loss]
    #[arg(long, value_name = "R=..,E=..")]
    pub wall: Option<String>,
    /// The options of the run.
    #[command(flatten)]
    #[serde(skip)]
    pub running: Running,
}

/// Shell completions.
fn goals() -> Vec<String> {
    Measure::OF_STRUCTURE.map(|measure| measure.name().to_owned()).to_vec()
}

fn limits() -> Vec<String> {
    let others = ["cavity", "k2"];
    Measure::ALL.map(Measure::name).into_iter().chain(others).map(|name| format!("{name}=")).collect()
}

fn dampers() -> Vec<String> {
    ["tmd", "ssvi", "both"].map(str::to_owned).to_vec()
}

const EXAMPLES: &str = "\
Examples:
  retune design --m1 40t --f1 2Hz --zeta 0.5% --force 280N --mass 2%
  retune design --m1 2t --f1 24.5Hz --zeta 1% --imbalance 0.02kg·m --band 1350rpm..1650rpm --mass 60kg --limit stroke=0.5mm
  retune design --m1 2t --f1 3Hz --zeta 1% --shock half-sine,20ms,5g --after 3s --mass 5%
  retune design --m1 40t --f1 1Hz --zeta 1% --record studies/records/quake.csv --goal x1max --mass 5%
  retune design --modes studies/modes/building.csv --force 2kN --mass 1%
  retune design studies/examples/building.json --limit stroke=250mm";

impl Design {
    /// The requirements; the fields have the names of the options.
    pub fn specification(&self) -> Result<Specification, Error> {
        let refused = |error: serde_json::Error| Error::Requirement {
            place: "command line".to_owned(),
            problem: error.to_string(),
        };
        let given: Specification = to_value(self).and_then(from_value).map_err(refused)?;
        let band = (!self.band.is_empty()).then(|| self.band.join(" .. ").into());
        let limit = self.limit.iter().cloned().map(Typed::from).collect();
        Ok(Specification { band, limit, ..given })
    }
}
