//! The arguments of `sweep`.

use super::named::Named;
use super::running::Running;
use clap::Args;
use retune_jobs::parts::Shard;
use retune_jobs::sweep::Quantity;
use retune_model::Parameter;
use std::path::PathBuf;

/// `sweep`.
#[derive(Debug, Args)]
pub struct Sweep {
    /// A study, the optimum.json of a search, or the directory of its results
    #[arg(value_name = "STUDY|OPTIMUM|RESULTS")]
    pub study: PathBuf,
    #[arg(long, value_name = "NAME", help = format!("The parameter: {}", parameters().join(" ")), value_parser = Named::<Parameter>::new(parameters), hide_possible_values = true)]
    pub over: Parameter,
    /// Its first value, in its SI unit or with a unit: 0.8Hz, 30kN/m
    #[arg(long, value_name = "A")]
    pub from: String,
    /// Its last value
    #[arg(long, value_name = "B")]
    pub to: String,
    /// The number of values, both ends included
    #[arg(long, value_name = "N", default_value_t = 61)]
    pub points: usize,
    /// Equal ratios between values instead of equal differences
    #[arg(long)]
    pub log: bool,
    /// The unit of ends without one, for instance Hz for omega
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<String>,
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', conflicts_with = "objective", help = about_quantities(), value_parser = Named::<Quantity>::new(quantities), hide_possible_values = true)]
    pub quantity: Vec<Quantity>,
    /// Compute the objective of the study at each value, for instance the worst over its band, instead of one run
    #[arg(long)]
    pub objective: bool,
    /// Compute only share i of N of the values, into DIR/parts; the same command with --merge combines the shares
    #[arg(long, value_name = "i/N", conflicts_with_all = ["merge", "json"])]
    pub shard: Option<Shard>,
    /// Merge the parts that --shard made
    #[arg(long)]
    pub merge: bool,
    /// How it is run; results go to results/sweep-<study>-<parameter> unless --out says otherwise.
    #[command(flatten)]
    pub running: Running,
}

/// Names of the parameters that may be swept.
fn parameters() -> Vec<String> {
    Parameter::ALL.map(|parameter| parameter.symbol().to_owned()).to_vec()
}

/// Names of the quantities that may be shown.
fn quantities() -> Vec<String> {
    Quantity::all().map(|quantity| quantity.name().to_owned()).collect()
}

/// The help of `--quantity`.
fn about_quantities() -> String {
    let names = quantities();
    format!(
        "What is shown: {}, with commas between [default: {}]; the tables hold all of them",
        names.join(" "),
        names[0]
    )
}
