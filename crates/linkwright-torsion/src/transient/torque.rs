//! Torques on a mass from outside: products of a law of speed or time, a shape over the angle, and a weight over time.
//!
//! ```text
//! M = s · w(t) · g(ω, t) · f(pθ + β)        ω, θ of the part, n times those of its mass
//! ```
//!
//! A part behind rigid gears turns n times as fast as the mass that it belongs to, and its torque counts n times there.

use super::curve::Curve;
use super::periodic::Periodic;

/// Share of the speed of reference below which a law that is steep at rest goes through zero instead of jumping there.
const AT_REST: f64 = 1e-3;

/// How a torque depends on the speed of its part, or on time.
#[derive(Clone, Copy, Debug)]
pub enum Law {
    /// Not at all.
    Constant,
    /// |ω/ω₀|ᵖ, the same in both senses.
    Even { inverse_speed: f64, exponent: f64 },
    /// ω/ω₀ |ω/ω₀|ᵖ⁻¹, with the sign of the speed.
    Odd { inverse_speed: f64, exponent: f64 },
    /// A curve over speed.
    OverSpeed { curve: usize },
    /// gain · (speed wanted at the time − ω).
    Following { gain: f64, curve: usize },
    /// e^{−a(t − t₀)} sin(Ω(t − t₀) + γ) from t₀ on.
    Decaying { from: f64, until: f64, rate: f64, omega: f64, phase: f64 },
}

impl Law {
    /// The curve that it follows, if any.
    pub fn curve(&self) -> Option<usize> {
        match *self {
            Law::OverSpeed { curve } | Law::Following { curve, .. } => Some(curve),
            _ => None,
        }
    }
}

/// A function of the angle.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    pub table: usize,
    /// Angle of the table over that of the mass.
    pub pitch: f64,
    pub phase: f64,
}

/// A torque on a mass.
#[derive(Clone, Copy, Debug)]
pub struct Torque {
    pub mass: usize,
    /// Speed of the part over that of the mass.
    pub ratio: f64,
    pub scale: f64,
    pub law: Law,
    /// Curve over time.
    pub weight: Option<usize>,
    pub shape: Option<Shape>,
}

/// Curves over time on the stretch between two of their points, where each is one smooth piece.
#[derive(Clone, Debug, Default)]
pub struct Stretch {
    pieces: Vec<usize>,
    pub middle: f64,
}

impl Stretch {
    /// The stretch about a time.
    pub fn about(&mut self, curves: &[Curve], middle: f64) {
        self.pieces.clear();
        self.pieces.extend(curves.iter().map(|curve| curve.piece(middle)));
        self.middle = middle;
    }

    /// A curve over time, on from this stretch beyond its ends.
    #[inline(always)]
    pub fn at(&self, curves: &[Curve], curve: usize, t: f64) -> f64 {
        curves[curve].of_piece(self.pieces[curve], t).0
    }
}

/// A torque at its mass, and how it changes with the mass's angle and speed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pull {
    pub torque: f64,
    pub by_angle: f64,
    pub by_speed: f64,
}

impl Torque {
    /// At a time, angle and speed of its mass.
    #[inline(always)]
    pub fn at(
        &self,
        (tables, curves, stretch): (&[Periodic], &[Curve], &Stretch),
        (t, theta, omega): (f64, f64, f64),
    ) -> Pull {
        let mut size = self.scale * self.ratio;
        if let Some(weight) = self.weight {
            size *= stretch.at(curves, weight, t);
        }
        let (law, slope) = match self.law {
            Law::Constant => (1.0, 0.0),
            Law::Even { inverse_speed, exponent } => even(omega * self.ratio, inverse_speed, exponent),
            Law::Odd { inverse_speed, exponent } => odd(omega * self.ratio, inverse_speed, exponent),
            Law::OverSpeed { curve } => curves[curve].at(omega * self.ratio),
            Law::Following { gain, curve } => {
                (gain * (stretch.at(curves, curve, t) - omega * self.ratio), -gain)
            }
            Law::Decaying { from, until, rate, omega, phase } => {
                let on = from < stretch.middle && stretch.middle < until;
                let since = t - from;
                (if on { (-rate * since).exp() * (omega * since + phase).sin() } else { 0.0 }, 0.0)
            }
        };
        let slope = slope * self.ratio;
        let Some(shape) = self.shape else {
            return Pull { torque: size * law, by_angle: 0.0, by_speed: size * slope };
        };
        let [value, d1] = tables[shape.table].value_and_slope(shape.pitch * theta + shape.phase);
        Pull {
            torque: size * law * value,
            by_angle: size * law * d1 * shape.pitch,
            by_speed: size * slope * value,
        }
    }

    /// Times at which it jumps or bends.
    pub fn marks<'a>(&'a self, curves: &'a [Curve]) -> impl Iterator<Item = f64> + 'a {
        let over_time = match self.law {
            Law::Following { curve, .. } => Some(curve),
            _ => None,
        };
        let switched = match self.law {
            Law::Decaying { from, until, .. } => [from, until],
            _ => [f64::INFINITY; 2],
        };
        let curves = self.weight.into_iter().chain(over_time).map(|curve| curves[curve].knots());
        curves.flatten().copied().chain(switched)
    }
}

/// |u|ᵖ and its slope; below zero p is held near rest.
#[inline(always)]
fn even(omega: f64, inverse_speed: f64, exponent: f64) -> (f64, f64) {
    let u = omega * inverse_speed;
    if exponent < 0.0 {
        let value = power(softened(u), 0.25 * exponent);
        return (value, exponent * value * u.powi(3) / (u.powi(4) + AT_REST.powi(4)) * inverse_speed);
    }
    let size = u.abs();
    (power(size, exponent), u.signum() * exponent * power(size, exponent - 1.0) * inverse_speed)
}

/// u|u|ᵖ⁻¹ and its slope; below one p goes through zero near rest.
#[inline(always)]
fn odd(omega: f64, inverse_speed: f64, exponent: f64) -> (f64, f64) {
    let u = omega * inverse_speed;
    if exponent >= 1.0 {
        let factor = power(u.abs(), exponent - 1.0);
        return (u * factor, exponent * factor * inverse_speed);
    }
    let factor = power(softened(u), 0.25 * (exponent - 1.0));
    let slope = factor * (1.0 + (exponent - 1.0) * u.powi(4) / (u.powi(4) + AT_REST.powi(4)));
    (u * factor, slope * inverse_speed)
}

/// u⁴ that does not vanish at rest, and is 1 at 1. The fourth power is u⁴ to 1e-8 already at a tenth of the speed of reference.
fn softened(u: f64) -> f64 {
    (u.powi(4) + AT_REST.powi(4)) / (1.0 + AT_REST.powi(4))
}

/// A power, without the general one where the exponent is a usual one; 0⁻ˣ counts as zero, it is only met times zero.
#[inline(always)]
fn power(base: f64, exponent: f64) -> f64 {
    match exponent {
        0.0 => 1.0,
        0.5 => base.sqrt(),
        0.25 => base.sqrt().sqrt(),
        -0.25 => 1.0 / base.sqrt().sqrt(),
        1.0 => base,
        2.0 => base * base,
        -1.0 if base != 0.0 => 1.0 / base,
        _ if base == 0.0 && exponent < 0.0 => 0.0,
        _ => base.powf(exponent),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values at the speed of reference and at others, and slopes against differences.
    #[test]
    fn laws_over_speed() {
        let step = 1e-6;
        for exponent in [-1.0, 0.0, 0.7, 1.0, 1.5, 2.0, 3.0] {
            for law in [even, odd] {
                assert!((law(50.0, 0.02, exponent).0 - 1.0).abs() < 1e-15, "1 at the speed of reference");
                for omega in [-30.0, 0.02, 7.0, 90.0] {
                    let (a, b) = (law(omega - step, 0.02, exponent).0, law(omega + step, 0.02, exponent).0);
                    let slope = law(omega, 0.02, exponent).1;
                    // Differences err by step² and by rounding over the step.
                    let off = (b - a) / (2.0 * step) - slope;
                    assert!(off.abs() < 1e-6 * slope.abs().max(1e-2), "p = {exponent}, ω = {omega}: {off:e}");
                }
            }
            let (there, back) = (odd(25.0, 0.02, exponent).0, odd(-25.0, 0.02, exponent).0);
            assert_eq!(there, -back, "odd");
            assert_eq!(even(25.0, 0.02, exponent).0, even(-25.0, 0.02, exponent).0, "even");
            // At half the speed the softening counts (ε/u)⁴(p − 1)/4, at most 8e-12.
            assert!((there / 0.5_f64.powf(exponent) - 1.0).abs() < 1e-11, "half the speed, p = {exponent}");
        }
        assert_eq!(
            [odd(0.0, 0.02, 0.0).0, odd(0.0, 0.02, -1.0).0, odd(0.0, 0.02, 2.0).0],
            [0.0; 3],
            "at rest"
        );
    }
}
