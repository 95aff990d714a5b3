//! What is swept.

use crate::Error;
use crate::sweep::quantity::Quantity;
use retune_model::{Measure, Parameter};
use retune_optim::{Axis, AxisError, Scale};
use serde::{Deserialize, Serialize};

/// Most values of a sweep.
pub const MOST_POINTS: usize = 100_000;

/// What is asked for, as it is typed.
#[derive(Clone, Debug)]
pub struct Options {
    /// The parameter.
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
    /// What is shown; E1max if empty.
    pub quantities: Vec<Quantity>,
    /// Whether each point is the objective of the study instead of one run.
    pub objective: bool,
}

/// What is swept. With a study it is the complete input of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The parameter.
    pub over: Parameter,
    /// Its first value, in its SI unit.
    pub from: f64,
    /// Its last value.
    pub to: f64,
    /// The number of values, both ends included.
    pub points: usize,
    /// Their spacing.
    pub scale: Scale,
    /// What is shown on screen and in the figure; tables hold everything.
    pub quantities: Vec<Quantity>,
    /// Whether each point is the objective of the study instead of one run.
    pub objective: bool,
}

impl Options {
    /// A sweep of 61 evenly spaced values, the ends of which are still to be given.
    pub fn over(over: Parameter) -> Self {
        let [from, to] = [String::new(), String::new()];
        Self { over, from, to, unit: None, points: 61, log: false, quantities: Vec::new(), objective: false }
    }
}

impl Plan {
    /// Reads what is asked for.
    ///
    /// # Errors
    /// An end is no number, or there are no such values.
    pub fn read(options: &Options) -> Result<Self, Error> {
        let Options { over, points, objective, .. } = *options;
        let end = |option, text: &str| {
            // A number that has no unit of its own has that of all.
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
            quantities.push(Quantity::Largest(Measure::Energy));
        }
        let scale = if options.log { Scale::Log } else { Scale::Linear };
        Ok(Self { over, from, to, points, scale, quantities, objective })
    }

    /// The options of the command line that ask for it.
    pub fn options(&self) -> String {
        let Self { over, from, to, points, scale, quantities, objective } = self;
        let log = if *scale == Scale::Log { " --log" } else { "" };
        let names: Vec<&str> = quantities.iter().map(|quantity| quantity.name()).collect();
        let shown =
            if *objective { " --objective".to_owned() } else { format!(" --quantity {}", names.join(",")) };
        format!("--over {} --from {from} --to {to} --points {points}{log}{shown}", over.symbol())
    }

    /// The values.
    ///
    /// # Errors
    /// There are no such values, or too many.
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
        Axis::new(from, to, points, scale).map_err(refuse)
    }
}
