//! Trains for tests: trees of parts that differ by up to six orders, and the plain count of what lies below.

use super::Train;

/// Chains and branched trees, free and held.
pub(super) fn trees() -> impl Iterator<Item = Train> {
    let mut state = 7u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..300).map(move |nth| {
        let n = 1 + nth % 40;
        let spread = 1.0 + 5.0 * random();
        let mut number = || 10f64.powf(spread * (random() - 0.5));
        let parent: Vec<usize> =
            (0..n).map(|c: usize| c.saturating_sub(1 + (3.0 * number()) as usize % 4)).collect();
        let (inertia, mut stiffness): (Vec<f64>, Vec<f64>) = (0..n).map(|_| (number(), number())).unzip();
        if nth % 3 > 0 {
            stiffness[0] = 0.0;
        }
        Train::new(&parent, &inertia, &stiffness).expect("a tree")
    })
}

/// How many λ lie below: negative pivots, by divisions.
pub(super) fn below(train: &Train, lambda: f64) -> usize {
    let mut x: Vec<f64> = train.inertia.iter().zip(&train.ground).map(|(J, k)| k - lambda * J).collect();
    let mut count = 0;
    for c in (1..train.len()).rev() {
        let pivot = train.stiffness[c] + x[c];
        count += usize::from(pivot < 0.0);
        x[train.parent[c]] += train.stiffness[c] * x[c] / pivot;
    }
    count + usize::from(x[0] < 0.0)
}
