//! Load of the plunger by its valves, from one instant to the next.
//!
//! A wave W = F + Zv comes down the rods, with F the load of the plunger, v its velocity upward and Z the impedance of the lowest
//! section. The valves answer with F:
//!
//! ```text
//! standing valve open     F = F₀    the barrel fills
//! travelling valve open   F = 0     the plunger sinks through the liquid
//! both shut               the liquid under the plunger holds it: v = κF', with the compliance κ of tubing that is not anchored and
//!                         of the liquid; gas in the barrel of length ℓ at intake pressure: ℓ (G/(D − F))^{1/n}, D and G the
//!                         discharge and intake pressure on the plunger
//! ```
//!
//! With κ = 0 and a full barrel that is F = min(max(W, 0), F₀) at any instant, without an error of a step. Else the balance of
//! volume over a step weights both its ends as the exponential of a step does, which is exact for tubing under a wave of constant
//! slope.

use crate::complex::exp;
use linkwright_kernel::real::Real;

/// Rounds of Newton's method for gas, and the largest change of the logarithm of its pressure in one.
const ROUNDS: usize = 30;
const LARGEST: f64 = 3.0;

/// Step of Newton's method, as a share of the load, after which its solution is exact to rounding.
const NEAR: f64 = 1e-9;

/// Exponent of gas below which it has no pressure.
const SMALL: f64 = 1e-14;

/// A pump with its valves.
#[derive(Clone, Copy, Debug)]
pub struct Pump<R> {
    /// F₀, load of the fluid \[N\].
    pub load: R,
    /// Z, impedance of the lowest section \[N s/m\].
    pub impedance: R,
    /// Compliance of the tubing \[m/N\]; 0 where it is anchored.
    pub compliance: R,
    /// Compliance of a metre of liquid in the barrel, 1/(KA) \[1/N\].
    pub compressibility: R,
    /// Velocity by which the plunger slips through the liquid under its full load \[m/s\].
    pub slip: R,
    /// Share of the volume that the barrel takes in which is liquid.
    pub fillage: R,
    /// D, discharge pressure on the area of the plunger \[N\].
    pub discharge: R,
    /// 1/n of the gas in the barrel; 0: gas without pressure, which collapses where the plunger meets the liquid.
    pub softness: R,
}

/// Load and velocity of the plunger, and what is under it.
#[derive(Clone, Copy, Debug)]
pub struct Plunger<R> {
    /// F \[N\].
    pub load: R,
    /// v, upward \[m/s\].
    pub velocity: R,
    /// ℓ, length of the gas in the barrel at intake pressure \[m\].
    pub gas: R,
    /// Length of the liquid in the barrel \[m\].
    pub liquid: R,
}

impl<R: Real> Plunger<R> {
    /// At rest without load.
    pub fn at_rest() -> Self {
        let zero = R::splat(0.0);
        Plunger { load: zero, velocity: zero, gas: zero, liquid: zero }
    }
}

impl<R: Real> Pump<R> {
    /// The plunger after a step, when the wave W has come down.
    #[inline(always)]
    pub fn step(&self, before: &Plunger<R>, wave: R, step: R) -> Plunger<R> {
        let (zero, full) = (R::splat(0.0), self.load);
        let balance = self.balance(before, wave, step);
        let shut = self.shut(before, &balance);
        let open = (wave - full) / self.impedance - self.slip;
        let taken = (before.velocity.max(zero) + open.max(zero)) * (step * 0.5);
        let filled = before.gas + (R::splat(1.0) - self.fillage) * taken;
        let falls = (before.velocity.min(zero) + open.min(zero)) * (step * 0.5);
        let left = before.gas + falls;
        // Gas without pressure: full load until the plunger meets the liquid, for a share of the step.
        let collapses = self.softness.select_lt(R::splat(SMALL), before.gas, zero);
        let share = (before.gas / zero.select_lt(-falls, -falls, R::splat(1.0))).min(R::splat(1.0));
        let is_up = shut.select_lt(full, zero, R::splat(1.0));
        let met = full * share + shut * (R::splat(1.0) - share);
        let load = zero.select_lt(collapses, zero.select_lt(left, full, met), shut);
        let load = zero.select_lt(is_up, full, load);
        let sunk = zero.select_lt(collapses, left.max(zero), before.gas);
        let gas = zero.select_lt(is_up, filled, zero.select_lt(load, sunk, zero));
        let full_of = before.liquid + self.fillage * taken;
        let liquid = zero.select_lt(is_up, full_of, zero.select_lt(load, before.liquid, zero));
        Plunger { load, velocity: (wave - load) / self.impedance, gas, liquid }
    }

    /// Load with both valves shut, within what opens them.
    #[inline(always)]
    fn shut(&self, before: &Plunger<R>, balance: &Balance<R>) -> R {
        let (zero, full, most) = (R::splat(0.0), self.load, R::splat(LARGEST));
        let mut load = before.load;
        // Without gas the balance is linear; with gas it is nearly so in the logarithm of its pressure.
        let has_gas = balance.soft.max_lane() > 0.0;
        for _ in 0..if has_gas { ROUNDS } else { 1 } {
            let (excess, slope) = balance.at(self, before, load);
            let step = excess / slope;
            let mut next = load - step;
            if has_gas {
                let under = self.under(load);
                let grown = exp((step / under).min(most).max(-most));
                next = zero.select_lt(balance.soft, self.discharge - under * grown, next);
            }
            let next = next.max(zero).min(full);
            let moved = (next - load).abs();
            load = next;
            // The next step would be the square of this one.
            if (moved - full * NEAR).max_lane() <= 0.0 {
                break;
            }
        }
        load
    }

    #[inline(always)]
    fn balance(&self, before: &Plunger<R>, wave: R, step: R) -> Balance<R> {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let soft = zero.select_lt(self.softness, before.gas, zero);
        let under = self.under(before.load);
        // How far the plunger gives way a newton, over a step a newton of the wave: ∞ of a rigid column counts as 1e4.
        let compliance = self.compliance + self.compressibility * before.liquid;
        let give = compliance + soft * self.softness * self.relative(under) / under;
        let z = (step / (self.impedance * give.max(step * 1e-4 / self.impedance))).max(R::splat(1e-6));
        let weight =
            z.select_lt(R::splat(1e-2), z * (1.0 / 12.0) + 0.5, (one - faded(z)).recip() - z.recip());
        let weight = z.select_lt(R::splat(9.9e3), weight, one);
        // What moved while a valve was open is not held.
        let held = zero.select_lt(before.load, before.velocity, before.velocity.max(zero));
        let held = before.load.select_lt(self.load, held, held.min(zero));
        let slip = self.slip / self.load;
        let start = (held - slip * before.load) * (one - weight);
        Balance { wave, step, weight, start, slip, soft, compliance, length: soft * self.relative(under) }
    }

    /// Pressure under the plunger on its area, at a load \[N\].
    #[inline(always)]
    fn under(&self, load: R) -> R {
        self.discharge - load
    }

    /// Length of gas over that at intake pressure.
    #[inline(always)]
    fn relative(&self, under: R) -> R {
        let zero = R::splat(0.0);
        if self.softness.max_lane() <= 0.0 {
            return zero;
        }
        let ratio = (self.discharge - self.load) / under;
        zero.select_lt(self.softness, exp(ratio.ln() * self.softness), zero)
    }
}

/// exp(−z); beyond 40 nothing is left beside 1.
#[inline(always)]
fn faded<R: Real>(z: R) -> R {
    if (-z).max_lane() < -40.0 { R::splat(0.0) } else { exp(-z.min(R::splat(40.0))) }
}

/// The volume under the plunger over a step, with both valves shut.
struct Balance<R> {
    wave: R,
    step: R,
    /// Weight of the end of the step.
    weight: R,
    start: R,
    slip: R,
    /// Gas that is compressed, at intake pressure \[m\].
    soft: R,
    /// κ \[m/N\].
    compliance: R,
    /// The length that it had \[m\].
    length: R,
}

impl<R: Real> Balance<R> {
    /// By what the volume grows beyond what the plunger makes room for, and its derivative by the load.
    #[inline(always)]
    fn at(&self, pump: &Pump<R>, before: &Plunger<R>, load: R) -> (R, R) {
        let under = pump.under(load);
        let length = self.soft * pump.relative(under);
        let velocity = (self.wave - load) / pump.impedance - self.slip * load;
        let grown = length - self.length + self.compliance * (load - before.load);
        let excess = grown - self.step * (self.start + self.weight * velocity);
        let zero = R::splat(0.0);
        let soft = zero.select_lt(self.soft, length * pump.softness / under, zero);
        let rate = self.step * self.weight * (pump.impedance.recip() + self.slip);
        (excess, soft + self.compliance + rate)
    }
}
