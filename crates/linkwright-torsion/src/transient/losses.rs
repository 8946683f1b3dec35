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

use super::rates::Rates;
use super::stages::{Change, LOSSLESS, Sense};
use super::system::{Link, Loss};
use linkwright_kernel::matrix::LuFactors;

/// Share of the sizes of torques, and of the largest speed, within which a bound counts as kept; speed that is rest \[rad/s\].
const ROUNDING: f64 = 1e-11;
const REST: f64 = 1e-14;

/// Added to the mobility of each row, as a share: rows that say the same share their torque.
const DEPENDENT: f64 = 1e-12;

/// Attempts to find the directions of power of rigid stages, and the senses at one instant.
const ATTEMPTS: usize = 30;

/// A row of the equilibrium of rigid and stuck stages: the sum of accelerations times `join` vanishes, its torque acts by `push`.
#[derive(Clone, Copy, Debug)]
struct Row {
    stage: usize,
    is_teeth: bool,
    masses: [usize; 2],
    join: [f64; 2],
    push: [f64; 2],
}

impl Rates<'_> {
    fn stage(&self, stage: usize) -> (&Link, Loss) {
        let link = &self.system.links[self.stages.links[stage]];
        (link, link.manner.loss.unwrap_or(LOSSLESS))
    }

    /// Whether stages have to be looked after.
    pub fn has_stages(&self) -> bool {
        !self.stages.links.is_empty()
    }

    /// Torque at the first end over that of the teeth of an elastic mesh.
    pub(super) fn tooth_factor(&mut self, link: usize, torque: f64) -> f64 {
        let Some(stage) = self.stages.place(link) else { return 1.0 };
        self.stages.teeth[stage] = torque;
        self.stage(stage).1.factor(torque, self.stages.senses[stage])
    }

    /// Torque at the first end over that of the teeth as it was last.
    pub(super) fn last_tooth_factor(&self, link: usize) -> f64 {
        let Some(stage) = self.stages.place(link) else { return 1.0 };
        self.stage(stage).1.factor(self.stages.teeth[stage], self.stages.senses[stage])
    }

    /// Torque of the teeth of a rigid stage at the instant last evaluated.
    pub fn rigid_torque(&self, link: usize) -> f64 {
        self.stages.place(link).map_or(0.0, |stage| self.stages.teeth[stage])
    }

    /// Direction of the torque of each rigid stage.
    pub(super) fn rigid_senses(&self) -> impl Iterator<Item = u32> + '_ {
        let rigid = |(stage, torque): (usize, &f64)| {
            self.stage(stage).0.manner.rigid.then_some(u32::from(*torque > 0.0))
        };
        self.stages.teeth.iter().enumerate().filter_map(rigid)
    }

    /// Rows of all stages, for torques of their teeth.
    fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        for (stage, &sense) in self.stages.senses.iter().enumerate() {
            let (link, loss) = self.stage(stage);
            let ([a, b], n) = (link.ends, link.ratio);
            if link.manner.rigid {
                let factor = loss.factor(self.stages.teeth[stage], sense);
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

    /// Accelerations by a unit of the torque of a row.
    fn response(&self, row: &Row) -> Vec<f64> {
        let mut response = vec![0.0; self.system.len()];
        for (&mass, push) in row.masses.iter().zip(row.push) {
            response[mass] += push / self.inertia[mass];
        }
        self.share_with_pendulums(&mut response);
        response
    }

    /// Lets stuck ends rest and both ends of rigid stages move as one, from the accelerations that they would have without;
    /// torques of the rows.
    fn hold(&self, rows: &[Row], acceleration: &mut [f64]) -> Vec<f64> {
        let responses: Vec<Vec<f64>> = rows.iter().map(|row| self.response(row)).collect();
        let along = |row: &Row, list: &[f64]| -> f64 {
            row.masses.iter().zip(row.join).map(|(&mass, join)| join * list[mass]).sum()
        };
        let mut torques: Vec<f64> = rows.iter().map(|row| along(row, acceleration)).collect();
        let mut factors = LuFactors::<f64>::new(rows.len());
        factors.factor(|i, j| along(&rows[i], &responses[j]) * if i == j { 1.0 + DEPENDENT } else { 1.0 });
        factors.solve(&mut torques);
        for (response, torque) in responses.iter().zip(&torques) {
            acceleration.iter_mut().zip(response).for_each(|(a, by)| *a -= by * torque);
        }
        torques
    }

    /// Accelerations of the masses with what rigid and stuck stages carry.
    pub(super) fn engage(&mut self) {
        let mut free = std::mem::take(&mut self.acceleration);
        for _ in 0..ATTEMPTS {
            let (rows, mut held) = (self.rows(), free.clone());
            let torques = self.hold(&rows, &mut held[..self.system.len()]);
            let mut settled = true;
            for (row, &torque) in rows.iter().zip(&torques) {
                let (_, loss) = self.stage(row.stage);
                if row.is_teeth {
                    let (sense, before) = (self.stages.senses[row.stage], self.stages.teeth[row.stage]);
                    settled &= loss.factor(torque, sense) == loss.factor(before, sense);
                    self.stages.teeth[row.stage] = torque;
                } else {
                    self.stages.held[row.stage] = torque;
                }
            }
            if settled {
                self.acceleration = held;
                self.lose();
                return;
            }
        }
        // No directions of power agree with the torques.
        free[0] = f64::NAN;
        self.acceleration = free;
    }

    /// The same for changes of the accelerations, at the senses and directions of power last found.
    pub(super) fn engage_changes(&self, changes: &mut [f64]) {
        self.hold(&self.rows(), changes);
    }

    /// Notes the losses of rigid stages.
    fn lose(&mut self) {
        let first = self.losses_of_others();
        for (stage, &other) in self.stages.others.iter().enumerate() {
            let (link, loss) = self.stage(stage);
            if link.manner.rigid {
                let torque = self.stages.teeth[stage];
                let factor = loss.factor(torque, self.stages.senses[stage]);
                let speed = link.ratio * self.omega[link.ends[0]];
                self.powers[first + other] = (factor - 1.0) * torque * speed;
            }
        }
    }

    /// A change that some stage has to make at the instant last evaluated.
    pub fn change(&self) -> Option<Change> {
        let rest = REST + ROUNDING * self.omega.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        (0..self.stages.senses.len()).find_map(|stage| {
            let (link, loss) = self.stage(stage);
            link.manner.loss?;
            let (speed, torque) = (self.omega[link.ends[0]], self.stages.teeth[stage]);
            let next = match self.stages.senses[stage] {
                Sense::Forward => (speed < -rest).then_some(Sense::Stuck),
                Sense::Backward => (speed > rest).then_some(Sense::Stuck),
                Sense::Stuck => {
                    let (needed, [low, high]) = (torque + self.stages.held[stage], loss.bounds(torque));
                    let doubt = ROUNDING * (needed.abs() + low.abs() + high.abs());
                    if needed > high + doubt {
                        Some(Sense::Forward)
                    } else {
                        (needed < low - doubt).then_some(Sense::Backward)
                    }
                }
            };
            next.map(|next| Change { stage, next })
        })
    }

    /// Makes a change, and those that follow from it at once, in a state at a time; whether they come to an end.
    pub fn make(&mut self, first: Option<Change>, t: f64, state: &mut [f64]) -> bool {
        let mut due = first;
        for _ in 0..ATTEMPTS {
            if let Some(Change { stage, next }) = due {
                self.stages.senses[stage] = next;
                if next == Sense::Stuck {
                    self.stop(stage, state);
                }
            }
            self.derivative(t, state, &mut state.to_vec());
            due = self.change();
            if due.is_none() {
                return true;
            }
        }
        false
    }

    /// Lets the first end of a stage rest, and the second with it if it is rigid.
    fn stop(&self, stage: usize, state: &mut [f64]) {
        let (n, link) = (self.system.len(), self.stage(stage).0);
        self.to_absolute(state);
        state[n + link.ends[0]] = 0.0;
        if link.manner.rigid {
            state[n + link.ends[1]] = 0.0;
        }
        self.to_relative(state);
    }

    /// Senses from the speeds of a state.
    pub fn set_senses(&mut self, t: f64, state: &[f64]) {
        self.derivative(t, state, &mut state.to_vec());
        for stage in 0..self.stages.senses.len() {
            let speed = self.omega[self.stage(stage).0.ends[0]];
            self.stages.senses[stage] = if speed > 0.0 {
                Sense::Forward
            } else if speed < 0.0 {
                Sense::Backward
            } else {
                Sense::Stuck
            };
        }
    }
}
