//! A run in blocks of some periods of the force.

use crate::extremes::{Also, Ask, Extremes, Maxima, maxima, read};
use crate::linear::steps::Steps;
use crate::motion::segment::Segment;
use crate::observe::observer::{Impact, Observer, Path};
use crate::recurrence::section::PoincareSection;
use crate::recurrence::test::{Recurrence, Settle};
use crate::settings::Settings;
use retune_model::{Coupled, PerMeasure};
use std::f64::consts::TAU;

/// The extremes of one block after another, until the motion has settled. A segment belongs to the block in which it begins.
pub struct Blocks<'a> {
    system: &'a Coupled,
    /// The question put to each block.
    ask: Ask,
    /// Of the force, s.
    period: f64,
    /// Periods in a block.
    periods: u32,
    /// Blocks that begin at this time or later count even if the motion does not settle, s.
    from: f64,
    /// What is asked for beside counts for blocks that end after this time, s; `None` if nothing is.
    beside_from: Option<f64>,
    section: PoincareSection,
    recurrence: Recurrence<'a>,
    now: Maxima<'a>,
    /// Blocks that are finished.
    done: u32,
    /// The largest values, of what is asked for beside, of the blocks that count.
    beside: PerMeasure<f64>,
    /// The last block of a motion that has settled.
    settled: Option<Extremes>,
    /// The extremes while the motion has not settled, and whether they are those of blocks that count.
    unsettled: Option<(Extremes, bool)>,
}

impl<'a> Blocks<'a> {
    /// Blocks from t = 0 on; those that begin at `from` (s) or later count even if the motion does not settle.
    pub fn new(system: &'a Coupled, from: f64, settle: Settle, settings: &Settings, ask: Ask) -> Self {
        let period = TAU / system.bare().frequency();
        let beside_from = ask.also.map(|also| also.from);
        let also = ask.also.map(|also| Also { from: 0.0, ..also });
        let ask = Ask { also, cutoff: f64::INFINITY, ..ask };
        Self {
            system,
            ask,
            period,
            periods: settle.periods,
            from,
            beside_from,
            section: PoincareSection::new(period, settle.periods as usize * settle.blocks as usize),
            recurrence: Recurrence::new(system, settle, settings),
            now: maxima(system, ask),
            done: 0,
            beside: PerMeasure::default(),
            settled: None,
            unsettled: None,
        }
    }

    /// When a block begins, s.
    fn begin(&self, block: u32) -> f64 {
        (f64::from(block) * f64::from(self.periods)) * self.period
    }

    /// Begins the next block if the present one ends before `t` (s).
    fn roll(&mut self, t: f64) {
        if t < self.begin(self.done + 1) || self.settled.is_some() {
            return;
        }
        let block = std::mem::replace(&mut self.now, maxima(self.system, self.ask));
        let extremes = read(&block);
        self.keep(extremes);
        if self.recurrence.has_settled(self.section.states()) {
            self.settled = Some(extremes);
        }
    }

    fn keep(&mut self, block: Extremes) {
        let counts = self.begin(self.done) >= self.from;
        self.unsettled = match self.unsettled {
            Some((all, true)) if block.largest.value <= all.largest.value => Some((all, true)),
            Some((_, true)) => Some((block, true)),
            Some((_, false)) | None => Some((block, counts)),
        };
        self.done += 1;
        if self.beside_from.is_some_and(|from| self.begin(self.done) > from) {
            self.beside = self.beside.max(block.reached);
        }
    }

    /// The extremes of the settled motion, or of all blocks that count.
    pub fn verdict(mut self) -> Extremes {
        let found = match self.settled {
            Some(block) => block,
            None => {
                let last = read(&self.now);
                if last.largest.value.is_finite() {
                    self.keep(last); // the block that the end of the run cut short
                }
                // A run in which no motion was seen has no block.
                let all = self.unsettled.map_or(last, |(all, _)| all);
                Extremes { settled: false, ..all }
            }
        };
        Extremes { reached: self.beside.max(found.reached), ..found }
    }
}

impl Observer<4> for Blocks<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        self.roll(segment.ends()[0].t);
        self.section.segment(segment);
        self.now.segment(segment);
    }
    fn path(&mut self, path: &dyn Path<4>) {
        self.section.path(path);
        self.now.path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.roll(steps.from().t);
        if steps.time(steps.count() - 1) < self.begin(self.done + 1) {
            self.section.steps(steps);
            self.now.steps(steps);
        } else {
            (0..steps.count()).for_each(|number| self.segment(&steps.step(number)));
        }
    }
    fn impact(&mut self, impact: &Impact<4>) {
        self.now.impact(impact);
    }
    fn seam(&mut self) {
        self.now.seam();
    }
    fn satisfied(&self) -> bool {
        self.settled.is_some()
    }
    fn looks(&self) -> u64 {
        self.now.looks()
    }
}
