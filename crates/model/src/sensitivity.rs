//! The derivatives of equation (1) by its parameters, at a fixed state and a fixed time.

use crate::loss::Factor;
use crate::{Bare, Coupled, Excitation, Measure, Parameter, Side, Source};

impl Bare {
    /// `∂[P cos(ωt + φ), P sin(ωt + φ)]/∂parameter` at time `t` (s), N per unit of the parameter.
    pub fn excitation_by(&self, parameter: Parameter, t: f64) -> Excitation {
        let [cos, sin] = self.excitation(t);
        let [growth, turn] = self.forcing_by(parameter);
        let turn = turn + if parameter == Parameter::Omega { t } else { 0.0 };
        [growth * cos - turn * sin, growth * sin + turn * cos]
    }

    /// The derivatives of the logarithm of the force's amplitude and of the angle by which the force leads at t = 0.
    fn forcing_by(&self, parameter: Parameter) -> [f64; 2] {
        let Source::Harmonic(of, size) = self.source() else { return [0.0; 2] };
        if parameter == of.parameter() && size.get() != 0.0 {
            return [1.0 / size.get(), 0.0];
        }
        let [growth, turn] = if of.is_of_base() { self.pushing_by(parameter) } else { [0.0; 2] };
        match (parameter, of.power()) {
            (Parameter::Omega, power) if power != 0 => [growth + f64::from(power) / self.omega, turn],
            _ => [growth, turn],
        }
    }

    /// [`Self::forcing_by`] of the complex stiffness k1 + iωc1 by which a base pushes: k1 y + c1 dy/dt.
    fn pushing_by(&self, parameter: Parameter) -> [f64; 2] {
        let (k1, loss) = (self.k1, self.omega * self.c1);
        let square = k1 * k1 + loss * loss;
        let by_loss = [loss / square, k1 / square];
        match parameter {
            Parameter::K1 => [k1 / square, -loss / square],
            Parameter::C1 => by_loss.map(|by| by * self.omega),
            Parameter::Omega => by_loss.map(|by| by * self.c1),
            _ => [0.0; 2],
        }
    }
}

impl Coupled {
    /// The derivative of the position of a wall relative to the structure: the far wall is at D + C.
    pub fn wall_by(&self, parameter: Parameter, side: Side) -> f64 {
        let moves = side == Side::Obstacle && matches!(parameter, Parameter::D | Parameter::C);
        if moves { 1.0 } else { 0.0 }
    }

    /// The derivative by a parameter of `ln(K)`, the same for both walls' Hertz stiffness, which grows as the root of R.
    pub fn hertz_by(&self, parameter: Parameter) -> f64 {
        if parameter == Parameter::R && self.radius > 0.0 { 0.5 / self.radius } else { 0.0 }
    }

    /// The net force on the damper, N, of a contact with a wall at the indentation `q²` (m), which grows at the rate `w` (m/s), and its
    /// derivative by a parameter at a fixed state.
    pub fn contact_force_by(&self, parameter: Parameter, side: Side, q: f64, w: f64) -> [f64; 2] {
        let Factor { f, by_z, .. } = self.wall_factor(side, q, w);
        let hertz = -side.sign() * self.hertz(side) * q * q * q;
        let force = hertz * f;
        // The factor depends on z by z^(5/2) K (1/m1 + 1/m2).
        let direct = match parameter {
            Parameter::Lambda | Parameter::Restitution => {
                hertz * self.law(side).by_parameter(|| self.half_square(side, q), w)
            }
            Parameter::M2 => {
                let (m2, ..) = self.damper();
                -hertz * 0.4 * by_z / (m2 * m2 * self.inverse_effective_mass())
            }
            _ => (force + hertz * 0.4 * by_z) * self.hertz_by(parameter),
        };
        let [slope, _] = self.contact_slopes(side, q, w);
        [force, slope * self.wall_by(parameter, side) + direct]
    }

    /// The slopes of the force of a wall by the indentation `q²` (m) and by its rate `w` (m/s), N/m and N·s/m: those of the law in
    /// `crate::Coupled`, for a known root `q`.
    pub fn contact_slopes(&self, side: Side, q: f64, w: f64) -> [f64; 2] {
        let (hertz, Factor { f, by_z, by_w, .. }) = (self.hertz(side), self.wall_factor(side, q, w));
        [hertz * q * (1.5 * f + by_z), hertz * q * q * q * by_w]
    }

    /// `∂[x1'', x2'']/∂parameter` by equation (1), m/s² per unit of the parameter, at a state, with the net contact force on the damper
    /// (N) and its derivative by the parameter, under a fixed force on the structure.
    pub fn acceleration_by(
        &self,
        parameter: Parameter,
        y: &[f64; 4],
        [contact, contact_by]: [f64; 2],
    ) -> [f64; 2] {
        let &[x1, v1, x2, v2] = y;
        let (m1, (m2, k2, _)) = (self.bare().mass(), self.damper());
        let on_damper = contact_by
            + match parameter {
                Parameter::K2 => self.rest_distance() - (x2 - x1),
                Parameter::C2 => v1 - v2,
                Parameter::D => k2,
                _ => 0.0,
            };
        let alone = match parameter {
            Parameter::K1 => [-x1 / m1, 0.0],
            Parameter::C1 => [-v1 / m1, 0.0],
            Parameter::M2 => [0.0, -self.derivative_under([0.0; 2], y, contact)[3] / m2],
            _ => [0.0; 2],
        };
        [alone[0] - on_damper / m1, alone[1] + on_damper / m2]
    }

    /// The derivative by a parameter of the quantity whose largest size a measure is, at time `t` (s) and state `y`, where `by` is the
    /// derivative of the state: in the unit of the measure per unit of the parameter. For the contact force, that of the nearer wall.
    pub fn measure_by(
        &self,
        measure: Measure,
        parameter: Parameter,
        t: f64,
        y: &[f64; 4],
        by: &[f64; 4],
    ) -> f64 {
        let [m1, k1] = self.bare().primary_energy_weights();
        let [near, far] = self.indentation(y);
        let side = if near > far { Side::Primary } else { Side::Obstacle };
        let (depth, rate) = (near.max(far).max(0.0), side.sign() * (y[3] - y[1]));
        let contact = self.contact_force_by(parameter, side, depth.sqrt(), rate);
        let is = |other: Parameter| if parameter == other { 1.0 } else { 0.0 };
        match measure {
            Measure::Energy => k1 * y[0] * by[0] + m1 * y[1] * by[1] + 0.5 * y[0] * y[0] * is(Parameter::K1),
            Measure::Displacement => y[0].signum() * by[0],
            Measure::Velocity => y[1].signum() * by[1],
            Measure::Acceleration if self.holding(self.excitation(t), y).is_some() => {
                let excitation = self.excitation(t);
                let [driven, _] = self.bare().excitation_by(parameter, t);
                let [k1, c1] = self.bare().ground_force_weights();
                let along = (driven - k1 * by[0] - c1 * by[1]) / self.masses().iter().sum::<f64>();
                let direct = self.held_acceleration_by(parameter, excitation, y);
                self.held_acceleration(excitation, y).signum() * (along + direct)
            }
            Measure::Acceleration => {
                let [direct, _] = self.acceleration_by(parameter, y, contact);
                let driven = self.bare().excitation_by(parameter, t)[0] / m1;
                let jacobian = self.jacobian(y);
                let along: f64 = (0..4).map(|j| jacobian[(1, j)] * by[j]).sum();
                self.derivative(self.excitation(t), y)[1].signum() * (along + direct + driven)
            }
            Measure::GroundForce => {
                let [k1, c1] = self.bare().ground_force_weights();
                let direct = y[0] * is(Parameter::K1) + y[1] * is(Parameter::C1);
                // Less the force that the ground exerts where it moves.
                let [driven, driven_by] = match self.bare().is_on_moving_base() {
                    true => [self.excitation(t)[0], self.bare().excitation_by(parameter, t)[0]],
                    false => [0.0; 2],
                };
                let force = k1 * y[0] + c1 * y[1] - driven;
                force.signum() * (k1 * by[0] + c1 * by[1] + direct - driven_by)
            }
            Measure::Stroke => {
                let stretch = y[2] - y[0] - self.rest_distance();
                stretch.signum() * (by[2] - by[0] - is(Parameter::D))
            }
            Measure::ContactForce => {
                let [_, slope, drag] = self.wall_force(side, depth, rate);
                side.sign() * (slope * (by[2] - by[0]) + drag * (by[3] - by[1]) - contact[1])
            }
            Measure::ContactPressure if depth > 0.0 => {
                let deeper = side.sign() * (by[2] - by[0] - self.wall_by(parameter, side));
                let radius = is(Parameter::R) / self.radius;
                self.wall_pressure(side, depth) * (0.5 * deeper / depth + self.hertz_by(parameter) - radius)
            }
            Measure::ContactPressure => 0.0,
            // Not defined at a moment of a run.
            Measure::DecayTime | Measure::Stationary(_) => f64::NAN,
        }
    }
}
