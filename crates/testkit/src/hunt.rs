//! Hunts for errors: properties that must hold for every scene are checked on many random scenes. `cargo test` draws few; the programs
//! of `retune-lab` draw any number and write the tables of `results/robustness`.

pub mod bands;
#[cfg(feature = "dynamics")]
pub mod branches;
#[cfg(feature = "dynamics")]
pub mod dampers;
#[cfg(feature = "anything")]
pub mod dashpots;
#[cfg(feature = "anything")]
pub mod draws;
#[cfg(feature = "anything")]
mod histories;
#[cfg(feature = "desk")]
pub mod kills;
#[cfg(feature = "anything")]
pub mod largest;
#[cfg(feature = "optim")]
pub mod needs;
#[cfg(feature = "optim")]
pub mod peaks;
#[cfg(feature = "anything")]
pub mod repeats;
#[cfg(feature = "anything")]
pub mod rigid;
#[cfg(feature = "anything")]
pub mod scenes;
#[cfg(feature = "anything")]
pub mod settled;
mod twofold;

/// What a hunt found.
#[derive(Clone, Debug, Default)]
pub struct Hunt {
    /// Its table, line by line.
    pub rows: Vec<String>,
    /// Violations, one per line; empty if there are none.
    pub faults: Vec<String>,
}

impl Hunt {
    /// Adds a line to the table.
    pub fn row(&mut self, line: String) {
        self.rows.push(line);
    }

    /// Records a fault unless `holds`.
    pub fn check(&mut self, holds: bool, fault: impl FnOnce() -> String) {
        if !holds {
            self.faults.push(fault());
        }
    }

    /// Panics with all faults, if any.
    ///
    /// # Panics
    /// At any fault.
    #[track_caller]
    pub fn passes(&self) {
        assert!(self.faults.is_empty(), "{}\n{}", self.rows.join("\n"), self.faults.join("\n"));
    }
}
