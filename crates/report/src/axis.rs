//! An axis as data: its label, its range and its scale.

/// The scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    Linear,
    /// Logarithmic, for values above zero.
    Log,
}

/// An axis of a quantity. Its constructors always give a range that can be drawn.
#[derive(Clone, Debug)]
pub struct Axis {
    pub(crate) label: String,
    pub(crate) scale: Scale,
    pub(crate) range: (f64, f64),
    pub(crate) names: Vec<(f64, String)>,
    pub(crate) second: Option<Box<Axis>>,
}

impl Axis {
    /// A linear axis over a range; one of zero width is widened.
    pub fn linear(label: impl Into<String>, range: (f64, f64)) -> Self {
        Self::new(label, Scale::Linear, range)
    }

    /// A logarithmic axis over a range of values above zero.
    pub fn log(label: impl Into<String>, range: (f64, f64)) -> Self {
        Self::new(label, Scale::Log, range)
    }

    /// An axis over a range. A range that is not finite, or not positive on a logarithmic scale, becomes 0 to 1.
    pub fn new(label: impl Into<String>, scale: Scale, (from, to): (f64, f64)) -> Self {
        let label = label.into();
        if !(from.is_finite() && to.is_finite()) || (scale == Scale::Log && from.min(to) <= 0.0) {
            return Self { label, scale: Scale::Linear, range: (0.0, 1.0), names: Vec::new(), second: None };
        }
        let (from, to) = (from.min(to), from.max(to));
        let flat = to - from <= 1e-12 * from.abs().max(to.abs());
        let range = match scale {
            _ if !flat => (from, to),
            Scale::Linear => {
                let pad = if to == 0.0 { 1.0 } else { 0.05 * to.abs() };
                (from - pad, to + pad)
            }
            Scale::Log => (from / 1.05, to * 1.05),
        };
        Self { label, scale, range, names: Vec::new(), second: None }
    }

    /// A linear axis from 0 to a little beyond the largest of the finite `values`.
    pub fn from_zero(label: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let top = values.into_iter().filter(|value| value.is_finite()).fold(0.0, f64::max);
        Self::linear(label, (0.0, if top > 0.0 { 1.06 * top } else { 1.0 }))
    }

    /// An axis whose scale [`scale_for`] chooses: linear from 0, or logarithmic around all values.
    pub fn fitting(label: impl Into<String>, values: &[f64]) -> Self {
        match scale_for(values) {
            Scale::Log => Self::around(label, Scale::Log, values.iter().copied()),
            Scale::Linear => Self::from_zero(label, values.iter().copied()),
        }
    }

    /// An axis from the smallest to the largest finite value (on a logarithmic scale, the smallest positive one).
    pub fn exact(label: impl Into<String>, scale: Scale, values: impl IntoIterator<Item = f64>) -> Self {
        Self::holding(label, scale, values, 0.0)
    }

    /// Like [`Self::exact`], extended by 8 % at both ends.
    pub fn around(label: impl Into<String>, scale: Scale, values: impl IntoIterator<Item = f64>) -> Self {
        Self::holding(label, scale, values, 0.08)
    }

    /// A categorical axis: each name at its position. A `\n` in a name breaks it into lines.
    pub fn of_names(range: (f64, f64), names: Vec<(f64, String)>) -> Self {
        Self { names, ..Self::linear("", range) }
    }

    /// Adds a second scale, in another unit: its label, and the factor that converts values to it. It is drawn above the frame, for an
    /// abscissa only.
    #[must_use]
    pub fn with_second(self, label: impl Into<String>, factor: f64) -> Self {
        let range = (factor * self.range.0, factor * self.range.1);
        let second = Self::new(label, self.scale, range);
        Self { second: Some(Box::new(second)), ..self }
    }

    fn holding(
        label: impl Into<String>,
        scale: Scale,
        values: impl IntoIterator<Item = f64>,
        room: f64,
    ) -> Self {
        let usable = |v: &f64| v.is_finite() && (scale == Scale::Linear || *v > 0.0);
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) =
            values.into_iter().filter(usable).fold(none, |(low, high), v| (low.min(v), high.max(v)));
        match scale {
            Scale::Linear => Self::new(label, scale, (low - room * (high - low), high + room * (high - low))),
            Scale::Log => {
                let stretch = (high / low).powf(room);
                Self::new(label, scale, (low / stretch, high * stretch))
            }
        }
    }

    /// The position of `value` on the axis, 0 at its beginning and 1 at its end; NaN where it has none.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        let (from, to) = self.range;
        match self.scale {
            Scale::Linear => (value - from) / (to - from),
            Scale::Log if value > 0.0 => (value / from).ln() / (to / from).ln(),
            Scale::Log => f64::NAN,
        }
    }

    /// The smallest and the largest value of the axis.
    pub const fn range(&self) -> (f64, f64) {
        self.range
    }

    /// Whether `value` lies on the axis.
    pub fn holds(&self, value: f64) -> bool {
        self.range.0 <= value && value <= self.range.1
    }
}

/// The scale for some values: logarithmic if the finite ones are all positive and span more than a decade, else linear.
pub fn scale_for(values: &[f64]) -> Scale {
    let usable = values.iter().filter(|v| v.is_finite());
    let (low, high) = usable.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(*v), high.max(*v)));
    if low > 0.0 && high > 10.0 * low { Scale::Log } else { Scale::Linear }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_share_is_even_on_the_scale() {
        let fraction = |scale, value| Axis::new("", scale, (2.0, 200.0)).fraction(value);
        assert!((fraction(Scale::Linear, 101.0) - 0.5).abs() < 1e-14);
        assert!((fraction(Scale::Log, 20.0) - 0.5).abs() < 1e-14);
        assert!(fraction(Scale::Log, 1.0) < 0.0 && fraction(Scale::Log, 300.0) > 1.0);
        assert!(fraction(Scale::Log, 0.0).is_nan() && fraction(Scale::Log, -1.0).is_nan());
    }

    #[test]
    fn contract_ranges_that_cannot_be_drawn_are_mended() {
        let range = |scale, from, to| Axis::new("", scale, (from, to)).range;
        assert_eq!(range(Scale::Linear, 3.0, 1.0), (1.0, 3.0));
        for wrong in [(f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            assert_eq!(range(Scale::Linear, wrong.0, wrong.1), (0.0, 1.0));
        }
        assert_eq!(range(Scale::Log, 0.0, 1.0), (0.0, 1.0));
        for (scale, value) in [(Scale::Linear, 5.0), (Scale::Linear, 0.0), (Scale::Log, 1e-9)] {
            let axis = Axis::around("", scale, [value, value, f64::NAN]);
            assert!(axis.holds(value) && axis.range.0 < axis.range.1, "{scale:?} {value}");
        }
        assert!(Axis::around("", Scale::Log, [f64::NAN]).holds(0.5));
    }

    #[test]
    fn contract_more_than_a_decade_is_logarithmic() {
        assert_eq!(scale_for(&[1.0, 11.0, f64::INFINITY]), Scale::Log);
        assert_eq!(scale_for(&[1.0, 9.0]), Scale::Linear);
        assert_eq!(scale_for(&[-1.0, 900.0]), Scale::Linear);
    }
}
