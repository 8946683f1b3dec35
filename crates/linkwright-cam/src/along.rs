//! Derivatives of all rows of a cam at given angles by its dimensions, its lift and the angle itself.

use super::shape::ROWS;
use super::{Cam, Dimensions, Kind};
use linkwright_kernel::dual::Dual;
use linkwright_kernel::lanes::{Job, in_common_lanes};
use linkwright_kernel::motion_law::MotionLaw;
use linkwright_kernel::real::Real;

/// A cam at some angles, and n directions of its numbers.
#[derive(Clone, Copy)]
pub struct CamAlong<'a> {
    pub kind: Kind,
    pub sense: f64,
    pub side: f64,
    pub size: Dimensions<f64>,
    pub law: &'a MotionLaw,
    /// Cam angles \[rad\]; at a joint from after it, or from `before`.
    pub phi: &'a [f64],
    pub before: bool,
    /// How many directions there are.
    pub n: usize,
    /// Of the dimensions in their order, (6, n).
    pub size_d: &'a [f64],
    /// Of the lift and its first three derivatives at a fixed angle, (4, angles, n).
    pub lift_d: &'a [f64],
    /// Of the angles, (angles, n).
    pub phi_d: &'a [f64],
}

impl CamAlong<'_> {
    /// The derivatives: `to` is (rows, angles, n).
    pub fn rows(self, to: &mut [f64]) {
        in_common_lanes(Rows { of: self, to });
    }
}

struct Rows<'a, 'b> {
    of: CamAlong<'a>,
    to: &'b mut [f64],
}

impl Job for Rows<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Rows { of, to } = self;
        let mut lanes = vec![0.0; R::LANES];
        for first in (0..of.n).step_by(R::LANES) {
            let some = R::LANES.min(of.n - first);
            let mut d = |list: &[f64], row: usize| {
                lanes[..some].copy_from_slice(&list[row * of.n + first..][..some]);
                R::load(&lanes)
            };
            let Dimensions { base_radius, roller_radius, offset, distance, arm, tilt } = of.size;
            let numbers = [base_radius, roller_radius, offset, distance, arm, tilt];
            let mut k = 0;
            let [base_radius, roller_radius, offset, distance, arm, tilt] = numbers.map(|value| {
                let dual = Dual { value: R::splat(value), d: d(of.size_d, k) };
                k += 1;
                dual
            });
            let size = Dimensions { base_radius, roller_radius, offset, distance, arm, tilt };
            let cam = Cam::new(of.kind, of.sense, of.side, size);
            let states: Vec<_> = (0..of.phi.len())
                .map(|i| {
                    let (piece, at) = of.law.piece(of.phi[i], of.before);
                    let phi = Dual { value: R::splat(at), d: d(of.phi_d, i) };
                    let mut s: [Dual<R>; 4] = piece.at(phi);
                    for (order, s) in s.iter_mut().enumerate() {
                        s.d = s.d + d(of.lift_d, order * of.phi.len() + i);
                    }
                    (phi, s)
                })
                .collect();
            let mut found = vec![0.0; R::LANES];
            for (i, &(phi, s)) in states.iter().enumerate() {
                for (row, x) in cam.row_of(s, phi).into_iter().enumerate() {
                    x.d.store(&mut found);
                    let place = (row * of.phi.len() + i) * of.n + first;
                    to[place..place + some].copy_from_slice(&found[..some]);
                }
            }
        }
        debug_assert_eq!(to.len(), ROWS * of.phi.len() * of.n);
    }
}
