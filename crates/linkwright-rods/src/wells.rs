//! Many strings at once, a string per lane; and the derivatives of one, a direction per lane.

use crate::cards::{Cards, cards, top_of};
use crate::fourier::Fourier;
use crate::prediction::{Prediction, Request, largest_change, predict};
use crate::pump::Pump;
use crate::string::Section;
use linkwright_kernel::call::{in_threads, poll};
use linkwright_kernel::dual::Dual;
use linkwright_kernel::lanes::{Job, in_lanes, in_single_lanes};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::{LANES_MAX, Real};
use rayon::prelude::*;

/// Numbers of a section, and of pump and period.
const OF_SECTION: usize = 4;
const OF_PUMP: usize = 8;

/// Strings of equally many sections and the motions of their polished rods, a row a string.
pub struct Wells<'a> {
    /// Sections of a string.
    pub sections: usize,
    /// Numbers: EA, μ, c, L of every section; F₀, κ, 1/(KA), slip, fillage, D, 1/n of the pump; the period.
    pub numbers: &'a [f64],
    /// Samples of the polished rod's position \[m\].
    pub motion: &'a [f64],
    /// Waves to start from.
    pub start: Option<&'a [f64]>,
    /// How solutions are sought.
    pub request: Request,
    /// Transforms of the samples, of twice as many for the cards, and of fewer to begin with.
    pub fourier: &'a [Fourier; 3],
}

/// Rows of results.
#[derive(Default)]
pub struct Found {
    /// Position \[m\] and load \[N\] of every station, a row a string.
    pub cards: [Vec<f64>; 2],
    /// Work that passes each station downward, then the heat of each section \[J\].
    pub work: Vec<f64>,
    /// The wave W that comes down \[N\].
    pub wave: Vec<f64>,
    /// Mean load of the plunger \[N\], and change of the wave in the last sweep.
    pub ends: Vec<f64>,
    /// Sweeps.
    pub sweeps: usize,
}

impl Wells<'_> {
    /// How many numbers a string has.
    pub fn width(&self) -> usize {
        OF_SECTION * self.sections + OF_PUMP
    }

    /// The motions of all strings.
    pub fn solved(&self) -> Vec<Found> {
        self.bundles(self.numbers, in_lanes(Lanes), |first, count| {
            in_lanes(RowsJob { wells: self, first, count })
        })
    }

    /// The cards by samples of load at the polished rod beside those of its motion, of which `harmonics` count.
    pub fn carried(&self, load: &[f64], harmonics: usize) -> Vec<Found> {
        let job = |first, count| CarriedJob { wells: self, load, harmonics, first, count };
        self.bundles(self.numbers, in_single_lanes(Lanes), |first, count| in_single_lanes(job(first, count)))
    }

    /// Work on the rows of a table of numbers, as many at once as there are lanes.
    fn bundles(
        &self,
        numbers: &[f64],
        lanes: usize,
        work: impl Fn(usize, usize) -> Found + Sync,
    ) -> Vec<Found> {
        let rows = numbers.len() / self.width();
        let task = |&first: &usize| work(first, lanes.min(rows - first));
        let firsts: Vec<usize> = (0..rows).step_by(lanes).collect();
        if firsts.len() == 1 {
            return firsts.iter().map(task).collect();
        }
        in_threads(|crew| firsts.par_iter().map(|first| crew.task(|| task(first))).collect())
    }

    /// Derivatives of the motion of the first string, of which `start` is the wave: by directions of its numbers and of its motion.
    pub fn along(&self, numbers: &[f64], motion: &[f64]) -> Vec<Found> {
        let job = |first, count| AlongJob { wells: self, numbers, motion, first, count };
        self.bundles(numbers, in_single_lanes(Lanes), |first, count| in_single_lanes(job(first, count)))
    }
}

/// How many lanes there are.
struct Lanes;

impl Job for Lanes {
    type Output = usize;

    #[inline(always)]
    fn run<R: Real>(self) -> usize {
        R::LANES
    }
}

struct RowsJob<'a> {
    wells: &'a Wells<'a>,
    first: usize,
    count: usize,
}

impl Job for RowsJob<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<R: Real>(self) -> Found {
        let RowsJob { wells, first, count } = self;
        let read = |table: &[f64], width| gathered::<R>(table, width, first, count);
        let n = wells.fourier[0].samples;
        let numbers = read(wells.numbers, wells.width());
        let motion = read(wells.motion, n);
        let start = wells.start.map(|start| read(start, n));
        let measure = |wave: &[R], next: &[R], load| largest_change(wave, next) / load;
        solved(wells, &numbers, &motion, start.as_deref(), measure, |x| x, count)
    }
}

struct CarriedJob<'a> {
    wells: &'a Wells<'a>,
    load: &'a [f64],
    harmonics: usize,
    first: usize,
    count: usize,
}

impl Job for CarriedJob<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<R: Real>(self) -> Found {
        let CarriedJob { wells, first, count, .. } = self;
        poll();
        let fourier = &wells.fourier[0];
        let read = |table: &[f64], width| gathered::<R>(table, width, first, count);
        let (sections, pump) = parts(wells.sections, &read(wells.numbers, wells.width()));
        let (position, load) = (read(wells.motion, fourier.samples), read(self.load, fourier.samples));
        let top = top_of(&position, &load, self.harmonics + 1, fourier);
        let along = cards(&sections, pump.1, &top, fourier);
        out_of_line!(R, handed(None, along, |x| x, count))
    }
}

struct AlongJob<'a> {
    wells: &'a Wells<'a>,
    numbers: &'a [f64],
    motion: &'a [f64],
    first: usize,
    count: usize,
}

impl Job for AlongJob<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<R: Real>(self) -> Found {
        let AlongJob { wells, first, count, .. } = self;
        let read = |values: &[f64], d: &[f64], width: usize| -> Vec<Dual<R>> {
            let d = gathered::<R>(d, width, first, count);
            values.iter().zip(d).map(|(&value, d)| Dual { value: R::splat(value), d }).collect()
        };
        let numbers = read(wells.numbers, self.numbers, wells.width());
        let motion = read(wells.motion, self.motion, wells.fourier[0].samples);
        let still = vec![0.0; wells.fourier[0].samples];
        let start = wells.start.map(|start| {
            start.iter().zip(&still).map(|(&x, _)| Dual::constant(R::splat(x))).collect::<Vec<_>>()
        });
        // The change of the derivatives over their size.
        let measure = |wave: &[Dual<R>], next: &[Dual<R>], _| {
            out_of_line!(R, {
                let (mut change, mut size) = (R::splat(0.0), R::splat(f64::MIN_POSITIVE));
                for (a, b) in wave.iter().zip(next) {
                    change = change.max((a.d - b.d).abs());
                    size = size.max(b.d.abs());
                }
                Dual::constant(change / size)
            })
        };
        solved(wells, &numbers, &motion, start.as_deref(), measure, |x: Dual<R>| x.d, count)
    }
}

/// Rows of a table as lanes, the last one again where there are fewer.
#[inline(always)]
fn gathered<R: Real>(table: &[f64], width: usize, first: usize, count: usize) -> Vec<R> {
    let mut lanes = [0.0; LANES_MAX];
    let mut list = Vec::with_capacity(width);
    for j in 0..width {
        for (lane, x) in lanes[..R::LANES].iter_mut().enumerate() {
            *x = table[(first + lane.min(count - 1)) * width + j];
        }
        list.push(R::load(&lanes));
    }
    list
}

/// The motion of the strings of a bundle; `part`: what of a number is asked for.
#[inline(always)]
fn solved<P: Real, R: Real>(
    wells: &Wells<'_>,
    numbers: &[R],
    motion: &[R],
    start: Option<&[R]>,
    measure: impl Fn(&[R], &[R], R) -> R,
    part: impl Fn(R) -> P,
    count: usize,
) -> Found {
    poll();
    let (sections, (pump, period)) = parts(wells.sections, numbers);
    let [own, finer, coarse] = wells.fourier;
    let found = predict(&sections, &pump, period, motion, start, wells.request, [coarse, own], measure);
    let along = cards(&sections, period, &found.top, finer);
    out_of_line!(P, handed(Some(found), along, part, count))
}

/// Sections, pump and period by their numbers.
#[inline(always)]
fn parts<R: Real>(sections: usize, numbers: &[R]) -> (Vec<Section<R>>, (Pump<R>, R)) {
    let (of_sections, of_pump) = numbers.split_at(OF_SECTION * sections);
    let section = |of: &[R]| Section { rigidity: of[0], mass: of[1], damping: of[2], length: of[3] };
    let sections: Vec<Section<R>> = of_sections.chunks_exact(OF_SECTION).map(section).collect();
    let pump = Pump {
        load: of_pump[0],
        impedance: sections[sections.len() - 1].impedance(),
        compliance: of_pump[1],
        compressibility: of_pump[2],
        slip: of_pump[3],
        fillage: of_pump[4],
        discharge: of_pump[5],
        softness: of_pump[6],
    };
    (sections, (pump, of_pump[7]))
}

/// Lanes as rows.
#[inline(always)]
fn handed<P: Real, R: Real>(
    found: Option<Prediction<R>>,
    along: Cards<R>,
    part: impl Fn(R) -> P,
    count: usize,
) -> Found {
    let rows = |list: &[R]| {
        let mut lanes = [0.0; LANES_MAX];
        let mut to = vec![0.0; list.len() * count];
        for (j, &x) in list.iter().enumerate() {
            part(x).store(&mut lanes);
            for (row, &x) in lanes[..count].iter().enumerate() {
                to[row * list.len() + j] = x;
            }
        }
        to
    };
    Found {
        cards: [rows(&along.position), rows(&along.load)],
        work: rows(&[along.work, along.loss].concat()),
        wave: found.as_ref().map_or(vec![], |found| rows(&found.wave)),
        ends: found.as_ref().map_or(vec![], |found| rows(&[found.mean_load, found.change])),
        sweeps: found.map_or(0, |found| found.sweeps),
    }
}
