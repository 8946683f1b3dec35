//! Dry friction between two masses, or a mass and the ground: clutch, brake, freewheel, drill bit.
//!
//! ```text
//! s = n (ω_a − ω_b)        T = w(t) S₊(s)  for s > 0        −w R₋ ≤ T ≤ w R₊  for s = 0        T = −w S₋(−s)  for s < 0
//! ```
//!
//! w is the engagement, S the sliding torque over the slip and R the static capacity, for each sense. A freewheel has no
//! bound in the sense in which it locks, and only its drag in the other.
//!
//! Source: Otter, Elmqvist and Mattsson, *Hybrid modeling in Modelica based on the synchronous data flow principle*,
//! CACSD 1999; the falling law is that of Armstrong-Hélouvry, Dupont and Canudas de Wit, Automatica 30 (1994), with the
//! exponent 1.

use super::curve::Curve;
use super::torque::Stretch;

/// Friction in one sense of slip, at full engagement.
#[derive(Clone, Copy, Debug)]
pub struct Grip {
    /// Static capacity \[N m\].
    pub held: f64,
    /// Sliding torque far from rest, and what it has more at rest \[N m\].
    pub sliding: f64,
    pub rise: f64,
    /// One over the slip at which the latter has fallen to 1/e \[s/rad\].
    pub inverse_speed: f64,
    /// Sliding torque over slip, instead.
    pub curve: Option<usize>,
}

impl Grip {
    /// Sliding torque at a slip of the piece of the curve, and its slope.
    pub fn at(&self, curves: &[Curve], piece: usize, slip: f64) -> (f64, f64) {
        match self.curve {
            Some(curve) => curves[curve].of_piece(piece, slip),
            None if self.rise == 0.0 => (self.sliding, 0.0),
            None => {
                let more = self.rise * (-slip * self.inverse_speed).exp();
                (self.sliding + more, -more * self.inverse_speed)
            }
        }
    }

    /// Steepest slope \[N m s/rad\].
    fn steepest(&self, curves: &[Curve]) -> f64 {
        self.curve.map_or((self.rise * self.inverse_speed).abs(), |curve| curves[curve].steepest())
    }
}

/// An element with dry friction.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    /// Masses, the number of masses for the ground.
    pub ends: [usize; 2],
    /// Speed of the part over that of the masses.
    pub ratio: f64,
    /// Where the first end is faster, and where it is slower; `None` where it cannot slide.
    pub forward: Option<Grip>,
    pub backward: Option<Grip>,
    /// Engagement over time; without it 1.
    pub engagement: Option<usize>,
}

impl Friction {
    /// Friction in a sense of slip.
    pub fn grip(&self, forward: bool) -> Option<&Grip> {
        if forward { self.forward.as_ref() } else { self.backward.as_ref() }
    }

    /// Engagement at a time: zero where its curve is below.
    pub fn engaged(&self, curves: &[Curve], stretch: &Stretch, t: f64) -> f64 {
        self.engagement.map_or(1.0, |curve| stretch.at(curves, curve, t).max(0.0))
    }

    /// Bounds of the torque while nothing slides, at an engagement.
    pub fn bounds(&self, engaged: f64) -> [f64; 2] {
        let held = |grip: &Option<Grip>| grip.as_ref().map_or(f64::INFINITY, |grip| grip.held * engaged);
        [-held(&self.backward), held(&self.forward)]
    }

    /// Slip from the speeds of the masses, those of the ground being zero.
    pub fn slip(&self, speed: impl Fn(usize) -> f64) -> f64 {
        self.ratio * (speed(self.ends[0]) - speed(self.ends[1]))
    }

    /// Whether one end is the ground, of so many masses.
    pub fn is_brake(&self, masses: usize) -> bool {
        self.ends.contains(&masses)
    }

    /// Steepest slope of the torque over the slip.
    pub fn steepest(&self, curves: &[Curve]) -> f64 {
        [&self.forward, &self.backward]
            .into_iter()
            .flatten()
            .map(|grip| grip.steepest(curves))
            .fold(0.0, f64::max)
    }
}

/// What an element does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// Nothing: it is not engaged.
    Open,
    /// It holds its ends together.
    Stuck,
    /// It slides, the first end faster or slower, on a piece of the curve of its sliding torque.
    Slip { forward: bool, piece: usize },
}

impl State {
    /// Its number in samples: 0 open, 1 stuck, 2 sliding forward, 3 backward.
    pub fn code(self) -> f64 {
        match self {
            State::Open => 0.0,
            State::Stuck => 1.0,
            State::Slip { forward: true, .. } => 2.0,
            State::Slip { forward: false, .. } => 3.0,
        }
    }
}
