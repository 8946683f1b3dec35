//! Holzer's table at any λ = ω²: how many natural frequencies lie below, and where the next are.
//!
//! A disc and all discs beyond it are carried through the angle θ, which takes the torque M; one shaft further
//!
//! ```text
//! M = M_c + (k_0 − λ J + Σ x) θ        θ_p = θ + M/k        x = M/θ_p of each side branch
//! ```
//!
//! without a division along a chain. θ_p/θ of all shafts and M/θ of the root have the signs of the pivots of K − λJ. Their
//! product is the characteristic polynomial p, whose derivative goes along.

use super::Train;
use linkwright_kernel::real::Real;

/// Share of an angle that is added to the next: nothing, unless that is zero, and then it has a sign and a reciprocal.
const NUDGE: f64 = 1e-25;

/// By how much angles may grow until they are brought back to one: products of two of them are still numbers.
const GROWTH: f64 = 1e110;

/// A disc on the way from the leaves to the root.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// J \[kg m²\].
    inertia: f64,
    /// To the ground \[N m/rad\].
    ground: f64,
    /// 1/k of the shaft to the disc before it \[rad/(N m)\].
    flexibility: f64,
    /// The disc before it.
    parent: usize,
    /// Whether other branches are connected to it.
    gathers: bool,
    /// Whether angles are brought back to one here.
    rescales: bool,
}

/// A train as it is swept.
#[derive(Clone, Debug)]
pub struct Holzer {
    steps: Vec<Step>,
    /// 1/k of the softest shaft, by which torques are measured \[rad/(N m)\].
    unit: f64,
    /// Upper bound of all λ.
    pub bound: f64,
    /// Whether λ = 0 is one of them.
    pub is_free: bool,
}

impl Holzer {
    /// From a train.
    pub fn new(train: &Train) -> Self {
        let bound = train.bound() * (1.0 + 1e-12);
        let mut steps: Vec<Step> = (0..train.len())
            .map(|c| Step {
                inertia: train.inertia[c],
                ground: train.ground[c],
                flexibility: if c == 0 { 0.0 } else { 1.0 / train.stiffness[c] },
                parent: train.parent[c],
                gathers: false,
                rescales: false,
            })
            .collect();
        for c in 1..steps.len() {
            let parent = steps[c].parent;
            steps[parent].gathers |= parent + 1 != c;
        }
        let unit = steps.iter().map(|step| step.flexibility).fold(0.0, f64::max);
        let every = steps_of(&steps, unit, bound);
        for (c, step) in steps.iter_mut().enumerate() {
            // What a side branch answers may be as good as infinite.
            step.rescales = step.gathers || c % every == 0;
        }
        Holzer { steps, unit, bound, is_free: train.is_free() }
    }

    /// How many discs.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether there is no disc.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// How many λ are above zero.
    pub fn positive(&self) -> usize {
        self.len() - usize::from(self.is_free)
    }

    /// Room for what the side branches of each disc answer, and the slope of that.
    pub fn room<R: Real>(&self) -> Vec<[R; 2]> {
        let branches = self.steps.iter().any(|step| step.gathers);
        vec![[R::splat(0.0); 2]; if branches { self.len() } else { 0 }]
    }

    /// How many λ lie below; or with `SLOPE` p′/p. `side` is its [`Holzer::room`].
    #[inline(always)]
    pub fn sweep<R: Real, const SLOPE: bool>(&self, lambda: R, side: &mut [[R; 2]]) -> R {
        let zero = R::splat(0.0);
        let fresh = State { angle: R::splat(1.0), torque: zero, angle_d1: zero, torque_d1: zero };
        let (mut at, mut found) = (fresh, zero);
        let mut before = fresh.angle;
        for (c, step) in self.steps.iter().enumerate().skip(1).rev() {
            at.turn::<SLOPE>(step, lambda, side.get_mut(c));
            let up = at.twist::<SLOPE>(step.flexibility);
            let sure = at.angle.mul_add(R::splat(NUDGE), up.angle);
            if !SLOPE {
                found = found + negative(before * sure);
            }
            before = sure;
            if step.parent + 1 == c {
                at = up;
                if step.rescales {
                    let size = up.size(self.unit).recip();
                    (at, before) = (up.scaled(size), before * size);
                }
                continue;
            }
            let reciprocal = sure.recip();
            let answer = up.torque * reciprocal;
            let sum = &mut side[step.parent];
            sum[0] = sum[0] + answer;
            if SLOPE {
                found = up.angle_d1.mul_add(reciprocal, found);
                sum[1] = (up.torque_d1 - answer * up.angle_d1).mul_add(reciprocal, sum[1]);
            }
            (at, before) = (fresh, fresh.angle);
        }
        at.turn::<SLOPE>(&self.steps[0], lambda, side.first_mut());
        found + if SLOPE { at.torque_d1 / at.torque } else { negative(before * at.torque) }
    }
}

/// After how many discs angles may have grown, or shrunk, by [`GROWTH`]: bounded by the norms of both halves of a step.
fn steps_of(steps: &[Step], unit: f64, bound: f64) -> usize {
    let torque = |step: &Step| unit * (bound * step.inertia + step.ground);
    let growth = 2.0 * (1.0 + steps.iter().map(torque).fold(0.0, f64::max));
    ((GROWTH.ln() / growth.ln()) as usize).max(1)
}

/// One where a number is below zero.
#[inline(always)]
fn negative<R: Real>(x: R) -> R {
    x.select_lt(R::splat(0.0), R::splat(1.0), R::splat(0.0))
}

/// θ and M with their derivatives by λ.
#[derive(Clone, Copy)]
struct State<R> {
    angle: R,
    torque: R,
    angle_d1: R,
    torque_d1: R,
}

impl<R: Real> State<R> {
    /// Adds the torque that a disc takes; side branches are taken, and their place is left empty.
    #[inline(always)]
    fn turn<const SLOPE: bool>(&mut self, step: &Step, lambda: R, side: Option<&mut [R; 2]>) {
        let mut stiffness = lambda.mul_add(R::splat(-step.inertia), R::splat(step.ground));
        let mut slope = R::splat(-step.inertia);
        if let Some(side) = side.filter(|_| step.gathers) {
            let [answer, answer_d1] = std::mem::replace(side, [R::splat(0.0); 2]);
            stiffness = stiffness + answer;
            slope = slope + answer_d1;
        }
        if SLOPE {
            let held = slope.mul_add(self.angle, self.torque_d1);
            self.torque_d1 = stiffness.mul_add(self.angle_d1, held);
        }
        self.torque = stiffness.mul_add(self.angle, self.torque);
    }

    /// At the far end of a shaft.
    #[inline(always)]
    fn twist<const SLOPE: bool>(self, flexibility: f64) -> Self {
        let f = R::splat(flexibility);
        let angle_d1 = if SLOPE { self.torque_d1.mul_add(f, self.angle_d1) } else { self.angle_d1 };
        State { angle: self.torque.mul_add(f, self.angle), angle_d1, ..self }
    }

    /// Of both together, never zero.
    #[inline(always)]
    fn size(&self, unit: f64) -> R {
        self.torque.abs().mul_add(R::splat(unit), self.angle.abs())
    }

    #[inline(always)]
    fn scaled(self, factor: R) -> Self {
        State {
            angle: self.angle * factor,
            torque: self.torque * factor,
            angle_d1: self.angle_d1 * factor,
            torque_d1: self.torque_d1 * factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{modes::modes, trees};

    fn count(train: &Train, lambda: f64) -> usize {
        let holzer = Holzer::new(train);
        holzer.sweep::<f64, false>(lambda, &mut holzer.room()) as usize
    }

    #[test]
    fn it_counts_as_the_plain_pivots_do() {
        for train in trees::trees() {
            let bound = Holzer::new(&train).bound;
            for part in 1..40 {
                let lambda = bound * 10f64.powi(-part / 4) * f64::from(part % 4 + 1) * 0.2137;
                assert_eq!(count(&train, lambda), trees::below(&train, lambda), "λ = {lambda}, {train:?}");
            }
        }
    }

    #[test]
    fn long_chains_do_not_grow_out_of_numbers() {
        let n = 900;
        let parent: Vec<usize> = (0..n).map(|c: usize| c.saturating_sub(1)).collect();
        let mut stiffness: Vec<f64> = (0..n).map(|c| if c % 7 == 3 { 1e6 } else { 1.0 }).collect();
        stiffness[0] = 0.0;
        let chain = Train::new(&parent, &vec![1.0; n], &stiffness).expect("a chain");
        for lambda in [1e-3, 0.37, 3.9, 5.0, 1e3, 1.1e6, 1.9e6, 3.9e6] {
            assert_eq!(count(&chain, lambda), trees::below(&chain, lambda), "λ = {lambda}");
        }
    }

    #[test]
    fn angles_that_are_zero_count_once() {
        // λ = 0, 1, 3; at 1 the middle disc is at rest.
        let chain = Train::new(&[0, 0, 1], &[1.0; 3], &[0.0, 1.0, 1.0]).expect("a chain");
        assert_eq!([0.5, 1.0, 1.5, 3.0, 3.5].map(|lambda| count(&chain, lambda)), [1, 1, 2, 2, 3], "a chain");
        // λ = 0, 1 three times, 5; at 1 all branches leave the hub at rest.
        let star = Train::new(&[0; 5], &[1.0; 5], &[0.0, 1.0, 1.0, 1.0, 1.0]).expect("a star");
        assert_eq!([0.5, 1.5, 4.5, 5.5].map(|lambda| count(&star, lambda)), [1, 4, 4, 5], "a star");
        // One of them, which counts for one below or above.
        assert!((1..=4).contains(&count(&star, 1.0)), "a star in tune");
    }

    #[test]
    fn tuned_branches_in_a_row_are_still_numbers() {
        // Every disc of the row carries a branch that at λ = 1 holds it as good as firmly.
        let n = 80;
        let parent: Vec<usize> =
            (0..n).map(|c: usize| if c < n / 2 { c.saturating_sub(1) } else { c - n / 2 }).collect();
        let mut stiffness = vec![1.0; n];
        stiffness[0] = 0.0;
        let comb = Train::new(&parent, &vec![1.0; n], &stiffness).expect("a comb");
        let (less, more) = (trees::below(&comb, 1.0 - 1e-9), trees::below(&comb, 1.0 + 1e-9));
        assert!((less..=more).contains(&count(&comb, 1.0)), "between {less} and {more}");
        let holzer = Holzer::new(&comb);
        assert!(!holzer.sweep::<f64, true>(1.0, &mut holzer.room()).is_nan(), "the slope");
    }

    #[test]
    fn the_slope_is_a_sum_over_all_zeros() {
        for train in trees::trees().filter(|train| train.len() > 1) {
            let holzer = Holzer::new(&train);
            let squares: Vec<f64> = modes(&train).omega.iter().map(|omega| omega * omega).collect();
            for part in [0.013, 0.21, 0.77, 1.3] {
                let lambda = part * holzer.bound;
                let found = holzer.sweep::<f64, true>(lambda, &mut holzer.room());
                let terms: Vec<f64> = squares.iter().map(|square| 1.0 / (lambda - square)).collect();
                let size: f64 = terms.iter().map(|term| term.abs()).sum();
                let largest = terms.iter().fold(0.0f64, |a, b| a.max(b.abs()));
                // Rounding of λ_i counts by 1/(λ − λ_i)².
                let off = 1e-13 * size + 1e-14 * lambda * largest * largest;
                let wanted: f64 = terms.iter().sum();
                assert!((found - wanted).abs() <= off, "{found} for {wanted} at {lambda} of {train:?}");
            }
        }
    }
}
