//! The plan of a sweep.

use crate::Error;
use retune_model::{Measure, Parameter};
use retune_optim::{Axis, AxisError, Scale};
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// Most values of a sweep.
pub const MOST_POINTS: usize = 100_000;

/// The options as typed.
#[derive(Clone, Debug)]
pub struct Options {
    /// The parameter that is swept.
    pub over: Parameter,
    /// Its first value; a frequency may have a unit.
    pub from: String,
    /// Its last value.
    pub to: String,
    /// The unit of ends without one; by default the SI unit.
    pub unit: Option<String>,
    /// The number of values, both ends included.
    pub points: usize,
    /// Whether the values have equal ratios instead of equal differences.
    pub log: bool,
    /// The quantities shown; E1max if empty.
    pub quantities: Vec<Quantity>,
    /// Whether each point is the objective of the study instead of one run.
    pub objective: bool,
}

/// The plan of a sweep. With a study it is the complete input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The parameter that is swept.
    pub over: Parameter,
    /// Its first value, in its SI unit.
    pub from: f64,
    /// Its last value.
    pub to: f64,
    /// The number of values, both ends included.
    pub points: usize,
    /// Whether the values have equal differences or equal ratios.
    pub scale: Scale,
    /// The quantities shown on screen and in the figure; tables hold all.
    pub quantities: Vec<Quantity>,
    /// Whether each point is the objective of the study instead of one run.
    pub objective: bool,
}

impl Options {
    /// A sweep of 61 evenly spaced values; the ends must still be given.
    pub fn over(over: Parameter) -> Self {
        let [from, to] = [String::new(), String::new()];
        Self { over, from, to, unit: None, points: 61, log: false, quantities: Vec::new(), objective: false }
    }
}

impl Plan {
    /// Reads the plan from options.
    ///
    /// # Errors
    /// An end is no number, or there are no such values.
    pub fn read(options: &Options) -> Result<Self, Error> {
        let Options { over, points, objective, .. } = *options;
        let end = |option, text: &str| {
            // A number without a unit takes the common one.
            let unit =
                options.unit.as_deref().filter(|_| text.trim().parse::<f64>().is_ok()).unwrap_or_default();
            over.read(&format!("{text}{unit}")).map_err(|problem| Error::Argument { option, problem })
        };
        let (from, to) = (end("--from", &options.from)?, end("--to", &options.to)?);
        let mut quantities: Vec<Quantity> = Vec::new();
        for quantity in &options.quantities {
            if !quantities.contains(quantity) {
                quantities.push(*quantity);
            }
        }
        if quantities.is_empty() {
            quantities.push(Quantity::Of(Measure::Energy));
        }
        let scale = if options.log { Scale::Log } else { Scale::Linear };
        Ok(Self { over, from, to, points, scale, quantities, objective })
    }

    /// The command-line options for the plan.
    pub fn options(&self) -> String {
        let Self { over, from, to, points, scale, quantities, objective } = self;
        let log = if *scale == Scale::Log { " --log" } else { "" };
        let names: Vec<&str> = quantities.iter().map(|quantity| quantity.name()).collect();
        let shown =
            if *objective { " --objective".to_owned() } else { format!(" --quantity {}", names.join(",")) };
        format!("--over {} --from {from} --to {to} --points {points}{log}{shown}", over.symbol())
    }

    /// The values.
    pub fn axis(&self) -> Result<Axis, Error> {
        let Self { from, to, points, scale, .. } = *self;
        if !(2..=MOST_POINTS).contains(&points) {
            let problem =
                format!("{points} is not allowed here: give a whole number from 2 to {MOST_POINTS}");
            return Err(Error::Argument { option: "--points", problem });
        }
        let refuse = |error: AxisError| Error::Argument {
            option: "--from, --to, --points",
            problem: error.to_string(),
        };
        if from == to {
            let problem = format!("{to} is not allowed here: give another number than --from");
            return Err(Error::Argument { option: "--to", problem });
        }
        Axis::new(from, to, points, scale).map_err(refuse)
    }
}

/// A quantity of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Quantity {
    /// A largest value of the motion in the window, or the [decay time](retune_solver::decay_time), for transient forcings only.
    Of(Measure),
    /// The transmissibility, see [`retune_model::Forcing::transmissibility`].
    Transmissibility,
    /// Impacts in the window, on both walls together.
    Impacts,
}

impl Quantity {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        Measure::OF_RUN.into_iter().map(Self::Of).chain([Self::Transmissibility, Self::Impacts])
    }

    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Of(measure) => measure.name(),
            Self::Transmissibility => "transmissibility",
            Self::Impacts => "impacts",
        }
    }

    /// Its SI unit; empty for a pure number.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Of(measure) => measure.unit(),
            Self::Transmissibility | Self::Impacts => "",
        }
    }
}

impl FromStr for Quantity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::all().find(|quantity| quantity.name() == text).ok_or_else(|| {
            let names: Vec<&str> = Self::all().map(Self::name).collect();
            format!("there is no quantity \"{text}\": give one or more of {}", names.join(", "))
        })
    }
}

impl TryFrom<String> for Quantity {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Quantity> for String {
    fn from(quantity: Quantity) -> Self {
        quantity.name().to_owned()
    }
}
