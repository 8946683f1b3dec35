//! What ends a step: kinks over the angle and over speeds, rest, and the end of rest.

use super::system::System;
use serde::{Deserialize, Serialize};

/// Something that happens where a quantity passes zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Event {
    /// The crank of a mechanism comes to the end of the interval between two kinks, in this direction.
    Kink(usize, f64),
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
    /// The twist of a link passes the end of a form of its law, in this direction: a flank, or a point of its curve.
    Bound(usize, f64),
    /// The damper of a link meets the torque of its spring, or its opposite.
    Limit(usize, i8),
}

/// All that may happen, and on which side of each the motion is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Events {
    /// What may happen.
    pub list: Vec<Event>,
    /// Sign of the quantity before it happens; of no account where the event itself says it.
    sides: Vec<f64>,
    /// Number of the interval in which the crank of each mechanism is, counted on over all cycles.
    intervals: Vec<i64>,
    /// Angles at which the motion ends.
    last: [f64; 2],
}

impl Events {
    /// Of a motion that starts from a state.
    pub fn new(system: &mut System<'_>, t: f64, y: &[f64], turns: f64) -> Self {
        let (chain, places) = (system.equation.chain, system.mounted.len());
        let phi = y[system.layout.phi];
        let mut list = vec![Event::Last(1.0), Event::Last(-1.0)];
        list.extend((0..places).flat_map(|place| [Event::Kink(place, 1.0), Event::Kink(place, -1.0)]));
        // The characteristic of a motor is that of its mass; loads over speed are those of the mechanism's.
        let mut speeds: Vec<(usize, f64)> = Vec::new();
        for driver in &chain.drivers {
            let kinks = system.program(driver).map(|(plan, q)| plan.drive.speed_kinks(&plan.tables, q));
            speeds.extend(kinks.into_iter().flatten().map(|speed| (driver.mass, speed)));
        }
        for one in &system.mounted {
            speeds.extend(one.speed_kinks().into_iter().map(|speed| (one.mass, speed)));
        }
        list.extend(
            speeds.iter().flat_map(|&(mass, speed)| [speed, -speed].map(|at| Event::Speed(mass, at))),
        );
        for mass in system.holding() {
            list.extend([Event::Rest(mass), Event::Slip(mass, 1.0), Event::Slip(mass, -1.0)]);
        }
        let laws: usize = system.mounted.iter().map(|one| one.law_kinks.len()).sum();
        list.extend((0..laws).map(Event::Law));
        for (k, link) in chain.links.iter().enumerate().filter(|(_, link)| !link.law.is_linear()) {
            list.extend([Event::Bound(k, 1.0), Event::Bound(k, -1.0)]);
            if link.law.has_limits() {
                list.extend([Event::Limit(k, 1), Event::Limit(k, -1)]);
            }
        }
        let angle = turns * std::f64::consts::TAU;
        let mut events = Events {
            sides: vec![0.0; list.len()],
            list,
            intervals: vec![0; places],
            last: [phi - angle, phi + angle],
        };
        for place in 0..places {
            let psi = system.angle(place, y);
            events.find_interval(system, place, psi);
        }
        let laws = system.at_law_kinks(t, y);
        for i in 0..events.list.len() {
            events.sides[i] = events.value(system, &laws, (t, y), events.list[i]);
        }
        events
    }

    fn find_interval(&mut self, system: &mut System<'_>, place: usize, psi: f64) {
        let kinks = &system.mounted[place].kinks;
        let (parts, cycle) = (kinks.len() - 1, kinks[kinks.len() - 1]);
        let turn = (psi / cycle).floor();
        let within = kinks.partition_point(|&kink| kink <= psi - turn * cycle).clamp(1, parts) - 1;
        self.intervals[place] = turn as i64 * parts as i64 + within as i64;
        self.enter(system, place);
    }

    /// Lets a mechanism be in its interval.
    fn enter(&self, system: &mut System<'_>, place: usize) {
        let one = &mut system.mounted[place];
        let (parts, cycle) = (one.kinks.len() as i64 - 1, one.kinks[one.kinks.len() - 1]);
        let interval = self.intervals[place];
        let (turn, k) = (interval.div_euclid(parts), interval.rem_euclid(parts) as usize);
        one.between = [k, k + 1].map(|k| turn as f64 * cycle + one.kinks[k]);
    }

    /// Angle of the crank at which the motion ends, in a direction.
    pub fn last(&self, direction: f64) -> f64 {
        self.last[usize::from(direction > 0.0)]
    }

    /// The quantity of an event.
    pub fn value(&self, system: &mut System<'_>, laws: &[f64], (t, y): (f64, &[f64]), event: Event) -> f64 {
        let twist = |link: usize| system.equation.chain.twist(&system.equation.chain.links[link], y);
        match event {
            Event::Kink(place, way) => {
                system.angle(place, y) - system.mounted[place].between[usize::from(way > 0.0)]
            }
            Event::Last(way) => y[system.layout.phi] - self.last(way),
            Event::Speed(mass, at) => system.speed(mass, y) - at,
            Event::Rest(mass) => system.speed(mass, y),
            Event::Slip(mass, way) => system.net_towards(t, y, mass, way),
            Event::Law(nth) => laws[nth],
            Event::Bound(link, way) => twist(link)[0] - system.bounds(link)[usize::from(way > 0.0)],
            Event::Limit(link, limit) => {
                let [twist, rate] = twist(link);
                let law = &system.equation.chain.links[link].law;
                law.over_spring(system.zones[link], twist, rate, limit)
            }
        }
    }

    /// Sign of the quantity before an event may happen; 0 where it cannot.
    pub fn side(&self, system: &System<'_>, nth: usize) -> f64 {
        match self.list[nth] {
            Event::Kink(_, way) | Event::Last(way) => -way,
            // A form may have no end on this side.
            Event::Bound(link, way) => {
                if system.bounds(link)[usize::from(way > 0.0)].is_finite() {
                    -way
                } else {
                    0.0
                }
            }
            Event::Limit(link, limit) => {
                system.equation.chain.links[link].law.side_of_limit(system.zones[link], limit)
            }
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
            Event::Kink(place, way) => {
                self.intervals[place] += way as i64;
                self.enter(system, place);
            }
            Event::Bound(link, way) => {
                let own = &system.equation.chain.links[link];
                let rate = system.equation.chain.twist(own, y)[1];
                system.zones[link] = own.law.beyond(system.zones[link], way as i32, rate);
            }
            Event::Limit(link, limit) => {
                let law = &system.equation.chain.links[link].law;
                system.zones[link] = law.behind_limit(system.zones[link], limit);
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
