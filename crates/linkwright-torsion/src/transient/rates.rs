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
//! Source: the equation is Lagrange's for T = ½ J(θ) θ̇²; e.g. Eksergian, *Dynamical analysis of machines*,
//! J. Franklin Inst. 209 (1930).

use super::chains::{Links, TwistSums};
use super::system::{Link, Rotor, System};
use super::torque::{Pull, Stretch};
use linkwright_kernel::lanes::{Job, in_single_lanes};
use linkwright_kernel::real::Real;

/// Calls a method for masses side by side, with the place of the first; the last bundle may overlap the one before, so that
/// none is left over. Fewer masses than lanes come one by one.
macro_rules! side_by_side {
    ($R:ident, $n:expr, $this:ident.$method:ident($($argument:expr),*)) => {
        if $n < $R::LANES {
            for at in 0..$n {
                $this.$method::<f64>(at $(, $argument)*);
            }
        } else {
            let mut at = 0;
            while at + $R::LANES < $n {
                $this.$method::<$R>(at $(, $argument)*);
                at += $R::LANES;
            }
            $this.$method::<$R>($n - $R::LANES $(, $argument)*);
        }
    };
}

/// A system at one instant, with room for what the equations need.
#[derive(Clone, Debug)]
pub struct Rates<'a> {
    pub system: &'a System,
    stretch: Stretch,
    links: Links,
    /// Whether angles of the state are counted from that of the first mass.
    relative: bool,
    theta: Vec<f64>,
    pub omega: Vec<f64>,
    /// Angles and speeds for twists, and those of the ground.
    aside: Vec<f64>,
    aside_speed: Vec<f64>,
    /// Shares of the masses in the inertia of the whole.
    shares: Vec<f64>,
    inertia: Vec<f64>,
    /// Whether anything damps swings.
    damps_swings: bool,
    /// J′ of each mass.
    bends: Vec<f64>,
    pub acceleration: Vec<f64>,
    /// Sum of torques on each mass and on the ground.
    net: Vec<f64>,
    /// Power of each torque, then loss in each link, then loss at each mass \[W\].
    pub powers: Vec<f64>,
    /// How often the equations were evaluated.
    pub evaluations: usize,
}

impl<'a> Rates<'a> {
    /// For a system.
    pub fn new(system: &'a System) -> Self {
        let n = system.len();
        Rates {
            system,
            stretch: Stretch::default(),
            links: Links::of(system),
            relative: system.is_free(),
            theta: vec![0.0; n],
            omega: vec![0.0; n],
            aside: vec![0.0; n + 1],
            aside_speed: vec![0.0; n + 1],
            shares: system.shares(),
            inertia: system.inertia.clone(),
            damps_swings: system.swing_damping.iter().any(|&d| d != 0.0),
            bends: vec![0.0; n],
            acceleration: vec![0.0; n],
            net: vec![0.0; n + 1],
            powers: vec![0.0; system.torques.len() + system.links.len() + n],
            evaluations: 0,
        }
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
        in_single_lanes(Derivative { rates: self, t, state, to });
    }

    /// What [`Rates::derivative`] does, in a function for the processor's own instructions.
    #[inline(always)]
    fn derive<R: Real>(&mut self, t: f64, state: &[f64], to: &mut [f64]) {
        self.evaluations += 1;
        self.place::<R>(state);
        self.turn();
        self.push::<R>(t);
        self.twist::<R>();
        let n = self.system.len();
        side_by_side!(R, n, self.accelerate());
        let (angles, speeds) = to.split_at_mut(n);
        let lead = if self.relative { self.acceleration[0] } else { 0.0 };
        side_by_side!(R, n, self.tell(&state[n..], lead, [&mut *angles, &mut *speeds]));
        speeds[0] = self.acceleration[0];
    }

    /// Accelerations of some masses.
    #[inline(always)]
    fn accelerate<R: Real>(&mut self, at: usize) {
        let omega = R::load(&self.omega[at..]);
        let gyration = R::load(&self.bends[at..]) * 0.5 * omega * omega;
        let found = (R::load(&self.net[at..]) - gyration) / R::load(&self.inertia[at..]);
        found.store(&mut self.acceleration[at..]);
    }

    /// Rates of some angles and speeds, less that of the first mass.
    #[inline(always)]
    fn tell<R: Real>(&self, at: usize, speeds: &[f64], lead: f64, to: [&mut [f64]; 2]) {
        R::load(&speeds[at..]).store(&mut to[0][at..]);
        (R::load(&self.acceleration[at..]) - R::splat(lead)).store(&mut to[1][at..]);
    }

    /// Angles and speeds of the masses.
    #[inline(always)]
    fn place<R: Real>(&mut self, state: &[f64]) {
        let n = self.system.len();
        let (angles, speeds) = state.split_at(n);
        let lead = if self.relative { [angles[0], speeds[0]] } else { [0.0; 2] };
        side_by_side!(R, n, self.place_some([angles, speeds], lead));
        if self.relative {
            (self.aside[0], self.aside_speed[0]) = (0.0, 0.0);
            [self.theta[0], self.omega[0]] = lead;
        }
    }

    /// Those of some masses.
    #[inline(always)]
    fn place_some<R: Real>(&mut self, at: usize, [angles, speeds]: [&[f64]; 2], lead: [f64; 2]) {
        let (angle, speed) = (R::load(&angles[at..]), R::load(&speeds[at..]));
        angle.store(&mut self.aside[at..]);
        speed.store(&mut self.aside_speed[at..]);
        (angle + lead[0]).store(&mut self.theta[at..]);
        (speed + lead[1]).store(&mut self.omega[at..]);
    }

    /// Inertias at these angles; what does not change stands there already.
    #[inline(always)]
    fn turn(&mut self) {
        for Rotor { mass, .. } in &self.system.rotors {
            (self.inertia[*mass], self.bends[*mass]) = (self.system.inertia[*mass], 0.0);
        }
        for rotor in &self.system.rotors {
            let i = rotor.mass;
            let n = rotor.ratio;
            let [value, d1] =
                self.system.tables[rotor.table].value_and_slope(n * self.theta[i] + rotor.phase);
            let square = n * n;
            self.inertia[i] += square * value;
            self.bends[i] += square * n * d1;
        }
    }

    /// Torques from outside and damping against the ground.
    #[inline(always)]
    fn push<R: Real>(&mut self, t: f64) {
        let (system, n) = (self.system, self.system.len());
        let whole = if self.damps_swings {
            self.shares.iter().zip(&self.aside_speed).map(|(share, w)| share * w).sum()
        } else {
            0.0
        };
        side_by_side!(R, n, self.drag(whole));
        let about = (&system.tables[..], &system.curves[..], &self.stretch);
        for (torque, power) in system.torques.iter().zip(&mut self.powers) {
            let i = torque.mass;
            let pull = torque.at(about, (t, self.theta[i], self.omega[i]));
            self.net[i] += pull.torque;
            *power = pull.torque * self.omega[i];
        }
    }

    /// Damping of some masses, with the speed of the train as a whole.
    #[inline(always)]
    fn drag<R: Real>(&mut self, at: usize, whole: f64) {
        let system = self.system;
        let omega = R::load(&self.omega[at..]);
        let swing =
            (R::load(&self.aside_speed[at..]) - R::splat(whole)) * R::load(&system.swing_damping[at..]);
        let drag = R::load(&system.damping[at..]) * omega + swing;
        (-drag).store(&mut self.net[at..]);
        (drag * omega).store(&mut self.powers[system.torques.len() + system.links.len() + at..]);
    }

    /// Torques of the links.
    #[inline(always)]
    fn twist<R: Real>(&mut self) {
        let (system, n) = (self.system, self.system.len());
        // The ground is the mass beyond the last.
        let (angle, speed, net) = (&self.aside[..=n], &self.aside_speed[..=n], &mut self.net[..=n]);
        let mut to = TwistSums { angle, speed, net, losses: &mut self.powers[system.torques.len()..] };
        for chain in &self.links.chains {
            chain.twist::<R>(&mut to);
        }
        for &place in &self.links.others {
            let link = &system.links[place];
            let [a, b] = link.ends;
            let rate = link.ratio * (speed[a] - speed[b]);
            let twist = link.ratio * (angle[a] - angle[b]);
            let elastic = link.elastic(system, twist).0;
            let torque = link.ratio * (elastic + link.damping * rate);
            to.losses[place] = link.damping * rate * rate;
            to.net[a] -= torque;
            to.net[b] += torque;
        }
    }

    /// Torque in a link at its own speed, and how fast it changes, at the instant last evaluated.
    pub fn link_torque(&self, link: &Link) -> (f64, f64) {
        let [a, b] = link.ends;
        let rate = link.ratio * (self.aside_speed[a] - self.aside_speed[b]);
        let twist = link.ratio * (self.aside[a] - self.aside[b]);
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
    pub fn energies(&mut self, state: &[f64]) -> [f64; 2] {
        self.place::<f64>(state);
        self.turn();
        let kinetic: f64 = self.inertia.iter().zip(&self.omega).map(|(j, w)| 0.5 * j * w * w).sum();
        let system = self.system;
        let stored = |link: &Link| {
            let [a, b] = link.ends;
            let twist = link.ratio * (self.aside[a] - self.aside[b]);
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
        inertia.copy_from_slice(&self.inertia);
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
            for (j, share) in self.shares.iter().enumerate() {
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
            let slope = link.elastic(system, link.ratio * (self.aside[a] - self.aside[b])).1;
            couple(by_angle, n, [a, b], square * slope);
            couple(by_speed, n, [a, b], square * link.damping);
        }
        for i in 0..n {
            let inverse = 1.0 / self.inertia[i];
            for list in [&mut *by_angle, &mut *by_speed] {
                list[i * n..(i + 1) * n].iter_mut().for_each(|x| *x *= inverse);
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
