//! Centrifugal pendulums that swing without rotation of their own (bifilar), exactly for any swing.
//!
//! The mass m moves on a circle of the radius l about a point of its disc at the radius R. With the angle χ = θ + ψ l/(R + l)
//! beside that of the disc, θ, and u = 1 − cos ψ,
//!
//! ```text
//! T = ½ (J + 2mR² u) θ̇² − mR(R + l) u θ̇χ̇ + ½ m(R + l)² χ̇²        ψ = (χ − θ)(R + l)/l
//! ```
//!
//! For small swings u vanishes: a ring of m(R + l)², which Ω² drives back, as linear vibration has it.
//!
//! Source: Den Hartog, *Mechanical Vibrations*, 4th ed. 1956, ch. 5; kinetic energy of a point on two circles, Lagrange.

/// A pendulum: mass of its disc, and mass that its angle χ is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    pub disc: usize,
    pub bob: usize,
    /// 2mR² and −mR(R + l), times the square of the speed of the disc over that of its mass \[kg m²\].
    pub of_disc: f64,
    pub of_both: f64,
    /// ψ over χ − θ of the masses.
    pub swing: f64,
}

/// What it adds at an instant: to the inertia of its disc and between both, and torques on both.
#[derive(Clone, Copy, Debug, Default)]
struct Added {
    disc: f64,
    both: f64,
    torque: [f64; 2],
}

impl Pendulum {
    /// Of a mass on two radii, R and l, on a disc `ratio` times as fast as its mass.
    pub fn new([disc, bob]: [usize; 2], ratio: f64, mass: f64, [radius, length]: [f64; 2]) -> Self {
        let scale = ratio * ratio * mass * radius;
        Pendulum {
            disc,
            bob,
            of_disc: 2.0 * scale * radius,
            of_both: -scale * (radius + length),
            swing: ratio * (radius + length) / length,
        }
    }

    /// From the lead of χ over θ and both speeds.
    fn at(&self, lead: f64, [theta, chi]: [f64; 2]) -> Added {
        let (sine, u) = of_swing(self.swing * lead);
        let (a, b, s) = (self.of_disc, self.of_both, self.swing);
        let rate = s * (chi - theta);
        let lagrange = s * sine * (0.5 * a * theta + b * chi) * theta;
        Added {
            disc: a * u,
            both: b * u,
            torque: [
                -(sine * rate * (a * theta + b * chi) + lagrange),
                -(sine * rate * b * theta - lagrange),
            ],
        }
    }

    /// Kinetic energy beyond that of the disc and the ring.
    pub fn energy(&self, lead: f64, [theta, chi]: [f64; 2]) -> f64 {
        let (_, u) = of_swing(self.swing * lead);
        u * theta * (0.5 * self.of_disc * theta + self.of_both * chi)
    }

    /// Derivatives of the torques on both by the lead of χ and by both speeds, at accelerations of both: of all that depends on
    /// the swing, inertias included.
    fn slopes(&self, lead: f64, [theta, chi]: [f64; 2], [disc, bob]: [f64; 2]) -> [[f64; 3]; 2] {
        let (psi, s) = (self.swing * lead, self.swing);
        let (a, b, rate) = (self.of_disc, self.of_both, self.swing * (chi - theta));
        let (sine, cosine) = psi.sin_cos();
        let lagrange = (0.5 * a * theta + b * chi) * theta;
        let both = a * theta + b * chi;
        [
            [
                -s * (sine * (a * disc + b * bob) + cosine * (rate * both + s * lagrange)),
                -sine * rate * a,
                -sine * (s * both + rate * b + s * b * theta),
            ],
            [
                -s * (sine * b * disc + cosine * (rate * b * theta - s * lagrange)),
                -sine * (b * (rate - s * theta) - s * both),
                0.0,
            ],
        ]
    }
}

/// sin ψ and 1 − cos ψ, which keeps its digits.
fn of_swing(psi: f64) -> (f64, f64) {
    let half = (0.5 * psi).sin();
    (psi.sin(), 2.0 * half * half)
}

/// What the pendulums of a train add at an instant: to the inertia of the disc, and between disc and pendulum.
#[derive(Clone, Debug)]
pub struct Bobs(Vec<[f64; 2]>);

/// Angles beside the first mass and speeds of all masses.
#[derive(Clone, Copy, Debug)]
pub struct Swing<'a> {
    pub aside: &'a [f64],
    pub omega: &'a [f64],
}

impl Swing<'_> {
    /// Lead of χ over θ, and both speeds, of a pendulum.
    fn of(&self, pendulum: &Pendulum) -> (f64, [f64; 2]) {
        let Pendulum { disc, bob, .. } = *pendulum;
        (self.aside[bob] - self.aside[disc], [self.omega[disc], self.omega[bob]])
    }
}

impl Bobs {
    /// Of so many pendulums.
    pub fn new(count: usize) -> Self {
        Bobs(vec![[0.0; 2]; count])
    }

    /// Whether there are any.
    pub fn any(&self) -> bool {
        !self.0.is_empty()
    }

    /// Torques of the pendulums on the masses, and what they add to inertias.
    pub fn push(&mut self, pendulums: &[Pendulum], swing: Swing<'_>, torque: &mut [f64]) {
        for (pendulum, bob) in pendulums.iter().zip(&mut self.0) {
            let (lead, speeds) = swing.of(pendulum);
            let added = pendulum.at(lead, speeds);
            torque[pendulum.disc] += added.torque[0];
            torque[pendulum.bob] += added.torque[1];
            *bob = [added.disc, added.both];
        }
    }

    /// Adds to the inertia of each disc what its pendulums are there, at given torques on them.
    pub fn add_to(&self, pendulums: &[Pendulum], inertia: &[f64], effective: &mut [f64]) {
        for (pendulum, [disc, both]) in pendulums.iter().zip(&self.0) {
            effective[pendulum.disc] += disc - both * both / inertia[pendulum.bob];
        }
    }

    /// Accelerations of the discs over these inertias, from those that torque over own inertia would give all masses.
    pub fn load(&self, pendulums: &[Pendulum], inertia: &[f64], effective: &[f64], acceleration: &mut [f64]) {
        for (first, Pendulum { disc: i, .. }) in pendulums.iter().enumerate() {
            if pendulums[..first].iter().any(|other| other.disc == *i) {
                continue;
            }
            let on_disc = pendulums.iter().zip(&self.0).filter(|(other, _)| other.disc == *i);
            let torque = on_disc.fold(inertia[*i] * acceleration[*i], |torque, (pendulum, [_, both])| {
                torque - both * acceleration[pendulum.bob]
            });
            acceleration[*i] = torque / effective[*i];
        }
    }

    /// Accelerations of the pendulums from those that their torques alone would give, at those of their discs.
    pub fn follow(&self, pendulums: &[Pendulum], inertia: &[f64], acceleration: &mut [f64]) {
        for (pendulum, [_, both]) in pendulums.iter().zip(&self.0) {
            acceleration[pendulum.bob] -= both / inertia[pendulum.bob] * acceleration[pendulum.disc];
        }
    }

    /// Inertia torque of a mass at accelerations, beyond its own inertia times its acceleration.
    pub fn torque_of(&self, pendulums: &[Pendulum], mass: usize, acceleration: impl Fn(usize) -> f64) -> f64 {
        let of = |(pendulum, [disc, both]): (&Pendulum, &[f64; 2])| match mass {
            i if i == pendulum.disc => disc * acceleration(i) + both * acceleration(pendulum.bob),
            i if i == pendulum.bob => both * acceleration(pendulum.disc),
            _ => 0.0,
        };
        pendulums.iter().zip(&self.0).map(of).sum()
    }
}

/// Adds to the derivatives of the torques of n masses, row by row, by angles and speeds.
pub fn add_slopes(
    pendulums: &[Pendulum],
    swing: Swing<'_>,
    acceleration: &[f64],
    n: usize,
    [by_angle, by_speed]: [&mut [f64]; 2],
) {
    for pendulum in pendulums {
        let [i, j] = [pendulum.disc, pendulum.bob];
        let (lead, speeds) = swing.of(pendulum);
        let slopes = pendulum.slopes(lead, speeds, [acceleration[i], acceleration[j]]);
        for (row, [by_lead, by_disc, by_bob]) in [i, j].into_iter().zip(slopes) {
            by_angle[row * n + j] += by_lead;
            by_angle[row * n + i] -= by_lead;
            by_speed[row * n + i] += by_disc;
            by_speed[row * n + j] += by_bob;
        }
    }
}
