//! The order conditions of a Runge–Kutta method, one for each rooted tree (J. C. Butcher; Hairer, Nørsett & Wanner, Solving
//! Ordinary Differential Equations I, 2nd ed. 1993, II.2).

/// A rooted tree: its children, each the index of a smaller tree, in falling order.
struct Tree {
    children: Vec<usize>,
    order: usize,
    /// γ, the density: `Σ b Φ = 1/γ` is the condition.
    density: f64,
}

/// All rooted trees with up to `largest` vertices, smallest first: 1, 1, 2, 4, 9, 20, 48, 115 of each size.
fn trees(largest: usize) -> Vec<Tree> {
    let mut all = vec![Tree { children: vec![], order: 1, density: 1.0 }];
    for order in 2..=largest {
        let mut found: Vec<Vec<usize>> = Vec::new();
        forests(&all, order - 1, all.len(), &mut vec![], &mut found);
        for children in found {
            let density = children.iter().map(|&child| all[child].density).product::<f64>() * order as f64;
            all.push(Tree { children, order, density });
        }
    }
    all
}

/// Every multiset of trees with indices below `below` that has `vertices` vertices together.
fn forests(
    all: &[Tree],
    vertices: usize,
    below: usize,
    chosen: &mut Vec<usize>,
    found: &mut Vec<Vec<usize>>,
) {
    if vertices == 0 {
        found.push(chosen.clone());
        return;
    }
    for index in (0..below).filter(|&i| all[i].order <= vertices) {
        chosen.push(index);
        forests(all, vertices - all[index].order, index + 1, chosen, found);
        chosen.pop();
    }
}

/// The worst violation of the conditions `Σ b Φ(t) = θ^|t| / γ(t)` up to `order` by the matrix `a` and the weights `b` at the
/// fraction `theta` of the step: 1 for a solution at its end, 0 for an error estimate.
pub fn worst_violation(a: &[Vec<f64>], order: usize, b: &[f64], theta: f64) -> f64 {
    let all = trees(order);
    let stages = a.len();
    // Φ of each tree at each stage: the product over the children of Σ a Φ(child).
    let mut phi: Vec<Vec<f64>> = Vec::new();
    let mut worst: f64 = 0.0;
    for tree in &all {
        let at: Vec<f64> = (0..stages)
            .map(|i| {
                tree.children
                    .iter()
                    .map(|&child| a[i].iter().zip(&phi[child]).map(|(a, p)| a * p).sum::<f64>())
                    .product()
            })
            .collect();
        let found: f64 = b.iter().zip(&at).map(|(b, p)| b * p).sum();
        worst = worst.max((found - theta.powi(tree.order as i32) / tree.density).abs());
        phi.push(at);
    }
    worst
}

/// How many conditions there are up to an order.
pub fn count(order: usize) -> usize {
    trees(order).len()
}
