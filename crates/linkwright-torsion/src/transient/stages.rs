//! Gear stages that are rigid or lose power: their senses and the torques that they carry at an instant.

use super::system::{Link, Loss};

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

/// A change that the sense of a stage has to make.
#[derive(Clone, Copy, Debug)]
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

    /// Place of a link among them.
    pub(super) fn place(&self, link: usize) -> Option<usize> {
        self.links.iter().position(|&place| place == link)
    }
}
