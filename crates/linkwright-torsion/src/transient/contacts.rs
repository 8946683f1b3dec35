//! States of the elements with dry friction, groups of masses that they hold together, and the torques that hold them.
//!
//! Masses that stuck elements join move as one: a = Σ M/Σ J over the group, or not at all with the ground. What an element
//! carries then follows from the balance of each mass,
//!
//! ```text
//! Σ ± n T = M − J a        with the minimum of Σ T²/R
//! ```
//!
//! the latter where several stuck elements close a loop: they share in proportion to their capacities R, as parallel
//! clutches do, within their bounds.

use super::curve::Curve;
use super::friction::{Friction, State};
use linkwright_kernel::matrix::LuFactors;

/// No group.
const NONE: usize = usize::MAX;

/// Capacity of a freewheel over the largest of the others where it shares with them, and the smallest that counts.
const UNBOUNDED: f64 = 1e2;
const SMALLEST: f64 = 1e-3;

/// Share of the torques on the masses by which a bound may be exceeded: rounding.
const ROUNDING: f64 = 1e-12;

/// An element that carries more than it can, and in which sense it begins to slide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Break {
    pub element: usize,
    pub forward: bool,
}

/// All elements of a train.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    pub states: Vec<State>,
    masses: usize,
    /// Group of each mass and of the ground; first the masses, then the ground.
    group: Vec<usize>,
    groups: usize,
    /// Torque on each mass without that of stuck elements, at the instant last evaluated.
    net: Vec<f64>,
    /// Torque of each element then.
    pub torques: Vec<f64>,
}

impl Contacts {
    /// Of elements that are open.
    pub fn new(frictions: &[Friction], masses: usize) -> Self {
        let mut contacts = Contacts {
            states: vec![State::Open; frictions.len()],
            masses,
            group: vec![NONE; masses + 1],
            groups: 0,
            net: vec![0.0; masses],
            torques: vec![0.0; frictions.len()],
        };
        contacts.regroup(frictions);
        contacts
    }

    /// Whether there is any element.
    pub fn any(&self) -> bool {
        !self.states.is_empty()
    }

    /// Whether any element is stuck.
    pub fn holds(&self) -> bool {
        self.groups > 0
    }

    /// Sets the states, and the groups that follow from them.
    pub fn set(&mut self, frictions: &[Friction], states: &[State]) {
        self.states.copy_from_slice(states);
        self.regroup(frictions);
    }

    /// Joins masses that stuck elements hold together.
    fn regroup(&mut self, frictions: &[Friction]) {
        self.group.fill(NONE);
        self.groups = 0;
        let stuck: Vec<[usize; 2]> = self.stuck(frictions).map(|(_, friction)| friction.ends).collect();
        for &[first, _] in &stuck {
            if self.group[first] != NONE {
                continue;
            }
            self.group[first] = self.groups;
            // As often as there are elements reaches the end of any chain.
            for _ in 0..stuck.len() {
                for &[a, b] in &stuck {
                    if self.group[a] == self.groups || self.group[b] == self.groups {
                        (self.group[a], self.group[b]) = (self.groups, self.groups);
                    }
                }
            }
            self.groups += 1;
        }
    }

    /// Torque on a mass without that of stuck elements, at the instant last evaluated.
    pub fn net(&self, mass: usize) -> f64 {
        self.net[mass]
    }

    fn stuck<'f>(&self, frictions: &'f [Friction]) -> impl Iterator<Item = (usize, &'f Friction)> {
        let states = self.states.clone();
        frictions.iter().enumerate().filter(move |&(e, _)| states[e] == State::Stuck)
    }

    /// Notes the torque on each mass from the acceleration that it would have alone.
    pub fn note(&mut self, acceleration: &[f64], inertia: &[f64]) {
        for i in 0..self.masses {
            self.net[i] = acceleration[i] * inertia[i];
        }
    }

    /// Takes a torque on a mass from what was noted.
    pub fn take(&mut self, mass: usize, torque: f64) {
        self.net[mass] -= torque;
    }

    /// Gives all masses of a group the mean of a list, weighted by their inertias: accelerations, speeds after an impulse, or
    /// changes of them; with the ground it is zero.
    pub fn join(&self, list: &mut [f64], inertia: &[f64]) {
        if self.groups == 0 {
            return;
        }
        let mut sums = vec![[0.0; 2]; self.groups];
        for i in 0..self.masses {
            if self.group[i] != NONE {
                let [sum, all] = &mut sums[self.group[i]];
                (*sum, *all) = (*sum + list[i] * inertia[i], *all + inertia[i]);
            }
        }
        let grounded = self.group[self.masses];
        for i in 0..self.masses {
            if self.group[i] != NONE {
                let [sum, all] = sums[self.group[i]];
                list[i] = if self.group[i] == grounded { 0.0 } else { sum / all };
            }
        }
    }

    /// Torques of the stuck elements at the instant last evaluated; the one that slides, if one cannot hold. Those of sliding
    /// ones are set already.
    pub fn carry(
        &mut self,
        frictions: &[Friction],
        engaged: &[f64],
        (acceleration, inertia): (&[f64], &[f64]),
    ) -> (f64, Option<Break>) {
        let mut spare = (f64::INFINITY, None);
        for group in 0..self.groups {
            let found = self.carry_group(frictions, engaged, (acceleration, inertia), group);
            if found.0 < spare.0 {
                spare = found;
            }
        }
        spare
    }

    /// Torques in one group; the smallest margin of its elements to a bound, negative if one does not hold, and which.
    fn carry_group(
        &mut self,
        frictions: &[Friction],
        engaged: &[f64],
        (acceleration, inertia): (&[f64], &[f64]),
        group: usize,
    ) -> (f64, Option<Break>) {
        let n = self.masses;
        let masses: Vec<usize> = (0..n).filter(|&i| self.group[i] == group).collect();
        let grounded = self.group[n] == group;
        // A mass of a group that moves follows from the others.
        let rows = if grounded { &masses[..] } else { &masses[1..] };
        let place = |mass: usize| rows.iter().position(|&i| i == mass);
        let mut free: Vec<usize> = self
            .stuck(frictions)
            .filter(|(_, friction)| self.group[friction.ends[0]] == group)
            .map(|(e, _)| e)
            .collect();
        let mut left: Vec<f64> = rows.iter().map(|&i| self.net[i] - inertia[i] * acceleration[i]).collect();
        let size = masses.iter().map(|&i| self.net[i].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let bounds = |e: usize| frictions[e].bounds(engaged[e]);
        let finite = |e: usize| bounds(e).map(|bound| if bound.is_finite() { bound.abs() } else { 0.0 });
        let largest = free.iter().flat_map(|&e| finite(e)).fold(0.0, f64::max).max(size);
        // Without a loop each torque follows from statics.
        let is_tree = free.len() == rows.len();
        let capacity = |e: usize| match bounds(e) {
            _ if is_tree => 1.0,
            [low, high] if low.is_finite() && high.is_finite() => high.max(-low).max(SMALLEST * largest),
            _ => UNBOUNDED * largest,
        };
        loop {
            let potentials = network(frictions, &free, &capacity, (rows.len(), &place), &left);
            let mut worst = (f64::INFINITY, None);
            for &e in &free {
                let Friction { ends, ratio, .. } = frictions[e];
                let at = |end: usize| place(end).map_or(0.0, |row| potentials[row]);
                let torque = ratio * capacity(e) * (at(ends[0]) - at(ends[1]));
                self.torques[e] = torque;
                let [low, high] = bounds(e);
                for (margin, forward) in [(high - torque, true), (torque - low, false)] {
                    if margin < worst.0 {
                        worst = (margin, Some(Break { element: e, forward }));
                    }
                }
            }
            let (margin, Some(breaks)) = worst else { return worst };
            if margin >= -ROUNDING * size {
                return (margin.max(0.0), Some(breaks));
            }
            // In a loop the others may carry what it cannot.
            let rest: Vec<usize> = free.iter().copied().filter(|&e| e != breaks.element).collect();
            if !spans(frictions, &rest, &masses, grounded.then_some(n)) {
                return worst;
            }
            let Friction { ends, ratio, .. } = frictions[breaks.element];
            let bound = bounds(breaks.element)[usize::from(breaks.forward)];
            self.torques[breaks.element] = bound;
            for (end, sign) in ends.into_iter().zip([1.0, -1.0]) {
                if let Some(row) = place(end) {
                    left[row] -= sign * ratio * bound;
                }
            }
            free = rest;
        }
    }
}

/// Potentials whose differences share what is left at the masses among the elements, in proportion to their capacities.
fn network(
    frictions: &[Friction],
    free: &[usize],
    capacity: &impl Fn(usize) -> f64,
    (rows, place): (usize, &impl Fn(usize) -> Option<usize>),
    left: &[f64],
) -> Vec<f64> {
    let mut matrix = vec![0.0; rows * rows];
    for &e in free {
        let Friction { ends, ratio, .. } = frictions[e];
        let weight = ratio * ratio * capacity(e);
        let [a, b] = ends.map(place);
        for (one, other) in [(a, b), (b, a)] {
            if let Some(i) = one {
                matrix[i * rows + i] += weight;
                if let Some(j) = other {
                    matrix[i * rows + j] -= weight;
                }
            }
        }
    }
    let mut factors = LuFactors::<f64>::new(rows);
    factors.factor(|i, j| matrix[i * rows + j]);
    let mut potentials = left.to_vec();
    factors.solve(&mut potentials);
    potentials
}

/// Whether elements join all masses of a group, and the ground if it is one of them.
fn spans(frictions: &[Friction], elements: &[usize], masses: &[usize], ground: Option<usize>) -> bool {
    let nodes: Vec<usize> = masses.iter().copied().chain(ground).collect();
    let mut reached = vec![nodes[0]];
    for _ in 0..elements.len() {
        for &e in elements {
            let [a, b] = frictions[e].ends;
            match (reached.contains(&a), reached.contains(&b)) {
                (true, false) => reached.push(b),
                (false, true) => reached.push(a),
                _ => {}
            }
        }
    }
    reached.len() == nodes.len()
}

/// Torque and loss of a sliding element at a slip, with the slope of the torque.
pub fn slide(
    friction: &Friction,
    state: State,
    curves: &[Curve],
    engaged: f64,
    slip: f64,
) -> Option<(f64, f64)> {
    let State::Slip { forward, piece } = state else { return None };
    let sign = if forward { 1.0 } else { -1.0 };
    let (torque, slope) = friction.grip(forward)?.at(curves, piece, sign * slip);
    Some((sign * engaged * torque, engaged * slope))
}
