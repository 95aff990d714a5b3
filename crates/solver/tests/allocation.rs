//! Nothing is allocated in a run. In a file of its own: the counting allocator is the whole program's.

use retune_solver::{Method, Settings, Window, e1_max, simulate};
use retune_testkit::scenes::{SSVI, TMD, TWO_SIDED};
use std::hint::black_box;

#[test]
fn invariant_runs_allocate_nothing() {
    let window = Window { from: 0.0, to: 20.0 };
    let count = |f: &dyn Fn()| allocation_counter::measure(f).count_total;
    assert_eq!(count(&|| drop(black_box(Box::new(1)))), 1, "the counter counts");
    // The first contact to a tolerance computes the rule of all such contacts.
    for rtol in [1e-6, 1e-8, 1e-10] {
        e1_max(&SSVI.scene(), window, &Settings { rtol, ..Settings::default() }, f64::INFINITY)
            .expect("a run");
    }
    for scene in [SSVI.scene(), TMD.scene(), TWO_SIDED.scene(), SSVI.bare_scene()] {
        for method in [Method::Hybrid, Method::Ode45, Method::Ode23s] {
            let settings = Settings { method, rtol: 1e-6, atol: 1e-8, ..Settings::default() };
            let found = count(&|| {
                black_box(e1_max(&scene, window, &settings, f64::INFINITY).expect("a run"));
                black_box(simulate(&scene, window, &settings).expect("a run"));
            });
            assert_eq!(found, 0, "{method:?}");
        }
    }
}
