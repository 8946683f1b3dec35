//! A train in motion: masses, links between them, inertias that change with the angle, torques.

use super::controllers::Controller;
use super::curve::Curve;
use super::friction::Friction;
use super::pendulums::Pendulum;
use super::periodic::Periodic;
use super::torque::Torque;
use linkwright_kernel::error::PlanError;

/// What twists between two masses, as seen at a part that turns `ratio` times as fast as they do.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// Masses, the number of masses for the ground.
    pub ends: [usize; 2],
    pub ratio: f64,
    /// \[N m/rad\]
    pub stiffness: f64,
    /// \[N m s/rad\]
    pub damping: f64,
    /// Torque over twist, added to that of the stiffness.
    pub curve: Option<usize>,
    pub manner: Manner,
}

/// What a link has beyond a spring and a damper between two masses that turn alike.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Manner {
    /// No stiffness: both ends move as one, and the torque follows from that.
    pub rigid: bool,
    /// Damping acts while the flanks touch, and never pulls.
    pub contact: bool,
    /// Friction of the teeth at the first end.
    pub loss: Option<Loss>,
    pub joint: Option<Joint>,
    pub carrier: Option<Carrier>,
}

/// Torque at the first end over that of the teeth: while the first end drives, and while the second does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// 1/η
    pub forward: f64,
    /// The efficiency of back-driving, zero of a stage that locks itself.
    pub reverse: f64,
}

/// A Hooke's joint at the first end: tan ψ = tan φ/cos α, φ the angle of the part and its phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// cos α
    pub cosine: f64,
    pub phase: f64,
}

/// A mass that carries the bearings of a mesh: Δ = Σ share · angle of first end, second end and carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    pub mass: usize,
    pub shares: [f64; 3],
}

/// An inertia that changes with the angle of its part.
#[derive(Clone, Copy, Debug)]
pub struct Rotor {
    pub mass: usize,
    /// Speed of the part over that of the mass.
    pub ratio: f64,
    pub phase: f64,
    pub table: usize,
}

/// Masses, links and torques.
#[derive(Clone, Debug, Default)]
pub struct System {
    /// Constant part \[kg m²\].
    pub inertia: Vec<f64>,
    /// Against the ground \[N m s/rad\].
    pub damping: Vec<f64>,
    /// Against the train as a whole: it resists swinging, not turning \[N m s/rad\].
    pub swing_damping: Vec<f64>,
    /// Zero for masses that rest while the train runs, such as a housing on its seat, else one; empty if all turn.
    pub turns: Vec<f64>,
    pub links: Vec<Link>,
    pub rotors: Vec<Rotor>,
    pub torques: Vec<Torque>,
    pub pendulums: Vec<Pendulum>,
    pub controllers: Vec<Controller>,
    pub frictions: Vec<Friction>,
    pub tables: Vec<Periodic>,
    pub curves: Vec<Curve>,
}

/// Share of the sizes of its parts that a sum of zero may be by rounding.
const EQUAL: f64 = 1e-9;

fn below(what: &'static str, value: usize, made: usize) -> Result<(), PlanError> {
    if value < made { Ok(()) } else { Err(PlanError::Missing { what, value, made }) }
}

fn length(what: &'static str, found: usize, expected: usize) -> Result<(), PlanError> {
    if found == expected { Ok(()) } else { Err(PlanError::Length { what, found, expected }) }
}

impl System {
    /// How many masses.
    pub fn len(&self) -> usize {
        self.inertia.len()
    }

    /// Never: a system has at least one mass.
    pub fn is_empty(&self) -> bool {
        self.inertia.is_empty()
    }

    /// Whether it can rotate as a rigid body.
    pub fn is_free(&self) -> bool {
        self.links.iter().all(|link| self.lets_turn(link))
    }

    /// Whether a link does not resist a rotation of all that it joins as a rigid body.
    fn lets_turn(&self, link: &Link) -> bool {
        let parts = link.masses(self.len()).into_iter().zip(link.shares());
        let [apart, size] = parts.fold([0.0; 2], |[sum, size], (mass, share)| {
            let part = share * self.turns_of(mass);
            [sum + part, size + part.abs()]
        });
        apart.abs() <= EQUAL * size
    }

    /// Whether a mass turns with the train, 1, or rests, 0; the ground rests.
    pub fn turns_of(&self, mass: usize) -> f64 {
        self.turns.get(mass).copied().unwrap_or(if mass < self.len() { 1.0 } else { 0.0 })
    }

    /// First mass of the part that each mass belongs to, and of the ground at the end: links join parts, and friction does not.
    /// Without friction the train is one.
    pub fn parts(&self) -> Vec<usize> {
        let n = self.len();
        if self.frictions.is_empty() {
            return vec![0; n + usize::from(!self.is_free())];
        }
        let mut parts: Vec<usize> = (0..=n).collect();
        let mut union = |one: usize, other: usize| {
            let [a, b] = [parts[one], parts[other]];
            parts.iter_mut().filter(|part| **part == a.max(b)).for_each(|part| *part = a.min(b));
        };
        for link in &self.links {
            // What rests while the train turns, such as a housing, joins nothing; a link that resists turning holds.
            let moves = link.masses(n).into_iter().zip(link.shares());
            let turning: Vec<usize> = moves
                .filter(|&(mass, share)| share != 0.0 && mass < n && self.turns_of(mass) != 0.0)
                .map(|(mass, _)| mass)
                .collect();
            turning.windows(2).for_each(|pair| union(pair[0], pair[1]));
            turning.first().filter(|_| !self.lets_turn(link)).into_iter().for_each(|&mass| union(mass, n));
        }
        self.pendulums.iter().for_each(|pendulum| union(pendulum.disc, pendulum.bob));
        parts
    }

    /// Share of each mass in the mean inertia of its part: weights of the speeds whose sum is that of the part as a whole. None
    /// of a part that is held, which as a whole stands.
    pub fn shares(&self) -> Vec<f64> {
        let (n, parts) = (self.len(), self.parts());
        let held = parts.get(n).copied();
        let mut shares: Vec<f64> =
            self.inertia.iter().enumerate().map(|(i, j)| j * self.turns_of(i)).collect();
        for rotor in &self.rotors {
            shares[rotor.mass] += rotor.ratio * rotor.ratio * self.tables[rotor.table].mean();
        }
        let mut sums = vec![0.0; n + 1];
        (0..n).for_each(|i| sums[parts[i]] += shares[i]);
        for (share, &part) in shares.iter_mut().zip(&parts) {
            *share = if held == Some(part) || sums[part] == 0.0 { 0.0 } else { *share / sums[part] };
        }
        shares
    }

    /// Checks that there is a mass, and that all that is spoken of is there.
    ///
    /// # Errors
    /// [`PlanError`] names the first list or index that does not make sense.
    pub fn check(&self) -> Result<(), PlanError> {
        let n = self.len();
        if n == 0 {
            return Err(PlanError::Length { what: "list of masses", found: 0, expected: 1 });
        }
        length("list of damping", self.damping.len(), n)?;
        length("list of damping of swings", self.swing_damping.len(), n)?;
        if !self.turns.is_empty() {
            length("list of what turns", self.turns.len(), n)?;
        }
        let curve = |curve: Option<usize>| curve.map_or(Ok(()), |k| below("curve", k, self.curves.len()));
        for link in &self.links {
            // The ground is the mass beyond the last.
            link.masses(n).into_iter().try_for_each(|end| below("mass", end, n + 1))?;
            curve(link.curve)?;
        }
        for rotor in &self.rotors {
            below("mass", rotor.mass, n)?;
            below("table", rotor.table, self.tables.len())?;
        }
        for pendulum in &self.pendulums {
            [pendulum.disc, pendulum.bob].into_iter().try_for_each(|mass| below("mass", mass, n))?;
        }
        for controller in &self.controllers {
            [controller.mass, controller.integral].into_iter().try_for_each(|mass| below("mass", mass, n))?;
            curve(Some(controller.set_point))?;
        }
        for torque in &self.torques {
            below("mass", torque.mass, n)?;
            curve(torque.weight)?;
            curve(torque.law.curve())?;
            torque.shape.map_or(Ok(()), |shape| below("table", shape.table, self.tables.len()))?;
        }
        for friction in &self.frictions {
            friction.ends.into_iter().try_for_each(|end| below("mass", end, n + 1))?;
            curve(friction.engagement)?;
            [friction.forward, friction.backward]
                .into_iter()
                .flatten()
                .try_for_each(|grip| curve(grip.curve))?;
        }
        Ok(())
    }
}
