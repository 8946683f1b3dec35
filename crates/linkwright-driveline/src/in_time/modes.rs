//! The forms that laws have between two events, where another program solves the equation of motion.
//!
//! That program integrates the rates of a state and looks at indicators: numbers above zero, one for each event. Where one falls below,
//! it comes back; what has happened then is taken into account by [`Modes::update`].

use super::events::{Event, Events};
use super::path::set_senses;
use super::system::System;
use crate::law::Zone;
use serde::{Deserialize, Serialize};

/// Events in a row at one instant.
const AT_ONCE: usize = 64;

/// Shares by which a quantity is beyond zero when its event happens: angles \[rad\], speeds over the working speed. A quantity that
/// starts at zero, as the torque on a mass that nothing drives yet, is above it: solvers look for changes of sign.
const BEYOND: f64 = 1e-11;

/// The first two events end the motion after some revolutions: not here.
const OWN: usize = 2;

/// Forms and directions, and what may happen next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Modes {
    events: Events,
    senses: Vec<f64>,
    zones: Vec<Zone>,
    between: Vec<[f64; 2]>,
    /// Speed about which the crank works \[rad/s\].
    speed: f64,
}

impl Modes {
    /// Those of a state, for a crank that works about a speed.
    pub fn of(system: &mut System<'_>, (t, y): (f64, &[f64]), speed: f64) -> Self {
        set_senses(system, t, y);
        let events = Events::new(system, t, y, f64::INFINITY);
        let between = system.mounted.iter().map(|one| one.between).collect();
        Modes { events, senses: system.senses.clone(), zones: system.zones.clone(), between, speed }
    }

    /// Directions of all masses: +1, −1, or 0 where one is held.
    pub fn senses(&self) -> &[f64] {
        &self.senses
    }

    /// Forms of the laws of all links.
    pub fn zones(&self) -> &[Zone] {
        &self.zones
    }

    /// Lets a system have them.
    pub fn enter(&self, system: &mut System<'_>) {
        system.senses.copy_from_slice(&self.senses);
        system.zones.copy_from_slice(&self.zones);
        for (one, &between) in system.mounted.iter_mut().zip(&self.between) {
            one.between = between;
        }
    }

    fn leave(&mut self, system: &System<'_>) {
        self.senses.copy_from_slice(&system.senses);
        self.zones.copy_from_slice(&system.zones);
        for (between, one) in self.between.iter_mut().zip(&system.mounted) {
            *between = one.between;
        }
    }

    /// Number of indicators.
    pub fn count(&self) -> usize {
        self.events.list.len() - OWN
    }

    /// Indicators at a state: positive, and below zero where an event has happened.
    pub fn indicators(&self, system: &mut System<'_>, t: f64, y: &[f64]) -> Vec<f64> {
        self.enter(system);
        let laws = system.at_law_kinks(t, y);
        (OWN..self.events.list.len()).map(|nth| self.indicator(system, &laws, (t, y), nth)).collect()
    }

    fn indicator(&self, system: &mut System<'_>, laws: &[f64], at: (f64, &[f64]), nth: usize) -> f64 {
        let (event, side) = (self.events.list[nth], self.events.side(system, nth));
        // What cannot happen now has any positive value.
        if side == 0.0 {
            return 1.0;
        }
        let value = self.events.value(system, laws, at, event);
        let beyond = match event {
            Event::Kink(place, _) => BEYOND * (1.0 + system.angle(place, at.1).abs()),
            Event::Speed(..) | Event::Rest(_) => system.slow,
            Event::Bound(..) | Event::Last(_) => BEYOND * BEYOND,
            // A torque over an angle of one radian against the kinetic energy at work.
            Event::Slip(mass, _) => BEYOND * system.inertia[mass] * self.speed.powi(2),
            Event::Limit(..) | Event::Law(_) => 0.0,
        };
        value * side.signum() + beyond
    }

    /// Takes into account what has happened at a state, which may change: a mass that comes to rest has no speed. Whether it did,
    /// or nothing when events follow one another without end.
    pub fn update(&mut self, system: &mut System<'_>, t: f64, y: &mut [f64]) -> Option<bool> {
        let before = y.to_vec();
        self.enter(system);
        let laws = system.at_law_kinks(t, y);
        for nth in OWN..self.events.list.len() {
            if self.events.side(system, nth) == 0.0 {
                let value = self.events.value(system, &laws, (t, y), self.events.list[nth]);
                self.events.start_on(nth, value);
            }
        }
        for _ in 0..AT_ONCE {
            let laws = system.at_law_kinks(t, y);
            let happened =
                (OWN..self.events.list.len()).find(|&nth| self.indicator(system, &laws, (t, y), nth) < 0.0);
            let Some(nth) = happened else { return Some(before != y) };
            self.events.happen(system, nth, t, y);
            self.leave(system);
        }
        None
    }
}
