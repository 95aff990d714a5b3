//! A run in blocks of some periods of the force.

use crate::extremes::{Also, Ask, Extremes, Maxima, maxima, read_maxima};
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
    /// What to compute in each block.
    ask: Ask,
    /// Of the force, s.
    period: f64,
    periods: u32,
    /// Blocks that begin at this time or later count even if the motion does not settle, s.
    from: f64,
    /// Additional measures count in blocks that end after this time, s; `None` if there are none.
    additional_from: Option<f64>,
    section: PoincareSection,
    recurrence: Recurrence<'a>,
    current: Maxima<'a>,
    finished: u32,
    /// The largest values of the additional measures in the blocks that count.
    additional: PerMeasure<f64>,
    /// The last block of a motion that has settled.
    settled: Option<Extremes>,
    /// The extremes while the motion has not settled, and whether they are those of blocks that count.
    unsettled: Option<(Extremes, bool)>,
}

impl<'a> Blocks<'a> {
    /// Blocks from t = 0 on; those that begin at `from` (s) or later count even if the motion does not settle.
    pub fn new(system: &'a Coupled, from: f64, settle: Settle, settings: &Settings, ask: Ask) -> Self {
        let period = TAU / system.bare().frequency();
        let additional_from = ask.also.map(|also| also.from);
        let also = ask.also.map(|also| Also { from: 0.0, ..also });
        let ask = Ask { also, cutoff: f64::INFINITY, ..ask };
        Self {
            system,
            ask,
            period,
            periods: settle.periods,
            from,
            additional_from,
            section: PoincareSection::new(period, settle.periods as usize * settle.blocks as usize),
            recurrence: Recurrence::new(system, settle, settings),
            current: maxima(system, ask),
            finished: 0,
            additional: PerMeasure::default(),
            settled: None,
            unsettled: None,
        }
    }

    /// When a block begins, s.
    fn begin(&self, block: u32) -> f64 {
        (f64::from(block) * f64::from(self.periods)) * self.period
    }

    /// Begins the next block if the present one ends before `t` (s).
    fn finish_block_before(&mut self, t: f64) {
        if t < self.begin(self.finished + 1) || self.settled.is_some() {
            return;
        }
        let block = std::mem::replace(&mut self.current, maxima(self.system, self.ask));
        let extremes = read_maxima(&block);
        self.record_block(extremes);
        if self.recurrence.has_settled(self.section.states()) {
            self.settled = Some(extremes);
        }
    }

    fn record_block(&mut self, block: Extremes) {
        let counts = self.begin(self.finished) >= self.from;
        self.unsettled = match self.unsettled {
            Some((all, true)) if block.largest.value <= all.largest.value => Some((all, true)),
            Some((_, true)) => Some((block, true)),
            Some((_, false)) | None => Some((block, counts)),
        };
        self.finished += 1;
        if self.additional_from.is_some_and(|from| self.begin(self.finished) > from) {
            self.additional = self.additional.max(block.reached);
        }
    }

    /// The extremes of the settled motion, or of all blocks that count.
    pub fn result(mut self) -> Extremes {
        let found = match self.settled {
            Some(block) => block,
            None => {
                let last = read_maxima(&self.current);
                if last.largest.value.is_finite() {
                    self.record_block(last); // the block that the end of the run cut short
                }
                // A run in which no motion was seen has no block.
                let all = self.unsettled.map_or(last, |(all, _)| all);
                Extremes { settled: false, ..all }
            }
        };
        Extremes { reached: self.additional.max(found.reached), ..found }
    }
}

impl Observer<4> for Blocks<'_> {
    fn segment(&mut self, segment: &dyn Segment<4>) {
        self.finish_block_before(segment.ends()[0].t);
        self.section.segment(segment);
        self.current.segment(segment);
    }
    fn path(&mut self, path: &dyn Path<4>) {
        self.section.path(path);
        self.current.path(path);
    }
    fn steps(&mut self, steps: &Steps<'_, 4>) {
        self.finish_block_before(steps.from().t);
        if steps.time(steps.count() - 1) < self.begin(self.finished + 1) {
            self.section.steps(steps);
            self.current.steps(steps);
        } else {
            (0..steps.count()).for_each(|number| self.segment(&steps.step(number)));
        }
    }
    fn impact(&mut self, impact: &Impact<4>) {
        self.current.impact(impact);
    }
    fn discontinuity(&mut self) {
        self.current.discontinuity();
    }
    fn satisfied(&self) -> bool {
        self.settled.is_some()
    }
    fn search_work(&self) -> u64 {
        self.current.search_work()
    }
}
