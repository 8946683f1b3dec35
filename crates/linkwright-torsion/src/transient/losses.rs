//! Changes of the senses of stages that lose power: where they are due.

use super::rates::Rates;
use super::stages::{Change, Sense};

/// Share of the sizes of torques, and of the largest speed, within which a bound counts as kept; speed that is rest \[rad/s\].
const ROUNDING: f64 = 1e-11;
const REST: f64 = 1e-14;

impl Rates<'_> {
    /// A change that some stage has to make at the instant last evaluated.
    pub fn change(&self) -> Option<Change> {
        let rest = REST + ROUNDING * self.omega.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        (0..self.stages.count()).find_map(|stage| {
            let (link, loss) = self.stages.stage(&self.system.links, stage);
            link.manner.loss?;
            let (speed, torque) = (self.omega[link.ends[0]], self.stages.teeth[stage]);
            let next = match self.stages.senses[stage] {
                Sense::Forward => (speed < -rest).then_some(Sense::Stuck),
                Sense::Backward => (speed > rest).then_some(Sense::Stuck),
                Sense::Stuck => {
                    let (needed, [low, high]) = (torque + self.stages.held[stage], loss.bounds(torque));
                    let doubt = ROUNDING * (needed.abs() + low.abs() + high.abs());
                    if needed > high + doubt {
                        Some(Sense::Forward)
                    } else {
                        (needed < low - doubt).then_some(Sense::Backward)
                    }
                }
            };
            next.map(|next| Change { stage, next })
        })
    }
}
