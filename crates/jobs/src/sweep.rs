//! `sweep`: the run of a scene, or the objective of a study, at each value of one parameter.
//!
//! ```
//! use retune_jobs::rows::Rows;
//! use retune_jobs::sweep::{Options, Plan, Sweep};
//!
//! let study = retune_study::read::from_text(
//!     r#"{
//!         "scene": {
//!             "primary": { "m1": 1000, "c1": 452, "k1": 39500 },
//!             "forcing": { "P": 800, "omega": 6.28 }
//!         },
//!         "window": { "t0": 200, "T": 230 }
//!     }"#,
//!     "bare.json",
//! )?;
//! let options = Options { from: "0.8Hz".into(), to: "1.2Hz".into(), points: 5, ..Options::over("omega".parse()?) };
//! let sweep = Sweep::new(Plan::read(&options)?, study)?;
//! let points: Vec<f64> = (0..sweep.len()).flat_map(|i| sweep.numbers(i).0).collect();
//! let table = sweep.table(&points);
//! assert_eq!(table.column("f_Hz").map(|column| column[2]), Some(1.0)); // resonance is at 1 Hz
//! let energy = table.column("E1max").ok_or("a column")?;
//! assert!(energy[2] > 10.0 * energy[0] && energy[2] > 10.0 * energy[4]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod draw;
mod plan;
mod points;
pub mod words;

pub use plan::{Options, Plan, Quantity};
pub use points::Sweep;

use crate::artefact::Kind;
use crate::job::{Job, Made};
use crate::parts::{Shard, Shared};
use crate::recompute::{Row, Source, broken};
use crate::resolved::{self, Resolved};
use crate::rows::{Rows, compute};
use crate::{Error, Observer, Request};
use retune_report::table::Table;
use retune_store::Directory;
use retune_store::identity::VERSION;
use retune_study::read;
use serde_json::{Value, json};
use std::path::Path;

/// The file with all points.
pub const FILE: &str = "sweep.csv";
/// All points as JSON.
const JSON: &str = "sweep.json";

/// The files of a sweep.
pub static KIND: Kind = Kind {
    command: "sweep",
    answer: JSON,
    input: resolved::SEVERAL,
    rows: &[(FILE, recompute)],
    whole: &[],
    derived: &[JSON, "sweep.txt", "sweep.svg"],
};

// A journal must hold every sweep; no point has more than 17 numbers.
const _: () = assert!(17 * plan::MOST_POINTS <= retune_store::MOST_POINTS);

/// How the points of a sweep are obtained.
#[derive(Clone, Debug, Default)]
pub enum Points {
    /// All are computed.
    #[default]
    All,
    /// The points of a share are computed and written as a part.
    Share(Shard),
    /// They are read from the parts of all shares.
    Merged,
}

impl Points {
    /// The choice of the options `--shard` and `--merge`.
    pub fn of(shard: Option<Shard>, merge: bool) -> Self {
        shard.map_or(if merge { Self::Merged } else { Self::All }, Self::Share)
    }
}

/// Sweeps a parameter through a study, or through the design that a search found.
///
/// # Errors The study or the request is wrong, parts are missing, or the results cannot be written.
pub fn sweep(
    request: &Request,
    options: &Options,
    points: &Points,
    watch: &dyn Observer,
) -> Result<(), Error> {
    let sweep = Sweep::new(Plan::read(options)?, read(&request.study)?)?;
    let objective = if sweep.plan().objective { "-objective" } else { "" };
    let rest = format!("{}{objective}", sweep.plan().over.symbol());
    let request = request.placed(KIND.command, sweep.study(), &rest)?;
    let plan = json!(sweep.plan());
    let studies = [(sweep.study().name(), sweep.study())];
    let job = Job::of_studies(&KIND, &request, plan, studies.into_iter())?;
    let command = format!("retune sweep {} {}", request.study.display(), sweep.plan().options());
    let (rows, identity) = (&sweep, job.identity());
    let shared = Shared { rows, identity, out: &job.out, order: &job.order, command };
    if let Points::Share(shard) = points {
        return request.on_threads(|| shared.make(*shard, watch));
    }
    job.run(&request, watch, |results| {
        if let Points::Merged = points {
            shared.merge(&[], results, watch)?;
        }
        Ok(Made { answer: (), report: write(&sweep, results, watch)?, parts: Vec::new() })
    })?;
    Ok(())
}

/// Computes all points and writes them; returns the answer.
fn write(sweep: &Sweep, results: &Directory, watch: &dyn Observer) -> Result<String, Error> {
    let bar = watch.progress("sweep", sweep.len() as u64);
    let found = compute(sweep, 0..sweep.len(), results.journal(), &*bar);
    bar.finish();
    results.journal().check()?;
    let reasons: Vec<(f64, String)> = found
        .iter()
        .enumerate()
        .filter_map(|(i, (_, reason))| Some((sweep.value(i), reason.clone()?)))
        .collect();
    let found: Vec<f64> = found.into_iter().flat_map(|(numbers, _)| numbers).collect();
    let table = sweep.table(&found);
    let [all, few] = [true, false].map(|all| words::text(sweep, &table, &reasons, all));
    results.write(FILE, &table.csv())?;
    results.write_json(JSON, &json(sweep, &table))?;
    results.write("sweep.txt", &(all.clone() + "\n"))?;
    results.write("sweep.svg", &draw::draw(sweep, &table))?;
    watch.log(&format!("{all}\n"))?;
    Ok(few)
}

/// The table with its origin.
fn json(sweep: &Sweep, table: &Table) -> Value {
    let mut json = json!({ "retune": VERSION, "study": sweep.study().name(), "sweep": sweep.plan() });
    json["window"] = json!(sweep.study().window);
    json["solver"] = json!(sweep.study().solver);
    if sweep.plan().objective {
        json["objective"] = json!(sweep.study().objective());
    }
    if let (Some(all), Value::Object(more)) = (json.as_object_mut(), table.json()) {
        all.extend(more);
    }
    json
}

/// Recomputes every number of a row of the table.
fn recompute(place: &Path, _name: &str) -> Result<Source, Error> {
    let (plan, study) = Resolved::one(place)?;
    let plan =
        serde_json::from_value(plan).map_err(|error| broken(place, resolved::SEVERAL, error.to_string()))?;
    let sweep = Sweep::new(plan, study)?;
    Ok(Source::new(move |row: Row| {
        let columns = sweep.columns();
        let value = row.number(&columns[0].name);
        let numbers = value.is_finite().then(|| sweep.row(value, &sweep.numbers_at(value).0))?;
        Some(columns.into_iter().zip(numbers).map(|(column, number)| (column.name, number)).collect())
    }))
}
