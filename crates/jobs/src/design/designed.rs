//! A damper that was designed.

#[cfg(doc)]
use super::requirements::Requirements;
use crate::designs::Row;
use retune_study::Study;

/// A damper as it was designed.
#[derive(Debug)]
pub struct Designed {
    /// Its name.
    pub name: &'static str,
    /// Its study, under all limits.
    pub study: Study,
    /// Its design under all limits, and those without one of them, in the order of [`Requirements::limits`].
    pub rows: Vec<Row>,
    /// The largest stroke of the design under all limits, m, and the largest contact force, N.
    pub needs: [f64; 2],
    /// Whether that design keeps its limits.
    pub feasible: bool,
    /// E1max with the stiffness k1 of the structure off by minus and plus its error, J, if an error is given.
    pub detuned: Option<[f64; 2]>,
}
