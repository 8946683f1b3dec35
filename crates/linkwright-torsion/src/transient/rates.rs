//! The equations of motion:
//!
//! ```text
//! J(θ) θ̈ = Σ M − c θ̇ − d (θ̇ − ω) − ½ J′(θ) θ̇² − Σ ± n (kΔ + cΔ̇ + f(Δ))        Δ = n(θ_a − θ_b)
//! ```
//!
//! with the speed of the train as a whole, ω = Σ J θ̇ / Σ J of the mean inertias.
//!
//! The state holds the angle of the first mass and those of the others less that one, so that the twist of a shaft keeps
//! its digits however far the train has turned; likewise for the speeds. A train that is held has nothing to turn far, and
//! its state holds the angles themselves.
//!
//! Masses stand side by side in lanes. Lists have places for whole registers; behind the last mass they hold such as nothing moves,
//! whose inertia has no bound.
//!
//! What joins masses beyond twists takes the accelerations further from those that all others leave:
//!
//! 1. a disc feels its pendulums as an effective inertia, J + a u − b² u²/J_p, and by a part of their torques;
//! 2. masses that stuck elements hold together have the mean acceleration, weighted by these inertias;
//! 3. rigid and stuck stages are one linear system, whose unit torques move whole groups of masses;
//! 4. pendulums follow their discs.
//!
//! Step 2 is a projection along the inertias, so that 3 leaves the groups together, and the torque of a stuck element follows
//! from the balance of each mass with the torques of the teeth.
//!
//! Source: the equation is Lagrange's for T = ½ J(θ) θ̇²; e.g. Eksergian, *Dynamical analysis of machines*,
//! J. Franklin Inst. 209 (1930).

use super::bank::{Bank, OfAngle, WIDEST};
use super::bond::{Bond, BondTorque};
use super::chains::{Links, Twists};
use super::contacts::{Contacts, slide};
use super::friction::Friction;
use super::pendulums::{Bobs, Pendulum, Swing, add_slopes};
use super::stages::Stages;
use super::system::{Carrier, Link, Rotor, System};
use super::torque::{Law, Pull, Shape, Stretch, Torque};
use linkwright_kernel::lanes::{Job, in_single_lanes};
use linkwright_kernel::real::Real;

/// A system at one instant, with room for what the equations need.
#[derive(Clone, Debug)]
pub struct Rates<'a> {
    pub system: &'a System,
    pub(super) stretch: Stretch,
    /// Elements with dry friction, and how far each is engaged at the instant last evaluated.
    pub contacts: Contacts,
    pub(super) engaged: Vec<f64>,
    links: Links,
    pub(super) stages: Stages,
    pub(super) bobs: Bobs,
    /// Whether angles of the state are counted from that of the first mass.
    pub(super) relative: bool,
    /// Zero for the mass from which the others are counted and behind the last, else one.
    beside: Vec<f64>,
    /// Zero for masses that rest while the train runs, else one.
    pub(super) turns: Vec<f64>,
    pub(super) theta: Vec<f64>,
    pub omega: Vec<f64>,
    /// Angles and speeds for twists: a place before the first mass, the masses, the ground.
    pub(super) aside: Vec<f64>,
    pub(super) aside_speed: Vec<f64>,
    /// Shares of the masses in the inertia of the whole, or of their parts; the first mass of each part; speed of the whole.
    shares: Vec<f64>,
    parts: Vec<usize>,
    whole: Vec<f64>,
    /// What the masses have of inertia and damping anyway.
    constant: Vec<f64>,
    damping: Vec<f64>,
    swing_damping: Vec<f64>,
    pub(super) inertia: Vec<f64>,
    /// The same with what pendulums add to it, where there are any.
    pub(super) effective: Vec<f64>,
    /// Whether anything damps swings.
    damps_swings: bool,
    /// J′ of each mass.
    bends: Vec<f64>,
    /// Inertias and torques that are functions of the angle alone; places of all other torques in their list.
    inertias: Vec<Bank>,
    shapes: Vec<Bank>,
    alone: Vec<usize>,
    pub acceleration: Vec<f64>,
    /// Torques from outside and of links that are no chain, on each mass and on the ground.
    pub(super) outer: Vec<f64>,
    /// Losses at masses and in the links behind them, powers of each bank of torques, powers of other torques, of controllers,
    /// losses in other links, losses by friction \[W\]: [`Rates::in_order`].
    pub powers: Vec<f64>,
    /// A state and its derivative, with places for whole registers.
    room: [Vec<f64>; 2],
    /// How often the equations were evaluated.
    pub evaluations: usize,
}

impl<'a> Rates<'a> {
    /// For a system.
    pub fn new(system: &'a System) -> Self {
        let (n, relative) = (system.len(), system.is_free());
        let places = n.next_multiple_of(WIDEST);
        let links = Links::of(system, places);
        let filled = |list: &[f64], rest: f64| {
            let mut filled = vec![rest; places];
            filled[..n].copy_from_slice(list);
            filled
        };
        let mut beside = filled(&vec![1.0; n], 0.0);
        if relative {
            beside[0] = 0.0;
        }
        let turns = filled(&(0..n).map(|i| system.turns_of(i)).collect::<Vec<_>>(), 1.0);
        let (banked, alone): (Vec<usize>, Vec<usize>) =
            (0..system.torques.len()).partition(|&k| system.torques[k].of_angle().is_some());
        let torques = banked.into_iter().filter_map(|k| Some((k, system.torques[k].of_angle()?)));
        let shapes = Bank::several(torques, places, &system.tables);
        let rotors = system.rotors.iter().map(Rotor::of_angle).enumerate();
        let none = vec![0.0; places];
        Rates {
            system,
            stretch: Stretch::default(),
            contacts: Contacts::new(&system.frictions, n),
            engaged: vec![0.0; system.frictions.len()],
            relative,
            beside,
            turns,
            theta: none.clone(),
            omega: none.clone(),
            aside: vec![0.0; places + 2],
            aside_speed: vec![0.0; places + 2],
            shares: system.shares(),
            parts: system.parts(),
            whole: none.clone(),
            constant: filled(&system.inertia, f64::INFINITY),
            damping: filled(&system.damping, 0.0),
            swing_damping: filled(&system.swing_damping, 0.0),
            inertia: filled(&system.inertia, f64::INFINITY),
            effective: filled(&system.inertia, f64::INFINITY),
            damps_swings: system.swing_damping.iter().any(|&d| d != 0.0),
            bends: none.clone(),
            inertias: Bank::several(rotors, places, &system.tables),
            acceleration: none.clone(),
            outer: vec![0.0; places + 1],
            powers: vec![
                0.0;
                places * (2 + shapes.len())
                    + alone.len()
                    + system.controllers.len()
                    + links.others.len()
                    + system.frictions.len()
            ],
            shapes,
            alone,
            stages: Stages::of(&system.links, &links.others),
            bobs: Bobs::new(system.pendulums.len()),
            links,
            room: [vec![0.0; 2 * places], vec![0.0; 2 * places]],
            evaluations: 0,
        }
    }

    /// A state with places for whole registers, as [`Rates::derivative_in_place`] takes it: zeros.
    pub fn room(&self) -> Vec<f64> {
        vec![0.0; 2 * self.theta.len()]
    }

    /// Copies the first numbers of both halves, angles and speeds, of a state into another.
    pub fn copy(&self, from: &[f64], to: &mut [f64]) {
        let halves = to.len() / 2;
        let (angles, speeds) = to.split_at_mut(halves);
        let n = self.system.len();
        angles[..n].copy_from_slice(&from[..n]);
        speeds[..n].copy_from_slice(&from[from.len() / 2..][..n]);
    }

    /// Inertia of a mass at the instant last evaluated, without bound for the ground \[kg m²\].
    pub fn inertia_of(&self, mass: usize) -> f64 {
        self.inertia.get(mass).copied().unwrap_or(f64::INFINITY)
    }

    /// Whether angles of the state are counted from that of the first mass.
    pub fn is_relative(&self) -> bool {
        self.relative
    }

    /// Curves over time between two marks.
    pub(super) fn stretch(&self) -> &Stretch {
        &self.stretch
    }

    /// Chooses the stretch of time between two marks.
    pub fn enter(&mut self, middle: f64) {
        self.stretch.about(&self.system.curves, middle);
    }

    /// A state from the angles and speeds of the masses.
    pub fn state(&self, angle: &[f64], speed: &[f64]) -> Vec<f64> {
        let mut state = [angle, speed].concat();
        self.to_relative(&mut state);
        state
    }

    /// Counts the other masses from the first, in angles and speeds.
    pub fn to_relative(&self, state: &mut [f64]) {
        if self.relative {
            for half in state.chunks_exact_mut(self.system.len()) {
                let first = half[0];
                half[1..].iter_mut().zip(&self.turns[1..]).for_each(|(x, turns)| *x -= turns * first);
            }
        }
    }

    /// Counts all masses from the ground.
    pub fn to_absolute(&self, state: &mut [f64]) {
        if self.relative {
            for half in state.chunks_exact_mut(self.system.len()) {
                let first = half[0];
                half[1..].iter_mut().zip(&self.turns[1..]).for_each(|(x, turns)| *x += turns * first);
            }
        }
    }

    /// The derivative of a state.
    pub fn derivative(&mut self, t: f64, state: &[f64], to: &mut [f64]) {
        let [mut from, mut into] = std::mem::take(&mut self.room);
        self.copy(state, &mut from);
        self.derivative_in_place(t, &from, &mut into);
        self.copy(&into, to);
        self.room = [from, into];
    }

    /// The derivative of a state that has places for whole registers.
    pub fn derivative_in_place(&mut self, t: f64, state: &[f64], to: &mut [f64]) {
        in_single_lanes(Derivative { rates: self, t, state, to });
    }

    /// What [`Rates::derivative`] does, in a function for the processor's own instructions.
    #[inline(always)]
    fn derive<R: Real>(&mut self, t: f64, state: &[f64], to: &mut [f64]) {
        self.evaluations += 1;
        let places = self.theta.len();
        let (state, to) = (&state[..2 * places], &mut to[..2 * places]);
        let (angles, speeds) = state.split_at(places);
        let lead = if self.relative { [angles[0], speeds[0]] } else { [0.0; 2] };
        for at in (0..places).step_by(R::LANES) {
            self.place::<R>(at, [angles, speeds], lead);
        }
        self.push(t);
        self.twist();
        self.rub(t);
        if self.bobs.any() {
            let swing = Swing { aside: &self.aside[1..], omega: &self.omega };
            self.bobs.push(&self.system.pendulums, swing, &mut self.outer);
        }
        self.whole_speed();
        for at in (0..places).step_by(R::LANES) {
            self.accelerate::<R>(at);
        }
        self.constrain();
        let lead = if self.relative { self.acceleration[0] } else { 0.0 };
        let (angle_rates, speed_rates) = to.split_at_mut(places);
        for at in (0..places).step_by(R::LANES) {
            R::load(&speeds[at..]).store(&mut angle_rates[at..]);
            let lead = R::load(&self.beside[at..]) * R::load(&self.turns[at..]) * lead;
            (R::load(&self.acceleration[at..]) - lead).store(&mut speed_rates[at..]);
        }
    }

    /// Accelerations of some masses.
    #[inline(always)]
    fn accelerate<R: Real>(&mut self, at: usize) {
        let places = self.theta.len();
        let (theta, omega) = (R::load(&self.theta[at..]), R::load(&self.omega[at..]));
        let (mut inertia, mut bend) = (R::load(&self.constant[at..]), R::splat(0.0));
        for bank in &self.inertias {
            if let Some([value, slope]) = bank.at(at, theta) {
                (inertia, bend) = (inertia + value, bend + slope);
            }
        }
        inertia.store(&mut self.inertia[at..]);
        bend.store(&mut self.bends[at..]);
        let (drags, powers) = self.powers.split_at_mut(places);
        let (losses, powers) = powers.split_at_mut(places);
        let mut shaped = R::splat(0.0);
        for (bank, powers) in self.shapes.iter().zip(powers.chunks_exact_mut(places)) {
            if let Some([torque, _]) = bank.at(at, theta) {
                (torque * omega).store(&mut powers[at..]);
                shaped = shaped + torque;
            }
        }
        let Twists { torque, loss } = self.links.chain.twists::<R>(at, &self.aside, &self.aside_speed);
        let swing = (R::load(&self.aside_speed[at + 1..])
            - R::load(&self.turns[at..]) * R::load(&self.whole[at..]))
            * R::load(&self.swing_damping[at..]);
        let drag = R::load(&self.damping[at..]) * omega + swing;
        let gyration = bend * 0.5 * omega * omega;
        let net = ((torque - drag) + R::load(&self.outer[at..])) + (shaped - gyration);
        (net / inertia).store(&mut self.acceleration[at..]);
        (drag * omega).store(&mut drags[at..]);
        loss.store(&mut losses[at..]);
    }

    /// Angles and speeds of some masses.
    #[inline(always)]
    fn place<R: Real>(&mut self, at: usize, [angles, speeds]: [&[f64]; 2], lead: [f64; 2]) {
        let beside = R::load(&self.beside[at..]);
        let (angle, speed) = (R::load(&angles[at..]) * beside, R::load(&speeds[at..]) * beside);
        angle.store(&mut self.aside[at + 1..]);
        speed.store(&mut self.aside_speed[at + 1..]);
        let turns = R::load(&self.turns[at..]);
        (angle + turns * lead[0]).store(&mut self.theta[at..]);
        (speed + turns * lead[1]).store(&mut self.omega[at..]);
        R::splat(0.0).store(&mut self.outer[at..]);
    }

    /// Speed of the train as a whole, or of each of its parts, beside its first mass; zero where nothing asks for it.
    fn whole_speed(&mut self) {
        if !self.damps_swings {
            return;
        }
        let n = self.system.len();
        for part in 0..n {
            if self.parts[part] != part {
                continue;
            }
            let moved = self.shares.iter().zip(&self.aside_speed[1..]).zip(&self.parts);
            let whole = moved.filter(|(_, of)| **of == part).map(|((share, w), _)| share * w).sum();
            let of_part = self.whole.iter_mut().zip(&self.parts).filter(|(_, of)| **of == part);
            of_part.for_each(|(speed, _)| *speed = whole);
        }
    }

    /// Accelerations with all constraints, from those that torque over own inertia gives; losses of rigid stages.
    pub(super) fn constrain(&mut self) {
        let (system, first) = (self.system, self.losses_of_others());
        let pendulums = &system.pendulums;
        if self.bobs.any() {
            self.effective.copy_from_slice(&self.inertia);
            self.bobs.add_to(pendulums, &self.inertia, &mut self.effective);
            self.bobs.load(pendulums, &self.inertia, &self.effective, &mut self.acceleration);
        }
        let inertia = if self.bobs.any() { &self.effective } else { &self.inertia };
        if self.contacts.any() {
            self.contacts.note(&self.acceleration, inertia);
            self.contacts.join(&mut self.acceleration, inertia);
        }
        if self.stages.any() {
            let held = &mut self.acceleration[..system.len()];
            if !self.stages.engage(&system.links, inertia, &mut self.contacts, held) {
                self.acceleration[0] = f64::NAN;
            }
            self.stages.lose(&system.links, &self.omega, &mut self.powers[first..]);
        }
        if self.bobs.any() {
            self.bobs.follow(pendulums, &self.inertia, &mut self.acceleration);
        }
    }

    /// The same for changes of the accelerations, column by column of a matrix.
    pub(super) fn constrain_columns(&self, matrix: &mut [f64]) {
        if !(self.bobs.any() || self.stages.any() || self.contacts.holds()) {
            return;
        }
        let (system, n) = (self.system, self.system.len());
        let mut column = vec![0.0; n];
        for j in 0..n {
            (0..n).for_each(|i| column[i] = matrix[i * n + j]);
            self.bobs.load(&system.pendulums, &self.inertia, &self.effective, &mut column);
            self.join(&mut column);
            self.bobs.follow(&system.pendulums, &self.inertia, &mut column);
            (0..n).for_each(|i| matrix[i * n + j] = column[i]);
        }
    }

    /// Lets a list obey the constraints of groups and stages, at the senses and directions of power last found.
    pub(super) fn join(&self, list: &mut [f64]) {
        let inertia = if self.bobs.any() { &self.effective } else { &self.inertia };
        self.contacts.join(list, inertia);
        self.stages.engage_changes(&self.system.links, inertia, &self.contacts, list);
    }

    /// Inertia torque of a mass at accelerations by the pendulums on it, or by its disc.
    pub fn torque_of_bobs(&self, mass: usize, acceleration: impl Fn(usize) -> f64) -> f64 {
        self.bobs.torque_of(&self.system.pendulums, mass, acceleration)
    }

    /// Sets the senses of stages that lose power from the speeds of a state.
    pub fn set_senses(&mut self, t: f64, state: &[f64]) {
        self.derivative(t, state, &mut state.to_vec());
        self.stages.set_senses(&self.system.links, &self.omega);
    }

    /// Torques of elements that slide.
    #[inline(always)]
    pub(super) fn rub(&mut self, t: f64) {
        let system = self.system;
        let first = self.powers.len() - system.frictions.len();
        for (e, friction) in system.frictions.iter().enumerate() {
            let engaged = friction.engaged(&system.curves, &self.stretch, t);
            let slip = self.slip(friction);
            let sliding = slide(friction, self.contacts.states[e], &system.curves, engaged, slip);
            let torque = sliding.map_or(0.0, |(torque, _)| torque);
            let [a, b] = friction.ends;
            self.outer[a] -= friction.ratio * torque;
            self.outer[b] += friction.ratio * torque;
            self.powers[first + e] = torque * slip;
            self.contacts.torques[e] = torque;
            self.engaged[e] = engaged;
        }
    }

    /// Adds to the derivatives of the torques on the masses by their speeds.
    pub(super) fn rub_slopes(&self, by_speed: &mut [f64]) {
        let (system, n) = (self.system, self.system.len());
        for (e, friction) in system.frictions.iter().enumerate() {
            let slip = self.slip(friction);
            let sliding = slide(friction, self.contacts.states[e], &system.curves, self.engaged[e], slip);
            let slope = friction.ratio * friction.ratio * sliding.map_or(0.0, |(_, slope)| slope);
            let [a, b] = friction.ends;
            for (i, j) in [(a, b), (b, a)].into_iter().filter(|&(i, _)| i < n) {
                by_speed[i * n + i] -= slope;
                if j < n {
                    by_speed[i * n + j] += slope;
                }
            }
        }
    }

    /// Whether both ends turn alike with the train, so that the slip follows from speeds beside that of the first mass.
    pub(super) fn turns_alike(&self, friction: &Friction) -> bool {
        let [a, b] = friction.ends.map(|end| self.system.turns_of(end));
        a == b
    }

    /// Slip of an element at the instant last evaluated.
    pub fn slip(&self, friction: &Friction) -> f64 {
        let n = self.system.len();
        if self.turns_alike(friction) {
            friction.slip(|i| self.aside_speed[i + 1])
        } else {
            friction.slip(|i| if i == n { 0.0 } else { self.omega[i] })
        }
    }

    /// Torques from outside that are more than functions of the angle.
    #[inline(always)]
    fn push(&mut self, t: f64) {
        let system = self.system;
        let about = (&system.tables[..], &system.curves[..], &self.stretch);
        let powers = &mut self.powers[self.theta.len() * (2 + self.shapes.len())..];
        for (&place, power) in self.alone.iter().zip(powers) {
            let torque = &system.torques[place];
            let i = torque.mass;
            let pull = torque.at(about, (t, self.theta[i], self.omega[i]));
            self.outer[i] += pull.torque;
            *power = pull.torque * self.omega[i];
        }
        let first = self.losses_of_others() - system.controllers.len();
        for (controller, power) in system.controllers.iter().zip(&mut self.powers[first..]) {
            let (i, j) = (controller.mass, controller.integral);
            let command = controller.at(&system.curves, &self.stretch, t, [self.omega[i], self.omega[j]]);
            self.outer[i] += command.torque;
            self.outer[j] += command.rate;
            *power = command.torque * self.omega[i];
        }
    }

    /// Place of the first loss in a link that is no chain.
    pub(super) fn losses_of_others(&self) -> usize {
        self.theta.len() * (2 + self.shapes.len()) + self.alone.len() + self.system.controllers.len()
    }

    /// A link at the instant last evaluated.
    pub(super) fn bond(&self, link: &Link) -> Bond {
        link.bond(
            self.system.len(),
            |i| self.aside[i + 1],
            |i| self.aside_speed[i + 1],
            |i| [self.theta[i], self.omega[i]],
        )
    }

    /// Torques of the links that are no chain.
    #[inline(always)]
    fn twist(&mut self) {
        let system = self.system;
        let first = self.losses_of_others();
        for nth in 0..self.links.others.len() {
            let place = self.links.others[nth];
            let link = &system.links[place];
            if link.manner.rigid {
                continue;
            }
            let bond = self.bond(link);
            let BondTorque { torque, friction, .. } = link.pulls(system, bond.twist, bond.rate);
            let mut loss = friction * bond.rate;
            let mut at_end = torque;
            if link.manner.loss.is_some() {
                at_end *= self.stages.factor(&system.links, place, torque);
                loss += (at_end - torque) * link.ratio * self.omega[link.ends[0]];
            }
            self.powers[first + nth] = loss;
            let [a, b, c] = bond.gradient;
            for (mass, torque) in bond.masses.into_iter().zip([a * at_end, b * torque, c * torque]) {
                self.outer[mass] -= torque;
            }
        }
    }

    /// Powers, or their works: of each torque, of each controller, then in each link, then at each mass, then by friction.
    pub fn in_order(&self, powers: &[f64]) -> Vec<f64> {
        let (n, places) = (self.system.len(), self.theta.len());
        let (drags, powers) = powers.split_at(places);
        let (behind, powers) = powers.split_at(places);
        let (banks, powers) = powers.split_at(places * self.shapes.len());
        let (alone, powers) = powers.split_at(self.alone.len());
        let (controllers, powers) = powers.split_at(self.system.controllers.len());
        let (others, rubbing) = powers.split_at(self.links.others.len());
        let mut torques = vec![0.0; self.system.torques.len()];
        self.alone.iter().zip(alone).for_each(|(&place, &power)| torques[place] = power);
        for (bank, powers) in self.shapes.iter().zip(banks.chunks_exact(places)) {
            for (place, &power) in bank.places.iter().zip(powers) {
                place.iter().for_each(|&place| torques[place] = power);
            }
        }
        let links = self.links.losses(behind, others);
        [torques, controllers.to_vec(), links, drags[..n].to_vec(), rubbing.to_vec()].concat()
    }

    /// Torque in a link at its own speed, and how fast it changes, at the instant last evaluated.
    pub fn link_torque(&self, place: usize) -> (f64, f64) {
        let link = &self.system.links[place];
        if link.manner.rigid {
            return (self.stages.torque(place), f64::NAN);
        }
        let bond = self.bond(link);
        let pulls = link.pulls(self.system, bond.twist, bond.rate);
        let at = |i: usize| self.acceleration.get(i).copied().unwrap_or(0.0);
        let bend = bond.twist_acceleration(at, self.omega[bond.masses[0].min(self.omega.len() - 1)]);
        (pulls.torque, pulls.by_twist * bond.rate + pulls.by_rate * bend)
    }

    /// Torque in a link from components of a state; of a rigid one that of the instant last evaluated.
    pub fn link_torque_at(&self, place: usize, state: impl Fn(usize) -> f64) -> f64 {
        let (n, link) = (self.system.len(), &self.system.links[place]);
        if link.manner.rigid {
            return self.stages.torque(place);
        }
        let first = if self.relative { [state(0), state(n)] } else { [0.0; 2] };
        let aside = |i: usize, value: f64| if i == 0 && self.relative { 0.0 } else { value };
        let bond = link.bond(
            n,
            |i| aside(i, state(i)),
            |i| aside(i, state(n + i)),
            |i| {
                let [angle, speed] = first.map(|lead| self.turns[i] * lead);
                [angle + aside(i, state(i)), speed + aside(i, state(n + i))]
            },
        );
        link.pulls(self.system, bond.twist, bond.rate).torque
    }

    /// Kinetic and potential energy of a state \[J\].
    pub fn energies(&self, state: &[f64]) -> [f64; 2] {
        let system = self.system;
        let mut masses = state.to_vec();
        self.to_absolute(&mut masses);
        let (theta, omega) = masses.split_at(system.len());
        let mut turning: f64 = system.inertia.iter().zip(omega).map(|(j, w)| j * w * w).sum();
        // What controllers add up has no energy.
        turning -= system
            .controllers
            .iter()
            .map(|one| system.inertia[one.integral] * omega[one.integral].powi(2))
            .sum::<f64>();
        let rotor = |rotor: &Rotor| {
            let part = rotor.ratio * omega[rotor.mass];
            let angle = rotor.ratio * theta[rotor.mass] + rotor.phase;
            system.tables[rotor.table].value_and_slope(angle)[0] * part * part
        };
        let swing = |pendulum: &Pendulum| {
            let Pendulum { disc, bob, .. } = *pendulum;
            let aside = |i: usize| if i == 0 && self.relative { 0.0 } else { state[i] };
            pendulum.energy(aside(bob) - aside(disc), [omega[disc], omega[bob]])
        };
        let kinetic = 0.5 * (turning + system.rotors.iter().map(rotor).sum::<f64>())
            + system.pendulums.iter().map(swing).sum::<f64>();
        let stored = |link: &Link| {
            if link.manner.rigid {
                return 0.0;
            }
            let aside = |i: usize| if i == 0 && self.relative { 0.0 } else { state[i] };
            let twist = link.bond(system.len(), aside, |_| 0.0, |i| [theta[i], 0.0]).twist;
            let curved = link.curve.map_or(0.0, |curve| system.curves[curve].integral(twist));
            0.5 * link.stiffness * twist * twist + curved
        };
        [kinetic, system.links.iter().map(stored).sum()]
    }

    /// Sum of all torques on each mass, less ½ J′ θ̇², and its inertia, at angles and speeds of the masses.
    pub fn net_torques(
        &mut self,
        t: f64,
        angle: &[f64],
        speed: &[f64],
        net: &mut [f64],
        inertia: &mut [f64],
    ) {
        let state = self.state(angle, speed);
        if self.stages.any() {
            self.set_senses(t, &state);
        }
        self.derivative(t, &state, &mut state.clone());
        inertia.copy_from_slice(&self.inertia[..inertia.len()]);
        for ((net, a), j) in net.iter_mut().zip(&self.acceleration).zip(&self.inertia) {
            *net = a * j;
        }
    }

    /// Bound of the fastest swing or decay at the instant last evaluated \[rad/s\]: from the sums about each mass (Gershgorin).
    pub fn fastest(&self) -> f64 {
        let system = self.system;
        let n = system.len();
        let (mut stiffness, mut damping) = (vec![0.0; n + 1], vec![0.0; n + 1]);
        for i in 0..n {
            damping[i] = system.damping[i] + system.swing_damping[i];
        }
        for link in &system.links {
            // A coupling with backlash has no stiffness yet; its steepest counts.
            let curved = link.curve.map_or(0.0, |curve| system.curves[curve].steepest());
            let shares = link.shares().map(f64::abs);
            let whole = 0.5 * shares.iter().sum::<f64>();
            for (i, share) in link.masses(n).into_iter().zip(shares) {
                stiffness[i] += whole * share * (link.stiffness + curved);
                damping[i] += whole * share * link.damping;
            }
        }
        for controller in &system.controllers {
            damping[controller.mass] += controller.ratio.powi(2) * controller.gain;
        }
        for friction in &system.frictions {
            let slope = friction.ratio * friction.ratio * friction.steepest(&system.curves);
            friction.ends.into_iter().for_each(|i| damping[i] += slope);
        }
        let each = (0..n).map(|i| {
            let inverse = 2.0 / self.inertia[i];
            (stiffness[i] * inverse).sqrt().max(damping[i] * inverse)
        });
        each.fold(0.0, f64::max)
    }

    /// How fast the fastest table over angle is run through in a state \[rad/s\].
    pub fn turning(&self, state: &[f64]) -> f64 {
        let system = self.system;
        let speeds = &state[system.len()..];
        let speed = |i: usize| {
            if i > 0 && self.relative { self.turns[i] * speeds[0] + speeds[i] } else { speeds[i] }
        };
        let rotors = system.rotors.iter().map(|rotor| (rotor.mass, rotor.ratio));
        let shapes = system.torques.iter().filter_map(|torque| Some((torque.mass, torque.shape?.pitch)));
        // What a joint adds repeats twice in a revolution.
        let joints = system.links.iter().filter(|link| link.manner.joint.is_some());
        let joints = joints.map(|link| (link.ends[0], 2.0 * link.ratio));
        rotors
            .chain(shapes)
            .chain(joints)
            .map(|(mass, pitch)| (pitch * speed(mass)).abs())
            .fold(0.0, f64::max)
    }

    /// Derivatives of the accelerations by all angles and speeds of the masses, row by row, at the instant last evaluated.
    pub fn jacobian(&mut self, t: f64, by_angle: &mut [f64], by_speed: &mut [f64]) {
        let system = self.system;
        let n = system.len();
        by_angle.fill(0.0);
        by_speed.fill(0.0);
        let mut d2 = vec![0.0; n];
        for Rotor { mass, ratio, phase, table } in &system.rotors {
            let square = ratio * ratio;
            d2[*mass] += square * square * system.tables[*table].bend(ratio * self.theta[*mass] + phase);
        }
        for i in 0..n {
            let omega = self.omega[i];
            let (d1, d2) = (self.bends[i], d2[i]);
            by_angle[i * n + i] = -0.5 * d2 * omega * omega - self.acceleration[i] * d1;
            by_speed[i * n + i] = -d1 * omega - system.damping[i] - system.swing_damping[i];
            for (j, share) in self.shares.iter().enumerate().filter(|&(j, _)| self.parts[j] == self.parts[i])
            {
                by_speed[i * n + j] += system.swing_damping[i] * self.turns[i] * share;
            }
        }
        for torque in &system.torques {
            let i = torque.mass;
            let about = (&system.tables[..], &system.curves[..], &self.stretch);
            let Pull { by_angle: angle, by_speed: speed, .. } =
                torque.at(about, (t, self.theta[i], self.omega[i]));
            by_angle[i * n + i] += angle;
            by_speed[i * n + i] += speed;
        }
        for controller in &system.controllers {
            let (i, j) = (controller.mass, controller.integral);
            let speeds = [self.omega[i], self.omega[j]];
            let is_free = controller.at(&system.curves, &self.stretch, t, speeds).is_free;
            for (row, [by_mass, by_integral]) in [i, j].into_iter().zip(controller.slopes(is_free)) {
                by_speed[row * n + i] += by_mass;
                by_speed[row * n + j] += by_integral;
            }
        }
        for (place, link) in system.links.iter().enumerate() {
            if !link.manner.rigid {
                self.couple(place, link, by_angle, by_speed);
            }
        }
        self.rub_slopes(by_speed);
        let swing = Swing { aside: &self.aside[1..], omega: &self.omega };
        add_slopes(&system.pendulums, swing, &self.acceleration, n, [&mut *by_angle, &mut *by_speed]);
        for i in 0..n {
            let inverse = 1.0 / self.inertia[i];
            for list in [&mut *by_angle, &mut *by_speed] {
                list[i * n..(i + 1) * n].iter_mut().for_each(|x| *x *= inverse);
            }
        }
        [by_angle, by_speed].into_iter().for_each(|matrix| self.constrain_columns(matrix));
    }

    /// A link's part of the derivatives of the torques.
    fn couple(&self, place: usize, link: &Link, by_angle: &mut [f64], by_speed: &mut [f64]) {
        let (n, bond) = (self.system.len(), self.bond(link));
        let pulls = link.pulls(self.system, bond.twist, bond.rate);
        let factors = [
            if link.manner.loss.is_some() { self.stages.last_factor(&self.system.links, place) } else { 1.0 },
            1.0,
            1.0,
        ];
        let present = |k: &usize| bond.masses[*k] < n;
        for a in (0..3).filter(present) {
            let row = bond.masses[a] * n;
            for b in (0..3).filter(present) {
                let both = factors[a] * bond.gradient[a] * bond.gradient[b];
                by_angle[row + bond.masses[b]] -= both * pulls.by_twist;
                by_speed[row + bond.masses[b]] -= both * pulls.by_rate;
            }
        }
        // Behind a joint the gradient changes with the angle.
        if bond.bend != 0.0 {
            let a = bond.masses[0];
            by_angle[a * n + a] -= bond.bend * pulls.torque;
            let turned = bond.bend * self.omega[a] * pulls.by_rate;
            for (mass, gradient) in bond.masses.into_iter().zip(bond.gradient).filter(|(mass, _)| *mass < n) {
                by_angle[mass * n + a] -= gradient * turned;
            }
        }
    }
}

/// The equations at one instant.
struct Derivative<'r, 'a> {
    rates: &'r mut Rates<'a>,
    t: f64,
    state: &'r [f64],
    to: &'r mut [f64],
}

impl Job for Derivative<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        self.rates.derive::<R>(self.t, self.state, self.to);
    }
}

impl Rotor {
    /// As a function of the angle of its mass.
    fn of_angle(&self) -> OfAngle {
        let Rotor { mass, ratio, phase, table } = *self;
        OfAngle { mass, table, scale: ratio * ratio, pitch: ratio, phase }
    }
}

impl Torque {
    /// As a function of the angle of its mass, unless speed or time have a say.
    fn of_angle(&self) -> Option<OfAngle> {
        let Shape { table, pitch, phase } = self.shape?;
        let is_constant = matches!(self.law, Law::Constant) && self.weight.is_none();
        is_constant.then_some(OfAngle {
            mass: self.mass,
            table,
            scale: self.scale * self.ratio,
            pitch,
            phase,
        })
    }
}

impl Link {
    /// Twist at its own speed from the angles of a state of n masses, but for that of a joint; from its speeds the rate.
    pub fn twist(&self, n: usize, relative: bool, state: impl Fn(usize) -> f64) -> f64 {
        let aside = |i: usize| if i == n || (i == 0 && relative) { 0.0 } else { state(i) };
        let [a, b, c] = self.masses(n).map(aside);
        match self.manner.carrier {
            None => self.ratio * (a - b),
            Some(Carrier { shares: [by_a, by_b, by_c], .. }) => by_a * a + by_b * b + by_c * c,
        }
    }
}
