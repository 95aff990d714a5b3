//! Observers that are composed see the same run as each of them alone.

use retune_model::Coupled;
use retune_solver::observe::{
    DamperEnergy, Observer, PrimaryEnergy, RunningMaximum, Segment, TouchDownTimes, TouchDowns, Unobserved,
};
use retune_solver::{Follower, Hybrid, Method, Motion, Phase, Settings};
use retune_testkit::scenes::SSVI;

/// Follows the SSVI from rest for 20 s, or until the observer is satisfied.
fn follow(system: &Coupled, observer: &mut dyn Observer<4>) -> Motion {
    let rest = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
    Hybrid::new(system, 1e-8, 20.0, 1_000_000).propagate(rest, 20.0, observer).expect("a run")
}

#[test]
fn invariant_composed_observers_see_what_each_sees_alone() {
    let system = SSVI.coupled();
    let e1 = || RunningMaximum::new(PrimaryEnergy::new(&system), f64::INFINITY);
    let e2 = || RunningMaximum::new(DamperEnergy::new(&system), f64::INFINITY);
    let (mut e1_alone, mut e2_alone) = (e1(), e2());
    let (mut counts_alone, mut times_alone) = (TouchDowns::default(), TouchDownTimes::default());
    let end = follow(&system, &mut Unobserved);
    for found in [
        follow(&system, &mut e1_alone),
        follow(&system, &mut e2_alone),
        follow(&system, &mut counts_alone),
        follow(&system, &mut times_alone),
    ] {
        assert_eq!((found.t, found.y), (end.t, end.y));
    }
    let mut all = (
        (e1(), [e2(), e2()]),
        (Some(TouchDowns::default()), (TouchDownTimes::default(), None::<TouchDowns>)),
    );
    follow(&system, &mut all);
    let ((e1, both), (counts, (times, _))) = all;
    assert_eq!(e1.record(), e1_alone.record());
    assert_eq!(both.map(|e2| e2.record()), [e2_alone.record(); 2]);
    assert_eq!((counts, &times), (Some(counts_alone), &times_alone));
    assert!(times.0.len() > 10 && counts_alone.0.iter().sum::<u64>() == times.0.len() as u64);
}

#[test]
fn invariant_a_run_stops_as_soon_as_one_of_its_observers_is_satisfied() {
    let system = SSVI.coupled();
    let e1 = |cutoff: f64| RunningMaximum::new(PrimaryEnergy::new(&system), cutoff);
    let mut whole = e1(f64::INFINITY);
    follow(&system, &mut whole);
    let cutoff = 0.5 * whole.record().value;
    let alone = follow(&system, &mut e1(cutoff)).t;
    assert!(alone < 20.0, "{alone}");
    assert_eq!(follow(&system, &mut (TouchDowns::default(), e1(cutoff))).t, alone);
    assert_eq!(follow(&system, &mut (e1(cutoff), e1(f64::INFINITY))).t, alone);
    assert_eq!(follow(&system, &mut [e1(f64::INFINITY), e1(cutoff)]).t, alone);
    assert_eq!(follow(&system, &mut Some(e1(cutoff))).t, alone);
}

/// Ends a run after some segments.
struct Enough(u32);

impl Observer<4> for Enough {
    fn segment(&mut self, _segment: &dyn Segment<4>) {
        self.0 = self.0.saturating_sub(1);
    }
    fn satisfied(&self) -> bool {
        self.0 == 0
    }
}

#[test]
fn regress_a_run_that_an_observer_ends_returns_the_time_it_reached() {
    let system = SSVI.coupled();
    for method in [Method::Dop853, Method::Hybrid] {
        let settings = Settings { method, ..Settings::default() };
        let rest = Motion { t: 0.0, y: system.rest(), phase: Phase::Flight };
        let mut follower = Follower::new(&system, &settings, 4.0);
        let middle = follower.propagate(rest, 4.0, &mut Enough(5)).expect("a run");
        assert!(middle.t > 0.0 && middle.t < 4.0, "{method:?}: {}", middle.t);
        // Continued from there the motion is that of an unbroken run.
        let [whole, parts] =
            [rest, middle].map(|from| follower.propagate(from, 4.0, &mut Unobserved).expect("a run"));
        for (a, b) in whole.y.into_iter().zip(parts.y) {
            assert!((a - b).abs() < 1e-6, "{method:?}: {:?} {:?}", whole.y, parts.y);
        }
    }
}
