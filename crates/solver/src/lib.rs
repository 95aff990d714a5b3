//! Retune: solver.
