//! Ends of the steps of a revolution where a formula is steep ([`crate::drive::steep`]): in it and beside it. The error of steps
//! that see something of it is then measured like any other.

use crate::drive::steep::{Along, Piece, Steepness};
use crate::kernel::interval::Interval;
use crate::linkage::motion::Motion;

/// Short pieces to a step: some 120 make up a pulse, so that steps are about half as long as its width on each side.
const PER_STEP: usize = 16;

/// Ends lie at the edges of what is steep and so many of its widths beside it, as far as the next \[rad\]; not where an end is
/// already, to the last shares of that distance or of the width.
const BESIDE: [f64; 3] = [1.0, 5.0, 25.0];
const FARTHEST: f64 = 0.1;
const ROOM: f64 = 0.6;
const EDGE: f64 = 0.1;

/// A solution sees what is steep where its steps are no longer than so many times what they have of it: of their ten nodes, two
/// times five, some lie in it, and the rest is measured. Less of it than the second share is its foot.
const SEEN: f64 = 4.0;
const FOOT: f64 = 0.15;

/// A force that changes by no more than this times the difference of its ends does not come back.
const FLANK: f64 = 1.1;

/// Where a formula is steep.
pub(super) struct Place {
    pub low: f64,
    pub high: f64,
}

/// All places where a formula is steep, and what it gives there.
pub(super) struct Places {
    pub places: Vec<Place>,
    /// Where it was looked at, in order, with the forces.
    forces: Vec<[f64; 2]>,
}

impl Steepness<'_> {
    /// Adds ends where the formula is steep to those of the steps of a cycle.
    pub(super) fn add_ends(&self, along: &Along<'_>, ends: &mut Vec<f64>, m: &mut Motion<f64>) {
        self.for_each_place(along, m, |place, least| {
            add_ends_in(place, least, ends);
            add_ends_beside(place, ends);
        });
    }

    /// Whether steps with given ends see all that is steep: what they have some stages in, and the flank of a force that is
    /// another one behind it than before it.
    pub(super) fn is_seen(&self, along: &Along<'_>, ends: &[f64], m: &mut Motion<f64>) -> bool {
        let found = self.places(along, m);
        let sees = |place: &Place| place.unseen(ends).all(|step| found.has_flank_alone(step[0], step[1]));
        found.places.iter().all(sees)
    }

    pub(super) fn places(&self, along: &Along<'_>, m: &mut Motion<f64>) -> Places {
        let (mut places, mut forces) = (Vec::new(), Vec::new());
        self.for_each_place(along, m, |place, _| {
            let first = forces.len();
            forces.extend(place.iter().flat_map(|piece| &piece.samples).map(|at| [at.at, self.force(at)]));
            // Some function may be steep where nothing of it is left in the force.
            if Interval::around(forces[first..].iter().map(|force| force[1])).width() > 0.0 {
                let [low, high] = ends_of(place);
                places.push(Place { low, high });
            }
        });
        forces.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Places { places, forces }
    }
}

impl Places {
    /// Whether the force changes between two ends and does not come back: what lies behind the flank is seen.
    pub(super) fn has_flank_alone(&self, low: f64, high: f64) -> bool {
        let [low, high] = [low, high].map(|end| self.forces.partition_point(|force| force[0] < end));
        let within = &self.forces[low..high];
        let (Some(first), Some(last)) = (within.first(), within.last()) else { return true };
        let width = Interval::around(within.iter().map(|force| force[1])).width();
        width <= FLANK * (last[1] - first[1]).abs()
    }
}

fn ends_of(place: &[Piece]) -> [f64; 2] {
    [place[0].ends()[0], place[place.len() - 1].ends()[1]]
}

/// Adds ends so that no step has too many of the pieces of a place, or one that may still hide something beside another.
fn add_ends_in(place: &[Piece], least: f64, ends: &mut Vec<f64>) {
    let (mut count, mut found) = (0, Vec::new());
    for piece in place {
        let [from, to] = piece.ends();
        count = if has_end(ends, from, to) { 0 } else { count + 1 };
        if count == PER_STEP || piece.hides > least && count > 0 {
            found.push(to);
            count = 0;
        }
    }
    ends.extend(found);
    ends.sort_by(f64::total_cmp);
}

/// Adds ends on both sides of a place, the farther apart the farther away: outside there may be the foot of a pulse.
fn add_ends_beside(place: &[Piece], ends: &mut Vec<f64>) {
    let [low, high] = ends_of(place);
    let (width, cycle) = (high - low, ends[ends.len() - 1]);
    for (edge, side) in [(low, -1.0), (high, 1.0)] {
        for times in [0.0].into_iter().chain(BESIDE) {
            let off = times * width;
            let (at, room) = ((edge + side * off).rem_euclid(cycle), (ROOM * off).max(EDGE * width));
            if off < FARTHEST && !has_end(ends, at - room, at + room) {
                ends.push(at);
                ends.sort_by(f64::total_cmp);
            }
        }
    }
}

impl Place {
    /// Steps with given ends, in order, that may have no stage in the part that they have of the place.
    fn unseen<'a>(&'a self, ends: &'a [f64]) -> impl Iterator<Item = &'a [f64]> {
        let &Place { low, high } = self;
        let first = ends.partition_point(|&end| end <= low).max(1) - 1;
        ends[first..].windows(2).take_while(move |step| step[0] < high).filter(move |step| {
            let of_it = step[1].min(high) - step[0].max(low);
            of_it > FOOT * (high - low) && step[1] - step[0] > SEEN * of_it
        })
    }
}

/// Whether some end of a step lies within two angles; ends are in order.
fn has_end(ends: &[f64], low: f64, high: f64) -> bool {
    let at = ends.partition_point(|&end| end < low);
    ends.get(at).is_some_and(|&end| end <= high)
}
