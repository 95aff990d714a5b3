//! fminsearch beyond the reference runs: log, limits, early stopping of the objective, failed evaluations, bounds,
//! scaling.

use crate::problems::{PROBLEMS, quadratic, rosenbrock};
use retune_optim::{Bounds, Error, Fminsearch, Minimum, Options, Procedure, Row, Scaling, Stop, minimize};
use std::cell::{Cell, RefCell};
use std::ops::ControlFlow;

/// A whole run and its rows.
fn run(objective: impl Fn(&[f64], f64) -> f64, start: &[f64], options: Options) -> (Minimum, Vec<Row>) {
    let mut rows = Vec::new();
    let found = minimize(objective, start, options, |row| {
        rows.push(row.clone());
        ControlFlow::Continue(())
    });
    (found.expect("a valid start"), rows)
}

fn between(lower: f64, upper: f64) -> Bounds {
    Bounds { lower: Some(lower), upper: Some(upper) }
}

fn bounded(bounds: &[Bounds]) -> Options {
    Options { bounds: bounds.to_vec(), ..Options::default() }
}

#[test]
fn contract_log_starts_and_runs_as_matlabs_does() {
    let (_, rows) = run(|x, _| rosenbrock(x), &[-1.2, 1.0], Options::default());
    let head: Vec<_> =
        rows[..3].iter().map(|r| (r.iteration, r.func_count, r.procedure.to_string())).collect();
    let expected = [(0, 1, ""), (1, 3, "initial simplex"), (2, 5, "expand")];
    assert_eq!(head, expected.map(|(i, count, name)| (i, count, name.to_owned())));
    assert_eq!(rows[0].best, [-1.2, 1.0]);
    assert!(rows.iter().zip(0..).all(|(row, i)| row.iteration == i), "numbered without gaps");
    assert!(rows.is_sorted_by(|a, b| a.value >= b.value), "the best never gets worse");
}

/// MATLAB itself on its documentation's example (`Display` `iter`, default options): 85 iterations, 159 evaluations,
/// f = 8.17766e-10, and these procedures after the initial simplex, by their letters expand, reflect, contract
/// inside, contract outside.
#[test]
fn reference_matlabs_own_run() {
    let matlabs = "eroiirieieeerrerereiieoerrririeirrieorereirrooirierreieeorirririoiooiiriiioiiiiioioi";
    let (found, rows) = run(|x, _| rosenbrock(x), &[-1.2, 1.0], Options::default());
    let letter = |row: &Row| match row.procedure {
        Procedure::Expand => 'e',
        Procedure::Reflect => 'r',
        Procedure::ContractInside => 'i',
        Procedure::ContractOutside => 'o',
        other => panic!("{other:?}"),
    };
    assert_eq!(rows[2..].iter().map(letter).collect::<String>(), matlabs);
    assert_eq!((found.iterations, found.func_count, found.stop), (85, 159, Stop::Converged));
    assert_eq!(format!("{:.5e}", found.value), "8.17766e-10");
}

/// The values that decide each kind of step on the line, and the cutoff each evaluation is given.
#[test]
fn contract_decisions_and_cutoffs_of_every_step() {
    use Procedure::{ContractInside, ContractOutside, Expand, Reflect, Shrink};
    let inf = f64::INFINITY;
    // The vertices 10, 10.5 have the values 1, 2; then the values of the step, its label and its cutoffs.
    let cases: [(&[f64], Procedure, &[f64]); 10] = [
        (&[0.5, 0.25], Expand, &[2.0, 0.5]),
        (&[0.5, 0.5], Reflect, &[2.0, 0.5]),
        (&[0.5, 0.75], Reflect, &[2.0, 0.5]),
        (&[1.0, 1.0], ContractOutside, &[2.0, 1.0]),
        (&[1.5, 1.5], ContractOutside, &[2.0, 1.5]),
        (&[1.5, 1.75, 7.0], Shrink, &[2.0, 1.5, inf]),
        (&[2.0, 1.5], ContractInside, &[2.0, 2.0]),
        (&[f64::NAN, 1.5], ContractInside, &[2.0, 2.0]),
        (&[3.0, 2.0, 7.0], Shrink, &[2.0, 2.0, inf]),
        (&[-inf, f64::NAN, -inf], Shrink, &[2.0, 2.0, inf]),
    ];
    for (values, procedure, cutoffs) in cases {
        let script: Vec<f64> = [&[1.0, 2.0], values].concat();
        let seen = RefCell::new(Vec::new());
        let stub = |_: &[f64], cutoff: f64| {
            seen.borrow_mut().push(cutoff);
            script[seen.borrow().len() - 1]
        };
        let (_, rows) = run(stub, &[10.0], Options { max_iter: Some(2), ..Options::default() });
        assert_eq!(rows[2].procedure, procedure, "{values:?}");
        assert_eq!(seen.borrow()[..], [&[inf, inf], cutoffs].concat()[..], "{values:?}");
    }
}

/// In two dimensions the second worst value differs from the best: reflections between them are kept as they are.
#[test]
fn contract_reflection_between_best_and_second_worst() {
    for (reflected, procedure) in [
        (1.5, Procedure::Reflect),
        (1.0, Procedure::Reflect), // a tie with the best is no reason to expand
        (2.0, Procedure::ContractOutside), // a tie with the second worst is not good enough
    ] {
        let script = [1.0, 2.0, 3.0, reflected, 1.25];
        let calls = Cell::new(0);
        let stub = |_: &[f64], _: f64| script[calls.replace(calls.get() + 1)];
        let (_, rows) = run(stub, &[1.0, 1.0], Options { max_iter: Some(2), ..Options::default() });
        assert_eq!(rows[2].procedure, procedure, "{reflected}");
    }
}

#[test]
fn invariant_early_stopping_changes_no_row() {
    let garbage: [fn(f64) -> f64; 4] = [|_| f64::MAX, f64::next_up, |_| f64::NAN, |_| f64::NEG_INFINITY];
    for (name, objective, start) in PROBLEMS {
        let exact = run(|x, _| objective(x), start, Options::default());
        for above in garbage {
            let stopped = Cell::new(0);
            let early = |x: &[f64], cutoff: f64| {
                let value = objective(x);
                if value <= cutoff {
                    return value;
                }
                stopped.set(stopped.get() + 1);
                above(cutoff)
            };
            assert_eq!(run(early, start, Options::default()), exact, "{name}");
            assert!(stopped.get() > 10, "{name}: {} evaluations stopped early", stopped.get());
        }
    }
}

#[test]
fn contract_limits_end_the_run() {
    let limited = |max_iter, max_fun_evals| Options { max_iter, max_fun_evals, ..Options::default() };
    let stop = |options| {
        let (found, rows) = run(|x, _| quadratic(x), &[1.0; 4], options);
        assert_eq!(rows.len() as u64, found.iterations + 1);
        (found.stop, found.iterations, found.func_count)
    };
    assert_eq!(stop(limited(Some(0), None)), (Stop::MaxIter, 1, 5), "the initial simplex is always made");
    let (reason, iterations, _) = stop(limited(Some(10), None));
    assert_eq!((reason, iterations), (Stop::MaxIter, 10));
    let (reason, _, evaluations) = stop(limited(None, Some(20)));
    assert_eq!(reason, Stop::MaxFunEvals);
    assert!((20..20 + 6).contains(&evaluations), "{evaluations}: the last iteration is finished");
    // MATLAB's own run of Rosenbrock's function has 27 evaluations after iteration 13.
    for (max_iter, max_fun_evals) in [(None, 26), (None, 27), (Some(13), 27)] {
        let (found, _) = run(|x, _| rosenbrock(x), &[-1.2, 1.0], limited(max_iter, Some(max_fun_evals)));
        assert_eq!((found.stop, found.iterations, found.func_count), (Stop::MaxFunEvals, 13, 27));
    }
    // An objective without a lower bound ends only after 200 iterations for each coordinate.
    let (found, _) = run(|x, _| -x[0], &[1.0], Options { max_fun_evals: Some(10_000), ..Options::default() });
    assert_eq!((found.stop, found.iterations), (Stop::MaxIter, 200));
}

#[test]
fn contract_tolerances_must_both_hold() {
    // A constant objective, so that TolX alone decides; and the reverse.
    let (found, _) = run(|_, _| 1.0, &[100.0, 0.0], Options::default());
    assert_eq!(found.stop, Stop::Converged);
    assert!(found.iterations > 10, "5 must shrink below 1e-4: {}", found.iterations);
    let (found, _) = run(|x, _| 1e9 * (x[0] - 3.1e-7).abs(), &[1e-6], Options::default());
    assert_eq!(found.stop, Stop::Converged);
    assert!(found.value < 1e-3 && found.iterations > 10, "{found:?}");
}

#[test]
fn contract_failed_evaluations_are_never_accepted() {
    for failure in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        // The lower half plane, which contains the bowl's middle, has no value.
        let objective =
            |x: &[f64], _: f64| if x[1] < 0.0 { failure } else { x[0] * x[0] + (x[1] + 1.0).powi(2) };
        let (found, rows) = run(objective, &[1.0, 1.0], Options::default());
        assert!(rows.iter().all(|row| row.value.is_finite() && row.best[1] >= 0.0), "{failure}");
        assert!(found.value < 1.1 && found.stop == Stop::Converged, "{failure}: {found:?}");

        // A value at the start alone: the simplex shrinks onto it, and the run ends.
        let lonely = |x: &[f64], _: f64| if x == [1.0, 1.0] { 7.0 } else { failure };
        let (found, _) = run(lonely, &[1.0, 1.0], Options::default());
        assert_eq!((found.x, found.value, found.stop), (vec![1.0, 1.0], 7.0, Stop::Converged), "{failure}");
    }
}

#[test]
fn contract_bounds_hold_at_every_evaluation() {
    // The bowl's middle (3, −1) is outside; the best point of the box is its corner (2, 0).
    let calls = Cell::new(0);
    let bowl = |x: &[f64], _: f64| {
        assert!((0.5..=2.0).contains(&x[0]) && x[1] >= 0.0, "{x:?}");
        calls.set(calls.get() + 1);
        (x[0] - 3.0).powi(2) + (x[1] + 1.0).powi(2)
    };
    let box_2d = [between(0.5, 2.0), Bounds { lower: Some(0.0), upper: None }];
    for scaling in [Scaling::None, Scaling::Start] {
        calls.set(0);
        let (found, _) = run(bowl, &[1.0, 0.5], Options { scaling, ..bounded(&box_2d) });
        assert_eq!(
            found.func_count,
            calls.get(),
            "points outside are not counted, for they are not evaluated"
        );
        assert_eq!(found.stop, Stop::Converged);
        assert!((found.x[0] - 2.0).abs() < 1e-3 && found.x[1] < 1e-3, "{found:?}");
    }
}

#[test]
fn contract_start_in_a_corner_of_its_box() {
    let first = RefCell::new(Vec::new());
    let recorded = |x: &[f64], _: f64| {
        first.borrow_mut().push(x.to_vec());
        x[0] + x[1]
    };
    run(recorded, &[2.0, 0.0], bounded(&[between(1.0, 2.0), between(-1.0, 0.0)]));
    assert_eq!(first.borrow()[..3], [[2.0, 0.0], [1.9, 0.0], [2.0, -0.00025]]);
}

#[test]
fn contract_invalid_input_is_refused_by_index_and_value() {
    let refused =
        |start: &[f64], options| minimize(|x, _| x[0], start, options, |_| ControlFlow::Continue(()));
    let error = |start: &[f64], options| refused(start, options).expect_err("invalid");
    let unit = between(0.0, 1.0);
    assert_eq!(error(&[], Options::default()), Error::EmptyStart);
    let infinite = Error::StartOutside { index: 1, value: f64::INFINITY, bounds: Bounds::default() };
    assert_eq!(error(&[1.0, f64::INFINITY], Options::default()), infinite);
    let outside = Error::StartOutside { index: 1, value: 1.5, bounds: unit };
    assert_eq!(error(&[0.5, 1.5], bounded(&[unit, unit])), outside);
    assert_eq!(outside.to_string(), "coordinate 1 of the start is 1.5, outside its bounds [0, 1]");
    assert_eq!(error(&[0.5, 0.5], bounded(&[unit])), Error::BoundsCount { expected: 2, given: 1 });
    for bad in [between(1.0, 1.0), between(2.0, 0.0), between(f64::NEG_INFINITY, 2.0)] {
        assert_eq!(error(&[1.0], bounded(&[bad])), Error::EmptyBounds { index: 0, bounds: bad });
    }
    assert!(matches!(error(&[1.0], bounded(&[between(f64::NAN, 2.0)])), Error::EmptyBounds { .. }));
    let tolerance = |tol_x, tol_fun| error(&[1.0], Options { tol_x, tol_fun, ..Options::default() });
    assert_eq!(tolerance(-1.0, 0.0), Error::Tolerance { name: "tol_x", value: -1.0 });
    assert!(matches!(tolerance(0.0, f64::NAN), Error::Tolerance { name: "tol_fun", .. }));
    let no_value =
        minimize(|_, _| f64::NEG_INFINITY, &[1.0], Options::default(), |_| ControlFlow::Continue(()));
    assert_eq!(no_value, Err(Error::StartValue { value: f64::NEG_INFINITY }));
}

#[test]
fn contract_a_start_without_a_value_leaves_the_run_as_new() {
    let mut solver = Fminsearch::new(&[1.0], Options::default()).expect("a valid start");
    let new = solver.clone();
    let failed = solver.run(|_, _| f64::INFINITY, |row| panic!("told {row:?}"));
    assert_eq!(failed, Err(Error::StartValue { value: f64::INFINITY }));
    assert_eq!(solver, new);
}

#[test]
fn exact_scaled_run_is_the_run_over_the_ratios() {
    let start = [215.0, -232.0, 0.06, 0.0];
    let size = [215.0, 232.0, 0.06, 1.0];
    let goal = [300.0, -100.0, 0.11, 0.2];
    let objective = |x: &[f64]| (0..4).map(|j| ((x[j] - goal[j]) / size[j]).powi(2)).sum::<f64>();
    let times_size = |u: &[f64]| (0..4).map(|j| u[j] * size[j]).collect::<Vec<f64>>();
    let scaled = Options { scaling: Scaling::Start, ..Options::default() };
    let (found, rows) = run(|x, _| objective(x), &start, scaled);
    let (ratios, ratio_rows) =
        run(|u, _| objective(&times_size(u)), &[1.0, -1.0, 1.0, 0.0], Options::default());

    assert_eq!(rows[0].best, start, "rows are in the parameters' own units");
    assert_eq!((found.scaling, ratios.scaling), (Scaling::Start, Scaling::None));
    assert_eq!(rows.len(), ratio_rows.len());
    for (row, ratio_row) in rows.iter().zip(ratio_rows) {
        assert_eq!(*row, Row { best: times_size(&ratio_row.best), ..ratio_row });
    }
    // TolX is relative there: k2 is not resolved to 1e-4 absolute, as the faithful run must.
    let (faithful, _) = run(|x, _| objective(x), &start, Options::default());
    assert!(faithful.func_count > found.func_count, "{} {}", faithful.func_count, found.func_count);
}

/// The parameters at which the start and the vertices of the initial simplex are evaluated.
fn first_evaluations(start: &[f64], options: Options) -> Vec<Vec<f64>> {
    let seen = RefCell::new(Vec::new());
    let recorded = |x: &[f64], _: f64| {
        seen.borrow_mut().push(x.to_vec());
        1.0
    };
    run(recorded, start, Options { max_iter: Some(0), ..options });
    seen.into_inner()
}

#[test]
fn contract_five_percent_or_matlabs_step_at_zero() {
    let all = first_evaluations(&[215.0, -2.0, 0.0], Options::default());
    assert_eq!(all[1..], [[225.75, -2.0, 0.0], [215.0, -2.1, 0.0], [215.0, -2.0, 0.00025]]);
}

#[test]
fn contract_steps_inward_at_a_bound_and_halfway_in_a_narrow_box() {
    let second =
        |x: f64, scaling, bounds| first_evaluations(&[x], Options { scaling, ..bounded(&[bounds]) })[1][0];
    let below = |upper| Bounds { lower: None, upper: Some(upper) };
    assert_eq!(second(100.0, Scaling::None, below(105.0)), 105.0, "the bound itself is allowed");
    assert_eq!(second(100.0, Scaling::None, below(104.0)), 95.0);
    assert_eq!(second(0.0, Scaling::None, below(0.0)), -0.00025);
    assert_eq!(second(-100.0, Scaling::None, Bounds { lower: Some(-100.0), upper: None }), -95.0);
    assert_eq!(second(100.0, Scaling::Start, below(104.0)), 95.0, "bounds are on the parameter");
    assert_eq!(second(100.0, Scaling::None, between(99.0, 102.0)), 101.0);
    assert_eq!(second(100.0, Scaling::None, between(96.0, 102.0)), 98.0);
    assert_eq!(second(-100.0, Scaling::Start, between(-100.0, -98.0)), -99.0);
}

/// How a run of one coordinate ends whose first two vertices, 0.00025 apart, have these values.
fn ends(values: [f64; 2], tol_x: f64, tol_fun: f64) -> Stop {
    let objective = |x: &[f64], _: f64| values[usize::from(x[0] != 0.0)];
    run(objective, &[0.0], Options { tol_x, tol_fun, max_iter: Some(2), ..Options::default() }).0.stop
}

#[test]
fn contract_converged_needs_both_tolerances() {
    let apart = 0.00025_f64;
    assert_eq!(ends([3.0, 3.5], apart, 0.5), Stop::Converged, "both limits are included");
    assert_eq!(ends([3.0, 3.5], 0.24 * apart, 0.5), Stop::MaxIter, "too wide");
    assert_eq!(ends([3.0, 3.5], apart, 0.49), Stop::MaxIter, "too steep");
    assert_eq!(ends([3.0, f64::INFINITY], apart, 0.5), Stop::MaxIter, "a vertex without a value");
}

#[test]
fn contract_converged_with_zero_tolerances_allows_ten_roundings() {
    // The spacing of doubles is that from the size of a number to the next larger one.
    for (f, spacing) in [
        (1.0, f64::EPSILON),
        (-1.5, f64::EPSILON),
        (2.0, 2.0 * f64::EPSILON),
        (2.0_f64.next_down(), f64::EPSILON),
        (0.0, 5e-324),
        (1e6, 2.0_f64.powi(19 - 52)),
    ] {
        assert_eq!(ends([f, f + 10.0 * spacing], 1.0, 0.0), Stop::Converged, "{f}");
        assert_eq!(ends([f, f + 11.0 * spacing], 1.0, 0.0), Stop::MaxIter, "{f}");
    }
    // That of a simplex is that of its largest coordinate, 2, not of the largest magnitude, 8. In a box narrower than the step the vertices
    // are halfway to its far side.
    let spacing = 2.0 * f64::EPSILON;
    let stop = |roundings: f64| {
        let narrow = [between(-8.0, -8.0 + 8.0 * spacing), between(2.0, 2.0 + 2.0 * roundings * spacing)];
        let options = Options { tol_x: 0.0, max_iter: Some(2), ..bounded(&narrow) };
        run(|_, _| 1.0, &[-8.0, 2.0], options).0.stop
    };
    assert_eq!(stop(10.0), Stop::Converged);
    assert_eq!(stop(11.0), Stop::MaxIter);
}

#[test]
fn exact_contraction_and_shrink_are_matlabs_formulas_to_the_last_bit() {
    for start in (1..100).map(|i| 0.1 * f64::from(i)) {
        let seen = RefCell::new(Vec::new());
        // Three expansions towards zero, after which one vertex is more than twice the other; then nothing is better, and the simplex shrinks.
        let stub = |x: &[f64], _: f64| {
            seen.borrow_mut().push(x[0]);
            let number = seen.borrow().len();
            if number == 2 || number > 8 { 100.0 } else { -(number as f64) }
        };
        let (_, rows) = run(stub, &[start], Options { max_iter: Some(5), ..Options::default() });
        assert_eq!(rows[5].procedure, Procedure::Shrink);
        let seen = seen.into_inner();
        let (best, worst) = (seen[7], seen[5]);
        assert_eq!(seen[9], (1.0 - 0.5) * best + 0.5 * worst);
        assert_eq!(seen[10], best + 0.5 * (worst - best));
    }
    // Written otherwise it is another point; SciPy's runs, which shrink too, tell (`reference`).
    assert_ne!(0.5 * 0.1 + 0.5 * 0.7, 0.1 + 0.5 * (0.7 - 0.1));
}

#[test]
fn contract_ties_keep_their_order() {
    // Zeros of either sign are equal: the vertices stay as they were made, so that the last is reflected about the mean of the others.
    for zeros in [[0.0; 4], [0.0, -0.0, 0.0, -0.0], [-0.0, 0.0, -0.0, 0.0]] {
        let seen = RefCell::new(Vec::new());
        let stub = |x: &[f64], _: f64| {
            seen.borrow_mut().push(x.to_vec());
            zeros.get(seen.borrow().len() - 1).copied().unwrap_or(-1.0)
        };
        let options = Options { tol_x: 0.0, max_iter: Some(2), ..Options::default() };
        let (_, rows) = run(stub, &[1.0, 1.0, 1.0], options);
        assert_eq!(rows[1].best, [1.0; 3]);
        assert!((seen.borrow()[4][2] - 0.95).abs() < 1e-12, "{:?}", seen.borrow()[4]);
    }
}
