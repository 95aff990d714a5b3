//! A box of parameters in coordinates from 0 to 1, in which distances are comparable along all axes.

use crate::search::grid::Scale;

/// One side of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Smallest value, in the parameter's unit; above 0 on a [`Scale::Log`] side.
    pub from: f64,
    /// Largest value, above the smallest.
    pub to: f64,
    /// Whether equal distances are equal differences or equal ratios.
    pub scale: Scale,
}

impl Side {
    /// A side with its natural scale: logarithmic if it is above zero and spans a decade or more, else linear.
    pub fn natural(from: f64, to: f64) -> Self {
        let scale = if from > 0.0 && to >= 10.0 * from { Scale::Log } else { Scale::Linear };
        Self { from, to, scale }
    }

    /// The value at the coordinate `u`; both ends are exact.
    pub fn value(&self, u: f64) -> f64 {
        if u <= 0.0 {
            return self.from;
        }
        if u >= 1.0 {
            return self.to;
        }
        match self.scale {
            Scale::Linear => self.from + u * (self.to - self.from),
            Scale::Log => self.from * (self.to / self.from).powf(u),
        }
    }

    /// The derivative of the value by the coordinate, at a value.
    pub fn slope(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => self.to - self.from,
            Scale::Log => value * (self.to / self.from).ln(),
        }
    }

    /// The coordinate of a value, from 0 to 1 inside the box.
    pub fn coordinate(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.from) / (self.to - self.from),
            Scale::Log => (value.max(f64::MIN_POSITIVE) / self.from).ln() / (self.to / self.from).ln(),
        }
    }
}

/// A box.
#[derive(Clone, Debug, PartialEq)]
pub struct Space(pub Vec<Side>);

impl Space {
    /// Number of sides.
    pub fn dim(&self) -> usize {
        self.0.len()
    }

    /// The parameters at `u`.
    pub fn point(&self, u: &[f64]) -> Vec<f64> {
        self.0.iter().zip(u).map(|(side, &u)| side.value(u)).collect()
    }

    /// The derivatives of the parameters by their coordinates.
    pub fn slopes(&self, x: &[f64]) -> Vec<f64> {
        self.0.iter().zip(x).map(|(side, &x)| side.slope(x)).collect()
    }

    /// The coordinates of parameters.
    pub fn coordinates(&self, x: &[f64]) -> Vec<f64> {
        self.0.iter().zip(x).map(|(side, &x)| side.coordinate(x)).collect()
    }

    /// The largest difference between the coordinates of two designs, over all sides.
    pub fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let (a, b) = (self.coordinates(a), self.coordinates(b));
        a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}
