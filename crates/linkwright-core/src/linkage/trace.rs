//! What a group needs to know of the motion beforehand.
//!
//! [`follow`] follows it from a first position over the crank angle, once for a machine, so that its start is known
//! at any angle afterwards.

use super::group::Group;
use super::mechanism::{Element, Mechanism};
use super::motion::Motion;
use crate::kernel::call::poll;
use crate::kernel::plane::{Angle, Place, Vec2};
use std::f64::consts::TAU;

/// The motion of a group as it was followed.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// Crank angles, increasing.
    pub phi: Vec<f64>,
    /// x and y of each unknown at each of them.
    pub places: Vec<Vec<f64>>,
    /// Whether the motion came back to its first position, after how many revolutions; otherwise it was followed
    /// to its limits, or to the most turns allowed.
    pub turns: Option<u32>,
}

/// Steps a revolution that a group is followed with; between them its table is straight, wrong by some 2e-5 of a
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

    /// One step of the grid, halved as often as the prediction asks; adds every place on the way, and tells
    /// whether it came to the end.
    ///
    /// Towards a limit the places change as the root of the distance from it. Parts of a step that shrink with
    /// that distance are what the table needs there: from a straight line over a whole step Newton overshoots.
    fn step(&mut self, to: f64, way: &mut Vec<(f64, Places)>) -> bool {
        let mut at = way[way.len() - 1].0;
        let mut step = to - at;
        let mut halved = 0;
        while halved <= HALVINGS {
            poll();
            let guess = self.predicted(step);
            let kept = self.m.clone();
            match self.at(at + step, &guess) {
                Some(found) if distance(&found, &guess) <= PREDICTION * self.size => {
                    let arrived = (to - at - step).abs() <= 1e-12;
                    at = if arrived { to } else { at + step };
                    way.push((at, found));
                    if arrived {
                        return true;
                    }
                    step = to - at;
                    halved = 0;
                }
                _ => {
                    self.m = kept;
                    step *= 0.5;
                    halved += 1;
                }
            }
        }
        false
    }

    /// Follows the group from its first place forward (+1) or back (−1): the places on the way, and the turns
    /// after which it is back where it began.
    fn follow(&mut self, first: (f64, Places), sign: f64) -> (Vec<(f64, Places)>, Option<u32>) {
        let start = first.0;
        let mut way = vec![first];
        for k in 1..=STEPS * TURNS_MAX {
            if !self.step(start + sign * TAU * f64::from(k) / f64::from(STEPS), &mut way) {
                break;
            }
            let last = way.len() - 1;
            if k % STEPS == 0 && distance(&way[last].1, &way[0].1) <= 1e-9 * self.size {
                // The last place is the first again.
                way.pop();
                return (way, Some(k / STEPS));
            }
        }
        (way, None)
    }
}

/// Follows one group of a mechanism from places near its first position at crank angle `phi`, forward until it
/// repeats, and back if it does not. `None` if it does not close at the first angle.
pub fn follow(mechanism: &Mechanism, element: usize, q: &[f64], phi: f64, near: &[f64]) -> Option<Path> {
    let Element::Group(group) = &mechanism.elements[element] else {
        return None;
    };
    let m = Motion::new(mechanism, q);
    let guess: Places = near.chunks_exact(2).map(|p| Vec2::new(p[0], p[1])).collect();
    let size = group.length_scale(q);
    let mut follower = Follower { mechanism, element, group, q, m, size };
    let first = follower.at(phi, &guess)?;
    let (forward, turns) = follower.follow((phi, first.clone()), 1.0);
    if turns.is_some() {
        return Some(path(&forward, turns));
    }
    let first = follower.at(phi, &first)?;
    let (mut back, _) = follower.follow((phi, first), -1.0);
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
