//! The driveline as masses and links, all referred to the speed of the crank. Its numbers are plain ones or, for derivatives, duals.

use crate::law::{Law, Transmitted};
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::real::Real;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A spring with a damper between two masses: T by the twist Δ of the first against the second, and its rate.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Link<N = f64> {
    /// Mass that T holds back.
    pub first: usize,
    /// Mass that T drives.
    pub second: usize,
    /// T of Δ and Δ˙.
    pub law: Law<N>,
}

/// The structure of a machine with its numbers: a further motor, or a further mechanism.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Part<N = f64> {
    /// Its structure.
    pub plan: Arc<Plan>,
    /// Its numbers.
    pub q: Vec<N>,
}

/// Where a torque on a mass comes from.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Source<N = f64> {
    /// The motor of the machine at the crank, by its characteristic.
    Own,
    /// A motor that keeps this speed \[rad/s\] whatever it takes.
    Held(N),
    /// The motor of another plan through the gearbox of that plan, at the speed of the mass.
    Motor(Part<N>),
    /// A power of the speed of the mass, `torque` (ω/`speed`)^`exponent`; positive if it drives, \[N m\].
    Power {
        /// T₀.
        torque: N,
        /// ω₀.
        speed: N,
        /// p.
        exponent: N,
    },
}

/// A torque on a mass from outside.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Torque<N = f64> {
    /// Mass on which it acts.
    pub mass: usize,
    /// Where it comes from.
    pub source: Source<N>,
}

/// A further mechanism on a mass. Its crank stands at `ratio` times the angle of the mass plus `phase`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Station<N = f64> {
    /// Mass that its crank turns with.
    pub mass: usize,
    /// The mechanism, without a drive.
    pub part: Part,
    /// Speed of its crank over that of the mass.
    pub ratio: N,
    /// Its crank angle where that of the mass is 0 \[rad\].
    pub phase: N,
}

/// Damping from outside against the rotation of all masses together, as its share of each has it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Swing<N = f64> {
    /// Damping of every mass \[N m s/rad\].
    pub damping: Vec<N>,
    /// Share of every mass in the moment of momentum.
    pub share: Vec<N>,
}

/// Masses with links between them. The last mass is the crank, with the mechanism.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Chain<N = f64> {
    /// Inertias of the masses but the crank \[kg m²\].
    pub inertia: Vec<N>,
    /// Inertia of the drive that does not turn with the crank as one \[kg m²\]: the reduction counts it there.
    pub apart: N,
    /// What joins the masses.
    pub links: Vec<Link<N>>,
    /// What drives them.
    pub drivers: Vec<Torque<N>>,
    /// What they drive beside mechanisms.
    pub loads: Vec<Torque<N>>,
    /// Further mechanisms.
    pub stations: Vec<Station<N>>,
    /// Damping from outside, if there is any.
    pub swing: Option<Swing<N>>,
}

impl<N: Real> Source<N> {
    fn add_numbers(&self, list: &mut Vec<N>) {
        match self {
            Source::Own => {}
            Source::Held(speed) => list.push(*speed),
            Source::Motor(part) => list.extend_from_slice(&part.q),
            Source::Power { torque, speed, exponent } => list.extend([*torque, *speed, *exponent]),
        }
    }
}

impl Source {
    fn with<N: Real>(&self, next: &mut impl FnMut() -> N) -> Source<N> {
        match self {
            Source::Own => Source::Own,
            Source::Held(_) => Source::Held(next()),
            Source::Motor(part) => {
                Source::Motor(Part { plan: part.plan.clone(), q: part.q.iter().map(|_| next()).collect() })
            }
            Source::Power { .. } => Source::Power { torque: next(), speed: next(), exponent: next() },
        }
    }
}

impl Chain {
    /// The same driveline with other numbers, in the order of [`Chain::numbers`].
    pub fn with<N: Real>(&self, numbers: &[N]) -> Chain<N> {
        let mut rest = numbers.iter().copied();
        let mut next = || rest.next().unwrap_or(N::splat(f64::NAN));
        let inertia = self.inertia.iter().map(|_| next()).collect();
        let apart = next();
        let link =
            |link: &Link| Link { first: link.first, second: link.second, law: link.law.with(&mut next) };
        let links = self.links.iter().map(link).collect();
        let [drivers, loads] = [&self.drivers, &self.loads].map(|list| {
            let with = |each: &Torque| Torque { mass: each.mass, source: each.source.with(&mut next) };
            list.iter().map(with).collect()
        });
        let station = |each: &Station| Station {
            mass: each.mass,
            part: each.part.clone(),
            ratio: next(),
            phase: next(),
        };
        let stations = self.stations.iter().map(station).collect();
        let swing = self.swing.as_ref().map(|swing| Swing {
            damping: swing.damping.iter().map(|_| next()).collect(),
            share: swing.share.iter().map(|_| next()).collect(),
        });
        Chain { inertia, apart, links, drivers, loads, stations, swing }
    }
}

impl<N: Real> Chain<N> {
    /// All its numbers, one behind the other: inertias, what is apart, those of links, drivers, loads, stations, and of damping
    /// from outside; a station's mechanism is not of them.
    pub fn numbers(&self) -> Vec<N> {
        let mut list = self.inertia.clone();
        list.push(self.apart);
        self.links.iter().for_each(|link| link.law.add_numbers(&mut list));
        self.drivers.iter().chain(&self.loads).for_each(|each| each.source.add_numbers(&mut list));
        list.extend(self.stations.iter().flat_map(|each| [each.ratio, each.phase]));
        if let Some(swing) = &self.swing {
            list.extend(swing.damping.iter().chain(&swing.share));
        }
        list
    }

    /// Number of masses.
    pub fn masses(&self) -> usize {
        self.inertia.len() + 1
    }

    /// Whether all numbers of masses are those of masses.
    pub fn fits(&self) -> bool {
        let n = self.masses();
        let on_masses = self.drivers.iter().chain(&self.loads).all(|torque| torque.mass < n);
        let swings =
            self.swing.as_ref().is_none_or(|swing| swing.damping.len() == n && swing.share.len() == n);
        let stands = self.stations.iter().all(|station| station.mass < n);
        on_masses && swings && stands && self.links.iter().all(|link| link.first < n && link.second < n)
    }

    /// Numbers of a state: twist and speed against the crank of every mass but the crank, and the crank's speed.
    pub fn states(&self) -> usize {
        2 * self.masses() - 1
    }

    /// Twist of a link, and its rate.
    #[inline(always)]
    pub fn twist(&self, link: &Link<N>, y: &[N]) -> [N; 2] {
        let others = self.masses() - 1;
        let of = |mass: usize, first: usize| if mass < others { y[first + mass] } else { N::splat(0.0) };
        [of(link.first, 0) - of(link.second, 0), of(link.first, others) - of(link.second, others)]
    }

    /// Whether all links are straight springs with dampers.
    pub fn is_linear(&self) -> bool {
        self.links.iter().all(|link| link.law.is_linear())
    }

    /// Torque of a link \[N m\] with its slopes by twist and rate.
    #[inline(always)]
    pub fn torque(&self, link: &Link<N>, y: &[N]) -> Transmitted<N> {
        let [twist, rate] = self.twist(link, y);
        link.law.torque(twist, rate)
    }

    /// The same by the form that its law has at another state.
    #[inline(always)]
    pub fn torque_like(&self, link: &Link<N>, y: &[N], near: &[N]) -> Transmitted<N> {
        let ([twist, rate], [t, r]) = (self.twist(link, y), self.twist(link, near));
        link.law.of_zone(link.law.zone(t, r), twist, rate)
    }

    /// Angle of a mass at a crank angle \[rad\].
    #[inline(always)]
    pub fn angle(&self, mass: usize, phi: N, y: &[N]) -> N {
        if mass < self.masses() - 1 { phi + y[mass] } else { phi }
    }

    /// Speed of a mass \[rad/s\].
    #[inline(always)]
    pub fn speed(&self, mass: usize, y: &[N]) -> N {
        let others = self.masses() - 1;
        let crank = y[2 * others];
        if mass < others { crank + y[others + mass] } else { crank }
    }
}
