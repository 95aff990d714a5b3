//! Contacts across samples of a record, computed at once, compared with the same contacts followed step by step from sample to sample.

use super::{Draw, numbers, step_by_step, touch_down};
use crate::contact::collocation::bends::Bends;
use crate::contact::collocation::response::Collisions;
use crate::linear::flow::Flow;
use crate::motion::knot::Knot;
use crate::observe::observer::Unobserved;
use crate::system::LinearSystem;
use retune_model::{Coupled, Of, Samples};
use retune_testkit::histories::record;
use retune_testkit::scenes::Numbers;

/// A record over a contact: samples `apart` durations of the contact apart, values of at most this size, which are noise or a slow wave.
#[derive(Clone, Copy, Debug)]
struct Ground {
    of: Of,
    apart: f64,
    size: f64,
    rough: bool,
}

impl Ground {
    /// Over the ranges of an engineer: from 25 samples in a contact to one in ten contacts.
    fn drawn(draw: &mut Draw) -> Self {
        let [of, of_base] = [Of::Force, Of::BaseAcceleration];
        let is_force = draw.next() < 0.5;
        Self {
            of: if is_force { of } else { of_base },
            apart: 10f64.powf(draw.between(-1.4, 1.0)),
            // A force in N on 1000 kg, or an acceleration in m/s².
            size: 10f64.powf(draw.between(-1.0, 1.0)) * if is_force { 800.0 } else { 1.0 },
            rough: draw.next() < 0.7,
        }
    }

    fn samples(&self, draw: &mut Draw, step: f64) -> Samples {
        let (turn, start) = (draw.between(0.05, 0.8), draw.between(0.0, 6.3));
        let value = |i: usize, draw: &mut Draw| match self.rough {
            true => draw.between(-1.0, 1.0),
            false => (turn * i as f64 + start).sin(),
        };
        let values = (0..80).map(|i| self.size * value(i, draw)).collect();
        Samples::every(0.0, step, values).expect("a record")
    }
}

/// The distance of a contact drawn at random from steps, in shares of its touch-down speed or its duration; `None` if it is not computed at
/// once.
fn off(
    draw: &mut Draw,
    ground: Ground,
    rtol: f64,
    change: impl Fn(Numbers) -> Numbers,
) -> Option<(f64, bool)> {
    let drawn = change(numbers(draw));
    let (side, touch) = touch_down(draw, &drawn.coupled());
    let flow = Flow::new(LinearSystem::linear(&drawn.coupled()), 1.0);
    let latest = Collisions::new(&drawn.coupled(), side, &flow, rtol).latest_end(&touch);
    let step = ground.apart * 0.5 * (latest - touch.t);
    let scene = drawn.under(record(ground.of, ground.samples(draw, step)));
    let system = Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper"));
    let t = step * draw.between(0.0, 2.0);
    let touch = Knot { t, excitation: system.excitation(t), ..touch };
    let (flow, mut bends) = (Flow::new(LinearSystem::linear(&system), 1.0), Bends::NONE);
    let collisions = Collisions::new(&system, side, &flow, rtol);
    let mut stretch = system.bare().stretch(t).expect("a record");
    while stretch.to < collisions.latest_end(&touch) {
        let next = system.bare().stretch(stretch.to).expect("a record");
        if !bends.push(stretch.to - t, next.begin[1] - stretch.begin[1]) {
            break;
        }
        stretch = next;
    }
    let (end, _) = collisions.collide(&flow, touch, stretch.to, &bends, &mut Unobserved)?;
    let expected = step_by_step(&system, side, &touch);
    let speed = (touch.y[3] - touch.y[1]).abs();
    let off = |i: usize| (end.y[i] - expected.y[i]).abs() / speed;
    let is_bent = bends.all().iter().any(|[time, _]| *time < expected.t - touch.t);
    Some((off(1).max(off(3)).max((end.t - expected.t).abs() / (expected.t - touch.t)), is_bent))
}

/// Draws a restitution and a λ.
type Drawn = fn(&mut Draw) -> [f64; 2];

/// What contacts lose, by name.
const LOSSES: [(&str, Drawn); 3] = [
    ("none", |_| [1.0, 0.0]),
    ("a restitution", |draw| [[0.4, 0.55, 0.7, 0.85, 0.95][(5.0 * draw.next()) as usize], 0.0]),
    ("λ", |draw| [1.0, 10f64.powf(draw.between(-2.0, 0.0))]),
];

/// Contacts computed at once: how many, how many of them with errors above 1, 3 and 10 times the tolerance, and the greatest over it.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    contacts: usize,
    above: [usize; 3],
    most: f64,
}

/// 3000 of them, or `RETUNE_CONTACTS` (`just lab test-bends`). Of 21,000, 5565 across samples were computed at once: 57 have an error above the
/// tolerance, eight above three times and none above 7.2 times, no larger shares than of those within a piece. With a share of the expansion's tail
/// as the limit, and of the same size for each loss, errors of 20 times the tolerance were seen in 3000.
#[test]
fn reference_contacts_across_samples_agree_with_contacts_step_by_step() {
    let count = std::env::var("RETUNE_CONTACTS").map_or(3000, |count| count.parse().expect("a number")) / 21;
    let mut draw = Draw(7);
    for (loss, numbers_of) in LOSSES {
        for power in 6..=12 {
            let rtol = 10f64.powi(-power);
            let mut seen = [Seen::default(); 2];
            for _ in 0..count {
                let ([e, lambda], ground) = (numbers_of(&mut draw), Ground::drawn(&mut draw));
                let change = |numbers| Numbers { e, lambda, ..numbers };
                let Some((off, is_bent)) = off(&mut draw, ground, rtol, change) else { continue };
                // Below 3e-12 rounding and the steps that they are compared with count.
                let share = off / rtol.max(3e-12);
                let Seen { contacts, above, most } = &mut seen[usize::from(is_bent)];
                *contacts += 1;
                for (above, limit) in above.iter_mut().zip([1.0, 3.0, 10.0]) {
                    *above += usize::from(share > limit);
                }
                *most = most.max(share);
            }
            let [even, bent] = seen;
            println!("loss {loss}, 1e-{power}, of {count}: within a piece {even:?}, across samples {bent:?}");
            let few = if power < 10 { 15 } else { 2 };
            assert!(bent.contacts > few * count / 100, "{loss}, 1e-{power}: {bent:?} of {count}");
            assert!(bent.above[0] <= 3 + bent.contacts / 20, "{loss}, 1e-{power}: {bent:?}");
            assert!(bent.most <= 20.0, "{loss}, 1e-{power}: {bent:?}");
        }
    }
}
