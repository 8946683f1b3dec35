//! What the lanes of a revolution hold: machines side by side, or the steps of one machine in a row.
//!
//! Everything inside a step is the same for both. They differ where steps meet: in the recurrence from step
//! to step, in sums over the revolution, and in what follows a step.

use crate::kernel::real::Real;

/// Lanes of the widest bundle.
const LANES_MAX: usize = 16;

/// What the lanes hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Each lane its own machine; the bundles are the steps.
    Machines,
    /// Successive steps of one machine; the last bundle may be filled up with steps of no length.
    Steps,
}

impl Layout {
    /// A quantity at the ends of the steps, from its values at their starts: that of the next step, and of
    /// the first for the last.
    #[inline(always)]
    pub fn ends<R: Real>(self, starts: &[R]) -> Vec<R> {
        match self {
            Layout::Machines => {
                let mut ends = starts.to_vec();
                ends.rotate_left(1);
                ends
            }
            Layout::Steps => {
                let mut ends = unbundle(starts);
                ends.rotate_left(1);
                bundle(&ends)
            }
        }
    }

    /// A sum over bundles made one over the revolution.
    #[inline(always)]
    pub fn total<R: Real>(self, sum: R) -> R {
        match self {
            Layout::Machines => sum,
            Layout::Steps => {
                // Asked for at every level of energy: not by way of a list.
                let mut lanes = [0.0; LANES_MAX];
                sum.store(&mut lanes);
                R::splat(lanes[..R::LANES].iter().sum())
            }
        }
    }

    /// A maximum over bundles made one over the revolution.
    #[inline(always)]
    pub fn highest<R: Real>(self, value: R) -> R {
        match self {
            Layout::Machines => value,
            Layout::Steps => R::splat(value.max_lane()),
        }
    }

    /// A minimum over bundles made one over the revolution.
    #[inline(always)]
    pub fn lowest<R: Real>(self, value: R) -> R {
        -self.highest(-value)
    }

    /// Solves `δ_{k+1} = growth_k δ_k + defect_k` with `δ_n = δ_0`. Returns all δ, and the product of the
    /// growths: the derivative of the return map.
    #[inline(always)]
    pub fn close<R: Real>(self, growth: &[R], defect: &[R]) -> (Vec<R>, R) {
        match self {
            Layout::Machines => close(growth, defect),
            Layout::Steps => {
                let (delta, gain) = close(&unbundle(growth), &unbundle(defect));
                (bundle(&delta), R::splat(gain))
            }
        }
    }
}

#[inline(always)]
fn close<T: Real>(growth: &[T], defect: &[T]) -> (Vec<T>, T) {
    let one = T::splat(1.0);
    let (mut gain, mut offset) = (one, T::splat(0.0));
    for k in 0..growth.len() {
        offset = growth[k].mul_add(offset, defect[k]);
        gain = gain * growth[k];
    }
    let mut delta = offset / (one - gain);
    let mut all = Vec::with_capacity(growth.len());
    for k in 0..growth.len() {
        all.push(delta);
        delta = growth[k].mul_add(delta, defect[k]);
    }
    (all, gain)
}

/// All lanes of all bundles in a row.
#[inline(always)]
pub fn unbundle<R: Real>(bundles: &[R]) -> Vec<f64> {
    let mut flat = vec![0.0; bundles.len() * R::LANES];
    for (bundle, lanes) in bundles.iter().zip(flat.chunks_exact_mut(R::LANES)) {
        bundle.store(lanes);
    }
    flat
}

/// Bundles of a row of numbers, whose length is a multiple of the lanes.
#[inline(always)]
pub fn bundle<R: Real>(flat: &[f64]) -> Vec<R> {
    let mut bundles = Vec::with_capacity(flat.len() / R::LANES);
    for lanes in flat.chunks_exact(R::LANES) {
        bundles.push(R::load(lanes));
    }
    bundles
}
