//! Equation (1) in intervals, and the Taylor series of its solutions.
//!
//! A state of a flight is `[r, w, x1, v1, φ, 0]` with `r = x2 - x1`, `w = dr/dt`, and the phase `φ` of the force. A state of a contact with a
//! wall is `[q, w, x1, v1, φ, v]` with the indentation `z = q²` and `w = dz/dt`; its independent variable is `θ`, `dt = q dθ` (equation (5) of
//! `docs/theory.md`), in which Hertz's force `K q³` is polynomial. With the same restitution at every speed `v` is the touch-down speed of
//! the undisturbed collision through the state; other contacts do not use it.

use crate::elementary::pi;
use crate::loss::Factor;
use crate::number::{SPEED, STATE};
use crate::{Event, Failure, Interval, Number, Taylor};
use retune_model::{Amplitude, Contact, Damper, Forcing, Primary, Scene, Side, Source, Surfaces};

/// The numbers of a scene.
#[derive(Clone, Debug)]
pub struct Equations {
    /// ω; for a family a function of its parameter.
    pub omega: Taylor,
    /// m1, c1, k1.
    pub primary: [Interval; 3],
    /// m2, c2, k2; m2 is zero without a damper.
    pub damper: [Interval; 3],
    /// D.
    pub rest: Interval,
    /// Positions of the walls; the whole line without walls.
    pub walls: [Interval; 2],
    /// K1, K3.
    pub hertz: [Interval; 2],
    /// The factors of the contacts' losses.
    pub factors: [Factor; 2],
    /// Powers of two that scale the coordinates alike, to roots of energies, which decrease by damping.
    pub scales: [f64; STATE],
    /// The force, as weights of `[cos φ, ω² cos φ, ω sin φ]`, all over `ω²` if the acceleration of a base is given.
    force: [Interval; 3],
    is_over_square: bool,
}

/// The mode of the damper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// It touches nothing.
    Flight,
    /// It indents a wall.
    Contact(Side),
}

/// The equations in one mode of the damper.
#[derive(Clone, Copy, Debug)]
pub struct Flow<'a> {
    /// The numbers.
    pub equations: &'a Equations,
    /// The mode.
    pub mode: Mode,
}

impl Equations {
    /// The equations of a scene. Each number encloses the decimal in the file, not just the double nearest to it.
    ///
    /// All fields are named here, so that a new field of the model must be read or refused.
    ///
    /// # Errors
    /// No damping at all without damper, no periodic force, rigid walls, or too small a restitution.
    pub fn new(scene: &Scene) -> Result<Self, Failure> {
        let number = Interval::decimal;
        let Scene { primary: Primary { mass, damping, stiffness }, forcing, damper: scene_damper } = scene;
        let primary @ [m1, c1, k1] = [mass.get(), damping.get(), stiffness.get()].map(number);
        let (damper, [rest, clearance], contact) = match scene_damper {
            Some(Damper { mass, stiffness, damping, rest_distance, clearance, contact }) => (
                [mass.get(), damping.get(), stiffness.get()].map(number),
                [rest_distance.get(), clearance.get()].map(number),
                *contact,
            ),
            // A structure alone moves like one with a massless damper, whose spring is never stretched.
            None => ([Interval::ZERO, Interval::ZERO, Interval::ONE], [Interval::ZERO; 2], None),
        };
        // A periodic motion does not depend on the start of a run.
        let Forcing { source, frequency, start: _ } = forcing;
        let omega = number(frequency.get());
        // k1 y + c1 dy/dt with y = Y cos φ.
        let base = |y: Interval| [y * k1, Interval::ZERO, -(y * c1)];
        let force = match source {
            Source::Harmonic(Amplitude::Force, p) => [number(p.get()), Interval::ZERO, Interval::ZERO],
            Source::Harmonic(Amplitude::Imbalance, me) => [Interval::ZERO, number(me.get()), Interval::ZERO],
            Source::Harmonic(Amplitude::Base, y) => base(number(y.get())),
            // Y = a/ω².
            Source::Harmonic(Amplitude::BaseAcceleration, a) => base(number(a.get())),
            Source::Decay(_) => return Err(Failure::Scene("a free decay, which does not repeat")),
            Source::History(_) => {
                return Err(Failure::Scene("a pulse or a record, under which no motion repeats"));
            }
        };
        if !omega.is_positive() {
            return Err(Failure::Scene("a forcing whose omega is not above 0"));
        }
        let is_over_square = matches!(source, Source::Harmonic(Amplitude::BaseAcceleration, _));
        let (walls, hertz, factors) = match contact {
            None => ([Interval::ENTIRE; 2], [Interval::ZERO; 2], [Factor::None; 2]),
            Some(Contact::Rigid(_)) => return Err(Failure::Scene("rigid walls")),
            Some(Contact::Hertz(surfaces)) => {
                let [a, b] = surfaces.losses();
                let walls = [Interval::ZERO, rest + clearance];
                (walls, hertz_stiffness(&surfaces), [Factor::new(&a)?, Factor::new(&b)?])
            }
        };
        let scales = scales(m1 / damper[0], omega.square() + k1 * (Interval::ONE / m1));
        let omega = Taylor::from(omega);
        let all = Self { omega, primary, damper, rest, walls, hertz, factors, scales, force, is_over_square };
        if scene_damper.is_none() && !all.comes_to_rest() {
            return Err(Failure::Scene("a structure without damper, and without spring or dashpot"));
        }
        Ok(all)
    }

    /// The equations with ω replaced by a function, exactly.
    pub fn at(&self, omega: Taylor) -> Self {
        Self { omega, ..self.clone() }
    }

    /// Whether the system without walls and force is proven to come to rest, that is, to be asymptotically stable.
    ///
    /// Its energy is positive definite if both stiffnesses are positive, and decreases at the rate `c1 v1² + c2 w²`. A motion of constant
    /// energy is rest: with `c1 > 0` the structure stands still, so the damper's spring pushes it with a constant force, so the damper
    /// stands still, and no spring is stretched; with `c2 > 0` and a mass both masses move as one, under the constant force of the damper's
    /// spring, which is zero as the motion is bounded, and so is the other's (E. A. Barbashin and N. N. Krasovskii, 1952).
    pub fn comes_to_rest(&self) -> bool {
        let [[_, c1, k1], [m2, c2, k2]] = [self.primary, self.damper];
        let is_damped = c1.is_positive() || (c2.is_positive() && m2.is_positive());
        k1.is_positive() && k2.is_positive() && is_damped
    }

    /// Whether there are walls.
    pub fn has_walls(&self) -> bool {
        self.walls[0].is_bounded()
    }

    /// The force over m1, as weights of `[cos φ, sin φ]`.
    pub fn force_per_mass<T: Number>(&self) -> [T; 2] {
        let per_m1 = Interval::ONE / self.primary[0];
        let (omega, f) = (T::of(self.omega), self.force.map(|part| part * per_m1));
        let force = [T::constant(f[0]) + (omega * omega).times(f[1]), omega.times(f[2])];
        if self.is_over_square { force.map(|part| part * (omega * omega).reciprocal()) } else { force }
    }

    /// `1/m1 + 1/m2`.
    pub fn inverse_masses(&self) -> Interval {
        Interval::ONE / self.primary[0] + Interval::ONE / self.damper[0]
    }
}

impl<'a> Flow<'a> {
    /// The flow after an event.
    pub fn after(equations: &'a Equations, event: Event) -> Self {
        let mode = if let Event::Touch(side) = event { Mode::Contact(side) } else { Mode::Flight };
        Self { equations, mode }
    }

    /// The direction in which the first coordinate increases: minus one in a contact with the structure.
    pub fn sign(self) -> Interval {
        Interval::point(if let Mode::Contact(side) = self.mode { side.sign() } else { 1.0 })
    }

    /// The Taylor coefficients of the solution from a state, up to `order`: `[k][i]` is that of the power `k` of the coordinate `i`.
    pub fn series<T: Number>(self, start: &[T; STATE], order: usize) -> Vec<[T; STATE]> {
        let (all, sign, zero) = (self.equations, self.sign(), T::constant(Interval::ZERO));
        let (stretch, mut contact) = match self.mode {
            Mode::Flight => (-all.rest, None),
            Mode::Contact(side) => (sign * (all.walls[side as usize] - all.rest), Some(Push::new(all, side))),
        };
        let [[m1, c1, k1], [m2, c2, k2]] = [all.primary, all.damper];
        let [per_m1, per_m2] = [m1, m2].map(|mass| Interval::ONE / mass);
        let (omega, force) = (T::of(all.omega), all.force_per_mass::<T>());
        let (mut y, mut circle) = (vec![*start], vec![start[4].cos_sin()]);
        // In a contact: the two accelerations, which are multiplied by dt/dθ = q, and that of the speed v.
        let mut accelerations: Vec<[T; 3]> = Vec::new();
        for k in 0..order {
            let [u, w, x1, v1, ..] = y[k];
            let [cos, sin] = circle[k];
            let (mut depth, mut push) = (u, w.times(c2));
            if let Some(contact) = &mut contact {
                contact.extend(&y);
                (depth, push) = (contact.factors[0][k], push + contact.force[k]);
            }
            push = push + depth.times(k2);
            if k == 0 {
                push = push + T::constant(k2 * stretch);
            }
            // m1 a1 = F - c1 v1 - k1 x1 + s push, and m2 a2 = -s push.
            let a1 = cos * force[0]
                + sin * force[1]
                + -v1.times(c1 * per_m1)
                + -x1.times(k1 * per_m1)
                + push.times(sign * per_m1);
            let rate = -push.times(per_m2) + -a1.times(sign);
            let slopes = if let Some(contact) = &mut contact {
                let others = rate + contact.force[k].times(all.inverse_masses());
                accelerations.push([rate, a1, contact.speeding(others)]);
                let by_clock = |other: &dyn Fn(usize) -> T| product(k, |i| y[i][0], other);
                let [rate, a1, speeding] = [0, 1, 2].map(|j| by_clock(&|i| accelerations[i][j]));
                [w.times(Interval::point(0.5)), rate, by_clock(&|i| y[i][3]), a1, u * omega, speeding]
            } else {
                [w, rate, v1, a1, if k == 0 { omega } else { zero }, zero]
            };
            let share = Interval::ONE / Interval::point((k + 1) as f64);
            y.push(slopes.map(|slope| slope.times(share)));
            // d cos φ = -sin φ dφ, with (i + 1) y[i + 1] the coefficient of dφ.
            let turning = |i: usize| y[i + 1][4].times(Interval::point((i + 1) as f64));
            let next = |of: usize| match &contact {
                // In flight φ is linear.
                None => circle[k][of] * turning(0),
                Some(_) => product(k, |i| circle[i][of], turning),
            };
            circle.push([next(1).times(-share), next(0).times(share)]);
        }
        y
    }

    /// The derivative of a state.
    pub fn derivative<T: Number>(self, state: &[T; STATE]) -> [T; STATE] {
        self.series(state, 1)[1]
    }
}

/// The series of the force of a contact.
pub struct Push<'a, T> {
    equations: &'a Equations,
    side: Side,
    /// The force.
    pub force: Vec<T>,
    /// `q²`, `q³`, `1/v`, `h = w/v`, and the factor `f`.
    factors: [Vec<T>; 5],
    /// `q⁵`, `1/v²`, `q⁵/v²`, `D`, `1/D`, `h/D`, and the acceleration by all other forces.
    denominator: [Vec<T>; 7],
}

impl<'a, T: Number> Push<'a, T> {
    /// The series without any terms yet.
    pub fn new(equations: &'a Equations, side: Side) -> Self {
        let (factors, denominator) = Default::default();
        Self { equations, side, force: Vec::new(), factors, denominator }
    }

    /// Adds the next term of all series, from that of the motion `y`.
    pub fn extend(&mut self, y: &[[T; STATE]]) {
        let (k, one) = (self.force.len(), if self.force.is_empty() { Interval::ONE } else { Interval::ZERO });
        let [squares, cubes, inverse_speed, stage, factors] = &mut self.factors;
        squares.push(product(k, |i| y[i][0], |i| y[i][0]));
        cubes.push(product(k, |i| squares[i], |i| y[i][0]));
        let more = match self.equations.factors[self.side as usize] {
            Factor::None => None,
            Factor::Damping(lambda) => Some(y[k][1].times(lambda)),
            Factor::Restoring(chi) => {
                quotient(inverse_speed, |i| y[i][SPEED]);
                stage.push(product(k, |i| y[i][1], |i| inverse_speed[i]));
                Some(stage[k].times(chi))
            }
        };
        factors.extend(more.map(|more| T::constant(one) + more));
        let push = if more.is_some() { product(k, |i| cubes[i], |i| factors[i]) } else { cubes[k] };
        self.force.push(push.times(self.equations.hertz[self.side as usize]));
    }

    /// The next term of `dv/dt = a h/D`, with the acceleration `a` into the wall by all forces but the contact's, and `D = 2 f G + h²`,
    /// `G = S/v²`, `S = (2/5) κ q⁵`, `κ = K (1/m1 + 1/m2)` (`docs/theory.md`, "One restitution at every speed"); zero for other contacts.
    fn speeding(&mut self, acceleration: T) -> T {
        let equations = self.equations;
        if !matches!(equations.factors[self.side as usize], Factor::Restoring(_)) {
            return T::constant(Interval::ZERO);
        }
        let storing = Interval::point(4.0) / Interval::point(5.0)
            * equations.hertz[self.side as usize]
            * equations.inverse_masses();
        let k = self.denominator[0].len();
        let of = |a: &[T], b: &[T]| product(k, |i| a[i], |i| b[i]);
        let [squares, cubes, inverse_speed, stage, factors] = &self.factors;
        let [fifth, inverse_square, stored, d, inverse_d, shares, others] = &mut self.denominator;
        fifth.push(of(squares, cubes));
        inverse_square.push(of(inverse_speed, inverse_speed));
        stored.push(of(fifth, inverse_square));
        d.push(of(factors, stored).times(storing) + of(stage, stage));
        quotient(inverse_d, |i| d[i]);
        shares.push(of(stage, inverse_d));
        others.push(acceleration);
        of(others, shares)
    }
}

/// Adds the next term of the series of `1/x`.
fn quotient<T: Number>(inverse: &mut Vec<T>, of: impl Fn(usize) -> T) {
    let next = match inverse.len() {
        0 => of(0).reciprocal(),
        k => -inverse[0] * product(k - 1, |i| inverse[i], |i| of(i + 1)),
    };
    inverse.push(next);
}

/// The powers of two next to `[√(m2/m1), √(m2/m1)/σ, 1, 1/σ, 1/σ, √(m2/m1)/σ]`, from `m1/m2` and `σ²`.
fn scales(ratio: Interval, square: Interval) -> [f64; STATE] {
    let power = |square: f64| (0.5 * square.log2()).round().exp2();
    let (mass, speed) = (power(1.0 / ratio.mid()), power(1.0 / square.mid()));
    [mass, mass * speed, 1.0, speed, speed, mass * speed]
}

/// The coefficient of the power `k` of a product of two series.
pub fn product<T: Number>(k: usize, a: impl Fn(usize) -> T, b: impl Fn(usize) -> T) -> T {
    (0..=k).fold(T::constant(Interval::ZERO), |sum, i| sum + a(i) * b(k - i))
}

/// `[K1, K3]` of the contacts, `K = (4/3) q / ((δa + δb) √(1/R))` with `δ = (1 - ν²)/(πE)` (section 2 of the paper).
fn hertz_stiffness(surfaces: &Surfaces) -> [Interval; 2] {
    // Losses are read by `losses`; no motion depends on strength and density.
    #[rustfmt::skip]
    let Surfaces {
        radius, coefficient, young_1, poisson_1, young_2, poisson_2, young_3, poisson_3, young_4, poisson_4,
        loss: _, loss_obstacle: _, strength: _, density: _,
    } = surfaces;
    let number = Interval::decimal;
    let softness =
        |young: f64, poisson: f64| (Interval::ONE - number(poisson).square()) / (pi() * number(young));
    let pairs = [
        softness(young_1.get(), poisson_1.get()) + softness(young_2.get(), poisson_2.get()),
        softness(young_3.get(), poisson_3.get()) + softness(young_4.get(), poisson_4.get()),
    ];
    let curvature = Interval::ONE / number(radius.get());
    let [three, four] = [3.0, 4.0].map(Interval::point);
    pairs.map(|softness| four * number(coefficient.get()) / (three * softness * curvature.sqrt()))
}

/// Evaluates a series by Horner's scheme.
pub fn at<T: Number>(series: impl DoubleEndedIterator<Item = T>, h: T) -> T {
    series.rev().fold(T::constant(Interval::ZERO), |sum, c| sum * h + c)
}
