//! The paper's two dampers by time stepping; the digits are those of three independent programs.

use crate::problems::assert_close;
use retune_solver::{SceneKind, Settings, Window, simulate};
use retune_testkit::scenes::{ROW1, ROW3, SSVI, TMD};

#[test]
fn paper_energies_of_the_structure() {
    for (what, scene, [from, to], expected, digits) in [
        ("bare, steady", SSVI.bare_scene(), [150.0, 160.0], 1568.0, 5e-2),
        ("TMD, steady", TMD.scene(), [90.0, 100.0], 635.1068, 1e-4),
        ("TMD, whole run", TMD.scene(), [0.0, 100.0], 635.1147, 1e-4),
        ("Table 1, row 1, whole run", ROW1.scene(), [0.0, 13.0], 760.98507, 1e-5),
        ("Table 1, row 3, whole run", ROW3.scene(), [0.0, 100.0], 554.53804, 1e-5),
    ] {
        let found = simulate(&scene, Window { from, to }, &Settings::default()).expect("a run");
        assert_close(found.e1_max.value, expected, 1.0, digits, what);
    }
}

/// Table 2's vibro-impact damper impacts all the time; its TMD never does.
#[test]
fn paper_kinds_of_damper() {
    let run =
        |scene| simulate(&scene, Window { from: 50.0, to: 100.0 }, &Settings::default()).expect("a run");
    let ssvi = run(SSVI.scene());
    assert!(ssvi.scene == SceneKind::Contact && ssvi.impacts[0] >= 25, "{:?}", ssvi.impacts);
    assert_eq!(run(TMD.scene()).scene, SceneKind::Linear);
}
