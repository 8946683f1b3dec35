//! What a method of integration can do, and how exact it has to be.

use super::between::{Between, Tolerances};
use super::rates::Rates;
use super::system::{Link, System};

/// Steps through a motion. In order for each step: [`Stepper::step`], [`Stepper::accept`], [`Stepper::fill`], and then
/// [`Stepper::component`], [`Stepper::slope`], [`Stepper::work`], [`Stepper::advance`]. Where the polynomial errs too much,
/// [`Stepper::shorten`], and the step is taken again.
pub trait Stepper {
    /// Restarts at an event, with a length to try first.
    fn begin(&mut self, rates: &mut Rates<'_>, t: f64, state: &[f64], first: f64);

    /// Takes a step of at most `longest` and writes where it leads; its length, or `None` if no step keeps the accuracy.
    fn step(
        &mut self,
        rates: &mut Rates<'_>,
        at: (f64, &Vec<f64>),
        longest: f64,
        scale: &Scale,
        end: &mut Vec<f64>,
    ) -> Option<f64>;

    /// Evaluates the equations at the end of the step.
    fn accept(&mut self, rates: &mut Rates<'_>, t_end: f64, end: &[f64]);

    /// Makes the polynomial between the ends of the step; its largest error over what it may be.
    fn fill(
        &mut self,
        rates: &mut Rates<'_>,
        at: (f64, &Vec<f64>),
        h: f64,
        scale: &Scale,
        end: &[f64],
    ) -> f64;

    /// Gives up a step that is good, to be taken again up to an event within it.
    fn retake(&mut self) {}

    /// Gives up a step of a length whose polynomial had an error.
    fn shorten(&mut self, h: f64, error: f64);

    /// One number of the state at a share 0…1 of the step.
    fn component(&self, share: f64, state: &[f64], i: usize) -> f64;

    /// All numbers of the state there.
    fn components(&self, share: f64, state: &[f64], to: &mut [f64]) {
        to.iter_mut().enumerate().for_each(|(i, to)| *to = self.component(share, state, i));
    }

    /// Rate of one number of the state at a share of the step \[1/s\].
    fn slope(&self, share: f64, h: f64, i: usize) -> f64;

    /// Adds the work of each power over the step.
    fn work(&mut self, rates: &mut Rates<'_>, at: (f64, &Vec<f64>), h: f64, to: &mut [f64]);

    /// Lets the end of the step be the start of the next.
    fn advance(&mut self);

    /// Steps that were tried in vain.
    fn rejected(&self) -> usize;
}

/// Twist below which nothing is asked for \[rad\]: the torque in a shaft of 1 MN m/rad is then known to 1 N m times the
/// accuracy.
const TWIST_FLOOR: f64 = 1e-6;

/// Torque below which nothing is asked for \[N m\]: what that twist makes in a shaft of 1 MN m/rad. It counts in shafts
/// stiffer than that, where steps follow their swings.
const TORQUE_FLOOR: f64 = 1.0;

/// A train without shafts has no swing that says how exact speeds shall be: then as if it had one this slow \[rad/s\].
const SLOWEST: f64 = 1.0;

/// Share of the largest twist, torque or speed so far below which the accuracy is no longer relative to the number itself.
const SMALL: f64 = 0.01;

/// Torque of a shaft to which its accuracy is relative, from its own size and the maximum of any \[N m\].
pub fn torque_counted(size: f64, greatest: f64) -> f64 {
    size.max(SMALL * greatest).max(TORQUE_FLOOR)
}

/// How large an error of each number of the state may be.
#[derive(Clone, Debug)]
pub struct Scale {
    twists: Between,
    /// Relative accuracy of a step as its method estimates it.
    pub accuracy: f64,
    /// Relative accuracy between the ends of a step.
    between: f64,
    n: usize,
    /// Place of the first speed in a state whose errors are measured.
    speeds: usize,
    relative: bool,
    /// Masses from which the others of their part are counted, where friction lets parts move apart; else none.
    leads: Vec<bool>,
    speed_floor: f64,
    /// Whether steps follow the swings of every shaft, so that its twist has to tell its torque.
    follows: bool,
    /// Largest twist, torque of a shaft, speed beside the first mass, and speed of the first mass so far.
    twist: f64,
    torque: f64,
    aside: f64,
    speed: f64,
}

impl Scale {
    /// For masses whose fastest swing is about `omega`, with the accuracies of a step's estimate and between its ends.
    pub fn new([accuracy, between]: [f64; 2], rates: &Rates<'_>, omega: f64) -> Self {
        let (n, relative) = (rates.system.len(), rates.is_relative());
        Scale {
            twists: Between::new(rates.system),
            accuracy,
            between,
            n,
            speeds: n,
            relative,
            leads: leads(rates.system),
            speed_floor: TWIST_FLOOR * omega.max(SLOWEST),
            follows: false,
            twist: 0.0,
            torque: 0.0,
            aside: 0.0,
            speed: 0.0,
        }
    }

    /// The same for explicit steps, which follow the swings of every shaft, however stiff; their states have places for whole
    /// registers.
    pub fn following(self, rates: &Rates<'_>) -> Self {
        Scale { follows: true, speeds: rates.room().len() / 2, ..self }
    }

    /// Error that one number of the state, of a size, may have.
    #[inline(always)]
    pub fn of(&self, index: usize, size: f64) -> f64 {
        self.accuracy * self.counted(index, size)
    }

    /// Largest error between the ends of a step over what it may be, of the numbers of the state and of the twist of each link:
    /// [`Between::worst`].
    pub fn worst(&self, system: &System, error: &[f64], states: [&[f64]; 2]) -> f64 {
        let may = Tolerances {
            accuracy: self.between,
            angle: (SMALL * self.twist).max(TWIST_FLOOR),
            speed: (SMALL * self.aside).max(self.speed_floor),
            lead_speed: (SMALL * self.speed).max(self.speed_floor),
            torque: if self.follows { torque_counted(0.0, self.torque) } else { f64::INFINITY },
        };
        self.twists.worst(system, &may, error, states)
    }

    /// Size to which the accuracy of one number is relative.
    #[inline(always)]
    fn counted(&self, index: usize, size: f64) -> f64 {
        let leads = if self.leads.is_empty() {
            self.relative && (index == 0 || index == self.speeds)
        } else {
            self.leads.get(if index < self.speeds { index } else { index - self.speeds }) == Some(&true)
        };
        match (leads, index < self.speeds) {
            (true, true) => 1.0,
            // Parts that slide apart turn far from each other; their shafts twist as little as before.
            (false, true) if !self.leads.is_empty() => {
                size.min(self.twist).max(SMALL * self.twist).max(TWIST_FLOOR)
            }
            (false, true) => size.max(SMALL * self.twist).max(TWIST_FLOOR),
            (true, false) => size.max(SMALL * self.speed).max(self.speed_floor),
            (false, false) => size.max(SMALL * self.aside).max(self.speed_floor),
        }
    }

    /// Takes note of a state that was reached.
    pub fn widen(&mut self, system: &System, state: &[f64]) {
        let torque = |link: &Link| link.stiffness * link.twist(self.n, self.relative, |i| state[i]).abs();
        self.torque = system.links.iter().map(torque).fold(self.torque, f64::max);
        let first = usize::from(self.relative);
        let largest = |list: &[f64], so_far: f64| list.iter().fold(so_far, |most, x| most.max(x.abs()));
        self.twist = if self.leads.is_empty() {
            largest(&state[first..self.n], self.twist)
        } else {
            let twist = |link: &Link| link.twist(self.n, self.relative, |i| state[i]).abs();
            system.links.iter().map(twist).fold(self.twist, f64::max)
        };
        self.aside = largest(&state[self.n + first..], self.aside);
        self.speed = self.speed.max(state[self.n].abs());
    }

    /// Size of an error against what it may be, over all numbers of the state.
    pub fn norm(&self, error: &[f64], state: &[f64]) -> f64 {
        let square = |(i, (e, y)): (usize, (&f64, &f64))| (e / self.of(i, y.abs())).powi(2);
        let sum: f64 = error.iter().zip(state).enumerate().map(square).sum();
        (sum / error.len() as f64).sqrt()
    }
}

/// Whether each mass is the first of its part, in a train with friction.
fn leads(system: &System) -> Vec<bool> {
    if system.frictions.is_empty() {
        return Vec::new();
    }
    (0..system.len()).map(|i| system.parts()[i] == i).collect()
}
