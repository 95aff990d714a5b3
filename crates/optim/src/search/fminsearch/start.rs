//! The steps of the initial simplex.

use super::options::Bounds;

/// Step along a coordinate, relative to it.
const STEP: f64 = 0.05;
/// Step along a coordinate that is zero.
const STEP_AT_ZERO: f64 = 0.00025;

/// Coordinate `x` of the start moved for its vertex of the initial simplex: to (1 + 0.05) x, or to 0.00025 if it is
/// zero. If that is outside `bounds` (on the parameter `x · scale`) it steps the other way; if both are outside,
/// halfway to the farther bound.
pub(super) fn stepped(x: f64, scale: f64, bounds: Bounds) -> f64 {
    let (there, back) =
        if x == 0.0 { (STEP_AT_ZERO, -STEP_AT_ZERO) } else { ((1.0 + STEP) * x, (1.0 - STEP) * x) };
    match bounds {
        _ if bounds.contain(there * scale) => there,
        Bounds { lower: Some(lower), upper: Some(upper) } if !bounds.contain(back * scale) => {
            let parameter = x * scale;
            let farther = if upper - parameter >= parameter - lower { upper } else { lower };
            (parameter + 0.5 * (farther - parameter)) / scale
        }
        _ => back,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_five_percent_or_matlabs_step_at_zero() {
        let free = Bounds::default();
        assert_eq!(stepped(215.0, 1.0, free), 225.75);
        assert_eq!(stepped(-2.0, 1.0, free), -2.1);
        assert_eq!(stepped(0.0, 1.0, free), 0.00025);
    }

    #[test]
    fn contract_steps_inward_at_a_bound() {
        let below = |upper| Bounds { lower: None, upper: Some(upper) };
        assert_eq!(stepped(100.0, 1.0, below(105.0)), 105.0, "the bound itself is allowed");
        assert_eq!(stepped(100.0, 1.0, below(104.0)), 95.0);
        assert_eq!(stepped(0.0, 1.0, below(0.0)), -0.00025);
        assert_eq!(stepped(-100.0, 1.0, Bounds { lower: Some(-100.0), upper: None }), -95.0);
        assert_eq!(stepped(1.0, 100.0, below(104.0)), 0.95, "bounds are on the parameter");
    }

    #[test]
    fn contract_halves_the_way_in_a_box_narrower_than_the_step() {
        assert_eq!(stepped(100.0, 1.0, Bounds::between(99.0, 102.0)), 101.0);
        assert_eq!(stepped(100.0, 1.0, Bounds::between(96.0, 102.0)), 98.0);
        assert_eq!(stepped(-1.0, 100.0, Bounds::between(-100.0, -98.0)), -0.99);
    }
}
