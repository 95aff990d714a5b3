//! A table of designs, as `table2` and `track` make it.

use crate::request::{open, where_results_are};
use crate::resolved::{self, Resolved};
use crate::tune::{Found, Optimum, table2_header, table2_row};
use crate::{Error, Observer};
use retune_store::{Directory, Extent, Identity, Order, manifest};
use retune_study::{PaperStudy, Solver, Study, joined, short};
use std::path::Path;

/// A table of designs in the form of the paper's Table 2, with E1max and one column of its own.
pub struct Table {
    name: &'static str,
    directory: Directory,
    resolved: String,
    solvers: Vec<Solver>,
    /// The results of its searches, which are finished together with it: until then a resumed run reads their journals.
    parts: Vec<Directory>,
    /// The error of the first search that found no design within its limits.
    infeasible: Option<Error>,
    csv: Vec<String>,
    text: Vec<String>,
}

impl Table {
    /// Begins the table `name`, whose first column is `column`, in the directory `out`. It combines searches of the studies of
    /// `rows` under `plan`; `others` are further files that the command writes there.
    ///
    /// # Errors
    /// The directory cannot be written to.
    pub fn new(
        [name, column]: [&'static str; 2],
        others: &'static [&'static str],
        out: &Path,
        order: &Order,
        plan: serde_json::Value,
        rows: &[PaperStudy],
        watch: &dyn Observer,
    ) -> Result<Self, Error> {
        let resolved =
            Resolved::new(plan, rows.iter().map(|row| (row.damper.as_str(), &row.study))).text()?;
        let solvers = rows.iter().map(|row| row.study.solver).collect();
        let identity = Identity::of(&resolved);
        let is_ours = move |file: &str| {
            file == format!("{name}.csv")
                || file == format!("{name}.txt")
                || [resolved::NAME, manifest::NAME].contains(&file)
                || others.contains(&file)
        };
        let directory = open(out, order, &identity, Extent::Whole, is_ours, watch)?;
        let csv = vec![format!("{column},damper,m2,k2,c2,D,C,E1max")];
        let text = vec![format!("{column:<14}{:<84}E1max, J", table2_header())];
        Ok(Self { name, directory, resolved, solvers, parts: Vec::new(), infeasible: None, csv, text })
    }

    /// Appends a row.
    pub fn push(&mut self, label: &str, damper: &str, Found { damper: found, e1_max }: Found) {
        self.csv.push(format!("{label},{},{},{e1_max}", quoted(damper), joined(&found.values(), ",")));
        self.text.push(format!("{label:<14}{:<84}{}", table2_row(damper, &found), short(e1_max)));
    }

    /// Keeps the results of a study's search, to be finished together with the table.
    pub fn keep(&mut self, study: &Study, optimum: &Optimum, results: Directory) {
        self.parts.push(results);
        self.infeasible = self.infeasible.take().or(optimum.check_limits(study.name()).err());
    }

    /// The directory of the table.
    pub fn directory(&self) -> &Directory {
        &self.directory
    }

    /// Writes and prints the table.
    ///
    /// # Errors
    /// It cannot be written, or a design in it breaks the limits of its study (the table is written all the same).
    pub fn finish(self, watch: &dyn Observer) -> Result<(), Error> {
        let Self { name, directory, resolved, solvers, parts, infeasible, csv, text } = self;
        directory.write(&format!("{name}.csv"), &(csv.join("\n") + "\n"))?;
        directory.write(&format!("{name}.txt"), &(text.join("\n") + "\n"))?;
        directory.write(resolved::NAME, &resolved)?;
        manifest::write(Identity::of(&resolved), solvers, &directory)?;
        let out = directory.path().to_owned();
        directory.publish()?;
        parts.into_iter().try_for_each(Directory::finish)?;
        directory.finish()?;
        watch.result(&format!("\n{}", text.join("\n")))?;
        watch.result(&where_results_are(&out)?)?;
        infeasible.map_or(Ok(()), Err)
    }
}

/// A text as a CSV field.
pub fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
