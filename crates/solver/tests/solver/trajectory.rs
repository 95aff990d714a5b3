//! A recorded motion has the moments between its equidistant rows.

use retune_solver::{
    Contacts, Method, Moment, Rows, Sample, Settings, Window, simulate, touch_downs, trajectory,
};
use retune_testkit::scenes::{SSVI, TMD};

const WINDOW: Window = Window { from: 50.0, to: 100.0 };

fn recorded(settings: &Settings, rows: Rows) -> Vec<Sample> {
    let mut samples = Vec::new();
    trajectory(&SSVI.scene(), WINDOW, settings, rows, &mut |sample| samples.push(*sample)).expect("a run");
    samples
}

/// A contact lasts some 13 ms: rows 0.05 s apart miss all but a few of them.
#[test]
fn contract_a_trajectory_has_every_contact_and_its_peaks() {
    for method in [Method::Hybrid, Method::Dop853] {
        let settings = Settings { method, ..Settings::default() };
        let window = Window { from: 2.0, to: 12.0 };
        let mut samples: Vec<Sample> = Vec::new();
        let rows = Rows { interval: 0.05, events: true };
        trajectory(&SSVI.scene(), window, &settings, rows, &mut |s| samples.push(*s)).expect("a run");
        let found = simulate(&SSVI.scene(), window, &settings).expect("a run");
        let of = |moment: Moment| samples.iter().filter(move |sample| sample.moment == moment);
        let near = |value: f64, expected: f64| (value - expected).abs() <= 1e-9 * expected;
        for side in [0, 1] {
            let force = of(Moment::ForceMax).map(|sample| sample.forces[side]).fold(0.0, f64::max);
            assert!(near(force, found.force_max[side]), "{method:?}: {force} {:?}", found.force_max);
            let grid = of(Moment::Grid).map(|sample| sample.forces[side]).fold(0.0, f64::max);
            assert!(found.force_max[side] == 0.0 || grid < 0.99 * force, "{method:?}: the grid has it, too");
        }
        let energy = of(Moment::EnergyMax).map(|sample| sample.e1).fold(0.0, f64::max);
        assert!(near(energy, found.e1_max.value), "{method:?}: {energy} {:?}", found.e1_max);
        let times: Vec<f64> =
            touch_downs(&SSVI.scene(), window, &settings).expect("a run").iter().map(|t| t.0).collect();
        assert!(!times.is_empty());
        let touches: Vec<f64> = of(Moment::TouchDown).map(|sample| sample.t).collect();
        assert_eq!(touches, times, "{method:?}");
        // Each contact: touch-down, one maximum or more, lift-off; none of it without the others.
        let contacts: Vec<Moment> = samples
            .iter()
            .map(|sample| sample.moment)
            .filter(|moment| !matches!(moment, Moment::Grid | Moment::EnergyMax))
            .collect();
        let mut phases = contacts.split_inclusive(|moment| *moment == Moment::LiftOff).peekable();
        while let Some(phase) = phases.next() {
            assert_eq!(phase[0], Moment::TouchDown, "{method:?} {phase:?}");
            assert!(phase[1..phase.len() - 1].iter().all(|moment| *moment == Moment::ForceMax), "{phase:?}");
            assert!(phases.peek().is_none() || phase.len() >= 3, "{method:?} {phase:?}");
        }
        assert!(samples.is_sorted_by(|a, b| a.t <= b.t), "{method:?}");
    }
}

#[test]
fn contract_the_grid_is_the_same_with_and_without_other_moments() {
    let settings = Settings::default();
    let all = recorded(&settings, Rows { interval: 0.01, events: true });
    let grid: Vec<Sample> = all.into_iter().filter(|sample| sample.moment == Moment::Grid).collect();
    assert_eq!(grid, recorded(&settings, Rows::every(0.01)));
    assert_eq!(grid.len(), 5001);
}

/// Steps over the kink of the force: what is told is told in order, and no force peak is far off.
#[test]
fn contract_stepped_contacts_are_told_in_order() {
    let settings =
        Settings { method: Method::Ode45, contacts: Contacts::Stepped, rtol: 1e-7, ..Settings::default() };
    let all = recorded(&settings, Rows { interval: 0.01, events: true });
    let count = |moment: Moment| all.iter().filter(|sample| sample.moment == moment).count();
    assert!(count(Moment::TouchDown) > 50 && count(Moment::TouchDown).abs_diff(count(Moment::LiftOff)) <= 1);
    let force = all.iter().map(|sample| sample.forces[0].max(sample.forces[1])).fold(0.0, f64::max);
    let found = simulate(&SSVI.scene(), WINDOW, &settings).expect("a run");
    assert!((force / found.force_max[0].max(found.force_max[1]) - 1.0).abs() < 1e-6, "{force} {found:?}");
}

/// Without contacts there are maxima of E1, two a period of the force.
#[test]
fn contract_a_linear_motion_has_two_maxima_a_period() {
    for scene in [TMD.scene(), TMD.bare_scene()] {
        let mut samples: Vec<Sample> = Vec::new();
        let rows = Rows { interval: 1.0, events: true };
        trajectory(&scene, WINDOW, &Settings::default(), rows, &mut |s| samples.push(*s)).expect("a run");
        let maxima = samples.iter().filter(|sample| sample.moment == Moment::EnergyMax).count();
        assert!((99..=101).contains(&maxima), "{maxima}");
        assert_eq!(samples.len(), 51 + maxima);
    }
}
