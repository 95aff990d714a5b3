//! Equation (1): the primary structure and the damper in its cavity, with Hertz contact on both walls, or rigid ones (`rigid`).

mod energies;
mod rigid;
mod structure;

use crate::bare::largest;
use crate::loss::{Factor, Law};
use crate::{
    Bare, Contact, Damper, Excitation, Forcing, Primary, Stretch, Surfaces, hertz_force, hertz_force_slope,
    hertz_pressure,
};
use nalgebra::SMatrix;

/// The two walls of the cavity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Direct contact with the primary structure: `z1 = x1 - x2 >= 0`.
    Primary,
    /// Contact with the obstacle: `z2 = x2 - x1 - (D + C) >= 0`.
    Obstacle,
}

impl Side {
    /// Both walls, in the order of every two-element array of this crate.
    pub const BOTH: [Side; 2] = [Side::Primary, Side::Obstacle];

    /// `∂z/∂(x2 - x1)`: -1 for the primary structure, +1 for the obstacle. The contact pushes the damper with `-sign F`.
    pub const fn sign(self) -> f64 {
        match self {
            Side::Primary => -1.0,
            Side::Obstacle => 1.0,
        }
    }
}

/// The coupled system. Its state is `[x1, v1, x2, v2]` (m, m/s).
#[derive(Clone, Debug)]
pub struct Coupled {
    bare: Bare,
    m2: f64,
    k2: f64,
    c2: f64,
    d: f64,
    /// Positions of the walls relative to the structure, m; infinite without walls.
    walls: [f64; 2],
    hertz: [f64; 2],
    /// The laws of contact losses.
    laws: [Law; 2],
    /// R, m; 0 without Hertz's surfaces.
    pub(crate) radius: f64,
    /// e of rigid walls.
    restitution: Option<f64>,
    /// m2/m1 where the coordinates move with an accelerated base: the share of the force on the structure that acts on the damper. 0
    /// otherwise.
    carried: f64,
}

impl Coupled {
    /// Collects the numbers of a structure, its forcing and its damper.
    pub fn new(primary: &Primary, forcing: &Forcing, damper: &Damper) -> Self {
        let surfaces = damper.contact.as_ref().and_then(Contact::surfaces);
        Self {
            bare: Bare::new(primary, forcing),
            m2: damper.mass.get(),
            k2: damper.stiffness.get(),
            c2: damper.damping.get(),
            d: damper.rest_distance.get(),
            walls: match damper.contact {
                Some(_) => [0.0, damper.rest_distance.get() + damper.clearance.get()],
                None => [f64::NEG_INFINITY, f64::INFINITY],
            },
            hertz: surfaces.map_or([0.0; 2], Surfaces::stiffness),
            laws: surfaces.map_or([Law::NONE, Law::NONE], |surfaces| surfaces.losses().map(Law::from)),
            radius: surfaces.map_or(0.0, |surfaces| surfaces.radius.get()),
            restitution: damper
                .contact
                .and_then(|contact| contact.rigid())
                .map(|rigid| rigid.restitution.get()),
            carried: if Bare::new(primary, forcing).moves_with_base() {
                damper.mass.get() / primary.mass.get()
            } else {
                0.0
            },
        }
    }

    /// This system under the force `P cos(ωt + φ)`, φ in rad. Time still begins at 0.
    #[must_use]
    pub fn with_phase(self, phase: f64) -> Self {
        Self { bare: self.bare.with_phase(phase), ..self }
    }

    /// This system as if a stretch of time never ended, see [`Bare::during`].
    #[must_use]
    pub fn during(&self, stretch: Stretch) -> Self {
        Self { bare: self.bare.during(stretch), ..self.clone() }
    }

    /// The structure without its damper.
    pub fn bare(&self) -> &Bare {
        &self.bare
    }

    /// `[P cos(ωt + φ), P sin(ωt + φ)]` at time `t` (s), N.
    pub fn excitation(&self, t: f64) -> Excitation {
        self.bare.excitation(t)
    }

    /// `f/m1`, m/s²: the part of every acceleration that is due to coordinates moving with the base; 0 in fixed ones.
    pub fn frame_acceleration(&self, [force, _]: Excitation) -> f64 {
        if self.carried > 0.0 { force / self.bare.m1 } else { 0.0 }
    }

    /// The paper's initial state, `[0, 0, D, 0]`.
    pub fn rest(&self) -> [f64; 4] {
        [0.0, 0.0, self.d, 0.0]
    }

    /// State at t = 0: at rest unless the forcing has a start, by default with the damper's spring at rest.
    pub fn start(&self) -> [f64; 4] {
        self.bare.away.map_or_else(|| self.rest(), |start| start.state(self.d))
    }

    /// Whether the damper's spring is at rest at t = 0, so that the damper starts at D from the structure.
    pub fn starts_at_rest_distance(&self) -> bool {
        self.bare.away.is_none_or(|start| start.x2.is_none())
    }

    /// The energy bound with a damper; see [`Bare::most_energy`]. An indentation at the start counts with its stored energy.
    pub fn most_energy(&self, t: f64) -> f64 {
        let start = (2.0 * self.total_energy(&self.start())).sqrt();
        0.5 * (start + self.energy_norm_growth() * t).powi(2)
    }

    /// Position `D` of the damper relative to the structure where its spring is at rest, m.
    pub fn rest_distance(&self) -> f64 {
        self.d
    }

    /// Whether there are walls to touch.
    pub fn has_walls(&self) -> bool {
        self.walls[0].is_finite()
    }

    /// Position of a wall relative to the structure, m: 0 for the structure itself, `D + C` for the obstacle; infinite without walls.
    pub fn wall(&self, side: Side) -> f64 {
        self.walls[side as usize]
    }

    /// Hertz stiffness of a wall, N/m^1.5.
    pub fn hertz(&self, side: Side) -> f64 {
        self.hertz[side as usize]
    }

    /// The law of the loss of contacts with a wall.
    pub(crate) fn law(&self, side: Side) -> &Law {
        &self.laws[side as usize]
    }

    /// Whether contacts lose energy.
    pub fn is_lossy(&self) -> bool {
        self.laws.iter().any(Law::is_lossy)
    }

    /// The force of a wall at an indentation `z` (m) that changes at the rate `w` (m/s), `[F, ∂F/∂z, ∂F/∂w]` in N, N/m, N·s/m: Hertz's,
    /// times the [factor](Law::factor) of the law of its loss.
    #[inline]
    pub(crate) fn wall_force(&self, side: Side, z: f64, w: f64) -> [f64; 3] {
        if z <= 0.0 {
            return [0.0; 3];
        }
        let (hertz, Factor { f, by_z, by_w, .. }) = (self.hertz(side), self.wall_factor(side, z.sqrt(), w));
        let force = hertz_force(hertz, z);
        [force * f, hertz_force_slope(hertz, z) * f + force * by_z / z, force * by_w]
    }

    /// The factor of Hertz's force at the indentation `q²` (m) that changes at the rate `w` (m/s).
    #[inline]
    pub(crate) fn wall_factor(&self, side: Side, q: f64, w: f64) -> Factor {
        self.law(side).factor(|| self.half_square(side, q), w)
    }

    /// Half of the square of the touch-down speed (m/s) of an undisturbed collision without loss that reaches the indentation `q²` (m).
    pub(crate) fn half_square(&self, side: Side, q: f64) -> f64 {
        0.4 * self.hertz(side) * self.inverse_effective_mass() * q.powi(5)
    }

    /// The radius of the contact area at an indentation `z` (m), m: `√(R z)` (Johnson, p. 92).
    pub fn contact_radius(&self, z: f64) -> f64 {
        (self.radius * z.max(0.0)).sqrt()
    }

    /// The largest pressure of a contact at an indentation `z` (m), N/m², by Hertz's theory. Losses are not included: their law is for
    /// forces only.
    pub fn wall_pressure(&self, side: Side, z: f64) -> f64 {
        hertz_pressure(self.hertz(side), self.radius, z)
    }

    /// `[m1, m2]`, kg.
    pub fn masses(&self) -> [f64; 2] {
        [self.bare.m1, self.m2]
    }

    /// `1/m1 + 1/m2`, 1/kg: the relative acceleration of the two bodies per unit of force between them.
    pub fn inverse_effective_mass(&self) -> f64 {
        1.0 / self.bare.m1 + 1.0 / self.m2
    }

    /// Indentations `[z1, z2]`, m: positive where the damper is in contact with the structure, with the obstacle.
    #[inline]
    pub fn indentation(&self, y: &[f64; 4]) -> [f64; 2] {
        let r = y[2] - y[0];
        [self.walls[0] - r, r - self.walls[1]]
    }

    /// Contact forces `[F_con(z1), F_con(z2)]`, N, none negative.
    #[inline]
    pub fn contact_forces(&self, y: &[f64; 4]) -> [f64; 2] {
        let ([z1, z2], rate) = (self.indentation(y), y[3] - y[1]);
        let ([f1, ..], [f2, ..]) =
            (self.wall_force(Side::Primary, z1, -rate), self.wall_force(Side::Obstacle, z2, rate));
        [f1, f2]
    }

    /// Equation (1): `[v1, a1, v2, a2]`.
    #[inline]
    pub fn derivative(&self, excitation: Excitation, y: &[f64; 4]) -> [f64; 4] {
        if self.holding(excitation, y).is_some() {
            let a = self.held_acceleration(excitation, y);
            return [y[1], a, y[3], a];
        }
        let [f1, f2] = self.contact_forces(y);
        self.derivative_under(excitation, y, f1 - f2)
    }

    /// Equation (1) under a given net contact force on the damper, `contact = F_con(z1) - F_con(z2)`, N.
    #[inline]
    pub fn derivative_under(
        &self,
        [cos, _]: Excitation,
        &[x1, v1, x2, v2]: &[f64; 4],
        contact: f64,
    ) -> [f64; 4] {
        let Bare { m1, c1, k1, .. } = self.bare;
        let on_damper = contact - self.c2 * (v2 - v1) - self.k2 * (x2 - x1 - self.d);
        let a2 = on_damper / self.m2;
        let a2 = if self.carried > 0.0 { a2 + cos / m1 } else { a2 };
        [v1, (cos - c1 * v1 - k1 * x1 - on_damper) / m1, v2, a2]
    }

    /// The linear part: `A` of `y' = A (y - y0) + b P cos ωt` away from contacts, and `b`; `y0` is [`Self::rest`].
    pub fn linear_part(&self) -> (SMatrix<f64, 4, 4>, [f64; 4]) {
        let on_structure = 1.0 / self.bare.m1;
        let on_damper = if self.carried > 0.0 { on_structure } else { 0.0 };
        (self.jacobian_with([0.0; 2]), [0.0, on_structure, 0.0, on_damper])
    }

    /// A bound on how fast the motion between contacts can change, 1/s: the larger of ω and `√(tr M⁻¹K) + tr M⁻¹C`, which is
    /// no less than the norm of the linear part in the energy norm.
    pub fn rate(&self) -> f64 {
        let Bare { m1, c1, k1, returns, .. } = self.bare;
        let inverse_m = self.inverse_effective_mass();
        returns.max((k1 / m1 + self.k2 * inverse_m).sqrt() + c1 / m1 + self.c2 * inverse_m)
    }

    /// The largest contribution to [`Self::rate`], in the symbols of a study file.
    pub fn fastest(&self) -> &'static str {
        let Bare { m1, c1, k1, returns, .. } = self.bare;
        let (m2, c2, k2) = (self.m2, self.c2, self.k2);
        largest([
            (returns, self.bare.turns_by()),
            ((k1 / m1).sqrt(), "k1/m1"),
            ((k2 / m1).sqrt(), "k2/m1"),
            ((k2 / m2).sqrt(), "k2/m2"),
            (c1 / m1, "c1/m1"),
            (c2 / m1, "c2/m1"),
            (c2 / m2, "c2/m2"),
        ])
    }

    /// `√(2E)` of a state, √J, with `E` the mechanical energy of the linear part (no contact). Between contacts damping only
    /// dissipates energy, so it grows by at most `P / √m1` a second.
    pub fn energy_norm(&self, &[x1, v1, x2, v2]: &[f64; 4]) -> f64 {
        let stretch = x2 - x1 - self.d;
        (2.0 * self.bare.primary_energy(x1, v1) + self.m2 * v2 * v2 + self.k2 * stretch * stretch).sqrt()
    }

    /// Largest growth of [`Self::energy_norm`], √J/s; see [`Bare::energy_norm_growth`].
    ///
    /// An acceleration `a` of the base does the work `-a (m1 v1 + m2 v2)`, at most `|a| √((m1 + m2) 2E)`: it grows by `√(1 + m2/m1)` as much.
    pub fn energy_norm_growth(&self) -> f64 {
        self.bare.energy_norm_growth() * (1.0 + self.carried).sqrt()
    }

    /// The largest `|row · (y - y0)|` over all states of energy norm 1 (the dual norm); infinite if `row` weights a coordinate
    /// without a spring.
    pub fn dual_energy_norm(&self, &[x1, v1, x2, v2]: &[f64; 4]) -> f64 {
        // In the coordinates x1, v1, stretch, v2 the energy is a sum of squares.
        let part = |weight: f64, scale: f64| if weight == 0.0 { 0.0 } else { weight * weight / scale };
        let Bare { m1, k1, .. } = self.bare;
        (part(x1 + x2, k1) + part(v1, m1) + part(x2, self.k2) + part(v2, self.m2)).sqrt()
    }

    /// Jacobian `∂y'/∂y` of equation (1), contacts included.
    pub fn jacobian(&self, y: &[f64; 4]) -> SMatrix<f64, 4, 4> {
        self.jacobian_with(self.wall_slopes(y))
    }

    /// The sums of the slopes of both contact forces, by the indentation (N/m) and by its rate (N·s/m).
    #[inline]
    fn wall_slopes(&self, y: &[f64; 4]) -> [f64; 2] {
        let ([z1, z2], rate) = (self.indentation(y), y[3] - y[1]);
        let [_, stiff_1, drag_1] = self.wall_force(Side::Primary, z1, -rate);
        let [_, stiff_2, drag_2] = self.wall_force(Side::Obstacle, z2, rate);
        [stiff_1 + stiff_2, drag_1 + drag_2]
    }

    /// Both contact forces act against the indentation and its rate, so `∂(F1 - F2)/∂(x2 - x1) = -slope` and
    /// `∂(F1 - F2)/∂(v2 - v1) = -drag`.
    fn jacobian_with(&self, [slope, drag]: [f64; 2]) -> SMatrix<f64, 4, 4> {
        let Bare { m1, c1, k1, .. } = self.bare;
        let (k, c) = (self.k2 + slope, self.c2 + drag);
        #[rustfmt::skip]
        let rows = [
            0.0, 1.0, 0.0, 0.0,
            -(k1 + k) / m1, -(c1 + c) / m1, k / m1, c / m1,
            0.0, 0.0, 0.0, 1.0,
            k / self.m2, c / self.m2, -k / self.m2, -c / self.m2,
        ];
        SMatrix::<f64, 4, 4>::from_row_slice(&rows)
    }

    /// `∂y'/∂t` of equation (1), which is due to the force alone.
    pub fn time_derivative(&self, [_, sin]: Excitation) -> [f64; 4] {
        let on_structure = -self.bare.omega * sin / self.bare.m1;
        [0.0, on_structure, 0.0, if self.carried > 0.0 { on_structure } else { 0.0 }]
    }

    /// `(m2, k2, c2)`, for the steady response.
    pub(crate) fn damper(&self) -> (f64, f64, f64) {
        (self.m2, self.k2, self.c2)
    }
}
