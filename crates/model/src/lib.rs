//! Retune: model.
