//! What a dyad with change points and a group need to know of the motion beforehand.
//!
//! [`change_points`] finds where a dyad's links come into line and expands the root of its radicand there;
//! [`follow`] follows a group from a first position over the crank angle, so that its start is known at any
//! angle afterwards. Both are done once for a machine.

use super::folding::{TERMS, radicand, square};
use super::group::Group;
use super::guided::{GuidedRod, rod_radicand};
use super::{Element, Mechanism, Motion, Rocker};
use crate::call::poll;
use crate::jet::Jet;
use crate::plane::{Angle, Place, Vec2};
use crate::real::Real;
use std::f64::consts::TAU;

/// Terms of the radicand's series: two more than of S/δ.
const ORDERS: usize = TERMS + 2;

/// Share of 4a²b², or of l², below which the radicand at its minimum counts as zero. Links then are in line to some
/// 1e-6 of their length: rounding of lengths given to all digits is far below, rounding of printed ones
/// far above.
const TOUCHES: f64 = 1e-12;

/// Rounding of (a + b)² − U, over [`TOUCHES`]: some 100 units of the last place.
const ROUNDING: f64 = 0.02;

/// Square of the distance of pin and pivot, over that of the links' sum, below which they coincide: there the
/// direction from one to the other is lost, and with it the motion.
const COINCIDE: f64 = 1e-12;

/// The crank angle of a change point, and the coefficients of S/δ there up to the sign.
pub type ChangePointSeries = (f64, [f64; TERMS]);

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

    /// What the radicand is measured against: its greatest value, and for links of very different length the
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

impl Mechanism {
    /// Series of the radicand of a dyad about a crank angle.
    /// NaN where pin and pivot coincide.
    fn radicand_series(&self, element: usize, dyad: &Dyad, q: &[f64], phi: f64) -> [f64; ORDERS] {
        let q: Vec<Jet<f64, ORDERS>> = q.iter().map(|&x| Jet::constant(x)).collect();
        let mut m = Motion::new(self, &q);
        self.place_first::<_, 1>(element, &q, Angle::new(Jet::variable(phi)), &mut m);
        match dyad {
            Dyad::Rocker(e) => {
                let apart = square(&m.points[e.pin], &m.points[e.pivot])[0].c[0];
                let sum = (q[e.coupler] + q[e.rocker]).c[0];
                if apart <= COINCIDE * sum * sum { [f64::NAN; ORDERS] } else { radicand(e, &q, &m)[0].c }
            }
            Dyad::Rod(e) => rod_radicand(e, &q, &m)[0].c,
        }
    }
}

/// The change point of a dyad near a crank angle; `None` if the radicand does not touch zero there.
pub fn change_point(
    mechanism: &Mechanism,
    element: usize,
    q: &[f64],
    near: f64,
) -> Option<ChangePointSeries> {
    let dyad = Dyad::of(mechanism, element)?;
    let size = dyad.size(q);
    let mut phi = near;
    // Newton on g′ = 0 from an angle of a fine grid: quadratic.
    for _ in 0..20 {
        let g = mechanism.radicand_series(element, &dyad, q, phi);
        let step = -g[1] / (2.0 * g[2]);
        phi += step.clamp(-0.1, 0.1);
        if step.abs() < 1e-15 {
            break;
        }
    }
    let g = mechanism.radicand_series(element, &dyad, q, phi);
    // What is written so that NaN is refused too.
    let touches = g[0].abs() <= TOUCHES * size && g[2] > 0.0;
    if !touches {
        return None;
    }
    let mut h = Jet { c: [0.0; TERMS] };
    h.c.copy_from_slice(&g[2..]);
    Some((phi.rem_euclid(TAU), h.sqrt().c))
}

/// The motion of a group as it was followed.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// Crank angles, increasing.
    pub phi: Vec<f64>,
    /// x and y of each unknown at each of them.
    pub places: Vec<Vec<f64>>,
    /// Whether the motion came back to its first position, after how many turns; otherwise it was followed
    /// to its limits, or to the most turns allowed.
    pub turns: Option<u32>,
}

/// Steps a turn that a group is followed with; between them its table is straight, wrong by some 2e-5 of a
/// length, from where Newton needs three rounds.
const STEPS: u32 = 360;

/// A step is halved until the predicted place is at most this far from the corrected one, over the group's
/// size: a jump to another branch is far larger.
const PREDICTION: f64 = 2e-3;

/// Halvings of a step after which the group is at a limit of its motion: 2⁻⁴⁰ of a degree.
const HALVINGS: u32 = 40;

/// Turns after which a group counts as not periodic.
const TURNS_MAX: u32 = 8;

/// Place of each unknown joint.
type Places = Vec<Vec2<f64>>;

/// Follows one group of a mechanism, and what comes before it.
struct Follower<'a> {
    mechanism: &'a Mechanism,
    element: usize,
    group: &'a Group,
    q: &'a [f64],
    m: Motion<f64>,
    size: f64,
}

impl Follower<'_> {
    /// Solves the group at an angle from given places; `None` if it does not close there.
    fn at(&mut self, phi: f64, places: &[Vec2<f64>]) -> Option<Vec<Vec2<f64>>> {
        self.mechanism.place_first::<f64, 2>(self.element, self.q, Angle::new(phi), &mut self.m);
        for (&unknown, &p) in self.group.unknowns.iter().zip(places) {
            self.m.points[unknown] = Place::fixed(p);
        }
        self.group.solve::<f64, 2>(self.q, &mut self.m);
        let found: Vec<Vec2<f64>> = self.group.unknowns.iter().map(|&k| self.m.points[k].p).collect();
        let closes = self.m.gaps[self.group.gap] >= 0.0;
        closes.then_some(found)
    }

    /// Where the last solution's rates lead after a step.
    fn predicted(&self, step: f64) -> Vec<Vec2<f64>> {
        let place = |&k: &usize| {
            let p = &self.m.points[k];
            p.p.plus(p.d1, step).plus(p.d2, 0.5 * step * step)
        };
        self.group.unknowns.iter().map(place).collect()
    }

    /// One step of the grid, halved as often as the prediction asks; the places at its end, or how far it
    /// came.
    fn step(&mut self, from: f64, to: f64) -> Result<Places, (f64, Places)> {
        let mut at = from;
        let mut step = to - from;
        let mut last: Vec<Vec2<f64>> = self.group.unknowns.iter().map(|&k| self.m.points[k].p).collect();
        let mut halved = 0;
        loop {
            poll();
            let guess = self.predicted(step);
            let kept = self.m.clone();
            match self.at(at + step, &guess) {
                Some(found) if distance(&found, &guess) <= PREDICTION * self.size => {
                    at += step;
                    last = found;
                    if (to - at).abs() <= 1e-12 {
                        return Ok(last);
                    }
                    step = to - at;
                    halved = 0;
                }
                _ => {
                    self.m = kept;
                    step *= 0.5;
                    halved += 1;
                    if halved > HALVINGS {
                        return Err((at, last));
                    }
                }
            }
        }
    }
}

/// Follows a group from places near its first position at crank angle `phi`, forward until it repeats, and
/// back if it does not. `None` if it does not close at the first angle.
pub fn follow(mechanism: &Mechanism, element: usize, q: &[f64], phi: f64, near: &[f64]) -> Option<Path> {
    let Element::Group(group) = &mechanism.elements[element] else {
        return None;
    };
    let m = Motion::new(mechanism, q);
    let guess: Vec<Vec2<f64>> = near.chunks_exact(2).map(|p| Vec2::new(p[0], p[1])).collect();
    let size = group.length_scale(q);
    let mut follower = Follower { mechanism, element, group, q, m, size };
    let first = follower.at(phi, &guess)?;
    let mut forward = vec![(phi, first.clone())];
    for k in 1..=STEPS * TURNS_MAX {
        let (from, _) = forward[forward.len() - 1];
        let to = phi + TAU * f64::from(k) / f64::from(STEPS);
        match follower.step(from, to) {
            Ok(found) if k % STEPS == 0 && distance(&found, &first) <= 1e-9 * size => {
                return Some(path(&forward, Some(k / STEPS)));
            }
            Ok(found) => forward.push((to, found)),
            Err((at, found)) => {
                if at > from {
                    forward.push((at, found));
                }
                break;
            }
        }
    }
    let first = follower.at(phi, &first)?;
    let mut back = vec![(phi, first)];
    for k in 1..=STEPS * TURNS_MAX {
        let (from, _) = back[back.len() - 1];
        let to = phi - TAU * f64::from(k) / f64::from(STEPS);
        match follower.step(from, to) {
            Ok(found) => back.push((to, found)),
            Err((at, found)) => {
                if at < from {
                    back.push((at, found));
                }
                break;
            }
        }
    }
    back.reverse();
    back.pop();
    back.extend(forward);
    Some(path(&back, None))
}

fn distance(a: &[Vec2<f64>], b: &[Vec2<f64>]) -> f64 {
    let each = a.iter().zip(b).map(|(a, b)| (a.x - b.x).abs().max((a.y - b.y).abs()));
    // A NaN must not pass for near.
    each.fold(0.0, |most, d| if d <= most { most } else { d })
}

fn path(steps: &[(f64, Vec<Vec2<f64>>)], turns: Option<u32>) -> Path {
    let n = steps.first().map_or(0, |(_, places)| places.len());
    let coordinate = |k: usize| {
        let place = move |(_, places): &(f64, Vec<Vec2<f64>>)| {
            if k.is_multiple_of(2) { places[k / 2].x } else { places[k / 2].y }
        };
        steps.iter().map(place).collect()
    };
    Path {
        phi: steps.iter().map(|&(phi, _)| phi).collect(),
        places: (0..2 * n).map(coordinate).collect(),
        turns,
    }
}
