//! Rectangular grids over parameters: evenly spaced axes and their product.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Largest magnitude of an axis end, so that [`Axis::value`] works for any number of points without
/// overflow: 1e280 · 2⁶⁴ < 1e300.
pub const LARGEST_END: f64 = 1e280;

/// How the points of an axis are spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// Equal differences.
    Linear,
    /// Equal ratios; both ends must be positive.
    Log,
}

/// Why an axis cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum AxisError {
    /// An end is NaN, infinite or too large.
    #[error("`{name}` is {value}: it must be a number of magnitude at most {LARGEST_END:e}")]
    NotANumber {
        /// `from` or `to`.
        name: &'static str,
        /// The end as given.
        value: f64,
    },
    /// A logarithmic axis has an end at or below zero.
    #[error("`{name}` is {value}: both ends of a logarithmic axis must be above zero")]
    NotPositive {
        /// `from` or `to`.
        name: &'static str,
        /// The end as given.
        value: f64,
    },
    /// The ends are in the wrong order.
    #[error("the range is empty: `from` {from} is above `to` {to}")]
    Reversed {
        /// First end as given.
        from: f64,
        /// Last end as given.
        to: f64,
    },
    /// Too few points for two different ends, or several points for equal ends.
    #[error(
        "`points` is {points} between {from} and {to}: an axis has at least 2 points, \
         or exactly 1 where `from` equals `to`"
    )]
    Points {
        /// The number of points as given.
        points: usize,
        /// First end as given.
        from: f64,
        /// Last end as given.
        to: f64,
    },
}

/// Evenly spaced values of one parameter, both ends included. Its fields are checked by [`Axis::new`].
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    from: f64,
    to: f64,
    points: usize,
    scale: Scale,
}

impl Axis {
    /// An axis of `points` values from `from` up to `to`, in the parameter's own unit.
    ///
    /// # Errors
    /// An end that is NaN, infinite or too large (or not above zero on a [`Scale::Log`] axis), `from > to`, or a number
    /// of points other than 1 where `from == to` and other than 2 or more elsewhere.
    pub fn new(from: f64, to: f64, points: usize, scale: Scale) -> Result<Self, AxisError> {
        for (name, value) in [("from", from), ("to", to)] {
            if value.is_nan() || value.abs() > LARGEST_END {
                return Err(AxisError::NotANumber { name, value });
            }
            if scale == Scale::Log && value <= 0.0 {
                return Err(AxisError::NotPositive { name, value });
            }
        }
        if from > to {
            return Err(AxisError::Reversed { from, to });
        }
        if points == 0 || (points == 1) != (from == to) {
            return Err(AxisError::Points { points, from, to });
        }
        Ok(Self { from, to, points, scale })
    }

    /// First value.
    pub fn from(&self) -> f64 {
        self.from
    }

    /// Last value.
    pub fn to(&self) -> f64 {
        self.to
    }

    /// Number of values.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Spacing of the values.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Value number `i`, counted from 0; `i` beyond the last gives the last.
    ///
    /// Each value is computed from the ends alone, so errors do not accumulate along the axis. The ends are exact.
    pub fn value(&self, i: usize) -> f64 {
        if i == 0 {
            return self.from;
        }
        if i >= self.points - 1 {
            return self.to;
        }
        match self.scale {
            Scale::Linear => self.between(self.from, self.to, i),
            Scale::Log => 10_f64.powf(self.between(self.from.log10(), self.to.log10(), i)),
        }
    }

    /// The `i`-th of `points` evenly spaced numbers from `a` to `b`. Multiplying before dividing keeps round
    /// steps round: 2 → 3 in tenths gives 2.1, not 2.1 plus a rounding of 0.1.
    fn between(&self, a: f64, b: f64, i: usize) -> f64 {
        let steps = self.points - 1;
        (a * (steps - i) as f64 + b * i as f64) / steps as f64
    }
}

/// Why a grid cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum GridError {
    /// There is no axis.
    #[error("the grid has no axis")]
    NoAxes,
    /// The product of the axes is larger than the caller allows.
    #[error("the grid has {points:e} points: at most {limit} are allowed")]
    TooLarge {
        /// Number of points; `u128::MAX` stands for that many or more.
        points: u128,
        /// Largest number of points allowed.
        limit: usize,
    },
}

/// All combinations of the values of its axes, numbered row-major: the last axis runs fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    axes: Vec<Axis>,
    len: usize,
}

impl Grid {
    /// The grid over `axes`, of at most `limit` points.
    ///
    /// # Errors
    /// No axis, or more points than `limit`.
    pub fn new(axes: Vec<Axis>, limit: usize) -> Result<Self, GridError> {
        if axes.is_empty() {
            return Err(GridError::NoAxes);
        }
        let points = axes.iter().fold(1_u128, |product, axis| product.saturating_mul(axis.points as u128));
        match usize::try_from(points) {
            Ok(len) if len <= limit => Ok(Self { axes, len }),
            _ => Err(GridError::TooLarge { points, limit }),
        }
    }

    /// The axes, the slowest one first.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Number of axes: the length of a point.
    pub fn dim(&self) -> usize {
        self.axes.len()
    }

    /// Number of points, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "a grid is never empty")]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Index along each axis of point number `i`, written to `steps` (length [`Grid::dim`]).
    pub fn steps(&self, i: usize, steps: &mut [usize]) {
        self.decode(i, |axis, step| steps[axis] = step);
    }

    /// Point number `i` (`0..len()`), written to `point` (length [`Grid::dim`], the order of the axes).
    pub fn point(&self, i: usize, point: &mut [f64]) {
        self.decode(i, |axis, step| point[axis] = self.axes[axis].value(step));
    }

    /// Calls `visit(axis, index along it)` for point number `i`, last axis first.
    fn decode(&self, i: usize, mut visit: impl FnMut(usize, usize)) {
        debug_assert!(i < self.len, "point {i} of a grid of {}", self.len);
        let mut rest = i;
        for (number, axis) in self.axes.iter().enumerate().rev() {
            visit(number, rest % axis.points);
            rest /= axis.points;
        }
    }
}
