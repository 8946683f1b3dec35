//! Torques of shafts as good as rigid, from what moves on one side of each.
//!
//! A shaft of 10¹⁸ N m/rad carries 100 N m at 10⁻¹⁶ rad, less than the last digit of the angles at its ends. Its torque is what
//! the parts that hang on it need beside the torques from outside:
//!
//! ```text
//! T = Σ (M − J θ̈)        over the masses beyond the shaft, θ̈ relative to the rigid group: from the step's polynomial
//! ```
//!
//! That errs by J δω/h, where stiffness times twist errs by k δΔ: the way that loses less is taken, as in steady vibration.
//! Where the steps follow the swings of a shaft, its twist is known and says the torque.
//!
//! Source: d'Alembert's principle; e.g. Wilson, *Practical Solution of Torsional Vibration Problems* I, ch. 3.

use super::rates::Rates;
use super::stepper::Stepper;
use super::system::{Link, System};

/// (ωh)² of a shaft between its masses from which on steps do not follow its swings.
const UNRESOLVED: f64 = 100.0;

/// Share of a twist's acceleration by which the polynomial's may be off.
const DOUBT: f64 = 0.01;

/// No mass is connected to the shaft.
const NONE: usize = usize::MAX;

/// Which shafts are as good as rigid in a step, and the trees that they form.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// Torques of all links at the instant last asked for.
    torques: Vec<f64>,
    rigid: Vec<bool>,
    /// Masses in the order in which they hang on each other, the ground among them; on which; first of its group.
    order: Vec<usize>,
    parent: Vec<usize>,
    root: Vec<usize>,
    /// Of the links to the mass on which one hangs, n²(k + c/h).
    bond: Vec<f64>,
    /// Torque that is missing at each mass, and beyond it; inertias and those sums of the groups.
    missing: Vec<f64>,
    whole: Vec<[f64; 2]>,
    state: Vec<f64>,
    rates: Vec<f64>,
}

/// How much a link resists over a step of a length, at its own speed \[N m/rad\].
fn resistance(link: &Link, h: f64) -> f64 {
    link.stiffness + link.damping / h
}

/// The other end of a link.
fn across(link: &Link, end: usize) -> Option<usize> {
    let [a, b] = link.ends;
    if end == a { Some(b) } else { (end == b).then_some(a) }
}

impl Equilibrium {
    /// For a system.
    pub fn new(system: &System) -> Self {
        let (n, m) = (system.len(), system.links.len());
        Equilibrium {
            torques: vec![0.0; m],
            rigid: vec![false; m],
            order: Vec::with_capacity(n + 1),
            parent: vec![NONE; n + 1],
            root: vec![NONE; n + 1],
            bond: vec![0.0; n + 1],
            missing: vec![0.0; n + 1],
            whole: vec![[0.0; 2]; n + 1],
            state: vec![0.0; 2 * n],
            rates: vec![0.0; 2 * n],
        }
    }

    /// Finds the shafts whose torque the twist tells worse in a step to a state; whether there are any.
    pub fn find(&mut self, rates: &Rates<'_>, stepper: &impl Stepper, end: &[f64], h: f64) -> bool {
        let (system, n) = (rates.system, rates.system.len());
        let relative = rates.is_relative();
        for (link, rigid) in system.links.iter().zip(&mut self.rigid) {
            if link.manner.rigid {
                *rigid = true;
                continue;
            }
            let inverse: f64 = link.ends.iter().map(|&i| rates.inertia_of(i).recip()).sum();
            let inertia = 1.0 / (link.ratio * link.ratio * inverse);
            let resolved = resistance(link, h) * h * h <= UNRESOLVED * inertia;
            *rigid = !resolved && link.is_plain() && {
                let size = |first: usize| {
                    let aside = |i: usize| if i == n || (i == 0 && relative) { 0.0 } else { end[first + i] };
                    link.ratio * link.ends.iter().map(|&i| aside(i).abs()).sum::<f64>()
                };
                let bend = link.twist(n, relative, |i| stepper.slope(1.0, h, n + i));
                let lost = f64::EPSILON * (link.stiffness * size(0) + link.damping * size(n));
                lost > inertia * (DOUBT * bend.abs() + f64::EPSILON * size(n) / h)
            };
        }
        let any = self.rigid.contains(&true);
        if any {
            self.hang(system, h);
        }
        any
    }

    /// Torque, at the instant last asked for, of a link that is as good as rigid in this step.
    pub fn torque(&self, link: usize) -> Option<f64> {
        self.rigid.get(link).is_some_and(|&rigid| rigid).then(|| self.torques[link])
    }

    /// Hangs the masses on each other by rigid links, from the ground first. A link that closes a loop carries what its twist
    /// says.
    fn hang(&mut self, system: &System, h: f64) {
        let n = system.len();
        self.order.clear();
        self.parent.fill(NONE);
        self.root.fill(NONE);
        self.bond.fill(0.0);
        let links = || {
            system
                .links
                .iter()
                .zip(&self.rigid)
                .filter(|(link, rigid)| **rigid && link.is_plain())
                .map(|(link, _)| link)
        };
        for first in (0..=n).rev() {
            if self.root[first] != NONE {
                continue;
            }
            self.root[first] = first;
            let mut next = self.order.len();
            self.order.push(first);
            while next < self.order.len() {
                let at = self.order[next];
                next += 1;
                for other in links().filter_map(|link| across(link, at)) {
                    if self.root[other] == NONE {
                        (self.root[other], self.parent[other]) = (first, at);
                        self.order.push(other);
                    }
                }
            }
        }
        for link in links() {
            if let Some((hangs, _)) = hanging(&self.parent, link) {
                self.bond[hangs] += link.ratio * link.ratio * resistance(link, h);
            }
        }
    }

    /// Torques of all links at a share of the step from a state.
    pub fn at(
        &mut self,
        rates: &mut Rates<'_>,
        stepper: &impl Stepper,
        (t, start): (f64, &Vec<f64>),
        h: f64,
        share: f64,
    ) {
        let system = rates.system;
        for i in 0..self.state.len() {
            self.state[i] = stepper.component(share, start, i);
        }
        rates.derivative(t + share * h, &self.state, &mut self.rates);
        for (place, torque) in self.torques.iter_mut().enumerate() {
            *torque = rates.link_torque(place).0;
        }
        self.balance(rates, stepper, h, share);
        for (s, link) in system.links.iter().enumerate().filter(|&(s, _)| self.rigid[s]) {
            if let Some((hangs, sign)) = hanging(&self.parent, link) {
                let part = link.ratio * resistance(link, h) / self.bond[hangs];
                self.torques[s] += sign * part * self.missing[hangs];
            }
        }
    }

    /// Torque that the twists leave missing beyond each mass for the group to move as its polynomial does.
    fn balance(&mut self, rates: &Rates<'_>, stepper: &impl Stepper, h: f64, share: f64) {
        let n = rates.system.len();
        let lead = if rates.is_relative() { stepper.slope(share, h, n) } else { 0.0 };
        self.whole.fill([0.0; 2]);
        self.missing[n] = 0.0;
        let over = |i: usize| {
            let aside = if i == 0 && rates.is_relative() { 0.0 } else { stepper.slope(share, h, n + i) };
            let lead = rates.system.turns_of(i) * lead;
            rates.acceleration[i] - (lead + aside)
        };
        for i in 0..n {
            let inertia = rates.inertia_of(i);
            self.missing[i] = inertia * over(i) + rates.torque_of_bobs(i, over);
            let [sum, all] = &mut self.whole[self.root[i]];
            (*sum, *all) = (*sum + self.missing[i], *all + inertia);
        }
        // A group moves on as the torques on all of it say; the ground stands.
        for i in 0..n {
            if self.root[i] != n {
                let [sum, all] = self.whole[self.root[i]];
                self.missing[i] -= rates.inertia_of(i) * sum / all;
            }
        }
        for &i in self.order.iter().rev() {
            if self.parent[i] != NONE {
                self.missing[self.parent[i]] += self.missing[i];
            }
        }
    }
}

/// Mass that hangs by a link on the other, and the sign of the link's torque on it.
fn hanging(parent: &[usize], link: &Link) -> Option<(usize, f64)> {
    let [a, b] = link.ends;
    if parent[a] == b { Some((a, 1.0)) } else { (parent[b] == a).then_some((b, -1.0)) }
}
