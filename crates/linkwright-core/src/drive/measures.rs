//! Integrals over a revolution: its duration, work, and the torque of the motor.
//!
//! Source of δ, H, k_p: paper 1, equations (13)–(15).

use crate::drive::cycle::Turn;
use crate::drive::equation::{Machine, Row};
use crate::drive::law::LawGeometry;
use crate::drive::layout::Layout;
use crate::drive::step::{REFERENCE, Step};
use crate::kernel::branch::OnBranch;
use crate::kernel::out_of_line;
use crate::kernel::radau::{B, S};
use crate::kernel::real::{Lift, Real};

/// Integrals over a revolution, by the quadrature of the steps (order 9).
#[derive(Clone, Copy, Debug)]
pub struct Totals<R> {
    /// Duration of the revolution \[s\].
    pub period: R,
    /// Work of the motor at its shaft \[J\].
    pub motor_work: R,
    /// Work that reaches the crank from the motor \[J\].
    pub crank_work: R,
    /// Work taken by all loads \[J\].
    pub load_work: R,
    /// Mean over time of the motor's torque \[N m\].
    pub torque_mean: R,
    /// Root mean square over time of the motor's torque \[N m\].
    pub torque_rms: R,
}

/// What is integrated over a revolution: time, work of the motor, work at the crank, work of the loads \[J\], and
/// the motor's torque and its square over time.
pub const INTEGRALS: usize = 6;

impl<R: Real> Machine<'_, R> {
    /// Torque of the motor at its shaft, the same at the crank, and load torque, at a stage \[N m\].
    #[inline(always)]
    pub fn torques(&self, step: &Step<R>, geometry: &[LawGeometry<R>], stage: usize) -> [R; 3] {
        let own = self.geometry_at(geometry, stage);
        let reference =
            self.is_on_branch(stage).then(|| (self.geometry_at(geometry, REFERENCE), step.X[REFERENCE]));
        self.torques_beside(&step.rows[stage], own, step.X[stage], reference)
    }

    /// The same of a row at u, with laws on the branch of a reference if there is one.
    #[inline(always)]
    pub fn torques_beside<N: Lift<R>>(
        &self,
        row: &Row<R>,
        geometry: &[LawGeometry<R>],
        u: N,
        reference: Option<(&[LawGeometry<R>], R)>,
    ) -> [N; 3]
    where
        OnBranch<N, R>: Lift<R> + Lift<OnBranch<R, R>>,
    {
        let Some((known, at)) = reference.filter(|_| !geometry.is_empty()) else {
            return self.torques_at(row, geometry, u);
        };
        let [torque, geared, drag] = self.torques_at(row, &[], u);
        let omega = (OnBranch { value: u, at } * 2.0).sqrt();
        [torque, geared, drag + self.laws_on_branch(geometry, known, omega).value]
    }

    /// The same of a row at u, with laws as they are there.
    #[inline(always)]
    pub fn torques_at<N: Lift<R>>(&self, row: &Row<R>, geometry: &[LawGeometry<R>], u: N) -> [N; 3] {
        out_of_line!(N, {
            let (drive, tables) = (&self.plan.drive, &self.plan.tables);
            let omega = (u * 2.0).sqrt();
            let torque = drive.motor_torque(tables, self.q, omega);
            let mut drag = N::lift(row.viscous).mul_add(omega, N::lift(row.load));
            if !drive.speed_loads.is_empty() {
                drag = drag + drive.speed_load(tables, self.q, omega);
            }
            if !geometry.is_empty() {
                drag = drag + self.laws(geometry, omega);
            }
            [torque, drive.geared_torque(self.q, torque), drag]
        })
    }

    /// The integrals over one step.
    #[inline(always)]
    pub fn integrals(&self, step: &Step<R>, geometry: &[LawGeometry<R>]) -> [R; INTEGRALS] {
        out_of_line!(R, {
            let q = self.q;
            let mut sums = [R::splat(0.0); INTEGRALS];
            for i in 0..S {
                let dphi = step.h * B[i];
                let omega = (step.X[i] * 2.0).sqrt();
                let dt = dphi / omega;
                let [torque, geared, drag] = self.torques(step, geometry, i);
                sums[0] = sums[0] + dt;
                sums[1] = (torque * q[self.plan.drive.ratio]).mul_add(dphi, sums[1]);
                sums[2] = geared.mul_add(dphi, sums[2]);
                sums[3] = drag.mul_add(dphi, sums[3]);
                sums[4] = torque.mul_add(dt, sums[4]);
                sums[5] = torque.squared().mul_add(dt, sums[5]);
            }
            sums
        })
    }
}

impl<R: Real> Totals<R> {
    /// From the integrals over a revolution.
    #[inline(always)]
    pub(super) fn new(layout: Layout, sums: [R; INTEGRALS]) -> Self {
        let mut totals = sums;
        for total in &mut totals {
            *total = layout.total(*total);
        }
        let [period, motor_work, crank_work, load_work, impulse, heat] = totals;
        let torque_mean = impulse / period;
        let torque_rms = (heat / period).sqrt();
        Totals { period, motor_work, crank_work, load_work, torque_mean, torque_rms }
    }
}

impl<R: Real> Turn<R> {
    /// Integrals over the revolution.
    #[inline(always)]
    pub fn totals(&self, machine: &Machine<'_, R>) -> Totals<R> {
        out_of_line!(R, {
            let mut sums = [R::splat(0.0); INTEGRALS];
            for (k, step) in self.steps.iter().enumerate() {
                let parts = machine.integrals(step, self.geometry_of(machine, k));
                for i in 0..INTEGRALS {
                    sums[i] = sums[i] + parts[i];
                }
            }
            Totals::new(self.layout, sums)
        })
    }
}
