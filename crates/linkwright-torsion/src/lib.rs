//! Torsional vibration of trains of discs and shafts.
//!
//! | module | answers |
//! | --- | --- |
//! | here | what a train is |
//! | [`forest`] | which discs are connected, in which order |
//! | [`holzer`] | how many natural frequencies lie below ω, and where the next are |
//! | [`frequencies`] | all natural frequencies |
//! | [`shapes`] | mode shapes |
//! | [`rotations`] | shapes of frequencies that coincide |
//! | [`modes`] | natural frequencies and mode shapes together |
//! | [`forced`] | amplitudes at every order and speed |
//! | [`waves`] | what harmonics add up to |
//! | [`transient`] | motion in time, with inertias that change with the angle |
//!
//! A train without loops is a tree: a shaft connects every disc but the first to one before it. Gear stages are
//! referred to one speed before, so that shafts carry k (θ_a − θ_b). Looked at from its leaves to the root, each
//! disc with all discs beyond it responds to a twist θ e^{iωt} with a torque x θ, its dynamic stiffness
//!
//! ```text
//! x_c = k_0 − ω² J_c + Σ s        s = k x_c/(k + x_c), that of shaft and disc in series
//! ```
//!
//! with k_0 to the ground, which is Holzer's table for branched trains. The number of k + x_c that are negative, and of
//! the root's x, is the number of natural frequencies below ω (Sylvester's law of inertia: they are the pivots of
//! K − ω² J).
//!
//! Source: Holzer, *Die Berechnung der Drehschwingungen* (1921); Parlett, *The Symmetric Eigenvalue Problem*, chapter 3.

// Fields of enum variants and of plain records are named as in the equations beside them.
#![allow(missing_docs)]

pub mod forced;
pub mod forest;
pub mod frequencies;
pub mod holzer;
pub mod modes;
pub mod rotations;
pub mod shapes;
pub mod transient;
#[cfg(test)]
mod trees;
pub mod waves;

/// A train referred to one speed, its discs in an order in which each is connected to an earlier one.
#[derive(Clone, Debug, Default)]
pub struct Train {
    /// The disc before each; that of the first is itself.
    parent: Vec<usize>,
    /// J \[kg m²\].
    inertia: Vec<f64>,
    /// Of the shaft to the disc before each; of the first, none \[N m/rad\].
    stiffness: Vec<f64>,
    /// From each disc to the ground \[N m/rad\].
    ground: Vec<f64>,
}

impl Train {
    /// A train; `None` unless inertias and stiffnesses are positive (the first stiffness, to the ground, may be zero) and each
    /// disc is connected to an earlier one.
    pub fn new(parent: &[usize], inertia: &[f64], stiffness: &[f64]) -> Option<Self> {
        let n = inertia.len();
        let fits = n > 0 && parent.len() == n && stiffness.len() == n;
        let sound = fits
            && inertia.iter().all(|&j| is_positive(j))
            && stiffness.iter().enumerate().all(|(i, &k)| is_positive(k) || (i == 0 && k == 0.0))
            && parent.iter().enumerate().all(|(i, &p)| if i == 0 { p == 0 } else { p < i });
        sound.then(|| {
            let mut train = Train {
                parent: parent.to_vec(),
                inertia: inertia.to_vec(),
                stiffness: stiffness.to_vec(),
                ground: vec![0.0; n],
            };
            train.ground[0] = std::mem::take(&mut train.stiffness[0]);
            train
        })
    }

    /// How many discs.
    pub fn len(&self) -> usize {
        self.inertia.len()
    }

    /// Whether there is no disc.
    pub fn is_empty(&self) -> bool {
        self.inertia.is_empty()
    }

    /// Whether it can rotate as a rigid body.
    pub fn is_free(&self) -> bool {
        self.ground.iter().all(|&k| k == 0.0)
    }

    /// An upper bound of all λ = ω²: twice the stiffness about a disc over its inertia (Gershgorin).
    fn bound(&self) -> f64 {
        let mut about: Vec<f64> = self.ground.iter().zip(&self.stiffness).map(|(k, s)| k + s).collect();
        for c in 1..self.len() {
            about[self.parent[c]] += self.stiffness[c];
        }
        about.iter().zip(&self.inertia).map(|(k, J)| 2.0 * k / J).fold(0.0, f64::max)
    }
}

/// Whether a number can be an inertia or a stiffness.
fn is_positive(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}
