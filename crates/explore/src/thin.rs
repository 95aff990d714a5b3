//! Thins the rows of a motion to pixel columns without losing a peak: of each column it keeps the first and the last row, and those
//! where some quantity is largest or smallest.

/// Most rows buffered until their pixel column is complete; then they are thinned early.
const MOST_WAITING: usize = 4096;

/// Rows of `N` quantities over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Thin<const N: usize> {
    /// The times, s.
    pub t: Vec<f64>,
    /// The quantities, each as a column.
    pub columns: [Vec<f64>; N],
}

/// Thins rows as they come.
pub struct Thinning<const N: usize> {
    from: f64,
    width: f64,
    /// The index of the pixel column of `rows`.
    column: f64,
    rows: Vec<(f64, [f64; N])>,
    kept: Thin<N>,
}

impl<const N: usize> Thinning<N> {
    /// For a span of time, s, that is `columns` pixels wide.
    pub fn new([from, to]: [f64; 2], columns: usize) -> Self {
        let kept = Thin { t: Vec::new(), columns: [const { Vec::new() }; N] };
        let width = (to - from) / columns.max(1) as f64;
        Self { from, width, column: 0.0, rows: Vec::new(), kept }
    }

    /// Adds the next row; times must not decrease.
    pub fn push(&mut self, t: f64, row: [f64; N]) {
        let column = ((t - self.from) / self.width).floor();
        if column != self.column {
            self.flush();
            self.column = column;
        }
        if self.rows.len() == MOST_WAITING {
            let kept_rows = self.kept_rows();
            self.rows = kept_rows.into_iter().map(|row| self.rows[row]).collect();
        }
        self.rows.push((t, row));
    }

    /// Returns the rows that are kept.
    pub fn finish(mut self) -> Thin<N> {
        self.flush();
        self.kept
    }

    /// The indices of the rows of this pixel column that are kept.
    fn kept_rows(&self) -> Vec<usize> {
        let Some(last) = self.rows.len().checked_sub(1) else { return Vec::new() };
        let mut kept_rows = vec![0, last];
        for quantity in 0..N {
            let value = |row: &usize| self.rows[*row].1[quantity];
            kept_rows.extend((0..=last).min_by(|a, b| value(a).total_cmp(&value(b))));
            kept_rows.extend((0..=last).max_by(|a, b| value(a).total_cmp(&value(b))));
        }
        kept_rows.sort_unstable();
        kept_rows.dedup();
        kept_rows
    }

    fn flush(&mut self) {
        for (t, row) in self.kept_rows().into_iter().map(|row| self.rows[row]) {
            self.kept.t.push(t);
            self.kept.columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        }
        self.rows.clear();
    }
}

/// The smallest and the largest value of a curve in each pixel column.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    from: f64,
    width: f64,
    /// The smallest and the largest value in each column; infinite where there was none.
    pub ends: Vec<[f64; 2]>,
}

impl Spread {
    /// For a span of time, s, that is `columns` pixels wide.
    pub fn new([from, to]: [f64; 2], columns: usize) -> Self {
        let ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; columns.max(1)];
        Self { from, width: (to - from) / columns.max(1) as f64, ends }
    }

    /// Adds a value.
    pub fn push(&mut self, t: f64, value: f64) {
        let column = ((t - self.from) / self.width).clamp(0.0, (self.ends.len() - 1) as f64) as usize;
        let [least, largest] = &mut self.ends[column];
        (*least, *largest) = (least.min(value), largest.max(value));
    }

    /// The middle of a column, s.
    pub fn at(&self, column: usize) -> f64 {
        self.from + (column as f64 + 0.5) * self.width
    }
}
