//! Forces given by a formula or a spectrum: they become samples with straight lines between them.
//!
//! Sample `i` is `f - h²/12 f''` and not `f`: then a straight line over each piece has the impulse of the force itself to the fifth order of
//! the distance `h`, and the motion is that of the force to the fourth. The force itself is off by no more than [`Recipe::error`].

use crate::record::{BadSamples, Samples, kept};
use crate::{Finite, NonNegative, Positive, Unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::Mutex;

/// A force of a recipe, with its samples.
#[derive(Clone, Copy, Debug)]
pub struct Made {
    recipe: &'static Recipe,
    samples: Samples,
}

/// The definition of a sampled force.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// Its form.
    pub form: Form,
    /// The unit of its amplitudes.
    pub unit: Unit,
    /// How long it lasts from t = 0 on, s.
    pub duration: Positive,
    /// The time between two samples, s, if given.
    pub step: Option<Positive>,
}

/// The forms of a [`Recipe`].
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A versed sine, `peak (1 - cos(2π t / duration)) / 2`.
    VersedSine(Finite),
    /// A sum of harmonics.
    Harmonics(Vec<Harmonic>),
    /// A harmonic whose frequency grows or falls.
    Sweep(Sweep),
    /// One draw of a stationary random force.
    Spectrum(Spectrum),
}

/// The harmonic `amplitude cos(omega t + phase)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// amplitude, in the unit of the force or acceleration.
    pub amplitude: Finite,
    /// omega, angular frequency, rad/s.
    pub omega: NonNegative,
    /// phase at t = 0, rad; 0 if left out.
    #[serde(default)]
    pub phase: Finite,
}

/// `amplitude cos(from t + rate t²/2)`: its frequency is `from + rate t`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// amplitude, in the unit of the force or acceleration.
    pub amplitude: Finite,
    /// from, angular frequency at t = 0, rad/s.
    pub from: NonNegative,
    /// rate at which the angular frequency grows, rad/s in a second; below 0 it falls.
    pub rate: Finite,
}

/// A stationary random force with this one-sided spectral density, drawn by the sum of M. Shinozuka and G. Deodatis (Appl. Mech. Rev. 44
/// (1991) 191): harmonics at the middles of equal intervals `Δω`, of amplitude `√(2 S(ω) Δω)` and with phases drawn from the seed. There are so
/// many that the sum does not repeat within its duration. In the place of a table `white` with `to` is white noise, of which a draw has the
/// frequencies up to `to`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spectrum {
    /// omega, angular frequencies of the table, growing, rad/s.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub omega: Vec<NonNegative>,
    /// density S at each of them, straight lines between: the variance is its integral over omega. The square of the unit, times s/rad.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub density: Vec<NonNegative>,
    /// white, the density of white noise at all frequencies, in the place of a table. The square of the unit, times s/rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub white: Option<NonNegative>,
    /// to, the largest frequency of a draw of white noise, rad/s; the stationary motion is that under all frequencies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Positive>,
    /// seed of the draw.
    #[serde(default)]
    pub seed: u64,
}

/// Why there are no samples.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Unmade {
    /// A spectrum without a valid table.
    #[error(
        "`spectrum`: {0} frequencies with {1} densities are not allowed here: give two or more frequencies that grow, and a density for each, or \
         `white` with `to` alone"
    )]
    Table(usize, usize),
    /// A sum of nothing.
    #[error("`harmonics`: empty: give at least one")]
    Nothing,
    /// Too much to compute.
    #[error(
        "`duration`: {duration} s are not allowed here: with a sample each {step} s that is more than {MOST} samples, or {MOST_TERMS} terms of a spectrum; give a shorter duration, or a longer `step`"
    )]
    Many {
        /// As given, s.
        duration: f64,
        /// As given or chosen, s.
        step: f64,
    },
    /// Samples that are not a valid record.
    #[error("`step`: {0}")]
    Samples(#[from] BadSamples),
}

/// Allowed error of a formula where no step is given, as a share of the sum of all amplitudes; less for a pulse, which is short.
const ERROR: f64 = 1e-5;
const ERROR_OF_A_PULSE: f64 = 1e-6;
/// The step of the samples of a spectrum times its largest frequency, where none is given: 31 samples in its shortest period.
const FINE: f64 = 0.2;
/// Maximum number of samples.
const MOST: f64 = 1e7;
/// Maximum number of summed terms, over all samples.
const MOST_TERMS: f64 = 2e9;
/// Number of samples over which a term is advanced by rotation before it is evaluated anew.
const BLOCK: usize = 64;

/// `amplitude cos(phase + omega t + rate t²/2)`.
#[derive(Clone, Copy)]
struct Term {
    amplitude: f64,
    omega: f64,
    rate: f64,
    phase: f64,
}

static RECIPES: Mutex<Vec<&'static Recipe>> = Mutex::new(Vec::new());

impl Made {
    /// Computes the samples.
    ///
    /// # Errors
    /// [`Unmade`].
    pub fn new(recipe: Recipe) -> Result<Self, Unmade> {
        let samples = recipe.samples()?;
        Ok(Self { recipe: kept(&RECIPES, recipe), samples })
    }

    /// Its recipe.
    pub fn recipe(&self) -> &'static Recipe {
        self.recipe
    }

    /// Its samples, SI units.
    pub fn samples(&self) -> Samples {
        self.samples
    }

    /// The force of the same recipe with samples `times` as dense.
    ///
    /// # Errors
    /// [`Unmade`].
    pub fn denser(&self, times: f64) -> Result<Self, Unmade> {
        let step = Positive::new(self.recipe.pieces().1 / times).ok();
        Self::new(Recipe { step, ..self.recipe.clone() })
    }
}

impl PartialEq for Made {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.recipe, other.recipe)
    }
}

impl Recipe {
    /// A bound on the error of the force between two samples and at them, N or m/s²: `5/24 h² max |f''|`, of which `h²/8` is due to the
    /// straight line and `h²/12` to the correction for the impulse.
    pub fn error(&self) -> f64 {
        let [_, curvature] = self.sizes();
        5.0 / 24.0 * self.pieces().1.powi(2) * curvature
    }

    /// Bounds on the force and on its second derivative: the sums of its terms' bounds.
    fn sizes(&self) -> [f64; 2] {
        let end = self.duration.get();
        let bounds = |term: Term| {
            let fastest = term.omega.abs().max((term.omega + term.rate * end).abs());
            [term.amplitude.abs(), term.amplitude.abs() * (fastest * fastest + term.rate.abs())]
        };
        self.terms().into_iter().map(bounds).fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]])
    }

    /// The number of pieces and their length, s.
    fn pieces(&self) -> (f64, f64) {
        let duration = self.duration.get();
        let longest = match (&self.step, &self.form) {
            (Some(step), _) => step.get(),
            (None, Form::Spectrum(spectrum)) => FINE / spectrum.ends()[1],
            (None, form) => {
                let [force, curvature] = self.sizes();
                let error = if matches!(form, Form::VersedSine(_)) { ERROR_OF_A_PULSE } else { ERROR };
                (error * 24.0 / 5.0 * force / curvature).sqrt()
            }
        };
        // For a constant `longest` is infinite, for zero NaN.
        let count = (duration / longest.min(duration)).ceil().max(1.0);
        (count, duration / count)
    }

    fn samples(&self) -> Result<Samples, Unmade> {
        match &self.form {
            Form::Harmonics(harmonics) if harmonics.is_empty() => return Err(Unmade::Nothing),
            Form::Spectrum(spectrum) if !spectrum.is_table() => {
                return Err(Unmade::Table(spectrum.omega.len(), spectrum.density.len()));
            }
            _ => {}
        }
        let (count, step) = self.pieces();
        let many = Unmade::Many { duration: self.duration.get(), step };
        if count > MOST || count * self.number_of_terms() > MOST_TERMS {
            return Err(many);
        }
        let mut values = vec![0.0; count as usize + 1];
        self.terms().into_iter().for_each(|term| term.add(step, &mut values));
        Ok(Samples::every(0.0, step, values)?)
    }

    fn number_of_terms(&self) -> f64 {
        match &self.form {
            Form::VersedSine(_) => 2.0,
            Form::Sweep(_) => 1.0,
            Form::Harmonics(harmonics) => harmonics.len() as f64,
            Form::Spectrum(spectrum) => spectrum.intervals(self.duration.get()),
        }
    }

    /// The terms of the sum, SI units.
    fn terms(&self) -> Vec<Term> {
        let (size, duration) = (self.unit.1, self.duration.get());
        let harmonic =
            |amplitude, omega, phase| Term { amplitude: size * amplitude, omega, rate: 0.0, phase };
        match &self.form {
            Form::VersedSine(peak) => {
                let half = 0.5 * peak.get();
                vec![harmonic(half, 0.0, 0.0), harmonic(-half, TAU / duration, 0.0)]
            }
            Form::Harmonics(all) => {
                all.iter().map(|of| harmonic(of.amplitude.get(), of.omega.get(), of.phase.get())).collect()
            }
            Form::Sweep(Sweep { amplitude, from, rate }) => {
                vec![Term { rate: rate.get(), ..harmonic(amplitude.get(), from.get(), 0.0) }]
            }
            Form::Spectrum(spectrum) => {
                let drawn = spectrum.drawn(duration);
                drawn.map(|[amplitude, omega, phase]| harmonic(amplitude, omega, phase)).collect()
            }
        }
    }
}

impl Term {
    /// Adds `f - h²/12 f''` at the samples, `step` (s) apart.
    fn add(&self, step: f64, values: &mut [f64]) {
        let Self { amplitude, omega, rate, phase } = *self;
        let share = step * step / 12.0;
        if rate != 0.0 {
            for (i, value) in values.iter_mut().enumerate() {
                let t = i as f64 * step;
                let (sin, cos) = (phase + (omega + 0.5 * rate * t) * t).sin_cos();
                *value += amplitude * (cos + share * ((omega + rate * t).powi(2) * cos + rate * sin));
            }
            return;
        }
        let (size, turn) = (amplitude * (1.0 + share * omega * omega), (omega * step).sin_cos());
        for (block, values) in values.chunks_mut(BLOCK).enumerate() {
            let (sin, cos) = (phase + omega * ((block * BLOCK) as f64 * step)).sin_cos();
            let mut now = [size * cos, size * sin];
            for value in values {
                *value += now[0];
                now = [now[0] * turn.1 - now[1] * turn.0, now[1] * turn.1 + now[0] * turn.0];
            }
        }
    }
}

impl Spectrum {
    fn is_table(&self) -> bool {
        let Self { omega, density, white, to, .. } = self;
        if white.is_some() || to.is_some() {
            return self.white_density().is_some() && omega.is_empty() && density.is_empty();
        }
        omega.len() >= 2
            && omega.len() == density.len()
            && omega.windows(2).all(|pair| pair[0].get() < pair[1].get())
    }

    /// The one-sided density of white noise, the square of the unit times s/rad; none of a table.
    pub fn white_density(&self) -> Option<f64> {
        self.to.and(self.white).map(NonNegative::get)
    }

    pub(crate) fn ends(&self) -> [f64; 2] {
        if let Some(to) = self.to {
            return [0.0, to.get()];
        }
        [self.omega.first(), self.omega.last()].map(|omega| omega.map_or(0.0, |omega| omega.get()))
    }

    /// The number of intervals with which the sum does not repeat before the duration ends.
    fn intervals(&self, duration: f64) -> f64 {
        let [from, to] = self.ends();
        ((to - from) * duration / TAU).ceil().max(self.omega.len() as f64)
    }

    /// Amplitude, frequency (rad/s) and phase of each harmonic.
    fn drawn(&self, duration: f64) -> impl Iterator<Item = [f64; 3]> + use<'_> {
        let ([from, to], count) = (self.ends(), self.intervals(duration));
        let (width, mut state) = ((to - from) / count, self.seed);
        (0..count as usize).map(move |i| {
            let omega = from + (i as f64 + 0.5) * width;
            [(2.0 * self.density_at(omega) * width).sqrt(), omega, TAU * drawn_number(&mut state)]
        })
    }

    pub(crate) fn density_at(&self, omega: f64) -> f64 {
        if let Some(white) = self.white_density() {
            return white;
        }
        let i = self.omega.partition_point(|known| known.get() <= omega).clamp(1, self.omega.len() - 1);
        let [a, b] = [self.omega[i - 1].get(), self.omega[i].get()];
        let [low, high] = [self.density[i - 1].get(), self.density[i].get()];
        low + (high - low) * (omega - a) / (b - a)
    }
}

/// The next random number, from 0 to below 1: SplitMix64 (G. L. Steele, D. Lea and C. H. Flood, Proc. OOPSLA 2014, 453).
pub fn drawn_number(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut mixed = *state;
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests;
