//! Den Hartog's tuned mass damper: the classical first guess.

use crate::Primary;

/// Den Hartog's optimum for the displacement of an undamped structure under a harmonic force: `[k2, c2]`, N/m and N·s/m, of a damper of
/// `mass` (kg). With `μ = m2/m1` and `ω2 = √(k1/m1) / (1 + μ)` they are `k2 = m2 ω2²` and `c2 = 2 m2 ω2 √(3μ / (8 (1 + μ)))`.
///
/// J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 3.3.
pub fn den_hartog(primary: &Primary, mass: f64) -> [f64; 2] {
    let ratio = mass / primary.mass.get();
    let frequency = primary.natural_frequency() / (1.0 + ratio);
    let zeta = (3.0 * ratio / (8.0 * (1.0 + ratio))).sqrt();
    [mass * frequency * frequency, 2.0 * mass * frequency * zeta]
}
