//! What waves add up to: the greatest and the least value of a sum of harmonics over its period.
//!
//! ```text
//! f(τ) = Σ Re c_h e^{ihτ},    h = 0, 1, … H
//! ```
//!
//! Sampled at 8H places, f is nearly a parabola through three of them. Tops of these that may be the highest, as the bounds
//! |f″| ≤ Σ h² |c_h| and |f‴| ≤ Σ h³ |c_h| of the derivatives have it, are taken to the last digit by Newton. Samples are
//! taken in lanes, a wave each, many waves in threads.

use super::forced::Complex;
use linkwright_kernel::call::{in_threads, poll};
use linkwright_kernel::lanes::{Job, in_lanes};
use linkwright_kernel::real::Real;
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

/// Extremes of a wave, and where they are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extremes {
    pub max: f64,
    pub at_max: f64,
    pub min: f64,
    pub at_min: f64,
}

/// Extremes of waves given as a row a harmonic, a column a wave; NaN where a wave is not finite.
pub fn extremes(coefficients: &[Complex], waves: usize) -> Vec<Extremes> {
    if waves == 0 {
        return Vec::new();
    }
    let harmonics = coefficients.len() / waves;
    let quarter = (FINE / 4 * harmonics.saturating_sub(1)).max(1);
    let table = turns(4 * quarter, quarter, harmonics);
    let part = |task: usize| {
        let range = task * TASK..((task + 1) * TASK).min(waves);
        in_lanes(Sampled { coefficients, waves, range, quarter, table: &table })
    };
    let found: Vec<Vec<Extremes>> = in_threads(|crew| {
        (0..waves.div_ceil(TASK)).into_par_iter().map(|task| crew.task(|| part(task))).collect()
    });
    found.concat()
}

/// Waves a task: some half a millisecond of work.
const TASK: usize = 64;

struct Sampled<'a> {
    coefficients: &'a [Complex],
    waves: usize,
    range: Range<usize>,
    quarter: usize,
    table: &'a [[[f64; 2]; BLOCK]],
}

impl Job for Sampled<'_> {
    type Output = Vec<Extremes>;

    #[inline(always)]
    fn run<R: Real>(self) -> Vec<Extremes> {
        let Sampled { coefficients, waves, range, quarter, table } = self;
        let (harmonics, places) = (coefficients.len() / waves, 4 * quarter);
        let zero = R::splat(0.0);
        // Even and odd harmonics in turn: an odd number of them has one of zero at its end.
        let mut c = vec![(zero, zero); harmonics.next_multiple_of(2)];
        let mut samples = vec![0.0; places * R::LANES];
        let mut buffer = vec![0.0; 2 * R::LANES];
        let mut found = Vec::with_capacity(range.len());
        let end = range.end;
        for first in range.step_by(R::LANES) {
            poll();
            R::outline(
                #[inline(always)]
                || {
                    for (c, row) in c.iter_mut().zip(coefficients.chunks_exact(waves)) {
                        let (re, im) = buffer.split_at_mut(R::LANES);
                        for (lane, (re, im)) in re.iter_mut().zip(im.iter_mut()).enumerate() {
                            [*re, *im] = row[(first + lane).min(end - 1)];
                        }
                        *c = (R::load(re), R::load(im));
                    }
                    for (block, rows) in table.chunks_exact(c.len()).enumerate() {
                        let sums = parts(&c, rows);
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
                                value.store(&mut samples[place % places * R::LANES..][..R::LANES]);
                            }
                        }
                    }
                },
            );
            for lane in 0..R::LANES.min(end - first) {
                let mut wave: Vec<Complex> =
                    (0..harmonics).map(|h| coefficients[h * waves + first + lane]).collect();
                wave.resize(harmonics.next_multiple_of(ABREAST), [0.0; 2]);
                let of: Vec<f64> = samples.iter().skip(lane).step_by(R::LANES).copied().collect();
                found.push(wave_extremes(&wave, &of));
            }
        }
        found
    }
}

/// Places at which sums are taken beside each other: they do not wait for one another, and registers hold them.
const BLOCK: usize = 2;

/// cos hτ and sin hτ at the places of each block, harmonic by harmonic.
fn turns(places: usize, quarter: usize, harmonics: usize) -> Vec<[[f64; 2]; BLOCK]> {
    let (sin, cos): (Vec<f64>, Vec<f64>) =
        (0..places).map(|j| (TAU * j as f64 / places as f64).sin_cos()).unzip();
    let blocks = (quarter + 1).div_ceil(BLOCK);
    let harmonics = harmonics.next_multiple_of(2);
    let at = |block: usize, h: usize, b: usize| (BLOCK * block + b).min(quarter) * h % places;
    (0..blocks * harmonics)
        .map(|row| {
            let (block, h) = (row / harmonics, row % harmonics);
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

/// Extremes of one wave from its samples.
fn wave_extremes(wave: &[Complex], samples: &[f64]) -> Extremes {
    if samples.iter().any(|x| !x.is_finite()) {
        return Extremes { max: f64::NAN, at_max: f64::NAN, min: f64::NAN, at_min: f64::NAN };
    }
    let bounds = bounds(wave);
    let (at_max, max) = highest(wave, samples, 1.0, bounds);
    let (at_min, min) = highest(wave, samples, -1.0, bounds);
    Extremes { max, at_max, min: -min, at_min }
}

/// What second and third derivative of a wave do not exceed.
fn bounds(wave: &[Complex]) -> [f64; 2] {
    let (mut second, mut third) = (0.0, 0.0);
    for (h, [re, im]) in wave.iter().enumerate() {
        let (h, size) = (h as f64, (re * re + im * im).sqrt());
        second += h * h * size;
        third += h * h * h * size;
    }
    [second, third]
}

/// Where ±f is largest, and how much it is there; `second` and `third` are bounds of these derivatives.
fn highest(wave: &[Complex], samples: &[f64], sign: f64, [second, third]: [f64; 2]) -> (f64, f64) {
    let n = samples.len();
    let step = TAU / n as f64;
    let most = samples.iter().fold(f64::NEG_INFINITY, |most, x| most.max(sign * x));
    // A sample beside the top is no lower than that by more than half a step's parabola.
    let least = most - 0.125 * second * step * step;
    // Tops of parabolas through three samples: where, and how high.
    let mut tops = Vec::with_capacity(8);
    for (j, here) in samples.iter().enumerate() {
        let here = sign * here;
        if here < least {
            continue;
        }
        let (before, after) = (sign * samples[(j + n - 1) % n], sign * samples[(j + 1) % n]);
        if here >= before && here >= after {
            let bend = before - 2.0 * here + after;
            let shift = if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
            tops.push(((j as f64 + shift) * step, here - 0.25 * (before - after) * shift, here));
        }
    }
    let missed = MISSED * third * step.powi(3);
    tops.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut found = (0.0, f64::NEG_INFINITY);
    for (start, top, sample) in tops {
        if top + missed < found.1 {
            break;
        }
        let (at, value) = climb(wave, start, step, sign, sample);
        if value > found.1 {
            found = (at.rem_euclid(TAU), value);
        }
    }
    found
}

/// Newton from beside a top; no less than the sample if that leads nowhere.
fn climb(wave: &[Complex], start: f64, step: f64, sign: f64, sample: f64) -> (f64, f64) {
    let (mut at, mut best) = (start, (start, sample));
    for _ in 0..STEPS {
        let [value, d1, d2] = evaluate(wave, at);
        let shift = -d1 / d2;
        // So near the top f is its parabola, and its top is known without another look.
        let last = shift.abs() < NEAR * step;
        let there = sign * if last { value + 0.5 * d1 * shift } else { value };
        if there > best.1 {
            best = (if last { at + shift } else { at }, there);
        }
        let inside = sign * d2 < 0.0 && (at + shift - start).abs() <= step;
        if last || !inside {
            break;
        }
        at += shift;
    }
    best
}

/// How many harmonics are summed beside each other: one by one each would wait for the one before it.
const ABREAST: usize = 4;

/// f, f′ and f″ of a wave whose harmonics are filled up to a multiple of [`ABREAST`].
fn evaluate(wave: &[Complex], at: f64) -> [f64; 3] {
    let (s1, c1) = at.sin_cos();
    let further = |(s, c): (f64, f64)| (s * c1 + c * s1, c * c1 - s * s1);
    let mut turns = [(0.0, 1.0); ABREAST];
    for k in 1..ABREAST {
        turns[k] = further(turns[k - 1]);
    }
    let (s4, c4) = further(turns[ABREAST - 1]);
    let mut sums = [[0.0; 3]; ABREAST];
    for (first, four) in wave.chunks_exact(ABREAST).enumerate() {
        for (k, (sum, ((s, c), &[re, im]))) in sums.iter_mut().zip(turns.iter_mut().zip(four)).enumerate() {
            let h = (ABREAST * first + k) as f64;
            let (value, turned) = (re * *c - im * *s, re * *s + im * *c);
            sum[0] += value;
            sum[1] -= h * turned;
            sum[2] -= h * h * value;
            (*s, *c) = (*s * c4 + *c * s4, *c * c4 - *s * s4);
        }
    }
    std::array::from_fn(|part| sums.iter().map(|sum| sum[part]).sum())
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
        let c: Vec<Complex> = (0..waves * harmonics).map(|_| [random(), random()]).collect();
        let found = extremes(&c, waves);
        for (w, found) in found.iter().enumerate() {
            let mut wave: Vec<Complex> = (0..harmonics).map(|h| c[h * waves + w]).collect();
            wave.resize(harmonics.next_multiple_of(ABREAST), [0.0; 2]);
            let fine = (0..100_000).map(|j| evaluate(&wave, TAU * f64::from(j) / 1e5)[0]);
            let (low, high) = fine.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
            // Fine samples miss an extreme by no more than ½ f″ (π/1e5)².
            assert!(found.max >= high - 1e-12 && found.max < high + 1e-5, "{} {high}", found.max);
            assert!(found.min <= low + 1e-12 && found.min > low - 1e-5, "{} {low}", found.min);
            assert!((evaluate(&wave, found.at_max)[0] - found.max).abs() < 1e-12);
        }
    }

    #[test]
    fn a_constant_and_one_wave() {
        let found = extremes(&[[2.0, 0.0], [0.0, -3.0]], 1)[0];
        assert!((found.max - 5.0).abs() < 1e-14 && (found.min + 1.0).abs() < 1e-14);
        assert!((found.at_max - TAU / 4.0).abs() < 1e-7);
        assert_eq!(extremes(&[[2.0, 0.0]], 1)[0].max, 2.0);
    }
}
