//! Derivatives by the numbers of the machine at given states: of motions over the crank angle, and of the acceleration.
//!
//! The kernels themselves in dual numbers, with a direction of the parameters in every lane. The state stays where it is:
//! whoever follows a motion adds what the state itself owes to the parameters.

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
    fn numbers<R: Real>(&self, first: usize) -> Vec<Dual<R>> {
        let mut lanes = vec![0.0; R::LANES];
        let width = R::LANES.min(self.n.saturating_sub(first));
        let dual = |(i, &value): (usize, &f64)| {
            lanes[..width].copy_from_slice(&self.values[i * self.n + first..][..width]);
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

/// States of the crank: times \[s\], angles \[rad\], speeds \[rad/s\].
#[derive(Clone, Copy)]
pub struct States<'a> {
    pub t: &'a [f64],
    pub phi: &'a [f64],
    pub omega: &'a [f64],
}

/// Derivatives of the acceleration at states, by each direction and then by angle and speed: `out` is (states,
/// directions + 2).
pub fn accelerations_along(of: Directions<'_>, at: States<'_>, out: &mut [f64]) {
    in_single_lanes(AccelerationsAlong { of, at, out });
}

struct AccelerationsAlong<'a> {
    of: Directions<'a>,
    at: States<'a>,
    out: &'a mut [f64],
}

impl Job for AccelerationsAlong<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let AccelerationsAlong { of, at, out } = self;
        let all = of.n + 2;
        let mut lanes = vec![0.0; R::LANES];
        for first in (0..all).step_by(R::LANES) {
            poll();
            let some = R::LANES.min(all - first);
            let q = of.numbers::<R>(first);
            let mut only = |direction: usize| {
                let is_it = |k| if first + k == direction { 1.0 } else { 0.0 };
                (0..R::LANES).for_each(|k| lanes[k] = is_it(k));
                R::load(&lanes)
            };
            let (by_angle, by_speed) = (only(of.n), only(of.n + 1));
            let machine = Machine::new(of.plan, &q);
            let mut m = Motion::new(&of.plan.mechanism, &q);
            let mut given = Vec::new();
            for i in 0..at.phi.len() {
                let phi = Dual { value: R::splat(at.phi[i]), d: by_angle };
                let omega = Dual { value: R::splat(at.omega[i]), d: by_speed };
                let r = of.plan.reduce::<Dual<R>, 2>(&q, Angle::new(phi), 1.0, &mut m);
                let torque: Dual<R> = of.plan.drive.torque(&of.plan.tables, &q, omega);
                let mut net = torque - r.load - r.dry - r.viscous * omega - r.J_d1 * omega.squared() * 0.5;
                if !of.plan.laws.is_empty() {
                    given.clear();
                    of.plan.give(&q, phi, &m, &mut given);
                    let t = Dual::constant(R::splat(at.t[i]));
                    net = net - machine.plan.law_torque::<Dual<R>, Dual<R>, Dual<R>>(&q, &given, omega, t);
                }
                (net / r.J).d.store(&mut lanes);
                out[i * all + first..][..some].copy_from_slice(&lanes[..some]);
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
