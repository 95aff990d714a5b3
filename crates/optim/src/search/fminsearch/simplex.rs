//! The geometry of a simplex: n + 1 vertices in n coordinates, sorted from the best value to the worst.

use std::cmp::Ordering;

/// A point and the value of the objective there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Vertex {
    /// Coordinates the simplex moves in: parameters over their scale.
    pub x: Vec<f64>,
    /// The objective: finite, or +∞ where it has no finite value. Never NaN.
    pub value: f64,
}

/// Sorts from best to worst; equal values keep their order, so a new vertex comes after the one it ties with.
pub(super) fn sort(simplex: &mut [Vertex]) {
    simplex.sort_by(|a, b| a.value.partial_cmp(&b.value).unwrap_or(Ordering::Equal));
}

/// The mean of all vertices but the last: (v₁ + … + vₙ) / n.
pub(super) fn centroid(simplex: &[Vertex]) -> Vec<f64> {
    let n = simplex.len() - 1;
    let mean = |j: usize| simplex[..n].iter().map(|vertex| vertex.x[j]).sum::<f64>() / n as f64;
    (0..n).map(mean).collect()
}

/// The point (1 + t)·x̄ − t·w on the line from the worst vertex w through the centroid x̄: beyond x̄ for t > 0.
///
/// With t = ρ, ρχ, ψρ this is MATLAB's reflection, expansion and outside contraction as written there; with t = −ψ
/// it is (1 − ψ)·x̄ + ψ·w, the inside contraction, to the last bit, since signs are exact.
pub(super) fn along(centroid: &[f64], worst: &[f64], t: f64) -> Vec<f64> {
    centroid.iter().zip(worst).map(|(xbar, w)| (1.0 + t) * xbar - t * w).collect()
}

/// The point v₁ + σ·(v − v₁): `x` moved towards the best vertex.
pub(super) fn shrunk(best: &[f64], x: &[f64], sigma: f64) -> Vec<f64> {
    best.iter().zip(x).map(|(v1, v)| v1 + sigma * (v - v1)).collect()
}

/// Whether MATLAB's fminsearch has converged: both max|fᵢ − f₁| ≤ max(TolFun, 10·eps(f₁)) and
/// max|vᵢ − v₁| ≤ max(TolX, 10·eps(max v₁)), over all vertices and coordinates.
pub(super) fn converged(simplex: &[Vertex], tol_x: f64, tol_fun: f64) -> bool {
    let Some((best, others)) = simplex.split_first() else { return false };
    let largest = best.x.iter().copied().fold(f64::NEG_INFINITY, f64::max); // MATLAB's max: signed
    let tol_fun = tol_fun.max(10.0 * eps(best.value));
    let tol_x = tol_x.max(10.0 * eps(largest));
    others.iter().all(|vertex| {
        (vertex.value - best.value).abs() <= tol_fun
            && vertex.x.iter().zip(&best.x).all(|(v, v1)| (v - v1).abs() <= tol_x)
    })
}

/// MATLAB's `eps(x)`: the distance from |x| to the next larger double.
fn eps(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_eps_is_the_spacing_of_doubles() {
        assert_eq!(eps(1.0), f64::EPSILON);
        assert_eq!(eps(-1.5), f64::EPSILON);
        assert_eq!(eps(2.0), 2.0 * f64::EPSILON);
        assert_eq!(eps(2.0_f64.next_down()), f64::EPSILON);
        assert_eq!(eps(0.0), 5e-324);
    }

    fn vertex(x: &[f64], value: f64) -> Vertex {
        Vertex { x: x.to_vec(), value }
    }

    #[test]
    fn contract_converged_needs_both_tolerances() {
        let simplex = |dx: f64, df: f64| [vertex(&[1.0], 3.0), vertex(&[1.0 - dx], 3.0 + df)];
        assert!(converged(&simplex(0.25, 0.5), 0.25, 0.5), "both limits are included");
        assert!(!converged(&simplex(0.26, 0.5), 0.25, 0.5), "too wide");
        assert!(!converged(&simplex(0.25, 0.51), 0.25, 0.5), "too steep");
        assert!(!converged(&simplex(0.0, f64::INFINITY), 0.25, 0.5), "a vertex without a value");
    }

    #[test]
    fn contract_converged_with_zero_tolerances_allows_ten_roundings() {
        let f = 1e6_f64;
        let simplex =
            |roundings: f64| [vertex(&[-8.0, 2.0], f), vertex(&[-8.0, 2.0], f + roundings * eps(f))];
        assert!(converged(&simplex(10.0), 0.0, 0.0));
        assert!(!converged(&simplex(11.0), 0.0, 0.0));
        // The spacing is that of the largest coordinate, 2, not of the largest magnitude, 8.
        let wide = |roundings: f64| [vertex(&[-8.0, 2.0], f), vertex(&[-8.0, 2.0 + roundings * eps(2.0)], f)];
        assert!(converged(&wide(10.0), 0.0, 0.0));
        assert!(!converged(&wide(11.0), 0.0, 0.0));
    }

    #[test]
    fn exact_inside_contraction_is_matlabs_formula_to_the_last_bit() {
        let (psi, xbar, w) = (0.5, 0.1, 0.7);
        assert_eq!(along(&[xbar], &[w], -psi), [(1.0 - psi) * xbar + psi * w]);
    }

    #[test]
    fn exact_shrink_is_matlabs_formula_to_the_last_bit() {
        assert_eq!(shrunk(&[0.1], &[0.7], 0.5), [0.4]);
        assert_ne!(0.5 * 0.1 + 0.5 * 0.7, 0.4, "the same point written otherwise");
    }

    #[test]
    fn contract_ties_keep_their_order() {
        let mut simplex =
            vec![vertex(&[1.0], 2.0), vertex(&[2.0], 0.0), vertex(&[3.0], -0.0), vertex(&[4.0], 0.0)];
        sort(&mut simplex);
        let order: Vec<f64> = simplex.iter().map(|vertex| vertex.x[0]).collect();
        assert_eq!(order, [2.0, 3.0, 4.0, 1.0]);
    }
}
