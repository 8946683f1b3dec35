//! Error of a solution in every step, from the defect of its quintics.
//!
//! The quintic p of a step satisfies the equation at the stages. Between them p′ − f(p) is in proportion to Π(θ − c_i), and so the
//! quintic is off by h d ∫Π/Π(θ*) where the defect d was taken. What stiff parts hold back is taken out by (1 − h γ ∂f)⁻¹, with γ
//! of the method, as Hairer and Wanner do (*Solving Ordinary Differential Equations II*, IV.8).

use crate::elimination::solve;
use crate::equation::{Equation, Rates};
use crate::mesh::{Mesh, Rows, Solution};
use linkwright_kernel::radau::{C, S, slope_and_bend, value};

/// Shares of a step at which the defect is taken, far from the stages.
pub(crate) const WATCHED: [f64; 2] = [0.43, 0.73];

/// The largest error of a quintic over h times the defect at the places watched: max |∫Π| / |Π(θ*)|.
pub(crate) const ERROR_OF_DEFECT: [f64; 2] = error_of_defect();

/// The real eigenvalue of the weights of the method.
pub(crate) const GAMMA: f64 = 1.0 / 6.286_704_751_729_317;

const fn product(at: f64) -> f64 {
    let (mut product, mut i) = (1.0, 0);
    while i < S {
        product *= at - C[i];
        i += 1;
    }
    product
}

const fn error_of_defect() -> [f64; 2] {
    let (mut sum, mut largest, mut i) = (0.0_f64, 0.0_f64, 0);
    while i < 400 {
        sum += product((i as f64 + 0.5) / 400.0) / 400.0;
        largest = largest.max(sum.abs());
        i += 1;
    }
    [largest / product(WATCHED[0]).abs(), largest / product(WATCHED[1]).abs()]
}

/// Error of the solution in every step, the largest over the scale of each number of the state.
pub fn errors(equation: &Equation<'_>, mesh: &Mesh, solution: &Solution, scale: &[f64]) -> Vec<f64> {
    let m = solution.states();
    let places = mesh.edges.windows(2).flat_map(|pair| WATCHED.map(|at| pair[0] + at * (pair[1] - pair[0])));
    let rows = Rows::at(equation, &places.collect::<Vec<f64>>());
    let mut rates = Rates::new(equation.chain);
    let (mut y, mut table) = (vec![0.0; m], vec![0.0; m * (m + 1)]);
    let mut found = Vec::with_capacity(mesh.steps());
    for k in 0..mesh.steps() {
        let (h, mut worst) = (mesh.length(k), 0.0_f64);
        let quintics: Vec<_> = (0..m).map(|number| solution.quintic(k, number)).collect();
        for (w, at) in WATCHED.into_iter().enumerate() {
            for (y, quintic) in y.iter_mut().zip(&quintics) {
                *y = value(quintic, at);
            }
            equation.rates(&rows.row(k * WATCHED.len() + w), &y, &mut rates);
            for r in 0..m {
                let defect = slope_and_bend(&quintics[r], at).0 - h * rates.rate[r];
                let row = &mut table[r * (m + 1)..][..m + 1];
                for c in 0..m {
                    row[c] = f64::from(u8::from(r == c)) - h * GAMMA * rates.jacobian[r * m + c];
                }
                row[m] = defect * ERROR_OF_DEFECT[w];
            }
            solve(&mut table, m, 1);
            for r in 0..m {
                let error = table[r * (m + 1) + m].abs() / scale[r];
                // What is no number is not lost.
                worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
            }
        }
        found.push(worst);
    }
    found
}
