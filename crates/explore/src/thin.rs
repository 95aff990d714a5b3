//! Rows of a motion thinned to the columns of pixels that show them. Every peak stays: of the rows in a column of pixels those remain at
//! which some quantity is largest or smallest, and the first and the last.

/// Rows that wait until their column of pixels is whole.
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
    /// The number of the column of pixels that `rows` belong to.
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

    /// The next row; times do not fall.
    pub fn push(&mut self, t: f64, row: [f64; N]) {
        let column = ((t - self.from) / self.width).floor();
        if column != self.column {
            self.keep();
            self.column = column;
        }
        if self.rows.len() == MOST_WAITING {
            let stays = self.stays();
            self.rows = stays.into_iter().map(|row| self.rows[row]).collect();
        }
        self.rows.push((t, row));
    }

    /// What remains.
    pub fn finish(mut self) -> Thin<N> {
        self.keep();
        self.kept
    }

    /// The rows of this column of pixels that stay.
    fn stays(&self) -> Vec<usize> {
        let Some(last) = self.rows.len().checked_sub(1) else { return Vec::new() };
        let mut stays = vec![0, last];
        for quantity in 0..N {
            let value = |row: &usize| self.rows[*row].1[quantity];
            stays.extend((0..=last).min_by(|a, b| value(a).total_cmp(&value(b))));
            stays.extend((0..=last).max_by(|a, b| value(a).total_cmp(&value(b))));
        }
        stays.sort_unstable();
        stays.dedup();
        stays
    }

    fn keep(&mut self) {
        for (t, row) in self.stays().into_iter().map(|row| self.rows[row]) {
            self.kept.t.push(t);
            self.kept.columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        }
        self.rows.clear();
    }
}

/// The least and the largest of several curves in each column of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    from: f64,
    width: f64,
    /// The least and the largest value in each column; infinite where there was none.
    pub ends: Vec<[f64; 2]>,
}

impl Spread {
    /// For a span of time, s, that is `columns` pixels wide.
    pub fn new([from, to]: [f64; 2], columns: usize) -> Self {
        let ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; columns.max(1)];
        Self { from, width: (to - from) / columns.max(1) as f64, ends }
    }

    /// Another value.
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
