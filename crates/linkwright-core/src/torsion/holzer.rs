//! Holzer's table at any λ = ω²: how many natural frequencies lie below, and where the next are.
//!
//! A disc and all that hangs on it are carried through the angle θ, which takes the torque M; one shaft further
//!
//! ```text
//! M = M_c + (k_0 − λ J + Σ x) θ        θ_p = θ + M/k        x = M/θ_p of each side branch
//! ```
//!
//! without a division along a chain. θ_p/θ of all shafts and M/θ of the root have the signs of the pivots of K − λJ. Their
//! product is the characteristic polynomial p, whose derivative goes along.

use super::Train;
use crate::real::Real;

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
    /// 1/k of the shaft to the disc that it hangs on \[rad/(N m)\].
    flexibility: f64,
    /// The disc that it hangs on.
    parent: usize,
    /// Whether others hang on it by the side of the way.
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
        for (c, step) in self.steps.iter().enumerate().skip(1).rev() {
            at.turn::<SLOPE>(step, lambda, side.get_mut(c));
            let up = at.twist::<SLOPE>(step.flexibility);
            let sure = at.angle.mul_add(R::splat(NUDGE), up.angle);
            if !SLOPE {
                found = found + negative(at.angle * sure);
            }
            if step.parent + 1 == c {
                at = if step.rescales { up.rescaled(self.unit) } else { up };
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
            at = fresh;
        }
        at.turn::<SLOPE>(&self.steps[0], lambda, side.first_mut());
        found + if SLOPE { at.torque_d1 / at.torque } else { negative(at.angle * at.torque) }
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

    /// The same, of size one.
    #[inline(always)]
    fn rescaled(self, unit: f64) -> Self {
        let size = self.torque.abs().mul_add(R::splat(unit), self.angle.abs()).recip();
        State {
            angle: self.angle * size,
            torque: self.torque * size,
            angle_d1: self.angle_d1 * size,
            torque_d1: self.torque_d1 * size,
        }
    }
}
