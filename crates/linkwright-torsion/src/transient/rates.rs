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
//! Source: the equation is Lagrange's for T = ½ J(θ) θ̇²; e.g. Eksergian, *Dynamical analysis of machines*,
//! J. Franklin Inst. 209 (1930).

use super::bank::{Bank, OfAngle, WIDEST};
use super::chains::{Links, Twists};
use super::contacts::{Break, Contacts, slide};
use super::friction::Friction;
use super::system::{Link, Rotor, System};
use super::torque::{Law, Pull, Shape, Stretch, Torque};
use linkwright_kernel::lanes::{Job, in_single_lanes};
use linkwright_kernel::real::Real;

/// Share of the accelerations of its ends below which that of an element's slip is rounding.
const RATE_ROUNDING: f64 = 1e-9;

/// A system at one instant, with room for what the equations need.
#[derive(Clone, Debug)]
pub struct Rates<'a> {
    pub system: &'a System,
    stretch: Stretch,
    /// Elements with dry friction, and how far each is engaged at the instant last evaluated.
    pub contacts: Contacts,
    engaged: Vec<f64>,
    links: Links,
    /// Whether angles of the state are counted from that of the first mass.
    relative: bool,
    /// Zero for the mass from which the others are counted and behind the last, else one.
    beside: Vec<f64>,
    theta: Vec<f64>,
    pub omega: Vec<f64>,
    /// Angles and speeds for twists: a place before the first mass, the masses, the ground.
    aside: Vec<f64>,
    aside_speed: Vec<f64>,
    /// Shares of the masses in the inertia of the whole, or of their parts; the first mass of each part; speed of the whole.
    shares: Vec<f64>,
    parts: Vec<usize>,
    whole: Vec<f64>,
    /// What the masses have of inertia and damping anyway.
    constant: Vec<f64>,
    damping: Vec<f64>,
    swing_damping: Vec<f64>,
    inertia: Vec<f64>,
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
    outer: Vec<f64>,
    /// Losses at masses and in the links behind them, powers of each bank of torques, powers of other torques, losses in other
    /// links, losses by friction \[W\]: [`Rates::in_order`].
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
            damps_swings: system.swing_damping.iter().any(|&d| d != 0.0),
            bends: none.clone(),
            inertias: Bank::several(rotors, places, &system.tables),
            acceleration: none.clone(),
            outer: vec![0.0; places + 1],
            powers: vec![
                0.0;
                places * (2 + shapes.len())
                    + alone.len()
                    + links.others.len()
                    + system.frictions.len()
            ],
            shapes,
            alone,
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
                half[1..].iter_mut().for_each(|x| *x -= first);
            }
        }
    }

    /// Counts all masses from the ground.
    pub fn to_absolute(&self, state: &mut [f64]) {
        if self.relative {
            for half in state.chunks_exact_mut(self.system.len()) {
                let first = half[0];
                half[1..].iter_mut().for_each(|x| *x += first);
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
        self.whole_speed();
        for at in (0..places).step_by(R::LANES) {
            self.accelerate::<R>(at);
        }
        if self.contacts.any() {
            self.contacts.hold(&mut self.acceleration, &self.inertia);
        }
        let lead = if self.relative { self.acceleration[0] } else { 0.0 };
        let (angle_rates, speed_rates) = to.split_at_mut(places);
        for at in (0..places).step_by(R::LANES) {
            R::load(&speeds[at..]).store(&mut angle_rates[at..]);
            let lead = R::load(&self.beside[at..]) * lead;
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
        let swing = (R::load(&self.aside_speed[at + 1..]) - R::load(&self.whole[at..]))
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
        (angle + lead[0]).store(&mut self.theta[at..]);
        (speed + lead[1]).store(&mut self.omega[at..]);
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

    /// Torques of elements that slide.
    #[inline(always)]
    fn rub(&mut self, t: f64) {
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

    /// Slip of an element at the instant last evaluated.
    pub fn slip(&self, friction: &Friction) -> f64 {
        let n = self.system.len();
        if friction.is_brake(n) {
            friction.slip(|i| if i == n { 0.0 } else { self.omega[i] })
        } else {
            friction.slip(|i| self.aside_speed[i + 1])
        }
    }

    /// Slip of an element from components of a state.
    pub fn slip_at(&self, friction: &Friction, state: impl Fn(usize) -> f64) -> f64 {
        let n = self.system.len();
        let aside = |i: usize| if i == n || (i == 0 && self.relative) { 0.0 } else { state(n + i) };
        let lead = if self.relative && friction.is_brake(n) { state(n) } else { 0.0 };
        friction.slip(|i| if i == n { 0.0 } else { aside(i) + lead })
    }

    /// How fast the slip of an element grows at the instant last evaluated.
    pub fn slip_rate(&self, friction: &Friction) -> f64 {
        friction.slip(|i| if i == self.system.len() { 0.0 } else { self.acceleration[i] })
    }

    /// Whether an element is engaged, at a time or later on the stretch.
    pub fn is_engaged(&self, friction: &Friction, t: f64) -> bool {
        [t, self.stretch.middle]
            .iter()
            .any(|&t| friction.engaged(&self.system.curves, &self.stretch, t) > 0.0)
    }

    /// Finds the torques of stuck elements at the instant last evaluated: the smallest margin to a bound, below zero where one
    /// does not hold, and which.
    pub fn carry(&mut self) -> (f64, Option<Break>) {
        let motion = (&self.acceleration[..], &self.inertia[..]);
        self.contacts.carry(&self.system.frictions, &self.engaged, motion)
    }

    /// Accelerations below which a sliding element neither gains nor loses slip: rounding of what acts on its ends.
    pub fn slip_rate_rounding(&self, e: usize) -> f64 {
        let Friction { ends, ratio, .. } = self.system.frictions[e];
        let of = |&i: &usize| {
            let inverse = ratio.abs() / self.inertia[i];
            inverse * (self.contacts.net(i).abs() + (ratio * self.contacts.torques[e]).abs())
        };
        RATE_ROUNDING * ends.iter().filter(|&&i| i < self.system.len()).map(of).sum::<f64>()
    }

    /// Inertias of the masses at the instant last evaluated.
    pub fn inertias(&self) -> &[f64] {
        &self.inertia[..self.system.len()]
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
    }

    /// Torques of the links that are no chain.
    #[inline(always)]
    fn twist(&mut self) {
        let system = self.system;
        let losses = &mut self.powers[self.theta.len() * (2 + self.shapes.len()) + self.alone.len()..];
        for (&place, loss) in self.links.others.iter().zip(losses) {
            let link = &system.links[place];
            let [a, b] = link.ends;
            let rate = link.ratio * (self.aside_speed[a + 1] - self.aside_speed[b + 1]);
            let twist = link.ratio * (self.aside[a + 1] - self.aside[b + 1]);
            let elastic = link.elastic(system, twist).0;
            let torque = link.ratio * (elastic + link.damping * rate);
            *loss = link.damping * rate * rate;
            self.outer[a] -= torque;
            self.outer[b] += torque;
        }
    }

    /// Powers, or their works: of each torque, then in each link, then at each mass, then by friction.
    pub fn in_order(&self, powers: &[f64]) -> Vec<f64> {
        let (n, places) = (self.system.len(), self.theta.len());
        let (drags, powers) = powers.split_at(places);
        let (behind, powers) = powers.split_at(places);
        let (banks, powers) = powers.split_at(places * self.shapes.len());
        let (alone, powers) = powers.split_at(self.alone.len());
        let (others, rubbing) = powers.split_at(self.links.others.len());
        let mut torques = vec![0.0; self.system.torques.len()];
        self.alone.iter().zip(alone).for_each(|(&place, &power)| torques[place] = power);
        for (bank, powers) in self.shapes.iter().zip(banks.chunks_exact(places)) {
            for (place, &power) in bank.places.iter().zip(powers) {
                place.iter().for_each(|&place| torques[place] = power);
            }
        }
        [torques, self.links.losses(behind, others), drags[..n].to_vec(), rubbing.to_vec()].concat()
    }

    /// Torque in a link at its own speed, and how fast it changes, at the instant last evaluated.
    pub fn link_torque(&self, link: &Link) -> (f64, f64) {
        let [a, b] = link.ends;
        let rate = link.ratio * (self.aside_speed[a + 1] - self.aside_speed[b + 1]);
        let twist = link.ratio * (self.aside[a + 1] - self.aside[b + 1]);
        let at = |i: usize| self.acceleration.get(i).copied().unwrap_or(0.0);
        let bend = link.ratio * (at(a) - at(b));
        let (elastic, slope) = link.elastic(self.system, twist);
        (elastic + link.damping * rate, slope * rate + link.damping * bend)
    }

    /// Torque in a link from components of a state.
    pub fn link_torque_at(&self, link: &Link, state: impl Fn(usize) -> f64) -> f64 {
        let n = self.system.len();
        let (twist, rate) =
            (link.twist(n, self.relative, &state), link.twist(n, self.relative, |i| state(n + i)));
        link.elastic(self.system, twist).0 + link.damping * rate
    }

    /// Kinetic and potential energy of a state \[J\].
    pub fn energies(&self, state: &[f64]) -> [f64; 2] {
        let system = self.system;
        let mut masses = state.to_vec();
        self.to_absolute(&mut masses);
        let (theta, omega) = masses.split_at(system.len());
        let turning: f64 = system.inertia.iter().zip(omega).map(|(j, w)| j * w * w).sum();
        let rotor = |rotor: &Rotor| {
            let part = rotor.ratio * omega[rotor.mass];
            let angle = rotor.ratio * theta[rotor.mass] + rotor.phase;
            system.tables[rotor.table].value_and_slope(angle)[0] * part * part
        };
        let kinetic = 0.5 * (turning + system.rotors.iter().map(rotor).sum::<f64>());
        let stored = |link: &Link| {
            let twist = link.twist(system.len(), self.relative, |i| state[i]);
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
            let [a, b] = link.ends;
            let square = link.ratio * link.ratio;
            // A coupling with backlash has no stiffness yet; its steepest counts.
            let curved = link.curve.map_or(0.0, |curve| system.curves[curve].steepest());
            for i in [a, b] {
                stiffness[i] += square * (link.stiffness + curved);
                damping[i] += square * link.damping;
            }
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
        let speed = |i: usize| if i > 0 && self.relative { speeds[0] + speeds[i] } else { speeds[i] };
        let rotors = system.rotors.iter().map(|rotor| (rotor.mass, rotor.ratio));
        let shapes = system.torques.iter().filter_map(|torque| Some((torque.mass, torque.shape?.pitch)));
        rotors.chain(shapes).map(|(mass, pitch)| (pitch * speed(mass)).abs()).fold(0.0, f64::max)
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
                by_speed[i * n + j] += system.swing_damping[i] * share;
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
        for link in &system.links {
            let [a, b] = link.ends;
            let square = link.ratio * link.ratio;
            let slope = link.elastic(system, link.ratio * (self.aside[a + 1] - self.aside[b + 1])).1;
            couple(by_angle, n, [a, b], square * slope);
            couple(by_speed, n, [a, b], square * link.damping);
        }
        for (e, friction) in system.frictions.iter().enumerate() {
            let slip = self.slip(friction);
            let sliding = slide(friction, self.contacts.states[e], &system.curves, self.engaged[e], slip);
            let slope = sliding.map_or(0.0, |(_, slope)| slope);
            couple(by_speed, n, friction.ends, friction.ratio * friction.ratio * slope);
        }
        for i in 0..n {
            let inverse = 1.0 / self.inertia[i];
            for list in [&mut *by_angle, &mut *by_speed] {
                list[i * n..(i + 1) * n].iter_mut().for_each(|x| *x *= inverse);
            }
        }
        for list in [by_angle, by_speed] {
            self.contacts.hold_rows(list, &self.inertia);
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

/// A stiffness between two masses, as it acts on them.
fn couple(matrix: &mut [f64], n: usize, [a, b]: [usize; 2], stiffness: f64) {
    for (i, j) in [(a, b), (b, a)] {
        if i < n {
            matrix[i * n + i] -= stiffness;
            if j < n {
                matrix[i * n + j] += stiffness;
            }
        }
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
    /// Twist at its own speed from the angles of a state of n masses; from its speeds the rate of twist.
    pub fn twist(&self, n: usize, relative: bool, state: impl Fn(usize) -> f64) -> f64 {
        let aside = |i: usize| if i == n || (i == 0 && relative) { 0.0 } else { state(i) };
        let [a, b] = self.ends;
        self.ratio * (aside(a) - aside(b))
    }

    /// Elastic torque at a twist, and its slope.
    #[inline(always)]
    fn elastic(&self, system: &System, twist: f64) -> (f64, f64) {
        let (curved, slope) = match self.curve {
            None => (0.0, 0.0),
            Some(curve) => system.curves[curve].at(twist),
        };
        (self.stiffness * twist + curved, self.stiffness + slope)
    }
}
