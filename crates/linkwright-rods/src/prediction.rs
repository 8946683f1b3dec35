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
//! often the plunger turns back; the last sweeps combined need fewer of them ([`crate::mixing`]).
//!
//! Between samples B is straight. Its harmonics are those of its samples, again and again, times sinc²(k/n), and the samples of what comes
//! back are exact: no corner or jump of the load rings, wherever its echo arrives. Where all delays are whole numbers of samples this is
//! the method of characteristics.

use crate::complex::Complex;
use crate::fourier::{Fourier, Room};
use crate::mixing::Mixing;
use crate::pump::{Plunger, Pump};
use crate::string::{Section, State, Transfer, whole};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;
use std::f64::consts::{PI, TAU};

/// How often the harmonics of samples are repeated; beyond, little of a straight line is left.
const REPEATED: usize = 2;

/// Change of the wave over the load of the fluid at which a solution of fewer samples is good enough to start from.
const COARSE: f64 = 1e-3;

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
    /// Harmonics at the polished rod, from the mean on: as many as there are samples.
    pub top: Vec<State<R>>,
    /// The wave W that comes down \[N\], to start from.
    pub wave: Vec<R>,
    /// Mean load of the plunger by its valves \[N\].
    pub mean_load: R,
    /// Sweeps that it took.
    pub sweeps: usize,
    /// Change of the wave in the last sweep, over the load of the fluid.
    pub change: R,
}

/// The load of the pump for samples of the polished rod's position \[m, upward\] over a period.
///
/// `grids`: transforms of fewer samples, on which the solution begins, and of all; `start`: a wave to start from in place of that;
/// `measure`: the change from a wave to the next, for a load of the fluid.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a string, its pump, its motion, and how it is solved")]
pub fn predict<R: Real>(
    sections: &[Section<R>],
    pump: &Pump<R>,
    period: R,
    motion: &[R],
    start: Option<&[R]>,
    request: Request,
    grids: [&Fourier; 2],
    measure: impl Fn(&[R], &[R], R) -> R,
) -> Prediction<R> {
    let [coarse, fine] = grids;
    let n = fine.samples;
    let mut room = Room::new(n);
    let mut position = vec![Complex::splat(0.0, 0.0); fine.harmonics()];
    fine.forward(motion, &mut room, &mut position);
    let string = Returns::new(sections, pump.impedance, period, &position, n);
    let wave = start.map_or_else(
        || {
            let begun = Request { tolerance: COARSE.max(request.tolerance), ..request };
            let first = vec![pump.load * 0.5; coarse.samples];
            refined(&Sweep::new(pump, coarse, period, &string).settled(first, begun, &measure).wave, n)
        },
        <[R]>::to_vec,
    );
    let mut sweep = Sweep::new(pump, fine, period, &string);
    let Settled { wave, sweeps, change } = sweep.settled(wave, request, &measure);
    let top = sweep.top(&position);
    let mean_load = sweep.mean_load(&wave);
    Prediction { top, wave, mean_load, sweeps, change }
}

/// A wave of fewer samples as one of n, straight between them.
#[inline(always)]
fn refined<R: Real>(wave: &[R], n: usize) -> Vec<R> {
    let times = n / wave.len();
    out_of_line!(R, {
        let mut fine = Vec::with_capacity(n);
        for i in 0..n {
            let (here, next) = (wave[i / times], wave[(i / times + 1) % wave.len()]);
            fine.push(here + (next - here) * ((i % times) as f64 / times as f64));
        }
        fine
    })
}

/// By how much two waves differ at most.
#[inline(always)]
pub fn largest_change<R: Real>(wave: &[R], next: &[R]) -> R {
    out_of_line!(R, {
        let mut most = R::splat(0.0);
        for (&a, &b) in wave.iter().zip(next) {
            most = most.max((a - b).abs());
        }
        most
    })
}

/// What the string makes of waves from the pump, per harmonic.
struct Returns<R> {
    /// From the polished rod to the pump, and R.
    matrices: Vec<Transfer<R>>,
    exact: Vec<Complex<R>>,
    /// Zs (1 + R).
    sent: Vec<Complex<R>>,
}

impl<R: Real> Returns<R> {
    #[inline(always)]
    fn new(sections: &[Section<R>], impedance: R, period: R, position: &[Complex<R>], n: usize) -> Self {
        out_of_line!(R, {
            let one = Complex::splat(1.0, 0.0);
            let (mut matrices, mut exact, mut sent) = (vec![], vec![], vec![]);
            for k in 0..=n / 2 + REPEATED * n {
                let omega = R::splat(TAU * k as f64) / period;
                let matrix = whole(sections, k, omega);
                // y and v of the plunger: y₀/m₂₂ + F m₁₂/m₂₂, since the determinant is one.
                let over = matrix.rows[1][1].recip().turned().times(omega * impedance);
                let mobility = matrix.rows[0][1] * over;
                let reflected = (one + mobility) * (one - mobility).recip();
                exact.push(reflected);
                if k < n {
                    matrices.push(matrix);
                }
                match position.get(k) {
                    Some(&y) if 2 * k < n => sent.push(y * over * (one + reflected)),
                    _ => sent.push(Complex::splat(0.0, 0.0)),
                }
            }
            Returns { matrices, exact, sent }
        })
    }
}

/// Share of a harmonic of samples that lines between them have: sinc²(k/n).
#[inline(always)]
fn share(k: usize, n: usize) -> f64 {
    if k == 0 {
        return 1.0;
    }
    let x = PI * k as f64 / n as f64;
    (x.sin() / x).powi(2)
}

/// R of harmonic k of waves that are straight between n samples: over all harmonics that have the same samples.
#[inline(always)]
fn straight<R: Real>(exact: &[Complex<R>], k: usize, n: usize) -> Complex<R> {
    let (mut sum, mut rest) = (exact[k] * share(k, n), 1.0 - share(k, n));
    for repeat in 1..=REPEATED {
        let (above, below) = (repeat * n + k, repeat * n - k);
        rest -= share(above, n) + share(below, n);
        // All shares are one. Where waves are so short, damping no longer depends on their length: the last two stand for the rest.
        let more = if repeat == REPEATED { 0.5 * rest } else { 0.0 };
        sum = sum + exact[above] * (share(above, n) + more) + exact[below].conj() * (share(below, n) + more);
    }
    sum
}

/// Samples and harmonics of a sweep.
struct Sweep<'a, R> {
    pump: &'a Pump<R>,
    fourier: &'a Fourier,
    string: &'a Returns<R>,
    period: R,
    /// R of waves that are straight between samples.
    reflected: Vec<Complex<R>>,
    room: Room<R>,
    /// B.
    up: Vec<R>,
    /// Its harmonics.
    harmonics: Vec<Complex<R>>,
    /// The plunger at the last sample of the sweep before.
    plunger: Plunger<R>,
}

/// The end of sweeps.
struct Settled<R> {
    wave: Vec<R>,
    sweeps: usize,
    change: R,
}

impl<'a, R: Real> Sweep<'a, R> {
    #[inline(always)]
    fn new(pump: &'a Pump<R>, fourier: &'a Fourier, period: R, string: &'a Returns<R>) -> Self {
        out_of_line!(R, {
            let n = fourier.samples;
            let mut reflected = Vec::with_capacity(fourier.harmonics());
            for k in 0..fourier.harmonics() {
                reflected.push(straight(&string.exact, k, n));
            }
            Sweep {
                pump,
                fourier,
                string,
                period,
                reflected,
                room: Room::new(n),
                up: vec![R::splat(0.0); n],
                harmonics: vec![Complex::splat(0.0, 0.0); fourier.harmonics()],
                plunger: Plunger::at_rest(),
            }
        })
    }

    /// Sweeps from a wave to the one that comes again.
    #[inline(always)]
    fn settled(
        &mut self,
        mut wave: Vec<R>,
        request: Request,
        measure: &impl Fn(&[R], &[R], R) -> R,
    ) -> Settled<R> {
        let mut next = wave.clone();
        let mut mixing = Mixing::new(wave.len());
        let (mut change, mut sweeps) = (R::splat(f64::INFINITY), 0);
        while sweeps < request.sweeps {
            self.run(&wave, &mut next);
            sweeps += 1;
            change = measure(&wave, &next, self.pump.load);
            if change.max_lane() <= request.tolerance {
                break;
            }
            mixing.advance(&mut wave, &mut next);
        }
        Settled { wave, sweeps, change }
    }

    /// The wave that comes down after `wave`.
    #[inline(always)]
    fn run(&mut self, wave: &[R], next: &mut [R]) {
        out_of_line!(R, {
            let step = self.period * (1.0 / wave.len() as f64);
            for (up, &wave) in self.up.iter_mut().zip(wave) {
                self.plunger = self.pump.step(&self.plunger, wave, step);
                *up = self.plunger.load * 2.0 - wave;
            }
        });
        self.fourier.forward(&self.up, &mut self.room, &mut self.harmonics);
        out_of_line!(R, {
            let last = self.harmonics.len() - 1;
            for (n, to) in self.room.harmonics.iter_mut().enumerate() {
                // The harmonic at half the rate of sampling has no phase.
                let sent = if n < last { self.string.sent[n] } else { Complex::splat(0.0, 0.0) };
                *to = self.reflected[n] * self.harmonics[n] + sent;
            }
        });
        let harmonics = std::mem::take(&mut self.room.harmonics);
        self.fourier.backward(&harmonics, &mut self.room, next);
        self.room.harmonics = harmonics;
    }

    /// Mean of the load, (W + B)/2.
    #[inline(always)]
    fn mean_load(&self, wave: &[R]) -> R {
        out_of_line!(R, {
            let mut sum = R::splat(0.0);
            for (&down, &up) in wave.iter().zip(&self.up) {
                sum = sum + down + up;
            }
            sum * (0.5 / wave.len() as f64)
        })
    }

    /// Harmonics at the polished rod by those of load and velocity of the plunger: F₀ = m₁₁ F − m₂₁ y, which holds where the
    /// string is in resonance, too.
    #[inline(always)]
    fn top(&mut self, position: &[Complex<R>]) -> Vec<State<R>> {
        out_of_line!(R, {
            let n = self.fourier.samples;
            let mut states = Vec::with_capacity(n);
            for (k, matrix) in self.string.matrices.iter().enumerate() {
                let [[own, _], [from_position, _]] = matrix.rows;
                let samples = if 2 * k <= n { self.harmonics[k] } else { self.harmonics[n - k].conj() };
                let up = samples * share(k, n);
                let down = self.string.exact[k] * up + self.string.sent[k];
                let load = (down + up) * 0.5;
                if k == 0 {
                    states.push(State { position: position[0], load });
                    continue;
                }
                let none = Complex::splat(0.0, 0.0);
                let position = if 2 * k < n { position[k] } else { none };
                let velocity = (down - up).times((self.pump.impedance * 2.0).recip());
                let plunger = (velocity.turned() * -1.0).times(self.period * (1.0 / (TAU * k as f64)));
                states.push(State { position, load: own * load - from_position * plunger });
            }
            states
        })
    }
}
