//! Samples and their transforms.

use super::*;

#[test]
fn exact_a_record_is_linear_between_its_samples_and_nothing_outside() {
    for times in [vec![0.5, 0.75, 1.0, 1.25], vec![0.5, 0.8, 1.0, 1.25]] {
        let samples = Samples::at(times.clone(), vec![1.0, -2.0, 4.0, 3.0]).expect("a record");
        let is_even = matches!(samples.table.times, Times::Every(..));
        assert_eq!(is_even, times[1] == 0.75);
        assert_eq!(samples.stretch(0.2), Stretch { from: 0.0, to: 0.5, begin: [0.0; 2] });
        assert_eq!(samples.stretch(1.25).begin, [0.0; 2]);
        assert_eq!(samples.stretch(1.25).to, f64::INFINITY);
        for (i, t) in times.iter().take(3).enumerate() {
            let slope = (samples.value(i + 1) - samples.value(i)) / (times[i + 1] - t);
            let expected = Stretch { from: *t, to: times[i + 1], begin: [samples.value(i), -slope] };
            assert_eq!(samples.stretch(*t), expected);
            assert_eq!(samples.stretch(0.5 * (t + times[i + 1])), expected);
        }
        assert_eq!(samples.bounds()[0], 4.0);
    }
}

/// Times are equidistant if they are so to a billionth of their distance and to their rounding, however many there are.
#[test]
fn exact_equidistant_times_are_found_as_they_come() {
    fn even(mut times: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
        let mut spacing = Spacing::default();
        times.all(|t| spacing.push(t)).then(|| spacing.even()).flatten()
    }
    for start in [0, 1_400, 200_000_000] {
        let [first, step] = even((0..100_000).map(|i| f64::from(start + i) / 200.0)).expect("equidistant");
        assert!(first == f64::from(start) / 200.0 && (step - 0.005).abs() < 1e-14, "{step}");
    }
    for (off, is_even) in [(0.9e-9, true), (1.1e-9, false), (-0.9e-9, true), (-1.1e-9, false)] {
        for place in [5_u32, 50] {
            let at = |i: u32| 0.5 * (f64::from(i) + if i == place { off } else { 0.0 });
            assert_eq!(even((0..100).map(at)).is_some(), is_even, "{off} at {place}");
        }
    }
    for none in
        [&[] as &[f64], &[1.0], &[0.0, f64::NAN], &[0.0, 1.0, 1.0], &[-1.0, 0.0], &[0.0, f64::INFINITY]]
    {
        assert_eq!(even(none.iter().copied()), None, "{none:?}");
    }
}

/// The time of every sample finds that sample, whatever rounding does to the division by the distance.
#[test]
fn exact_the_time_of_a_sample_begins_its_stretch() {
    let count = 4001;
    let samples = Samples::every(0.0, 0.01, (0..count).map(f64::from).collect()).expect("a record");
    for i in 0..count as usize - 1 {
        let stretch = samples.stretch(samples.time(i));
        assert_eq!([stretch.from, stretch.to], [samples.time(i), samples.time(i + 1)]);
        assert_eq!(samples.stretch(stretch.to.next_down()).from, stretch.from);
    }
}

/// Scaled, reversed or with half the samples, a record shares one table, and equals separately stored samples.
#[test]
fn exact_scaled_and_coarser_samples_are_views_of_one_table() {
    let own = |times: &[f64], values: &[f64]| Samples::at(times.to_vec(), values.to_vec()).expect("a record");
    for times in [[0.5, 0.75, 1.0, 1.25, 1.5], [0.5, 0.8, 1.0, 1.25, 1.5]] {
        let samples = own(&times, &[1.0, -2.0, 4.0, 3.0, 7.0]);
        let reversed = samples.times(-3.0).expect("a record");
        assert!(std::ptr::eq(reversed.table, samples.table));
        let alone = own(&times, &[-3.0, 6.0, -12.0, -9.0, -21.0]);
        assert_eq!((reversed, reversed.bounds()), (alone, alone.bounds()));
        let coarser = reversed.every_second().expect("a record");
        let expected = own(&[times[0], times[2], times[4]], &[-3.0, -12.0, -21.0]);
        assert!(std::ptr::eq(coarser.table, samples.table));
        assert!(reversed != samples && coarser != reversed, "views of one table are not the same samples");
        assert_eq!((coarser, coarser.bounds(), coarser.len()), (expected, expected.bounds(), 3));
        for t in [0.0, 0.5, 0.6, 0.8, 1.0, 1.1, 1.5, 2.0] {
            assert_eq!(coarser.stretch(t), expected.stretch(t), "{t}");
        }
        let force = SampledForce::new(coarser, 2.0);
        assert_eq!((force.forces(1), force.times(1)), (Some([-24.0, -42.0]), Some([times[2], times[4]])));
        assert_eq!((force.forces::<3>(1), force.times::<3>(1)), (None, None));
        for (t, sample) in [(0.0, None), (0.5, Some(0)), (times[1], None), (times[2], Some(1)), (2.0, None)] {
            assert_eq!(force.at(t), sample, "{t}");
        }
    }
    let samples = own(&[0.0, 1.0, 2.0], &[1.0, 2.0, 3.0]);
    assert_eq!(
        samples.times(f64::INFINITY).expect_err("no number").to_string().split(':').next(),
        Some("sample 1")
    );
    assert!(samples.every_second().and_then(Samples::every_second).is_err(), "one sample is none");
}

#[test]
fn contract_what_is_no_record_says_why() {
    let refused = |times: &[f64], values: &[f64]| {
        Samples::at(times.to_vec(), values.to_vec()).expect_err("no record").to_string()
    };
    assert_eq!(refused(&[], &[]), "it has 0 samples: give at least two");
    assert_eq!(refused(&[0.0], &[1.0]), "it has 1 sample: give at least two");
    assert!(refused(&[0.0, 1.0], &[1.0, f64::NAN]).starts_with("sample 2: NaN is not allowed"));
    assert!(refused(&[0.0, f64::INFINITY], &[1.0, 1.0]).starts_with("sample 2: inf is not allowed"));
    assert!(refused(&[-1.0, 1.0], &[1.0, 1.0]).starts_with("sample 1: the time -1 s"));
    assert!(refused(&[0.0, 1.0, 1.0], &[1.0, 1.0, 1.0]).starts_with("sample 3: the time 1 s does not"));
    assert!(Samples::every(0.0, 0.0, vec![1.0, 1.0]).is_err());
    assert!(Samples::every(0.0, 0.1, vec![]).is_err());
    let close = refused(&[0.0, 1e-320, 1.0], &[0.0, 1.0, 1.0]);
    assert!(close.starts_with("sample 2: it comes only 1e-320 s after the sample before it"), "{close}");
    assert!(Samples::every(0.0, 1e-320, vec![1.0, 2.0]).is_err());
    let endless = Samples::every(0.0, 1e308, vec![1.0; 3]).expect_err("no record").to_string();
    assert!(endless.starts_with("sample 3: inf is not allowed"), "{endless}");
}

#[test]
fn contract_what_is_read_again_is_kept_once() {
    let file =
        |column| RecordFile { file: "a.csv".to_owned(), column, unit: None, scale: Finite::new(2.0).ok() };
    let read = || Record::new(file(None)).with(Samples::every(0.0, 0.1, vec![1.0, 2.0]).expect("a record"));
    assert_eq!(read(), read());
    let table = || read().samples().expect("read").table;
    assert!(std::ptr::eq(table(), table()));
    assert_ne!(read(), Record::new(file(None)));
    assert_ne!(Record::new(file(Some(Column::Number(1)))), Record::new(file(None)));
}
