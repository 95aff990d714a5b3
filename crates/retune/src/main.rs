//! Retune: the command line.
fn main() {}
