//! The solver in an argmin `Executor` of the user's own.

use crate::problems::PROBLEMS;
use argmin::core::observers::{Observe, ObserverMode};
use argmin::core::{Error, Executor, KV, State as _, TerminationReason};
use retune_optim::search::fminsearch::State;
use retune_optim::{Fminsearch, Options, Row, minimize};
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};

/// The values passed to an argmin observer: (iteration, func_count, procedure, best, value).
type Seen = (u64, u64, String, Vec<f64>, f64);

#[derive(Clone, Default)]
struct Recorder(Arc<Mutex<Vec<Seen>>>);

impl Recorder {
    fn record(&self, state: &State, log: &KV) -> Result<(), Error> {
        let count = |key| log.get(key).and_then(|value| value.get_uint()).expect(key);
        let procedure = log.get("procedure").and_then(|value| value.get_string()).expect("procedure");
        let best = state.get_param().expect("parameters").clone();
        let seen = (count("iteration"), count("func_count"), procedure, best, state.get_cost());
        self.0.lock().expect("no panic").push(seen);
        Ok(())
    }
}

impl Observe<State> for Recorder {
    fn observe_init(&mut self, name: &str, state: &State, log: &KV) -> Result<(), Error> {
        assert_eq!(name, "fminsearch");
        self.record(state, log)
    }

    fn observe_iter(&mut self, state: &State, log: &KV) -> Result<(), Error> {
        self.record(state, log)
    }
}

#[test]
fn contract_argmin_observers_see_the_same_rows() {
    for (name, objective, start) in PROBLEMS {
        let objective = |x: &[f64], _cutoff: f64| objective(x);
        let mut rows = Vec::new();
        let found = minimize(objective, start, Options::default(), |row: &Row| {
            rows.push(row.clone());
            ControlFlow::Continue(())
        })
        .expect("a valid start");

        let recorder = Recorder::default();
        let solver = Fminsearch::new(start, Options::default()).expect("a valid start");
        let result = Executor::new(objective, solver)
            .add_observer(recorder.clone(), ObserverMode::Always)
            .run()
            .expect("a valid start");

        let as_seen = |row: Row| {
            (row.iteration, row.func_count, row.procedure.label().to_string(), row.best, row.value)
        };
        let seen = recorder.0.lock().expect("no panic");
        assert_eq!(*seen, rows.into_iter().map(as_seen).collect::<Vec<Seen>>(), "{name}");
        assert_eq!(result.state.get_termination_reason(), Some(&TerminationReason::SolverConverged));
        assert_eq!(result.state.get_best_param(), Some(&found.x));
        assert_eq!(
            result.problem.counts["cost_count"], found.func_count,
            "argmin counts the evaluations, too"
        );
    }
}
