//! Pulses of formulas over speed or time that lie between the stages of a step.
//!
//! A step may see nothing of a pulse, and its error says so little. Along the motion that was found it is looked for
//! where formulas are steep ([`crate::drive::steep`]); the step then ends before the pulse, and the next one is so short that its
//! stages lie in it.

use super::attempt::{Piece, state};
use super::equation::{Equation, Y};
use crate::drive::law::Moment;
use crate::drive::pulses::Place;
use crate::drive::steep::{Along, SteepKind, Steepness, WIDE};
use crate::kernel::dual::Dual;

/// Between two stages of a step lies no more than this share of it: of the explicit method from 1/3 to 0.6.
const BETWEEN_STAGES: f64 = 0.27;

/// The measure of a step in which what is wide enough to be seen is as wide as in a step of a steady motion.
const WHOLE: f64 = WIDE / BETWEEN_STAGES;

/// A step has stages in what is steep over this share of it.
const SEEN: f64 = 0.5;

impl Equation<'_> {
    /// Collects the laws that may be steep at angles that depend on speed or time.
    pub fn find_steep_laws(&mut self) {
        let (plan, q, m) = (self.machine.plan, self.machine.q, &mut self.motion);
        let laws = plan.steep_laws(SteepKind::MovingOrJumping).into_iter();
        self.steep = laws.map(|load| Steepness::new(plan, q, load, SteepKind::MovingOrJumping, m)).collect();
    }

    /// The share of a step from a time and a state after which it is to end for a pulse that its stages may not see.
    pub fn first_unseen(&mut self, (t, y): (f64, &Y), pieces: &[Piece]) -> Option<f64> {
        let (whole, sense): (f64, _) = (pieces.iter().map(|piece| piece.h).sum(), self.turning.crank);
        let moment = |at: f64| {
            let time = Dual::variable(at) * (whole / WHOLE);
            let [angle, speed] = state(y, pieces, time);
            Moment { phi: angle * sense, omega: speed * sense, time: time + t }
        };
        let along = Along { moment: &moment, breaks: vec![0.0, WHOLE] };
        let ends = self.steep.iter().filter_map(|steepness| {
            let found = steepness.places(&along, &mut self.motion);
            if found.has_flank_alone(0.0, WHOLE) {
                return None;
            }
            let unseen = found.places.iter().filter(|place| place.width() < SEEN * WHOLE);
            let first = unseen.min_by(|a, b| a.low.total_cmp(&b.low))?;
            let behind = first.high + first.width();
            Some(if found.has_flank_alone(0.0, behind) { behind } else { first.end() })
        });
        ends.reduce(f64::min).map(|end| end / WHOLE)
    }
}

impl Place {
    fn width(&self) -> f64 {
        self.high - self.low
    }

    /// Where a step that begins before it is to end: before it too, or behind it where there is no room.
    fn end(&self) -> f64 {
        if self.low > self.width() { self.low } else { self.high }
    }
}
