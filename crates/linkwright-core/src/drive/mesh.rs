//! The steps of one machine's turn: where they end, how they are made shorter, and what a solution on other
//! steps gives to start from.

use crate::drive::check::Excess;
use crate::drive::cycle::Turn;
use crate::drive::layout::{bundle, unbundle};
use crate::kernel::dual::Dual;
use crate::kernel::radau::{B, C, N, S, through, value};
use crate::kernel::real::Real;

/// A step shorter than this \[rad\] counts as that long where kinks are placed.
const SHORTEST: f64 = 1e-4;

/// Kinks nearer than the same share of this \[rad\], some steps, have one end: in a step between them rounding alone would
/// tell the sides.
const SHARED: f64 = 0.4;

/// An end of a step that moves by more than this share of the shorter step beside it may have to pass other ends, which go.
const FAR: f64 = 0.2;

/// Most parts that a step is cut into at once.
const PARTS_MAX: f64 = 4.0;

/// A solved step.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// Crank angle at its start \[rad\].
    pub phi: f64,
    /// Length \[rad\].
    pub h: f64,
    /// u at its start.
    pub u: f64,
    /// u at its stages.
    pub X: [f64; S],
}

impl Piece {
    /// How long it takes \[s\].
    pub fn duration(&self) -> f64 {
        (0..S).map(|i| self.h * B[i] / (2.0 * self.X[i]).sqrt()).sum()
    }

    /// Quintic through start and stages.
    pub(super) fn quintic(&self) -> [f64; N] {
        let mut values = [self.u; N];
        values[1..].copy_from_slice(&self.X);
        through(&values)
    }

    /// du/dφ at a share of the step, of the quintic.
    pub(super) fn slope(&self, share: f64) -> f64 {
        let x = Dual::variable(share);
        self.quintic().iter().rev().fold(Dual::splat(0.0), |sum, &c| sum * x + c).d / self.h
    }

    /// u at an angle, on the quintic.
    pub(super) fn value(&self, quintic: &[f64; N], phi: f64) -> f64 {
        // Where the solution falls fast a polynomial may swing below zero.
        let least = self.X.iter().copied().fold(self.u, f64::min);
        value(quintic, (phi - self.phi) / self.h).max(0.5 * least)
    }
}

/// Speed of the crank over the angle with its derivative, along solved steps.
pub(super) fn speed_along(pieces: &[Piece]) -> impl Fn(f64) -> Dual<f64> + '_ {
    let quintics: Vec<[f64; N]> = pieces.iter().map(Piece::quintic).collect();
    move |phi| {
        let k = pieces.partition_point(|piece| piece.phi <= phi).max(1) - 1;
        let (piece, x) = (&pieces[k], Dual::variable(phi));
        let share = (x - piece.phi) * (1.0 / piece.h);
        let u = quintics[k].iter().rev().fold(Dual::splat(0.0), |sum, &c| sum * share + c);
        let least = piece.X.iter().copied().fold(piece.u, f64::min);
        (u.max(Dual::splat(0.5 * least)) * 2.0).sqrt()
    }
}

impl<R: Real> Turn<R> {
    /// The solved steps in a row, those of no length left out.
    #[inline(always)]
    pub fn pieces(&self) -> Vec<Piece> {
        let columns = |of: &dyn Fn(usize) -> R| unbundle(&(0..self.steps.len()).map(of).collect::<Vec<_>>());
        let (phi, h) = (columns(&|k| self.steps[k].phi), columns(&|k| self.steps[k].h));
        let u = columns(&|k| self.steps[k].u);
        let X: [Vec<f64>; S] = std::array::from_fn(|i| columns(&|k| self.steps[k].X[i]));
        let piece = |k: usize| Piece { phi: phi[k], h: h[k], u: u[k], X: std::array::from_fn(|i| X[i][k]) };
        (0..phi.len()).filter(|&k| h[k] > 0.0).map(piece).collect()
    }

    /// Growth of a disturbance in each of these steps.
    #[inline(always)]
    pub fn growths(&self) -> Vec<f64> {
        let columns = |of: &dyn Fn(usize) -> R| unbundle(&(0..self.steps.len()).map(of).collect::<Vec<_>>());
        let (h, growth) = (columns(&|k| self.steps[k].h), columns(&|k| self.steps[k].growth));
        growth.into_iter().zip(h).filter(|&(_, h)| h > 0.0).map(|(growth, _)| growth).collect()
    }

    /// Starts every step from a solution on other steps.
    #[inline(always)]
    pub fn start_from(&mut self, pieces: &[Piece]) {
        let columns = |of: &dyn Fn(usize) -> R| unbundle(&(0..self.steps.len()).map(of).collect::<Vec<_>>());
        let (phi, h) = (columns(&|k| self.steps[k].phi), columns(&|k| self.steps[k].h));
        let mut at = 0;
        let mut values: [Vec<f64>; S + 1] = std::array::from_fn(|_| Vec::with_capacity(phi.len()));
        for (&phi, &h) in phi.iter().zip(&h) {
            // The piece that the step's middle lies in.
            while at + 1 < pieces.len() && pieces[at + 1].phi <= phi + 0.5 * h {
                at += 1;
            }
            let quintic = pieces[at].quintic();
            values[0].push(pieces[at].value(&quintic, phi));
            for i in 0..S {
                values[i + 1].push(pieces[at].value(&quintic, phi + C[i] * h));
            }
        }
        let u: Vec<R> = bundle(&values[0]);
        let X: [Vec<R>; S] = std::array::from_fn(|i| bundle(&values[i + 1]));
        for (k, step) in self.steps.iter_mut().enumerate() {
            step.u = u[k];
            for i in 0..S {
                step.X[i] = X[i][k];
            }
        }
    }
}

/// An end of a step at which the motion passes a kink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Crank angle \[rad\].
    pub phi: f64,
    /// Number of the kink among those of the machine ([`crate::drive::events::Events`]).
    pub nth: usize,
}

/// How the end of a step at a kink has to move.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    /// By what angle \[rad\].
    pub by: f64,
    /// Angle within which a disturbance dies out beside the kink \[rad\]: under a steep drive what is left of the way there
    /// changes the acceleration in proportion to its share of this.
    pub layer: f64,
}

/// Steps of a revolution.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Ends of the steps from 0 to 2π.
    pub edges: Vec<f64>,
    /// Those of them at which the solution was found to pass a kink.
    pub crossings: Vec<Crossing>,
}

impl Mesh {
    /// A mesh without any kinks that depend on the speed yet.
    pub fn new(edges: Vec<f64>) -> Self {
        Mesh { edges, crossings: Vec::new() }
    }

    /// Moves the ends at kinks; where there is no move the end is an ordinary one again. Whether any changes by more than the
    /// share `kink_share` of a step, or of the layer beside it.
    pub fn follow(&mut self, moves: &[Option<Move>], breaks: &[f64], kink_share: f64) -> bool {
        let mut changes = false;
        for (crossing, to) in self.crossings.clone().into_iter().zip(moves) {
            let at = self.edges.partition_point(|&edge| edge < crossing.phi);
            let cycle = self.edges[self.edges.len() - 1];
            let h = self.edges.get(at + 1).map_or(cycle, |next| next - crossing.phi);
            let h = if at > 0 { h.min(crossing.phi - self.edges[at - 1]) } else { h };
            let shares_end =
                self.crossings.iter().any(|other| other.phi == crossing.phi && other.nth != crossing.nth);
            let is_break = breaks.contains(&crossing.phi);
            let near = |to: &Move| match (shares_end, is_break) {
                (true, _) => SHARED.max(h),
                (_, true) => h.max(SHORTEST),
                _ => h.min(to.layer).max(SHORTEST),
            };
            if to.is_some_and(|to| to.by.abs() <= kink_share * near(&to)) {
                continue;
            }
            changes = true;
            self.crossings.retain(|other| *other != crossing);
            let Some(Move { by, .. }) = *to else { continue };
            if !is_break && self.crossings.iter().all(|other| other.phi != crossing.phi) {
                self.edges.remove(at);
            }
            let phi = (crossing.phi + by).rem_euclid(cycle);
            if by.abs() > FAR * h {
                self.drop_ordinary(phi, by.abs(), breaks);
            }
            self.add_crossing(Crossing { phi, ..crossing }, kink_share);
        }
        changes
    }

    /// Makes room beside a crank angle: ends of steps that nothing asks for go.
    fn drop_ordinary(&mut self, phi: f64, room: f64, breaks: &[f64]) {
        let crossings = &self.crossings;
        self.edges.retain(|edge| {
            let is_asked_for = || breaks.contains(edge) || crossings.iter().any(|other| other.phi == *edge);
            (edge - phi).abs() >= room || is_asked_for()
        });
    }

    /// Makes a kink the end of a step: one that is there to the share `kink_share` of the step, or a new one. Whether it is new.
    pub fn add_crossing(&mut self, mut found: Crossing, kink_share: f64) -> bool {
        let is_beside = |other: &&Crossing| {
            let apart = (other.phi - found.phi).abs();
            other.nth != found.nth && apart <= kink_share * SHARED
        };
        if let Some(other) = self.crossings.iter().find(is_beside) {
            found.phi = other.phi;
        }
        let after = self.edges.partition_point(|&edge| edge <= found.phi).clamp(1, self.edges.len() - 1);
        let (low, high) = (self.edges[after - 1], self.edges[after]);
        let near = kink_share * (high - low).max(SHORTEST);
        let end = if found.phi - low <= high - found.phi { low } else { high };
        let is_new = (found.phi - end).abs() > near;
        let phi = if is_new { found.phi } else { end % self.edges[self.edges.len() - 1] };
        if is_new {
            self.edges.insert(after, phi);
        }
        let crossing = Crossing { phi, ..found };
        if !self.crossings.contains(&crossing) {
            self.crossings.push(crossing);
            self.crossings.sort_by(|a, b| a.phi.total_cmp(&b.phi));
            return true;
        }
        is_new
    }

    /// Whether the motion was found to pass a kink at this end of a step.
    pub fn is_crossing(&self, edge: f64) -> bool {
        self.crossings.iter().any(|crossing| crossing.phi == edge)
    }

    /// The mesh with the steps that are not good made shorter.
    pub fn refined(&self, excess: &[Excess]) -> Mesh {
        let mut next = Mesh { edges: vec![0.0], crossings: self.crossings.clone() };
        for (ends, excess) in self.edges.windows(2).zip(excess) {
            if excess.error <= 1.0 {
                next.edges.push(ends[1]);
            } else {
                next.split(ends[0], ends[1], *excess);
            }
        }
        next
    }

    /// Adds the ends of the parts of a step: equal ones, or, where its start is what matters, doubling.
    fn split(&mut self, low: f64, high: f64, excess: Excess) {
        let h = high - low;
        if excess.halvings == 0 {
            // In the worst case the error falls with the fifth power of the length.
            let parts = excess.error.powf(0.2).ceil().clamp(2.0, PARTS_MAX);
            self.edges.extend((1..parts as u32).map(|i| low + h * f64::from(i) / parts));
        } else {
            let shortest = excess.halvings as i32 + 1;
            self.edges.extend((1..=shortest).rev().map(|k| low + h * 0.5_f64.powi(k)));
        }
        self.edges.push(high);
    }
}

/// Zero of `f` in [0, h] with given values of opposite sign at the ends: Illinois variant of regula falsi
/// (Dowell, Jarratt, *BIT* 11, 1971), order 1.44, never leaves the bracket.
pub fn crossing(mut f: impl FnMut(f64) -> f64, h: f64, mut left: f64, mut right: f64) -> f64 {
    let (mut a, mut b) = (0.0, h);
    let mut root = a;
    for _ in 0..60 {
        root = (a * right - b * left) / (right - left);
        let value = f(root);
        // Rounding of the speed limits the place to about 1e-14 of the step.
        if value == 0.0 || (b - a).abs() <= 1e-14 * h.abs() {
            break;
        }
        if value * right < 0.0 {
            (a, left) = (b, right);
        } else {
            left *= 0.5;
        }
        if (root - b).abs() <= 1e-14 * h.abs() {
            break;
        }
        (b, right) = (root, value);
    }
    root
}
