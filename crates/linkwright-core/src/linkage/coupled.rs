//! Motions coupled in proportion: gears, planetary trains, belts, racks, cables, linear drivers.
//!
//! Most of them say that one coordinate is a sum of others times constants: a planet's angle is that of the
//! carrier times (1 − i) plus i times that of the sun; a cable on an arc of radius R runs out by R times
//! the angle of the arc. The angle of a link counts as a coordinate once [`AngleOf`] has made it continuous.

use super::guided::{Line, on_line};
use super::motion::Motion;
use crate::kernel::formula::{Formula, Inputs};
use crate::kernel::jet::Jet;
use crate::kernel::motion_law::MotionLaw;
use crate::kernel::plane::{Angle, Vec2};
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use serde::{Deserialize, Serialize};

/// What a term of a sum is proportional to.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub enum Source {
    /// The crank angle φ.
    Drive,
    /// A slide's coordinate, or a link's continuous angle kept as one.
    Slide(usize),
}

/// start + Σ factor · source.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Sum {
    pub start: Slot,
    pub terms: Vec<(Source, Slot)>,
}

impl Sum {
    /// The sum and its two derivatives.
    #[inline(always)]
    fn at<R: Real>(&self, q: &[R], angle: Angle<R>, m: &Motion<R>) -> [R; 3] {
        let mut sum = [q[self.start], R::splat(0.0), R::splat(0.0)];
        for &(source, factor) in &self.terms {
            let factor = q[factor];
            match source {
                Source::Drive => {
                    sum[0] = factor.mul_add(angle.phi, sum[0]);
                    sum[1] = sum[1] + factor;
                }
                Source::Slide(i) => {
                    let slide = &m.slides[i];
                    sum[0] = factor.mul_add(slide.s, sum[0]);
                    sum[1] = factor.mul_add(slide.d1, sum[1]);
                    sum[2] = factor.mul_add(slide.d2, sum[2]);
                }
            }
        }
        sum
    }
}

/// A link whose angle is a sum: a gear or a pulley. Its continuous angle is kept as a slide.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Turn {
    pub link: usize,
    pub slide: usize,
    pub angle: Sum,
}

/// A point on a guide whose coordinate is a sum: a rack, the end of a cable, a linear driver.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Runner {
    pub point: usize,
    pub slide: usize,
    pub line: Line,
    pub place: Sum,
}

/// The continuous angle of a link, kept as a slide: `winding` revolutions per revolution of the crank, and about that never
/// farther than half a revolution from `centre`.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct AngleOf {
    pub link: usize,
    pub slide: usize,
    pub winding: Slot,
    pub centre: Slot,
}

/// A coordinate that is a formula of the crank angle: the law of a driver.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Law {
    pub slide: usize,
    pub formula: Formula,
}

/// A coordinate that follows a motion law, which begins at crank angle `phase`: the lift of a cam's follower.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Programme {
    pub slide: usize,
    pub phase: Slot,
    pub law: MotionLaw,
}

#[inline(always)]
pub(super) fn programme<R: Real>(e: &Programme, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
    let [s, d1, d2] = e.law.at_numbers(angle.phi - q[e.phase], q);
    m.slides[e.slide].set(s, d1, d2);
}

/// The formula worked in series of φ, which brings its derivatives along.
#[inline(always)]
pub(super) fn law<R: Real>(e: &Law, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
    let found: Jet<R, 3> = e.formula.value(q, &Inputs::of_angle(Jet::variable(angle.phi)));
    m.slides[e.slide].set(found.c[0], found.c[1], found.c[2] * 2.0);
}

#[inline(always)]
pub(super) fn turn<R: Real>(e: &Turn, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
    let [psi, d1, d2] = e.angle.at(q, angle, m);
    let (sin, cos) = psi.sin_cos();
    m.slides[e.slide].set(psi, d1, d2);
    m.links[e.link].set(Vec2::new(cos, sin), d1, d2);
}

#[inline(always)]
pub(super) fn runner<R: Real, const ORDER: u8>(e: &Runner, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
    let s = e.place.at(q, angle, m);
    let place = on_line::<R, ORDER>(&e.line, q, m, s);
    m.slides[e.slide].set(s[0], s[1], s[2]);
    m.points[e.point].set(place.p, place.d1, place.d2);
}

/// ψ = ψ₀ + δ, ψ₀ = winding·φ + centre, δ in (−π, π] from the link's direction seen from ψ₀.
#[inline(always)]
pub(super) fn angle_of<R: Real>(e: &AngleOf, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
    let middle = q[e.winding].mul_add(angle.phi, q[e.centre]);
    let (sin, cos) = middle.sin_cos();
    let link = &m.links[e.link];
    let from = Vec2::new(cos, sin);
    let (aside, ahead) = (from.left().dot(link.e), from.dot(link.e));
    let psi = middle + aside.atan2(ahead);
    let (d1, d2) = (link.d1, link.d2);
    m.slides[e.slide].set(psi, d1, d2);
}
