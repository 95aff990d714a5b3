//! A motion as rows: at equal intervals, and at the moments that lie between them.

use crate::error::SolverError;
use crate::motion::knot::Knot;
use crate::motion::segment::Segment;
use crate::observe::falls::falls;
use crate::observe::observer::{Impact, Observer, Unobserved};
use crate::plan::{Plan, Request};
use crate::run::Follow;
use crate::settings::{Settings, Window};
use retune_model::{Bare, Coupled, Scene, Side};

/// Why a moment of the motion is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Moment {
    /// It lies at a whole number of intervals from the start of the window.
    Grid,
    /// The damper touches a wall.
    TouchDown,
    /// The force of a contact is at a maximum: a contact of some milliseconds has one, a sustained contact may have several.
    ForceMax,
    /// The damper leaves a wall.
    LiftOff,
    /// E1 is at a maximum.
    EnergyMax,
}

impl Moment {
    /// Its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::TouchDown => "touch-down",
            Self::ForceMax => "force-max",
            Self::LiftOff => "lift-off",
            Self::EnergyMax => "E1-max",
        }
    }
}

/// A moment of a recorded trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub t: f64,
    /// `[x1, v1, x2, v2]` (m, m/s); `[x1, v1, 0, 0]` without a damper.
    pub state: [f64; 4],
    /// Energy of the primary structure, J.
    pub e1: f64,
    /// Energy of the damper, the paper's E2, J.
    pub e2: f64,
    /// Contact forces on the primary structure and on the obstacle, N.
    pub forces: [f64; 2],
    /// Why it is recorded.
    pub moment: Moment,
    /// The wall of the contact to which the moment belongs; `None` for [`Moment::Grid`] and [`Moment::EnergyMax`].
    pub wall: Option<Side>,
}

/// The moments to record within a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows {
    /// Time between two moments of [`Moment::Grid`], s.
    pub interval: f64,
    /// Whether the other moments are recorded, too.
    pub events: bool,
}

impl Rows {
    /// The grid alone.
    pub fn every(interval: f64) -> Self {
        Self { interval, events: false }
    }
}

/// Visits the motion in the order of time at `window.from + k interval` (s) for `k = 0, 1, …` up to the end of the window and, if
/// requested, at the other moments of [`Moment`].
///
/// Touch-downs and lift-offs are those that the method locates; a method that steps over them reports them at the end of its step.
/// Maxima are located to rounding on the motion of the method, which is sampled four times a step.
///
/// # Errors
/// [`SolverError`] with the time reached; samples before that have been visited.
pub fn trajectory(
    scene: &Scene,
    window: Window,
    settings: &Settings,
    rows: Rows,
    visit: &mut dyn FnMut(&Sample),
) -> Result<(), SolverError> {
    match &scene.damper {
        None => recorded(&Bare::new(&scene.primary, &scene.forcing), window, settings, rows, visit),
        Some(damper) => {
            recorded(&Coupled::new(&scene.primary, &scene.forcing, damper), window, settings, rows, visit)
        }
    }
}

fn recorded<S: Recorded<N> + Follow<N>, const N: usize>(
    system: &S,
    window: Window,
    settings: &Settings,
    rows: Rows,
    visit: &mut dyn FnMut(&Sample),
) -> Result<(), SolverError> {
    let mut recorder = Recorder::new(system, window.from, rows, visit);
    let plan = Plan::of(system, settings, Request::Motion);
    system.follow(plan, window, settings, &mut Unobserved, &mut recorder)?;
    Ok(())
}

/// The recorded quantities of a system.
trait Recorded<const N: usize> {
    fn sample(&self, knot: &Knot<N>, moment: Moment) -> Sample;
    /// dE1/dt, W.
    fn power(&self, knot: &Knot<N>) -> f64;
    /// The indentation of a wall, m, and its rate, m/s.
    fn depth(&self, knot: &Knot<N>, side: Side) -> [f64; 2];
}

impl Recorded<2> for Bare {
    fn sample(&self, knot: &Knot<2>, moment: Moment) -> Sample {
        let [x1, v1] = knot.y;
        let e1 = self.primary_energy(x1, v1);
        Sample { t: knot.t, state: [x1, v1, 0.0, 0.0], e1, e2: 0.0, forces: [0.0; 2], moment, wall: None }
    }
    fn power(&self, knot: &Knot<2>) -> f64 {
        self.primary_energy_rates(knot.excitation, &knot.y)[1]
    }
    fn depth(&self, _knot: &Knot<2>, _side: Side) -> [f64; 2] {
        [f64::NEG_INFINITY, 0.0]
    }
}

impl Recorded<4> for Coupled {
    fn sample(&self, knot: &Knot<4>, moment: Moment) -> Sample {
        Sample {
            t: knot.t,
            state: knot.y,
            e1: self.bare().primary_energy(knot.y[0], knot.y[1]),
            e2: self.damper_energy_rates(knot.excitation, &knot.y)[0],
            forces: self.wall_reactions(knot.excitation, &knot.y),
            moment,
            wall: None,
        }
    }
    fn power(&self, knot: &Knot<4>) -> f64 {
        self.primary_energy_rates(knot.excitation, &knot.y)[1]
    }
    fn depth(&self, knot: &Knot<4>, side: Side) -> [f64; 2] {
        [self.indentation(&knot.y)[side as usize], side.sign() * (knot.y[3] - knot.y[1])]
    }
}

struct Recorder<'a, S, const N: usize> {
    system: &'a S,
    start: f64,
    rows: Rows,
    next: f64,
    visit: &'a mut dyn FnMut(&Sample),
    /// The end of the last piece.
    last: Option<Knot<N>>,
    /// The wall in contact, and the largest indentation of this contact.
    contact: Option<(Side, f64)>,
    /// The rigid wall that holds the damper.
    held: Option<Side>,
}

/// Share of the largest indentation below which a contact has ended.
const LEFT: f64 = 1e-9;

impl<'a, S: Recorded<N>, const N: usize> Recorder<'a, S, N> {
    fn new(system: &'a S, start: f64, rows: Rows, visit: &'a mut dyn FnMut(&Sample)) -> Self {
        Self { system, start, rows, next: 0.0, visit, last: None, contact: None, held: None }
    }

    fn emit(&mut self, knot: &Knot<N>, moment: Moment, wall: Option<Side>) {
        (self.visit)(&Sample { wall, ..self.system.sample(knot, moment) });
    }

    /// Emits a moment of a contact, if events are requested.
    fn event(&mut self, knot: &Knot<N>, moment: Moment, wall: Side) {
        if self.rows.events {
            self.emit(knot, moment, Some(wall));
        }
    }

    /// The moments in a piece, in the order of time, each with the wall of its contact.
    fn moments(&mut self, segment: &dyn Segment<N>) -> Vec<(Knot<N>, Moment, Option<Side>)> {
        const SAMPLES: usize = 4;
        let [from, to] = segment.ends();
        let theta = |number: usize| segment.length() * number as f64 / SAMPLES as f64;
        let places: [f64; SAMPLES + 1] = std::array::from_fn(theta);
        let knots: [Knot<N>; SAMPLES + 1] = std::array::from_fn(|number| match number {
            0 => *from,
            SAMPLES => *to,
            _ => segment.at(places[number]),
        });
        let mut moments = Vec::new();
        let mut maxima = |rate: &dyn Fn(&Knot<N>) -> f64, moment: Moment, wall: Option<Side>| {
            let rates = knots.map(|knot| rate(&knot));
            for number in 0..SAMPLES {
                let [from, to] = [number, number + 1].map(|number| (places[number], rates[number]));
                if from.1 > 0.0 && to.1 <= 0.0 {
                    let place = falls(|theta| rate(&segment.at(theta)), from, to);
                    moments.push((segment.at(place), moment, wall));
                }
            }
        };
        maxima(&|knot| self.system.power(knot), Moment::EnergyMax, None);
        // A damper that rests on a wall from the start is in contact without a touch-down.
        let depth = |side: Side| knots.map(|knot| self.system.depth(&knot, side)[0]);
        let deepest = |side: Side| depth(side).into_iter().fold(0.0, f64::max);
        let contact = self
            .contact
            .or_else(|| Side::BOTH.into_iter().find(|&side| deepest(side) > 1e-12).map(|side| (side, 0.0)));
        if let Some((side, before)) = contact {
            maxima(&|knot| self.system.depth(knot, side)[1], Moment::ForceMax, Some(side));
            // An indentation by rounding is no contact.
            moments.retain(|(knot, moment, _)| {
                *moment != Moment::ForceMax || self.system.depth(knot, side)[0] > 0.0
            });
            let deepest = deepest(side).max(before);
            let [depth, rate] = self.system.depth(to, side);
            let left = deepest > 0.0 && rate < 0.0 && depth <= LEFT * deepest;
            self.contact = (!left).then_some((side, deepest));
            if left {
                moments.push((*to, Moment::LiftOff, Some(side)));
            }
        }
        moments.sort_by(|(a, ..), (b, ..)| a.t.total_cmp(&b.t));
        moments
    }
}

impl<S: Recorded<N>, const N: usize> Observer<N> for Recorder<'_, S, N> {
    fn segment(&mut self, segment: &dyn Segment<N>) {
        let [from, to] = segment.ends();
        if segment.in_flight()
            && let Some(wall) = self.held.take()
        {
            self.event(from, Moment::LiftOff, wall);
        }
        let moments = if self.rows.events { self.moments(segment) } else { Vec::new() };
        let mut moments = moments.into_iter().peekable();
        loop {
            let t = self.start + self.next * self.rows.interval;
            let row = t.min(to.t);
            while let Some((knot, moment, wall)) = moments.next_if(|(knot, ..)| knot.t < row || t > to.t) {
                self.emit(&knot, moment, wall);
            }
            if t > to.t {
                break;
            }
            let knot = if t <= from.t {
                *from
            } else if t == to.t {
                *to
            } else {
                segment.at_time(t)
            };
            self.emit(&knot, Moment::Grid, None);
            self.next += 1.0;
        }
        self.last = Some(*to);
    }

    fn touch_down(&mut self, _t: f64, side: Side) {
        self.contact = Some((side, 0.0));
        if let Some(knot) = self.last {
            self.event(&knot, Moment::TouchDown, side);
        }
    }

    fn impact(&mut self, impact: &Impact<N>) {
        (self.contact, self.held) = (None, impact.caught.then_some(impact.side));
        self.last = Some(impact.after);
        if !impact.caught {
            self.event(&impact.after, Moment::LiftOff, impact.side);
        }
    }
}
