//! Natural frequencies and mode shapes of a train.
//!
//! All frequencies and then all shapes at once, in lanes. Where frequencies coincide, as in trains with equal branches, or a
//! shape is not good, all shapes are found by rotations, which keep them orthogonal; of the frequencies those are kept that
//! were found first, which shafts of any stiffness leave their digits.

use super::forest::Part;
use super::holzer::Holzer;
use super::{Train, frequencies, rotations, shapes};

/// Frequencies ω \[rad/s\], increasing, and shapes, a row a disc, a column a mode, each with Σ J q² = 1.
#[derive(Clone, Debug)]
pub struct Modes {
    pub omega: Vec<f64>,
    pub shapes: Vec<f64>,
}

/// Closer than this, shapes are made orthogonal to one another: each is off by rounding over that share, within the two.
const CLOSE: f64 = 1e-2;

/// Natural frequencies and mode shapes.
pub fn modes(train: &Train) -> Modes {
    let n = train.len();
    let mut lambda = frequencies::find(&Holzer::new(train)).squares;
    let mut q = vec![0.0; n * n];
    let mut improved = lambda.clone();
    if shapes::shapes(train, &mut improved, &mut q) {
        lambda = improved;
        part_shapes(train, &lambda, &mut q);
    } else {
        rotations::shapes(train, &mut q);
    }
    Modes { omega: lambda.into_iter().map(f64::sqrt).collect(), shapes: q }
}

/// Of a train that may have fallen apart: discs in their own order, frequencies of all parts together.
pub fn modes_of_parts(parts: &[Part]) -> Modes {
    let found: Vec<Modes> = parts.iter().map(|part| modes(&part.train)).collect();
    let n = parts.iter().map(|part| part.discs.len()).sum();
    let mut columns: Vec<(f64, usize, usize)> = Vec::with_capacity(n);
    for (nth, each) in found.iter().enumerate() {
        columns.extend(each.omega.iter().enumerate().map(|(mode, &omega)| (omega, nth, mode)));
    }
    if parts.len() > 1 {
        columns.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    let mut shapes = vec![0.0; n * n];
    for (nth, (part, each)) in parts.iter().zip(&found).enumerate() {
        for (&disc, row) in part.discs.iter().zip(each.shapes.chunks_exact(each.omega.len())) {
            let to = &mut shapes[disc * n..][..n];
            if parts.len() == 1 {
                to.copy_from_slice(row);
                continue;
            }
            for (to, column) in to.iter_mut().zip(&columns).filter(|(_, column)| column.1 == nth) {
                *to = row[column.2];
            }
        }
    }
    Modes { omega: columns.into_iter().map(|column| column.0).collect(), shapes }
}

/// Makes shapes of neighbours that are close orthogonal, each to those before it.
fn part_shapes(train: &Train, lambda: &[f64], q: &mut [f64]) {
    let n = lambda.len();
    for mode in 1..n {
        for other in (0..mode).rev() {
            if lambda[other + 1] - lambda[other] > CLOSE * lambda[other + 1] {
                break;
            }
            let mass: f64 = (0..n).map(|d| train.inertia[d] * q[d * n + mode] * q[d * n + other]).sum();
            (0..n).for_each(|d| q[d * n + mode] -= mass * q[d * n + other]);
        }
    }
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::{forest::Forest, trees};
    use std::f64::consts::PI;

    fn laws(train: &Train, tolerance: f64) {
        let n = train.len();
        let found = modes(train);
        let mut trace: f64 = (0..n).map(|c| train.ground[c] / train.inertia[c]).sum();
        for c in 1..n {
            trace += train.stiffness[c] * (1.0 / train.inertia[c] + 1.0 / train.inertia[train.parent[c]]);
        }
        let sum: f64 = found.omega.iter().map(|w| w * w).sum();
        assert!((sum - trace).abs() <= tolerance * trace, "the sum of squares {sum} is the trace {trace}");
        let column = |mode: usize| found.shapes.iter().skip(mode).step_by(n);
        for i in 0..n {
            for j in 0..n {
                let mass: f64 =
                    column(i).zip(column(j)).zip(&train.inertia).map(|((a, b), J)| J * a * b).sum();
                let wanted = if i == j { 1.0 } else { 0.0 };
                assert!((mass - wanted).abs() < tolerance, "modes {i} and {j}: {mass}");
            }
        }
    }

    #[test]
    fn an_even_chain_has_its_closed_form() {
        for n in [2, 3, 10, 50] {
            let parent: Vec<usize> = (0..n).map(|i: usize| i.saturating_sub(1)).collect();
            let mut stiffness = vec![2.0; n];
            stiffness[0] = 0.0;
            let train = Train::new(&parent, &vec![0.5; n], &stiffness).expect("a chain");
            let found = modes(&train);
            for (m, omega) in found.omega.iter().enumerate() {
                let closed = 2.0 * (2.0f64 / 0.5).sqrt() * (0.5 * PI * m as f64 / n as f64).sin();
                assert!(
                    (omega - closed).abs() < 1e-14 * closed.max(1e-3),
                    "{n} discs, mode {m}: {omega} for {closed}"
                );
            }
            laws(&train, 1e-13);
        }
    }

    #[test]
    fn a_shaft_as_good_as_rigid_leaves_the_others_their_digits() {
        let chain = |stiff: f64| {
            let stiffness = [0.0, 1.0, 3.0, stiff, 2.0, 1.5];
            Train::new(&[0, 0, 1, 2, 3, 4], &[1.0, 0.5, 2.0, 0.3, 0.8, 1.2], &stiffness).expect("a chain")
        };
        let rigid = Train::new(&[0, 0, 1, 2, 3], &[1.0, 0.5, 2.3, 0.8, 1.2], &[0.0, 1.0, 3.0, 2.0, 1.5]);
        let limit = modes(&rigid.expect("a chain")).omega;
        let found = modes(&chain(1e13)).omega;
        for (a, b) in found.iter().zip(&limit) {
            // The limit is approached with k/10¹³.
            assert!((a - b).abs() <= 1e-12 * b, "{a} for {b}");
        }
    }

    #[test]
    fn frequencies_lie_where_the_plain_count_changes() {
        for train in trees::trees() {
            let found = modes(&train);
            for (mode, omega) in found.omega.iter().enumerate().skip(usize::from(train.is_free())) {
                // The count itself is good to some roundings a disc.
                let off = 1e-14;
                let (low, high) = (omega * omega * (1.0 - off), omega * omega * (1.0 + off));
                assert!(
                    trees::below(&train, low) <= mode && mode < trees::below(&train, high),
                    "mode {mode} of {train:?}"
                );
            }
        }
    }

    #[test]
    fn all_discs_are_in_equilibrium() {
        for train in trees::trees() {
            let (n, found) = (train.len(), modes(&train));
            for (mode, omega) in found.omega.iter().enumerate() {
                let q: Vec<f64> = found.shapes.iter().skip(mode).step_by(n).copied().collect();
                let (mut left, mut size) = (vec![0.0; n], 0.0f64);
                for c in 0..n {
                    let (k, p) = (train.stiffness[c], train.parent[c]);
                    let (held, swung) = (train.ground[c] * q[c], omega * omega * train.inertia[c] * q[c]);
                    left[c] += held - swung + k * (q[c] - q[p]);
                    left[p] -= k * (q[c] - q[p]);
                    size = size.max(held.abs()).max(swung.abs()).max(k * (q[c].abs() + q[p].abs()));
                }
                let worst = left.iter().fold(0.0f64, |a, b| a.max(b.abs()));
                assert!(worst <= 1e-14 * n as f64 * size, "mode {mode}: {worst} of {size}, {train:?}");
            }
            laws(&train, 1e-12);
        }
    }

    #[test]
    fn branches_and_supports_keep_the_laws() {
        let uneven = Train::new(
            &[0, 0, 1, 1, 0, 4, 5, 4],
            &[3.0, 0.1, 2.0, 0.03, 1.5, 0.7, 20.0, 0.4],
            &[0.0, 1e3, 4e5, 2e2, 7e3, 9e4, 3e3, 1e4],
        );
        laws(&uneven.expect("a tree"), 1e-13);
        let held = Train::new(&[0, 0, 0], &[1.0, 2.0, 3.0], &[5.0, 7.0, 11.0]).expect("a held tree");
        laws(&held, 1e-13);
        // Three equal branches: two modes of one frequency in which the root stands.
        let star = Train::new(&[0, 0, 0, 0], &[2.0, 1.0, 1.0, 1.0], &[0.0, 8.0, 8.0, 8.0]).expect("a star");
        laws(&star, 1e-13);
        let omega = modes(&star).omega;
        assert!((omega[1] - 8.0f64.sqrt()).abs() < 1e-14 && (omega[2] - omega[1]).abs() < 1e-14, "{omega:?}");
    }

    #[test]
    fn twins_that_hardly_feel_each_other() {
        for coupling in [1e-2, 1e-4, 1e-6, 1e-8] {
            let stiffness = [0.0, 1.0, 1.0, 1.0, coupling, 1.0, 1.0, 1.0];
            let twins = Train::new(&[0, 0, 1, 2, 3, 4, 5, 6], &[1.0; 8], &stiffness).expect("a chain");
            laws(&twins, 1e-13);
        }
    }

    #[test]
    fn parts_are_put_in_order_together() {
        // ω² = k (1/J + 1/J): 0 and 4 of the first and last disc, 0 and 2 of the others.
        let ends = [[0, 3], [1, 2], [2, 3]];
        let Forest::Trees(parts) = Forest::new(&[1.0, 2.0, 2.0, 1.0], &ends, &[2.0, 2.0, 0.0]) else {
            panic!("no trees");
        };
        let found = modes_of_parts(&parts);
        let wanted = [0.0, 0.0, 2f64.sqrt(), 2.0];
        assert!(found.omega.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-15), "{:?}", found.omega);
        let rows: Vec<&[f64]> = found.shapes.chunks_exact(4).collect();
        let at_rest = |mode: usize| rows.iter().map(|row| row[mode] == 0.0).collect::<Vec<_>>();
        assert_eq!(at_rest(0), [false, true, true, false], "the first part as a whole");
        assert_eq!(at_rest(1), [true, false, false, true], "the second part as a whole");
        assert_eq!(at_rest(2), [true, false, false, true], "the second part");
        assert_eq!(at_rest(3), [false, true, true, false], "the first part");
    }

    #[test]
    fn rotations_find_the_same_shapes() {
        for train in trees::trees() {
            let n = train.len();
            let found = modes(&train);
            let mut q = vec![0.0; n * n];
            rotations::shapes(&train, &mut q);
            let gap = |mode: usize| {
                let beside = [mode.wrapping_sub(1), mode + 1];
                let square = |mode: usize| found.omega.get(mode).map(|omega| omega * omega);
                let own = square(mode).unwrap_or(0.0);
                let other = beside.into_iter().filter_map(square).map(|other| (other - own).abs());
                other.fold(f64::INFINITY, f64::min).min(own) / own.max(1e-300)
            };
            for mode in usize::from(train.is_free())..n {
                for disc in 0..n {
                    let (a, b) = (found.shapes[disc * n + mode], q[disc * n + mode]);
                    let off = (a - b).abs() * train.inertia[disc].sqrt() * gap(mode);
                    assert!(off < 1e-11, "mode {mode}, disc {disc}: {a} and {b} of {train:?}");
                }
            }
        }
    }
}
