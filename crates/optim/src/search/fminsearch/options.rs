//! The options of a run of [`fminsearch`](super), and their errors.

/// Why a run cannot start. Coordinates are counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The start has no coordinate.
    #[error("the start has no coordinate")]
    EmptyStart,
    /// A coordinate of the start is outside the box, NaN or infinite.
    #[error("coordinate {index} of the start is {value}, outside its bounds {bounds}")]
    StartOutside {
        /// Index of the coordinate.
        index: usize,
        /// Its value.
        value: f64,
        /// The bounds it violates.
        bounds: Bounds,
    },
    /// The objective has no finite value at the start.
    #[error("the objective is {value} at the start: it must be finite there")]
    StartValue {
        /// The value of the objective.
        value: f64,
    },
    /// The number of bounds differs from the number of coordinates.
    #[error("{given} bounds for {expected} coordinates: give one for each, or none")]
    BoundsCount {
        /// Coordinates of the start.
        expected: usize,
        /// Bounds given.
        given: usize,
    },
    /// Invalid bounds: the lower is not below the upper, or one is NaN or infinite.
    #[error("the bounds of coordinate {index} are {bounds}: the lower must be below the upper, both finite")]
    EmptyBounds {
        /// Index of the coordinate.
        index: usize,
        /// Its bounds.
        bounds: Bounds,
    },
    /// A tolerance is negative, NaN or infinite.
    #[error("`{name}` is {value}: it must be finite and not negative")]
    Tolerance {
        /// `tol_x` or `tol_fun`.
        name: &'static str,
        /// The tolerance.
        value: f64,
    },
    /// Any other failure of argmin's executor.
    #[error("argmin: {0}")]
    Executor(String),
}

/// The range a coordinate may take, both ends included; `None` means no bound.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Smallest value allowed.
    pub lower: Option<f64>,
    /// Largest value allowed.
    pub upper: Option<f64>,
}

impl Bounds {
    /// Whether `x` is a finite number within the bounds.
    pub fn contain(&self, x: f64) -> bool {
        x.is_finite()
            && self.lower.is_none_or(|lower| lower <= x)
            && self.upper.is_none_or(|upper| x <= upper)
    }
}

impl std::fmt::Display for Bounds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.lower, self.upper) {
            (Some(lower), Some(upper)) => write!(f, "[{lower}, {upper}]"),
            (Some(lower), None) => write!(f, "[{lower}, ∞)"),
            (None, Some(upper)) => write!(f, "(−∞, {upper}]"),
            (None, None) => write!(f, "(−∞, ∞)"),
        }
    }
}

/// The coordinates in which the simplex moves and [`Options::tol_x`] is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scaling {
    /// The parameters as given, as in MATLAB: one absolute `tol_x` for all of them, regardless of their magnitudes.
    #[default]
    None,
    /// Each parameter divided by the magnitude of its start (by 1 where that is zero): `tol_x` is relative.
    Start,
}

/// Settings of a run; the default is MATLAB's.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// TolX: largest distance of a vertex from the best one, along any coordinate, at which a run may stop.
    pub tol_x: f64,
    /// TolFun: largest difference of a vertex's value from the best one at which a run may stop.
    pub tol_fun: f64,
    /// MaxIter: iterations after which a run stops; `None` means 200 for each coordinate.
    pub max_iter: Option<u64>,
    /// MaxFunEvals: evaluations after which a run stops, at the end of the iteration that reaches them; `None` means as many.
    pub max_fun_evals: Option<u64>,
    /// The box to stay in: bounds for each coordinate, or empty for none.
    pub bounds: Vec<Bounds>,
    /// The coordinates to work in.
    pub scaling: Scaling,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tol_x: 1e-4,
            tol_fun: 1e-4,
            max_iter: None,
            max_fun_evals: None,
            bounds: Vec::new(),
            scaling: Scaling::None,
        }
    }
}

impl Options {
    /// Checks these options and `start` against each other.
    pub(super) fn check(&self, start: &[f64]) -> Result<(), Error> {
        if start.is_empty() {
            return Err(Error::EmptyStart);
        }
        for (name, value) in [("tol_x", self.tol_x), ("tol_fun", self.tol_fun)] {
            if !value.is_finite() || value < 0.0 {
                return Err(Error::Tolerance { name, value });
            }
        }
        if !self.bounds.is_empty() && self.bounds.len() != start.len() {
            return Err(Error::BoundsCount { expected: start.len(), given: self.bounds.len() });
        }
        for (index, &value) in start.iter().enumerate() {
            let bounds = self.bounds_of(index);
            let finite = [bounds.lower, bounds.upper].into_iter().flatten().all(f64::is_finite);
            let ordered = bounds.lower.zip(bounds.upper).is_none_or(|(lower, upper)| lower < upper);
            if !(finite && ordered) {
                return Err(Error::EmptyBounds { index, bounds });
            }
            if !bounds.contain(value) {
                return Err(Error::StartOutside { index, value, bounds });
            }
        }
        Ok(())
    }

    /// The bounds of coordinate `index`.
    pub(super) fn bounds_of(&self, index: usize) -> Bounds {
        self.bounds.get(index).copied().unwrap_or_default()
    }
}
