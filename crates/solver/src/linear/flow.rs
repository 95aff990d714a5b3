//! The exact flow of a forced linear system: Taylor series over one step of a fixed length.
//!
//! The step is little longer than the inverse of the flow's fastest rate, so the series of the matrix exponential needs no
//! scaling, loses almost nothing to cancellation and has converged to rounding after 20 terms (`1.25²⁰/20! = 4e-17`).
//! Eigenvectors are not used: near critical damping they are nearly parallel. The force is two more components that rotate by
//! `ωt`, so resonance is no special case. Four steps are computed at once, with the powers of the same matrix, and every operation
//! is one vector instruction.

use crate::budget::Pace;
use crate::error::SolverError;
use crate::motion::knot::Jet;
use crate::motion::lanes::{LANES, each};
use crate::motion::polynomial::{BLOCKS, Polynomial};
use crate::system::Linear;
use retune_model::Excitation;
use wide::f64x4;

/// Length of a step times the rate of the flow. Longer steps are fewer, but bounds over them are looser.
const STEP: f64 = 1.25;

/// The moments after 1, 2, … [`LANES`] whole steps, component by component.
pub struct Stride<const N: usize> {
    /// `[P cos ωt, P sin ωt]`, N.
    pub excitation: [f64x4; 2],
    /// States.
    pub y: [f64x4; N],
}

/// Four consecutive pieces of a record.
pub struct FourPieces<const N: usize> {
    /// Their durations and end times, s.
    pub lengths: f64x4,
    pub times: f64x4,
    /// The force at the beginning of each, and its partner.
    pub begin: [f64x4; 2],
    /// The moments at which they end.
    pub ends: Stride<N>,
}

/// The flow over a fixed step: `y(t + h) = origin + Φ (y(t) - origin) + Ψ [P cos ωt, P sin ωt]`.
pub struct Flow<const N: usize> {
    linear: Linear<N>,
    step: f64,
    /// 1 for a harmonic force, 0 for one that is linear in time.
    back: f64,
    /// Columns of `Φ` and of its powers: `phi[j][i]` is the effect of component `j` on component `i` after each of the steps.
    phi: [[f64x4; N]; N],
    /// The effects of the two components of the force, as `phi`.
    psi: [[f64x4; N]; 2],
    /// Cosine and sine of the angles by which the force has rotated, and the sine with which it enters its partner: 0 where it is linear in
    /// time.
    turn: [f64x4; 3],
    /// Series of the cosine and the sine of the angle by which the force rotates.
    rotation: [Polynomial<BLOCKS>; 2],
    /// Responses of the states to the force at each boundary of the steps, where it is linear within each step: zero in earlier steps.
    sample_responses: [[f64x4; N]; LANES + 1],
    /// The series of which `Φ` and `Ψ` are the values at the end of the step.
    free: [Expansion<N>; N],
    forced: [Expansion<N>; 2],
}

/// The motion over one step, component by component: `y(t + s)` for `0 <= s <= step`, to the first `4 B` terms.
#[derive(Clone, Copy)]
pub struct Expansion<const N: usize, const B: usize = BLOCKS>(pub [Polynomial<B>; N]);

impl<const N: usize> Flow<N> {
    /// Prepares the flow for steps of [`STEP`]` / rate` seconds, or of `longest` if that is shorter.
    pub fn new(linear: Linear<N>, longest: f64) -> Self {
        let step = longest.min(STEP / linear.rate);
        let unit = |i: usize| -> [f64; N] { std::array::from_fn(|j| f64::from(i == j)) };
        let free = series(&linear, [[0.0; 2]; N], std::array::from_fn(unit));
        let forced = series(&linear, [[1.0, 0.0], [0.0, 1.0]], [[0.0; N]; 2]);
        let mut coefficients = [[0.0; 2]; 4 * BLOCKS];
        coefficients[0] = [1.0, 0.0];
        for k in 1..coefficients.len() {
            let ([c, s], order) = (coefficients[k - 1], k as f64);
            coefficients[k] = [-(linear.returns / order) * s, (linear.frequency / order) * c];
        }
        let rotation = [0, 1].map(|part| Polynomial::new(&coefficients.map(|c| c[part])));
        let back = if linear.returns == 0.0 { 0.0 } else { 1.0 };
        let turn = rotation.each_ref().map(|part: &Polynomial<BLOCKS>| part.at(step));
        let mut flow = Self {
            phi: [[f64x4::ZERO; N]; N],
            psi: [[f64x4::ZERO; N]; 2],
            sample_responses: [[f64x4::ZERO; N]; LANES + 1],
            turn: [f64x4::ZERO; 3],
            linear,
            step,
            back,
            rotation,
            free,
            forced,
        };
        let (phi, psi) =
            (flow.free.each_ref().map(|c| c.at(step)), flow.forced.each_ref().map(|c| c.at(step)));
        let mut columns: [([f64; 2], [f64; N]); N] = std::array::from_fn(|j| ([0.0; 2], unit(j)));
        let mut forces = [([1.0, 0.0], [0.0; N]), ([0.0, 1.0], [0.0; N])];
        for lane in 0..LANES {
            for (excitation, y) in columns.iter_mut().chain(&mut forces) {
                let mut next = [0.0; N];
                for (column, weight) in psi.iter().zip(&*excitation).chain(phi.iter().zip(&*y)) {
                    for i in 0..N {
                        next[i] += column[i] * weight;
                    }
                }
                (*excitation, *y) = (rotated(*excitation, turn, back), next);
            }
            for i in 0..N {
                for j in 0..N {
                    flow.phi[j][i].as_mut_array()[lane] = columns[j].1[i];
                }
                for j in 0..2 {
                    flow.psi[j][i].as_mut_array()[lane] = forces[j].1[i];
                }
            }
            // The first force has become [cos, sin], the second [-sin, cos]: of a force that is linear in time [1, 0] and [-ωt, 1].
            let [(ahead, _), (across, _)] = forces;
            let sine = if back == 0.0 { -across[0] } else { ahead[1] };
            for (turn, now) in flow.turn.iter_mut().zip([ahead[0], sine, back * sine]) {
                turn.as_mut_array()[lane] = now;
            }
        }
        if back == 0.0 {
            flow.sample_responses = flow.responses_to_samples();
        }
        flow
    }

    /// A straight line from `f` to `g` is `f` with the partner `-(g - f) / (ω h)`; its effect within the step is carried on by `Φ`.
    fn responses_to_samples(&self) -> [[f64x4; N]; LANES + 1] {
        let lane = |column: &[f64x4; N], lane: usize| column.map(|lanes| lanes.to_array()[lane]);
        let [value, partner] = self.psi.each_ref().map(|column| lane(column, 0));
        let slope = 1.0 / (self.linear.frequency * self.step);
        let single_step: [[f64; N]; 2] =
            [std::array::from_fn(|i| value[i] + partner[i] * slope), partner.map(|of| -of * slope)];
        let mut sample_responses = [[f64x4::ZERO; N]; LANES + 1];
        for step in 0..LANES {
            for (end, response) in single_step.iter().enumerate() {
                for after in step..LANES {
                    // Carried on by the whole steps after this one.
                    let carried = match (after - step).checked_sub(1) {
                        None => *response,
                        Some(steps) => {
                            let mut sum = [0.0; N];
                            for (column, weight) in self.phi.iter().zip(response) {
                                let column = lane(column, steps);
                                for i in 0..N {
                                    sum[i] += column[i] * weight;
                                }
                            }
                            sum
                        }
                    };
                    for i in 0..N {
                        sample_responses[step + end][i].as_mut_array()[after] += carried[i];
                    }
                }
            }
        }
        sample_responses
    }

    /// Adds the deviation of a state after the next whole steps without force.
    #[inline(always)]
    fn add_free(&self, next: &mut [f64x4; N], y: &[f64; N]) {
        for (j, column) in self.phi.iter().enumerate() {
            let deviation = y[j] - self.linear.origin[j];
            for i in 0..N {
                next[i] += column[i] * deviation;
            }
        }
    }

    /// The moments after the next whole steps, in each of which the force is linear from one of these values to the next, and the force and
    /// its partner at the beginning of each.
    #[inline(always)]
    pub fn sampled_stride(&self, forces: &[f64; LANES + 1], y: &[f64; N]) -> ([f64x4; 2], Stride<N>) {
        let mut next = self.linear.origin.map(f64x4::splat);
        for (column, &force) in self.sample_responses.iter().zip(forces) {
            for i in 0..N {
                next[i] += column[i] * force;
            }
        }
        self.add_free(&mut next, y);
        let [a, b, c, d, e] = *forces;
        let (begin, end) = (f64x4::from([a, b, c, d]), f64x4::from([b, c, d, e]));
        let partner = (begin - end) * (1.0 / (self.linear.frequency * self.step));
        ([begin, partner], Stride { excitation: [end, partner], y: next })
    }

    /// Length of a whole step, s.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Refuses a run to time `to` (s) in which a whole step would be lost to rounding.
    ///
    /// # Errors
    /// [`SolverError::TooFast`].
    pub fn check_step(&self, t: f64, to: f64) -> Result<(), SolverError> {
        if to <= t || to + self.step > to { Ok(()) } else { Err(self.too_fast(to)) }
    }

    /// The error of a step that is lost to rounding at `t` (s).
    pub fn too_fast(&self, t: f64) -> SolverError {
        SolverError::TooFast { t, h: self.step, remedy: self.pace().remedy(t, self.step) }
    }

    /// The derivatives of the motion at a moment, by the equations of this flow.
    #[cold]
    pub fn jet(&self, excitation: Excitation, y: &[f64; N]) -> Jet<N> {
        let Linear { columns, input, partner, origin, frequency, returns, .. } = &self.linear;
        let mut states = [each(|i| y[i] - origin[i]); 4];
        let mut force = [excitation[0]; 3];
        let mut now = excitation;
        for order in 1..4 {
            let free = mat_vec(columns, &states[order - 1]);
            states[order] = each(|i| free[i] + input[i] * now[0]);
            if let Some(partner) = partner {
                (0..N).for_each(|i| states[order][i] += partner[i] * now[1]);
            }
            now = [-frequency * now[1], returns * now[0]];
            if order < 3 {
                force[order] = now[0];
            }
        }
        Jet { states, force }
    }

    /// The series of which `Φ` and `Ψ` are the values.
    pub(super) fn series(&self) -> (&[Expansion<N>; N], &[Expansion<N>; 2]) {
        (&self.free, &self.forced)
    }

    /// The last term of the series over a step, relative to the largest one: the largest such ratio of any component of the motion.
    pub fn last_term(&self) -> f64 {
        let share = |series: &Polynomial<BLOCKS>| {
            let mut power = 1.0;
            let terms: [f64; 4 * BLOCKS] = std::array::from_fn(|k| {
                let term = (series.coefficient(k) * power).abs();
                power *= self.step;
                term
            });
            let largest = terms.iter().copied().fold(0.0, f64::max);
            if largest > 0.0 { terms[4 * BLOCKS - 1] / largest } else { 0.0 }
        };
        let series = self.free.iter().chain(&self.forced);
        series.flat_map(|expansion| expansion.0.iter().map(share)).fold(0.0, f64::max)
    }

    /// How the flow chooses its steps.
    pub fn pace(&self) -> Pace {
        Pace::Flight { step: self.step, fastest: self.linear.fastest }
    }

    /// Whether it leaves out a fast part of the motion, which has decayed.
    pub fn is_reduced(&self) -> bool {
        self.linear.partner.is_some()
    }

    /// The linear equations of the flow.
    pub fn linear(&self) -> &Linear<N> {
        &self.linear
    }

    /// A deviation from the origin after `steps` whole steps without force, `Φ^steps y`, by repeated squaring.
    pub fn decay(&self, mut steps: u64, mut deviation: [f64; N]) -> [f64; N] {
        let mut power = self.phi.map(|column| column.map(|lanes| lanes.to_array()[0]));
        while steps > 0 {
            if steps & 1 == 1 {
                deviation = mat_vec(&power, &deviation);
            }
            power = power.map(|column| mat_vec(&power, &column));
            steps >>= 1;
        }
        deviation
    }

    /// The moments after the next whole steps.
    #[inline(always)]
    pub fn stride(&self, excitation: Excitation, y: &[f64; N]) -> Stride<N> {
        let mut next = self.linear.origin.map(f64x4::splat);
        for (column, force) in self.psi.iter().zip(excitation) {
            for i in 0..N {
                next[i] += column[i] * force;
            }
        }
        self.add_free(&mut next, y);
        let ([c, s], [cos, sin, returning]) = (excitation, self.turn);
        Stride { excitation: [cos * c - sin * s, cos * s + returning * c], y: next }
    }

    /// The response over the next step to a jump of the force's partner by 1 N: the contribution of a bend of a force that is linear in
    /// time.
    pub fn partner_response(&self) -> &Expansion<N> {
        &self.forced[1]
    }

    /// The force `s` seconds later, `0 <= s <= step`.
    #[inline(always)]
    pub fn excitation_after(&self, excitation: Excitation, s: f64) -> Excitation {
        rotated(excitation, self.rotation.each_ref().map(|part| part.at(s)), self.back)
    }

    /// The motion from `y` over the next step.
    #[inline(always)]
    pub fn expand<const B: usize>(&self, excitation: Excitation, y: &[f64; N]) -> Expansion<N, B> {
        let deviation: [f64; N] = each(|j| y[j] - self.linear.origin[j]);
        Expansion(std::array::from_fn(|i| {
            let mut sum = [f64x4::ZERO; B];
            for b in 0..B {
                for (series, force) in self.forced.iter().zip(excitation) {
                    sum[b] += series.0[i].0[b] * force;
                }
                for (series, deviation) in self.free.iter().zip(deviation) {
                    sum[b] += series.0[i].0[b] * deviation;
                }
            }
            Polynomial(sum).with_constant(y[i])
        }))
    }
}

/// A matrix, by its columns, times a vector.
pub(super) fn mat_vec<const N: usize>(columns: &[[f64; N]; N], y: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| (0..N).map(|j| columns[j][i] * y[j]).sum())
}

/// Taylor series of the deviation from the origin: `c_{k+1} = (A c_k + b f_k) / (k + 1)`, `f_{k+1} = ω J f_k / (k + 1)`, with `J` without
/// its second row where the force is linear in time. Several motions are computed together, because each term depends on the one before it.
fn series<const N: usize, const M: usize>(
    linear: &Linear<N>,
    mut excitations: [Excitation; M],
    mut deviations: [[f64; N]; M],
) -> [Expansion<N>; M] {
    let Linear { columns, input, partner, frequency, returns, .. } = linear;
    let mut expansions = [const { Expansion([Polynomial([f64x4::ZERO; BLOCKS]); N]) }; M];
    for k in 0..4 * BLOCKS {
        if k > 0 {
            let scale = 1.0 / k as f64;
            for (excitation, deviation) in excitations.iter_mut().zip(&mut deviations) {
                let mut next = [0.0; N];
                for i in 0..N {
                    next[i] = input[i] * excitation[0];
                }
                if let Some(partner) = partner {
                    for i in 0..N {
                        next[i] += partner[i] * excitation[1];
                    }
                }
                for (column, &c) in columns.iter().zip(&*deviation) {
                    for i in 0..N {
                        next[i] += column[i] * c;
                    }
                }
                *deviation = next.map(|c| c * scale);
                *excitation = [-frequency * scale * excitation[1], returns * scale * excitation[0]];
            }
        }
        for (expansion, deviation) in expansions.iter_mut().zip(&deviations) {
            for (polynomial, &c) in expansion.0.iter_mut().zip(deviation) {
                polynomial.0[k / 4].as_mut_array()[k % 4] = c;
            }
        }
    }
    expansions
}

impl<const N: usize, const B: usize> Expansion<N, B> {
    /// The state after `s` seconds.
    #[inline(always)]
    pub fn at(&self, s: f64) -> [f64; N] {
        each(|i| self.0[i].at(s))
    }
}

/// `[f cos, f sin]` of a phase, rotated by the angle with this cosine and sine; `back` is 0 where the second stays constant.
#[inline(always)]
fn rotated([c, s]: Excitation, [cos, sin]: [f64; 2], back: f64) -> Excitation {
    [c * cos - s * sin, s * cos + c * (back * sin)]
}
