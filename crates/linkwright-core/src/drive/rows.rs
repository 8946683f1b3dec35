//! Rows of a batch: their parameters, and the numbers of their results.

use crate::drive::extremes::Extremes;
use crate::drive::measures::Totals;
use crate::kernel::real::Real;

/// Parameters that differ from row to row.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// Parameters of every row, before replacement.
    pub base: &'a [f64],
    /// Which of them are replaced.
    pub slots: &'a [usize],
    /// Their values: slot by slot, each with one value a row.
    pub values: &'a [f64],
    /// How many rows.
    pub n: usize,
}

impl Rows<'_> {
    /// Parameters of one row.
    pub fn row(&self, row: usize) -> Vec<f64> {
        let mut q = self.base.to_vec();
        self.replace(row, &mut q);
        q
    }

    /// Puts what differs in one row into parameters.
    pub(super) fn replace(&self, row: usize, q: &mut [f64]) {
        for (i, &slot) in self.slots.iter().enumerate() {
            q[slot] = self.values[i * self.n + row];
        }
    }

    /// Parameters of some rows, one a lane; the last is repeated past the end.
    #[inline(always)]
    pub(super) fn lanes<R: Real>(&self, rows: &[usize], q: &mut [R]) {
        let mut lanes = vec![0.0; R::LANES];
        for (i, &slot) in self.slots.iter().enumerate() {
            let column = &self.values[i * self.n..(i + 1) * self.n];
            for (lane, value) in lanes.iter_mut().enumerate() {
                *value = column[rows[lane.min(rows.len() - 1)]];
            }
            q[slot] = R::load(&lanes);
        }
    }
}

/// Quantities of a row's steady motion, in the order of a result row.
pub const QUANTITIES: usize = 13;

/// Measures of a revolution as a row of numbers:
/// speed min, max; acceleration min, max; period; multiplier; motor work, crank work, load work;
/// torque mean, rms; crank angles of the speed's extremes.
pub(super) fn row_of<R: Real>(multiplier: R, e: &Extremes<R>, t: &Totals<R>) -> [R; QUANTITIES] {
    [
        e.speed_min.value,
        e.speed_max.value,
        e.acceleration_min.value,
        e.acceleration_max.value,
        t.period,
        multiplier,
        t.motor_work,
        t.crank_work,
        t.load_work,
        t.torque_mean,
        t.torque_rms,
        e.speed_min.phi,
        e.speed_max.phi,
    ]
}
