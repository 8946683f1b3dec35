//! Derivatives by the numbers of the machine at given crank angles: of motions, and of the kinks there.
//!
//! The kernels themselves in dual numbers, with a direction of the parameters in every lane.

use crate::drive::cycle::Machine;
use crate::drive::motions::store;
use crate::drive::structure::Plan;
use crate::kernel::call::poll;
use crate::kernel::dual::Dual;
use crate::kernel::lanes::{Job, in_single_lanes};
use crate::kernel::plane::Angle;
use crate::kernel::real::Real;
use crate::linkage::motion::{Channel, Motion};

/// The numbers of a machine, and directions of them.
#[derive(Clone, Copy)]
pub struct Directions<'a> {
    /// The machine's structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [f64],
    /// Directions, (parameters, n).
    pub values: &'a [f64],
    /// How many there are.
    pub n: usize,
}

impl Directions<'_> {
    /// The numbers with the directions from `first` on, one a lane; those beyond the last are zero.
    #[inline(always)]
    pub(super) fn numbers<R: Real>(&self, first: usize) -> Vec<Dual<R>> {
        let mut lanes = vec![0.0; R::LANES];
        let width = R::LANES.min(self.n.saturating_sub(first));
        let dual = |(i, &value): (usize, &f64)| {
            let row = &self.values[i * self.n..][..self.n];
            lanes[..width].copy_from_slice(&row[first.min(self.n)..][..width]);
            Dual { value: R::splat(value), d: R::load(&lanes) }
        };
        self.q.iter().enumerate().map(dual).collect()
    }
}

/// Derivatives of motions at crank angles: `out` is (numbers of the channels, angles, directions).
pub fn motions_along(of: Directions<'_>, phi: &[f64], channels: &[Channel], out: &mut [f64]) {
    in_single_lanes(MotionsAlong { of, phi, channels, out });
}

struct MotionsAlong<'a> {
    of: Directions<'a>,
    phi: &'a [f64],
    channels: &'a [Channel],
    out: &'a mut [f64],
}

impl Job for MotionsAlong<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let MotionsAlong { of, phi, channels, out } = self;
        let width: usize = channels.iter().map(|c| c.width()).sum();
        let mut found = vec![vec![0.0; R::LANES]; width];
        for first in (0..of.n).step_by(R::LANES) {
            poll();
            let some = R::LANES.min(of.n - first);
            let q = of.numbers::<R>(first);
            let mut m = Motion::new(&of.plan.mechanism, &q);
            for (at, &angle) in phi.iter().enumerate() {
                let angle = Angle::new(Dual::constant(R::splat(angle)));
                of.plan.mechanism.place::<Dual<R>, 2>(&q, angle, &mut m);
                let mut lists: Vec<&mut [f64]> = found.iter_mut().map(Vec::as_mut_slice).collect();
                store(&m, channels, 0, &mut lists, |x: Dual<R>, to| x.d.store(to));
                for (row, lanes) in found.iter().enumerate() {
                    let place = (row * phi.len() + at) * of.n + first;
                    out[place..place + some].copy_from_slice(&lanes[..some]);
                }
            }
        }
    }
}

/// Derivatives of crank angles by each direction, where they are kinks: `out` is (angles, directions).
pub fn kinks_along(of: Directions<'_>, phi: &[f64], out: &mut [f64]) {
    in_single_lanes(KinksAlong { of, phi, out });
}

struct KinksAlong<'a> {
    of: Directions<'a>,
    phi: &'a [f64],
    out: &'a mut [f64],
}

impl Job for KinksAlong<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let KinksAlong { of, phi, out } = self;
        let mut lanes = vec![0.0; R::LANES];
        for first in (0..of.n).step_by(R::LANES) {
            let some = R::LANES.min(of.n - first);
            let q = of.numbers::<R>(first);
            let mut m = Motion::new(&of.plan.mechanism, &q);
            for (i, kink) in Machine::new(of.plan, &q).moving(phi, &mut m).into_iter().enumerate() {
                kink.d.store(&mut lanes);
                out[i * of.n + first..][..some].copy_from_slice(&lanes[..some]);
            }
        }
    }
}
