//! Derivatives by the numbers of the machine at given crank angles: of motions, of the inertia, and of the kinks there.
//!
//! The kernels themselves in dual numbers, with a direction of the parameters in every lane.

use crate::moving_kinks::MovingKinks;
use linkwright_core::drive::equation::Machine;
use linkwright_core::drive::motions::store;
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::{Channel, Motion};
use linkwright_kernel::call::poll;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::lanes::{Job, in_common_lanes};
use linkwright_kernel::plane::Angle;
use linkwright_kernel::real::{LANES_MAX, Real};

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
    /// Those that move a number of the machine; along the others nothing changes.
    pub(crate) fn moving(&self) -> Vec<usize> {
        let moves = |&way: &usize| self.values.iter().skip(way).step_by(self.n).any(|&by| by != 0.0);
        (0..self.n).filter(moves).collect()
    }

    /// The numbers with some of the directions, one a lane; those beyond the last, and of directions that are none of the
    /// parameters, are constant.
    #[inline(always)]
    pub(crate) fn numbers<R: Real>(&self, some: &[usize]) -> Vec<Dual<R>> {
        let mut numbers = Vec::with_capacity(self.q.len());
        for (i, &value) in self.q.iter().enumerate() {
            let (row, mut lanes) = (&self.values[i * self.n..][..self.n], [0.0; LANES_MAX]);
            for (lane, &way) in lanes.iter_mut().zip(some) {
                *lane = row.get(way).copied().unwrap_or(0.0);
            }
            numbers.push(Dual { value: R::splat(value), d: R::load(&lanes) });
        }
        numbers
    }
}

/// Writes lanes to the places of some directions in a row.
#[inline(always)]
pub(crate) fn put<R: Real>(x: R, some: &[usize], row: &mut [f64]) {
    let mut lanes = [0.0; LANES_MAX];
    x.store(&mut lanes);
    for (&lane, &way) in lanes.iter().zip(some) {
        row[way] = lane;
    }
}

/// Derivatives of motions at crank angles: `out` is (numbers of the channels, angles, directions), zero at first.
pub fn motions_along(of: Directions<'_>, phi: &[f64], channels: &[Channel], out: &mut [f64]) {
    in_common_lanes(MotionsAlong { of, phi, channels, out });
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
        for some in of.moving().chunks(R::LANES) {
            poll();
            let q = of.numbers::<R>(some);
            let mut m = Motion::new(&of.plan.mechanism, &q);
            for (at, &angle) in phi.iter().enumerate() {
                let angle = Angle::new(Dual::constant(R::splat(angle)));
                of.plan.mechanism.place::<Dual<R>, 2>(&q, angle, &mut m);
                let mut lists: Vec<&mut [f64]> = found.iter_mut().map(Vec::as_mut_slice).collect();
                store(&m, channels, 0, &mut lists, |x: Dual<R>, to| x.d.store(to));
                for (row, lanes) in found.iter().enumerate() {
                    put(R::load(lanes), some, &mut out[(row * phi.len() + at) * of.n..][..of.n]);
                }
            }
        }
    }
}

/// Derivatives of the reduced inertia and of its slope at crank angles: `out` is (2, angles, directions), zero at first.
pub fn inertias_along(of: Directions<'_>, phi: &[f64], out: &mut [f64]) {
    in_common_lanes(InertiasAlong { of, phi, out });
}

struct InertiasAlong<'a> {
    of: Directions<'a>,
    phi: &'a [f64],
    out: &'a mut [f64],
}

impl Job for InertiasAlong<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let InertiasAlong { of, phi, out } = self;
        for some in of.moving().chunks(R::LANES) {
            poll();
            let q = of.numbers::<R>(some);
            let mut m = Motion::new(&of.plan.mechanism, &q);
            for (at, &angle) in phi.iter().enumerate() {
                let angle = Angle::new(Dual::constant(R::splat(angle)));
                let reduced = of.plan.reduce::<Dual<R>, 2>(&q, angle, 1.0, &mut m);
                for (row, number) in [reduced.J, reduced.J_d1].into_iter().enumerate() {
                    put(number.d, some, &mut out[(row * phi.len() + at) * of.n..][..of.n]);
                }
            }
        }
    }
}

/// Derivatives of crank angles by each direction, where they are kinks: `out` is (angles, directions),
/// zero at first.
pub fn kinks_along(of: Directions<'_>, phi: &[f64], out: &mut [f64]) {
    in_common_lanes(KinksAlong { of, phi, out });
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
        for some in of.moving().chunks(R::LANES) {
            let q = of.numbers::<R>(some);
            let mut m = Motion::new(&of.plan.mechanism, &q);
            for (i, kink) in
                MovingKinks(Machine::new(of.plan, &q)).moving(phi, &mut m).into_iter().enumerate()
            {
                put(kink.d, some, &mut out[i * of.n..][..of.n]);
            }
        }
    }
}
