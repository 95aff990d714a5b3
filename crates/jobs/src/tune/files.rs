//! The names of the files of a search.

/// The design that a search found.
pub const OPTIMUM: &str = "optimum.json";
/// A row for each design of the grid, with its value.
pub const GRID: &str = "surf.csv";
/// A row for each iteration of the refinement that was chosen.
pub const LOG: &str = "fminsearch.csv";
/// The same of all refinements.
pub const STARTS: &str = "fminsearch-starts.csv";
/// A row for each basin of a global search.
pub const BASINS: &str = "basins.csv";
/// A row for each frequency: without a damper, with that of the study, with the tuned one.
pub const BAND: &str = "band.csv";

/// Those that only a search leaves.
pub const SEARCHED: [&str; 5] = [GRID, LOG, STARTS, BASINS, BAND];
