//! What waves add up to: the maximum and the minimum value of a sum of harmonics over its period.
//!
//! ```text
//! f(τ) = Σ Re c_h e^{ihτ},    h = 0, 1, … H
//! ```
//!
//! Sampled at 8H places, f is nearly a parabola through three of them. Tops of these that may be the highest, as the bounds
//! |f″| ≤ Σ h² |c_h| and |f‴| ≤ Σ h³ |c_h| of the derivatives have it, are taken to the last digit by Newton. Samples are
//! taken in lanes, a wave each, many waves in threads. Harmonics that no wave has are left out: orders of gears without a
//! simple ratio have a base far below them.

use linkwright_kernel::call::{in_threads, poll};
use linkwright_kernel::lanes::{Job, in_lanes};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::ops::Range;

/// Samples in a period of the highest harmonic.
const FINE: usize = 8;

/// Share of h³ max |f‴| by which the top of a parabola through three samples h apart may miss that of f: 1/(9√3).
const MISSED: f64 = 0.0642;

/// Newton's steps: it starts within a hundredth of the shortest period.
const STEPS: usize = 8;

/// Share of a step below which f is a parabola about its top, to rounding.
const NEAR: f64 = 1e-4;

/// Share of a height that is rounding.
const ROUNDING: f64 = 1e-14;

/// Extremes of a wave, and where they are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extremes {
    pub max: f64,
    pub at_max: f64,
    pub min: f64,
    pub at_min: f64,
}

/// Extremes of waves given as a row a harmonic, a column a wave; NaN where a wave is not finite.
pub fn extremes(coefficients: &[Complex64], waves: usize) -> Vec<Extremes> {
    if waves == 0 {
        return Vec::new();
    }
    let harmonics = coefficients.len() / waves;
    let quarter = (FINE / 4 * harmonics.saturating_sub(1)).max(1);
    let numbers = present(coefficients, waves);
    let table = turns(4 * quarter, quarter, &numbers);
    let part = |task: usize| {
        let range = task * TASK..((task + 1) * TASK).min(waves);
        in_lanes(WaveJob { coefficients, waves, range, quarter, numbers: &numbers, table: &table })
    };
    let found: Vec<Vec<Extremes>> = in_threads(|crew| {
        (0..waves.div_ceil(TASK)).into_par_iter().map(|task| crew.task(|| part(task))).collect()
    });
    found.concat()
}

/// Waves a task: some half a millisecond of work.
const TASK: usize = 64;

struct WaveJob<'a> {
    coefficients: &'a [Complex64],
    waves: usize,
    range: Range<usize>,
    quarter: usize,
    numbers: &'a [usize],
    table: &'a [[[f64; 2]; BLOCK]],
}

/// Numbers of the harmonics that some wave has, even and odd ones in turn; a number that no wave has fills the shorter list.
fn present(coefficients: &[Complex64], waves: usize) -> Vec<usize> {
    let filler = (coefficients.len() / waves).next_multiple_of(2);
    let rows = coefficients.chunks_exact(waves).enumerate();
    let (mut even, mut odd): (Vec<usize>, Vec<usize>) = rows
        .filter(|(_, row)| row.iter().any(|c| *c != Complex64::ZERO))
        .map(|(h, _)| h)
        .partition(|h| h % 2 == 0);
    let pairs = even.len().max(odd.len()).max(1);
    even.resize(pairs, filler);
    odd.resize(pairs, filler + 1);
    even.into_iter().zip(odd).flat_map(|(even, odd)| [even, odd]).collect()
}

impl Job for WaveJob<'_> {
    type Output = Vec<Extremes>;

    #[inline(always)]
    fn run<R: Real>(self) -> Vec<Extremes> {
        let WaveJob { coefficients, waves, range, quarter, numbers, table } = self;
        let (harmonics, places) = (coefficients.len() / waves, 4 * quarter);
        let zero = R::splat(0.0);
        let mut c = vec![(zero, zero); numbers.len()];
        // The first and the last once more behind the other end, so that each has its neighbours.
        let mut samples = vec![0.0; (places + 2) * R::LANES];
        let mut buffer = vec![0.0; 2 * R::LANES];
        let mut tops = vec![[const { Vec::new() }; 2]; R::LANES];
        let mut thirds = vec![0.0; R::LANES];
        let mut wave = Wave::default();
        let mut found = Vec::with_capacity(range.len());
        let end = range.end;
        for first in range.step_by(R::LANES) {
            poll();
            out_of_line!(R, {
                for (c, &h) in c.iter_mut().zip(numbers).filter(|(_, h)| **h < harmonics) {
                    let row = &coefficients[h * waves..][..waves];
                    let (re, im) = buffer.split_at_mut(R::LANES);
                    for (lane, (re, im)) in re.iter_mut().zip(im.iter_mut()).enumerate() {
                        let z = row[(first + lane).min(end - 1)];
                        (*re, *im) = (z.re, z.im);
                    }
                    *c = (R::load(re), R::load(im));
                }
                let [second, third] = bounds(&c, numbers);
                third.store(&mut thirds);
                let range = sample(&c, table, quarter, &mut samples);
                for (side, sign) in SIGNS.into_iter().enumerate() {
                    let top = range[side] * sign;
                    tops_of(&samples, sign, least_beside(top, second, places), side, &mut tops);
                }
            });
            for lane in 0..R::LANES.min(end - first) {
                wave.set((0..harmonics).map(|h| coefficients[h * waves + first + lane]));
                found.push(out_of_line!(R, wave_extremes(&wave, &mut tops[lane], places, thirds[lane])));
            }
        }
        found
    }
}

/// Maxima, then minima.
const SIGNS: [f64; 2] = [1.0, -1.0];

/// The top of a parabola through three samples: where, how high, and the sample in the middle.
type Top = (f64, f64, f64);

/// Samples all waves at even places; their maximum and minimum.
#[inline(always)]
fn sample<R: Real>(c: &[(R, R)], table: &[[[f64; 2]; BLOCK]], quarter: usize, samples: &mut [f64]) -> [R; 2] {
    let places = 4 * quarter;
    let (mut most, mut least) = (R::splat(f64::NEG_INFINITY), R::splat(f64::INFINITY));
    for (block, rows) in table.chunks_exact(c.len()).enumerate() {
        let sums = parts(c, rows);
        for (b, [ce, se, co, so]) in sums.into_iter().enumerate() {
            let j = (BLOCK * block + b).min(quarter);
            // ±τ and π ± τ share their cosines and sines but for the sign.
            let (plus, minus) = (ce + co, ce - co);
            let (up, down) = (se + so, se - so);
            let mirrored = [
                (j, plus - up),
                (places - j, plus + up),
                (2 * quarter - j, minus + down),
                (2 * quarter + j, minus - down),
            ];
            for (place, value) in mirrored {
                most = most.max(value);
                least = least.min(value);
                value.store(&mut samples[(place % places + 1) * R::LANES..][..R::LANES]);
            }
        }
    }
    samples.copy_within(places * R::LANES..(places + 1) * R::LANES, 0);
    samples.copy_within(R::LANES..2 * R::LANES, (places + 1) * R::LANES);
    [most, least]
}

/// A sample beside the top of a wave is no lower than that by more than half a step's parabola.
#[inline(always)]
fn least_beside<R: Real>(most: R, second: R, places: usize) -> R {
    let step = TAU / places as f64;
    most - second * 0.125 * step * step
}

/// Tops of parabolas about samples of ±f that are no lower than a limit, lane by lane.
#[inline(always)]
fn tops_of<R: Real>(samples: &[f64], sign: f64, least: R, side: usize, tops: &mut [[Vec<Top>; 2]]) {
    let step = TAU / (samples.len() / R::LANES - 2) as f64;
    tops.iter_mut().for_each(|lane| lane[side].clear());
    let mut limits = [0.0; 16];
    least.store(&mut limits);
    // Strictly below, so that a sample on the limit, and one as high as its neighbour, are looked at.
    let below = least - least.abs() * f64::EPSILON - R::splat(f64::MIN_POSITIVE);
    let (one, below_zero) = (R::splat(1.0), R::splat(-f64::MIN_POSITIVE));
    for (j, rows) in samples.windows(3 * R::LANES).step_by(R::LANES).enumerate() {
        let (before, rest) = rows.split_at(R::LANES);
        let (here, after) = rest.split_at(R::LANES);
        let sample = R::load(here) * sign;
        let rise = (sample - R::load(before) * sign).min(sample - R::load(after) * sign);
        if !below_zero.any_below(below.select_lt(sample, rise, -one)) {
            continue;
        }
        for (lane, tops) in tops.iter_mut().enumerate() {
            let [before, here, after] = [before, here, after].map(|row| sign * row[lane]);
            if here >= limits[lane] && here >= before && here >= after {
                let bend = before - 2.0 * here + after;
                let shift = if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
                let height = here - 0.25 * (before - after) * shift;
                tops[side].push(((j as f64 + shift) * step, height, here));
            }
        }
    }
}

/// Places at which sums are taken beside each other: they do not wait for one another, and registers hold them.
const BLOCK: usize = 2;

/// cos hτ and sin hτ at the places of each block, for the numbers h one by one.
fn turns(places: usize, quarter: usize, numbers: &[usize]) -> Vec<[[f64; 2]; BLOCK]> {
    let (sin, cos): (Vec<f64>, Vec<f64>) =
        (0..places).map(|j| (TAU * j as f64 / places as f64).sin_cos()).unzip();
    let blocks = (quarter + 1).div_ceil(BLOCK);
    let at = |block: usize, h: usize, b: usize| (BLOCK * block + b).min(quarter) * h % places;
    (0..blocks * numbers.len())
        .map(|row| {
            let (block, h) = (row / numbers.len(), numbers[row % numbers.len()]);
            std::array::from_fn(|b| [cos[at(block, h, b)], sin[at(block, h, b)]])
        })
        .collect()
}

/// Sums of Re c cos hτ and Im c sin hτ over even, then over odd harmonics, at the places of a block.
#[inline(always)]
fn parts<R: Real>(c: &[(R, R)], rows: &[[[f64; 2]; BLOCK]]) -> [[R; 4]; BLOCK] {
    let mut sums = [[R::splat(0.0); 4]; BLOCK];
    for (c, rows) in c.chunks_exact(2).zip(rows.chunks_exact(2)) {
        let ((even_re, even_im), (odd_re, odd_im)) = (c[0], c[1]);
        for b in 0..BLOCK {
            let [[even_cos, even_sin], [odd_cos, odd_sin]] = [rows[0][b], rows[1][b]];
            sums[b][0] = even_re.mul_add(R::splat(even_cos), sums[b][0]);
            sums[b][1] = even_im.mul_add(R::splat(even_sin), sums[b][1]);
            sums[b][2] = odd_re.mul_add(R::splat(odd_cos), sums[b][2]);
            sums[b][3] = odd_im.mul_add(R::splat(odd_sin), sums[b][3]);
        }
    }
    sums
}

/// Extremes of one wave from tops of its samples and of those of −f; `third` is a bound of its third derivative.
#[inline(always)]
fn wave_extremes(wave: &Wave, tops: &mut [Vec<Top>; 2], places: usize, third: f64) -> Extremes {
    // The bound counts every coefficient but the mean.
    if !(third.is_finite() && wave.rows[0].iter().all(|part| part[0].is_finite())) {
        return Extremes { max: f64::NAN, at_max: f64::NAN, min: f64::NAN, at_min: f64::NAN };
    }
    let (at_max, max) = highest(wave, &mut tops[0], SIGNS[0], places, third);
    let (at_min, min) = highest(wave, &mut tops[1], SIGNS[1], places, third);
    Extremes { max, at_max, min: -min, at_min }
}

/// What second and third derivative of waves do not exceed.
#[inline(always)]
fn bounds<R: Real>(c: &[(R, R)], numbers: &[usize]) -> [R; 2] {
    let (mut second, mut third) = (R::splat(0.0), R::splat(0.0));
    for (&h, &(re, im)) in numbers.iter().zip(c) {
        let (h, size) = (h as f64, (re * re + im * im).sqrt());
        second = second + size * (h * h);
        third = third + size * (h * h * h);
    }
    [second, third]
}

/// Where ±f is largest, and how much it is there.
#[inline(always)]
fn highest(wave: &Wave, tops: &mut [Top], sign: f64, places: usize, third: f64) -> (f64, f64) {
    let step = TAU / places as f64;
    let missed = MISSED * third * step.powi(3);
    if tops.len() > 1 {
        tops.sort_by(|a, b| b.1.total_cmp(&a.1));
    }
    let mut found = (0.0, f64::NEG_INFINITY);
    for &(start, top, sample) in tops.iter() {
        if top + missed < found.1 {
            break;
        }
        let (at, value) = climb(wave, (start, sample), step, sign, (third, found.1));
        if value > found.1 {
            found = (at.rem_euclid(TAU), value);
        }
    }
    found
}

/// Newton from beside a top; no less than the sample if that leads nowhere. A top that, by a bound of the third derivative,
/// stays below a height is left: a fast wave on a slow one has many that are nearly equal.
#[inline(always)]
fn climb(
    wave: &Wave,
    (start, sample): (f64, f64),
    step: f64,
    sign: f64,
    (third, height): (f64, f64),
) -> (f64, f64) {
    let (mut at, mut best) = (start, (start, sample));
    for _ in 0..STEPS {
        let [value, d1, d2] = evaluate(wave, at);
        let shift = -d1 / d2;
        // So near the top f is its parabola, and its top is known without another look.
        let last = shift.abs() < NEAR * step;
        let there = sign * if last { value + 0.5 * d1 * shift } else { value };
        // Two heights near the top differ by rounding: the top is where the slope is zero.
        if there > best.1 || (last && there > best.1 - ROUNDING * best.1.abs()) {
            best = (if last { at + shift } else { at }, there.max(best.1));
        }
        let inside = sign * d2 < 0.0 && (at + shift - start).abs() <= step;
        // The slope changes its sign within twice the shift.
        let reach = 2.0 * shift.abs();
        let is_known = inside && third * reach < 0.5 * d2.abs();
        if is_known && sign * (value + 0.5 * d1 * shift) + third * reach.powi(3) / 6.0 < height {
            break;
        }
        if last || !inside {
            break;
        }
        at += shift;
    }
    best
}

/// How many harmonics are summed beside each other: one by one each would wait for the one before it.
const ABREAST: usize = 4;

/// Harmonics of a wave, some side by side: real parts and imaginary parts, the last filled up with zeros.
#[derive(Clone, Debug, Default)]
struct Wave {
    rows: Vec<[[f64; ABREAST]; 2]>,
}

impl Wave {
    /// Takes the harmonics of another wave.
    fn set(&mut self, harmonics: impl ExactSizeIterator<Item = Complex64>) {
        self.rows.clear();
        self.rows.resize(harmonics.len().div_ceil(ABREAST), [[0.0; ABREAST]; 2]);
        for (h, z) in harmonics.enumerate() {
            let [real, imaginary] = &mut self.rows[h / ABREAST];
            (real[h % ABREAST], imaginary[h % ABREAST]) = (z.re, z.im);
        }
    }
}

/// f, f′ and f″ of a wave at an angle.
#[inline(always)]
fn evaluate(wave: &Wave, at: f64) -> [f64; 3] {
    let (s1, c1) = at.sin_cos();
    let next = |(s, c): (f64, f64)| (s * c1 + c * s1, c * c1 - s * s1);
    let (mut s, mut c) = ([0.0; ABREAST], [1.0; ABREAST]);
    for k in 1..ABREAST {
        (s[k], c[k]) = next((s[k - 1], c[k - 1]));
    }
    let (s4, c4) = next((s[ABREAST - 1], c[ABREAST - 1]));
    let [mut value, mut slope, mut bend] = [[0.0; ABREAST]; 3];
    for (row, h) in wave.rows.iter().zip(0..) {
        let [re, im] = row;
        let first = f64::from(ABREAST as u32 * h);
        for k in 0..ABREAST {
            let h = first + k as f64;
            let (here, turned) = (re[k] * c[k] - im[k] * s[k], re[k] * s[k] + im[k] * c[k]);
            value[k] += here;
            slope[k] -= h * turned;
            bend[k] -= h * h * here;
            (s[k], c[k]) = (s[k] * c4 + c[k] * s4, c[k] * c4 - s[k] * s4);
        }
    }
    [value, slope, bend].map(|parts| parts.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random waves against samples a thousand times finer.
    #[test]
    fn extremes_against_fine_samples() {
        let (waves, harmonics) = (37, 25);
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
        };
        let c: Vec<Complex64> = (0..waves * harmonics).map(|_| Complex64::new(random(), random())).collect();
        let found = extremes(&c, waves);
        for (w, found) in found.iter().enumerate() {
            let mut wave = Wave::default();
            wave.set((0..harmonics).map(|h| c[h * waves + w]));
            let fine = (0..100_000).map(|j| evaluate(&wave, TAU * f64::from(j) / 1e5)[0]);
            let (low, high) = fine.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
            // Fine samples miss an extreme by no more than ½ f″ (π/1e5)².
            assert!(found.max >= high - 1e-12 && found.max < high + 1e-5, "{} {high}", found.max);
            assert!(found.min <= low + 1e-12 && found.min > low - 1e-5, "{} {low}", found.min);
            assert!((evaluate(&wave, found.at_max)[0] - found.max).abs() < 1e-12);
            // Newton's last step squares a ten-thousandth of the distance of samples, 0.03; the height alone would tell
            // the place to the root of rounding.
            for at in [found.at_max, found.at_min] {
                let [_, slope, bend] = evaluate(&wave, at);
                assert!((slope / bend).abs() < 1e-10, "{}", slope / bend);
            }
        }
    }

    /// A base far below the orders: most harmonics are of no wave, of the others more are even than odd.
    #[test]
    fn harmonics_far_apart() {
        let (waves, harmonics) = (3, 311);
        let mut c = vec![Complex64::ZERO; waves * harmonics];
        for (n, h) in [0, 2, 62, 124, 155, 310].into_iter().enumerate() {
            for w in 0..waves {
                c[h * waves + w] = Complex64::new(1.0 / (n + w + 1) as f64, 0.3 * (n * w) as f64 - 0.5);
            }
        }
        for (w, found) in extremes(&c, waves).iter().enumerate() {
            let mut wave = Wave::default();
            wave.set((0..harmonics).map(|h| c[h * waves + w]));
            let fine = (0..1_000_000).map(|j| evaluate(&wave, TAU * f64::from(j) / 1e6)[0]);
            let (low, high) = fine.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
            assert!(found.max >= high - 1e-12 && found.max < high + 1e-5, "{} {high}", found.max);
            assert!(found.min <= low + 1e-12 && found.min > low - 1e-5, "{} {low}", found.min);
        }
        assert_eq!(extremes(&[Complex64::ZERO; 2], 1)[0].max, 0.0);
    }

    #[test]
    fn a_constant_and_one_wave() {
        let found = extremes(&[Complex64::new(2.0, 0.0), Complex64::new(0.0, -3.0)], 1)[0];
        assert!((found.max - 5.0).abs() < 1e-14 && (found.min + 1.0).abs() < 1e-14);
        assert!((found.at_max - TAU / 4.0).abs() < 1e-14);
        assert_eq!(extremes(&[Complex64::new(2.0, 0.0)], 1)[0].max, 2.0);
    }
}
