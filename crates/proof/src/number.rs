//! What the equations of motion are evaluated in: intervals or functions of a parameter, alone or with their derivatives by the coordinates of a state.

use crate::{Interval, Taylor, cos_sin};
use std::ops::{Add, Mul, Sub};

/// Coordinates of a state: four of the motion, the phase of the force, and the speed of a contact that loses energy.
pub const STATE: usize = 6;
/// The place of that speed.
pub const SPEED: usize = 5;
/// Coordinates that are free on a section.
pub const FREE: usize = 4;

/// Intervals, one for each coordinate.
pub type State = [Interval; STATE];
/// Functions of the parameter of a family, one for each coordinate.
pub type Family = [Taylor; STATE];

/// A quantity that sums and products can be taken of.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// A constant.
    fn constant(value: Interval) -> Self;
    /// A function of the parameter.
    fn of(function: Taylor) -> Self;
    /// A multiple by a constant.
    fn times(self, factor: Interval) -> Self {
        self * Self::constant(factor)
    }
    /// `[cos x, sin x]`.
    fn cos_sin(self) -> [Self; 2];
    /// `1/x`.
    fn reciprocal(self) -> Self;
}

impl Number for Interval {
    fn constant(value: Interval) -> Self {
        value
    }

    fn of(function: Taylor) -> Self {
        function.hull()
    }

    fn cos_sin(self) -> [Self; 2] {
        cos_sin(self)
    }

    fn reciprocal(self) -> Self {
        Self::ONE / self
    }
}

impl Number for Taylor {
    fn constant(value: Interval) -> Self {
        Self::from(value)
    }

    fn of(function: Taylor) -> Self {
        function
    }

    fn times(self, factor: Interval) -> Self {
        if factor == Interval::ONE { self } else { self * Self::from(factor) }
    }

    fn cos_sin(self) -> [Self; 2] {
        self.cos_sin()
    }

    fn reciprocal(self) -> Self {
        self.reciprocal()
    }
}

/// A quantity with its derivatives by the coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Gradient<T> {
    /// The quantity.
    pub value: T,
    /// Its derivatives.
    pub by: [T; STATE],
}

impl<T: Number> Gradient<T> {
    /// The coordinates of a state as quantities: the derivative of each by itself is one.
    pub fn coordinates(state: &[T; STATE]) -> [Self; STATE] {
        let entry = |is_own: bool| T::constant(if is_own { Interval::ONE } else { Interval::ZERO });
        std::array::from_fn(|i| Self { value: state[i], by: std::array::from_fn(|j| entry(i == j)) })
    }

    /// What does not depend on the state.
    fn of_value(value: T) -> Self {
        Self { value, by: [T::constant(Interval::ZERO); STATE] }
    }

    fn zip(self, other: Self, value: T, by: impl Fn(T, T) -> T) -> Self {
        Self { value, by: std::array::from_fn(|j| by(self.by[j], other.by[j])) }
    }
}

impl<T: Number> Add for Gradient<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.zip(other, self.value + other.value, |a, b| a + b)
    }
}

impl<T: Number> Sub for Gradient<T> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.zip(other, self.value - other.value, |a, b| a - b)
    }
}

impl<T: Number> Mul for Gradient<T> {
    type Output = Self;

    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
    fn mul(self, other: Self) -> Self {
        self.zip(other, self.value * other.value, |a, b| a * other.value + self.value * b)
    }
}

impl<T: Number> Number for Gradient<T> {
    fn constant(value: Interval) -> Self {
        Self::of_value(T::constant(value))
    }

    fn of(function: Taylor) -> Self {
        Self::of_value(T::of(function))
    }

    fn times(self, factor: Interval) -> Self {
        Self { value: self.value.times(factor), by: self.by.map(|by| by.times(factor)) }
    }

    fn cos_sin(self) -> [Self; 2] {
        let [cos, sin] = self.value.cos_sin();
        let minus_sin = T::constant(Interval::ZERO) - sin;
        [
            Self { value: cos, by: self.by.map(|by| minus_sin * by) },
            Self { value: sin, by: self.by.map(|by| cos * by) },
        ]
    }

    fn reciprocal(self) -> Self {
        let value = self.value.reciprocal();
        let slope = T::constant(Interval::ZERO) - value * value;
        Self { value, by: self.by.map(|by| slope * by) }
    }
}
