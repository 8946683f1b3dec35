//! Measures of a turn: extremes of speed and acceleration, evenness, work, and torque of the motor.
//!
//! Extremes are found inside the steps, not at their ends: the largest sample's parabola gives the place,
//! and the energy equation is solved on to that place with full accuracy ([`Machine::advance`]).
//!
//! Source of δ, H, k_p: paper 1, equations (13)–(15).

use crate::cycle::{Machine, Row, Turn};
use crate::gauss::{B, C, S};
use crate::linkage::Motion;
use crate::plane::Angle;
use crate::real::Real;

/// The machine at one angle of its motion.
#[derive(Clone, Copy, Debug)]
pub struct State<R> {
    /// Speed of the crank \[rad/s\].
    pub omega: R,
    /// Acceleration of the crank \[rad/s²\].
    pub epsilon: R,
    /// Torque of the motor at its own shaft \[N m\].
    pub motor_torque: R,
    /// Torque of the motor at the crank, through the gearbox \[N m\].
    pub drive_torque: R,
    /// Resisting torque at the crank \[N m\].
    pub load_torque: R,
    /// Reduced inertia \[kg m²\].
    pub J: R,
}

/// An extreme and the crank angle where it is.
#[derive(Clone, Copy, Debug)]
pub struct Extreme<R> {
    /// The value.
    pub value: R,
    /// Crank angle \[rad\].
    pub phi: R,
}

/// Speed and acceleration extremes of a turn.
#[derive(Clone, Copy, Debug)]
pub struct Extremes<R> {
    pub speed_min: Extreme<R>,
    pub speed_max: Extreme<R>,
    pub acceleration_min: Extreme<R>,
    pub acceleration_max: Extreme<R>,
    /// Largest relative disagreement of the energies at the stages with those of order 7: how coarse the
    /// steps are.
    pub doubt: R,
}

/// Integrals over a turn, by the quadrature of the steps (order 8).
#[derive(Clone, Copy, Debug)]
pub struct Totals<R> {
    /// Duration of the turn \[s\].
    pub period: R,
    /// Work of the motor at its shaft \[J\].
    pub motor_work: R,
    /// Work that reaches the crank from the motor \[J\].
    pub crank_work: R,
    /// Work taken by all loads \[J\].
    pub load_work: R,
    /// Mean over time of the motor's torque \[N m\].
    pub torque_mean: R,
    /// Root mean square over time of the motor's torque \[N m\].
    pub torque_rms: R,
}

/// Samples of a step: its start, its stages and its end.
const N: usize = S + 2;

/// Their places in the step.
const AT: [f64; N] = [0.0, C[0], C[1], C[2], C[3], 1.0];

/// Coefficients of the quintic through six samples: `a_p = Σ POWERS[p][j] y_j`.
const POWERS: [[f64; N]; N] = powers();

/// Integrals of that quintic from the start to each sample: `∫ = Σ AREAS[i][j] y_j`, in steps.
const AREAS: [[f64; N]; N] = areas();

/// Expands the Lagrange polynomials of the samples' places into powers.
const fn powers() -> [[f64; N]; N] {
    let mut table = [[0.0; N]; N];
    let mut j = 0;
    while j < N {
        // Product of (x − x_k)/(x_j − x_k), one factor after the other.
        let mut a = [0.0; N];
        a[0] = 1.0;
        let mut k = 0;
        while k < N {
            if k != j {
                let mut p = N - 1;
                while p > 0 {
                    a[p] = (a[p - 1] - AT[k] * a[p]) / (AT[j] - AT[k]);
                    p -= 1;
                }
                a[0] = -AT[k] * a[0] / (AT[j] - AT[k]);
            }
            k += 1;
        }
        let mut p = 0;
        while p < N {
            table[p][j] = a[p];
            p += 1;
        }
        j += 1;
    }
    table
}

const fn areas() -> [[f64; N]; N] {
    let mut table = [[0.0; N]; N];
    let mut i = 0;
    while i < N {
        let mut j = 0;
        while j < N {
            let (mut power, mut p) = (AT[i], 0);
            while p < N {
                table[i][j] += POWERS[p][j] * power / (p + 1) as f64;
                power *= AT[i];
                p += 1;
            }
            j += 1;
        }
        i += 1;
    }
    table
}

/// Rounds of refinement for one extreme: the best step, and steps that promise as much as it.
const ROUNDS: usize = 4;

/// By how much the estimate of a step's peak may err, as a share of the range: steps that promise less than
/// the best found by more than this are passed over. Parabolas through samples a quarter of a step apart err
/// by about 1e-3 of what the quantity changes in the step, itself a fraction of the range.
const DOUBT: f64 = 5e-4;

/// (ω, ε) at the samples of every step.
type Samples<R> = Vec<[(R, R); N]>;

/// What is made as large as possible: speed or acceleration, with sign −1 for the smallest.
#[derive(Clone, Copy)]
struct Quantity {
    is_speed: bool,
    sign: f64,
}

impl Quantity {
    /// Of (ω, ε).
    #[inline(always)]
    fn of<R: Real>(self, (omega, epsilon): (R, R)) -> R {
        (if self.is_speed { omega } else { epsilon }) * self.sign
    }
}

/// A place in a step that promises an extreme, with the samples of the step.
#[derive(Clone, Copy)]
struct Promise<R> {
    value: R,
    at: R,
    phi: R,
    h: R,
    E: R,
    index: R,
    samples: [R; N],
}

impl<R: Real> Machine<'_, R> {
    /// The machine at (φ, E).
    #[inline(always)]
    pub fn state(&self, phi: R, E: R, m: &mut Motion<R>) -> State<R> {
        let r = self.plan.reduce::<R, 2>(self.q, Angle::new(phi), 1.0, m);
        let inverse = r.J.recip();
        let squared = E * inverse * 2.0;
        let omega = squared.sqrt();
        let motor_torque = self.plan.motor_torque(self.q, omega);
        let drive_torque = self.plan.geared_torque(self.q, motor_torque);
        let mut load_torque = r.viscous.mul_add(omega, r.load + r.dry);
        if !self.plan.drive.speed_loads.is_empty() {
            load_torque = load_torque + self.plan.speed_load(omega);
        }
        if !self.plan.laws.is_empty() {
            let mut given = Vec::with_capacity(self.plan.laws.len());
            self.plan.give(self.q, phi, m, &mut given);
            load_torque = load_torque + self.laws(&given, omega);
        }
        let net = drive_torque - load_torque - r.J_d1 * squared * 0.5;
        State { omega, epsilon: net * inverse, motor_torque, drive_torque, load_torque, J: r.J }
    }
}

impl<R: Real> Turn<R> {
    /// Integrals over the turn.
    #[inline(always)]
    pub fn totals(&self, machine: &Machine<'_, R>) -> Totals<R> {
        let zero = R::splat(0.0);
        let (plan, q) = (machine.plan, machine.q);
        let (mut period, mut motor, mut crank, mut load) = (zero, zero, zero, zero);
        let (mut mean, mut square) = (zero, zero);
        for (k, step) in self.steps.iter().enumerate() {
            for i in 0..S {
                let row = &step.rows[i];
                let dphi = step.h * B[i];
                let omega = row.root * step.X[i].sqrt();
                let dt = dphi / omega;
                let torque: R = plan.motor_torque(q, omega);
                let mut drag = row.viscous.mul_add(omega, row.load) + plan.speed_load(omega);
                if !self.given.is_empty() {
                    drag = drag + machine.laws(machine.given_at(&self.given, k * S + i), omega);
                }
                period = period + dt;
                motor = (torque * q[plan.drive.ratio]).mul_add(dphi, motor);
                crank = plan.geared_torque(q, torque).mul_add(dphi, crank);
                load = drag.mul_add(dphi, load);
                mean = torque.mul_add(dt, mean);
                square = torque.squared().mul_add(dt, square);
            }
        }
        let layout = self.layout;
        let (period, mean, square) = (layout.total(period), layout.total(mean), layout.total(square));
        let (motor, crank, load) = (layout.total(motor), layout.total(crank), layout.total(load));
        Totals {
            period,
            motor_work: motor,
            crank_work: crank,
            load_work: load,
            torque_mean: mean / period,
            torque_rms: (square / period).sqrt(),
        }
    }

    /// Extremes of speed and acceleration.
    #[inline(always)]
    pub fn extremes(&self, machine: &Machine<'_, R>, m: &mut Motion<R>) -> Extremes<R> {
        let (samples, doubt) = R::outline(
            #[inline(always)]
            || self.samples(machine, m),
        );
        Extremes {
            doubt,
            speed_min: self.largest(machine, &samples, Quantity { is_speed: true, sign: -1.0 }, m),
            speed_max: self.largest(machine, &samples, Quantity { is_speed: true, sign: 1.0 }, m),
            acceleration_min: self.largest(machine, &samples, Quantity { is_speed: false, sign: -1.0 }, m),
            acceleration_max: self.largest(machine, &samples, Quantity { is_speed: false, sign: 1.0 }, m),
        }
    }

    /// (ω, ε) at start, stages and end of every step.
    ///
    /// The stages' energies are of order 5 only. With the torque at both ends of the step there are six
    /// values to integrate through, which gives energies of order 7 at the stages.
    #[inline(always)]
    fn samples(&self, machine: &Machine<'_, R>, m: &mut Motion<R>) -> (Samples<R>, R) {
        let n = self.steps.len();
        let (mut torques, mut speeds, mut gains) =
            (Vec::with_capacity(n), Vec::with_capacity(n), Vec::with_capacity(n));
        let mut given = Vec::with_capacity(machine.plan.laws.len());
        for step in &self.steps {
            given.clear();
            let row = machine.row::<2>(step.phi, m, &mut given);
            let mut torque = machine.balance(&row, step.E).value;
            if !given.is_empty() {
                torque = torque - machine.taken(&row, &given, step.E).value;
            }
            let (omega, epsilon) = speed_and_gain(&row, step.E, torque);
            torques.push(torque);
            speeds.push(omega);
            gains.push(epsilon);
        }
        let [torques_end, speeds_end, gains_end] =
            [self.layout.ends(&torques), self.layout.ends(&speeds), self.layout.ends(&gains)];
        let mut samples: Samples<R> = Vec::with_capacity(n);
        let mut doubt = R::splat(0.0);
        for (k, step) in self.steps.iter().enumerate() {
            let mut f = [torques[k]; N];
            f[S + 1] = torques_end[k];
            for i in 0..S {
                f[i + 1] = machine.balance(&step.rows[i], step.X[i]).value;
                if !self.given.is_empty() {
                    let given = machine.given_at(&self.given, k * S + i);
                    f[i + 1] = f[i + 1] - machine.taken(&step.rows[i], given, step.X[i]).value;
                }
            }
            let mut sample = [(speeds[k], gains[k]); N];
            sample[S + 1] = (speeds_end[k], gains_end[k]);
            for i in 1..=S {
                let mut E = step.E;
                for j in 0..N {
                    E = (step.h * AREAS[i][j]).mul_add(f[j], E);
                }
                doubt = doubt.max((E - step.X[i - 1]).abs() / E);
                let row = &step.rows[i - 1];
                let mut torque = machine.balance(row, E).value;
                if !self.given.is_empty() {
                    let given = machine.given_at(&self.given, k * S + i - 1);
                    torque = torque - machine.taken(row, given, E).value;
                }
                sample[i] = speed_and_gain(row, E, torque);
            }
            samples.push(sample);
        }
        (samples, doubt)
    }

    /// The extreme of a quantity over the turn; while searching, its value counts times its sign.
    #[inline(always)]
    fn largest(
        &self,
        machine: &Machine<'_, R>,
        samples: &Samples<R>,
        quantity: Quantity,
        m: &mut Motion<R>,
    ) -> Extreme<R> {
        let lowest = R::splat(f64::NEG_INFINITY);
        let mut best = Extreme { value: lowest, phi: R::splat(0.0) };
        let mut seen: [R; ROUNDS] = [R::splat(-1.0); ROUNDS];
        let range = self.range(samples, quantity);
        let peaks = R::outline(
            #[inline(always)]
            || peaks_of(samples, quantity),
        );
        for round in 0..ROUNDS {
            let promise = R::outline(
                #[inline(always)]
                || self.promise(samples, &peaks, quantity, &seen[..round]),
            );
            let worth = best.value - range * DOUBT;
            // In lanes the round is run while any lane has a step worth looking into.
            if round > 0 && (promise.value - worth).max_lane() <= 0.0 {
                break;
            }
            seen[round] = promise.index;
            let found = R::outline(
                #[inline(always)]
                || refine(machine, &promise, quantity, m),
            );
            best = Extreme {
                phi: best.value.select_lt(found.value, found.phi, best.phi),
                value: best.value.max(found.value),
            };
            // With the steps of one machine in lanes, the best of all lanes is the one to beat.
            let top = self.layout.highest(best.value);
            let below = R::splat(f64::NEG_INFINITY);
            best.phi = self.layout.highest(best.value.select_lt(top, below, best.phi));
            best.value = top;
        }
        best.value = best.value * quantity.sign;
        best
    }

    /// Largest minus smallest sample.
    #[inline(always)]
    fn range(&self, samples: &Samples<R>, quantity: Quantity) -> R {
        let mut low = quantity.of(samples[0][0]);
        let mut high = low;
        for sample in samples {
            for state in sample {
                low = low.min(quantity.of(*state));
                high = high.max(quantity.of(*state));
            }
        }
        self.layout.highest(high) + self.layout.highest(-low)
    }

    /// The most promising step of those not seen yet.
    #[inline(always)]
    fn promise(&self, samples: &Samples<R>, peaks: &[(R, R)], quantity: Quantity, seen: &[R]) -> Promise<R> {
        let lowest = R::splat(f64::NEG_INFINITY);
        let zero = R::splat(0.0);
        let samples_of_none = [zero; N];
        let mut best = Promise {
            value: lowest,
            at: zero,
            phi: zero,
            h: zero,
            E: zero,
            index: zero,
            samples: samples_of_none,
        };
        for (k, (step, sample)) in self.steps.iter().zip(samples).enumerate() {
            let index = R::splat(k as f64);
            let mut y = samples_of_none;
            for i in 0..N {
                y[i] = quantity.of(sample[i]);
            }
            let (mut value, at) = peaks[k];
            for &other in seen {
                // Lanes that have looked into this step pass over it.
                value = (index - other).abs().select_lt(R::splat(0.5), lowest, value);
            }
            best.keep_better(&Promise { value, at, phi: step.phi, h: step.h, E: step.E, index, samples: y });
        }
        best
    }
}

impl<R: Real> Promise<R> {
    /// Takes over the other promise in the lanes where it is better.
    #[inline(always)]
    fn keep_better(&mut self, other: &Promise<R>) {
        let value = self.value;
        self.at = value.select_lt(other.value, other.at, self.at);
        self.phi = value.select_lt(other.value, other.phi, self.phi);
        self.h = value.select_lt(other.value, other.h, self.h);
        self.E = value.select_lt(other.value, other.E, self.E);
        self.index = value.select_lt(other.value, other.index, self.index);
        for i in 0..N {
            self.samples[i] = value.select_lt(other.value, other.samples[i], self.samples[i]);
        }
        self.value = value.max(other.value);
    }

    /// Place of the peak of the quintic through the samples, from the promised place by Newton.
    #[inline(always)]
    fn peak(&self) -> R {
        let zero = R::splat(0.0);
        let mut a = [zero; N];
        for p in 0..N {
            for j in 0..N {
                a[p] = self.samples[j].mul_add(R::splat(POWERS[p][j]), a[p]);
            }
        }
        let mut at = self.at;
        // The parabola's place is good to a tenth of the step; Newton squares that: 1e-2, 1e-4, 1e-8.
        for _ in 0..4 {
            let (mut slope, mut bend) = (zero, zero);
            for p in (1..N).rev() {
                bend = bend.mul_add(at, slope);
                slope = slope.mul_add(at, a[p] * p as f64);
            }
            let next = (at - slope / bend).max(zero).min(R::splat(1.0));
            // Where the quintic is not concave the parabola's place, an end of the step, is kept.
            at = bend.select_lt(zero, next, at);
        }
        at
    }
}

/// ω, and ε = (M − ½ J′ ω²)/J, with the net torque M given.
#[inline(always)]
fn speed_and_gain<R: Real>(row: &Row<R>, E: R, net: R) -> (R, R) {
    let omega = row.root * E.sqrt();
    let inverse = row.root.squared() * 0.5;
    (omega, (net - row.J_d1 * omega.squared() * 0.5) * inverse)
}

/// [`peak_of_step`] of every step.
#[inline(always)]
fn peaks_of<R: Real>(samples: &Samples<R>, quantity: Quantity) -> Vec<(R, R)> {
    let mut peaks = Vec::with_capacity(samples.len());
    for sample in samples {
        let mut y = [sample[0].0; N];
        for i in 0..N {
            y[i] = quantity.of(sample[i]);
        }
        peaks.push(peak_of_step(&y));
    }
    peaks
}

/// Height and place (share of the step) of the best of four parabolas through neighbouring samples.
#[inline(always)]
fn peak_of_step<R: Real>(y: &[R; N]) -> (R, R) {
    let mut best = (y[0], R::splat(0.0));
    for i in 0..S {
        let at = [R::splat(AT[i]), R::splat(AT[i + 1]), R::splat(AT[i + 2])];
        let (height, place) = peak(at, [y[i], y[i + 1], y[i + 2]]);
        best = (best.0.max(height), best.0.select_lt(height, place, best.1));
    }
    best
}

/// Height and place of the parabola through three points on their span.
#[inline(always)]
fn peak<R: Real>(x: [R; 3], y: [R; 3]) -> (R, R) {
    let (left, right) = (x[1] - x[0], x[2] - x[1]);
    let slope_left = (y[1] - y[0]) / left;
    let slope_right = (y[2] - y[1]) / right;
    let bend = (slope_right - slope_left) / (left + right);
    // Newton's form about the middle: y = y₁ + g (x − x₁) + bend (x − x₁)².
    let g = bend.mul_add(left, slope_left);
    let ends = (y[0], y[2]);
    let outer = (ends.0.max(ends.1), ends.0.select_lt(ends.1, right, -left));
    // Concave parabolas have their top inside or beyond an end; for others the better end is the top.
    let top = (g / (bend * -2.0)).max(-left).min(right);
    let dx = bend.select_lt(R::splat(0.0), top, outer.1);
    (bend.mul_add(dx, g).mul_add(dx, y[1]), x[1] + dx)
}

/// The quantity at the peak of the promised step, by solving on to there: the value errs by the square of
/// the error in the place.
#[inline(always)]
fn refine<R: Real>(
    machine: &Machine<'_, R>,
    promise: &Promise<R>,
    quantity: Quantity,
    m: &mut Motion<R>,
) -> Extreme<R> {
    let along = promise.peak() * promise.h;
    let phi = promise.phi + along;
    let E = machine.advance(promise.phi, promise.E, along, m);
    let state = machine.state(phi, E, m);
    Extreme { value: quantity.of((state.omega, state.epsilon)), phi }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quintic_reproduces_its_samples_and_its_integral() {
        let y: [f64; N] = std::array::from_fn(|i| (1.3 * AT[i] + 0.2).powi(5) - AT[i].powi(2));
        let a: [f64; N] = std::array::from_fn(|p| (0..N).map(|j| POWERS[p][j] * y[j]).sum());
        for i in 0..N {
            let value: f64 = (0..N).map(|p| a[p] * AT[i].powi(p as i32)).sum();
            // Rounding of a sum is at most a few ulps of the sum of its terms' sizes.
            let size: f64 = (0..N).map(|p| (0..N).map(|j| (POWERS[p][j] * y[j]).abs()).sum::<f64>()).sum();
            let rounding = 4.0 * f64::EPSILON * size;
            assert!((value - y[i]).abs() < rounding, "sample {i}: {value} for {}", y[i]);
            let area: f64 = (0..N).map(|j| AREAS[i][j] * y[j]).sum();
            let exact = ((1.3 * AT[i] + 0.2).powi(6) - 0.2_f64.powi(6)) / 7.8 - AT[i].powi(3) / 3.0;
            assert!((area - exact).abs() < rounding, "integral to sample {i}: {area} for {exact}");
        }
    }
}
