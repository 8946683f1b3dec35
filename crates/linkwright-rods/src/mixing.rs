//! Fewer sweeps to a fixed point: the next state is that of the combination of the last ones whose changes cancel best.
//!
//! Source: Walker and Ni, "Anderson acceleration for fixed-point iterations", *SIAM J. Numer. Anal.* 49 (2011) 1715. Each lane has
//! coefficients of its own. Numbers that carry derivatives take plain steps: these converge as fast as the sweeps do.

use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;

/// Steps that are remembered.
const MEMORY: usize = 6;

/// Share of a change that is taken up.
const RELAXED: f64 = 0.8;

/// Pivot below which a step says nothing that others do not, of columns of length 1.
const DEPENDENT: f64 = 1e-10;

/// Growth of the square of the change after which a plain step is taken.
const GROWN: f64 = 4.0;

/// The last steps.
pub struct Mixing<R> {
    steps: Vec<[Vec<R>; 2]>,
    /// State and change before, and the square of that change.
    before: [Vec<R>; 2],
    square: R,
    products: [[R; MEMORY]; MEMORY],
    count: usize,
}

impl<R: Real> Mixing<R> {
    /// None yet, of states of n numbers.
    pub fn new(n: usize) -> Self {
        let list = || [vec![R::splat(0.0); n], vec![R::splat(0.0); n]];
        let memory = if R::IS_DUAL { 0 } else { MEMORY };
        Mixing {
            steps: (0..memory).map(|_| list()).collect(),
            before: list(),
            square: R::splat(f64::INFINITY),
            products: [[R::splat(0.0); MEMORY]; MEMORY],
            count: 0,
        }
    }

    /// Moves a state, of which the sweep made `next`.
    #[inline(always)]
    pub fn advance(&mut self, state: &mut [R], next: &mut [R]) {
        out_of_line!(R, {
            for (next, &state) in next.iter_mut().zip(&*state) {
                *next = *next - state;
            }
            let change = next;
            if !R::IS_DUAL {
                self.remember(state, change);
                self.before[0].copy_from_slice(state);
                self.before[1].copy_from_slice(change);
            }
            for (state, &change) in state.iter_mut().zip(&*change) {
                *state = *state + change * RELAXED;
            }
            if !R::IS_DUAL {
                self.combine(state, change);
                self.count += 1;
            }
        });
    }

    /// Takes up the step that led here.
    #[inline(always)]
    fn remember(&mut self, state: &[R], change: &[R]) {
        if self.count == 0 {
            return;
        }
        let place = (self.count - 1) % MEMORY;
        let [moved, changed] = &mut self.steps[place];
        for (i, (&state, &change)) in state.iter().zip(change).enumerate() {
            moved[i] = state - self.before[0][i];
            changed[i] = change - self.before[1][i];
        }
        for other in 0..self.count.min(MEMORY) {
            let product = dot(&self.steps[place][1], &self.steps[other][1]);
            self.products[place][other] = product;
            self.products[other][place] = product;
        }
    }

    /// Takes off the steps that cancel the change best.
    #[inline(always)]
    fn combine(&mut self, state: &mut [R], change: &[R]) {
        let zero = R::splat(0.0);
        let square = dot(change, change);
        let known = self.count.min(MEMORY);
        let mut shares = [zero; MEMORY];
        for (share, step) in shares.iter_mut().zip(&self.steps[..known]) {
            *share = dot(&step[1], change);
        }
        self.solve(known, &mut shares);
        for (share, [moved, changed]) in shares.iter().zip(&self.steps[..known]) {
            let share = (self.square * GROWN).select_lt(square, zero, *share);
            for (i, state) in state.iter_mut().enumerate() {
                *state = *state - share * (moved[i] + changed[i] * RELAXED);
            }
        }
        self.square = square;
    }

    /// The normal equations of the shares, by elimination of columns of length 1; a dependent one has no share.
    #[inline(always)]
    fn solve(&self, known: usize, shares: &mut [R; MEMORY]) {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let mut lengths = [one; MEMORY];
        for (i, length) in lengths[..known].iter_mut().enumerate() {
            let square = self.products[i][i];
            *length = zero.select_lt(square, square, one).sqrt().recip();
        }
        let mut matrix = [[zero; MEMORY]; MEMORY];
        for i in 0..known {
            for j in 0..known {
                matrix[i][j] = self.products[i][j] * lengths[i] * lengths[j];
            }
            shares[i] = shares[i] * lengths[i];
        }
        for i in 0..known {
            let pivot = matrix[i][i];
            let inverse = R::splat(DEPENDENT).select_lt(pivot, pivot.recip(), zero);
            for row in i + 1..known {
                let factor = matrix[row][i] * inverse;
                for j in i..known {
                    matrix[row][j] = matrix[row][j] - factor * matrix[i][j];
                }
                shares[row] = shares[row] - factor * shares[i];
            }
            matrix[i][i] = inverse;
        }
        for i in (0..known).rev() {
            let mut rest = shares[i];
            for j in i + 1..known {
                rest = rest - matrix[i][j] * shares[j];
            }
            shares[i] = rest * matrix[i][i];
        }
        for (i, share) in shares[..known].iter_mut().enumerate() {
            *share = *share * lengths[i];
        }
    }
}

/// Scalar product.
#[inline(always)]
fn dot<R: Real>(a: &[R], b: &[R]) -> R {
    let mut sums = [R::splat(0.0); 4];
    for (i, (&a, &b)) in a.iter().zip(b).enumerate() {
        sums[i % 4] = a.mul_add(b, sums[i % 4]);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
