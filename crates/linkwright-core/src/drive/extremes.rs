//! Extremes of speed and acceleration over a turn.
//!
//! Extremes are found inside the steps, not at their ends: samples of every step tell which steps promise
//! one, the polynomial through them the place, and the solution is read there like any curve
//! ([`Machine::advance`]). So an extreme is a value of the curve; the square of the error in its place is
//! what it may fall short by.

use crate::drive::cycle::{Machine, Turn, stages_of_part};
use crate::drive::layout::{Layout, unbundle};
use crate::kernel::radau::{AT, N, S, slope_and_bend, through};
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// An extreme and the crank angle where it is.
#[derive(Clone, Copy, Debug)]
pub struct Extreme<R> {
    /// The value.
    pub value: R,
    /// Crank angle \[rad\].
    pub phi: R,
}

impl<R: Real> Extreme<R> {
    /// Takes over the other in the lanes where it is larger.
    #[inline(always)]
    fn keep_larger(&mut self, other: &Self) {
        self.phi = self.value.select_lt(other.value, other.phi, self.phi);
        self.value = self.value.max(other.value);
    }
}

/// Speed and acceleration extremes of a turn.
#[derive(Clone, Copy, Debug)]
pub struct Extremes<R> {
    pub speed_min: Extreme<R>,
    pub speed_max: Extreme<R>,
    pub acceleration_min: Extreme<R>,
    pub acceleration_max: Extreme<R>,
}

/// Rounds of refinement for one extreme of machines in lanes: the best step, and steps that promise as much
/// as it.
const ROUNDS: usize = 4;

/// By how much the estimate of a step's peak may err, as a share of the range: steps that promise less than
/// the best by more than this are passed over. Parabolas through samples a quarter of a step apart err
/// by about 1e-3 of what the quantity changes in the step, itself a fraction of the range.
const DOUBT: f64 = 2e-3;

/// Shares of a step to both sides of a place at which the curve is read for a better one: the quintic's peak is
/// good to a few hundredths; a parabola through readings this far apart to a thousandth, then to the square of
/// that.
const ASIDE: [f64; 2] = [0.04, 0.004];

/// How much farther than that the better place may lie.
const LEAP: f64 = 4.0;

/// (u, ε) at the samples of a step.
type Samples<R> = [(R, R); N];

/// What is made as large as possible: u or acceleration, with sign −1 for the smallest.
#[derive(Clone, Copy)]
struct Quantity {
    is_speed: bool,
    sign: f64,
}

impl Quantity {
    /// Of (u, ε).
    #[inline(always)]
    fn of<R: Real>(self, (u, epsilon): (R, R)) -> R {
        (if self.is_speed { u } else { epsilon }) * self.sign
    }

    /// At the samples of a step.
    #[inline(always)]
    fn samples<R: Real>(self, samples: &Samples<R>) -> [R; N] {
        let mut y = [samples[0].0; N];
        for i in 0..N {
            y[i] = self.of(samples[i]);
        }
        y
    }
}

/// A place in a step that promises an extreme, with the samples of the step.
#[derive(Clone, Copy)]
struct Promise<R> {
    /// Sign and kind of the quantity; 1 for speed, 0 for acceleration.
    sign: R,
    is_speed: R,
    value: R,
    at: R,
    phi: R,
    h: R,
    u: R,
    /// The quantity at the samples of the step.
    samples: [R; N],
    /// u over the step.
    quintic: [R; N],
}

/// The four extremes, in their order.
const QUANTITIES: [Quantity; 4] = [
    Quantity { is_speed: true, sign: -1.0 },
    Quantity { is_speed: true, sign: 1.0 },
    Quantity { is_speed: false, sign: -1.0 },
    Quantity { is_speed: false, sign: 1.0 },
];

impl<R: Real> Turn<R> {
    /// Extremes of speed and acceleration.
    #[inline(always)]
    pub fn extremes(&self, machine: &Machine<'_, R>, m: &mut Motion<R>) -> Extremes<R> {
        let samples = R::outline(
            #[inline(always)]
            || self.samples(machine, m),
        );
        let mut best = match self.layout {
            Layout::Machines => QUANTITIES.map(
                #[inline(always)]
                |quantity| self.largest_of_machine(machine, &samples, quantity, m),
            ),
            Layout::Steps => self.largest_of_steps(machine, &samples, m),
        };
        for (best, quantity) in best.iter_mut().zip(QUANTITIES) {
            best.value = best.value * quantity.sign;
            if quantity.is_speed {
                best.value = (best.value * 2.0).sqrt();
            }
        }
        let [speed_min, speed_max, acceleration_min, acceleration_max] = best;
        Extremes { speed_min, speed_max, acceleration_min, acceleration_max }
    }

    /// (u, ε) at start and stages of every step.
    #[inline(always)]
    fn samples(&self, machine: &Machine<'_, R>, m: &mut Motion<R>) -> Vec<Samples<R>> {
        let mut samples = Vec::with_capacity(self.steps.len());
        let mut given = Vec::with_capacity(machine.plan.laws.len());
        for step in &self.steps {
            given.clear();
            let row = machine.row(step.phi, m, &mut given);
            let mut sample = [(step.u, machine.acceleration(&row, &given, step.u).value); N];
            for i in 0..S {
                sample[i + 1] = (step.X[i], step.K[i]);
            }
            samples.push(sample);
        }
        samples
    }

    /// In lanes with a machine each: the best step of every lane, and others that promise as much.
    #[inline(always)]
    fn largest_of_machine(
        &self,
        machine: &Machine<'_, R>,
        samples: &[Samples<R>],
        quantity: Quantity,
        m: &mut Motion<R>,
    ) -> Extreme<R> {
        let mut promises = R::outline(
            #[inline(always)]
            || self.promises(samples, quantity),
        );
        let range = self.range(samples, quantity);
        let lowest = R::splat(f64::NEG_INFINITY);
        let mut best = self.largest_of_ends(samples, quantity);
        for round in 0..ROUNDS {
            let promise = R::outline(
                #[inline(always)]
                || take_best(&mut promises),
            );
            let worth = best.value - range * DOUBT;
            if round > 0 && (promise.value - worth).max_lane() <= 0.0 {
                break;
            }
            // u has one derivative more than its derivative: its quintic's peak is good enough.
            let asides = if quantity.is_speed { &ASIDE[..0] } else { &ASIDE[..1] };
            let found = R::outline(
                #[inline(always)]
                || promise.read_around(machine, asides, m),
            );
            // A lane whose step was not worth it takes nothing: its bits do not depend on its neighbours.
            let value = worth.select_lt(promise.value, found.value, lowest);
            best.keep_larger(&Extreme { value, phi: found.phi });
        }
        best
    }

    /// The largest at the ends of the steps, which are on the curve: extremes may be corners there.
    #[inline(always)]
    fn largest_of_ends(&self, samples: &[Samples<R>], quantity: Quantity) -> Extreme<R> {
        let mut best = Extreme { value: R::splat(f64::NEG_INFINITY), phi: R::splat(0.0) };
        for (step, sample) in self.steps.iter().zip(samples) {
            best.keep_larger(&Extreme { value: quantity.of(sample[0]), phi: step.phi });
            best.keep_larger(&Extreme { value: quantity.of(sample[N - 1]), phi: step.phi + step.h });
        }
        best
    }

    /// Of the steps of one machine: all that promise as much as the best, for all four extremes, as many at
    /// once as there are lanes.
    #[inline(always)]
    fn largest_of_steps(
        &self,
        machine: &Machine<'_, R>,
        samples: &[Samples<R>],
        m: &mut Motion<R>,
    ) -> [Extreme<R>; 4] {
        let mut chosen: Vec<(usize, Promise<f64>)> = Vec::new();
        for (which, quantity) in QUANTITIES.into_iter().enumerate() {
            let promises = R::outline(
                #[inline(always)]
                || self.promises(samples, quantity),
            );
            let values = unbundle(&promises.iter().map(|promise| promise.value).collect::<Vec<_>>());
            let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let worth = top - DOUBT * unbundle(&[self.range(samples, quantity)])[0];
            for (k, _) in values.iter().enumerate().filter(|&(_, &value)| value >= worth) {
                chosen.push((which, promises[k / R::LANES].lane(k % R::LANES)));
            }
        }
        let mut best = QUANTITIES.map(
            #[inline(always)]
            |quantity| {
                let of_lanes = self.largest_of_ends(samples, quantity);
                let mut best = Extreme { value: f64::NEG_INFINITY, phi: 0.0 };
                for (value, phi) in unbundle(&[of_lanes.value]).into_iter().zip(unbundle(&[of_lanes.phi])) {
                    best.keep_larger(&Extreme { value, phi });
                }
                best
            },
        );
        for chosen in chosen.chunks(R::LANES) {
            let promise = Promise::<R>::of_lanes(chosen);
            let found = promise.read_around(machine, &ASIDE, m);
            let (values, places) = (unbundle(&[found.value]), unbundle(&[found.phi]));
            for (lane, &(which, _)) in chosen.iter().enumerate() {
                best[which].keep_larger(&Extreme { value: values[lane], phi: places[lane] });
            }
        }
        best.map(|best| Extreme { value: R::splat(best.value), phi: R::splat(best.phi) })
    }

    /// Largest minus smallest sample.
    #[inline(always)]
    fn range(&self, samples: &[Samples<R>], quantity: Quantity) -> R {
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

    /// What every step promises.
    #[inline(always)]
    fn promises(&self, samples: &[Samples<R>], quantity: Quantity) -> Vec<Promise<R>> {
        let mut promises = Vec::with_capacity(samples.len());
        for (step, sample) in self.steps.iter().zip(samples) {
            let samples = quantity.samples(sample);
            let (value, at) = peak_of_step(&samples);
            let (sign, is_speed) =
                (R::splat(quantity.sign), R::splat(if quantity.is_speed { 1.0 } else { 0.0 }));
            let (phi, h, u, quintic) = (step.phi, step.h, step.u, step.quintic());
            promises.push(Promise { sign, is_speed, value, at, phi, h, u, samples, quintic });
        }
        promises
    }
}

/// The best promise of each lane; it promises nothing any more.
#[inline(always)]
fn take_best<R: Real>(promises: &mut [Promise<R>]) -> Promise<R> {
    let mut best = promises[0];
    for promise in promises.iter() {
        best.keep_better(promise);
    }
    let lowest = R::splat(f64::NEG_INFINITY);
    for promise in promises {
        let is_other = (promise.phi - best.phi).abs() + (promise.h - best.h).abs();
        promise.value = R::splat(0.0).select_lt(is_other, promise.value, lowest);
    }
    best
}

impl<R: Real> Promise<R> {
    /// That of one lane.
    #[inline(always)]
    fn lane(&self, lane: usize) -> Promise<f64> {
        let of = |x: R| unbundle(&[x])[lane];
        Promise {
            sign: of(self.sign),
            is_speed: of(self.is_speed),
            value: of(self.value),
            at: of(self.at),
            phi: of(self.phi),
            h: of(self.h),
            u: of(self.u),
            samples: self.samples.map(of),
            quintic: self.quintic.map(of),
        }
    }

    /// One in each lane; the last fills the lanes that are left.
    #[inline(always)]
    fn of_lanes(promises: &[(usize, Promise<f64>)]) -> Self {
        let across = |of: &dyn Fn(&Promise<f64>) -> f64| {
            let lane = |i: usize| of(&promises[i.min(promises.len() - 1)].1);
            R::load(&(0..R::LANES).map(lane).collect::<Vec<_>>())
        };
        Promise {
            sign: across(&|p| p.sign),
            is_speed: across(&|p| p.is_speed),
            value: across(&|p| p.value),
            at: across(&|p| p.at),
            phi: across(&|p| p.phi),
            h: across(&|p| p.h),
            u: across(&|p| p.u),
            samples: std::array::from_fn(|i| across(&|p| p.samples[i])),
            quintic: std::array::from_fn(|i| across(&|p| p.quintic[i])),
        }
    }

    /// Takes over the other promise in the lanes where it is better.
    #[inline(always)]
    fn keep_better(&mut self, other: &Promise<R>) {
        let value = self.value;
        self.at = value.select_lt(other.value, other.at, self.at);
        self.phi = value.select_lt(other.value, other.phi, self.phi);
        self.h = value.select_lt(other.value, other.h, self.h);
        self.u = value.select_lt(other.value, other.u, self.u);
        for i in 0..N {
            self.samples[i] = value.select_lt(other.value, other.samples[i], self.samples[i]);
            self.quintic[i] = value.select_lt(other.value, other.quintic[i], self.quintic[i]);
        }
        self.value = value.max(other.value);
    }

    /// The quantity at a place of the step, on the curve.
    #[inline(always)]
    fn read(&self, machine: &Machine<'_, R>, at: R, m: &mut Motion<R>) -> Extreme<R> {
        let X = stages_of_part(&self.quintic, R::splat(0.0), at);
        let (there, _) = machine.advance_near(self.phi, self.u, at * self.h, X, m);
        let value = self.is_speed.select_lt(R::splat(0.5), there.K[S - 1], there.end());
        Extreme { value: value * self.sign, phi: at.mul_add(self.h, self.phi) }
    }

    /// The quantity near the quintic's peak, read at better and better places.
    #[inline(always)]
    fn read_around(&self, machine: &Machine<'_, R>, asides: &[f64], m: &mut Motion<R>) -> Extreme<R> {
        let mut place = self.peak();
        let mut best = Extreme { value: R::splat(f64::NEG_INFINITY), phi: place };
        for &aside in asides {
            let middle = place.max(R::splat(aside)).min(R::splat(1.0 - aside));
            let [left, centre, right] = [middle - aside, middle, middle + aside].map(
                #[inline(always)]
                |at| {
                    let found = self.read(machine, at, m);
                    best.keep_larger(&found);
                    found.value
                },
            );
            let bend = left - centre - centre + right;
            let slope = right - left;
            let ahead = R::splat(LEAP * aside);
            let uphill = slope.select_lt(R::splat(0.0), -ahead, ahead);
            let top = (slope / bend * (-0.5 * aside)).max(-ahead).min(ahead);
            let better = middle + bend.select_lt(R::splat(0.0), top, uphill);
            place = better.max(R::splat(0.0)).min(R::splat(1.0));
        }
        best.keep_larger(&self.read(machine, place, m));
        best
    }

    /// Place of the peak of the quintic through the samples, from the promised place by Newton.
    #[inline(always)]
    fn peak(&self) -> R {
        let zero = R::splat(0.0);
        let a = through(&self.samples);
        let mut at = self.at;
        // The parabola's place is good to a tenth of the step; Newton squares that: 1e-2, 1e-4, 1e-8.
        for _ in 0..4 {
            let (slope, bend) = slope_and_bend(&a, at);
            let next = (at - slope / bend).max(zero).min(R::splat(1.0));
            // Where the quintic is not concave the parabola's place, an end of the step, is kept.
            at = bend.select_lt(zero, next, at);
        }
        at
    }
}

/// Height and place (share of the step) of the best of four parabolas through neighbouring samples.
#[inline(always)]
fn peak_of_step<R: Real>(y: &[R; N]) -> (R, R) {
    let mut best = (y[0], R::splat(0.0));
    for i in 0..S - 1 {
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
