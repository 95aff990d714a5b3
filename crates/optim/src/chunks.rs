//! Parallel evaluation with early stopping whose result does not depend on the number of threads.

use rayon::prelude::*;

/// Evaluations in one group: enough for the cores of a workstation, few enough that stopping early saves most of the rest.
pub(crate) const TOGETHER: usize = 8;

/// Evaluates `value(i, before)` for `i` in `0..count`, in parallel in groups of 1, 2, 4 … and at most `together`; `before` are the
/// results of earlier groups. Ends early, after a whole group, once `enough` is true for the results so far.
pub(crate) fn in_groups<T: Send + Sync>(
    count: usize,
    together: usize,
    value: &(dyn Fn(usize, &[T]) -> T + Sync),
    enough: &dyn Fn(&[T]) -> bool,
) -> Vec<T> {
    let mut results: Vec<T> = Vec::with_capacity(count);
    while results.len() < count && (results.is_empty() || !enough(&results)) {
        let size = (results.len() + 1).min(together.max(1));
        let group = results.len()..count.min(results.len() + size);
        let before = &results;
        let fresh: Vec<T> = group.into_par_iter().map(|i| value(i, before)).collect();
        results.extend(fresh);
    }
    results
}
