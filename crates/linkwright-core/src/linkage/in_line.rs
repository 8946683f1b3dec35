//! Where the links of a dyad come into line, and whether its motion goes on there: change points of RRR and RRP.
//!
//! Links in line are a change point if they are so to rounding: the radicand touches zero, and the motion goes on
//! as [`super::folding`] has it, with a series made here once. Links that clearly have room to spare pass, or
//! clearly miss each other: both is motion like any other. In between the lengths do not tell which of two motions
//! that nearly meet goes on in which, and nothing is made up: the place is handed back as undecided.

use super::arm::{self, Fold};
use super::dyads::Rocker;
use super::folding::{TERMS, radicand, square};
use super::guided::{GuidedRod, Series, rod_radicand};
use super::mechanism::{Element, Mechanism};
use super::motion::Motion;
use crate::kernel::jet::Jet;
use crate::kernel::lanes::{Job, in_lanes};
use crate::kernel::plane::{Angle, Vec2};
use crate::kernel::real::Real;
use std::f64::consts::TAU;

/// Terms of the radicand's series: two more than of S/δ.
const ORDERS: usize = TERMS + 2;

/// Share of 4a²b², or of l², below which the radicand at its minimum counts as zero. Links then are in line to some
/// 1e-6 of their length: rounding of lengths given to all digits is far below, rounding of printed ones
/// far above.
const TOUCHES: f64 = 1e-12;

/// Rounding of (a + b)² − U, over [`TOUCHES`]: some 100 units of the last place.
const ROUNDING: f64 = 0.02;

/// Likewise of the distance of pin and pivot, over the sum of coupler and rocker: where the pin passes near its pivot
/// the radicand is small at any rate, and lengths are compared.
const MEETS: f64 = 1e-13;

/// Shares below which both count as undecided: the radicand, some 1e-16 of its maximum by rounding, has eight digits
/// left above.
const UNDECIDED: f64 = 1e-8;

/// Distance of pin and pivot over the sum of coupler and rocker below which an arm has its own series: the general
/// form still loses no more than the cube of this in third derivatives.
const NEAR: f64 = 0.05;

/// Farthest from a change point that the series of S is used \[rad\]: there the direct root has lost some 1/δ² = 1e3
/// of its digits in its slope. Nearer, where its last terms would be more than [`LAST_TERM`] of the first.
const REACH: f64 = 0.03;
const LAST_TERM: f64 = 1e-15;

/// Rounds of Newton on g′ = 0 from an angle of a fine grid: it doubles its digits in each.
const ROUNDS: usize = 20;

/// Angles of a first look over the revolution, and the share of its maximum above which a radicand has room to spare all
/// round: one that falls to zero between two of these angles is a few ten-thousandths at the nearer one.
const FEW: usize = 192;
const AMPLE: f64 = 0.02;

/// Angles of a fine look, and the share of its maximum below which the lowest of a parabola through three of them is
/// looked into.
const MANY: usize = 720;
const NEAR_ZERO: f64 = 1e-3;

/// Distance of two angles that are the same \[rad\]: Newton's last step is far below.
const SAME: f64 = 1e-6;

/// Where the links of a dyad come nearest to being in line.
#[derive(Clone, Debug)]
pub struct InLine {
    /// Crank angle \[rad\].
    pub phi: f64,
    /// What is left until they are in line \[m\]: negative where they do not meet.
    pub spare: f64,
    /// Numbers of a change point in the order of its fields; empty where it is undecided.
    pub series: Vec<f64>,
    /// Numbers of its two arms, where the pin passes near its pivot.
    pub arms: Vec<f64>,
    /// Whether the arm with S > 0, and that with S < 0, after the point has no digits left: it goes round about a
    /// pivot that the pin all but meets.
    pub lost: [bool; 2],
}

/// A dyad that may have change points.
enum Dyad {
    Rocker(Rocker),
    Rod(GuidedRod),
}

impl Dyad {
    fn of(mechanism: &Mechanism, element: usize) -> Option<Self> {
        match &mechanism.elements[element] {
            Element::Rocker(e) => Some(Dyad::Rocker(*e)),
            Element::SliderRod(e) => Some(Dyad::Rod(e.guided(mechanism.n_links))),
            Element::GuidedRod(e) => Some(Dyad::Rod(*e)),
            _ => None,
        }
    }

    #[inline(always)]
    fn radicand<R: Real>(&self, q: &[R], m: &Motion<R>) -> Series<R> {
        match self {
            Dyad::Rocker(e) => radicand(e, q, m),
            Dyad::Rod(e) => rod_radicand(e, q, m),
        }
    }

    /// What the radicand is measured against: its maximum value, and for links of very different length the
    /// rounding of its factors.
    fn size(&self, q: &[f64]) -> f64 {
        match self {
            Dyad::Rocker(e) => {
                let (a, b) = (q[e.coupler], q[e.rocker]);
                4.0 * a * b * (a * b + ROUNDING * (a + b).powi(2))
            }
            Dyad::Rod(e) => q[e.rod].powi(2),
        }
    }
}

/// How the links of a dyad stand where they are nearest to being in line.
struct Meeting {
    spare: f64,
    /// `spare` over a length, or the radicand over its size, and what counts as rounding of it.
    share: f64,
    rounding: f64,
    /// Of a pin near its pivot.
    fold: Option<Fold>,
}

/// The radicand of a dyad over the revolution.
struct OverTheTurn<'a> {
    probe: &'a DyadProbe<'a>,
    g: &'a mut [f64],
}

impl Job for OverTheTurn<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let n = self.g.len();
        let q: Vec<R> = self.probe.q.iter().map(|&x| R::splat(x)).collect();
        let mut m = Motion::new(self.probe.mechanism, &q);
        // Both numbers of angles are multiples of any number of lanes.
        for (block, g) in self.g.chunks_exact_mut(R::LANES).enumerate() {
            let angle = |i: usize| TAU * (block * R::LANES + i) as f64 / n as f64;
            let phi: Vec<f64> = (0..R::LANES).map(angle).collect();
            let at = Angle::new(R::load(&phi));
            self.probe.mechanism.place_first::<R, 1>(self.probe.element, &q, at, &mut m);
            self.probe.dyad.radicand(&q, &m)[0].store(g);
        }
    }
}

/// One dyad of a machine.
struct DyadProbe<'a> {
    mechanism: &'a Mechanism,
    element: usize,
    q: &'a [f64],
    dyad: Dyad,
}

impl DyadProbe<'_> {
    /// The mechanism before the dyad, at a crank angle.
    fn before<R: Real>(&self, q: &[R], phi: R) -> Motion<R> {
        let mut m = Motion::new(self.mechanism, q);
        self.mechanism.place_first::<_, 1>(self.element, q, Angle::new(phi), &mut m);
        m
    }

    /// Series of the radicand about a crank angle.
    fn radicand(&self, phi: f64) -> [f64; ORDERS] {
        let q: Vec<Jet<f64, ORDERS>> = self.q.iter().map(|&x| Jet::constant(x)).collect();
        let m = self.before(&q, Jet::variable(phi));
        self.dyad.radicand(&q, &m)[0].c
    }

    /// The radicand at angles spread evenly over the revolution.
    fn over_the_turn(&self, n: usize) -> Vec<f64> {
        let mut g = vec![0.0; n];
        in_lanes(OverTheTurn { probe: self, g: &mut g });
        g
    }

    /// Pivot and radius of the crank that has a pin, if any has.
    fn crank(&self, pin: usize) -> Option<(Vec2<f64>, f64)> {
        self.mechanism.elements[..self.element].iter().find_map(|element| match *element {
            Element::Crank { pin: other, pivot, radius, .. } if other == pin => {
                Some((self.ground(pivot)?, self.q[radius].abs()))
            }
            _ => None,
        })
    }

    /// A point of the ground.
    fn ground(&self, point: usize) -> Option<Vec2<f64>> {
        let fixed = self.mechanism.ground.iter().find(|fixed| fixed.point == point)?;
        Some(Vec2::new(self.q[fixed.x], self.q[fixed.y]))
    }

    /// Minimum and maximum of the radicand over the revolution, where the pin of a crank drives a dyad on the ground: from
    /// lengths alone.
    fn extremes_of_lengths(&self) -> Option<(f64, f64)> {
        let q = self.q;
        match &self.dyad {
            Dyad::Rod(e) if e.line.link == self.mechanism.n_links => {
                let (pivot, radius) = self.crank(e.pin)?;
                let from = pivot - self.ground(e.line.through)?;
                let aside = (q[e.line.cos] * from.y - q[e.line.sin] * from.x - q[e.line.offset]).abs();
                let [near, far] = [(aside - radius).max(0.0), aside + radius];
                let square = q[e.rod].powi(2);
                Some((square - far * far, square - near * near))
            }
            Dyad::Rod(_) => None,
            Dyad::Rocker(e) => {
                let (pivot, radius) = self.crank(e.pin)?;
                let apart = self.ground(e.pivot)? - pivot;
                let apart = apart.dot(apart).sqrt();
                let (a, b) = (q[e.coupler], q[e.rocker]);
                // Concave over u²: ((a + b)² − u²)(u² − (a − b)²).
                let at = |square: f64| ((a + b).powi(2) - square) * (square - (a - b).powi(2));
                let ends = [(apart - radius).powi(2), (apart + radius).powi(2)];
                let top = (a * a + b * b).max(ends[0]).min(ends[1]);
                Some((at(ends[0]).min(at(ends[1])), at(top)))
            }
        }
    }

    /// Whether the radicand is so large all round that it touches zero nowhere.
    fn is_ample(&self) -> bool {
        if self.extremes_of_lengths().is_some_and(|(least, most)| least > AMPLE * most) {
            return true;
        }
        let g = self.over_the_turn(FEW);
        let (least, most) = g.iter().fold((f64::INFINITY, 0.0), |(a, b), &x| (x.min(a), x.max(b)));
        least > AMPLE * most && g.iter().all(|x| x.is_finite())
    }

    /// Angles of a fine grid beside which the parabola through three of them comes near zero.
    fn lowest(&self) -> Vec<f64> {
        let g = self.over_the_turn(MANY);
        let size = g.iter().filter(|x| x.is_finite()).fold(0.0_f64, |most, x| most.max(x.abs()));
        let is_lowest = |&k: &usize| {
            let (before, here, after) = (g[(k + MANY - 1) % MANY], g[k], g[(k + 1) % MANY]);
            let bend = (before + after - 2.0 * here).max(1e-300);
            let vertex = here - (after - before).powi(2) / (8.0 * bend);
            here <= before && here <= after && vertex.abs() < NEAR_ZERO * size
        };
        (0..MANY).filter(is_lowest).map(|k| TAU * k as f64 / MANY as f64).collect()
    }

    /// What happens near an angle; `None` if the links clearly are not in line.
    fn near(&self, near: f64) -> Option<InLine> {
        let phi = self.minimum(near);
        let g = self.radicand(phi);
        let meeting = self.meeting(phi, g[0]);
        // Written so that NaN is refused too.
        let is_near = meeting.share.abs() <= UNDECIDED && g[2] > 0.0;
        if !is_near {
            return None;
        }
        let phi = phi.rem_euclid(TAU);
        let (series, arms, lost) = (Vec::new(), Vec::new(), [false; 2]);
        let mut found = InLine { phi, spare: meeting.spare, series, arms, lost };
        if meeting.share.abs() > meeting.rounding {
            return Some(found);
        }
        let mut h = Jet { c: [0.0; TERMS] };
        h.c.copy_from_slice(&g[2..]);
        found.series = numbers(phi, &h.sqrt().c);
        if let Some(fold) = &meeting.fold {
            (found.arms, found.lost) = self.arms(phi, fold);
        }
        Some(found)
    }

    /// Newton on g′ = 0.
    fn minimum(&self, near: f64) -> f64 {
        let mut phi = near;
        for _ in 0..ROUNDS {
            let g = self.radicand(phi);
            let step = -g[1] / (2.0 * g[2]);
            phi += step.clamp(-0.1, 0.1);
            if step.abs() < 1e-15 {
                break;
            }
        }
        phi
    }

    /// How the links stand at an angle with radicand `g`.
    fn meeting(&self, phi: f64, g: f64) -> Meeting {
        let share = g / self.dyad.size(self.q);
        let m = self.before(self.q, phi);
        let e = match &self.dyad {
            Dyad::Rocker(e) => e,
            Dyad::Rod(e) => {
                let l = self.q[e.rod];
                let spare = l - (l * l - g).max(0.0).sqrt();
                return Meeting { spare, share, rounding: TOUCHES, fold: None };
            }
        };
        let (a, b) = (self.q[e.coupler], self.q[e.rocker]);
        let (pin, pivot) = (&m.points[e.pin], &m.points[e.pivot]);
        let (u, u1) = (pivot.p - pin.p, pivot.d1 - pin.d1);
        let apart = square(pin, pivot)[0].sqrt();
        let (folded, stretched) = (apart - (a - b).abs(), a + b - apart);
        let spare = if folded < stretched { folded } else { stretched };
        if apart > NEAR * (a + b) {
            return Meeting { spare, share, rounding: TOUCHES, fold: None };
        }
        let coordinate = [pin.p, pivot.p].map(|p| p.x.abs().max(p.y.abs()));
        let coordinate = coordinate[0].max(coordinate[1]);
        // Eight units of the last place of what u is the difference of.
        let rounding = MEETS + 8.0 * f64::EPSILON * coordinate / (a + b);
        let meets = apart.max((a - b).abs()) <= rounding * (a + b);
        let far = coordinate / u1.dot(u1).sqrt();
        let excess = if meets { 0.0 } else { a - b };
        let fold = Fold { coupler: a, rocker: b, excess, u, far };
        Meeting { spare, share: folded / (a + b), rounding, fold: Some(fold) }
    }

    /// Numbers of both arms, and which of them has no digits left.
    fn arms(&self, phi: f64, fold: &Fold) -> (Vec<f64>, [bool; 2]) {
        let Dyad::Rocker(e) = &self.dyad else {
            return (Vec::new(), [false; 2]);
        };
        let u = |delta: f64| -> Vec2<f64> {
            let m = self.before(self.q, phi + delta);
            m.points[e.pivot].p - m.points[e.pin].p
        };
        let both = [1.0, -1.0].map(|after| fold.fit(after, u));
        let near = fold.u.dot(fold.u).sqrt() < UNDECIDED * (fold.coupler + fold.rocker);
        (both.concat(), both.map(|numbers| near && arm::is_missing(&numbers)))
    }
}

/// Where the links of a dyad come into line over the revolution, by crank angle; nothing where they clearly do not, and for
/// an element that is no such dyad.
pub fn in_line(mechanism: &Mechanism, element: usize, q: &[f64]) -> Vec<InLine> {
    let Some(dyad) = Dyad::of(mechanism, element) else {
        return Vec::new();
    };
    let probe = DyadProbe { mechanism, element, q, dyad };
    if probe.is_ample() {
        return Vec::new();
    }
    let mut found: Vec<InLine> = probe.lowest().into_iter().filter_map(|near| probe.near(near)).collect();
    found.sort_by(|a, b| a.phi.total_cmp(&b.phi));
    // Two angles of the grid beside one minimum; the first and the last may meet across the revolution.
    found.dedup_by(|a, b| a.phi - b.phi < SAME);
    if found.len() > 1 && found[0].phi + TAU - found[found.len() - 1].phi < SAME {
        found.pop();
    }
    found
}

/// Numbers of a change point in the order of its row.
fn numbers(phi: f64, series: &[f64; TERMS]) -> Vec<f64> {
    let ((sin, cos), (half_sin, half_cos)) = (phi.sin_cos(), (0.5 * phi).sin_cos());
    let mut numbers = vec![cos, sin, half_cos, half_sin, reach(series)];
    numbers.extend(series);
    numbers
}

/// How far from a change point its series is used \[rad\]: as far as its last terms are rounding.
fn reach(series: &[f64; TERMS]) -> f64 {
    let last = (TERMS - 3..TERMS).map(|k| {
        let share = LAST_TERM * series[0].abs() / series[k].abs().max(1e-300);
        share.powf(1.0 / k as f64)
    });
    last.fold(REACH, f64::min)
}
