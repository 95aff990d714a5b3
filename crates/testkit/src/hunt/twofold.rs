//! Numbers of twice the precision, each a sum of two that do not overlap (T. J. Dekker, Numer. Math. 18, 1971).

use std::ops::{Add, Mul, Sub};

#[derive(Clone, Copy, Debug)]
pub struct Twofold(f64, f64);

impl Twofold {
    pub fn value(self) -> f64 {
        self.0
    }

    pub fn sqrt(self) -> Self {
        let root = self.0.sqrt();
        let rest = self - Self::from(root) * Self::from(root);
        Self::from(root) + Self::from(0.5 * rest.0 / root)
    }
}

impl From<f64> for Twofold {
    fn from(value: f64) -> Self {
        Self(value, 0.0)
    }
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

impl Add for Twofold {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = two_sum(self.0, other.0);
        let (tail, rest) = two_sum(self.1, other.1);
        let (high, low) = two_sum(high, low + tail);
        let (high, low) = two_sum(high, low + rest);
        Self(high, low)
    }
}

impl Sub for Twofold {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self(-other.0, -other.1)
    }
}

impl Mul for Twofold {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.0 * other.0;
        let low = self.0.mul_add(other.0, -high) + (self.0 * other.1 + self.1 * other.0);
        let (high, low) = two_sum(high, low);
        Self(high, low)
    }
}
