//! Retune as a Python package: conversion, exceptions and nothing else. What is computed, and what is allowed, is said by the libraries.
//!
//! A problem is a study (`retune_study`): Python builds its JSON, the study's own rules check it, and answers go back as numpy arrays or
//! as JSON. `python/retune` is what users see; this module is its private `_core`.
//!
//! - `errors`: from every error to one of the package's exceptions.
//! - `arrays`: numbers from numpy and back.
//! - `columns`: what is told of an evaluation.
//! - `monitor`: long work without the interpreter's lock, which Ctrl-C ends and which tells how far it is.
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
