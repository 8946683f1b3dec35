//! Elements with dry friction along a motion: slip, its rate, engagement, and what holds those that stick.

use super::contacts::Break;
use super::friction::Friction;
use super::rates::Rates;

/// Share of the accelerations of its ends below which that of an element's slip is rounding.
const RATE_ROUNDING: f64 = 1e-9;

impl Rates<'_> {
    /// Slip of an element from components of a state.
    pub fn slip_at(&self, friction: &Friction, state: impl Fn(usize) -> f64) -> f64 {
        let n = self.system.len();
        let counted = self.relative && !self.turns_alike(friction);
        let lead = if counted { state(n) } else { 0.0 };
        friction.slip(|i| {
            let aside = if i == n || (i == 0 && self.relative) { 0.0 } else { state(n + i) };
            aside + self.system.turns_of(i) * lead
        })
    }

    /// How fast the slip of an element grows at the instant last evaluated.
    pub fn slip_rate(&self, friction: &Friction) -> f64 {
        friction.slip(|i| if i == self.system.len() { 0.0 } else { self.acceleration[i] })
    }

    /// Whether an element is engaged, at a time or later on the stretch.
    pub fn is_engaged(&self, friction: &Friction, t: f64) -> bool {
        [t, self.stretch.middle]
            .iter()
            .any(|&t| friction.engaged(&self.system.curves, &self.stretch, t) > 0.0)
    }

    /// Finds the torques of stuck elements at the instant last evaluated: the smallest margin to a bound, below zero where one
    /// does not hold, and which.
    pub fn carry(&mut self) -> (f64, Option<Break>) {
        let inertia = if self.bobs.any() { &self.effective } else { &self.inertia };
        self.contacts.carry(&self.system.frictions, &self.engaged, (&self.acceleration, inertia))
    }

    /// Accelerations below which a sliding element neither gains nor loses slip: rounding of what acts on its ends.
    pub fn slip_rate_rounding(&self, e: usize) -> f64 {
        let Friction { ends, ratio, .. } = self.system.frictions[e];
        let of = |&i: &usize| {
            let inverse = ratio.abs() / self.inertia[i];
            inverse * (self.contacts.net(i).abs() + (ratio * self.contacts.torques[e]).abs())
        };
        RATE_ROUNDING * ends.iter().filter(|&&i| i < self.system.len()).map(of).sum::<f64>()
    }
}
