//! Mode shapes of a train, all at once, a lane each.
//!
//! One sweep from the leaves gives the response of every disc and all discs beyond it, x; another from the root what the
//! rest answers there, y. At the disc where both fit together best, γ = x + y smallest, the shape begins; from there
//! outwards all its ratios are stable,
//!
//! ```text
//! θ_c = θ_p k/(k + x_c) away from the root        θ_p = θ_c k/(k + y_c) towards it
//! ```
//!
//! and all discs but that one are in equilibrium. Rayleigh's quotient of the shape is λ + γ θ²/Σ J θ², which is the λ that is kept:
//! sums of positive terms, its error the square of the shape's. By the theorem of the gap the shape is off by no more than
//! the angle γ θ/√(J Σ J θ²) over the distance to the next λ.
//!
//! Source: Fernando, *On computing an eigenvector of a tridiagonal matrix*, SIAM J. Matrix Anal. Appl. 18 (1997)
//! 1013–1034; Dhillon, Parlett, *Orthogonal eigenvectors and relative gaps*, SIAM J. Matrix Anal. Appl. 25 (2004) 858–899;
//! Parlett, *The Symmetric Eigenvalue Problem*, section 11.7, for the gap.

use super::Train;
use linkwright_kernel::call::poll;
use linkwright_kernel::lanes::{Job, in_lanes};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;

/// A pivot is moved off zero by this share of the stiffness, so little that no other value changes: what the disc answers is then
/// as good as infinite and the next one as good as held, without infinities to compute with.
const NUDGE: f64 = 1e-25;

/// Rounds at most; each has the third power of the error of the last.
const ROUNDS: usize = 3;

/// Change of λ over its distance from the next that needs no further round.
const SETTLED: f64 = 1e-13;

/// Changes of λ below this share are rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Angle by which a shape may be off: that of λ that differ by some 10⁻⁶ of themselves.
const STRAIGHT: f64 = 1e-9;

/// Shapes, a row a disc, a column a mode, each with Σ J θ² = 1; λ is improved. `false` if one of them is not good.
pub fn shapes(train: &Train, lambda: &mut [f64], to: &mut [f64]) -> bool {
    in_lanes(Shapes { train, lambda, to })
}

struct Shapes<'a> {
    train: &'a Train,
    lambda: &'a mut [f64],
    to: &'a mut [f64],
}

impl Job for Shapes<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<R: Real>(self) -> bool {
        let Shapes { train, lambda, to } = self;
        let modes = lambda.len();
        let mut twisted = TwistedSweep::<R>::new(train);
        // The first mode of a free train is known: it rotates as a rigid body.
        let known = usize::from(train.is_free());
        if train.is_free() {
            let whole = 1.0 / train.inertia.iter().sum::<f64>().sqrt();
            to.iter_mut().step_by(modes).for_each(|q| *q = whole);
        }
        let (mut padded, mut buffer) = (Vec::with_capacity(modes + 2 * R::LANES), vec![0.0; R::LANES]);
        let mut good = true;
        for first in (known..modes).step_by(R::LANES) {
            poll();
            let n = R::LANES.min(modes - first);
            neighbours(lambda, first, R::LANES, &mut padded);
            let (found, straight) = out_of_line!(R, twisted.refine(&padded));
            found.store(&mut buffer);
            lambda[first..first + n].copy_from_slice(&buffer[..n]);
            straight.store(&mut buffer);
            good &= buffer[..n].iter().all(|&angle| angle <= STRAIGHT);
            for (Sweep { shape: q, .. }, row) in twisted.sweeps.iter().zip(to.chunks_exact_mut(modes)) {
                if n == R::LANES {
                    q.store(&mut row[first..]);
                } else {
                    q.store(&mut buffer);
                    row[first..].copy_from_slice(&buffer[..n]);
                }
            }
        }
        good
    }
}

/// The λ of some lanes with the one before and the one after; past the ends there is none near.
fn neighbours(lambda: &[f64], first: usize, lanes: usize, to: &mut Vec<f64>) {
    to.clear();
    to.push(if first == 0 { -lambda[0] } else { lambda[first - 1] });
    to.extend_from_slice(&lambda[first..lambda.len().min(first + lanes + 1)]);
    let last = to[to.len() - 1];
    to.resize(lanes + 2, 2.0 * last);
}

/// What a disc and its shaft are in the sweeps.
#[derive(Clone, Copy)]
struct Sweep<R> {
    /// Response of the disc and all discs beyond it, x; then that of the rest, y.
    answer: R,
    /// Of the disc and those of its branches that come later than the one from which one comes.
    later: R,
    /// k/(k + x), k/(k + y).
    down: R,
    up: R,
    /// θ.
    shape: R,
}

/// Room for the shapes of as many modes as there are lanes.
struct TwistedSweep<'a, R> {
    train: &'a Train,
    sweeps: Vec<Sweep<R>>,
}

/// Where a shape begins.
struct TwistStart<R> {
    disc: R,
    /// γ there, and its size over J.
    rest: R,
    size: R,
    /// J there.
    inertia: R,
}

impl<'a, R: Real> TwistedSweep<'a, R> {
    fn new(train: &'a Train) -> Self {
        let zero = R::splat(0.0);
        let sweep = Sweep { answer: zero, later: zero, down: zero, up: zero, shape: zero };
        TwistedSweep { train, sweeps: vec![sweep; train.len()] }
    }

    /// Shapes and improved λ; also by what angle a shape may be off. Given are λ with their neighbours.
    #[inline(always)]
    fn refine(&mut self, padded: &[f64]) -> (R, R) {
        let mut lambda = R::load(&padded[1..]);
        let gap = (lambda - R::load(padded)).min(R::load(&padded[2..]) - lambda);
        let mut angle = R::splat(0.0);
        for _ in 0..ROUNDS {
            self.sweep_up(lambda);
            let best = self.sweep_down();
            let mass = self.spread(&best);
            let change = best.rest / mass;
            // What is left over, and what rounding of λ is worth.
            let off = best.rest.abs() / (best.inertia * mass).sqrt() + lambda * ROUNDING;
            angle = off / gap;
            lambda = lambda + change;
            let left = (change.abs() - lambda * ROUNDING).min(change.abs() - gap * SETTLED);
            if left.max_lane() <= 0.0 {
                break;
            }
        }
        (lambda, angle)
    }

    /// x of every disc.
    #[inline(always)]
    fn sweep_up(&mut self, lambda: R) {
        let Train { parent, inertia, stiffness, ground } = self.train;
        for ((sweep, &J), &k) in self.sweeps.iter_mut().zip(inertia).zip(ground) {
            sweep.answer = lambda.mul_add(R::splat(-J), R::splat(k));
        }
        for c in (1..parent.len()).rev() {
            let k = stiffness[c];
            let x = self.sweeps[c].answer;
            let down = (x + k + k * NUDGE).recip() * k;
            let up = &mut self.sweeps[parent[c]].answer;
            let later = *up;
            *up = x.mul_add(down, later);
            self.sweeps[c] = Sweep { down, later, ..self.sweeps[c] };
        }
    }

    /// y of every disc, in place of x, and where both fit best.
    #[inline(always)]
    fn sweep_down(&mut self) -> TwistStart<R> {
        let Train { parent, inertia, stiffness, .. } = self.train;
        let zero = R::splat(0.0);
        let rest = self.sweeps[0].answer;
        let J = inertia[0];
        let mut best = TwistStart { disc: zero, rest, size: rest.abs() * (1.0 / J), inertia: R::splat(J) };
        // What the rest answers at the first disc: nothing.
        self.sweeps[0].answer = zero;
        for c in 1..parent.len() {
            let (k, J) = (stiffness[c], inertia[c]);
            let Sweep { answer: x, later, down, .. } = self.sweeps[c];
            let above = &mut self.sweeps[parent[c]].answer;
            let rest = later + *above;
            // Those that come after are at rest with this one, too.
            *above = x.mul_add(down, *above);
            let up = (rest + k + k * NUDGE).recip() * k;
            let y = rest * up;
            self.sweeps[c] = Sweep { answer: y, up, ..self.sweeps[c] };
            let rest = x + y;
            let size = rest.abs() * (1.0 / J);
            best = TwistStart {
                disc: size.select_lt(best.size, R::splat(c as f64), best.disc),
                rest: size.select_lt(best.size, rest, best.rest),
                inertia: size.select_lt(best.size, R::splat(J), best.inertia),
                size: size.min(best.size),
            };
        }
        best
    }

    /// Shapes from the best disc outwards, with Σ J θ² = 1 and the largest positive. Σ J θ² where the best has one.
    #[inline(always)]
    fn spread(&mut self, best: &TwistStart<R>) -> R {
        let Train { parent, inertia, .. } = self.train;
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        for (c, sweep) in self.sweeps.iter_mut().enumerate() {
            let away = (best.disc - c as f64).abs();
            sweep.shape = away.select_lt(R::splat(0.5), one, zero);
        }
        for c in (1..parent.len()).rev() {
            let up = self.sweeps[c].shape * self.sweeps[c].up;
            let q = &mut self.sweeps[parent[c]].shape;
            *q = *q + up;
        }
        let (mut mass, mut largest) = (zero, zero);
        for c in 0..parent.len() {
            let mut q = self.sweeps[c].shape;
            if c > 0 {
                // Off the way from the best disc to the root.
                q = zero.select_lt(q.abs(), q, self.sweeps[parent[c]].shape * self.sweeps[c].down);
                self.sweeps[c].shape = q;
            }
            mass = (q * inertia[c]).mul_add(q, mass);
            largest = largest.abs().select_lt(q.abs(), q, largest);
        }
        let unit = mass.sqrt().recip();
        let unit = largest.select_lt(zero, -unit, unit);
        self.sweeps.iter_mut().for_each(|sweep| sweep.shape = sweep.shape * unit);
        mass
    }
}
