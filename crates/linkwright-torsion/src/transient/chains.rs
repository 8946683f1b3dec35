//! Links that follow each other along a chain of masses, side by side in lanes: most of a train.

use super::system::{Link, System};
use linkwright_kernel::real::Real;

/// Links from which on a chain pays.
const LEAST: usize = 4;

/// Links of a system: those of chains, and all others.
#[derive(Clone, Debug)]
pub struct Links {
    pub chains: Vec<Chain>,
    /// Places of the others in the list of links.
    pub others: Vec<usize>,
}

/// Links without curves; each joins a mass and the next.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Place of the first link in the list of links, and its first mass.
    link: usize,
    mass: usize,
    ratio: Vec<f64>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

/// Angles and speeds for twists, sums of torques on masses and ground, and losses of links.
#[derive(Debug)]
pub struct TwistSums<'a> {
    pub angle: &'a [f64],
    pub speed: &'a [f64],
    pub net: &'a mut [f64],
    pub losses: &'a mut [f64],
}

impl Links {
    /// Of a system.
    pub fn of(system: &System) -> Self {
        let mut found = Links { chains: Vec::new(), others: Vec::new() };
        let mut first = 0;
        while first < system.links.len() {
            let rest = &system.links[first..];
            let length = 1 + rest.windows(2).take_while(|pair| follows(&pair[0], &pair[1])).count();
            if length >= LEAST && starts(&rest[0]) {
                found.chains.push(Chain::of(first, &rest[..length]));
            } else {
                found.others.extend(first..first + length);
            }
            first += length;
        }
        found
    }
}

/// Whether a chain may begin with a link.
fn starts(link: &Link) -> bool {
    link.curve.is_none() && link.ends[1] == link.ends[0] + 1
}

/// Whether a link goes on where another ends.
fn follows(link: &Link, next: &Link) -> bool {
    starts(link) && starts(next) && next.ends[0] == link.ends[1]
}

impl Chain {
    fn of(first: usize, links: &[Link]) -> Self {
        let list = |f: fn(&Link) -> f64| links.iter().map(f).collect();
        Chain {
            link: first,
            mass: links[0].ends[0],
            ratio: list(|link| link.ratio),
            stiffness: list(|link| link.stiffness),
            damping: list(|link| link.damping),
        }
    }

    /// Adds their torques to the sums, and tells what they lose.
    #[inline(always)]
    pub fn twist<R: Real>(&self, to: &mut TwistSums<'_>) {
        let (mut at, n) = (0, self.ratio.len());
        while at + R::LANES <= n {
            self.twist_some::<R>(at, to);
            at += R::LANES;
        }
        while at < n {
            self.twist_some::<f64>(at, to);
            at += 1;
        }
    }

    /// As many of them as there are lanes.
    #[inline(always)]
    fn twist_some<R: Real>(&self, at: usize, to: &mut TwistSums<'_>) {
        let mass = self.mass + at;
        let beside = |list: &[f64]| R::load(&list[mass..]) - R::load(&list[mass + 1..]);
        let [ratio, stiffness, damping] =
            [&self.ratio, &self.stiffness, &self.damping].map(|list| R::load(&list[at..]));
        let (twist, rate) = (ratio * beside(to.angle), ratio * beside(to.speed));
        let loss = damping * rate;
        let torque = ratio * (stiffness * twist + loss);
        (loss * rate).store(&mut to.losses[self.link + at..]);
        (R::load(&to.net[mass..]) - torque).store(&mut to.net[mass..]);
        (R::load(&to.net[mass + 1..]) + torque).store(&mut to.net[mass + 1..]);
    }
}
