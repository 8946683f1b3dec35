//! Curves and extremes of a motion in time, and its balance of energy.

use super::start::Start;
use super::system::System;
use super::trajectory::Trajectory;
use crate::equation::Equation;
use crate::reading::{Extremes, LOWER, peak};
use linkwright_kernel::rk::rise;

/// Looks of a step for extremes.
const LOOKS: usize = 8;

/// How far inside a step its ends are read, as a share of it: torques jump there.
const INSIDE: f64 = 1e-9;

/// Curves over time, one list after another for every part.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    /// Angle of every mass \[rad\].
    pub angle: Vec<f64>,
    /// Of the masses \[rad/s\].
    pub speed: Vec<f64>,
    /// Of the masses \[rad/s²\].
    pub acceleration: Vec<f64>,
    /// Of the links \[rad\].
    pub twist: Vec<f64>,
    /// Of the links \[N m\].
    pub torque: Vec<f64>,
    /// Of the drivers, behind their gearboxes \[N m\].
    pub drive: Vec<f64>,
    /// Of the loads at the crank \[N m\].
    pub load: Vec<f64>,
    /// Kinetic energy, then what the links store \[J\].
    pub energy: [Vec<f64>; 2],
    /// Works: see [`super::system::Layout`].
    pub works: Vec<f64>,
}

/// Extremes of a motion with their times, and its balance.
#[derive(Clone, Debug)]
pub struct Measures {
    /// Of the masses \[rad/s\].
    pub speed: Vec<Extremes>,
    /// Of the masses \[rad/s²\].
    pub acceleration: Vec<Extremes>,
    /// Of the links \[rad\].
    pub twist: Vec<Extremes>,
    /// Of the links \[N m\].
    pub torque: Vec<Extremes>,
    /// Largest gain of energy, less works, over the largest of energies and works.
    pub energy_error: f64,
}

/// A motion with the machine that it is of.
pub struct Reading<'a> {
    system: System<'a>,
    trajectory: &'a Trajectory,
}

/// Something read of a state; by whether it asks for torques, they have been computed.
type Quantity<'q> = (bool, &'q dyn Fn(&System<'_>, &[f64]) -> f64);

impl<'a> Reading<'a> {
    /// Of a motion that was followed.
    pub fn new(equation: Equation<'a>, start: &Start, trajectory: &'a Trajectory) -> Self {
        let system = System::new(equation, start);
        Reading { system, trajectory }
    }

    fn steps(&self) -> usize {
        self.trajectory.t.len() - 1
    }

    /// State at a share of a step; torques of the step hold from now on.
    fn state(&mut self, k: usize, share: f64, to: &mut [f64]) {
        let (size, path) = (self.system.layout.size, self.trajectory);
        let (start, between) = (&path.states[k * size..][..size], &path.between[k * size..][..size]);
        for (to, (start, factors)) in to.iter_mut().zip(start.iter().zip(between)) {
            *to = start + rise(factors, share);
        }
    }

    /// Lets torques be those of a step.
    fn enter(&mut self, k: usize) {
        let (path, masses) = (self.trajectory, self.system.senses.len());
        self.system.senses.copy_from_slice(&path.senses[k * masses..][..masses]);
        let places = self.system.mounted.len();
        for (one, &between) in self.system.mounted.iter_mut().zip(&path.intervals[k * places..]) {
            one.between = between;
        }
        let links = self.system.zones.len();
        self.system.zones.copy_from_slice(&path.zones[k * links..][..links]);
    }

    fn time(&self, k: usize, share: f64) -> f64 {
        let t = &self.trajectory.t;
        t[k] + share * (t[k + 1] - t[k])
    }

    /// Curves at times of the motion.
    pub fn curves(&mut self, times: &[f64]) -> Curves {
        let chain = self.system.equation.chain;
        let layout = self.system.layout;
        let mut y = vec![0.0; layout.size];
        let mut found = Curves::default();
        let (mut masses, mut links, mut works) = (Vec::new(), Vec::new(), Vec::new());
        let mut drives = Vec::new();
        for &time in times {
            let t = &self.trajectory.t;
            if self.steps() == 0 {
                y.copy_from_slice(&self.trajectory.states[..layout.size]);
            } else {
                let k = t.partition_point(|&at| at <= time).clamp(1, self.steps()) - 1;
                let share = (time - t[k]) / (t[k + 1] - t[k]);
                self.enter(k);
                self.state(k, share.clamp(0.0, 1.0), &mut y);
            }
            let [kinetic, elastic] = self.system.energy(time, &y);
            found.energy[0].push(kinetic);
            found.energy[1].push(elastic);
            drives.push(self.system.drives.clone());
            found.load.push(self.system.load);
            let angle = |mass: usize| y[layout.phi] + if mass < layout.others { y[mass] } else { 0.0 };
            let of_mass = |m: usize| [angle(m), self.system.speed(m, &y), self.system.acceleration(m)];
            masses.extend((0..chain.masses()).map(of_mass));
            links.extend(
                chain.links.iter().map(|link| [chain.twist(link, &y)[0], chain.torque(link, &y).value]),
            );
            works.extend(y[layout.shaft..].iter().map(|&work| [work]));
        }
        [found.angle, found.speed, found.acceleration] =
            [0, 1, 2].map(|which| by_part(&masses, chain.masses(), which));
        [found.twist, found.torque] = [0, 1].map(|which| by_part(&links, chain.links.len(), which));
        found.drive = (0..chain.drivers.len()).flat_map(|k| drives.iter().map(move |row| row[k])).collect();
        found.works = by_part(&works, layout.size - layout.shaft, 0);
        found
    }

    /// Extremes of the motion, and its balance of energy.
    pub fn measures(&mut self) -> Measures {
        let chain = self.system.equation.chain;
        let (masses, links) = (0..chain.masses(), &chain.links);
        let speed = masses.clone().map(|m| self.extremes((false, &move |_, y| chain.speed(m, y)))).collect();
        let acceleration = masses.map(|m| self.extremes((true, &move |s, _| s.acceleration(m)))).collect();
        let twist = links.iter().map(|l| self.extremes((false, &move |_, y| chain.twist(l, y)[0]))).collect();
        let torque =
            links.iter().map(|l| self.extremes((false, &move |_, y| chain.torque(l, y).value))).collect();
        Measures { speed, acceleration, twist, torque, energy_error: self.energy_error() }
    }

    /// Largest gain of energy, less works, at the ends of the steps, over the largest of energies and works.
    fn energy_error(&mut self) -> f64 {
        let layout = self.system.layout;
        let (mut first, mut worst, mut largest) = (0.0, 0.0_f64, 0.0_f64);
        for k in 0..=self.steps() {
            if self.steps() > 0 {
                self.enter(k.min(self.steps() - 1));
            }
            let y = &self.trajectory.states[k * layout.size..][..layout.size];
            let energy: f64 = self.system.energy(self.trajectory.t[k], y).iter().sum();
            let heat: f64 = y[layout.heat..].iter().sum();
            if k == 0 {
                first = energy;
            }
            let gained = y[layout.drive] - y[layout.load] - y[layout.brake] - heat;
            worst = worst.max((energy - first - gained).abs());
            let sizes = [energy, y[layout.drive], y[layout.load], y[layout.brake], heat];
            largest = sizes.into_iter().fold(largest, |most, size| most.max(size.abs()));
        }
        if largest > 0.0 { worst / largest } else { 0.0 }
    }

    /// Value of a quantity at a share of a step.
    fn value(&mut self, k: usize, share: f64, y: &mut [f64], (asks, of): Quantity<'_>) -> f64 {
        if !asks {
            self.state(k, share, y);
        } else {
            let share = share.clamp(INSIDE, 1.0 - INSIDE);
            self.state(k, share, y);
            self.enter(k);
            self.system.act(self.time(k, share), y);
        }
        of(&self.system, y)
    }

    /// Extremes of a quantity over the motion.
    fn extremes(&mut self, quantity: Quantity<'_>) -> Extremes {
        let mut y = self.trajectory.states[..self.system.layout.size].to_vec();
        if self.steps() == 0 {
            self.system.act(self.trajectory.t[0], &y);
            let (value, at) = (quantity.1(&self.system, &y), self.trajectory.t[0]);
            return Extremes { min: value, min_at: at, max: value, max_at: at };
        }
        let looks = LOOKS + 1;
        let mut samples = Vec::with_capacity(self.steps() * looks);
        for k in 0..self.steps() {
            for look in 0..looks {
                samples.push(self.value(k, look as f64 / LOOKS as f64, &mut y, quantity));
            }
        }
        let [low, high] = samples
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &x| [low.min(x), high.max(x)]);
        let [min, max] = [-1.0, 1.0].map(|sign| {
            let top = if sign > 0.0 { high } else { -low };
            let least = top - LOWER * (high - low);
            let near = |i: usize| samples.get(i).map_or(f64::NEG_INFINITY, |x| sign * x);
            let mut best = (f64::NEG_INFINITY, 0.0);
            for i in 0..samples.len() {
                let before = if i == 0 { f64::NEG_INFINITY } else { near(i - 1) };
                if near(i) < least || near(i) < before || near(i) < near(i + 1) {
                    continue;
                }
                let (k, look) = (i / looks, i % looks);
                let bracket =
                    [look.saturating_sub(1), (look + 1).min(LOOKS)].map(|l| l as f64 / LOOKS as f64);
                let (share, value) =
                    peak(bracket, &mut |share| sign * self.value(k, share, &mut y, quantity));
                if value > best.0 {
                    best = (value, self.time(k, share));
                }
            }
            (sign * best.0, best.1)
        });
        Extremes { min: min.0, min_at: min.1, max: max.0, max_at: max.1 }
    }
}

fn by_part<const N: usize>(list: &[[f64; N]], parts: usize, which: usize) -> Vec<f64> {
    (0..parts).flat_map(|p| list.iter().skip(p).step_by(parts.max(1)).map(move |x| x[which])).collect()
}
