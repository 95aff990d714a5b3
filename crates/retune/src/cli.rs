//! The command line: commands, arguments and their help.

mod branches;
mod common;
mod design;
mod named;
mod running;
mod sweep;

pub use branches::Branches;
pub use common::Common;
pub use design::Design;
use named::Named;
pub use running::Running;
pub use sweep::Sweep;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use retune_jobs::parts::Shard;
use retune_model::{Parameter, Start};
use retune_solver::{Contacts, Method};
use retune_study::{Settable, Setting, SettingError};
use std::path::PathBuf;

/// Tunes vibration dampers: from a study file to the best design, its log and its figures.
#[derive(Debug, Parser)]
#[command(version, about, max_term_width = 110, subcommand_required = true, arg_required_else_help = true)]
#[command(after_help = crate::exit::HELP)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Tune the damper of a study: a coarse grid (surf), then Nelder-Mead (fminsearch)
    Optimize {
        /// The study file
        study: PathBuf,
        /// Compute only share i of N of the grid, into DIR/parts; `merge` combines the shares
        #[arg(long, value_name = "i/N")]
        shard: Option<Shard>,
        #[command(flatten)]
        running: Running,
    },
    /// Design a damper: from a structure and limits to the better of a TMD and an SSVI NES, what each limit costs, and how sure that is
    #[command(allow_negative_numbers = true)]
    Design(Box<Design>),
    /// Merge the parts of a grid made by `optimize --shard`, and continue with the search
    Merge {
        /// The study file
        study: PathBuf,
        /// The parts [default: all in DIR/parts]
        parts: Vec<PathBuf>,
        #[command(flatten)]
        running: Running,
    },
    /// Recompute a sample of the rows of results, and report whether they hold (exit code 0), do not (1), or cannot be checked (4)
    Verify {
        /// A directory of results
        results: PathBuf,
        /// Number of rows of each table to recompute, evenly distributed over it
        #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
        sample: u32,
        /// Largest relative difference that is accepted; another machine may round differently
        #[arg(long, value_name = "X", default_value_t = 0.0)]
        within: f64,
        #[command(flatten)]
        common: Common,
    },
    /// Certify a design: error bar, sensitivity, regime and a verdict on its E1max
    Certify {
        /// A study (the design in its scene is certified), the optimum.json of a search, or the directory of its results
        #[arg(value_name = "STUDY|OPTIMUM|RESULTS")]
        design: PathBuf,
        /// How it is run; the certificate goes beside an optimum, or to results/certify/<study>, unless --out says otherwise.
        #[command(flatten)]
        running: Running,
    },
    /// Run one scene and print a summary of the motion
    Simulate(Simulate),
    /// Explore a damper live in the browser: turn its parameters, and its motion and response follow; ends with Ctrl-C
    Explore {
        /// A study, or the directory of its results [default: the paper's SSVI NES]
        #[arg(value_name = "STUDY|RESULTS")]
        study: Option<PathBuf>,
        /// Port of the loopback address [default: any that is free]
        #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
        port: u16,
        /// Print the address, and open no browser
        #[arg(long)]
        no_browser: bool,
        /// Most threads; the results are the same for any number [default: all cores]
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
    },
    /// Sweep a parameter: one run of the scene, or the whole objective, at each of its values; into results/sweep-<study>-<parameter>
    #[command(allow_negative_numbers = true)]
    Sweep(Sweep),
    /// Follow every periodic motion along omega or another parameter: branches, bifurcations, what coexists and how likely
    #[command(allow_negative_numbers = true)]
    Branches(Branches),
    /// Prove a periodic motion by interval arithmetic: it exists, alone in a box, is stable, and has E1max in an interval
    #[command(allow_negative_numbers = true)]
    Prove(Prove),
    /// Evaluate the objective that `optimize` minimises for designs read from standard input, one per line
    #[command(after_help = retune_jobs::evaluate::PROTOCOL)]
    Evaluate(Evaluate),
    /// Re-optimise the paper's Table 2 from its own designs, beside the paper's rows
    Table2 {
        /// The study file
        #[arg(default_value = "studies/table2.json")]
        study: PathBuf,
        #[command(flatten)]
        running: Running,
    },
    /// Contacts that lose energy: tune a damper for each restitution and for all at once, and plot what a wrong one costs
    Losses {
        /// A study whose objective has restitutions
        #[arg(default_value = "studies/ssvi-hedged.json")]
        study: PathBuf,
        #[command(flatten)]
        running: Running,
    },
    /// Retention of tuning along k1: tune dampers again for other stiffnesses of the structure, and plot what detuning costs
    Retention {
        /// Stiffnesses of the primary structure, N/m
        #[arg(required = true, value_name = "K1", value_parser = stiffness, allow_negative_numbers = true)]
        k1: Vec<Setting>,
        /// The table that names the study of each damper; each is tuned for its own k1 as well
        #[arg(long, value_name = "FILE", default_value = "studies/retune.json")]
        study: PathBuf,
        #[command(flatten)]
        running: Running,
    },
    /// Compute Pareto fronts: tune dampers under successively looser bounds on k2 and on the stroke
    Fronts {
        /// The study file
        #[arg(default_value = "studies/fronts.json")]
        study: PathBuf,
        #[command(flatten)]
        running: Running,
    },
    /// Reproduce every table and figure of the paper, on one page beside its statements
    Reproduce(Reproduce),
    /// Reproduce one figure of the paper
    Figure {
        /// Its number in the paper
        #[arg(value_parser = clap::value_parser!(u8).range(2..=7))]
        number: u8,
        #[command(flatten)]
        paper: Reproduce,
    },
    /// Reproduce one table of the paper
    Table {
        /// Its number in the paper
        #[arg(value_parser = clap::value_parser!(u8).range(1..=2))]
        number: u8,
        #[command(flatten)]
        paper: Reproduce,
    },
    /// Check a study file and describe what it specifies
    Check {
        /// The study file
        study: PathBuf,
        #[command(flatten)]
        common: Common,
    },
    /// Print the JSON Schema of a study file, for completion and validation in an editor
    Schema {
        /// The kind of file
        #[arg(value_enum, default_value_t = Kind::Study)]
        kind: Kind,
    },
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// The kinds of study file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// A scene to simulate or tune
    Study,
    /// The paper's Table 2
    Table2,
    /// Pareto fronts
    Fronts,
    /// The whole paper
    Paper,
}

/// `reproduce`, `figure`, `table`.
#[derive(Debug, Args)]
pub struct Reproduce {
    /// The study of the whole paper
    #[arg(long, value_name = "FILE", default_value = "studies/paper.json")]
    pub study: PathBuf,
    /// How it is run; results go to results/<study> unless --out says otherwise.
    #[command(flatten)]
    pub running: Running,
}

/// `prove`.
#[derive(Debug, Args)]
pub struct Prove {
    /// A study (its scene is looked at), the optimum.json of a search, or the directory of its results
    #[arg(value_name = "STUDY|OPTIMUM|RESULTS")]
    pub study: PathBuf,
    #[arg(long = "set", value_name = "NAME=VALUE", help = settings(), value_parser = Named::<Setting>::new(assignments), hide_possible_values = true)]
    pub settings: Vec<Setting>,
    /// Frequency of the force, rad/s or with its unit [default: that of the worst run of a search, or of the scene]
    #[arg(long, value_name = "W", value_parser = omega)]
    pub omega: Option<Setting>,
    /// Prove all frequencies from --omega to this one instead: piece by piece, minutes for a band
    #[arg(long, value_name = "W", value_parser = omega, requires = "omega", conflicts_with = "from")]
    pub to: Option<Setting>,
    /// Prove that E1max is at most this at each of these frequencies, J; the nearer it is to the largest, the longer it takes
    #[arg(long, value_name = "J", default_value_t = f64::INFINITY, hide_default_value = true, requires = "to")]
    pub most: f64,
    /// Guess this state at a crest of the force: x1,v1,x2,v2 in m and m/s [default: what the run of the scene settles on]
    #[arg(long, value_name = "X1,V1,X2,V2", value_parser = retune_study::start, allow_hyphen_values = true)]
    pub from: Option<Start>,
    /// Periods of the force after which the motion from there repeats
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=64), requires = "from")]
    pub periods: u8,
    #[command(flatten)]
    pub common: Common,
}

/// `simulate`.
#[derive(Debug, Args)]
pub struct Simulate {
    /// The study file
    pub study: PathBuf,
    #[arg(long = "set", value_name = "NAME=VALUE", help = settings(), value_parser = Named::<Setting>::new(assignments), hide_possible_values = true)]
    pub settings: Vec<Setting>,
    /// Start from this state instead of rest: x1,v1,x2,v2 in m and m/s, or x1,v1 with the damper's spring at rest
    #[arg(long, value_name = "X1,V1,X2,V2", value_parser = retune_study::start, allow_hyphen_values = true)]
    pub from: Option<Start>,
    /// Integration method
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Method::ALL.map(Method::name)).map(method))]
    pub solver: Option<Method>,
    /// Treatment of contacts by every method except the hybrid
    #[arg(long, value_name = "HOW", value_parser = PossibleValuesParser::new(["located", "stepped"]).map(contacts))]
    pub contacts: Option<Contacts>,
    /// Relative tolerance of a step
    #[arg(long, value_name = "X")]
    pub rtol: Option<f64>,
    #[command(flatten)]
    pub common: Common,
    /// Also write the motion in the window to a CSV file. Its last column, moment, gives the kind of row: "grid" (one per
    /// --interval), or an event in between: "touch-down", "force-max", "lift-off" of each contact, "E1-max" of each maximum of E1
    #[arg(long, value_name = "FILE.csv")]
    pub trajectory: Option<PathBuf>,
    /// Time between two rows of the trajectory's grid, s
    #[arg(long, value_name = "S", default_value_t = 0.005, requires = "trajectory")]
    pub interval: f64,
}

/// `evaluate`.
#[derive(Debug, Args)]
pub struct Evaluate {
    #[arg(help = format!("The study file; a design is one number for each parameter that it tunes, in the order {}", Parameter::VARIED_SYMBOLS.join(" ")))]
    pub study: PathBuf,
    /// Answer with JSON objects, one per line, which include the violation of limits
    #[arg(long)]
    pub json: bool,
    /// Print only the answers, without notes on the study
    #[arg(long)]
    pub quiet: bool,
    /// Number of lines evaluated in parallel, and threads of the runs of each; the values are the same for any number [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// Shell completions of `--set`.
fn assignments() -> Vec<String> {
    Settable::all().map(|settable| format!("{}=", settable.symbol())).collect()
}

/// The help of `--set`.
fn settings() -> String {
    let names: Vec<&str> = Settable::all().map(Settable::symbol).collect();
    format!(
        "Change a number (repeatable): {}; in SI units, or with a unit: omega=1Hz, k1=30kN/m",
        names.join(" ")
    )
}

fn stiffness(text: &str) -> Result<Setting, SettingError> {
    format!("k1={text}").parse()
}

fn omega(text: &str) -> Result<Setting, SettingError> {
    format!("omega={text}").parse()
}

fn method(name: String) -> Method {
    Method::ALL.into_iter().find(|method| method.name() == name).unwrap_or(Method::Hybrid)
}

fn contacts(name: String) -> Contacts {
    if name == "stepped" { Contacts::Stepped } else { Contacts::Located }
}

#[cfg(test)]
#[path = "../tests/unit/cli.rs"]
mod tests;
