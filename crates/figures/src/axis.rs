//! An axis: its range, its scale and its ticks.

/// The scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    Linear,
    /// Logarithmic, for values above zero.
    Log,
}

/// An axis of a quantity.
pub struct Axis {
    label: String,
    scale: Scale,
    from: f64,
    to: f64,
}

impl Axis {
    /// An axis from `from` to `to`; a range of zero width is widened.
    pub fn new(label: String, scale: Scale, from: f64, to: f64) -> Self {
        let pad = if to > from { 0.0 } else { 0.05 * from.abs().max(1e-3) };
        Self { label, scale, from: from - pad, to: to + pad }
    }

    /// An axis from the smallest to the largest of the finite `values` (on a logarithmic scale: of those above zero).
    pub fn exact(label: String, scale: Scale, values: &[f64]) -> Self {
        Self::holding(label, scale, values, 0.0)
    }

    /// As [`Self::exact`], extended by 8 % at both ends.
    pub fn around(label: String, scale: Scale, values: &[f64]) -> Self {
        Self::holding(label, scale, values, 0.08)
    }

    fn holding(label: String, scale: Scale, values: &[f64], room: f64) -> Self {
        let usable = |v: &f64| v.is_finite() && (scale == Scale::Linear || *v > 0.0);
        let ends = |(low, high): (f64, f64), v: f64| (low.min(v), high.max(v));
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = values.iter().copied().filter(usable).fold(none, ends);
        if low > high {
            return Self::new(label, Scale::Linear, 0.0, 1.0);
        }
        match scale {
            Scale::Linear => Self::new(label, scale, low - room * (high - low), high + room * (high - low)),
            Scale::Log => {
                let stretch = (high / low).powf(room);
                Self::new(label, scale, low / stretch, high * stretch)
            }
        }
    }

    /// The quantity with its unit.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// The position of `value` on the axis, 0 to 1; a value outside the range is clamped, NaN gives 0.
    pub fn share(&self, value: f64) -> f64 {
        let share = match self.scale {
            Scale::Linear => (value - self.from) / (self.to - self.from),
            Scale::Log => (value / self.from).ln() / (self.to / self.from).ln(),
        };
        if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }
    }

    /// Whether `value` lies on the axis.
    pub fn holds(&self, value: f64) -> bool {
        self.from <= value && value <= self.to
    }

    /// The ticks, at round numbers, about `count` of them, with their text.
    pub fn ticks(&self, count: i32) -> Vec<(f64, String)> {
        let values = match self.scale {
            Scale::Log if self.to / self.from >= 5.0 => self.log_ticks(),
            _ => self.linear_ticks(f64::from(count.max(2))),
        };
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        let step = match values.as_slice() {
            [first, second, ..] if self.scale == Scale::Linear => second - first,
            _ => 0.0,
        };
        values.into_iter().map(|value| (value, words(value, step, size))).collect()
    }

    /// Multiples of 1, 2 or 5 times a power of ten, about `count` of them.
    fn linear_ticks(&self, count: f64) -> Vec<f64> {
        let rough = (self.to - self.from) / count;
        let power = 10_f64.powf(rough.log10().floor());
        let factor = match rough / power {
            f if f < 1.5 => 1.0,
            f if f < 3.5 => 2.0,
            f if f < 7.5 => 5.0,
            _ => 10.0,
        };
        let step = factor * power;
        let (first, last) = ((self.from / step - 1e-9).ceil() as i64, (self.to / step + 1e-9).floor() as i64);
        (first..=last.min(first + 20)).map(|i| i as f64 * step).collect()
    }

    /// Powers of ten, with 2 and 5 times them where there is room.
    fn log_ticks(&self) -> Vec<f64> {
        let decades = (self.to / self.from).log10();
        let factors: &[f64] = if decades <= 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (first, last) = (self.from.log10().floor() as i32, self.to.log10().ceil() as i32);
        let every = ((last - first) / 8).max(1) as usize;
        let all = (first..=last).step_by(every).flat_map(|n| factors.iter().map(move |f| f * 10_f64.powi(n)));
        all.filter(|value| (self.from * (1.0 - 1e-9)..=self.to * (1.0 + 1e-9)).contains(value)).collect()
    }
}

/// The scale for some values: logarithmic if the finite ones are all positive and span more than a decade, else linear.
pub fn scale_for(values: &[f64]) -> Scale {
    let usable = values.iter().filter(|v| v.is_finite());
    let (low, high) = usable.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(*v), high.max(*v)));
    if low > 0.0 && high > 10.0 * low { Scale::Log } else { Scale::Linear }
}

/// A tick's number with as many decimals as the step needs; `size` is the largest on the axis.
fn words(value: f64, step: f64, size: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&size) {
        let text = format!("{value:.2e}");
        return text.replace(".00e", "e").replace("0e", "e");
    }
    if step > 0.0 {
        let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
        return format!("{value:.decimals$}");
    }
    // Of 0.1 * 3 only the digits that were meant.
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    format!("{rounded}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, from: f64, to: f64) -> Vec<String> {
        Axis::new(String::new(), scale, from, to).ticks(5).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn contract_ticks_are_round_numbers() {
        assert_eq!(labels(Scale::Linear, 0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(
            labels(Scale::Linear, 0.02, 0.14),
            ["0.02", "0.04", "0.06", "0.08", "0.10", "0.12", "0.14"]
        );
        assert_eq!(labels(Scale::Log, 30.0, 3000.0), ["50", "100", "200", "500", "1000", "2000"]);
        assert_eq!(labels(Scale::Log, 1e-3, 1e3), ["0.001", "0.01", "0.1", "1", "10", "100", "1000"]);
    }

    #[test]
    fn exact_share_is_even_on_the_scale() {
        let share = |scale, value| Axis::new(String::new(), scale, 2.0, 200.0).share(value);
        assert!((share(Scale::Linear, 101.0) - 0.5).abs() < 1e-14);
        assert!((share(Scale::Log, 20.0) - 0.5).abs() < 1e-14);
        assert_eq!(
            [share(Scale::Log, 1.0), share(Scale::Log, 300.0), share(Scale::Log, f64::NAN)],
            [0.0, 1.0, 0.0]
        );
    }

    #[test]
    fn contract_empty_and_flat_ranges_have_axes() {
        let none = Axis::around(String::new(), Scale::Log, &[f64::NAN]);
        assert!(none.holds(0.5) && !none.ticks(5).is_empty());
        let flat = Axis::around(String::new(), Scale::Linear, &[5.0, 5.0]);
        assert!(flat.holds(5.0) && !flat.ticks(5).is_empty());
    }
}
