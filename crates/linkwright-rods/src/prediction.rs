//! The periodic load of the pump under a given motion of the polished rod.
//!
//! The string is linear: a wave B = F − Zv that goes up from the pump comes back as W = F + Zv. Per harmonic, with the mobility
//! g = v/F at the lower end under a polished rod at rest and s the velocity there without a load,
//!
//! ```text
//! W = R (B + Zs) + Zs,    R = (1 + Zg)/(1 − Zg)
//! ```
//!
//! and the valves of the pump make B of W, instant by instant. Both are passive: |R| ≤ 1, and no two waves leave the pump further apart
//! than they came. With damping the sweep W → B → W therefore contracts to the one periodic motion, whatever the valves do and however
//! often the plunger turns back. Gas that collapses makes a jump of it, which a sweep moves: a share of the wave before settles that, as
//! Douglas and Rachford average. Where all delays are whole numbers of samples this is the method of characteristics.

use crate::complex::Complex;
use crate::fourier::{Fourier, Room};
use crate::pump::{Plunger, Pump};
use crate::string::{Section, State, Transfer, whole};
use linkwright_kernel::real::Real;
use std::f64::consts::TAU;

/// Share of the new wave in that of the next sweep.
const RELAXED: f64 = 0.8;

/// How a solution is sought.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// Change of the wave in a sweep at which the solution has converged, over the load of the fluid.
    pub tolerance: f64,
    /// Most sweeps.
    pub sweeps: usize,
}

/// The periodic motion of a string.
pub struct Prediction<R> {
    /// Harmonics at the polished rod, from the mean on.
    pub top: Vec<State<R>>,
    /// Load of the plunger at each sample, by its valves \[N\].
    pub load: Vec<R>,
    /// Its velocity upward \[m/s\].
    pub velocity: Vec<R>,
    /// The wave W that comes down \[N\], to start from.
    pub wave: Vec<R>,
    /// Sweeps that it took.
    pub sweeps: usize,
    /// Change of the wave in the last sweep, over the load of the fluid.
    pub change: f64,
}

/// The load of the pump for samples of the polished rod's position \[m, upward\] over a period; `start`: a wave to start from.
pub fn predict<R: Real>(
    sections: &[Section<R>],
    pump: &Pump<R>,
    period: R,
    motion: &[R],
    start: Option<&[R]>,
    request: Request,
    fourier: &Fourier,
) -> Prediction<R> {
    let n = fourier.samples;
    let mut room = Room::new(n);
    let mut position = vec![Complex::splat(0.0, 0.0); fourier.harmonics()];
    fourier.forward(motion, &mut room, &mut position);
    let string = Returns::new(sections, pump.impedance, period, &position);
    let mut sweep = Sweep {
        pump,
        fourier,
        room,
        step: period * (1.0 / n as f64),
        load: vec![R::splat(0.0); n],
        velocity: vec![R::splat(0.0); n],
        harmonics: vec![Complex::splat(0.0, 0.0); fourier.harmonics()],
        plunger: Plunger::at_rest(),
    };
    let mut wave = start.map_or_else(|| vec![pump.load * 0.5; n], <[R]>::to_vec);
    let (mut change, mut sweeps) = (f64::INFINITY, 0);
    let mut next = wave.clone();
    while sweeps < request.sweeps && change > request.tolerance {
        sweep.run(&string, &wave, &mut next);
        let largest = wave.iter().zip(&next).fold(R::splat(0.0), |most, (&a, &b)| most.max((a - b).abs()));
        change = (largest / pump.load).max_lane();
        for (wave, &next) in wave.iter_mut().zip(&next) {
            *wave = *wave + (next - *wave) * RELAXED;
        }
        sweeps += 1;
    }
    sweep.answer(&wave);
    let top = sweep.top(&string, period, &position);
    Prediction { top, load: sweep.load, velocity: sweep.velocity, wave, sweeps, change }
}

/// What the string makes of waves from the pump, per harmonic.
struct Returns<R> {
    matrices: Vec<Transfer<R>>,
    /// R.
    reflected: Vec<Complex<R>>,
    /// Zs (1 + R).
    sent: Vec<Complex<R>>,
}

impl<R: Real> Returns<R> {
    fn new(sections: &[Section<R>], impedance: R, period: R, position: &[Complex<R>]) -> Self {
        let count = position.len();
        let one = Complex::splat(1.0, 0.0);
        let mut found = Returns { matrices: vec![], reflected: vec![], sent: vec![] };
        for (n, &y) in position.iter().enumerate() {
            let omega = R::splat(TAU * n as f64) / period;
            let matrix = whole(sections, n, omega);
            // y and v of the plunger: y₀/m₂₂ + F m₁₂/m₂₂, since the determinant is one.
            let over = matrix.rows[1][1].recip().turned().times(omega * impedance);
            let mobility = matrix.rows[0][1] * over;
            let mut reflected = (one + mobility) * (one - mobility).recip();
            let mut sent = y * over * (one + reflected);
            if n + 1 == count {
                // Samples show of this harmonic but the real part.
                (reflected.1, sent) = (R::splat(0.0), Complex::splat(0.0, 0.0));
            }
            found.matrices.push(matrix);
            found.reflected.push(reflected);
            found.sent.push(sent);
        }
        found
    }
}

/// Samples and harmonics of a sweep.
struct Sweep<'a, R> {
    pump: &'a Pump<R>,
    fourier: &'a Fourier,
    room: Room<R>,
    step: R,
    load: Vec<R>,
    velocity: Vec<R>,
    harmonics: Vec<Complex<R>>,
    /// The plunger at the last sample of the sweep before.
    plunger: Plunger<R>,
}

impl<R: Real> Sweep<'_, R> {
    /// The answer of the valves to a wave.
    fn answer(&mut self, wave: &[R]) {
        for (i, &wave) in wave.iter().enumerate() {
            self.plunger = self.pump.step(&self.plunger, wave, self.step);
            self.load[i] = self.plunger.load;
            self.velocity[i] = self.plunger.velocity;
        }
    }

    /// The wave that comes down after `wave`.
    fn run(&mut self, string: &Returns<R>, wave: &[R], next: &mut [R]) {
        self.answer(wave);
        for ((next, &load), &wave) in next.iter_mut().zip(&self.load).zip(wave) {
            *next = load * 2.0 - wave;
        }
        self.fourier.forward(next, &mut self.room, &mut self.harmonics);
        for (n, harmonic) in self.harmonics.iter_mut().enumerate() {
            *harmonic = string.reflected[n] * *harmonic + string.sent[n];
        }
        self.fourier.backward(&self.harmonics, &mut self.room, next);
    }

    /// Harmonics at the polished rod by those of load and velocity of the plunger: F₀ = m₁₁ F − m₂₁ y, which holds where the
    /// string is in resonance, too.
    fn top(&mut self, string: &Returns<R>, period: R, position: &[Complex<R>]) -> Vec<State<R>> {
        self.fourier.forward(&self.load, &mut self.room, &mut self.harmonics);
        let mut velocity = self.harmonics.clone();
        self.fourier.forward(&self.velocity, &mut self.room, &mut velocity);
        let state = |(n, &position): (usize, _)| {
            let [[own, _], [from_position, _]] = string.matrices[n].rows;
            let load = self.harmonics[n];
            if n == 0 {
                return State { position, load };
            }
            let plunger = (velocity[n].turned() * -1.0).times(period * (1.0 / (TAU * n as f64)));
            State { position, load: own * load - from_position * plunger }
        };
        position.iter().enumerate().map(state).collect()
    }
}
