//! The driveline as masses and links, all referred to the speed of the crank.

use crate::law::{Law, Torque};

/// A spring with a damper between two masses: T by the twist Δ of the first against the second, and its rate.
#[derive(Clone, Debug)]
pub struct Link {
    /// Mass that T holds back.
    pub first: usize,
    /// Mass that T drives.
    pub second: usize,
    /// T of Δ and Δ˙.
    pub law: Law,
}

/// What drives a mass.
#[derive(Clone, Copy, Debug)]
pub enum Driver {
    /// The motor of the machine, by its characteristic.
    Motor,
    /// A motor that keeps this speed \[rad/s\] whatever it takes.
    Held(f64),
}

/// Masses with links between them. The last mass is the crank, with the mechanism.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Inertias of the masses but the crank \[kg m²\].
    pub inertia: Vec<f64>,
    /// Inertia of the drive that does not turn with the crank as one \[kg m²\]: the reduction counts it there.
    pub apart: f64,
    /// What joins the masses.
    pub links: Vec<Link>,
    /// Mass that is driven.
    pub driven: usize,
    /// What drives it.
    pub driver: Driver,
}

impl Chain {
    /// Number of masses.
    pub fn masses(&self) -> usize {
        self.inertia.len() + 1
    }

    /// Whether all numbers of masses are those of masses.
    pub fn fits(&self) -> bool {
        let n = self.masses();
        self.driven < n && self.links.iter().all(|link| link.first < n && link.second < n)
    }

    /// All numbers that a parameter may change, in one list.
    pub fn numbers(&self) -> Vec<f64> {
        let mut list = self.inertia.clone();
        list.push(self.apart);
        list.extend(if let Driver::Held(speed) = self.driver { Some(speed) } else { None });
        self.links.iter().for_each(|link| link.law.add_numbers(&mut list));
        list
    }

    /// The same driveline with other numbers.
    pub fn with_numbers(&self, list: &[f64]) -> Chain {
        let mut chain = self.clone();
        let mut numbers = list.iter().copied();
        let mut next = |to: &mut f64| *to = numbers.next().unwrap_or(*to);
        chain.inertia.iter_mut().for_each(&mut next);
        next(&mut chain.apart);
        if let Driver::Held(speed) = &mut chain.driver {
            next(speed);
        }
        chain.links.iter_mut().for_each(|link| link.law.set_numbers(&mut next));
        chain
    }

    /// Numbers of a state: twist and speed against the crank of every mass but the crank, and the crank's speed.
    pub fn states(&self) -> usize {
        2 * self.masses() - 1
    }

    /// Twist of a link, and its rate.
    pub fn twist(&self, link: &Link, y: &[f64]) -> [f64; 2] {
        let others = self.masses() - 1;
        let of = |mass: usize, first: usize| if mass < others { y[first + mass] } else { 0.0 };
        [0, others].map(|first| of(link.first, first) - of(link.second, first))
    }

    /// Torque of a link \[N m\] with its slopes by twist and rate.
    pub fn torque(&self, link: &Link, y: &[f64]) -> Torque {
        let [twist, rate] = self.twist(link, y);
        link.law.torque(twist, rate)
    }

    /// The same by the form that its law has at another state.
    pub fn torque_like(&self, link: &Link, y: &[f64], near: &[f64]) -> Torque {
        let ([twist, rate], [t, r]) = (self.twist(link, y), self.twist(link, near));
        link.law.of_zone(link.law.zone(t, r), twist, rate)
    }

    /// Speed of a mass \[rad/s\].
    pub fn speed(&self, mass: usize, y: &[f64]) -> f64 {
        let others = self.masses() - 1;
        let crank = y[2 * others];
        if mass < others { crank + y[others + mass] } else { crank }
    }
}
