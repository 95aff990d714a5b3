//! Retune: optim.
