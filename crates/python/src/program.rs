//! The command line `retune`, which the wheel installs beside the package.

use pyo3::Python;
use std::ffi::OsString;

/// Runs the program with these words; returns its exit code.
#[pyo3::pyfunction]
pub fn program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| retune::program(words))
}
