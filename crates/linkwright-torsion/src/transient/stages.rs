//! Friction of the teeth of gear stages: efficiency by direction of power, stuck at rest.
//!
//! The teeth carry T at the second end, and at the first
//!
//! ```text
//! X = T/η while the first end drives, T ω > 0        X = η' T while the second does, T ω < 0
//! ```
//!
//! At rest X takes any value between both, and the first end stays as long as it need not be beyond: as Coulomb's friction
//! whose capacity grows with the load. η' = 0 locks itself. Of a rigid stage T follows from equal accelerations of its ends,
//!
//! ```text
//! T (n²/J_b + g n²/J_a) = n (a_a − a_b)        g = X/T
//! ```
//!
//! solved for all rigid and stuck stages at once.
//!
//! Source: Pelchen, Schweiger and Otter, *Modeling and simulating the efficiency of gearboxes and of planetary gearboxes*, 2nd
//! International Modelica Conference (2002); reference model LossyGear of the Modelica Standard Library.

use super::contacts::Contacts;
use super::system::{Link, Loss};
use linkwright_kernel::matrix::LuFactors;

/// Added to the mobility of each row, as a share: rows that say the same share their torque.
const DEPENDENT: f64 = 1e-12;

/// Attempts to find the directions of power of rigid stages.
const ATTEMPTS: usize = 30;

/// Rotation of the first end of a stage with losses: forward, backward, stuck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    Forward,
    Backward,
    Stuck,
}

/// Of a rigid stage without losses.
pub(super) const LOSSLESS: Loss = Loss { forward: 1.0, reverse: 1.0 };

impl Loss {
    /// Torque at the first end over that of the teeth.
    pub(super) fn factor(&self, torque: f64, sense: Sense) -> f64 {
        let drives = match sense {
            Sense::Stuck => return 1.0,
            Sense::Forward => torque > 0.0,
            Sense::Backward => torque < 0.0,
        };
        if drives { self.forward } else { self.reverse }
    }

    /// Bounds of the torque at the first end at rest.
    pub(super) fn bounds(&self, torque: f64) -> [f64; 2] {
        let (a, b) = (self.forward * torque, self.reverse * torque);
        [a.min(b), a.max(b)]
    }
}

/// A row of the equilibrium of rigid and stuck stages: the sum of accelerations times `join` vanishes, its torque acts by `push`.
#[derive(Clone, Copy, Debug)]
struct Row {
    stage: usize,
    is_teeth: bool,
    masses: [usize; 2],
    join: [f64; 2],
    push: [f64; 2],
}

/// A change that the sense of a stage has to make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    pub(super) stage: usize,
    pub(super) next: Sense,
}

/// Stages that are rigid or have losses, at an instant.
#[derive(Clone, Debug, Default)]
pub struct Stages {
    /// Places of the links, among all and among those that are no chain.
    pub links: Vec<usize>,
    pub(super) others: Vec<usize>,
    pub(super) senses: Vec<Sense>,
    /// Torque of the teeth of each, and what friction adds at rest at the first end.
    pub(super) teeth: Vec<f64>,
    pub(super) held: Vec<f64>,
}

impl Stages {
    /// Of links, of which some are no chain; stuck until their speeds are known.
    pub fn of(links: &[Link], others: &[usize]) -> Self {
        let counts = |place: &usize| links[*place].manner.loss.is_some() || links[*place].manner.rigid;
        let (others, links): (Vec<usize>, Vec<usize>) =
            others.iter().copied().enumerate().filter(|(_, place)| counts(place)).unzip();
        let none = vec![0.0; links.len()];
        Stages { senses: vec![Sense::Stuck; links.len()], teeth: none.clone(), held: none, links, others }
    }

    /// Whether there are any.
    pub fn any(&self) -> bool {
        !self.links.is_empty()
    }

    /// How many.
    pub fn count(&self) -> usize {
        self.links.len()
    }

    /// Place of a link among them.
    fn place(&self, link: usize) -> Option<usize> {
        self.links.iter().position(|&place| place == link)
    }

    /// A stage, with its losses.
    pub fn stage<'s>(&self, links: &'s [Link], stage: usize) -> (&'s Link, Loss) {
        let link = &links[self.links[stage]];
        (link, link.manner.loss.unwrap_or(LOSSLESS))
    }

    /// Torque at the first end over that of the teeth of an elastic mesh.
    pub fn factor(&mut self, links: &[Link], link: usize, torque: f64) -> f64 {
        let Some(stage) = self.place(link) else { return 1.0 };
        self.teeth[stage] = torque;
        self.last_factor(links, link)
    }

    /// The same as it was last.
    pub fn last_factor(&self, links: &[Link], link: usize) -> f64 {
        let Some(stage) = self.place(link) else { return 1.0 };
        self.stage(links, stage).1.factor(self.teeth[stage], self.senses[stage])
    }

    /// Torque of the teeth at the instant last evaluated.
    pub fn torque(&self, link: usize) -> f64 {
        self.place(link).map_or(0.0, |stage| self.teeth[stage])
    }

    /// Senses from the speeds of the masses.
    pub fn set_senses(&mut self, links: &[Link], omega: &[f64]) {
        for stage in 0..self.count() {
            let speed = omega[self.stage(links, stage).0.ends[0]];
            self.senses[stage] = if speed > 0.0 {
                Sense::Forward
            } else if speed < 0.0 {
                Sense::Backward
            } else {
                Sense::Stuck
            };
        }
    }

    /// Makes a change.
    pub(super) fn make(&mut self, Change { stage, next }: Change) {
        self.senses[stage] = next;
    }

    /// Rows of all stages.
    fn rows(&self, links: &[Link]) -> Vec<Row> {
        let mut rows = Vec::new();
        for (stage, &sense) in self.senses.iter().enumerate() {
            let (link, loss) = self.stage(links, stage);
            let ([a, b], n) = (link.ends, link.ratio);
            if link.manner.rigid {
                let factor = loss.factor(self.teeth[stage], sense);
                let (join, push) = ([n, -n], [factor * n, -n]);
                rows.push(Row { stage, is_teeth: true, masses: [a, b], join, push });
            }
            if link.manner.loss.is_some() && sense == Sense::Stuck {
                let own = [n, 0.0];
                rows.push(Row { stage, is_teeth: false, masses: [a, a], join: own, push: own });
            }
        }
        rows
    }

    /// Lets stuck ends rest and both ends of rigid stages move as one, from the accelerations that they would have without;
    /// whether directions of power are found that agree with the torques.
    pub fn engage(
        &mut self,
        links: &[Link],
        inertia: &[f64],
        contacts: &mut Contacts,
        acceleration: &mut [f64],
    ) -> bool {
        let free = acceleration.to_vec();
        for _ in 0..ATTEMPTS {
            let rows = self.rows(links);
            acceleration.copy_from_slice(&free);
            let torques = hold(&rows, inertia, contacts, acceleration);
            let mut settled = true;
            for (row, &torque) in rows.iter().zip(&torques) {
                let (_, loss) = self.stage(links, row.stage);
                if row.is_teeth {
                    let (sense, before) = (self.senses[row.stage], self.teeth[row.stage]);
                    settled &= loss.factor(torque, sense) == loss.factor(before, sense);
                    self.teeth[row.stage] = torque;
                } else {
                    self.held[row.stage] = torque;
                }
            }
            if settled {
                if contacts.any() {
                    rows.iter().zip(torques).for_each(|(row, torque)| row.load(torque, contacts));
                }
                return true;
            }
        }
        false
    }

    /// The same for changes of the accelerations, at the senses and directions of power last found.
    pub fn engage_changes(&self, links: &[Link], inertia: &[f64], contacts: &Contacts, changes: &mut [f64]) {
        if self.any() {
            hold(&self.rows(links), inertia, contacts, changes);
        }
    }

    /// Each stage with its sense.
    pub(super) fn senses_of<'s>(&'s self, links: &'s [Link]) -> impl Iterator<Item = (&'s Link, Sense)> {
        self.senses.iter().enumerate().map(|(stage, &sense)| (self.stage(links, stage).0, sense))
    }

    /// Writes the losses of rigid stages among those of links that are no chain.
    pub fn lose(&self, links: &[Link], omega: &[f64], losses: &mut [f64]) {
        for (stage, &other) in self.others.iter().enumerate() {
            let (link, loss) = self.stage(links, stage);
            if link.manner.rigid {
                let torque = self.teeth[stage];
                let factor = loss.factor(torque, self.senses[stage]);
                losses[other] = (factor - 1.0) * torque * link.ratio * omega[link.ends[0]];
            }
        }
    }

    /// Direction of the torque of each rigid stage.
    pub fn rigid_senses<'s>(&'s self, links: &'s [Link]) -> impl Iterator<Item = u32> + 's {
        let rigid = |(stage, torque): (usize, &f64)| {
            self.stage(links, stage).0.manner.rigid.then_some(u32::from(*torque > 0.0))
        };
        self.teeth.iter().enumerate().filter_map(rigid)
    }
}

impl Row {
    /// Sum that vanishes.
    fn along(&self, list: &[f64]) -> f64 {
        self.masses.iter().zip(self.join).map(|(&mass, join)| join * list[mass]).sum()
    }

    /// Accelerations by a unit of its torque, without groups of masses.
    fn alone(&self, inertia: &[f64], masses: usize) -> Vec<f64> {
        let mut response = vec![0.0; masses];
        for (&mass, push) in self.masses.iter().zip(self.push) {
            response[mass] += push / inertia[mass];
        }
        response
    }

    /// Takes its torque from what acts on the masses.
    fn load(&self, torque: f64, contacts: &mut Contacts) {
        self.masses.iter().zip(self.push).for_each(|(&mass, push)| contacts.take(mass, push * torque));
    }
}

/// Accelerations at which all rows vanish, from those without; torques of the rows. A row whose masses stuck elements hold
/// already has no torque.
fn hold(rows: &[Row], inertia: &[f64], contacts: &Contacts, acceleration: &mut [f64]) -> Vec<f64> {
    let masses = acceleration.len();
    let mut responses: Vec<Vec<f64>> = rows.iter().map(|row| row.alone(inertia, masses)).collect();
    let sizes: Vec<f64> = rows.iter().zip(&responses).map(|(row, by)| row.along(by).abs()).collect();
    responses.iter_mut().for_each(|by| contacts.join(by, inertia));
    let mut factors = LuFactors::<f64>::new(rows.len());
    factors.factor(|i, j| {
        let mobility = rows[i].along(&responses[j]);
        if i == j { mobility + DEPENDENT * sizes[i] } else { mobility }
    });
    let mut torques = vec![0.0; rows.len()];
    // The second time what was added to the mobilities is made good.
    for _ in 0..2 {
        let mut more: Vec<f64> = rows.iter().map(|row| row.along(acceleration)).collect();
        factors.solve(&mut more);
        for (response, torque) in responses.iter().zip(&more) {
            acceleration.iter_mut().zip(response).for_each(|(a, by)| *a -= by * torque);
        }
        torques.iter_mut().zip(more).for_each(|(torque, more)| *torque += more);
    }
    torques
}
