//! Changes of the senses of stages that lose power: where they are due, and what follows from them at once.

use super::rates::Rates;
use super::stages::{Change, Sense};

/// Share of the sizes of torques, and of the largest speed, within which a bound counts as kept; speed that is rest \[rad/s\].
const ROUNDING: f64 = 1e-11;
const REST: f64 = 1e-14;

/// Changes at one instant.
const ATTEMPTS: usize = 30;

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

    /// Makes a change, and those that follow from it at once, in a state at a time; whether they come to an end.
    pub fn make(&mut self, first: Option<Change>, t: f64, state: &mut [f64]) -> bool {
        let mut due = first;
        for _ in 0..ATTEMPTS {
            if let Some(Change { stage, next }) = due {
                self.stages.senses[stage] = next;
                if next == Sense::Stuck {
                    self.stop(stage, state);
                }
            }
            self.derivative(t, state, &mut state.to_vec());
            due = self.change();
            if due.is_none() {
                return true;
            }
        }
        false
    }

    /// Lets the first end of a stage rest, and the second with it if it is rigid.
    fn stop(&self, stage: usize, state: &mut [f64]) {
        let (n, link) = (self.system.len(), self.stages.stage(&self.system.links, stage).0);
        self.to_absolute(state);
        state[n + link.ends[0]] = 0.0;
        if link.manner.rigid {
            state[n + link.ends[1]] = 0.0;
        }
        self.to_relative(state);
    }
}
