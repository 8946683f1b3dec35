//! A solved revolution of machines in lanes at ten nodes a step: corrected there, read there, and its error measured.
//!
//! The stages of a step and their quintic solve the equation of motion at the stages only. At five more places
//! ([`crate::kernel::nested`]) what they miss is evaluated; the linear variation of the motion along them, closed over the
//! revolution, corrects u at all ten nodes. Everything that is returned is taken from there: u as a series, its multiplier,
//! work and torque.
//!
//! The error of what is returned is measured after the correction. The equation of motion is evaluated once more, at the
//! corrected nodes, and integrated: what it misses is left by the correction. The last terms of its series tell what ten
//! nodes do not resolve. Both are carried from step to step and closed over the revolution, and count as errors of speed
//! and, by the steepness of the drive, of acceleration. An integral errs by less than its value at the five stages differs
//! from that at ten nodes.

use crate::drive::between::Between;
use crate::drive::check::EVEN;
use crate::drive::cycle::Turn;
use crate::drive::differences::ROUNDING;
use crate::drive::equation::{Machine, Row};
use crate::drive::law::LawGeometry;
use crate::drive::measures::{INTEGRALS, Totals};
use crate::drive::step::REFERENCE;
use crate::kernel::dual::Dual;
use crate::kernel::nested::{
    Correction, END, MORE, SHARES, START, WEIGHTS, correction, residual, spread, terms, unresolved, whole,
};
use crate::kernel::out_of_line;
use crate::kernel::radau::{B, S, value};
use crate::kernel::real::Real;
use crate::kernel::series::{G, TERMS, integral};
use crate::linkage::motion::Motion;

/// By how much more exact than at five stages an integral at ten nodes is, at least.
const WON: f64 = 8.0;

/// A kink is passed within this share of a step beside its end.
const BESIDE: f64 = 0.01;

/// A step at its nodes.
#[derive(Clone, Copy)]
struct NodeStep<R> {
    /// The machine at the nodes that are no stages.
    rows: [Row<R>; MORE],
    /// u at the nodes.
    x: [R; G],
    /// ε at the nodes.
    f: [R; G],
    /// What u is to be corrected by.
    correction: Correction<R>,
    /// What may be wrong in its end, and anywhere inside \[rad²/s²\].
    of_end: R,
    of_inside: R,
    /// Steepest ∂ε/∂u.
    steepest: R,
    /// Errors of integrals that have the size of the revolution's: of the exponent of growth, and of those over time.
    exponent: R,
    integrals: [R; INTEGRALS],
}

/// A revolution at the nodes of its steps.
#[derive(Clone)]
pub(super) struct NodeSolution<R> {
    steps: Vec<NodeStep<R>>,
    /// What laws need to know at the nodes that are no stages.
    geometry: Vec<LawGeometry<R>>,
    /// u over each step.
    pub between: Vec<Between<R>>,
    /// ε at the starts of the steps.
    pub starts: Vec<R>,
    /// The relative error of each step in each lane.
    pub errors: Vec<R>,
    /// The largest of each lane; infinite above what is promised.
    pub worst: R,
    /// What rounding of the speed may leave of the acceleration in each lane, relative to its peak.
    pub noise: R,
}

impl<R: Real> NodeSolution<R> {
    /// Of no revolution yet.
    pub(super) fn new() -> Self {
        NodeSolution {
            steps: Vec::new(),
            geometry: Vec::new(),
            between: Vec::new(),
            starts: Vec::new(),
            errors: Vec::new(),
            worst: R::splat(f64::INFINITY),
            noise: R::splat(0.0),
        }
    }

    /// Corrects a solved revolution and measures its error; lanes that err by less than is `promised` take the corrected motion
    /// over. `kinks` has u at the kink of the drive that is passed at each end of a step, 0 in lanes in which there is none. Returns
    /// its integrals.
    #[inline(always)]
    pub(super) fn correct(
        &mut self,
        turn: &mut Turn<R>,
        machine: &Machine<'_, R>,
        kinks: &[R],
        promised: f64,
        m: &mut Motion<R>,
    ) -> Totals<R> {
        self.geometry.clear();
        if self.steps.len() != turn.steps.len() {
            self.steps.resize(turn.steps.len(), NodeStep::empty());
        }
        for k in 0..turn.steps.len() {
            out_of_line!(R, self.evaluate(turn, machine, k, kinks[k + 1], m));
        }
        let growth: Vec<R> = self.steps.iter().map(|step| step.correction.u[END]).collect();
        let ends = turn.layout.ends(&turn.steps.iter().map(|step| step.u).collect::<Vec<_>>());
        let mut defect = ends;
        for (defect, step) in defect.iter_mut().zip(&self.steps) {
            *defect = step.x[END] + step.correction.p[END] - *defect;
        }
        let (delta, _) = turn.layout.close(&growth, &defect);
        let (mut sums, mut exponent) = ([R::splat(0.0); INTEGRALS], R::splat(0.0));
        self.between.clear();
        self.starts.clear();
        for (k, &delta) in delta.iter().enumerate() {
            let (of_step, grown) =
                out_of_line!(R, self.take(turn, machine, k, delta, [kinks[k], kinks[k + 1]]));
            for (sum, part) in sums.iter_mut().zip(of_step) {
                *sum = *sum + part;
            }
            exponent = exponent + grown;
        }
        turn.multiplier = exponent.exp();
        for k in 0..turn.steps.len() {
            if kinks[k + 1].max_lane() > 0.0 {
                self.take_corner(turn, machine, k, kinks[k + 1], m);
            }
        }
        out_of_line!(R, self.measure(turn, machine, &growth, &sums));
        self.give_to(turn, promised);
        Totals::new(turn.layout, sums)
    }

    /// A step at its nodes, and what it is to be corrected by.
    #[inline(always)]
    fn evaluate(&mut self, turn: &Turn<R>, machine: &Machine<'_, R>, k: usize, kink: R, m: &mut Motion<R>) {
        let (step, at, zero) = (&turn.steps[k], &mut self.steps[k], R::splat(0.0));
        at.x[..S].copy_from_slice(&step.X);
        at.f[..S].copy_from_slice(&step.K);
        at.x[START] = step.u;
        let quintic = step.quintic();
        for i in START + 1..G {
            at.x[i] = value(&quintic, R::splat(SHARES[i]));
        }
        for i in 0..MORE {
            let phi = step.h.mul_add(R::splat(SHARES[S + i]), step.phi);
            at.rows[i] = if S + i == START {
                machine.row_at_end(phi, machine.inside_by(step.h), m, &mut self.geometry)
            } else {
                machine.row(phi, m, &mut self.geometry)
            };
        }
        let of_stages = turn.geometry_of(machine, k);
        for i in 0..MORE {
            let (row, u) = (&at.rows[i], at.x[S + i]);
            let own = machine.geometry_at(&self.geometry, k * MORE + i);
            let reference = reference_of(machine, S + i, of_stages, step.X[REFERENCE]);
            let [_, geared, drag] = machine.torques_beside(row, own, u, reference);
            at.f[S + i] = (geared - drag) * row.inverse - row.drift * u;
        }
        let mut slopes = step.D;
        if kink.max_lane() > 0.0 {
            let besides = machine.slope_besides(&step.rows[END], step.X[END], step.X[REFERENCE]);
            slopes[END] = zero.select_lt(kink, slopes[END] + besides, slopes[END]);
        }
        let missed = residual(step.u, step.h, &at.f, &at.x);
        at.correction = correction(step.h, &spread(&slopes), &missed);
    }

    /// Takes the correction over into a step, and looks at what is left. Returns the integrals over the step, and that of
    /// ∂ε/∂u.
    #[inline(always)]
    fn take(
        &mut self,
        turn: &mut Turn<R>,
        machine: &Machine<'_, R>,
        k: usize,
        delta: R,
        kinks: [R; 2],
    ) -> ([R; INTEGRALS], R) {
        let (at, zero) = (&mut self.steps[k], R::splat(0.0));
        let (mut d, mut parts) = ([zero; G], [[zero; G]; INTEGRALS]);
        for i in 0..G {
            let by = at.correction.u[i].mul_add(delta, at.correction.p[i]);
            at.x[i] = at.x[i] + by;
        }
        let step = &turn.steps[k];
        let (h, geometry) = (step.h, turn.geometry_of(machine, k));
        for i in 0..G {
            let row = if i < S { &step.rows[i] } else { &at.rows[i - S] };
            let own = if i < S {
                machine.geometry_at(geometry, i)
            } else {
                machine.geometry_at(&self.geometry, k * MORE + i - S)
            };
            let reference = reference_of(machine, i, geometry, at.x[REFERENCE]);
            let [torque, geared, drag] = machine.torques_beside(row, own, Dual::variable(at.x[i]), reference);
            let net = (geared - drag) * Dual::constant(row.inverse);
            (at.f[i], d[i]) = (net.value - row.drift * at.x[i], net.d - row.drift);
            let dt = (at.x[i] * 2.0).sqrt().recip();
            let impulse = torque.value * dt;
            parts[0][i] = dt;
            parts[1][i] = torque.value * machine.q[machine.plan.drive.ratio];
            parts[2][i] = geared.value;
            parts[3][i] = drag.value;
            parts[4][i] = impulse;
            parts[5][i] = impulse * torque.value;
        }
        for (node, kink) in [(START, kinks[0]), (END, kinks[1])] {
            if kink.max_lane() > 0.0 {
                let row = if node == END { &step.rows[END] } else { &at.rows[0] };
                let besides = machine.slope_besides(row, at.x[node], at.x[REFERENCE]);
                d[node] = zero.select_lt(kink, d[node] + besides, d[node]);
            }
        }
        let start = at.x[START];
        let slope = terms(&at.f);
        let mut u = integral(start, h, &slope);
        // All polynomials are 1 at the end of the step: the line from nothing to what the step's end has besides.
        let mut end = u[0];
        for term in &u[1..] {
            end = end + *term;
        }
        let rest = (at.x[END] - end) * 0.5;
        (u[0], u[1]) = (u[0] + rest, u[1] + rest);
        self.between.push(Between { u, t: [zero; TERMS] });
        self.starts.push(at.f[START]);
        let missed = residual(start, h, &at.f, &at.x);
        let mut most = missed[0].abs();
        for r in &missed[1..] {
            most = most.max(r.abs());
        }
        let left = unresolved(h, &slope);
        at.of_end = left.mul_add(R::splat(1.0 / WON), missed[END].abs());
        at.of_inside = most + left;
        at.steepest = d[0].abs();
        for d in &d[1..] {
            at.steepest = at.steepest.max(d.abs());
        }
        let (mut sums, mut errors) = ([zero; INTEGRALS], [zero; INTEGRALS]);
        for i in 0..INTEGRALS {
            (sums[i], errors[i]) = both(h, &parts[i]);
        }
        let (exponent, off) = both(h, &d);
        (at.exponent, at.integrals) = (off, errors);
        turn.steps[k].D.copy_from_slice(&d[..S]);
        (sums, exponent)
    }

    /// The acceleration at the end of a step on a kink, where it has a corner that may be its extreme: at the angle at which
    /// the corrected motion passes the kink.
    #[inline(always)]
    fn take_corner(
        &mut self,
        turn: &Turn<R>,
        machine: &Machine<'_, R>,
        k: usize,
        kink: R,
        m: &mut Motion<R>,
    ) {
        let (n, zero, mut geometry) = (turn.steps.len(), R::splat(0.0), Vec::new());
        let (step, solved) = (&turn.steps[k], &mut self.steps[k]);
        let by = (kink - solved.x[END]) / solved.f[END];
        // A NaN is not below the limit.
        let by = by.abs().select_lt(step.h * BESIDE, by, zero);
        let row = machine.row(step.h.mul_add(R::splat(SHARES[END]), step.phi) + by, m, &mut geometry);
        let at = zero.select_lt(kink, kink, solved.x[END]);
        let [_, geared, drag] = machine.torques_at(&row, &geometry, at);
        let epsilon = (geared - drag) * row.inverse - row.drift * at;
        solved.f[END] = zero.select_lt(kink, epsilon, solved.f[END]);
        let start = &mut self.starts[(k + 1) % n];
        *start = zero.select_lt(kink, epsilon, *start);
    }

    /// The relative errors of the steps: of speed, of acceleration relative to its peak, of torque relative to its root mean
    /// square, of growth, of the period, and of torque over time.
    #[inline(always)]
    fn measure(&mut self, turn: &Turn<R>, machine: &Machine<'_, R>, growth: &[R], sums: &[R; INTEGRALS]) {
        let zero = R::splat(0.0);
        let (mut epsilon, mut u) = (zero, zero);
        for step in &self.steps {
            for i in 0..G {
                epsilon = epsilon.max(step.f[i].abs());
                u = u.max(step.x[i]);
            }
        }
        let per_epsilon = epsilon.max(u * (2.0 * EVEN)).recip();
        let of_ends: Vec<R> = self.steps.iter().map(|step| step.of_end).collect();
        let (carried, _) = turn.layout.close(growth, &of_ends);
        // A machine without torque has none to err in.
        let heat = sums[5].max(R::splat(f64::MIN_POSITIVE));
        let (per_time, per_heat) = ((sums[0] * WON).recip(), (heat * (2.0 * WON)).recip());
        let per_impulse = ((heat * sums[0]).sqrt() * WON).recip();
        let per_growth = turn.multiplier * (1.0 / WON);
        // Per torque at the crank: the motor's, by its root mean square.
        let per_torque = (sums[0] / heat).sqrt() / machine.q[machine.plan.drive.ratio];
        self.noise = zero;
        self.errors.clear();
        for ((step, solved), carried) in self.steps.iter().zip(&turn.steps).zip(carried) {
            self.noise = self.noise.max(step.steepest * step.x[START] * per_epsilon * ROUNDING);
            let off = step.of_inside + carried.abs();
            let of_acceleration = off * step.steepest;
            let of_torque = (step.integrals[5] * per_heat).max(step.integrals[4] * per_impulse);
            let parts = [
                off * 0.5 / step.x[START],
                of_acceleration * per_epsilon,
                of_acceleration / solved.rows[END].inverse * per_torque,
                step.exponent * per_growth,
                step.integrals[0] * per_time,
                of_torque,
            ];
            let (mut error, infinity) = (zero, R::splat(f64::INFINITY));
            for part in parts {
                // A NaN is not below the limit.
                error = error.max(part.select_lt(infinity, part, infinity));
            }
            self.errors.push(error);
        }
    }
}

impl<R: Real> NodeSolution<R> {
    /// Gives the corrected motion to lanes that err by less than is promised. The others keep what the stages solved, from which
    /// finer meshes start: where steps are much too long it is nearer than what the correction makes of it.
    #[inline(always)]
    fn give_to(&mut self, turn: &mut Turn<R>, promised: f64) {
        let (limit, infinity) = (R::splat(promised), R::splat(f64::INFINITY));
        self.worst = R::splat(0.0);
        for &error in &self.errors {
            // A NaN is not below the limit.
            self.worst = self.worst.max(error.select_lt(limit, error, infinity));
        }
        let take = |corrected: R, solved: R| self.worst.select_lt(infinity, corrected, solved);
        for (step, at) in turn.steps.iter_mut().zip(&self.steps) {
            step.u = take(at.x[START], step.u);
            for i in 0..S {
                step.X[i] = take(at.x[i], step.X[i]);
                step.K[i] = take(at.f[i], step.K[i]);
            }
        }
    }
}

impl<R: Real> NodeStep<R> {
    /// Of nothing.
    #[inline(always)]
    fn empty() -> Self {
        let zero = R::splat(0.0);
        NodeStep {
            rows: [Row { inverse: zero, drift: zero, load: zero, viscous: zero }; MORE],
            x: [zero; G],
            f: [zero; G],
            correction: Correction { p: [zero; G], u: [zero; G] },
            of_end: zero,
            of_inside: zero,
            steepest: zero,
            exponent: zero,
            integrals: [zero; INTEGRALS],
        }
    }
}

/// The state whose branch the laws at a node are on: at an end of a step where the machine may jump, that of its reference, which
/// has `u`; `geometry` is what laws know at the stages.
#[inline(always)]
fn reference_of<'g, R: Real>(
    machine: &Machine<'_, R>,
    node: usize,
    geometry: &'g [LawGeometry<R>],
    u: R,
) -> Option<(&'g [LawGeometry<R>], R)> {
    let is_end = [START, END].contains(&node) && machine.is_on_branch(END);
    is_end.then(|| (machine.geometry_at(geometry, REFERENCE), u))
}

/// The integral over a step by all nodes, and how much that by the stages alone differs.
#[inline(always)]
fn both<R: Real>(h: R, values: &[R; G]) -> (R, R) {
    let mut difference = R::splat(0.0);
    for i in 0..G {
        let besides = if i < S { WEIGHTS[i] - B[i] } else { WEIGHTS[i] };
        difference = values[i].mul_add(R::splat(besides), difference);
    }
    (h * whole(values), (h * difference).abs())
}
