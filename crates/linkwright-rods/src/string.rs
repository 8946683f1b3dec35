//! A string of sucker rods at a frequency.
//!
//! With y the displacement of a section upward, x its depth, F its tension beyond that at rest,
//!
//! ```text
//! y_tt = a² y_xx − c y_t,    F = −EA y_x,    a² = EA/μ,    k² = (ω² − icω)/a²
//!
//! | y |         |  cos kL       −sin kL/(EAk) | | y |
//! | F | below = |  EAk sin kL    cos kL       | | F | above
//! ```
//!
//! and for the mean y falls by FL/(EA). Source: Gibbs, "Predicting the Behavior of Sucker-Rod Pumping Systems", *J. Pet. Tech.* 15
//! (1963) 769.

use crate::complex::{Complex, exp};
use linkwright_kernel::real::Real;

/// A section of one kind of rod.
#[derive(Clone, Copy, Debug)]
pub struct Section<R> {
    /// EA \[N\].
    pub rigidity: R,
    /// μ, with couplings \[kg/m\].
    pub mass: R,
    /// c \[1/s\].
    pub damping: R,
    /// L \[m\].
    pub length: R,
}

/// y and F of a harmonic.
#[derive(Clone, Copy, Debug)]
pub struct State<R> {
    /// Displacement upward \[m\].
    pub position: Complex<R>,
    /// Tension beyond that at rest \[N\].
    pub load: Complex<R>,
}

/// From y and F at one depth to those at another; its determinant is one.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<R> {
    /// A row for y, a row for F.
    pub rows: [[Complex<R>; 2]; 2],
}

impl<R: Real> Transfer<R> {
    /// y and F below, from those above.
    #[inline(always)]
    pub fn below(&self, above: State<R>) -> State<R> {
        let [[a, b], [c, d]] = self.rows;
        let State { position: y, load: f } = above;
        State { position: a * y + b * f, load: c * y + d * f }
    }

    /// First `above`, then this one.
    #[inline(always)]
    fn after(&self, above: &Self) -> Self {
        let [[a, b], [c, d]] = above.rows;
        let first = self.below(State { position: a, load: c });
        let second = self.below(State { position: b, load: d });
        Transfer { rows: [[first.position, second.position], [first.load, second.load]] }
    }
}

impl<R: Real> Section<R> {
    /// √(EAμ), what a wave has as force per velocity \[N s/m\].
    #[inline(always)]
    pub fn impedance(&self) -> R {
        (self.rigidity * self.mass).sqrt()
    }

    /// k at a frequency \[1/m\].
    #[inline(always)]
    fn wave_number(&self, omega: R) -> Complex<R> {
        let slowness = (self.mass / self.rigidity).sqrt();
        // (ω² − icω)^½, of which the real part is the larger: no digits cancel.
        let size = omega * (omega.squared() + self.damping.squared()).sqrt();
        let real = ((size + omega.squared()) * 0.5).sqrt();
        Complex(real * slowness, -(self.damping * omega / real * 0.5 * slowness))
    }

    /// The section at a frequency above zero.
    #[inline(always)]
    pub fn transfer(&self, omega: R) -> Transfer<R> {
        let k = self.wave_number(omega);
        let (cos, sin) = k.times(self.length).cos_sin();
        let stiffness = k.times(self.rigidity);
        let down = (sin * stiffness.recip()) * -1.0;
        Transfer { rows: [[cos, down], [sin * stiffness, cos]] }
    }

    /// The section at rest.
    #[inline(always)]
    pub fn at_rest(&self) -> Transfer<R> {
        let [one, zero] = [Complex::splat(1.0, 0.0), Complex::splat(0.0, 0.0)];
        let stretch = Complex(-(self.length / self.rigidity), R::splat(0.0));
        Transfer { rows: [[one, stretch], [zero, one]] }
    }

    /// The section at harmonic `n` of a motion.
    #[inline(always)]
    pub fn at_harmonic(&self, n: usize, omega: R) -> Transfer<R> {
        if n == 0 { self.at_rest() } else { self.transfer(omega) }
    }

    /// Mean power of the damping at a frequency, of amplitudes y and F at its top \[W\]: ½cμω² ∫|y|² dx.
    ///
    /// y = α exp(ikx) + β exp(−ikx), of which the square is integrated in closed form.
    #[inline(always)]
    pub fn loss(&self, omega: R, top: State<R>) -> R {
        let k = self.wave_number(omega);
        let slope = (top.load * k.times(self.rigidity).recip()) * -1.0;
        let [alpha, beta] = [(top.position - slope.turned()) * 0.5, (top.position + slope.turned()) * 0.5];
        let (decay, phase) = (k.1 * self.length * 2.0, k.0 * self.length);
        let falling = mean_of_exponential(-decay);
        let rising = mean_of_exponential(decay);
        let (sin, cos) = phase.sin_cos();
        // ∫ exp(2i Re(k) x) dx over L = exp(i Re(k) L) sin(Re(k) L)/(Re(k) L).
        let cross = (alpha * beta.conj() * Complex(cos, sin)).0 * (sin / phase) * 2.0;
        let square = alpha.norm() * falling + beta.norm() * rising + cross;
        self.damping * self.mass * omega.squared() * square * self.length * 0.5
    }
}

/// (eᶻ − 1)/z, of which the digits cancel for small z: there its series.
#[inline(always)]
fn mean_of_exponential<R: Real>(z: R) -> R {
    let series = ((z * (1.0 / 24.0) + 1.0 / 6.0) * z + 0.5) * z + 1.0;
    let away = z.abs().select_lt(R::splat(1e-3), R::splat(1.0), z);
    z.abs().select_lt(R::splat(1e-3), series, (exp(z) - R::splat(1.0)) / away)
}

/// All sections of a string at harmonic `n`.
#[inline(always)]
pub fn whole<R: Real>(sections: &[Section<R>], n: usize, omega: R) -> Transfer<R> {
    let mut all = sections[0].at_harmonic(n, omega);
    for section in &sections[1..] {
        all = section.at_harmonic(n, omega).after(&all);
    }
    all
}
