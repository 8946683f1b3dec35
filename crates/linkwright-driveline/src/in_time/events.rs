//! What ends a step: kinks over the angle and over speeds, rest, and the end of rest.

use super::system::System;
use crate::equation::Equation;

/// Something that happens where a quantity passes zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The crank comes to the end of the interval between two kinks, in this direction.
    Kink(f64),
    /// It has turned as far as it may, in this direction.
    Last(f64),
    /// A mass passes a speed at which the characteristic of motor or loads has a kink.
    Speed(usize, f64),
    /// A mass comes to rest whose torque jumps there.
    Rest(usize),
    /// A mass that is held is taken on in this direction.
    Slip(usize, f64),
    /// A law has a kink or a jump.
    Law(usize),
}

/// All that may happen, and on which side of each the motion is.
pub struct Events {
    /// What may happen.
    pub list: Vec<Event>,
    /// Sign of the quantity before it happens; of no account where the event itself says it.
    sides: Vec<f64>,
    /// Angles between two kinks, over a cycle, from 0 to its end.
    kinks: Vec<f64>,
    /// Number of the interval in which the crank is, counted on over all cycles.
    interval: i64,
    /// Angles at which the motion ends.
    last: [f64; 2],
}

impl Events {
    /// Of a motion that starts from a state.
    pub fn new(system: &mut System<'_>, kinks: Vec<f64>, t: f64, y: &[f64], turns: f64) -> Self {
        let Equation { plan, q, .. } = system.equation;
        let phi = y[system.layout.phi];
        let mut list = vec![Event::Kink(1.0), Event::Kink(-1.0), Event::Last(1.0), Event::Last(-1.0)];
        let speeds: Vec<f64> = plan.drive.speed_kinks(&plan.tables, q);
        // The characteristic of the motor is that of its mass; loads over speed are those of the crank.
        let crank = (!plan.drive.speed_loads.is_empty()).then_some(system.crank());
        for mass in [system.driven].into_iter().chain(crank) {
            list.extend(speeds.iter().flat_map(|&speed| [speed, -speed]).map(|at| Event::Speed(mass, at)));
        }
        for mass in system.holding() {
            list.extend([Event::Rest(mass), Event::Slip(mass, 1.0), Event::Slip(mass, -1.0)]);
        }
        list.extend((0..system.law_kinks.len()).map(Event::Law));
        let angle = turns * std::f64::consts::TAU;
        let mut events = Events {
            sides: vec![0.0; list.len()],
            list,
            kinks,
            interval: 0,
            last: [phi - angle, phi + angle],
        };
        events.find_interval(phi);
        system.between = events.between();
        let laws = system.at_law_kinks(t, y);
        for i in 0..events.list.len() {
            events.sides[i] = events.value(system, &laws, (t, y), events.list[i]);
        }
        events
    }

    fn find_interval(&mut self, phi: f64) {
        let (parts, cycle) = (self.kinks.len() - 1, self.kinks[self.kinks.len() - 1]);
        let turn = (phi / cycle).floor();
        let within = self.kinks.partition_point(|&kink| kink <= phi - turn * cycle).clamp(1, parts) - 1;
        self.interval = turn as i64 * parts as i64 + within as i64;
    }

    /// Angles of the interval.
    pub fn between(&self) -> [f64; 2] {
        let (parts, cycle) = (self.kinks.len() as i64 - 1, self.kinks[self.kinks.len() - 1]);
        let (turn, k) = (self.interval.div_euclid(parts), self.interval.rem_euclid(parts) as usize);
        [k, k + 1].map(|k| turn as f64 * cycle + self.kinks[k])
    }

    /// The next angle in a direction at which a step must end.
    pub fn next_angle(&self, direction: f64) -> f64 {
        let [low, high] = self.between();
        if direction < 0.0 { low.max(self.last[0]) } else { high.min(self.last[1]) }
    }

    /// The quantity of an event.
    pub fn value(&self, system: &mut System<'_>, laws: &[f64], (t, y): (f64, &[f64]), event: Event) -> f64 {
        let phi = y[system.layout.phi];
        match event {
            Event::Kink(way) => phi - self.between()[usize::from(way > 0.0)],
            Event::Last(way) => phi - self.last[usize::from(way > 0.0)],
            Event::Speed(mass, at) => system.speed(mass, y) - at,
            Event::Rest(mass) => system.speed(mass, y),
            Event::Slip(mass, way) => system.net_towards(t, y, mass, way),
            Event::Law(nth) => laws[nth],
        }
    }

    /// Sign of the quantity before an event may happen; 0 where it cannot.
    pub fn side(&self, system: &System<'_>, nth: usize) -> f64 {
        match self.list[nth] {
            Event::Kink(way) | Event::Last(way) => -way,
            Event::Speed(..) | Event::Law(_) => self.sides[nth],
            Event::Rest(mass) => system.senses[mass],
            Event::Slip(mass, way) => {
                if system.senses[mass] == 0.0 {
                    -way
                } else {
                    0.0
                }
            }
        }
    }

    /// Takes the side of a quantity that was zero at the start.
    pub fn start_on(&mut self, nth: usize, value: f64) {
        if matches!(self.list[nth], Event::Speed(..) | Event::Law(_)) && !value.is_nan() {
            self.sides[nth] = value;
        }
    }

    /// What changes when an event has happened at a time and a state.
    pub fn happen(&mut self, system: &mut System<'_>, nth: usize, t: f64, y: &mut [f64]) {
        let layout = system.layout;
        match self.list[nth] {
            Event::Kink(way) => {
                self.interval += way as i64;
                system.between = self.between();
            }
            Event::Last(_) => {}
            Event::Speed(..) | Event::Law(_) => self.sides[nth] = -self.sides[nth].signum(),
            Event::Rest(mass) => {
                if mass == layout.others {
                    let omega = std::mem::replace(&mut y[layout.omega], 0.0);
                    y[layout.others..layout.omega].iter_mut().for_each(|speed| *speed += omega);
                } else {
                    y[layout.others + mass] = -y[layout.omega];
                }
                let way = system.way_from_rest(t, y, mass);
                system.senses[mass] = way;
            }
            Event::Slip(mass, way) => system.senses[mass] = way,
        }
    }
}
