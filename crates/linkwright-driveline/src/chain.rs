//! The driveline as masses and links, all referred to the speed of the crank.

use linkwright_core::drive::structure::Plan;

/// A spring with a damper between two masses: T = k Δ + c Δ˙, with the twist Δ of the first against the second.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// Mass that T holds back.
    pub first: usize,
    /// Mass that T drives.
    pub second: usize,
    /// k \[N m/rad\].
    pub stiffness: f64,
    /// c \[N m s/rad\].
    pub damping: f64,
}

/// The structure of a machine with its numbers: a further motor, or a further mechanism.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its structure.
    pub plan: Plan,
    /// Its numbers.
    pub q: Vec<f64>,
}

/// Where a torque on a mass comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// The motor of the machine at the crank, by its characteristic.
    Own,
    /// A motor that keeps this speed \[rad/s\] whatever it takes.
    Held(f64),
    /// The motor of another plan through the gearbox of that plan, at the speed of the mass.
    Motor(Box<Part>),
    /// A power of the speed of the mass, `torque` (ω/`speed`)^`exponent`; positive if it drives, \[N m\].
    Power {
        /// T₀.
        torque: f64,
        /// ω₀.
        speed: f64,
        /// p.
        exponent: f64,
    },
}

/// A torque on a mass from outside.
#[derive(Clone, Debug)]
pub struct Torque {
    /// Mass on which it acts.
    pub mass: usize,
    /// Where it comes from.
    pub source: Source,
}

/// A further mechanism on a mass. Its crank stands at `ratio` times the angle of the mass plus `phase`.
#[derive(Clone, Debug)]
pub struct Station {
    /// Mass that its crank turns with.
    pub mass: usize,
    /// The mechanism, without a drive.
    pub part: Part,
    /// Speed of its crank over that of the mass.
    pub ratio: f64,
    /// Its crank angle where that of the mass is 0 \[rad\].
    pub phase: f64,
}

/// Damping from outside against the rotation of all masses together, as its share of each has it.
#[derive(Clone, Debug)]
pub struct Swing {
    /// Damping of every mass \[N m s/rad\].
    pub damping: Vec<f64>,
    /// Share of every mass in the moment of momentum.
    pub share: Vec<f64>,
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
    /// What drives them.
    pub drivers: Vec<Torque>,
    /// What they drive beside mechanisms.
    pub loads: Vec<Torque>,
    /// Further mechanisms.
    pub stations: Vec<Station>,
    /// Damping from outside, if there is any.
    pub swing: Option<Swing>,
}

impl Chain {
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
    pub fn twist(&self, link: &Link, y: &[f64]) -> [f64; 2] {
        let others = self.masses() - 1;
        let of = |mass: usize, first: usize| if mass < others { y[first + mass] } else { 0.0 };
        [0, others].map(|first| of(link.first, first) - of(link.second, first))
    }

    /// Torque of a link \[N m\].
    pub fn torque(&self, link: &Link, y: &[f64]) -> f64 {
        let [twist, rate] = self.twist(link, y);
        link.stiffness * twist + link.damping * rate
    }

    /// Angle of a mass at a crank angle \[rad\].
    pub fn angle(&self, mass: usize, phi: f64, y: &[f64]) -> f64 {
        if mass < self.masses() - 1 { phi + y[mass] } else { phi }
    }

    /// Speed of a mass \[rad/s\].
    pub fn speed(&self, mass: usize, y: &[f64]) -> f64 {
        let others = self.masses() - 1;
        let crank = y[2 * others];
        if mass < others { crank + y[others + mass] } else { crank }
    }
}
