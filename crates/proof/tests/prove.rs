//! What is proven of motions of the paper's dampers, and what is not.

use nalgebra::Matrix4;
use retune_model::{Amplitude, Bare, Coupled, Forcing, NonNegative, Parameter, Scene, Side, Source, Steady};
use retune_proof::{Event, Failure, Interval, Stability, Start, prove, prove_over, prove_steady};
use std::f64::consts::TAU;

const STRUCTURE: &str =
    r#""primary": { "m1": 1000, "c1": 452, "k1": 39500 }, "forcing": { "P": 800, "omega": 6.28 }"#;
const SURFACES: &str = r#"{ "R": 2, "q": 0.318, "E1": 2.1e11, "nu1": 0.3, "E2": 2.21e7, "nu2": 0.4,
    "E3": 2.1e11, "nu3": 0.3, "E4": 2.05e7, "nu4": 0.4 }"#;

fn scene(damper: &str, omega: f64) -> Scene {
    let scene = serde_json::from_str(&format!("{{ {STRUCTURE}, \"damper\": {damper} }}")).expect("a scene");
    Parameter::Omega.at(scene, omega).expect("a frequency")
}

/// The tuned SSVI NES of `results/ssvi`.
fn tuned(omega: f64) -> Scene {
    let damper = format!(
        r#"{{ "m2": 60, "k2": 583.9214076890732, "c2": 94.97051688885965, "D": 0.02884977844071534,
            "C": 1.1045445737539366, "contact": {SURFACES} }}"#
    );
    scene(&damper, omega)
}

/// That of `results/branches/isola`, whose damper strikes both walls in some motions.
fn with_isola(omega: f64) -> Scene {
    let damper = format!(
        r#"{{ "m2": 60, "k2": 597.2737982898645, "c2": 95.72415913882642, "D": 0.6072128825900359,
            "C": 0.03740508433492577, "contact": {SURFACES} }}"#
    );
    scene(&damper, omega)
}

fn tmd(omega: f64) -> Scene {
    scene(r#"{ "m2": 60, "k2": 2000, "c2": 85 }"#, omega)
}

/// About the worst frequency: `results/branches/tuned`, branch 0, place 128.
const WORST: (f64, [f64; 4]) =
    (6.624128731514711, [-0.02820555307031281, 0.6083072322136185, 0.1833641390932657, -1.121482573779919]);

/// Branch 0, place 160, beyond the period doubling at 7.5067 rad/s.
const UNSTABLE: (f64, [f64; 4]) = (
    7.531425492418166,
    [-0.04618206941599734, 0.12210602044391623, 0.11191069155584588, -0.23375919700486558],
);
/// `results/branches/isola`, branch 4, place 18.
const BOTH_WALLS: (f64, [f64; 4]) =
    (6.025174847652773, [-0.01742425621462693, 0.7113522489291041, 0.024470135969196602, 1.5288347514858798]);

/// Whether an interval is as narrow as the share `narrow` of a value and holds it, up to the share `off`.
fn is_about(interval: Interval, value: f64, [narrow, off]: [f64; 2]) -> bool {
    interval.width() <= narrow * value && interval.wider(off * value).contains(value)
}

/// Off by the rounding of a closed form; by what the solver's contacts may be.
const CLOSED: [f64; 2] = [1e-10, 3e-15];
const SOLVER: [f64; 2] = [1e-10, 1e-10];

/// A force, an imbalance, and bases of given displacement and acceleration.
fn sources() -> [Source; 4] {
    let size = |size: f64| NonNegative::new(size).expect("an amplitude");
    [
        Source::Harmonic(Amplitude::Force, size(30.5)),
        Source::Harmonic(Amplitude::Imbalance, size(30.5)),
        Source::Harmonic(Amplitude::Base, size(0.02)),
        Source::Harmonic(Amplitude::BaseAcceleration, size(0.7)),
    ]
}

fn steady(scene: &Scene, omega: f64) -> Steady {
    Coupled::new(&scene.primary, &scene.forcing, &scene.damper.expect("a damper")).steady(omega)
}

#[test]
fn exact_the_closed_form_of_a_tmd_is_in_the_proven_intervals() {
    for omega in [2.5, 5.0, 5.9, 6.3, 7.3] {
        for source in sources() {
            let mut scene = tmd(omega);
            scene.forcing = Forcing { source, ..scene.forcing };
            let steady = steady(&scene, omega);
            let proven = prove(&scene, [0.0; 4], 1).expect("a proof");
            assert!(proven.impacts.is_empty() && proven.width < 1e-11, "{proven:?}");
            let Stability::Stable(_) = proven.stability else { panic!("{proven:?}") };
            assert!(is_about(proven.largest.energy, steady.e1_max, CLOSED), "{proven:?} {steady:?}");
            assert!(is_about(proven.largest.stroke, steady.stroke(), CLOSED), "{proven:?} {steady:?}");
            assert_eq!(proven.largest.contact_force.hi(), 0.0);
        }
    }
}

fn undamped(mut scene: Scene) -> Scene {
    let zero = NonNegative::new(0.0).expect("zero");
    scene.primary.damping = zero;
    scene.damper = scene.damper.map(|damper| retune_model::Damper { damping: zero, ..damper });
    scene
}

#[test]
fn exact_the_closed_form_of_a_structure_alone_is_in_the_proven_intervals() {
    for source in sources() {
        let mut scene = Scene { damper: None, ..tmd(6.1) };
        scene.forcing = Forcing { source, ..scene.forcing };
        let own = Bare::new(&scene.primary, &scene.forcing).steady(6.1);
        let proven = prove(&scene, [0.0; 4], 1).expect("a proof");
        assert!(is_about(proven.largest.energy, own.e1_max, CLOSED), "{proven:?} {own:?}");
        assert!(proven.events[0].state[0].wider(1e-15).contains(own.x1.re), "{proven:?} {own:?}");
        assert_eq!((proven.largest.stroke, proven.alone_within), (Interval::ZERO, None));
    }
}

/// Without dashpots motions at the natural frequencies go on for ever.
#[test]
fn contract_what_is_not_damped_is_not_called_stable() {
    let proven = prove(&undamped(tmd(6.3)), [0.0; 4], 1).expect("a proof");
    assert!(matches!(proven.stability, Stability::Open(_)) && proven.alone_within.is_some(), "{proven:?}");
    let refused = prove_steady(&undamped(tmd(6.3)), [6.3, 6.4]).expect_err("no rest");
    assert_eq!(refused, Failure::Undamped);
}

/// The closed form over a piece holds that at its ends and in between; the piece is short enough for bounds that hold little more.
#[test]
fn exact_the_closed_form_of_a_tmd_is_in_the_pieces_in_closed_form() {
    for source in sources() {
        for from in [5.0, 5.9, 6.3, 7.3] {
            let mut scene = tmd(5.0);
            scene.forcing = Forcing { source, ..scene.forcing };
            let own = prove_steady(&scene, [from, from + 1e-3]).expect("a proof");
            for omega in [from, from + 3e-4, from + 1e-3] {
                let steady = steady(&scene, omega);
                assert!(is_about(own.largest.energy, steady.e1_max, [0.02, 3e-15]), "{steady:?} {own:?}");
                assert!(is_about(own.largest.stroke, steady.stroke(), [0.02, 3e-15]), "{steady:?} {own:?}");
            }
        }
    }
}

/// The eigenvalues of `[[0, 1], [-M⁻¹K, -M⁻¹C]]` in doubles. What rounds them is far below the share by which the bound may be larger.
#[test]
fn exact_the_bound_on_the_multipliers_of_a_steady_motion_is_next_to_the_largest() {
    let [m1, c1, k1] = [1000.0, 452.0, 39500.0];
    for (m2, c2, k2) in [(60.0, 85.0, 2000.0), (60.0, 259.8, 600.0), (1.0, 0.5, 40.0), (60.0, 5000.0, 600.0)]
    {
        let scene = scene(&format!(r#"{{ "m2": {m2}, "k2": {k2}, "c2": {c2} }}"#), 6.1);
        let rows = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-(k1 + k2) / m1, k2 / m1, -(c1 + c2) / m1, c2 / m1],
            [k2 / m2, -k2 / m2, c2 / m2, -c2 / m2],
        ];
        let motion = Matrix4::from_fn(|i, j| rows[i][j]);
        let slowest =
            motion.complex_eigenvalues().iter().fold(f64::NEG_INFINITY, |most, x| f64::max(most, x.re));
        assert_bound(&scene, (slowest * TAU / 6.1).exp());
    }
    // Alone it comes to rest with c1/2 m1.
    assert_bound(&Scene { damper: None, ..tmd(6.1) }, (-c1 / (2.0 * m1) * TAU / 6.1).exp());
}

fn assert_bound(scene: &Scene, largest: f64) {
    let Stability::Stable(bound) = prove(scene, [0.0; 4], 1).expect("a proof").stability else { panic!() };
    assert!(bound > (1.0 - 1e-12) * largest && bound < (1.0 + 1e-7) * largest, "{bound} {largest}");
    // Over a piece that of its highest frequency, whose period is the shortest.
    let piece = prove_steady(scene, [6.0, 6.1]).expect("a proof");
    let Stability::Stable(over) = piece.stability else { panic!() };
    assert!(over > (1.0 - 1e-12) * bound && over < 1.01 * bound, "{over} {bound}");
}

/// Walls that the damper touches at some frequency of a piece, or at none.
#[test]
fn contract_a_piece_in_closed_form_touches_no_wall() {
    let stroke = steady(&tmd(6.3), 6.3).stroke();
    let walled = |d: f64, c: f64| {
        let damper =
            format!(r#"{{ "m2": 60, "k2": 2000, "c2": 85, "D": {d}, "C": {c}, "contact": {SURFACES} }}"#);
        prove_steady(&scene(&damper, 6.3), [6.3, 6.301]).map(|theorem| theorem.impacts)
    };
    let (near, far) = (0.9 * stroke, 1.1 * stroke);
    assert_eq!(walled(far, far), Ok(String::new()));
    for (touched, side) in [(walled(near, far), Side::Primary), (walled(far, near), Side::Obstacle)] {
        // The stroke changes by so much over the piece.
        let Err(Failure::Graze(event, width)) = touched else { panic!("{touched:?}") };
        assert!(event == Event::Touch(side) && (1e-5..1e-2).contains(&(width / stroke)), "{event:?} {width}");
    }
}

#[test]
fn reference_the_tuned_dampers_motion_at_its_worst_frequency_is_proven() {
    let proven = prove(&tuned(WORST.0), WORST.1, 1).expect("a proof");
    assert_eq!(proven.impacts, "S");
    assert!(proven.width < 1e-10 && proven.alone_within > Some(100.0 * proven.width), "{proven:?}");
    // The solver's multiplier, energy, stroke and contact force, from the same line.
    let Stability::Stable(bound) = proven.stability else { panic!("{proven:?}") };
    assert!((0.6602065..0.6603).contains(&bound), "{bound}");
    assert!(is_about(proven.largest.energy, 225.7923331035133, SOLVER), "{proven:?}");
    assert!(is_about(proven.largest.stroke, 0.5111341429141772, SOLVER), "{proven:?}");
    assert!(is_about(proven.largest.contact_force, 23964.417596389438, SOLVER), "{proven:?}");
    assert!(proven.largest.energy.hi() < 225.82);
}

#[test]
fn reference_unstable_motions_are_proven_and_not_called_stable() {
    for (scene, start, periods, impacts) in
        [(tuned(UNSTABLE.0), UNSTABLE.1, 1, "S"), (with_isola(BOTH_WALLS.0), BOTH_WALLS.1, 2, "OOS")]
    {
        let proven = prove(&scene, start, periods).expect("a proof");
        let Stability::Unstable(largest) = proven.stability else { panic!("{proven:?}") };
        assert!(largest.re.hypot(largest.im) > 1.0 && largest.derivatives < 1e-3, "{largest}");
        assert_eq!(proven.impacts, impacts);
    }
}

/// What does not come back is refused. From a guess that is only poor, Newton's iteration finds a motion, and what is proven is proven of that.
#[test]
fn contract_a_wrong_guess_is_refused() {
    let (omega, start) = WORST;
    let own = prove(&tuned(omega), start, 1).expect("a proof");
    let mut refused = 0;
    for by in [1.5, 0.5, 0.1, 0.0, -1.0] {
        match prove(&tuned(omega), start.map(|x| by * x), 1) {
            Ok(poor) => assert!(own.largest.energy.meet(poor.largest.energy).is_some(), "{own:?} {poor:?}"),
            Err(Failure::Guess(_, gap)) => refused += usize::from(gap > 1e-3),
            Err(_) => refused += 1,
        }
    }
    assert!((2..5).contains(&refused), "{refused}");
}

/// Walls as far from the damper's place of rest as it swings, and a little nearer and farther.
#[test]
fn contract_a_graze_cannot_be_proven() {
    let omega = 6.3;
    let free = tmd(omega);
    let system = Coupled::new(&free.primary, &free.forcing, &free.damper.expect("a damper"));
    let stroke = system.steady(omega).stroke();
    let walled = |d: f64| {
        scene(
            &format!(r#"{{ "m2": 60, "k2": 2000, "c2": 85, "D": {d}, "C": 1, "contact": {SURFACES} }}"#),
            omega,
        )
    };
    for near in [0.0, 1e-15, -1e-15] {
        match prove(&walled(stroke + near), [0.0, 0.0, stroke, 0.0], 1) {
            Err(Failure::Graze(event, width)) => {
                assert!(event == Event::Touch(Side::Primary) && (1e-16..1e-12).contains(&width), "{width:e}");
            }
            other => panic!("{other:?}"),
        }
    }
    let proven = prove(&walled(stroke + 1e-9), [0.0, 0.0, stroke, 0.0], 1).expect("a gap of a nanometre");
    assert!(proven.impacts.is_empty());
    assert!(is_about(proven.largest.stroke, stroke, CLOSED));
}

#[test]
fn contract_scenes_beyond_the_proof_are_refused() {
    let with = |contact: &str| {
        scene(
            &format!(r#"{{ "m2": 60, "k2": 2000, "c2": 85, "D": 0.1, "C": 1, "contact": {contact} }}"#),
            6.0,
        )
    };
    let lossy = SURFACES.replace('}', r#", "loss": { "restitution": 0.1 } }"#);
    for (scene, said) in [
        (undamped(Scene { damper: None, ..tmd(6.0) }), "a structure without damper, and without spring"),
        (tmd(0.0), "a forcing whose omega is not above 0"),
        (with(r#"{ "rigid": { "restitution": 0.7 } }"#), "rigid walls"),
        (with(&lossy), "a restitution below 0.2"),
        (with(&lossy.replace("loss", "loss_obstacle")), "a restitution below 0.2"),
    ] {
        let error = prove(&scene, [0.0; 4], 1).expect_err(said).to_string();
        assert!(error.starts_with(said), "{error}");
    }
}

/// Newton's iteration ends on this motion of eight periods, whose largest multiplier is 0.998, but Krawczyk's operator maps no box into itself.
#[test]
fn contract_a_box_that_is_not_mapped_into_itself_proves_nothing() {
    // `results/branches/isola`, branch 3, place 62.
    let start = [-0.038065392671756404, 0.10383126534211681, 0.598070957397342, 0.167707584961897];
    match prove(&with_isola(7.710298498129456), start, 8) {
        Err(Failure::Krawczyk(width, image)) => assert!(image > 0.5 * width, "{image:e} {width:e}"),
        other => panic!("{other:?}"),
    }
}

/// One proof holds for all frequencies of a piece: those of its ends and of one in between are in its bounds. The next piece is found beside it.
#[test]
fn invariant_a_piece_of_a_band_holds_the_motions_at_its_frequencies() {
    let first = prove_over(&tuned(6.6), [6.62, 6.63], Start::From((WORST.1, 1))).expect("a piece");
    let next = prove_over(&tuned(6.6), [6.63, 6.64], Start::Beside(&first.1)).expect("a piece");
    for ([from, to], piece) in [([6.62, 6.63], first.0), ([6.63, 6.64], next.0)] {
        let Stability::Stable(multipliers) = piece.stability else { panic!("{piece:?}") };
        for omega in [from, from + 0.3 * (to - from), to] {
            let own = prove(&tuned(omega), WORST.1, 1).expect("a proof");
            let Stability::Stable(bound) = own.stability else { panic!("{own:?}") };
            assert_eq!((own.impacts.as_str(), piece.impacts.as_str()), ("S", "S"));
            // Neither is the largest multiplier, but both are next to it.
            assert!(multipliers < 1.0 && bound < 1.01 * multipliers, "{bound} {multipliers}");
            for ((_, own), (_, all)) in own.largest.all().into_iter().zip(piece.largest.all()) {
                assert!(own.is_in(all), "{omega}: {own:?} {all:?}");
            }
        }
    }
    let unstable = prove_over(&tuned(7.5), [7.531, 7.532], Start::From((UNSTABLE.1, 1)));
    // Beyond a period doubling.
    let Err(Failure::NotStable(largest)) = unstable.map(|(theorem, _)| theorem) else { panic!("proven") };
    assert!((-2.0..-1.0).contains(&largest.re) && largest.im == 0.0, "{largest}");
}

/// What acts changes with the frequency along a piece: of an imbalance and of a base, in three ways.
#[test]
fn exact_the_closed_form_of_a_tmd_is_in_the_pieces_of_a_band() {
    for source in sources() {
        let mut scene = tmd(5.0);
        scene.forcing = Forcing { source, ..scene.forcing };
        let (piece, _) = prove_over(&scene, [7.0, 7.01], Start::From(([0.0; 4], 1))).expect("a piece");
        for omega in [7.0, 7.007, 7.01] {
            let own = steady(&scene, omega);
            assert!(is_about(piece.largest.energy, own.e1_max, [0.1, 3e-15]), "{omega} {own:?} {piece:?}");
            assert!(is_about(piece.largest.stroke, own.stroke(), [0.1, 3e-15]), "{omega} {own:?} {piece:?}");
        }
    }
}

/// λ and the same restitution at every speed; the values are the solver's, `results/ssvi-loss` and `results/ssvi-hedged` with e = 0.6.
#[test]
fn reference_motions_with_contacts_that_lose_energy_are_proven() {
    for (damper, loss, omega, start, energy) in [
        (
            r#""k2": 599.9993632927062, "c2": 42.46445493609147, "D": 0.01647227038173732, "C": 1.318957352940895"#,
            r#""lambda": 0.45344877233315495"#,
            5.796091001829637,
            [0.043473079661900074, 0.5083217953157486, 0.22277047998944727, 1.4547529850362335],
            223.2231351510352,
        ),
        (
            r#""k2": 553.3182521950557, "c2": 63.361302607068225, "D": 0, "C": 1.9124291840546004"#,
            r#""restitution": 0.6"#,
            6.403445578561367,
            [-0.009303539415377619, 0.6961363183467432, 0.07813583075554904, -1.2821736616249684],
            255.73788476638006,
        ),
    ] {
        let contact = SURFACES.replace('}', &format!(r#", "loss": {{ {loss} }} }}"#));
        let lossy = scene(&format!(r#"{{ "m2": 60, {damper}, "contact": {contact} }}"#), omega);
        let proven = prove(&lossy, start, 1).expect("a proof");
        assert_eq!(proven.impacts, "S");
        assert!(matches!(proven.stability, Stability::Stable(_)), "{proven:?}");
        assert!(is_about(proven.largest.energy, energy, SOLVER), "{proven:?}");
    }
}

/// With so much loss the force ends before the contact does.
#[test]
fn contract_a_force_that_may_end_is_named() {
    let contact = SURFACES.replace('}', r#", "loss": { "lambda": 50 } }"#);
    let damper = format!(
        r#"{{ "m2": 60, "k2": 599.9993632927062, "c2": 42.46445493609147, "D": 0.0164722703817373,
            "C": 1.318957352940895, "contact": {contact} }}"#
    );
    let start = [0.0434, 0.508, 0.2227, 1.4547];
    let refused = prove(&scene(&damper, 5.796), start, 1);
    assert!(matches!(refused, Err(Failure::Graze(Event::Pull, _))), "{refused:?}");
}
