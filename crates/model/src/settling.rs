//! How fast transients decay.

use crate::{Bare, Coupled, Scene};
use nalgebra::Complex;

/// Share of the fastest rate below which an eigenvalue counts as zero: a damper without a spring has a neutral position.
const STILL: f64 = 1e-9;

impl Scene {
    /// The rate at which the slowest transient decays without contact, 1/s; 0 where one is undamped. After `t` seconds the share
    /// `exp(-rate t)` of its start is left.
    pub fn slowest_decay(&self) -> f64 {
        match &self.damper {
            None => slowest(
                Bare::new(&self.primary, &self.forcing).linear_part().0.complex_eigenvalues().as_slice(),
            ),
            Some(damper) => {
                let coupled = Coupled::new(&self.primary, &self.forcing, damper);
                slowest(coupled.linear_part().0.complex_eigenvalues().as_slice())
            }
        }
    }
}

fn slowest(eigenvalues: &[Complex<f64>]) -> f64 {
    let fastest = eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let moving = eigenvalues.iter().filter(|value| value.norm() > STILL * fastest);
    // Rounding is not damping.
    moving
        .map(|value| if -value.re > STILL * fastest { -value.re } else { 0.0 })
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Damper, Forcing, NonNegative, Positive, Primary};

    fn scene([m1, c1, k1]: [f64; 3], damper: Option<[f64; 3]>) -> Scene {
        let (positive, number) = (
            |value| Positive::new(value).expect("above 0"),
            |value| NonNegative::new(value).expect("not below 0"),
        );
        let zero = NonNegative::default();
        let damper = damper.map(|[m2, c2, k2]| Damper {
            mass: positive(m2),
            stiffness: number(k2),
            damping: number(c2),
            rest_distance: zero,
            clearance: zero,
            contact: None,
        });
        let primary = Primary { mass: positive(m1), damping: number(c1), stiffness: number(k1) };
        Scene { primary, forcing: Forcing::force(number(1.0), number(1.0)), damper }
    }

    #[test]
    fn exact_the_slowest_decay_is_that_of_the_slowest_mode() {
        let near = |found: f64, expected: f64| {
            assert!((found - expected).abs() < 1e-12 * expected, "{found} {expected}")
        };
        near(scene([1000.0, 452.0, 39500.0], None).slowest_decay(), 0.226); // c1 / (2 m1)
        near(scene([1.0, 3.0, 2.0], None).slowest_decay(), 1.0); // λ² + 3 λ + 2: the slower of -1 and -2
        assert_eq!(scene([1.0, 0.0, 2.0], None).slowest_decay(), 0.0);
        assert_eq!(scene([1.0, 0.0, 2.0], Some([1.0, 0.0, 1.0])).slowest_decay(), 0.0);
        // Equal masses, springs and dashpots: λ² + z λ + z = 0 with z = (3 ± √5) / 2, the roots of z² - 3 z + 1.
        let z = 0.5 * (3.0 - 5f64.sqrt());
        near(scene([1.0, 1.0, 1.0], Some([1.0, 1.0, 1.0])).slowest_decay(), 0.5 * z);
        // A damper without a spring has a neutral position, which is not a transient.
        let free = scene([1000.0, 452.0, 39500.0], Some([1.0, 1.0, 0.0])).slowest_decay();
        assert!(free > 0.2, "{free}");
    }
}
