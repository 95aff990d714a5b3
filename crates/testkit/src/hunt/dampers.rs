//! Branches of dampers over practical ranges, on other structures than the paper's: checks that every change of stability has a
//! bifurcation, and that branches are followed to their ends.

use super::Hunt;
use crate::scenes::{Numbers, SSVI, Spread};
use retune_dynamics::Parameter;
use retune_dynamics::periodic::branches::{Control, Plan};
use retune_dynamics::periodic::{Branch, End, Event, EventKind, Orbit, branches};
use retune_solver::Settings;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};

/// A family: its name, and a function that draws a member.
type Family = (&'static str, fn(&mut Spread) -> Numbers);

const FAMILIES: [Family; 12] = [
    ("Table 2's damper, k1 from 20 to 60 kN/m", |s| {
        tuned(Numbers { k1: s.logarithmic(2e4, 6e4), ..SSVI }, s)
    }),
    ("D = 0", |s| tuned(Numbers { d: 0.0, c: s.logarithmic(0.05, 1.0), ..SSVI }, s)),
    ("C = 0", |s| tuned(Numbers { d: s.logarithmic(0.02, 0.5), c: 0.0, ..SSVI }, s)),
    ("m2 = 1 kg", |s| tuned(Numbers { m2: 1.0, ..walls(s) }, s)),
    ("m2 = 500 kg", |s| tuned(Numbers { m2: 500.0, ..walls(s) }, s)),
    ("hard walls (steel)", |s| {
        tuned(Numbers { young: [2.1e11; 4], r: s.logarithmic(0.05, 2.0), ..walls(s) }, s)
    }),
    ("soft walls", |s| {
        tuned(Numbers { young: [2.1e11, 1e6, 2.1e11, 1e6], r: s.logarithmic(0.01, 0.3), ..walls(s) }, s)
    }),
    ("P = 3000 N", |s| tuned(Numbers { p: 3000.0, ..walls(s) }, s)),
    ("P = 100 N", |s| tuned(Numbers { p: 100.0, ..walls(s) }, s)),
    ("equal walls, D = C", |s| {
        let d = s.logarithmic(0.02, 0.3);
        tuned(Numbers { d, c: d, young: [2.1e11, 2.2e7, 2.1e11, 2.2e7], ..SSVI }, s)
    }),
    ("footbridge, 40 t at 2 Hz", |s| {
        other(Numbers { m1: 4e4, k1: 6.317e6, c1: 5027.0, p: 280.0, ..SSVI }, s)
    }),
    ("laboratory, 2 kg at 5 Hz", |s| {
        other(Numbers { m1: 2.0, k1: 1974.0, c1: 0.6, p: 2.0, r: 0.02, ..SSVI }, s)
    }),
];

/// Table 2's structure with other walls.
fn walls(s: &mut Spread) -> Numbers {
    Numbers { d: s.logarithmic(0.02, 0.5), c: s.logarithmic(0.02, 0.8), ..SSVI }
}

/// Sets a spring between that of a bouncing damper and that of a tuned mass damper, and a damping ratio from 1 to 100 %.
fn tuned(numbers: Numbers, s: &mut Spread) -> Numbers {
    let Numbers { m1, k1, m2, .. } = numbers;
    let k2 = k1 / m1 * m2 * s.logarithmic(0.08, 1.2);
    Numbers { k2, c2: 2.0 * s.logarithmic(0.01, 1.0) * (k2 * m2).sqrt(), ..numbers }
}

/// A damper of 1 to 10 % of the structure's mass, with gaps of the size of its motion at resonance.
fn other(numbers: Numbers, s: &mut Spread) -> Numbers {
    let Numbers { m1, k1, c1, p, .. } = numbers;
    let size = p / (c1 * (k1 / m1).sqrt());
    let m2 = m1 * s.logarithmic(0.01, 0.1);
    tuned(Numbers { m2, d: size * s.logarithmic(0.1, 2.0), c: size * s.logarithmic(0.1, 4.0), ..numbers }, s)
}

/// Counts over branches.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    branches: usize,
    points: usize,
    doubled: usize,
    closed: usize,
    /// Pairs of neighbouring motions between which multipliers cross the unit circle but no bifurcation is reported: among the first four
    /// of a doubled branch, in the last two steps of a closed one, elsewhere.
    unnamed: [usize; 3],
    /// How many of these have a grazing in between.
    grazing: usize,
    circles: usize,
    false_circles: usize,
    ends: usize,
    lost: usize,
    stopped: usize,
}

impl Count {
    fn add(&mut self, other: &Self) {
        self.branches += other.branches;
        self.points += other.points;
        self.doubled += other.doubled;
        self.closed += other.closed;
        for (own, other) in self.unnamed.iter_mut().zip(other.unnamed) {
            *own += other;
        }
        self.grazing += other.grazing;
        self.circles += other.circles;
        self.false_circles += other.false_circles;
        self.ends += other.ends;
        self.lost += other.lost;
        self.stopped += other.stopped;
    }

    fn of(branch: &Branch) -> Self {
        let is = |end: End| branch.ends.iter().filter(|own| **own == end).count();
        let closed = is(End::Closed) > 0;
        let circles: Vec<&Event> =
            branch.events.iter().filter(|event| event.kind == EventKind::NeimarkSacker).collect();
        let mut count = Self {
            branches: 1,
            points: branch.points.len(),
            doubled: usize::from(branch.ends[0] == End::Halved),
            closed: usize::from(closed),
            circles: circles.len(),
            false_circles: circles.iter().filter(|event| !is_on_circle(&event.orbit)).count(),
            ends: if closed { 0 } else { 2 },
            lost: is(End::Lost),
            stopped: is(End::Steps),
            ..Self::default()
        };
        for (place, at_grazing) in unnamed(branch) {
            let part = match place {
                ..4 if branch.ends[0] == End::Halved => 0,
                _ if closed && place + 3 >= branch.points.len() => 1,
                _ => 2,
            };
            count.unnamed[part] += 1;
            count.grazing += usize::from(at_grazing);
        }
        count
    }

    fn row(&self, name: &str, dampers: usize) -> String {
        let Count { branches, points, doubled, closed, unnamed: [first, closing, elsewhere], .. } = *self;
        let Count { grazing, circles, false_circles, ends, lost, stopped, .. } = *self;
        format!(
            "| {name} | {dampers} | {branches} | {doubled} | {closed} | {points} | {first} | {closing} | {elsewhere} | {grazing} | {circles} | {false_circles} | {ends} | {lost} | {stopped} |"
        )
    }
}

/// Whether the pair whose product is nearest to 1 is complex, and on the unit circle.
fn is_on_circle(orbit: &Orbit) -> bool {
    let all = &orbit.multipliers;
    let pairs = (0..4).flat_map(|i| (0..i).map(move |j| (all[i], all[j])));
    let off = |(a, b): (nalgebra::Complex<f64>, nalgebra::Complex<f64>)| (a * b - 1.0).norm();
    pairs
        .min_by(|a, b| off(*a).total_cmp(&off(*b)))
        .is_some_and(|(a, b)| a.im != 0.0 && b == a.conj() && off((a, b)) < 1e-5)
}

/// The motions after which the number of multipliers outside the unit circle changes in a way that the reported bifurcations do not
/// explain, and whether a grazing is reported there.
pub fn unnamed(branch: &Branch) -> Vec<(usize, bool)> {
    let last = branch.points.len() - 1;
    let weight = |event: &Event| match event.kind {
        EventKind::Grazing => 0,
        EventKind::NeimarkSacker => 2,
        _ => 1,
    };
    // At an event, rounding decides on which side of the unit circle a multiplier is.
    let at_event = |place: usize| {
        place == 0 && branch.ends[0] == End::Halved
            || place == last && branch.ends[1] == End::Halved
            || branch.events.iter().any(|event| event.place == place)
    };
    let outside = |place: usize| branch.points[place].multipliers.iter().filter(|m| m.norm() > 1.0).count();
    let places: Vec<usize> = (0..=last).filter(|place| !at_event(*place)).collect();
    let steps = places.windows(2).filter_map(|pair| {
        let [a, b] = [pair[0], pair[1]];
        let between = || branch.events.iter().filter(|event| event.place > a && event.place <= b);
        let change = outside(a).abs_diff(outside(b));
        let named: usize = between().map(weight).sum();
        let told = change <= named && (named - change).is_multiple_of(2);
        (!told).then(|| (a, between().any(|event| event.kind == EventKind::Grazing)))
    });
    steps.collect()
}

/// Follows `each` dampers of every family, each with at most `most` runs and motions, and so either few long branches or many short ones.
pub fn dampers(each: usize, most: usize) -> Hunt {
    let mut hunt = Hunt::default();
    let mut all = Count::default();
    for (number, (name, draw)) in FAMILIES.into_iter().enumerate() {
        let mut spread = Spread::new(100 + number as u64);
        let mut own = Count::default();
        for _ in 0..each {
            let numbers = draw(&mut spread);
            let natural = (numbers.k1 / numbers.m1).sqrt();
            let over = Plan::over(Parameter::Omega, [0.8 * natural, 1.25 * natural]);
            let plan = Plan { samples: 11, starts: 3, ..over };
            let asked = AtomicUsize::new(0);
            let proceed = || asked.fetch_add(1, SeqCst) < most;
            let control = Control { proceed: &proceed, ..Control::default() };
            let found = branches(&numbers.scene(), plan, &Settings::default(), control).expect("branches");
            found.branches.iter().for_each(|branch| own.add(&Count::of(branch)));
        }
        hunt.row(own.row(name, each));
        all.add(&own);
    }
    hunt.row(all.row("all", each * FAMILIES.len()));
    hunt.check(all.branches > 0, || "no branch".to_owned());
    hunt.check(all.unnamed == [0; 3], || format!("{:?} changes of stability are not named", all.unnamed));
    hunt.check(all.false_circles == 0, || format!("{} false Neimark-Sacker bifurcations", all.false_circles));
    hunt
}
