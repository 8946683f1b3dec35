//! The solution inside the steps of a revolution as series: u and time over the share of a step.
//!
//! The solved turn is exact at the ends of its steps, by order 9; inside them its quintics are not. Collocation at more
//! nodes, one correction of Newton from these quintics, gives what lies between as exactly as the ends, to be read at any
//! angle without solving anything. Where a step ends on a kink of the drive, its last stage may lie behind it; no node does, so
//! that the series are those of the step's side up to its end.
//!
//! There are no series where the solution changes too fast within a step for them, as behind a kink under a steep motor,
//! or where laws keep to branches: there it is read by a step of its own ([`crate::drive::reading`]).

use crate::drive::cycle::Turn;
use crate::drive::equation::Machine;
use crate::drive::layout::unbundle;
use crate::kernel::out_of_line;
use crate::kernel::radau::value as on_quintic;
use crate::kernel::real::Real;
use crate::kernel::series::{G, SHARES, TERMS, integral, missing, newton, terms};
use crate::linkage::motion::Motion;

/// Share of the accuracy that the series may miss, by an estimate that is some ten times too high: they are to add nothing
/// to the error of the steps.
const SHARE: f64 = 0.5;

/// Most corrections; the first is as good as the square of what the quintics miss.
const CORRECTIONS: usize = 3;

/// u and time inside a step.
#[derive(Clone, Copy, Debug)]
pub struct Between<T> {
    /// Terms of u \[rad²/s²\].
    pub u: [T; TERMS],
    /// Terms of the time from the start of the step \[s\].
    pub t: [T; TERMS],
}

impl<R: Real> Turn<R> {
    /// The series of all steps of one machine with the relative error by which they may be off, if they are as exact as
    /// `accuracy` asks; `scale` is what errors of the acceleration count against.
    #[inline(always)]
    pub fn between(
        &self,
        machine: &Machine<'_, R>,
        accuracy: f64,
        scale: f64,
        m: &mut Motion<R>,
    ) -> Option<(Vec<Between<R>>, f64)> {
        if machine.keeps_branch {
            return None;
        }
        let (mut all, mut worst) = (Vec::with_capacity(self.steps.len()), 0.0_f64);
        for k in 0..self.steps.len() {
            let (series, error) = self.between_of(machine, k, accuracy, scale, m);
            // A NaN is not below the limit.
            worst = worst.max(error.select_lt(R::splat(SHARE), error, R::splat(f64::INFINITY)).max_lane());
            if worst > SHARE {
                return None;
            }
            all.push(series);
        }
        Some((all, worst * accuracy))
    }

    /// The series of one bundle of steps, and what they miss per accuracy.
    #[inline(always)]
    fn between_of(
        &self,
        machine: &Machine<'_, R>,
        k: usize,
        accuracy: f64,
        scale: f64,
        m: &mut Motion<R>,
    ) -> (Between<R>, R) {
        out_of_line!(R, {
            let step = &self.steps[k];
            let zero = R::splat(0.0);
            let (mut x, mut f, mut d) = ([step.u; G], [zero; G], [zero; G]);
            let (mut rows, mut geometry) = ([step.rows[0]; G], Vec::new());
            let quintic = step.quintic();
            for i in 0..G {
                rows[i] = machine.row(step.h.mul_add(R::splat(SHARES[i]), step.phi), m, &mut geometry);
                x[i] = on_quintic(&quintic, R::splat(SHARES[i]));
            }
            let mut squared = zero;
            for _ in 0..CORRECTIONS {
                for i in 0..G {
                    let epsilon = machine.acceleration(&rows[i], machine.geometry_at(&geometry, i), x[i]);
                    (f[i], d[i]) = (epsilon.value, epsilon.d);
                }
                let delta = newton(step.u, step.h, &f, &d, &x);
                let (mut worst, mut steepest) = (zero, d[0].abs());
                for i in 0..G {
                    worst = worst.max(delta[i].abs() / x[i]);
                    steepest = steepest.max(d[i].abs());
                    x[i] = x[i] + delta[i];
                    // The tangent gives ε at the corrected node to the square of the correction.
                    f[i] = d[i].mul_add(delta[i], f[i]);
                }
                // What the next correction would be: of the speed, and what a steep drive makes of it.
                let of_acceleration = steepest * step.u * (1.0 / scale);
                squared = worst.squared() * (of_acceleration + 1.0) * (1.0 / accuracy);
                if squared.max_lane() < 0.1 * SHARE {
                    break;
                }
            }
            let slope = terms(&f);
            let u = integral(step.u, step.h, &slope);
            let mut pace = x;
            for i in 0..G {
                pace[i] = (x[i] * 2.0).sqrt().recip();
            }
            let pace = terms(&pace);
            let left = missing(step.h, &slope);
            let mut steepest = d[0].abs();
            for d in &d[1..] {
                steepest = steepest.max(d.abs());
            }
            let of_speed = left / step.u * (0.5 / accuracy);
            let of_acceleration = steepest * left * (1.0 / (accuracy * scale));
            let of_time = missing(R::splat(1.0), &pace) / pace[0] * (1.0 / accuracy);
            let error = of_speed.max(of_acceleration).max(of_time).max(squared);
            (Between { u, t: integral(zero, step.h, &pace) }, error)
        })
    }

    /// The series of the steps in a row, those of no length left out.
    #[inline(always)]
    pub fn in_a_row(&self, series: &[Between<R>]) -> Vec<Between<f64>> {
        out_of_line!(R, {
            let mut row = Vec::with_capacity(series.len() * R::LANES);
            let mut numbers = vec![0.0; 2 * TERMS * R::LANES];
            for (step, series) in self.steps.iter().zip(series) {
                for (term, lanes) in series.u.iter().chain(&series.t).zip(numbers.chunks_exact_mut(R::LANES))
                {
                    term.store(lanes);
                }
                for (lane, h) in unbundle(&[step.h]).into_iter().enumerate() {
                    let of = |first: usize| std::array::from_fn(|i| numbers[(first + i) * R::LANES + lane]);
                    if h > 0.0 {
                        row.push(Between { u: of(0), t: of(TERMS) });
                    }
                }
            }
            row
        })
    }
}
