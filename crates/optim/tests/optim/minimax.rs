//! The least of the largest of several functions, on problems with known solutions.

use retune_optim::{Height, Piece, Scale, Side, Space, minimax};

fn square(from: f64, to: f64) -> Space {
    Space(vec![Side { from, to, scale: Scale::Linear }; 2])
}

/// Madsen's first example is the largest of three functions (J. Charalambous and A. R. Conn, An efficient method to solve the minimax
/// problem directly, SIAM J. Numer. Anal. 15, 1978, problem CB2): 1.952224 at (1.139038, 0.899560).
#[test]
fn reference_charalambous_conn() {
    let all = |x: &[f64]| {
        let (a, b) = (x[0], x[1]);
        let e = 2.0 * (b - a).exp();
        [
            (a * a + b.powi(4), vec![2.0 * a, 4.0 * b.powi(3)]),
            ((2.0 - a).powi(2) + (2.0 - b).powi(2), vec![2.0 * a - 4.0, 2.0 * b - 4.0]),
            (e, vec![-e, e]),
        ]
    };
    let worst = |x: &[f64]| all(x).iter().map(|(value, _)| *value).fold(0.0, f64::max);
    let evaluate = |x: &[f64], _: f64| (Height { worst: worst(x), violation: 0.0 }, ());
    let pieces =
        |x: &[f64], (): &()| all(x).map(|(value, slope)| Piece { is_limit: false, value, slope }).to_vec();
    let (x, found) = minimax(evaluate, pieces, &square(-3.0, 3.0), &[1.0, -0.1], 1e-8);
    assert!((found.worst - 1.952_224_49).abs() < 1e-6, "{found:?}");
    assert!((x[0] - 1.139_038).abs() < 1e-3 && (x[1] - 0.899_560).abs() < 1e-3, "{x:?}");
}

/// The least of x + y with x y >= 1, from a point that breaks it: 2 at (1, 1).
#[test]
fn exact_limits_are_kept_where_they_can_be() {
    let broken = |x: &[f64]| 1.0 - x[0] * x[1];
    let evaluate = |x: &[f64], _: f64| (Height { worst: x[0] + x[1], violation: broken(x).max(0.0) }, ());
    let pieces = |x: &[f64], (): &()| {
        vec![
            Piece { is_limit: false, value: x[0] + x[1], slope: vec![1.0, 1.0] },
            Piece { is_limit: true, value: broken(x), slope: vec![-x[1], -x[0]] },
        ]
    };
    let (_, found) = minimax(evaluate, pieces, &square(0.1, 4.0), &[0.5, 0.7], 1e-8);
    assert!(found.violation == 0.0 && (found.worst - 2.0).abs() < 1e-4, "{found:?}");
}
