//! The driveline as masses and links, all referred to the speed of the crank. Its numbers are plain ones or, for derivatives, duals.

use linkwright_kernel::real::Real;

/// A spring with a damper between two masses: T = k Δ + c Δ˙, with the twist Δ of the first against the second.
#[derive(Clone, Copy, Debug)]
pub struct Link<N = f64> {
    /// Mass that T holds back.
    pub first: usize,
    /// Mass that T drives.
    pub second: usize,
    /// k \[N m/rad\].
    pub stiffness: N,
    /// c \[N m s/rad\].
    pub damping: N,
}

/// What drives a mass.
#[derive(Clone, Copy, Debug)]
pub enum Driver<N = f64> {
    /// The motor of the machine, by its characteristic.
    Motor,
    /// A motor that keeps this speed \[rad/s\] whatever it takes.
    Held(N),
}

/// Masses with links between them. The last mass is the crank, with the mechanism.
#[derive(Clone, Debug)]
pub struct Chain<N = f64> {
    /// Inertias of the masses but the crank \[kg m²\].
    pub inertia: Vec<N>,
    /// Inertia of the drive that does not turn with the crank as one \[kg m²\]: the reduction counts it there.
    pub apart: N,
    /// What joins the masses.
    pub links: Vec<Link<N>>,
    /// Mass that is driven.
    pub driven: usize,
    /// What drives it.
    pub driver: Driver<N>,
}

impl Chain {
    /// All its numbers, one behind the other: inertias, what is apart, stiffness and damping of each link, a speed that is held.
    pub fn numbers(&self) -> Vec<f64> {
        let of_links = self.links.iter().flat_map(|link| [link.stiffness, link.damping]);
        let held = if let Driver::Held(speed) = self.driver { Some(speed) } else { None };
        self.inertia.iter().copied().chain([self.apart]).chain(of_links).chain(held).collect()
    }

    /// The same driveline with other numbers, in the order of [`Chain::numbers`].
    pub fn with<N: Real>(&self, numbers: &[N]) -> Chain<N> {
        let (inertia, rest) = numbers.split_at(self.inertia.len());
        let link = |(link, rates): (&Link, &[N])| Link {
            first: link.first,
            second: link.second,
            stiffness: rates[0],
            damping: rates[1],
        };
        let driver = match self.driver {
            Driver::Motor => Driver::Motor,
            Driver::Held(_) => Driver::Held(rest[rest.len() - 1]),
        };
        Chain {
            inertia: inertia.to_vec(),
            apart: rest[0],
            links: self.links.iter().zip(rest[1..].chunks_exact(2)).map(link).collect(),
            driven: self.driven,
            driver,
        }
    }
}

impl<N: Real> Chain<N> {
    /// Number of masses.
    pub fn masses(&self) -> usize {
        self.inertia.len() + 1
    }

    /// Whether all numbers of masses are those of masses.
    pub fn fits(&self) -> bool {
        let n = self.masses();
        self.driven < n && self.links.iter().all(|link| link.first < n && link.second < n)
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

    /// Torque of a link \[N m\].
    #[inline(always)]
    pub fn torque(&self, link: &Link<N>, y: &[N]) -> N {
        let [twist, rate] = self.twist(link, y);
        link.stiffness * twist + link.damping * rate
    }

    /// Speed of a mass \[rad/s\].
    #[inline(always)]
    pub fn speed(&self, mass: usize, y: &[N]) -> N {
        let others = self.masses() - 1;
        let crank = y[2 * others];
        if mass < others { crank + y[others + mass] } else { crank }
    }
}
