//! Retune as a Python package: conversion and exceptions only. The libraries define what is computed and what is allowed.
//!
//! A problem is a study (`retune_study`): Python builds its JSON, the study's own rules check it, and answers are returned as numpy
//! arrays or as JSON. Users see `python/retune`; this module is its private `_core`.
//!
//! - `errors`: conversion of errors to the package's exceptions.
//! - `arrays`: numbers from numpy and back.
//! - `columns`: the results of an evaluation as columns.
//! - `monitor`: long work without the interpreter's lock, with progress and Ctrl-C.
//! - `pool`: the threads that an evaluation may use.
//! - `problem`: a study as a function of a design; `motion`: its runs and sweeps; `jobs`: what takes minutes and writes files;
//!   `files`: the jobs whose answer is their files.
//! - `program`: the command line.

mod arrays;
mod columns;
mod errors;
mod files;
mod jobs;
mod monitor;
mod motion;
mod pool;
mod problem;
mod program;

/// The private part of the package `retune`.
#[pyo3::pymodule]
mod _core {
    #[pymodule_export]
    use crate::files::job;
    #[pymodule_export]
    use crate::jobs::{
        amplitudes, branches, certify, contact, design_study, history_unit, optimize, parameters, prove,
        study_text, typed, verify,
    };
    #[pymodule_export]
    use crate::motion::{run, sweep};
    #[pymodule_export]
    use crate::problem::Core;
    #[pymodule_export]
    use crate::program::program;

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
