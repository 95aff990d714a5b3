//! What the equations of motion are evaluated in: intervals, or intervals with their derivatives by the five coordinates of a state.

use crate::Interval;
use crate::elementary::cos_sin;
use std::ops::{Add, Mul, Sub};

/// Coordinates of a state: four of the motion, the phase of the force, and its frequency, which does not change.
pub const STATE: usize = 6;
/// The place of the frequency.
pub const OMEGA: usize = 5;
/// Coordinates that are free on a section.
pub const FREE: usize = 4;

/// Intervals, one for each coordinate.
pub type State = [Interval; STATE];

/// A quantity that sums and products can be taken of.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// A constant.
    fn constant(value: Interval) -> Self;
    /// A multiple by a constant.
    fn times(self, factor: Interval) -> Self;
    /// `[cos x, sin x]`.
    fn cos_sin(self) -> [Self; 2];
}

impl Number for Interval {
    fn constant(value: Interval) -> Self {
        value
    }

    fn times(self, factor: Interval) -> Self {
        self * factor
    }

    fn cos_sin(self) -> [Self; 2] {
        cos_sin(self)
    }
}

/// A quantity with its derivatives by the coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Gradient {
    /// The quantity.
    pub value: Interval,
    /// Its derivatives.
    pub by: State,
}

impl Gradient {
    /// The coordinates of a state as quantities: the derivative of each by itself is one.
    pub fn coordinates(state: &State) -> [Self; STATE] {
        std::array::from_fn(|i| {
            let by = std::array::from_fn(|j| if i == j { Interval::ONE } else { Interval::ZERO });
            Self { value: state[i], by }
        })
    }

    fn zip(self, other: Self, value: Interval, by: impl Fn(Interval, Interval) -> Interval) -> Self {
        Self { value, by: std::array::from_fn(|j| by(self.by[j], other.by[j])) }
    }
}

impl Add for Gradient {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.zip(other, self.value + other.value, |a, b| a + b)
    }
}

impl Sub for Gradient {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.zip(other, self.value - other.value, |a, b| a - b)
    }
}

impl Mul for Gradient {
    type Output = Self;

    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
    fn mul(self, other: Self) -> Self {
        self.zip(other, self.value * other.value, |a, b| a * other.value + self.value * b)
    }
}

impl Number for Gradient {
    fn constant(value: Interval) -> Self {
        Self { value, by: [Interval::ZERO; STATE] }
    }

    fn times(self, factor: Interval) -> Self {
        Self { value: self.value * factor, by: self.by.map(|by| by * factor) }
    }

    fn cos_sin(self) -> [Self; 2] {
        let [cos, sin] = cos_sin(self.value);
        [
            Self { value: cos, by: self.by.map(|by| -(sin * by)) },
            Self { value: sin, by: self.by.map(|by| cos * by) },
        ]
    }
}
