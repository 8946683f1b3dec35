//! All modes of a train by rotations, for trains whose frequencies coincide.
//!
//! The shafts are columns √(k/J) of a matrix H with K = J^(1/2) H Hᵀ J^(1/2). Rotating its columns in pairs until all
//! are orthogonal leaves J^(1/2) q ω as columns. Shafts of whatever stiffness keep their digits: a stiff one only makes its
//! column long.
//!
//! Source: Demmel, Veselić, *Jacobi's method is more accurate than QR*, SIAM J. Matrix Anal. Appl. 13 (1992) 1204–1245;
//! de Rijk, *A one-sided Jacobi algorithm*, SIAM J. Sci. Stat. Comput. 10 (1989) 359–371.

use super::Train;
use linkwright_kernel::call::poll;

/// Sweeps over all pairs at most; ten are usual.
const SWEEPS: usize = 40;

/// Columns shorter than this share of the longest have no direction: a train held in several places has more shafts than discs.
const NOTHING: f64 = 1e-30;

/// Shapes, a row a disc, a column a mode, increasing in frequency, each with Σ J q² = 1.
pub fn shapes(train: &Train, to: &mut [f64]) {
    let n = train.len();
    let mut columns = columns(train);
    for _ in 0..SWEEPS {
        if !rotate_all(&mut columns) {
            break;
        }
    }
    let mut lengths: Vec<(f64, usize)> =
        columns.iter().enumerate().map(|(nth, column)| (dot(column, column), nth)).collect();
    lengths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let free = usize::from(train.is_free());
    if train.is_free() {
        let whole = 1.0 / train.inertia.iter().sum::<f64>().sqrt();
        to.iter_mut().step_by(n).for_each(|q| *q = whole);
    }
    let longest = &lengths[lengths.len() + free - n..];
    for (mode, &(square, nth)) in longest.iter().enumerate() {
        let column = &columns[nth];
        let largest = column.iter().zip(&train.inertia).map(|(h, J)| h / J.sqrt()).fold(0.0f64, larger);
        let factor = (1.0 / square.sqrt()).copysign(largest);
        for (disc, h) in column.iter().enumerate() {
            to[disc * n + mode + free] = h * factor / train.inertia[disc].sqrt();
        }
    }
}

fn larger(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}

/// A column for every shaft, also for those to the ground.
fn columns(train: &Train) -> Vec<Vec<f64>> {
    let n = train.len();
    let column = |ends: &[(usize, f64)], k: f64| {
        let mut column = vec![0.0; n];
        for &(disc, sign) in ends {
            column[disc] = sign * (k / train.inertia[disc]).sqrt();
        }
        column
    };
    let shafts = (1..n).map(|c| column(&[(c, 1.0), (train.parent[c], -1.0)], train.stiffness[c]));
    let held = (0..n).filter(|&c| train.ground[c] > 0.0).map(|c| column(&[(c, 1.0)], train.ground[c]));
    shafts.chain(held).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// One sweep of rotations over all pairs; whether any was needed.
fn rotate_all(columns: &mut [Vec<f64>]) -> bool {
    let longest = columns.iter().map(|column| dot(column, column)).fold(0.0, f64::max);
    let mut rotated = false;
    for q in 1..columns.len() {
        poll();
        let (before, rest) = columns.split_at_mut(q);
        let b = &mut rest[0];
        for a in before {
            let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
            if ab.abs() <= f64::EPSILON * (aa * bb).sqrt() || aa.min(bb) <= NOTHING * longest {
                continue;
            }
            rotated = true;
            let theta = (bb - aa) / (2.0 * ab);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            for (x, y) in a.iter_mut().zip(b.iter_mut()) {
                (*x, *y) = (c * (*x - t * *y), c * (t * *x + *y));
            }
        }
    }
    rotated
}
