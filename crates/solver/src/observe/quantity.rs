//! The quantities that are observed in a run.

use crate::motion::form::Form;
use crate::motion::knot::Knot;
use crate::motion::lanes::LANES;
use crate::motion::segment::Segment;
use retune_model::{Bare, Coupled, Excitation};
use wide::f64x4;

/// A quantity that depends on the force and the state.
pub trait Quantity<const N: usize> {
    /// Its value with its first two time derivatives. The value itself must depend on the state alone, unless
    /// [`Self::form`] says otherwise: between the ends of a [`Path`](crate::observe::Path) it is evaluated without the force.
    fn rates(&self, excitation: Excitation, y: &[f64; N]) -> [f64; 3];
    /// [`Self::rates`] at moments of flight side by side, without contact forces even if rounding has left the damper inside a wall.
    #[inline(always)]
    fn rates_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; N]) -> [f64x4; 3] {
        let mut rates = [f64x4::ZERO; 3];
        for lane in 0..LANES {
            let at = self.rates(excitation.map(|c| c.to_array()[lane]), &y.map(|c| c.to_array()[lane]));
            for (all, one) in rates.iter_mut().zip(at) {
                all.as_mut_array()[lane] = one;
            }
        }
        rates
    }
    /// The value from the state alone, without the force.
    #[inline(always)]
    fn value(&self, y: &[f64; N]) -> f64 {
        if self.is_forced() {
            return self.rates([0.0; 2], y)[0];
        }
        // Contact forces enter the derivatives alone.
        self.rates_in_flight(&[f64x4::ZERO; 2], &y.map(f64x4::splat))[0].to_array()[0]
    }
    /// The quantity as a polynomial in the state, from which its bounds follow.
    fn form(&self) -> &Form<N>;
    /// Whether the value depends on the force and on contact forces as well as on the state, as a form with the rate of the state does.
    #[inline(always)]
    fn is_forced(&self) -> bool {
        false
    }
    /// The sum of the magnitudes of its terms, which sets its rounding error.
    fn size(&self, y: &[f64; N]) -> f64 {
        self.form().size(y)
    }
}

/// A quantity with its first two time derivatives at a moment of a segment.
#[inline(always)]
pub fn rates_in<const N: usize>(
    segment: &dyn Segment<N>,
    at: &Knot<N>,
    quantity: &impl Quantity<N>,
) -> [f64; 3] {
    match segment.jet(at) {
        None => at.rates(quantity, segment.in_flight()),
        Some(jet) => quantity.form().rates(&jet),
    }
}

impl<const N: usize> Knot<N> {
    /// A quantity with its first two time derivatives at this moment; `in_flight` as in
    /// [`Segment`](crate::observe::Segment).
    #[inline(always)]
    pub fn rates(&self, quantity: &impl Quantity<N>, in_flight: bool) -> [f64; 3] {
        if in_flight {
            let (excitation, y) = (self.excitation.map(f64x4::splat), self.y.map(f64x4::splat));
            quantity.rates_in_flight(&excitation, &y).map(|lanes| lanes.to_array()[0])
        } else {
            quantity.rates(self.excitation, &self.y)
        }
    }
}

/// The energy of the primary structure without a damper, J.
pub struct BareEnergy<'a> {
    system: &'a Bare,
    form: Form<2>,
}

impl<'a> BareEnergy<'a> {
    /// The energy of this structure.
    pub fn new(system: &'a Bare) -> Self {
        Self { system, form: Form::energy(system, system.primary_energy_weights(), [0, 1]) }
    }
}

impl Quantity<2> for BareEnergy<'_> {
    #[inline(always)]
    fn rates(&self, excitation: Excitation, y: &[f64; 2]) -> [f64; 3] {
        self.system.primary_energy_rates(excitation, y)
    }
    fn form(&self) -> &Form<2> {
        &self.form
    }
}

/// The energy of the primary structure, E1, J.
pub struct PrimaryEnergy<'a> {
    system: &'a Coupled,
    form: Form<4>,
}

impl<'a> PrimaryEnergy<'a> {
    /// The energy in a coupled system.
    pub fn new(system: &'a Coupled) -> Self {
        Self { system, form: Form::energy(system, system.bare().primary_energy_weights(), [0, 1]) }
    }
}

impl Quantity<4> for PrimaryEnergy<'_> {
    #[inline(always)]
    fn rates(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 3] {
        self.system.primary_energy_rates(excitation, y)
    }
    #[inline(always)]
    fn rates_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> [f64x4; 3] {
        self.system.primary_energy_rates_in_flight(excitation, y)
    }
    fn form(&self) -> &Form<4> {
        &self.form
    }
}

/// The paper's energy of the damper, E2, J.
pub struct DamperEnergy<'a> {
    system: &'a Coupled,
    form: Form<4>,
}

impl<'a> DamperEnergy<'a> {
    /// The energy in a coupled system.
    pub fn new(system: &'a Coupled) -> Self {
        Self { system, form: Form::energy(system, system.damper_energy_weights(), [2, 3]) }
    }
}

impl Quantity<4> for DamperEnergy<'_> {
    #[inline(always)]
    fn rates(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 3] {
        self.system.damper_energy_rates(excitation, y)
    }
    #[inline(always)]
    fn rates_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> [f64x4; 3] {
        self.system.damper_energy_rates_in_flight(excitation, y)
    }
    fn form(&self) -> &Form<4> {
        &self.form
    }
}

/// The damper's position relative to the structure, `r = x2 - x1` (m), or its negative.
pub struct RelativePosition<'a> {
    system: &'a Coupled,
    sign: f64,
    form: Form<4>,
}

impl<'a> RelativePosition<'a> {
    /// `sign r` of a coupled system: with 1 the largest is nearest to the obstacle, with -1 nearest to the structure.
    pub fn new(system: &'a Coupled, sign: f64) -> Self {
        let form = Form::linear(system, [-sign, 0.0, sign, 0.0]);
        Self { system, sign, form }
    }
}

impl Quantity<4> for RelativePosition<'_> {
    #[inline(always)]
    fn rates(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 3] {
        self.system.relative_position_rates(excitation, y).map(|rate| self.sign * rate)
    }
    #[inline(always)]
    fn rates_in_flight(&self, excitation: &[f64x4; 2], y: &[f64x4; 4]) -> [f64x4; 3] {
        self.system.relative_position_rates_in_flight(excitation, y).map(|rate| rate * self.sign)
    }
    fn form(&self) -> &Form<4> {
        &self.form
    }
}
