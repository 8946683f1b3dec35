//! Steps of a cycle with the mechanism at their stages, and a solution on them.

use crate::equation::{Equation, Row};
use linkwright_core::drive::law::LawGeometry;
use linkwright_core::drive::reduce::{Reduction, reductions};
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::plane::Angle;
use linkwright_kernel::radau::{C, N, S, through, value};

/// Places of a step from one end to the other, and the mechanism there.
#[derive(Clone)]
pub struct Rows {
    /// Inertia and loads.
    pub reduced: Vec<Reduction<f64>>,
    angles: Vec<f64>,
    geometry: Vec<LawGeometry<f64>>,
    laws: usize,
}

impl Rows {
    /// The mechanism at crank angles.
    pub fn at(equation: &Equation<'_>, angles: &[f64]) -> Self {
        let Equation { plan, q, .. } = *equation;
        let (mut geometry, laws) = (Vec::new(), plan.laws.len());
        if laws > 0 {
            let mut motion = Motion::new(&plan.mechanism, q);
            for &phi in angles {
                plan.mechanism.place::<f64, 2>(q, Angle::new(phi), &mut motion);
                plan.add_geometry(q, phi, &motion, &mut geometry);
            }
        }
        Rows { reduced: reductions(plan, q, angles, 1.0), angles: angles.to_vec(), geometry, laws }
    }

    /// The mechanism at one of them.
    pub fn row(&self, i: usize) -> Row<'_> {
        let geometry = &self.geometry[i * self.laws..][..self.laws];
        Row { phi: self.angles[i], reduced: self.reduced[i], geometry }
    }
}

/// Ends of the steps of a cycle, and the mechanism at the stages.
#[derive(Clone)]
pub struct Mesh {
    /// From 0 to the end of the cycle \[rad\].
    pub edges: Vec<f64>,
    /// At all stages of all steps.
    pub rows: Rows,
    /// Whether a step ends where a law of a link has a kink.
    pub at_kink: Vec<bool>,
}

/// A solution on a mesh.
#[derive(Clone, Debug)]
pub struct Solution {
    /// State at the start of the cycle.
    pub start: Vec<f64>,
    /// States at all stages of all steps.
    pub stages: Vec<f64>,
}

impl Mesh {
    /// Of steps with these ends.
    pub fn new(equation: &Equation<'_>, edges: Vec<f64>) -> Self {
        let at_stages = |pair: &[f64]| C.map(|c| pair[0] + c * (pair[1] - pair[0]));
        let angles: Vec<f64> = edges.windows(2).flat_map(at_stages).collect();
        Mesh { rows: Rows::at(equation, &angles), at_kink: vec![false; edges.len() - 1], edges }
    }

    /// The same with some ends at kinks of laws.
    pub fn with_kinks(mut self, kinks: &[f64]) -> Self {
        for (at_kink, end) in self.at_kink.iter_mut().zip(&self.edges[1..]) {
            *at_kink = kinks.contains(end);
        }
        self
    }

    /// Number of steps.
    pub fn steps(&self) -> usize {
        self.edges.len() - 1
    }

    /// Distance of an angle from the nearest end of a step \[rad\].
    pub fn to_edge(&self, phi: f64) -> f64 {
        let behind = self.edges.partition_point(|&edge| edge < phi);
        let beside = [behind.saturating_sub(1), behind.min(self.steps())];
        beside.map(|i| (self.edges[i] - phi).abs()).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Length of a step \[rad\].
    pub fn length(&self, k: usize) -> f64 {
        self.edges[k + 1] - self.edges[k]
    }
}

impl Solution {
    /// Numbers of a state.
    pub fn states(&self) -> usize {
        self.start.len()
    }

    /// The same state everywhere.
    pub fn constant(steps: usize, y: &[f64]) -> Self {
        Solution { start: y.to_vec(), stages: y.repeat(steps * S) }
    }

    /// State at a stage of a step.
    pub fn stage(&self, k: usize, i: usize) -> &[f64] {
        let m = self.states();
        &self.stages[(k * S + i) * m..][..m]
    }

    /// State at the start of a step.
    pub fn start_of(&self, k: usize) -> &[f64] {
        if k == 0 { &self.start } else { self.stage(k - 1, S - 1) }
    }

    /// Coefficients of the quintic of a number of the state in a step, over its share.
    pub fn quintic(&self, k: usize, number: usize) -> [f64; N] {
        let mut values = [self.start_of(k)[number]; N];
        for i in 0..S {
            values[i + 1] = self.stage(k, i)[number];
        }
        through(&values)
    }

    /// State at a share of a step.
    pub fn state(&self, k: usize, share: f64, to: &mut [f64]) {
        for (number, to) in to.iter_mut().enumerate() {
            *to = value(&self.quintic(k, number), share);
        }
    }

    /// The same solution on steps with certain ends, read on the stages of others.
    pub fn on(&self, own: &[f64], other: &[f64]) -> Solution {
        let m = self.states();
        let mut stages = Vec::with_capacity((other.len() - 1) * S * m);
        let (mut k, mut y) = (0, vec![0.0; m]);
        for pair in other.windows(2) {
            let h = pair[1] - pair[0];
            while k + 2 < own.len() && own[k + 1] <= pair[0] + 1e-12 * h {
                k += 1;
            }
            let mut at = k;
            for c in C {
                let phi = pair[0] + c * h;
                while at + 2 < own.len() && own[at + 1] < phi {
                    at += 1;
                }
                self.state(at, (phi - own[at]) / (own[at + 1] - own[at]), &mut y);
                stages.extend_from_slice(&y);
            }
        }
        Solution { start: self.start.clone(), stages }
    }
}
