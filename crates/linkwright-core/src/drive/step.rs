//! A step of the solution: Newton for its stages ([`crate::kernel::radau`]), with the ends of the step on its side of jumps.

use crate::drive::equation::{Machine, Row};
use crate::drive::law::LawGeometry;
use crate::kernel::dual::Dual;
use crate::kernel::out_of_line;
use crate::kernel::radau::{B, C, N, S, StageNewton, stage_newton, through, value};
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// A step of the revolution: where it starts, how long it is, its stages.
#[derive(Clone, Copy, Debug)]
pub struct Step<R> {
    /// Crank angle at its start \[rad\].
    pub phi: R,
    /// Length \[rad\].
    pub h: R,
    /// The machine at its stages.
    pub rows: [Row<R>; S],
    /// u at its start \[rad²/s²\].
    pub u: R,
    /// u at its stages.
    pub X: [R; S],
    /// ε at its stages \[rad/s²\].
    pub K: [R; S],
    /// ∂ε/∂u at its stages \[1/rad\].
    pub D: [R; S],
    /// Derivative of its end by its start.
    pub growth: R,
}

/// The stage whose state chooses the branch: well inside the step.
pub const REFERENCE: usize = 2;

/// Newton sweeps of a step on its own.
const STEP_SWEEPS: usize = 16;

/// Relative correction after which the stages of a step have converged: the next would be about its square.
pub const CONVERGED: f64 = 1e-8;

/// Sweeps more after which the stages of a step that ends on a kink of the drive have converged: the last one may take its end
/// over the kink with the slope of the other side, which leaves ε there, and the next one may take it back.
pub const OVER_KINK: usize = 2;

/// Largest correction of the last sweep that counts as converged at all.
const SOLVED: f64 = 1e-6;

/// A sweep may lower u at most to this share of itself, so that roots stay real.
pub(super) const SHRINK: f64 = 0.25;

/// Ends of a step are on its side by no more than this share of it, so that what they are drawn on from twice as far inside
/// lies in its near half.
const AT_JUMP_OF_STEP: f64 = 0.25;

impl<R: Real> Machine<'_, R> {
    /// The stages of a step.
    #[inline(always)]
    pub(super) fn rows(
        &self,
        phi: R,
        h: R,
        m: &mut Motion<R>,
        geometry: &mut Vec<LawGeometry<R>>,
    ) -> [Row<R>; S] {
        let mut rows = [Row { inverse: h, drift: h, load: h, viscous: h }; S];
        for i in 0..S {
            rows[i] = self.row_at((phi, h), i, m, geometry);
        }
        rows
    }

    /// The reduced machine at a stage of a step; at the end on the side of the step.
    #[inline(always)]
    pub(super) fn row_at(
        &self,
        (phi, h): (R, R),
        stage: usize,
        m: &mut Motion<R>,
        geometry: &mut Vec<LawGeometry<R>>,
    ) -> Row<R> {
        let at = h.mul_add(R::splat(C[stage]), phi);
        if stage == S - 1 {
            self.row_at_end(at, -self.inside_by(h), m, geometry)
        } else {
            self.row(at, m, geometry)
        }
    }

    /// How far inside a step its ends are known to be on its side.
    #[inline(always)]
    pub(super) fn inside_by(&self, h: R) -> R {
        (h * AT_JUMP_OF_STEP).min(R::splat(self.inside))
    }

    /// ε at the stages of a step, and its derivatives.
    #[inline(always)]
    pub(super) fn accelerations(&self, step: &Step<R>, geometry: &[LawGeometry<R>]) -> ([R; S], [R; S]) {
        out_of_line!(R, {
            let (rows, X) = (&step.rows, &step.X);
            let (mut f, mut d) = (*X, *X);
            for i in 0..S {
                if self.is_on_branch(i) {
                    continue;
                }
                let free = self.drive_acceleration(&rows[i], Dual::variable(X[i]));
                (f[i], d[i]) = (free.value, free.d);
            }
            for i in 0..S {
                let own = self.geometry_at(geometry, i);
                if self.is_on_branch(i) {
                    let reference =
                        self.side.unwrap_or((self.geometry_at(geometry, REFERENCE), X[REFERENCE]));
                    let epsilon = self.acceleration_on_branch(&rows[i], own, X[i], reference);
                    (f[i], d[i]) = (epsilon.value, epsilon.d);
                } else if !geometry.is_empty() {
                    let taken = self.laws(own, (Dual::variable(X[i]) * 2.0).sqrt());
                    (f[i], d[i]) = (f[i] - taken.value * rows[i].inverse, d[i] - taken.d * rows[i].inverse);
                }
            }
            (f, d)
        })
    }

    /// A step with a known solution, and what its laws need to know.
    #[inline(always)]
    pub fn step_of(
        &self,
        phi: R,
        h: R,
        u: R,
        X: [R; S],
        m: &mut Motion<R>,
    ) -> (Step<R>, Vec<LawGeometry<R>>) {
        let mut geometry = Vec::new();
        let rows = self.rows(phi, h, m, &mut geometry);
        (Step { X, ..Step::at_rest(phi, h, rows, u) }, geometry)
    }

    /// Growth of a step that ends on a kink of the drive, with the slope that the drive's torque has on its side of the
    /// kink; the step's own has the slope that rounding chose. The torque itself is the same on either side.
    #[inline(always)]
    pub fn growth_on_side(&self, step: &Step<R>, geometry: &[LawGeometry<R>]) -> R {
        out_of_line!(R, {
            let (f, mut d) = self.accelerations(step, geometry);
            d[S - 1] = d[S - 1] + self.slope_besides(&step.rows[S - 1], step.X[S - 1], step.X[REFERENCE]);
            stage_newton(step.u, step.h, &f, &d, &step.X).u[S - 1]
        })
    }

    /// Where the stages of a step lie on another branch than the one that the step keeps to: the most that this makes of
    /// u at its end. The last stage lies on the kink itself.
    #[inline(always)]
    pub fn off_branch(&self, step: &Step<R>, geometry: &[LawGeometry<R>]) -> R {
        out_of_line!(R, {
            let mut sum = R::splat(0.0);
            for i in 0..S - 1 {
                let own = self.acceleration(&step.rows[i], self.geometry_at(geometry, i), step.X[i]).value;
                sum = (own - step.K[i]).abs().mul_add(step.h * B[i], sum);
            }
            sum
        })
    }

    /// ε at the start of a step, on its side where it may jump there, of which the geometry of its stages is known.
    #[inline(always)]
    pub fn start(&self, step: &Step<R>, geometry: &[LawGeometry<R>], m: &mut Motion<R>) -> R {
        out_of_line!(R, {
            let mut own = Vec::with_capacity(self.plan.laws.len());
            let row = self.row_at_end(step.phi, self.inside_by(step.h), m, &mut own);
            if !(self.keeps_branch || self.inside > 0.0) {
                return self.acceleration(&row, &own, step.u).value;
            }
            let known = (self.geometry_at(geometry, REFERENCE), step.X[REFERENCE]);
            self.acceleration_on_branch(&row, &own, step.u, known).value
        })
    }

    /// A step of its own from (`phi`, `u`) on by `h`, and what its laws needed. This is how the solution is
    /// read between the steps of the revolution. Lanes that do not converge are NaN.
    #[inline(always)]
    pub fn advance(&self, phi: R, u: R, h: R, m: &mut Motion<R>) -> (Step<R>, Vec<LawGeometry<R>>) {
        self.advance_near(phi, u, h, [u; S], m)
    }

    /// The same with stages to start from, and sweeps over kinks: of duals the derivatives have converged too then.
    #[inline(always)]
    pub fn advance_near(
        &self,
        phi: R,
        u: R,
        h: R,
        X: [R; S],
        m: &mut Motion<R>,
    ) -> (Step<R>, Vec<LawGeometry<R>>) {
        let (mut step, geometry) = self.advance_within(CONVERGED, phi, u, h, X, m);
        self.settle(&mut step, &geometry);
        (step, geometry)
    }

    /// The sweeps of [`OVER_KINK`] over a solved step.
    #[inline(always)]
    pub fn settle(&self, step: &mut Step<R>, geometry: &[LawGeometry<R>]) {
        let once = R::splat(f64::INFINITY);
        for _ in 0..OVER_KINK {
            out_of_line!(R, {
                let newton = self.step_newton(step, geometry, once, 0.0);
                step.take(&newton, R::splat(0.0), once, 0.0);
            });
        }
    }

    /// The same until the relative correction is below a limit.
    #[inline(always)]
    pub fn advance_within(
        &self,
        limit: f64,
        phi: R,
        u: R,
        h: R,
        X: [R; S],
        m: &mut Motion<R>,
    ) -> (Step<R>, Vec<LawGeometry<R>>) {
        out_of_line!(R, {
            let mut geometry = Vec::new();
            let rows = self.rows(phi, h, m, &mut geometry);
            let step = out_of_line!(
                R,
                self.solve_step(Step { X, ..Step::at_rest(phi, h, rows, u) }, &geometry, limit)
            );
            (step, geometry)
        })
    }

    /// Newton for the stages of a step from its start values.
    #[inline(always)]
    fn solve_step(&self, mut step: Step<R>, geometry: &[LawGeometry<R>], limit: f64) -> Step<R> {
        let mut worst = R::splat(f64::INFINITY);
        for _ in 0..STEP_SWEEPS {
            let newton = self.step_newton(&mut step, geometry, worst, limit);
            let correction = step.take(&newton, R::splat(0.0), worst, limit);
            worst = worst.select_lt(R::splat(limit), worst, correction);
            if worst.max_lane() < limit {
                break;
            }
        }
        // A NaN is not below the limit.
        step.X[S - 1] = worst.select_lt(R::splat(SOLVED), step.X[S - 1], R::splat(f64::NAN));
        step.K[S - 1] = worst.select_lt(R::splat(SOLVED), step.K[S - 1], R::splat(f64::NAN));
        step
    }

    /// One Newton step for the stages of a step. Lanes whose last correction was small enough keep what they
    /// have: no lane's bits depend on how long another takes.
    #[inline(always)]
    pub(super) fn step_newton(
        &self,
        step: &mut Step<R>,
        geometry: &[LawGeometry<R>],
        correction: R,
        limit: f64,
    ) -> StageNewton<R> {
        out_of_line!(R, {
            let limit = R::splat(limit);
            let (f, d) = self.accelerations(step, geometry);
            let newton = stage_newton(step.u, step.h, &f, &d, &step.X);
            for i in 0..S {
                step.K[i] = correction.select_lt(limit, step.K[i], f[i]);
                step.D[i] = correction.select_lt(limit, step.D[i], d[i]);
            }
            step.growth = correction.select_lt(limit, step.growth, newton.u[S - 1]);
            newton
        })
    }
}

impl<R: Real> Step<R> {
    /// A step whose stages are still those of its start.
    #[inline(always)]
    pub(super) fn at_rest(phi: R, h: R, rows: [Row<R>; S], u: R) -> Self {
        let zero = R::splat(0.0);
        Step { phi, h, rows, u, X: [u; S], K: [zero; S], D: [zero; S], growth: zero }
    }

    /// A step whose stages are not known, as the machine there is not.
    #[inline(always)]
    pub fn unsolved(phi: R, h: R, u: R) -> Self {
        let zero = R::splat(0.0);
        let row = Row { inverse: zero, drift: zero, load: zero, viscous: zero };
        Self::at_rest(phi, h, [row; S], u)
    }

    /// u at its end: the last stage.
    #[inline(always)]
    pub fn end(&self) -> R {
        self.X[S - 1]
    }

    /// Quintic through u at its start and its stages, over the share of the step.
    #[inline(always)]
    pub fn quintic(&self) -> [R; N] {
        let mut values = [self.u; N];
        values[1..].copy_from_slice(&self.X);
        through(&values)
    }

    /// Corrects the stages for a correction of the start; the largest relative correction.
    #[inline(always)]
    pub(super) fn take(&mut self, newton: &StageNewton<R>, delta: R, last: R, limit: f64) -> R {
        let (mut worst, limit) = (R::splat(0.0), R::splat(limit));
        for i in 0..S {
            let change = newton.u[i].mul_add(delta, newton.p[i]);
            let next = (self.X[i] + change).max(self.X[i] * SHRINK);
            let next = last.select_lt(limit, self.X[i], next);
            // The tangent gives ε at the corrected stage to the square of the correction.
            self.K[i] = self.D[i].mul_add(next - self.X[i], self.K[i]);
            worst = worst.max(change.abs() / self.X[i]);
            self.X[i] = next;
        }
        worst
    }

    /// Steepest ∂ε/∂u of its stages, in size \[1/rad\].
    #[inline(always)]
    pub fn steepness(&self) -> R {
        let mut steepest = self.D[0].abs();
        for d in &self.D[1..] {
            steepest = steepest.max(d.abs());
        }
        steepest
    }

    /// How long the step takes \[s\]: ∫ dφ/ω.
    #[inline(always)]
    pub fn duration(&self) -> R {
        let mut t = R::splat(0.0);
        for i in 0..S {
            t = (self.h * B[i] / (self.X[i] * 2.0).sqrt()) + t;
        }
        t
    }
}

/// Stages of a part of a step, from share `from` on by share `length`, on the step's quintic; not below a
/// share of what the part starts from, where a polynomial may swing.
#[inline(always)]
pub fn stages_of_part<R: Real>(quintic: &[R; N], from: R, length: R) -> [R; S] {
    let mut X = [from; S];
    let least = value(quintic, from) * SHRINK;
    for i in 0..S {
        X[i] = value(quintic, length.mul_add(R::splat(C[i]), from)).max(least);
    }
    X
}
