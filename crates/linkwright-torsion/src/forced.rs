//! Forced vibration of a train: amplitudes at every order and speed.
//!
//! At the speed Ω the order ν excites with ω = νΩ. With the complex stiffness of every shaft
//!
//! ```text
//! s = k (1 + iη) + iωc          D = −ω² J + iωc₀  of every disc
//! ```
//!
//! D θ + Σ s (θ − θ′) = M is solved from the leaves to the root and back: the discs beyond a shaft respond
//!
//! ```text
//! D_p ← D_p + s D_c/(D_c + s)      M_p ← M_p + s M_c/(D_c + s)      θ_c = (M_c + s θ_p)/(D_c + s)
//! ```
//!
//! which is Gauss's elimination in the order of the tree, without fill. A lane is a speed.
//!
//! Where D_c + s is zero the discs beyond the shaft are in tune, as an absorber is: they hold the disc p still, and respond
//! themselves by what it bears. That is no resonance, and the elimination divides by zero all the same. There the divisor is
//! held at a small share of s, and the error that this makes is taken out again by the residual of the equations.
//!
//! Source: Holzer, *Die Berechnung der Drehschwingungen* (1921); with complex numbers Ker Wilson, *Practical Solution of
//! Torsional Vibration Problems*, vol. 4.

use super::Train;
use linkwright_kernel::call::{in_threads, poll};
use linkwright_kernel::lanes::{Job, in_lanes};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;
use num_complex::Complex64;
use rayon::current_num_threads;
use rayon::prelude::*;
use std::ops::{Add, Mul, Sub};

/// What damps a train, and how that changes with the speed.
#[derive(Clone, Copy, Debug)]
pub struct Damping<'a> {
    /// Speeds Ω \[rad/s\].
    pub speeds: &'a [f64],
    /// k of the shaft above each disc, a row a disc, a column a speed \[N m/rad\]; in place of the train's own.
    pub stiffness: &'a [f64],
    /// Viscous, of the shaft above each disc, likewise \[N m s/rad\].
    pub shaft: &'a [f64],
    /// ηk, likewise \[N m/rad\].
    pub loss: &'a [f64],
    /// Viscous against the ground, likewise \[N m s/rad\].
    pub ground: &'a [f64],
}

impl Damping<'_> {
    /// Whether every table has a row a disc.
    fn fits(&self, discs: usize) -> bool {
        let size = discs * self.speeds.len();
        [self.stiffness, self.shaft, self.loss, self.ground].iter().all(|each| each.len() == size)
    }
}

/// Amplitudes θ of every order, disc and speed, in place of the torques that cause them; `false`, and nothing done, if the
/// tables do not fit.
pub fn forced(train: &Train, damping: &Damping<'_>, orders: &[f64], torques: &mut [Complex64]) -> bool {
    let fits =
        damping.fits(train.len()) && torques.len() == orders.len() * train.len() * damping.speeds.len();
    let block = train.len() * damping.speeds.len();
    if !fits || block == 0 {
        return fits;
    }
    if torques.len() <= TASK {
        // Waking threads would take longer than doing it.
        in_lanes(ResponseJob { train, damping, orders, torques });
        return true;
    }
    in_threads(|crew| {
        // A task looks up what damps at a speed once for all its orders; two tasks a thread level out.
        let at_once = (TASK / block).max(orders.len().div_ceil(2 * current_num_threads())).max(1);
        let tasks = torques.par_chunks_mut(at_once * block).zip(orders.par_chunks(at_once));
        tasks.for_each(|(torques, orders)| {
            crew.task(|| in_lanes(ResponseJob { train, damping, orders, torques }))
        });
    });
    true
}

/// Amplitudes that a task finds: some hundred microseconds of work.
const TASK: usize = 65_536;

struct ResponseJob<'a> {
    train: &'a Train,
    damping: &'a Damping<'a>,
    orders: &'a [f64],
    torques: &'a mut [Complex64],
}

/// A complex number in lanes.
#[derive(Clone, Copy)]
struct Z<R>(R, R);

impl<R: Real> Add for Z<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Z(self.0 + other.0, self.1 + other.1)
    }
}

impl<R: Real> Sub for Z<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Z(self.0 - other.0, self.1 - other.1)
    }
}

impl<R: Real> Mul<f64> for Z<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, by: f64) -> Self {
        Z(self.0 * by, self.1 * by)
    }
}

impl<R: Real> Mul for Z<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let re = self.0.mul_add(other.0, -(self.1 * other.1));
        Z(re, self.0.mul_add(other.1, self.1 * other.0))
    }
}

impl<R: Real> Z<R> {
    /// |z|².
    #[inline(always)]
    fn squared(self) -> R {
        self.0.mul_add(self.0, self.1 * self.1)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        let size = self.squared().recip();
        Z(self.0 * size, -(self.1 * size))
    }
}

/// Lane by lane `low` where `size` is below a limit, else `other`.
#[inline(always)]
fn pick<R: Real>(size: R, limit: R, low: Z<R>, other: Z<R>) -> Z<R> {
    Z(size.select_lt(limit, low.0, other.0), size.select_lt(limit, low.1, other.1))
}

/// What a shaft and its disc are at some speeds: k, ηk, c, c₀.
#[derive(Clone, Copy)]
struct Part<R> {
    k: R,
    loss: R,
    c: R,
    ground: R,
}

/// A disc on the way through the tree.
#[derive(Clone, Copy)]
struct Step<R> {
    /// D, then 1/(D + s).
    D: Z<R>,
    s: Z<R>,
    /// M, then θ.
    M: Z<R>,
}

impl Job for ResponseJob<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let ResponseJob { train, damping, orders, torques } = self;
        let (n, speeds) = (train.len(), damping.speeds.len());
        let zero = R::splat(0.0);
        let mut parts = vec![Part { k: zero, loss: zero, c: zero, ground: zero }; n];
        let mut steps = vec![Step { D: Z(zero, zero), s: Z(zero, zero), M: Z(zero, zero) }; n];
        let mut buffer = vec![0.0; R::LANES];
        for first in (0..speeds).step_by(R::LANES) {
            for (i, part) in parts.iter_mut().enumerate() {
                let mut at = |from: &[f64]| lanes(&from[i * speeds..(i + 1) * speeds], first, &mut buffer);
                *part = Part {
                    k: at(damping.stiffness),
                    loss: at(damping.loss),
                    c: at(damping.shaft),
                    ground: at(damping.ground),
                };
            }
            let speed: R = lanes(damping.speeds, first, &mut buffer);
            for (block, &order) in torques.chunks_exact_mut(n * speeds).zip(orders) {
                poll();
                out_of_line!(R, {
                    for (step, row) in steps.iter_mut().zip(block.chunks_exact(speeds)) {
                        step.M = read(row, first);
                    }
                    if train.respond(speed * order, &parts, &mut steps) {
                        let torque = |disc: usize| read(&block[disc * speeds..(disc + 1) * speeds], first);
                        train.correct(speed * order, &parts, torque, &mut steps);
                    }
                    for (step, row) in steps.iter().zip(block.chunks_exact_mut(speeds)) {
                        write(step.M, row, first);
                    }
                });
            }
        }
    }
}

impl Train {
    /// Amplitudes in place of torques, at one ω a lane; whether a divisor was held away from zero.
    #[inline(always)]
    fn respond<R: Real>(&self, omega: R, parts: &[Part<R>], steps: &mut [Step<R>]) -> bool {
        let mut held = R::splat(1.0);
        let square = omega.squared();
        for ((step, part), &J) in steps.iter_mut().zip(parts).zip(&self.inertia) {
            step.D = Z(-(square * J), omega * part.ground);
            step.s = Z(part.k, omega.mul_add(part.c, part.loss));
        }
        for c in (1..self.len()).rev() {
            let Step { D, s, M } = steps[c];
            let (sum, least) = (D + s, s.squared() * (IN_TUNE * IN_TUNE));
            let size = sum.squared();
            held = held.min(size - least);
            let pivot = pick(size, least, s * IN_TUNE, sum).recip();
            let share = s * pivot;
            steps[c].D = pivot;
            let up = &mut steps[self.parent[c]];
            up.D = up.D + share * D;
            up.M = up.M + share * M;
        }
        let root = steps[0];
        steps[0].M = root.M * (root.D + root.s).recip();
        for c in 1..self.len() {
            let up = steps[self.parent[c]].M;
            let step = &mut steps[c];
            step.M = (step.M + step.s * up) * step.D;
        }
        held.any_below(R::splat(0.0))
    }

    /// Takes out of the amplitudes what divisors that were held away from zero made of them.
    #[inline(always)]
    fn correct<R: Real>(
        &self,
        omega: R,
        parts: &[Part<R>],
        torque: impl Fn(usize) -> Z<R>,
        steps: &mut [Step<R>],
    ) {
        let square = omega.squared();
        let mut theta: Vec<Z<R>> = steps.iter().map(|step| step.M).collect();
        for _ in 0..CORRECTIONS {
            for i in 0..self.len() {
                let D = Z(-(square * self.inertia[i]), omega * parts[i].ground);
                steps[i].M = torque(i) - (D + steps[i].s) * theta[i];
            }
            for c in 1..self.len() {
                let (p, s) = (self.parent[c], steps[c].s);
                steps[c].M = steps[c].M + s * theta[p];
                steps[p].M = steps[p].M + s * (theta[c] - theta[p]);
            }
            self.respond(omega, parts, steps);
            for (theta, step) in theta.iter_mut().zip(steps.iter()) {
                *theta = *theta + step.M;
            }
        }
        for (step, theta) in steps.iter_mut().zip(theta) {
            step.M = theta;
        }
    }
}

/// Share of the shaft's stiffness below which discs beyond it count as in tune: rounding of the torque over it, and it itself, leave
/// as many digits.
const IN_TUNE: f64 = 1e-8;

/// Corrections then: the first leaves that share where a torque acts on the disc in tune, which cancels in its amplitude, and each
/// further one multiplies what is left by about as much.
const CORRECTIONS: usize = 3;

/// Lanes of a row from a place on; past its end the last entry again.
#[inline(always)]
fn lanes<R: Real>(row: &[f64], first: usize, buffer: &mut [f64]) -> R {
    if first + R::LANES <= row.len() {
        return R::load(&row[first..]);
    }
    for (lane, to) in buffer[..R::LANES].iter_mut().enumerate() {
        *to = row[(first + lane).min(row.len() - 1)];
    }
    R::load(buffer)
}

/// Real parts and imaginary parts of a row, likewise.
#[inline(always)]
fn read<R: Real>(row: &[Complex64], first: usize) -> Z<R> {
    let (mut re, mut im) = ([0.0; LANES_MAX], [0.0; LANES_MAX]);
    if let Some(row) = row.get(first..first + R::LANES) {
        for lane in 0..R::LANES {
            (re[lane], im[lane]) = (row[lane].re, row[lane].im);
        }
    } else {
        for lane in 0..R::LANES {
            let z = row[(first + lane).min(row.len() - 1)];
            (re[lane], im[lane]) = (z.re, z.im);
        }
    }
    Z(R::load(&re), R::load(&im))
}

#[inline(always)]
fn write<R: Real>(z: Z<R>, row: &mut [Complex64], first: usize) {
    let (mut re, mut im) = ([0.0; LANES_MAX], [0.0; LANES_MAX]);
    z.0.store(&mut re);
    z.1.store(&mut im);
    if let Some(row) = row.get_mut(first..first + R::LANES) {
        for lane in 0..R::LANES {
            row[lane] = Complex64::new(re[lane], im[lane]);
        }
    } else {
        for ((to, re), im) in row[first..].iter_mut().zip(re).zip(im) {
            *to = Complex64::new(re, im);
        }
    }
}

/// Lanes of two of the widest registers.
const LANES_MAX: usize = 16;
