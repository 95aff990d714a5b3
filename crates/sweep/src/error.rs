//! Why a sweep cannot be made.

use retune_optim::AxisError;
use retune_study::{Rule, SettingError};
use thiserror::Error;

/// What is wrong with what was options, by its name on the command line.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Error {
    /// An end cannot be read.
    #[error("--{option}: {problem}")]
    End {
        /// `from` or `to`.
        option: &'static str,
        /// What it is, and what to give.
        problem: String,
    },
    /// The ends and the number of values contradict one another.
    #[error("--from, --to, --points: {0}")]
    Axis(#[from] AxisError),
    /// Too many values.
    #[error("--points: {points} is not allowed here: give a whole number from 2 to {most}")]
    Points {
        /// Their number as given.
        points: usize,
        /// The largest number allowed.
        most: usize,
    },
    /// A value that the scene cannot have.
    #[error("--over: {0}")]
    Value(#[from] SettingError),
    /// The objective does not depend on the parameter.
    #[error(
        "--over {parameter}: the objective takes its own values of {parameter}, so that it does not change with that of the \
         scene: sweep another parameter, or leave out --objective"
    )]
    OwnValues {
        /// The parameter.
        parameter: &'static str,
    },
    /// The study does not fit.
    #[error("--objective: {0}")]
    Rule(#[from] Rule),
}
