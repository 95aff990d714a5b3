//! The catalogue: every parameter is read where it is set, is refused out of its range, and says where it is absent.

use retune_model::{
    Absent, Amplitude, Damper, Design, Finite, NonNegative, Parameter, PerVariable, Scene, Source, Start,
    Unsettable,
};
use retune_testkit::scenes::{Numbers, SSVI};

/// The scenes of the four forcings with Hertz's surfaces, one of them with a restitution, and one with rigid walls.
fn scenes() -> [Scene; 5] {
    let size = NonNegative::new(0.5).expect("a number");
    let rigid = Numbers { rigid: Some(0.7), ..SSVI }.scene();
    let [a, b, c, d] = Amplitude::ALL.map(|of| {
        let mut scene = SSVI.scene();
        scene.forcing.source = Source::Harmonic(of, size);
        let loss = if of == Amplitude::Base { Parameter::Restitution } else { Parameter::Lambda };
        loss.set(&mut scene, 0.3).expect("in range");
        Parameter::Strength.set(&mut scene, 2e7).expect("in range");
        Parameter::Density.set(&mut scene, 1200.0).expect("in range");
        scene
    });
    [a, b, c, d, rigid]
}

#[test]
fn exact_a_parameter_is_read_where_it_was_set_and_nothing_else_changes() {
    for parameter in Parameter::ALL {
        let mut found = 0;
        for scene in scenes() {
            let Some(own) = parameter.of(&scene) else { continue };
            found += 1;
            let mut moved = scene;
            parameter.set(&mut moved, 0.9 * own).expect("in range");
            for other in Parameter::ALL {
                let expected = if other == parameter { Some(0.9 * own) } else { other.of(&scene) };
                assert_eq!(other.of(&moved), expected, "{other} after {parameter}");
            }
            let back = parameter.at(moved, own).expect("in range");
            assert_eq!(back, scene, "{parameter}");
        }
        let expected = match parameter {
            Parameter::P | Parameter::Restitution => 2,
            Parameter::Lambda => 3,
            Parameter::Imbalance | Parameter::Base | Parameter::BaseAcceleration => 1,
            _ if parameter.is_of_contact() => 4,
            _ => 5,
        };
        assert_eq!(found, expected, "{parameter}");
    }
}

/// The symbol of a parameter is its field in a file.
#[test]
fn exact_parameters_stand_in_files_under_their_symbols() {
    for mut scene in scenes() {
        for (i, parameter) in Parameter::ALL.into_iter().enumerate() {
            if let Some(own) = parameter.of(&scene) {
                parameter.set(&mut scene, own * (1.0 - 0.01 * i as f64)).expect("in range");
            }
        }
        let file = serde_json::to_value(scene).expect("JSON");
        let places = ["/primary", "/forcing", "/damper", "/damper/contact"];
        let laws = ["/damper/contact/loss", "/damper/contact/rigid"];
        let parts: Vec<_> = places.iter().chain(&laws).map(|part| file.pointer(part)).collect();
        let mut count = 0;
        for parameter in Parameter::ALL {
            let field = parameter.symbol();
            let found = parts.iter().flatten().find_map(|part| part.get(field)?.as_f64());
            assert_eq!(found, parameter.of(&scene), "{parameter}");
            count += usize::from(found.is_some());
        }
        let fields = parts.iter().flatten().flat_map(|part| part.as_object()).flatten();
        assert_eq!(
            fields.filter(|(_, value)| value.is_number()).count(),
            count,
            "every number is in the catalogue"
        );
    }
}

#[test]
fn contract_values_out_of_range_are_refused_and_leave_the_scene_as_it_is() {
    for parameter in Parameter::ALL {
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            for mut scene in scenes() {
                let before = scene;
                match parameter.set(&mut scene, bad) {
                    Err(
                        Unsettable::OutOfRange(_)
                        | Unsettable::Absent(
                            Absent::Forcing(_) | Absent::Rigid | Absent::Losses | Absent::Loss(_),
                        ),
                    ) => {}
                    other => panic!("{parameter} = {bad}: {other:?}"),
                }
                assert_eq!(scene, before, "{parameter}");
            }
        }
    }
    // Without a damper the same values are refused.
    for parameter in Parameter::VARIED {
        for value in [-1.0, 0.0, 1.0, f64::NAN, f64::INFINITY] {
            let set = parameter.set(&mut SSVI.scene(), value).is_ok();
            assert_eq!(parameter.check(value).is_ok(), set, "{parameter} = {value}");
        }
    }
}

#[test]
fn contract_a_scene_says_what_it_does_not_have() {
    let mut bare = SSVI.scene();
    bare.damper = None;
    let mut open = SSVI.scene();
    open.damper = open.damper.map(|damper| Damper { contact: None, ..damper });
    let mut free = SSVI.scene();
    free.forcing.source =
        Source::Decay(Start { x1: Finite::new(0.1).expect("a number"), ..Start::default() });
    let absent = |parameter: Parameter, mut scene: Scene| match parameter.set(&mut scene, 0.5) {
        Err(Unsettable::Absent(why)) => Some(why),
        _ => None,
    };
    for parameter in Parameter::ALL {
        let of_walls = (parameter.is_gap() || parameter.is_of_contact()).then_some(Absent::NoWalls);
        let of_damper = parameter.is_of_damper().then_some(Absent::NoDamper);
        let other = Parameter::AMPLITUDES[1..].contains(&parameter).then_some(Absent::Forcing("P"));
        assert_eq!(absent(parameter, bare), of_damper.or(other), "{parameter}");
        assert_eq!(absent(parameter, open), of_walls.or(other), "{parameter}");
        let forced = parameter.is_frequency() || Parameter::AMPLITUDES.contains(&parameter);
        assert_eq!(absent(parameter, free), forced.then_some(Absent::Forcing("start")), "{parameter}");
        let rigid =
            (parameter.is_of_contact() && parameter != Parameter::Restitution).then_some(Absent::Rigid);
        let walls = Numbers { rigid: Some(0.7), ..SSVI }.scene();
        assert_eq!(absent(parameter, walls), rigid.or(other), "{parameter}");
    }
}

#[test]
fn contract_symbols_are_names_and_those_that_vary_come_first() {
    for (i, parameter) in Parameter::ALL.into_iter().enumerate() {
        assert_eq!(parameter.symbol().parse(), Ok(parameter));
        let is_varied = i < Parameter::VARIED.len();
        assert_eq!(Parameter::varied(parameter.symbol()), is_varied.then_some(parameter));
        assert_eq!(parameter.units()[0].1, 1.0, "{parameter}: the SI unit comes first");
    }
    assert_eq!(Parameter::ALL[..Parameter::VARIED.len()], Parameter::VARIED);
    assert!("k3".parse::<Parameter>().is_err_and(|words| words.contains("give one of k2, c2")));
}

#[test]
fn contract_designs_in_files() {
    let text = r#"{"k2":215.0,"c2":232.0,"D":0.06,"C":0.36,"R":1.5}"#;
    let design: Design = serde_json::from_str(text).expect("a design");
    assert_eq!(serde_json::to_string(&design).expect("JSON"), text);
    assert_eq!((design.get(Parameter::R), design.get(Parameter::M2).is_nan()), (1.5, true));
    let on = design.on(SSVI.damper());
    assert_eq!((Parameter::R.get(&on), Parameter::M2.get(&on)), (1.5, SSVI.m2));
    assert_eq!(Design::of_varied(&on, &[Parameter::R]), design);
    for (wrong, said) in [
        (r#"{"k2":1}"#, "missing field `c2`"),
        (r#"{"k2":1,"c2":-1}"#, "c2: -1 is not allowed here"),
        (r#"{"k2":1,"c2":1,"P":1}"#, "unknown field `P`"),
        (r#"{"k2":1,"k2":1}"#, "duplicate field `k2`"),
        ("[1]", "an object with some of k2, c2, D, C, m2, R"),
    ] {
        let error = serde_json::from_str::<Design>(wrong).expect_err(wrong).to_string();
        assert!(error.contains(said), "{wrong}: {error}");
    }
    let some = design.only(&[Parameter::D, Parameter::M2]);
    assert_eq!(some, PerVariable::of(&[Parameter::D], &[0.06]));
}
