//! Strong dashpots: compares long steps, which drop the fast part of the motion once it has decayed, with short steps, which follow all of
//! it.

use super::Hunt;
use crate::scenes::{Numbers, SSVI, Spread};
use rayon::prelude::*;
use retune_model::Coupled;
use retune_solver::observe::{
    DamperEnergy, Magnitude, Observer, PrimaryEnergy, RelativePosition, RunningMaximum, Segment,
    StructureMotion,
};
use retune_solver::{Hybrid, Motion, Settings, Window, simulate};

/// Draws a damper whose relative motion decays at 30 to 10,000 times the frequency of the force. One in four never touches a wall; one in
/// eight is held to a wall half of the time.
fn drawn(number: u64) -> Numbers {
    let mut draw = Spread::new(number + 11);
    let mut within = |low: f64, high: f64| low + (high - low) * draw.unit();
    let mut numbers = Numbers {
        c1: within(0.0, 2000.0),
        k1: within(1e4, 1e5),
        d: within(0.0, 0.05),
        c: within(0.0, 0.2),
        omega: within(3.0, 10.0),
        ..SSVI
    };
    numbers.m2 = draw.logarithmic(1.0, 3000.0);
    let both = numbers.m1 * numbers.m2 / (numbers.m1 + numbers.m2);
    numbers.c2 = both * numbers.omega * draw.logarithmic(30.0, 1e4);
    numbers.k2 = if draw.unit() < 0.1 { 0.0 } else { numbers.c2 * draw.logarithmic(1e-3, 30.0) };
    if draw.unit() < 0.25 {
        (numbers.d, numbers.c) = (1.0, 2.0);
    }
    if number.is_multiple_of(8) {
        numbers.d = 0.0;
    }
    // In one in ten the structure has no damping; in another, so much that two parts of the motion are fast.
    match draw.unit() {
        0.0..0.1 => numbers.c1 = 0.0,
        0.9..1.0 => numbers.c1 = numbers.m1 * draw.logarithmic(10.0, 1e4),
        _ => {}
    }
    numbers
}

/// Time of a run, s.
const TO: f64 = 20.0;

/// Largest values, final state, number of steps.
type Observed = ([f64; 8], [f64; 4], u64);

/// Requires, if true, that contacts are followed in full.
struct FollowsContacts(bool);

impl Observer<4> for FollowsContacts {
    fn segment(&mut self, _segment: &dyn Segment<4>) {}
    fn follows_contacts(&self) -> bool {
        self.0
    }
}

fn observe<'a>(system: &'a Coupled, mut hybrid: Hybrid<'a>, follows: bool) -> Result<Observed, String> {
    let energies = (
        RunningMaximum::new(PrimaryEnergy::new(system), f64::INFINITY),
        RunningMaximum::new(DamperEnergy::new(system), f64::INFINITY),
    );
    let ends =
        [1.0, -1.0].map(|sign| RunningMaximum::new(RelativePosition::new(system, sign), f64::INFINITY));
    let of = |quantity: fn(&'a Coupled, f64) -> StructureMotion<'a, Coupled, 4>| {
        Magnitude::new(|sign| quantity(system, sign), f64::INFINITY)
    };
    let structure = [
        of(StructureMotion::displacement),
        of(StructureMotion::velocity),
        of(StructureMotion::acceleration),
        of(StructureMotion::ground_force),
    ];
    let mut all = ((energies, FollowsContacts(follows)), (ends, structure));
    let end = hybrid.propagate(Motion::start(system), TO, &mut all).map_err(|error| error.to_string())?;
    let (((e1, e2), _), ([far, near], structure)) = &all;
    let [x1, v1, a1, ground] = structure.each_ref().map(|one| one.record().value);
    let [e1, e2] = [e1.record().value, e2.record().value];
    Ok(([e1, e2, far.record().value, near.record().value, x1, v1, a1, ground], end.y, hybrid.work.steps))
}

/// Largest difference allowed between long and short steps, relative.
const TOLERANCE: f64 = 1e-9;

/// Compares long and short steps on `count` scenes of 20 s.
pub fn dashpots(count: u64) -> Hunt {
    let compared: Vec<_> = (0..count)
        .into_par_iter()
        .map(|number| {
            let numbers = drawn(number);
            let scene = numbers.scene();
            let damper = scene.damper.as_ref().expect("a damper");
            let system = Coupled::new(&scene.primary, &scene.forcing, damper);
            let hybrid = || Hybrid::new(&system, 1e-10, TO, 200_000_000);
            let long = observe(&system, hybrid(), false);
            // A damper held to a wall moves so little that the rounding errors of short flight steps add up to more than the tolerance, so
            // only contacts use short steps.
            let held = numbers.d == 0.0;
            let short = observe(&system, if held { hybrid() } else { hybrid().in_short_steps() }, held);
            let (Ok(long), Ok(short)) = (&long, &short) else {
                let same = long.is_err() == short.is_err();
                return (number, None, (!same).then(|| format!("{number}: {long:?} {short:?}")));
            };
            let reach = short.0[2].abs().max(short.0[3].abs());
            let apart = |i: usize| {
                let size = if i == 2 || i == 3 { reach } else { short.0[i].abs() };
                (long.0[i] - short.0[i]).abs() / size
            };
            let each: [f64; 8] = std::array::from_fn(apart);
            // Each short step computes a1 from a difference of speeds, so the largest of many values includes the largest rounding error.
            let rounding = 16.0 * f64::EPSILON * numbers.c2 / numbers.m1 * short.0[5] / short.0[6];
            let mut worst = each.into_iter().fold(0.0, f64::max);
            if worst == each[6] && worst < rounding {
                worst = 0.0;
            }
            if numbers.d == 1.0 {
                let mut free = scene;
                free.damper.iter_mut().for_each(|damper| damper.contact = None);
                let found =
                    simulate(&free, Window { from: 0.0, to: TO }, &Settings::default()).expect("a run");
                worst = worst.max((found.e1_max.value - short.0[0]).abs() / short.0[0]);
            }
            let parted = (0..4).any(|i| (long.1[i] - short.1[i]).abs() > TOLERANCE);
            let fault = (worst.is_nan() || worst > TOLERANCE) && !parted;
            let steps = (!parted).then_some([long.2, short.2]);
            (number, steps, fault.then(|| format!("{number}: {worst:e} {each:?} {numbers:?}")))
        })
        .collect();
    let mut hunt = Hunt::default();
    let alike: Vec<[u64; 2]> = compared.iter().filter_map(|(_, steps, _)| *steps).collect();
    let total = |way: usize| alike.iter().map(|steps| steps[way]).sum::<u64>();
    hunt.faults = compared.into_iter().filter_map(|(_, _, fault)| fault).collect();
    hunt.row(format!(
        "| long steps beside short ones, the motion predictable | {} of {count} | {} | {} | 1e-9 | {} |",
        alike.len(),
        total(0),
        total(1),
        hunt.faults.len()
    ));
    hunt.check(alike.len() as u64 > count / 2, || {
        format!("{} of {count} scenes can be predicted", alike.len())
    });
    hunt.check(total(0) < total(1) / 10, || "long steps save nothing".into());
    hunt
}
