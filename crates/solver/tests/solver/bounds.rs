//! The bounds on which the search for a largest value rests (`docs/bounds.md`), held against the motion itself.

use crate::problems::{quintic, rates};
use retune_model::{Coupled, OverContact, Side};
use retune_solver::observe::{
    DamperEnergy, Observer, Path, PrimaryEnergy, Quantity, RelativePosition, Segment,
};
use retune_solver::{Hybrid, Motion, Phase};
use retune_testkit::scenes::{Numbers, ROW1, SSVI, Spread, TMD, TWO_SIDED};

/// Holds every piece of a motion against its bounds.
struct Held<Q> {
    quantity: Q,
    /// Pieces looked at, in flight and in contact; those whose bound is finite; contacts with a finite bound of all, and all.
    pieces: [u64; 2],
    bounded: [u64; 2],
    contacts: [u64; 2],
    /// Pieces whose coarse bound is finite: of contacts alone.
    risen: [u64; 2],
    /// The largest share of a bound that a piece used.
    used: [f64; 2],
    /// The second derivative that a contact's pieces may have, and the value that they may reach.
    second: f64,
    highest: f64,
    /// Contacts that are known to have little more than at their ends: a tenth.
    level: u64,
}

impl<Q: Quantity<4>> Held<Q> {
    fn new(quantity: Q) -> Self {
        let (pieces, bounded, contacts) = ([0; 2], [0; 2], [0; 2]);
        let (second, highest) = (f64::INFINITY, f64::INFINITY);
        Self { quantity, pieces, bounded, contacts, risen: [0; 2], used: [0.0; 2], second, highest, level: 0 }
    }
}

impl<Q: Quantity<4>> Observer<4> for Held<Q> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        let (h, [first, _]) = (segment.length(), segment.ends());
        let kind = usize::from(first.clock != [1.0, 0.0]);
        // Slopes at its ends are by its own clock, not by that of flight: as exact as the loosest runs.
        for (end, theta) in segment.ends().into_iter().zip([0.0, h]) {
            let ([rate, bend], there) = (end.clock, segment.at(theta).clock);
            let size = rate.abs() + h * bend.abs();
            assert!((rate - there[0]).abs() <= 0.01 * size, "{:?} {there:?}", end.clock);
        }
        // The last digits of a contact's ends are another computation's: the piece is taken between moments of its own.
        let (from, to) = (0.001 * h, 0.999 * h);
        let [begin, end] = [from, to].map(|theta| segment.at(theta));
        let [a, b] = [&begin, &end].map(|knot| rates(&self.quantity, knot, segment.in_flight()));
        let form = self.quantity.form();
        let size = form.size(&begin.y).max(form.size(&end.y));
        let bounds = [false, true]
            .map(|sharp| segment.quintic_error(form, [&begin, &end], to - from, sharp).expect("a bound"));
        let rise = segment.rise(form, [&begin, &end], [a[1], b[1]], to - from);
        self.pieces[kind] += 1;
        self.risen[kind] += u64::from(rise.is_finite());
        self.bounded[kind] += u64::from(bounds[0].is_finite());
        for step in 1..8 {
            let s = f64::from(step) / 8.0;
            let knot = segment.at(from + s * (to - from));
            let value = self.quantity.rates(knot.excitation, &knot.y)[0];
            let error = (value - quintic(to - from, a, b, s)).abs();
            // A contact's interior is as exact as its steps.
            let rounding = if kind == 1 { 1e-10 } else { 1e-12 } * size + 1e-20;
            assert!(value <= a[0].max(b[0]) + rise + rounding, "{kind}: {value:e} {a:?} {b:?} {rise:e}");
            for bound in bounds {
                assert!(error <= bound + rounding, "{kind}: {error:e} {bound:e} {size:e}");
                if bound > 100.0 * rounding {
                    self.used[kind] = self.used[kind].max(error / bound);
                }
            }
            let [_, _, curvature] = self.quantity.rates(knot.excitation, &knot.y);
            assert!(curvature.abs() <= self.second * (1.0 + 1e-9), "{curvature:e} {:e}", self.second);
            assert!(value <= self.highest + rounding, "{value:e} {:e}", self.highest);
        }
    }
    fn path(&mut self, path: &dyn Path<4>) {
        self.second = path.second_derivative(self.quantity.form());
        self.contacts[1] += 1;
        self.contacts[0] += u64::from(self.second.is_finite());
        let [begin, end] = path.ends().map(|y| self.quantity.rates([0.0; 2], y)[0]);
        let rise = path.rise(self.quantity.form());
        self.highest = begin.max(end) + rise;
        self.level += u64::from(rise < 0.1 * begin.max(end));
        (0..path.pieces()).for_each(|piece| path.show(piece, &mut |part| self.see(part)));
        (self.second, self.highest) = (f64::INFINITY, f64::INFINITY);
    }
}

fn held<Q: Quantity<4>>(numbers: &Numbers, quantity: Q, totals: &mut Held<()>) {
    let system = numbers.coupled();
    let mut held = Held::new(quantity);
    let rest = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    for rtol in [1e-6, 1e-10] {
        Hybrid::new(&system, rtol, 10.0, 1_000_000).propagate(rest, 10.0, &mut held).expect("a run");
    }
    for kind in [0, 1] {
        totals.pieces[kind] += held.pieces[kind];
        totals.bounded[kind] += held.bounded[kind];
        totals.risen[kind] += held.risen[kind];
        totals.contacts[kind] += held.contacts[kind];
        totals.used[kind] = totals.used[kind].max(held.used[kind]);
    }
    totals.level += held.level;
}

#[test]
fn invariant_no_motion_leaves_its_bounds() {
    let mut totals = Held {
        quantity: (),
        pieces: [0; 2],
        bounded: [0; 2],
        contacts: [0; 2],
        risen: [0; 2],
        used: [0.0; 2],
        second: 0.0,
        highest: 0.0,
        level: 0,
    };
    let mut draw = Spread::new(5);
    let mut scenes = vec![SSVI, ROW1, TMD, TWO_SIDED, Numbers { d: 0.0, ..TWO_SIDED }];
    for number in 0..80 {
        scenes.push(Numbers {
            // Half of them lose energy in contacts.
            lambda: if number % 4 == 1 { draw.logarithmic(1e-2, 30.0) } else { 0.0 },
            e: if number % 4 == 2 { 0.4 + 0.59 * draw.unit() } else { 1.0 },
            m2: draw.logarithmic(1.0, 3000.0),
            k1: draw.logarithmic(1e4, 1e5),
            k2: 3500.0 * draw.unit(),
            c2: 400.0 * draw.unit(),
            d: 0.2 * draw.unit(),
            c: 0.3 * draw.unit(),
            r: draw.logarithmic(0.2, 5.0),
            omega: 3.0 + 7.0 * draw.unit(),
            ..SSVI
        });
    }
    for numbers in &scenes {
        let system = numbers.coupled();
        held(numbers, PrimaryEnergy::new(&system), &mut totals);
        held(numbers, DamperEnergy::new(&system), &mut totals);
        held(numbers, RelativePosition::new(&system, 1.0), &mut totals);
    }
    eprintln!(
        "pieces {:?}, bounded {:?}; contacts bounded and all {:?}, level {}; largest share of a bound used {:.3?}",
        totals.pieces, totals.bounded, totals.contacts, totals.level, totals.used
    );
    // The bounds are of use: finite where they are asked for, and not far above what they bound.
    assert!(totals.pieces[0] > 10_000 && totals.pieces[1] > 10_000, "{:?}", totals.pieces);
    assert_eq!(totals.bounded[0], totals.pieces[0]);
    assert!(totals.bounded[1] as f64 > 0.95 * totals.pieces[1] as f64, "{:?}", totals.bounded);
    assert!(totals.contacts[0] as f64 > 0.95 * totals.contacts[1] as f64, "{:?}", totals.contacts);
    assert!(totals.risen[1] as f64 > 0.98 * totals.pieces[1] as f64, "{:?}", totals.risen);
    assert!(totals.level as f64 > 0.15 * totals.contacts[1] as f64, "{}", totals.level);
    assert!(totals.used.iter().all(|used| *used > 0.05), "{:?}", totals.used);
}

/// The rise of a quantity in contacts beside what it should be.
struct Rises<'a, Q, E> {
    numbers: &'a Numbers,
    system: &'a Coupled,
    quantity: Q,
    expected: E,
    contacts: u64,
}

impl<Q: Quantity<4>, E: Fn(&Numbers, &OverContact, f64) -> f64> Observer<4> for Rises<'_, Q, E> {
    fn path(&mut self, path: &dyn Path<4>) {
        let (&touch, mut duration) = (path.ends()[0], 0.0);
        path.states(&mut |t, _| duration = t);
        let to = |side: Side| (touch[2] - touch[0] - self.system.wall(side)).abs();
        let side = if to(Side::Primary) < to(Side::Obstacle) { Side::Primary } else { Side::Obstacle };
        let equations = self.system.regularised_contact(side);
        let touch = equations.regularise(&touch);
        let depth = equations.greatest_depth(touch[1]);
        let over = equations.over_contact(&touch, depth, duration, self.numbers.p).expect("a bound");
        // ∫ F dt, N·s.
        let impulse = self.system.hertz(side) * over.impulse / equations.hertz_rate();
        let found = path.rise(self.quantity.form());
        let expected = (self.expected)(self.numbers, &over, impulse);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        self.contacts += 1;
    }
}

fn rises<Q: Quantity<4>>(
    numbers: &Numbers,
    system: &Coupled,
    quantity: Q,
    expected: impl Fn(&Numbers, &OverContact, f64) -> f64,
) {
    let mut rises = Rises { numbers, system, quantity, expected, contacts: 0 };
    let rest = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    Hybrid::new(system, 1e-8, 20.0, 1_000_000).propagate(rest, 20.0, &mut rises).expect("a run");
    assert!(rises.contacts > 10, "{}", rises.contacts);
}

/// At most by what all forces but Hertz's do, and by what they change of what Hertz's does.
#[test]
fn exact_rise_in_a_contact_adds_up_every_cause() {
    for numbers in [SSVI, ROW1, TWO_SIDED] {
        let system = numbers.coupled();
        rises(&numbers, &system, PrimaryEnergy::new(&system), |n, over, impulse| {
            let ([_, v, stretch, w], [_, a, _, _]) = (over.most, over.beside);
            over.duration * (v * (n.p + n.c1 * v + n.c2 * w + n.k2 * stretch) + impulse * a)
        });
        // m2 a2 + k2 (x2 - D) = k2 x1 - c2 (v2 - v1).
        rises(&numbers, &system, DamperEnergy::new(&system), |n, over, impulse| {
            let ([x, v, _, w], [_, a, _, apart]) = (over.most, over.beside);
            over.duration * ((v + w) * (n.k2 * x + n.c2 * w) + impulse * (a + apart))
        });
        let away = RelativePosition::new(&system, -1.0);
        rises(&numbers, &system, away, |_, over, _| over.duration * over.most[3]);
    }
}
