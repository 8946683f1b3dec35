//! A train in motion: masses, links between them, inertias that change with the angle, torques.

use super::curve::Curve;
use super::friction::Friction;
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
#[derive(Clone, Debug)]
pub struct System {
    /// Constant part \[kg m²\].
    pub inertia: Vec<f64>,
    /// Against the ground \[N m s/rad\].
    pub damping: Vec<f64>,
    /// Against the train as a whole: it resists swinging, not turning \[N m s/rad\].
    pub swing_damping: Vec<f64>,
    pub links: Vec<Link>,
    pub rotors: Vec<Rotor>,
    pub torques: Vec<Torque>,
    pub frictions: Vec<Friction>,
    pub tables: Vec<Periodic>,
    pub curves: Vec<Curve>,
}

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
        self.links.iter().all(|link| !link.ends.contains(&self.len()))
    }

    /// First mass of the part that each mass belongs to, and of the ground at the end: links join parts, and friction does not.
    /// Without friction the train is one.
    pub fn parts(&self) -> Vec<usize> {
        let n = self.len();
        if self.frictions.is_empty() {
            return vec![0; n + usize::from(!self.is_free())];
        }
        let mut parts: Vec<usize> = (0..=n).collect();
        for link in &self.links {
            let [a, b] = link.ends.map(|end| parts[end]);
            parts.iter_mut().filter(|part| **part == a.max(b)).for_each(|part| *part = a.min(b));
        }
        parts
    }

    /// Share of each mass in the mean inertia of its part: weights of the speeds whose sum is that of the part as a whole. None
    /// of a part that is held, which as a whole stands.
    pub fn shares(&self) -> Vec<f64> {
        let (n, parts) = (self.len(), self.parts());
        let held = parts.get(n).copied();
        let mut shares = self.inertia.clone();
        for rotor in &self.rotors {
            shares[rotor.mass] += rotor.ratio * rotor.ratio * self.tables[rotor.table].mean();
        }
        let mut sums = vec![0.0; n + 1];
        (0..n).for_each(|i| sums[parts[i]] += shares[i]);
        for (share, &part) in shares.iter_mut().zip(&parts) {
            *share = if held == Some(part) { 0.0 } else { *share / sums[part] };
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
        let curve = |curve: Option<usize>| curve.map_or(Ok(()), |k| below("curve", k, self.curves.len()));
        for link in &self.links {
            // The ground is the mass beyond the last.
            link.ends.into_iter().try_for_each(|end| below("mass", end, n + 1))?;
            curve(link.curve)?;
        }
        for rotor in &self.rotors {
            below("mass", rotor.mass, n)?;
            below("table", rotor.table, self.tables.len())?;
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
