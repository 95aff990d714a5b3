//! Hertz's quasi-static contact law: force against indentation, `F = K z^(3/2)` for `z > 0`.

use std::f64::consts::PI;

/// Hertz stiffness of a sphere of radius `radius` (m) on a plane, N/m^1.5 (the paper's section 2):
///
/// `K = (4/3) q / ((δa + δb) √(A + B))` with `δ = (1 - ν²) / (πE)` and `A = B = 1/(2R)`.
///
/// `surfaces` holds `(E, ν)` of the two bodies, E in N/m². With `q = 1/π` this is the textbook `(4/3) E* √R`
/// (K. L. Johnson, Contact Mechanics, 1985, p. 93).
pub fn hertz_stiffness(q: f64, radius: f64, surfaces: [(f64, f64); 2]) -> f64 {
    let delta = |(young, poisson): (f64, f64)| (1.0 - poisson * poisson) / (PI * young);
    let curvature = 1.0 / radius; // A + B
    4.0 / 3.0 * q / ((delta(surfaces[0]) + delta(surfaces[1])) * curvature.sqrt())
}

/// Contact force `H(z) K z^(3/2)`, N; `z` (m) is the indentation, zero or negative where the bodies do not touch.
#[inline]
pub fn hertz_force(stiffness: f64, z: f64) -> f64 {
    if z > 0.0 { stiffness * z * z.sqrt() } else { 0.0 }
}

/// `dF/dz = (3/2) K √z`, N/m; zero where the bodies do not touch.
#[inline]
pub fn hertz_force_slope(stiffness: f64, z: f64) -> f64 {
    if z > 0.0 { 1.5 * stiffness * z.sqrt() } else { 0.0 }
}

/// `d²F/dz² = (3/4) K / √z`, N/m²; zero where the bodies do not touch, and unbounded towards first touch.
#[inline]
pub fn hertz_force_curvature(stiffness: f64, z: f64) -> f64 {
    if z > 0.0 { 0.75 * stiffness / z.sqrt() } else { 0.0 }
}

/// Elastic energy stored in the contact, `(2/5) K z^(5/2)`, J.
#[inline]
pub fn hertz_energy(stiffness: f64, z: f64) -> f64 {
    0.4 * z * hertz_force(stiffness, z)
}

/// Largest pressure of the contact of a sphere of radius `radius` (m) with a plane at the indentation `z` (m), in the middle of the contact
/// area, N/m²: `3 F / (2 π a²)` with `a² = R z` (Johnson, p. 92), `(3 / (2π)) K √z / R`.
#[inline]
pub fn hertz_pressure(stiffness: f64, radius: f64, z: f64) -> f64 {
    if z > 0.0 { 1.5 / PI * stiffness * z.sqrt() / radius } else { 0.0 }
}

/// Pressure in the middle of a contact area, as a multiple of the yield strength, from which on the softer body yields, first below the surface.
///
/// K. L. Johnson, Contact Mechanics, 1985, section 6.1, for a Poisson's ratio of 0.3. On the axis two principal stresses are equal, so the
/// criteria of Tresca and von Mises agree.
pub const HERTZ_YIELD: f64 = 1.6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_stiffness_is_the_textbook_sphere_on_plane() {
        let surfaces = [(2.1e11, 0.3), (2.21e7, 0.4)];
        let e_star = 1.0 / surfaces.iter().map(|(e, nu)| (1.0 - nu * nu) / e).sum::<f64>();
        let expected = 4.0 / 3.0 * e_star * 2.0_f64.sqrt();
        let k = hertz_stiffness(1.0 / PI, 2.0, surfaces);
        assert!((k / expected - 1.0).abs() < 1e-14, "{k} {expected}");
    }

    /// Johnson's `p0 = (2 E*/π) √(z/R)`, and the force as the integral of the pressure `p0 √(1 - r²/a²)` over the contact area.
    #[test]
    fn exact_pressure_carries_the_force() {
        let (modulus, radius, z) = (2e7, 0.05, 3e-4);
        let k = 4.0 / 3.0 * modulus * f64::sqrt(radius);
        let pressure = hertz_pressure(k, radius, z);
        assert!((pressure / (2.0 / PI * modulus * (z / radius).sqrt()) - 1.0).abs() < 1e-14);
        let carried = 2.0 / 3.0 * PI * radius * z * pressure;
        assert!((carried / hertz_force(k, z) - 1.0).abs() < 1e-14);
        assert_eq!(hertz_pressure(k, radius, -z), 0.0);
    }

    /// The stresses on the axis at the depth ζ a below the middle of the area, as shares of p0 (Johnson, equation 3.45): their largest
    /// difference is the yield strength.
    #[test]
    fn exact_yield_begins_where_the_stresses_below_the_surface_differ_most() {
        let difference = |depth: f64| {
            let axial = 1.0 / (1.0 + depth * depth);
            let radial = (1.0 + 0.3) * (1.0 - depth * (1.0 / depth).atan()) - 0.5 * axial;
            axial - radial
        };
        let (most, depth) = (1..4000)
            .map(|i| 5e-4 * f64::from(i))
            .map(|depth| (difference(depth), depth))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .expect("depths");
        assert!((depth - 0.48).abs() < 0.005, "Johnson: z = 0.48 a; {depth}");
        assert!((1.0 / most / HERTZ_YIELD - 1.0).abs() < 0.01, "{}", 1.0 / most);
    }

    #[test]
    fn exact_energy_and_slope_are_the_integral_and_derivative_of_the_force() {
        let (k, z, h) = (5e7, 3e-3, 1e-7);
        let slope = (hertz_force(k, z + h) - hertz_force(k, z - h)) / (2.0 * h);
        assert!((slope / hertz_force_slope(k, z) - 1.0).abs() < 1e-8);
        let force = (hertz_energy(k, z + h) - hertz_energy(k, z - h)) / (2.0 * h);
        assert!((force / hertz_force(k, z) - 1.0).abs() < 1e-8);
        let curvature = (hertz_force_slope(k, z + h) - hertz_force_slope(k, z - h)) / (2.0 * h);
        assert!((curvature / hertz_force_curvature(k, z) - 1.0).abs() < 1e-8);
        let law = [hertz_force, hertz_force_slope, hertz_force_curvature, hertz_energy];
        assert_eq!(law.map(|law| law(k, -z)), [0.0; 4]);
    }
}
