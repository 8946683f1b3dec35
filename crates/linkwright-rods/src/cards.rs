//! Position and load at the top of every section and at the pump, by the harmonics at the polished rod.

use crate::complex::Complex;
use crate::fourier::{Fourier, Room};
use crate::string::{Section, State};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;
use std::f64::consts::TAU;

/// Cards along a string.
pub struct Cards<R> {
    /// Position upward at each sample, a row a station: tops of sections, then the pump \[m\].
    pub position: Vec<R>,
    /// Tension beyond that at rest, likewise \[N\].
    pub load: Vec<R>,
    /// Work in a period that passes each station downward \[J\].
    pub work: Vec<R>,
    /// Heat of the damping of each section in a period \[J\].
    pub loss: Vec<R>,
}

/// The cards of a string whose top has the harmonics `top`, from the mean on; further ones are zero.
#[inline(always)]
pub fn cards<R: Real>(sections: &[Section<R>], period: R, top: &[State<R>], fourier: &Fourier) -> Cards<R> {
    let stations = sections.len() + 1;
    let none = Complex::splat(0.0, 0.0);
    // The harmonic at half the rate of sampling has no phase, and a velocity of zero.
    let count = top.len().min(fourier.harmonics() - 1);
    let mut waves = vec![vec![none; fourier.harmonics()]; 2 * stations];
    let mut work = vec![R::splat(0.0); stations];
    let mut loss = vec![R::splat(0.0); sections.len()];
    out_of_line!(R, {
        for (n, &state) in top[..count].iter().enumerate() {
            let omega = R::splat(TAU * n as f64) / period;
            let mut here = state;
            for station in 0..stations {
                waves[2 * station][n] = here.position;
                waves[2 * station + 1][n] = here.load;
                // ∮ F dy of a harmonic: amplitudes are twice the coefficients.
                let power = here.load * here.position.turned().conj();
                work[station] = work[station] + power.0 * omega * period * 2.0;
                if let Some(section) = sections.get(station) {
                    if n > 0 {
                        loss[station] = loss[station] + section.loss(omega, here) * period * 4.0;
                    }
                    here = section.at_harmonic(n, omega).below(here);
                }
            }
        }
    });
    let mut found = [vec![], vec![]];
    let mut room = Room::new(fourier.samples);
    let mut samples = vec![R::splat(0.0); fourier.samples];
    for (row, wave) in waves.iter().enumerate() {
        fourier.backward(wave, &mut room, &mut samples);
        found[row % 2].extend_from_slice(&samples);
    }
    let [position, load] = found;
    Cards { position, load, work, loss }
}

/// Harmonics of position and load at the polished rod, `count` of them with the mean.
pub fn top_of<R: Real>(position: &[R], load: &[R], count: usize, fourier: &Fourier) -> Vec<State<R>> {
    let mut room = Room::new(fourier.samples);
    let none = Complex::splat(0.0, 0.0);
    let [mut y, mut f] = [vec![none; fourier.harmonics()], vec![none; fourier.harmonics()]];
    fourier.forward(position, &mut room, &mut y);
    fourier.forward(load, &mut room, &mut f);
    y.iter().zip(&f).take(count).map(|(&position, &load)| State { position, load }).collect()
}
