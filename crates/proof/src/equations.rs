//! Equation (1) in intervals, and the Taylor series of its solutions.
//!
//! A state of a flight is `[r, w, x1, v1, φ, ω]` with `r = x2 - x1`, `w = dr/dt`, the phase `φ` of the force and its rate `ω`, which is a constant. A state of a contact with a
//! wall is `[q, w, x1, v1, φ, ω]` with the indentation `z = q²` and `w = dz/dt`; its independent variable is `θ`, `dt = q dθ` (equation (5) of
//! `docs/theory.md`), in which Hertz's force `K q³` is polynomial.

use crate::elementary::pi;
use crate::number::{Number, OMEGA, STATE, State};
use crate::{Failure, Interval};
use retune_model::{Contact, Loss, Scene, Side, Source, Surfaces};

/// The numbers of a scene.
#[derive(Clone, Debug)]
pub struct Equations {
    /// ω.
    pub omega: Interval,
    /// m1.
    pub m1: Interval,
    /// k1.
    pub k1: Interval,
    /// D.
    pub rest: Interval,
    /// Where the walls are; none of a damper without.
    pub walls: Option<[Interval; 2]>,
    /// K1, K3.
    pub hertz: [Interval; 2],
    /// Powers of two that make the coordinates alike: roots of energies, which damping lets fall.
    pub scales: [f64; STATE],
    /// 1/m1, c1/m1, k1/m1.
    inverse_m1: Interval,
    damping: Interval,
    stiffness: Interval,
    /// The force over m1, as weights of `[cos φ, ω² cos φ, ω sin φ]`.
    force: [Interval; 3],
    inverse_m2: Interval,
    c2: Interval,
    k2: Interval,
}

/// What the damper does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// It touches nothing.
    Flight,
    /// It indents a wall.
    Contact(Side),
}

impl Equations {
    /// The equations of a scene, each number of which is the decimal that a file has, not the double nearest to it.
    ///
    /// # Errors
    /// No damper, no force, rigid walls, or contacts that lose energy.
    pub fn new(scene: &Scene) -> Result<Self, Failure> {
        let number = Interval::decimal;
        let damper = scene.damper.as_ref().ok_or(Failure::Scene("a scene without damper"))?;
        let [m1, c1, k1] =
            [scene.primary.mass.get(), scene.primary.damping.get(), scene.primary.stiffness.get()]
                .map(number);
        let omega = number(scene.forcing.frequency.get());
        if !omega.is_positive() {
            return Err(Failure::Scene("a forcing whose omega is not above 0"));
        }
        let force = match scene.forcing.source {
            Source::Force(p) => [number(p.get()), Interval::ZERO, Interval::ZERO],
            Source::Imbalance(me) => [Interval::ZERO, number(me.get()), Interval::ZERO],
            // k1 y + c1 dy/dt with y = Y cos φ.
            Source::Base(y) => [number(y.get()) * k1, Interval::ZERO, -(number(y.get()) * c1)],
            // The same with Y = a / ω².
            Source::BaseAcceleration(a) => {
                let y = number(a.get()) / (omega * omega);
                [y * k1, Interval::ZERO, -(y * c1)]
            }
            Source::Decay(_) => return Err(Failure::Scene("a free decay, which does not repeat")),
            Source::History(_) => {
                return Err(Failure::Scene("a pulse or a record, under which no motion repeats"));
            }
        };
        let rest = number(damper.rest_distance.get());
        let hertz = match &damper.contact {
            None => None,
            Some(Contact::Rigid(_)) => return Err(Failure::Scene("rigid walls")),
            Some(Contact::Hertz(surfaces)) if !surfaces.losses().iter().all(Loss::is_none) => {
                return Err(Failure::Scene("contacts that lose energy"));
            }
            Some(Contact::Hertz(surfaces)) => Some(hertz_stiffness(surfaces)),
        };
        let inverse_m1 = Interval::ONE / m1;
        Ok(Self {
            omega,
            m1,
            k1,
            rest,
            walls: hertz.map(|_| [Interval::ZERO, rest + number(damper.clearance.get())]),
            hertz: hertz.unwrap_or([Interval::ZERO; 2]),
            scales: scales(m1 / number(damper.mass.get()), omega.square() + k1 * inverse_m1),
            inverse_m1,
            damping: c1 * inverse_m1,
            stiffness: k1 * inverse_m1,
            force: force.map(|part| part * inverse_m1),
            inverse_m2: Interval::ONE / number(damper.mass.get()),
            c2: number(damper.damping.get()),
            k2: number(damper.stiffness.get()),
        })
    }

    /// The same at a frequency, exactly.
    pub fn at(&self, omega: f64) -> Self {
        Self { omega: Interval::point(omega), ..self.clone() }
    }

    /// The position of a wall; none of a damper without.
    pub fn wall(&self, side: Side) -> Option<Interval> {
        self.walls.map(|walls| walls[side as usize])
    }

    /// The Taylor coefficients of the solution from a state, up to `order`: `[k][i]` is that of the power `k` of the coordinate `i`.
    pub fn series<T: Number>(&self, mode: Mode, start: &[T; STATE], order: usize) -> Vec<[T; STATE]> {
        let zero = T::constant(Interval::ZERO);
        let (sign, hertz, stretch) = match mode {
            Mode::Flight => (1.0, Interval::ZERO, -self.rest),
            Mode::Contact(side) => {
                let sign = Interval::point(side.sign());
                let wall = self.wall(side).unwrap_or(Interval::ENTIRE);
                (side.sign(), self.hertz[side as usize], sign * (wall - self.rest))
            }
        };
        let (sign, half) = (Interval::point(sign), Interval::point(0.5));
        let mut y = vec![*start];
        let omega = start[OMEGA];
        let force =
            [T::constant(self.force[0]) + (omega * omega).times(self.force[1]), omega.times(self.force[2])];
        let mut circle = vec![start[4].cos_sin()];
        // Of a contact: z = q², q³, and the two accelerations, which are multiplied by dt/dθ = q.
        let (mut squares, mut cubes, mut accelerations): (Vec<T>, Vec<T>, Vec<[T; 2]>) = Default::default();
        for k in 0..order {
            let [u, w, x1, v1, ..] = y[k];
            let [cos, sin] = circle[k];
            let mut depth = u;
            let mut push = w.times(self.c2);
            if mode != Mode::Flight {
                depth = product(k, zero, |i| y[i][0], |i| y[i][0]);
                squares.push(depth);
                cubes.push(product(k, zero, |i| squares[i], |i| y[i][0]));
                push = push + cubes[k].times(hertz);
            }
            push = push + depth.times(self.k2);
            if k == 0 {
                push = push + T::constant(self.k2 * stretch);
            }
            // m1 a1 = F - c1 v1 - k1 x1 + s push, and m2 a2 = -s push.
            let a1 = cos * force[0] + sin * force[1] - v1.times(self.damping) - x1.times(self.stiffness)
                + push.times(sign * self.inverse_m1);
            let rate = T::constant(Interval::ZERO) - push.times(self.inverse_m2) - a1.times(sign);
            accelerations.push([rate, a1]);
            let slopes = if mode == Mode::Flight {
                [w, rate, v1, a1, y[k][OMEGA], zero]
            } else {
                let by_clock = |other: &dyn Fn(usize) -> T| product(k, zero, |i| y[i][0], other);
                [
                    w.times(half),
                    by_clock(&|i| accelerations[i][0]),
                    by_clock(&|i| y[i][3]),
                    by_clock(&|i| accelerations[i][1]),
                    u * omega,
                    zero,
                ]
            };
            let share = Interval::ONE / Interval::point((k + 1) as f64);
            y.push(slopes.map(|slope| slope.times(share)));
            // d cos φ = -sin φ dφ, with (i + 1) y[i + 1] the coefficient of dφ.
            let turning = |i: usize| y[i + 1][4].times(Interval::point((i + 1) as f64));
            let cosine = product(k, zero, |i| circle[i][1], turning).times(-share);
            let sine = product(k, zero, |i| circle[i][0], turning).times(share);
            circle.push([cosine, sine]);
        }
        y
    }

    /// The derivative of a state.
    pub fn derivative<T: Number>(&self, mode: Mode, state: &[T; STATE]) -> [T; STATE] {
        self.series(mode, state, 1)[1]
    }
}

/// The powers of two next to `[√(m2/m1), √(m2/m1)/σ, 1, 1/σ, 1/σ, 1]`, by `m1/m2` and `σ²`.
fn scales(ratio: Interval, square: Interval) -> [f64; STATE] {
    let power = |square: f64| (0.5 * square.log2()).round().exp2();
    let (mass, speed) = (power(1.0 / ratio.mid()), power(1.0 / square.mid()));
    [mass, mass * speed, 1.0, speed, speed, 1.0]
}

/// The coefficient of the power `k` of a product of two series.
pub fn product<T: Number>(k: usize, zero: T, a: impl Fn(usize) -> T, b: impl Fn(usize) -> T) -> T {
    (0..=k).fold(zero, |sum, i| sum + a(i) * b(k - i))
}

/// `[K1, K3]` of the contacts, `K = (4/3) q / ((δa + δb) √(1/R))` with `δ = (1 - ν²)/(πE)` (section 2 of the paper).
fn hertz_stiffness(surfaces: &Surfaces) -> [Interval; 2] {
    let number = Interval::decimal;
    let softness =
        |young: f64, poisson: f64| (Interval::ONE - number(poisson).square()) / (pi() * number(young));
    let s = surfaces;
    let pairs = [
        softness(s.young_1.get(), s.poisson_1.get()) + softness(s.young_2.get(), s.poisson_2.get()),
        softness(s.young_3.get(), s.poisson_3.get()) + softness(s.young_4.get(), s.poisson_4.get()),
    ];
    let curvature = Interval::ONE / number(s.radius.get());
    pairs.map(|softness| {
        Interval::point(4.0) * number(s.coefficient.get())
            / (Interval::point(3.0) * softness * curvature.sqrt())
    })
}

/// The series at an independent variable, the last coefficient first (Horner).
pub fn at(series: &[State], h: Interval) -> State {
    std::array::from_fn(|i| series.iter().rev().fold(Interval::ZERO, |sum, c| sum * h + c[i]))
}
