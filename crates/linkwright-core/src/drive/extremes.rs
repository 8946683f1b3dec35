//! Extremes of speed and acceleration over a revolution.
//!
//! Extremes are found inside the steps, not at their ends: samples of every step tell which steps promise
//! one, the polynomial through them the place, and the solution is read there like any curve
//! ([`crate::drive::between`], or [`Machine::advance`]). So an extreme is a value of the curve; the square of the error in its place is
//! what it may fall short by.

use crate::drive::between::Between;
use crate::drive::cycle::Turn;
use crate::drive::equation::Machine;
use crate::drive::layout::{Layout, bundle, unbundle};
use crate::drive::step::{Step, stages_of_part};
use crate::kernel::out_of_line;
use crate::kernel::radau::{AT, N, S, slope_and_bend, through};
use crate::kernel::real::Real;
use crate::kernel::series::{TERMS, derivatives, value as on_series};
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

    /// Nothing where its place, a share of a step, is an end: what lies there is known, and at a kink only to one side.
    #[inline(always)]
    fn inside(self, at: R) -> Self {
        let zero = R::splat(0.0);
        let room = at.min(R::splat(1.0) - at);
        Extreme { value: zero.select_lt(room, self.value, R::splat(f64::NEG_INFINITY)), ..self }
    }
}

/// Speed and acceleration extremes of a revolution.
#[derive(Clone, Copy, Debug)]
pub struct Extremes<R> {
    pub speed_min: Extreme<R>,
    pub speed_max: Extreme<R>,
    pub acceleration_min: Extreme<R>,
    pub acceleration_max: Extreme<R>,
}

impl Extremes<f64> {
    /// With the accelerations at corners of their curve, which may lie inside steps.
    pub fn with_corners(mut self, corners: &[(f64, f64)]) -> Self {
        for &(phi, epsilon) in corners {
            if epsilon > self.acceleration_max.value {
                self.acceleration_max = Extreme { value: epsilon, phi };
            }
            if epsilon < self.acceleration_min.value {
                self.acceleration_min = Extreme { value: epsilon, phi };
            }
        }
        self
    }
}

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

/// Longest stride of Newton's method for a peak on a series, as a share of the step, and how many: the parabola's place is
/// good to a tenth of the step, and from a hundredth on errors are squared.
const STRIDE: f64 = 0.15;
/// See [`STRIDE`].
const STRIDES: usize = 6;

/// Share of an acceleration by which the derivative of a series may differ from it at a peak: the peak is displaced by about the
/// root of it, and falls short by much less.
const MISSED: f64 = 1e-8;

/// How far beside a peak, as a share of the step, the acceleration is read where the series misses it.
const BESIDE: f64 = 0.02;

/// u and ε at the samples of a step.
type Samples<R> = [[R; N]; 2];

/// Numbers of a step that a promise is made of: start, length, its samples, and the series of u where there is one.
const NUMBERS: usize = 2 + 2 * N + TERMS;

/// What is made as large as possible: u or acceleration, with sign −1 for the smallest.
#[derive(Clone, Copy)]
struct Quantity {
    is_speed: bool,
    sign: f64,
}

impl Quantity {
    /// Of the samples of a step.
    #[inline(always)]
    fn of<R: Real>(self, samples: &Samples<R>, i: usize) -> R {
        samples[usize::from(!self.is_speed)][i] * self.sign
    }
}

/// A value that a step promises, and its place as a share of the step.
#[derive(Clone, Copy)]
struct Hint<R> {
    value: R,
    at: R,
}

/// A step that promises an extreme: its number, its lane, what is extreme there and where.
#[derive(Clone, Copy)]
struct Pick {
    step: usize,
    lane: usize,
    quantity: usize,
    at: f64,
}

/// Steps that promise an extreme, one a lane, with their samples.
#[derive(Clone, Copy)]
struct Promise<R> {
    /// Sign and kind of the quantity; 1 for speed, 0 for acceleration.
    sign: R,
    is_speed: R,
    /// Place as a share of the step.
    at: R,
    phi: R,
    h: R,
    u: R,
    /// The quantity at the samples of the step.
    samples: [R; N],
    /// u over the step.
    quintic: [R; N],
    /// The same to the accuracy of the steps.
    series: Option<[R; TERMS]>,
}

/// The four extremes, in their order.
const QUANTITIES: [Quantity; 4] = [
    Quantity { is_speed: true, sign: -1.0 },
    Quantity { is_speed: true, sign: 1.0 },
    Quantity { is_speed: false, sign: -1.0 },
    Quantity { is_speed: false, sign: 1.0 },
];

impl<R: Real> Turn<R> {
    /// Extremes of speed and acceleration; read from series `between` the ends of the steps where there are any. `starts`
    /// is ε at the starts of the steps.
    #[inline(always)]
    pub fn extremes(
        &self,
        machine: &Machine<'_, R>,
        between: Option<&[Between<R>]>,
        starts: &[R],
        m: &mut Motion<R>,
    ) -> Extremes<R> {
        out_of_line!(R, {
            let samples = self.samples(starts);
            let numbers = self.numbers(&samples, between);
            let hints = hints(&samples);
            let mut best = match self.layout {
                Layout::Machines => {
                    let nothing = Extreme { value: R::splat(f64::NEG_INFINITY), phi: R::splat(0.0) };
                    let mut best = [nothing; QUANTITIES.len()];
                    for (quantity, hints) in hints.into_iter().enumerate() {
                        let numbers = (&numbers[..], between.is_some());
                        best[quantity] =
                            self.largest_of_machine(machine, &samples, numbers, quantity, hints, m);
                    }
                    best
                }
                Layout::Steps => {
                    self.largest_of_steps(machine, &samples, (&numbers, between.is_some()), &hints, m)
                }
            };
            for (best, quantity) in best.iter_mut().zip(QUANTITIES) {
                best.value = best.value * quantity.sign;
                if quantity.is_speed {
                    best.value = (best.value * 2.0).sqrt();
                }
            }
            let [speed_min, speed_max, acceleration_min, acceleration_max] = best;
            Extremes { speed_min, speed_max, acceleration_min, acceleration_max }
        })
    }

    /// ε at the starts of the steps.
    #[inline(always)]
    pub fn starts(&self, machine: &Machine<'_, R>, m: &mut Motion<R>) -> Vec<R> {
        let mut starts = Vec::with_capacity(self.steps.len());
        for (k, step) in self.steps.iter().enumerate() {
            starts.push(machine.start(step, self.geometry_of(machine, k), m));
        }
        starts
    }

    /// Takes ε at some ends of steps, numbered one by one, to both sides: into their last stages, and into the `starts`.
    #[inline(always)]
    pub fn take_sides(&mut self, sides: &[(usize, [f64; 2])], starts: &mut [R]) {
        let mut ends = unbundle(&self.steps.iter().map(|step| step.K[S - 1]).collect::<Vec<_>>());
        let mut first = unbundle(starts);
        let n = self.pieces().len();
        for &(k, [before, behind]) in sides {
            (ends[k], first[(k + 1) % n]) = (before, behind);
        }
        for (step, end) in self.steps.iter_mut().zip(bundle(&ends)) {
            step.K[S - 1] = end;
        }
        starts.copy_from_slice(&bundle(&first));
    }

    /// (u, ε) at start and stages of every step.
    #[inline(always)]
    fn samples(&self, starts: &[R]) -> Vec<Samples<R>> {
        let of_step = |(step, &start): (&Step<R>, &R)| {
            let (mut u, mut epsilon) = ([step.u; N], [start; N]);
            u[1..].copy_from_slice(&step.X);
            epsilon[1..].copy_from_slice(&step.K);
            [u, epsilon]
        };
        self.steps.iter().zip(starts).map(of_step).collect()
    }

    /// The numbers of all steps in a row: step by step, number by number, lane by lane.
    #[inline(always)]
    fn numbers(&self, samples: &[Samples<R>], between: Option<&[Between<R>]>) -> Vec<f64> {
        let mut numbers = vec![0.0; self.steps.len() * NUMBERS * R::LANES];
        let rows = numbers.chunks_exact_mut(NUMBERS * R::LANES);
        for (k, ((step, [u, epsilon]), to)) in self.steps.iter().zip(samples).zip(rows).enumerate() {
            step.phi.store(to);
            step.h.store(&mut to[R::LANES..]);
            for i in 0..N {
                u[i].store(&mut to[(2 + i) * R::LANES..]);
                epsilon[i].store(&mut to[(2 + N + i) * R::LANES..]);
            }
            for (i, term) in between.iter().flat_map(|all| &all[k].u).enumerate() {
                term.store(&mut to[(2 + 2 * N + i) * R::LANES..]);
            }
        }
        numbers
    }

    /// In lanes with a machine each: the best step of every lane, and all that promise as much: a peak near an end of a
    /// step shows in two, and like cranks give many like peaks.
    #[inline(always)]
    fn largest_of_machine(
        &self,
        machine: &Machine<'_, R>,
        samples: &[Samples<R>],
        (numbers, has_series): (&[f64], bool),
        quantity: usize,
        mut hints: Vec<Hint<R>>,
        m: &mut Motion<R>,
    ) -> Extreme<R> {
        let range = self.range(samples, QUANTITIES[quantity]);
        let lowest = R::splat(f64::NEG_INFINITY);
        let mut best = self.largest_of_ends(samples, QUANTITIES[quantity]);
        let (mut steps, mut places) = (vec![0.0; R::LANES], vec![0.0; R::LANES]);
        let mut picks = vec![Pick { step: 0, lane: 0, quantity, at: 0.0 }; R::LANES];
        for round in 0..self.steps.len() {
            let (step, hint) = take_best(&mut hints);
            let worth = best.value - range * DOUBT;
            if round > 0 && (hint.value - worth).max_lane() <= 0.0 {
                break;
            }
            step.store(&mut steps);
            hint.at.store(&mut places);
            for (lane, pick) in picks.iter_mut().enumerate() {
                *pick = Pick { step: steps[lane] as usize, lane, at: places[lane], ..*pick };
            }
            // u has one derivative more than its derivative: its quintic's peak is good enough.
            let asides = if QUANTITIES[quantity].is_speed { &ASIDE[..0] } else { &ASIDE[..1] };
            let found = Promise::found(&picks, (numbers, has_series), machine, (self.limit, asides), m);
            // A lane whose step was not worth it takes nothing: its bits do not depend on its neighbours.
            let value = worth.select_lt(hint.value, found.value, lowest);
            best.keep_larger(&Extreme { value, phi: found.phi });
        }
        best
    }

    /// The largest at the ends of the steps, which are on the curve: extremes may be corners there.
    #[inline(always)]
    fn largest_of_ends(&self, samples: &[Samples<R>], quantity: Quantity) -> Extreme<R> {
        let mut best = Extreme { value: R::splat(f64::NEG_INFINITY), phi: R::splat(0.0) };
        for (step, sample) in self.steps.iter().zip(samples) {
            best.keep_larger(&Extreme { value: quantity.of(sample, 0), phi: step.phi });
            best.keep_larger(&Extreme { value: quantity.of(sample, N - 1), phi: step.phi + step.h });
        }
        best
    }

    /// Of the steps of one machine: all that promise as much as the best, for all four extremes, as many at
    /// once as there are lanes. Where a torque jumps within a step this may promise what nothing gives; then all that promise as
    /// much as what was found are read too.
    #[inline(always)]
    fn largest_of_steps(
        &self,
        machine: &Machine<'_, R>,
        samples: &[Samples<R>],
        numbers: (&[f64], bool),
        hints: &[Vec<Hint<R>>; 4],
        m: &mut Motion<R>,
    ) -> [Extreme<R>; 4] {
        let mut best = [Extreme { value: f64::NEG_INFINITY, phi: 0.0 }; QUANTITIES.len()];
        for (best, quantity) in best.iter_mut().zip(QUANTITIES) {
            let of_lanes = self.largest_of_ends(samples, quantity);
            for (value, phi) in unbundle(&[of_lanes.value]).into_iter().zip(unbundle(&[of_lanes.phi])) {
                best.keep_larger(&Extreme { value, phi });
            }
        }
        let ranges = QUANTITIES.map(|quantity| unbundle(&[self.range(samples, quantity)])[0]);
        let hints = hints.each_ref().map(|hints| hints_one_by_one(hints));
        let mut worth: [f64; QUANTITIES.len()] = std::array::from_fn(|quantity| {
            let top = hints[quantity].iter().map(|hint| hint.value).fold(f64::NEG_INFINITY, f64::max);
            top - DOUBT * ranges[quantity]
        });
        let mut above = [f64::INFINITY; QUANTITIES.len()];
        for _ in 0..2 {
            let mut picks: Vec<Pick> = Vec::new();
            for (quantity, hints) in hints.iter().enumerate() {
                let is_worth =
                    |hint: &Hint<f64>| hint.value >= worth[quantity] && hint.value < above[quantity];
                for (k, hint) in hints.iter().enumerate().filter(|(_, hint)| is_worth(hint)) {
                    picks.push(Pick { step: k / R::LANES, lane: k % R::LANES, quantity, at: hint.at });
                }
            }
            self.read_picks(machine, &picks, numbers, &mut best, m);
            above = worth;
            worth = std::array::from_fn(|quantity| best[quantity].value - DOUBT * ranges[quantity]);
        }
        best.map(|best| Extreme { value: R::splat(best.value), phi: R::splat(best.phi) })
    }

    /// Reads what some steps promise.
    #[inline(always)]
    fn read_picks(
        &self,
        machine: &Machine<'_, R>,
        picks: &[Pick],
        numbers: (&[f64], bool),
        best: &mut [Extreme<f64>; QUANTITIES.len()],
        m: &mut Motion<R>,
    ) {
        for picks in picks.chunks(R::LANES) {
            let found = Promise::found(picks, numbers, machine, (self.limit, &ASIDE), m);
            let (values, places) = (unbundle(&[found.value]), unbundle(&[found.phi]));
            for (lane, pick) in picks.iter().enumerate() {
                best[pick.quantity].keep_larger(&Extreme { value: values[lane], phi: places[lane] });
            }
        }
    }

    /// Largest minus smallest sample.
    #[inline(always)]
    fn range(&self, samples: &[Samples<R>], quantity: Quantity) -> R {
        let mut low = quantity.of(&samples[0], 0);
        let mut high = low;
        for sample in samples {
            for i in 0..N {
                low = low.min(quantity.of(sample, i));
                high = high.max(quantity.of(sample, i));
            }
        }
        self.layout.highest(high) + self.layout.highest(-low)
    }
}

/// What every step promises of each quantity.
#[inline(always)]
fn hints<R: Real>(samples: &[Samples<R>]) -> [Vec<Hint<R>>; 4] {
    out_of_line!(R, {
        let mut hints = [const { Vec::new() }; 4];
        for sample in samples {
            for (kind, values) in sample.iter().enumerate() {
                for (sign, hint) in peaks_of_step(values).into_iter().enumerate() {
                    hints[2 * kind + sign].push(hint);
                }
            }
        }
        hints
    })
}

/// What steps promise, one after the other.
fn hints_one_by_one<R: Real>(hints: &[Hint<R>]) -> Vec<Hint<f64>> {
    let [values, places] = [|hint: &Hint<R>| hint.value, |hint: &Hint<R>| hint.at]
        .map(|of| unbundle(&hints.iter().map(of).collect::<Vec<_>>()));
    values.into_iter().zip(places).map(|(value, at)| Hint { value, at }).collect()
}

/// The best promise of each lane, and the number of its step; that promises nothing any more.
#[inline(always)]
fn take_best<R: Real>(hints: &mut [Hint<R>]) -> (R, Hint<R>) {
    let (mut best, mut step) = (hints[0], R::splat(0.0));
    for (k, hint) in hints.iter().enumerate() {
        step = best.value.select_lt(hint.value, R::splat(k as f64), step);
        best.at = best.value.select_lt(hint.value, hint.at, best.at);
        best.value = best.value.max(hint.value);
    }
    let lowest = R::splat(f64::NEG_INFINITY);
    for (k, hint) in hints.iter_mut().enumerate() {
        let is_other = (step - R::splat(k as f64)).abs();
        hint.value = R::splat(0.5).select_lt(is_other, hint.value, lowest);
    }
    (step, best)
}

impl<R: Real> Promise<R> {
    /// What some steps promise, read around its places.
    #[inline(always)]
    fn found(
        picks: &[Pick],
        (numbers, has_series): (&[f64], bool),
        machine: &Machine<'_, R>,
        (limit, asides): (f64, &[f64]),
        m: &mut Motion<R>,
    ) -> Extreme<R> {
        out_of_line!(R, Self::of_picks(picks, numbers, has_series).read_around(machine, limit, asides, m))
    }

    /// One in each lane; the last fills the lanes that are left.
    #[inline(always)]
    fn of_picks(picks: &[Pick], numbers: &[f64], has_series: bool) -> Self {
        let zero = R::splat(0.0);
        let (mut rows, mut lanes) = ([zero; NUMBERS + 3], vec![0.0; R::LANES]);
        for (number, row) in rows.iter_mut().enumerate() {
            for (lane, to) in lanes.iter_mut().enumerate() {
                let pick = picks[lane.min(picks.len() - 1)];
                let quantity = QUANTITIES[pick.quantity];
                *to = match number {
                    0 => quantity.sign,
                    1 => f64::from(u8::from(quantity.is_speed)),
                    2 => pick.at,
                    _ => numbers[(pick.step * NUMBERS + number - 3) * R::LANES + pick.lane],
                };
            }
            *row = R::load(&lanes);
        }
        let [sign, is_speed, at, phi, h, u, ..] = rows;
        let (mut us, mut samples) = ([u; N], [u; N]);
        for i in 0..N {
            us[i] = rows[5 + i];
            samples[i] = is_speed.select_lt(R::splat(0.5), rows[5 + N + i], us[i]) * sign;
        }
        let mut terms = [u; TERMS];
        terms.copy_from_slice(&rows[5 + 2 * N..]);
        let series = has_series.then_some(terms);
        Promise { sign, is_speed, at, phi, h, u, samples, quintic: through(&us), series }
    }

    /// The quantity at a place of the step, on the curve.
    #[inline(always)]
    fn read(&self, machine: &Machine<'_, R>, limit: f64, at: R, m: &mut Motion<R>) -> Extreme<R> {
        out_of_line!(R, {
            if let Some(series) = &self.series {
                let (u, phi) = (on_series(series, at), at.mul_add(self.h, self.phi));
                if !self.is_speed.any_below(R::splat(0.5)) {
                    return Extreme { value: u * self.sign, phi };
                }
                let mut geometry = Vec::new();
                let row = machine.row(phi, m, &mut geometry);
                let epsilon = machine.acceleration(&row, &geometry, u).value;
                return Extreme {
                    value: self.is_speed.select_lt(R::splat(0.5), epsilon, u) * self.sign,
                    phi,
                };
            }
            let X = stages_of_part(&self.quintic, R::splat(0.0), at);
            let (mut there, geometry) = machine.advance_within(limit, self.phi, self.u, at * self.h, X, m);
            machine.settle(&mut there, &geometry);
            let value = self.is_speed.select_lt(R::splat(0.5), there.K[S - 1], there.end());
            Extreme { value: value * self.sign, phi: at.mul_add(self.h, self.phi) }
        })
    }

    /// The quantity near the quintic's peak, read at better and better places.
    #[inline(always)]
    fn read_around(
        &self,
        machine: &Machine<'_, R>,
        limit: f64,
        asides: &[f64],
        m: &mut Motion<R>,
    ) -> Extreme<R> {
        if let Some(series) = &self.series {
            return self.read_on_series(series, machine, limit, m);
        }
        let mut place = self.peak();
        let mut best = Extreme { value: R::splat(f64::NEG_INFINITY), phi: place };
        for &aside in asides {
            let middle = place.max(R::splat(aside)).min(R::splat(1.0 - aside));
            let (places, mut values) = ([middle - aside, middle, middle + aside], [middle; 3]);
            for i in 0..places.len() {
                let found = self.read(machine, limit, places[i], m);
                best.keep_larger(&found.inside(places[i]));
                values[i] = found.value;
            }
            let [left, centre, right] = values;
            let bend = left - centre - centre + right;
            let slope = right - left;
            let ahead = R::splat(LEAP * aside);
            let uphill = slope.select_lt(R::splat(0.0), -ahead, ahead);
            let top = (slope / bend * (-0.5 * aside)).max(-ahead).min(ahead);
            let better = middle + bend.select_lt(R::splat(0.0), top, uphill);
            place = better.max(R::splat(0.0)).min(R::splat(1.0));
        }
        best.keep_larger(&self.read(machine, limit, place, m).inside(place));
        best
    }

    /// The quantity at the peak of the series. Where the acceleration is another one there than the derivative of the series, the
    /// peak is displaced as well: then the top of a parabola through readings beside it is read too.
    #[inline(always)]
    fn read_on_series(
        &self,
        series: &[R; TERMS],
        machine: &Machine<'_, R>,
        limit: f64,
        m: &mut Motion<R>,
    ) -> Extreme<R> {
        let place = self.peak_of_series(series);
        let mut best = self.read(machine, limit, place, m);
        let (zero, half, centre) = (R::splat(0.0), R::splat(0.5), best.value);
        let of_series = derivatives(series, place)[1] / self.h * self.sign;
        let missed = self.is_speed.select_lt(half, (centre - of_series).abs(), zero);
        let least = centre.abs() * MISSED;
        if !least.any_below(missed) {
            return best;
        }
        let middle = place.max(R::splat(BESIDE)).min(R::splat(1.0 - BESIDE));
        let mut beside = [centre; 3];
        for (aside, value) in [-BESIDE, 0.0, BESIDE].into_iter().zip(&mut beside) {
            *value = self.read(machine, limit, middle + aside, m).value;
        }
        let [left, centre, right] = beside;
        let bend = left - centre - centre + right;
        let top = ((right - left) / bend * (-0.5 * BESIDE)).max(R::splat(-BESIDE)).min(R::splat(BESIDE));
        // Lanes whose series is as good keep what they have.
        let by = least.select_lt(missed, bend.select_lt(zero, top, zero), zero);
        let found = self.read(machine, limit, middle + by, m);
        let lowest = R::splat(f64::NEG_INFINITY);
        best.keep_larger(&Extreme { value: least.select_lt(missed, found.value, lowest), phi: found.phi });
        best
    }

    /// Place of the peak on the series, of which ε is the derivative: from the promised place by Newton, uphill where the
    /// curve is not concave. What the series miss displaces it, and the value falls short by the square of that.
    #[inline(always)]
    fn peak_of_series(&self, series: &[R; TERMS]) -> R {
        let (zero, one, stride) = (R::splat(0.0), R::splat(1.0), R::splat(STRIDE));
        let mut at = self.at;
        for _ in 0..STRIDES {
            let [_, first, second, third] = derivatives(series, at);
            let slope = self.is_speed.select_lt(R::splat(0.5), second, first) * self.sign;
            let bend = self.is_speed.select_lt(R::splat(0.5), third, second) * self.sign;
            let uphill = slope.select_lt(zero, -stride, stride);
            let newton = (-(slope / bend)).max(-stride).min(stride);
            let next = (at + bend.select_lt(zero, newton, uphill)).max(zero).min(one);
            // A NaN is not below the limit.
            at = next.select_lt(R::splat(2.0), next, at);
        }
        at
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

/// Smallest, with its sign turned, and largest value that the best of four parabolas through neighbouring samples
/// promise, with their places.
#[inline(always)]
fn peaks_of_step<R: Real>(y: &[R; N]) -> [Hint<R>; 2] {
    let zero = R::splat(0.0);
    let mut best = [Hint { value: -y[0], at: zero }, Hint { value: y[0], at: zero }];
    for i in 0..S - 1 {
        let found = peaks([AT[i], AT[i + 1], AT[i + 2]], [y[i], y[i + 1], y[i + 2]]);
        for (best, found) in best.iter_mut().zip(found) {
            best.at = best.value.select_lt(found.value, found.at, best.at);
            best.value = best.value.max(found.value);
        }
    }
    best
}

/// The same of the parabola through three points on their span.
#[inline(always)]
fn peaks<R: Real>(x: [f64; 3], y: [R; 3]) -> [Hint<R>; 2] {
    let (left, right) = (x[1] - x[0], x[2] - x[1]);
    let slope_left = (y[1] - y[0]) * (1.0 / left);
    let slope_right = (y[2] - y[1]) * (1.0 / right);
    let bend = (slope_right - slope_left) * (1.0 / (left + right));
    // Newton's form about the middle: y = y₁ + g (x − x₁) + bend (x − x₁)².
    let (left, right) = (R::splat(left), R::splat(right));
    let g = bend.mul_add(left, slope_left);
    let top = (g / (bend * -2.0)).max(-left).min(right);
    let mut hints = [Hint { value: y[1], at: top }; 2];
    for (hint, sign) in hints.iter_mut().zip([-1.0, 1.0]) {
        let outer = (y[0] * sign).select_lt(y[2] * sign, right, -left);
        // Concave parabolas have their top inside or beyond an end; for others the better end is the top.
        let dx = (bend * sign).select_lt(R::splat(0.0), top, outer);
        *hint = Hint { value: bend.mul_add(dx, g).mul_add(dx, y[1]) * sign, at: dx + x[1] };
    }
    hints
}
