//! Numbers side by side, as vector instructions take them.

use wide::f64x4;

/// Flight steps that are computed side by side.
pub const LANES: usize = 4;

/// The lanes shifted by one, with `first` in front.
#[inline(always)]
pub fn shifted(first: f64, lanes: f64x4) -> f64x4 {
    let [a, b, c, _] = lanes.to_array();
    f64x4::from([first, a, b, c])
}

/// An array by its components. Unlike `std::array::from_fn` it is a plain loop, which becomes vector instructions.
#[inline(always)]
pub fn each<const N: usize>(f: impl Fn(usize) -> f64) -> [f64; N] {
    let mut array = [0.0; N];
    for i in 0..N {
        array[i] = f(i);
    }
    array
}
