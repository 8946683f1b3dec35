//! Torsional vibration of trains of discs and shafts.
//!
//! | module | answers |
//! | --- | --- |
//! | here | what a train is, and its dynamic stiffness |
//! | [`modes`] | natural frequencies and mode shapes |
//! | [`forced`] | amplitudes at every order and speed |
//! | [`waves`] | what harmonics add up to |
//! | [`transient`] | motion in time, with inertias that change with the angle |
//!
//! A train without loops is a tree: every disc but the first hangs on one other by a shaft. Gear stages are
//! referred to one speed before, so that shafts carry k (θ_a − θ_b). Looked at from its leaves to the root, each
//! disc with all that hangs on it answers a twist θ e^{iωt} with a torque x θ, its dynamic stiffness
//!
//! ```text
//! x_c = −ω² J_c + Σ s        s = k x_c/(k + x_c), that of shaft and disc in series
//! ```
//!
//! which is Holzer's table for branched trains. The number of k + x_c that are negative, and of the root's x, is the
//! number of natural frequencies below ω (Sylvester's law of inertia: they are the pivots of K − ω² J).
//!
//! Source: Holzer, *Die Berechnung der Drehschwingungen* (1921); Parlett, *The Symmetric Eigenvalue Problem*, chapter 3.

pub mod forced;
pub mod modes;
pub mod transient;
pub mod waves;

use crate::real::Real;

/// A pivot moved off zero by so little that no other value changes: what the disc answers is then as good as infinite
/// and the next one as good as held, without infinities to compute with.
#[inline(always)]
fn nudged<R: Real>(pivot: R, k: f64) -> R {
    pivot + k * 1e-25
}

/// A train referred to one speed, its discs in an order in which each hangs on an earlier one.
#[derive(Clone, Debug)]
pub struct Train {
    /// The disc that each hangs on; that of the first is itself.
    parent: Vec<usize>,
    /// J \[kg m²\].
    inertia: Vec<f64>,
    /// Of the shaft to the disc that each hangs on, of the first to the ground, zero if it is free \[N m/rad\].
    stiffness: Vec<f64>,
}

impl Train {
    /// A train; `None` unless inertias and stiffnesses are positive (the first stiffness may be zero) and each disc hangs on
    /// an earlier one.
    pub fn new(parent: &[usize], inertia: &[f64], stiffness: &[f64]) -> Option<Self> {
        let n = inertia.len();
        let fits = n > 0 && parent.len() == n && stiffness.len() == n;
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let sound = fits
            && inertia.iter().all(|&j| positive(j))
            && stiffness.iter().enumerate().all(|(i, &k)| positive(k) || (i == 0 && k == 0.0))
            && parent.iter().enumerate().all(|(i, &p)| if i == 0 { p == 0 } else { p < i });
        sound.then(|| Train {
            parent: parent.to_vec(),
            inertia: inertia.to_vec(),
            stiffness: stiffness.to_vec(),
        })
    }

    /// How many discs.
    pub fn len(&self) -> usize {
        self.inertia.len()
    }

    /// Never: a train has at least one disc.
    pub fn is_empty(&self) -> bool {
        self.inertia.is_empty()
    }

    /// How many natural frequencies lie below ω, λ = ω², and p′/p of the characteristic polynomial p(λ), which is the
    /// product of all pivots; without `NEWTON` that is left out. `x` has room for a dynamic stiffness and its slope of each disc.
    #[inline(always)]
    pub fn sweep<R: Real, const NEWTON: bool>(&self, lambda: R, x: &mut [[R; 2]]) -> (R, R) {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        for (x, &J) in x.iter_mut().zip(&self.inertia) {
            *x = [-(lambda * J), R::splat(-J)];
        }
        let (mut below, mut slope) = (zero, zero);
        for c in (1..self.len()).rev() {
            let k = self.stiffness[c];
            let [value, d] = x[c];
            let pivot = nudged(value + k, k);
            let share = pivot.recip() * k;
            below = below + pivot.select_lt(zero, one, zero);
            let up = &mut x[self.parent[c]];
            up[0] = value.mul_add(share, up[0]);
            if NEWTON {
                slope = d.mul_add(share * (1.0 / k), slope);
                up[1] = d.mul_add(share.squared(), up[1]);
            }
        }
        let root = x[0][0] + self.stiffness[0];
        below = below + root.select_lt(zero, one, zero);
        if NEWTON {
            slope = slope + x[0][1] / root;
        }
        (below, slope)
    }
}
