//! Curves, extremes and power of a steady motion.

use crate::equation::{Equation, Rates, Row};
use crate::mesh::Rows;
use crate::steady::Steady;
use crate::work::Work;
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::plane::Angle;
use linkwright_kernel::radau::{AT, B, N, S, value};

/// Shorter part of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Share of a step to which the place of an extreme is known: its value is then known to rounding.
const PLACE: f64 = 1e-8;

/// Values at most that are read for an extreme.
const READINGS: usize = 60;

/// Share of the range of a quantity by which a peak of its samples may lie below the highest and still be the highest.
pub(crate) const LOWER: f64 = 0.05;

/// How far inside a step its ends are read, as a share of it: kinks lie on them.
const INSIDE: f64 = 1e-9;

/// Minimum and maximum with their crank angles \[rad\].
#[derive(Clone, Copy, Debug)]
pub struct Extremes {
    /// Minimum.
    pub min: f64,
    /// Where it is.
    pub min_at: f64,
    /// Maximum.
    pub max: f64,
    /// Where it is.
    pub max_at: f64,
}

/// Curves over crank angles, one list after another for every part.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    /// From the start of the cycle \[s\].
    pub time: Vec<f64>,
    /// Of the masses \[rad/s\].
    pub speed: Vec<f64>,
    /// Of the masses \[rad/s²\].
    pub acceleration: Vec<f64>,
    /// Of the links \[rad\].
    pub twist: Vec<f64>,
    /// Of the links \[N m\].
    pub torque: Vec<f64>,
    /// Of the drivers at their masses \[N m\].
    pub drive: Vec<f64>,
    /// Of all loads, referred to the crank \[N m\].
    pub load: Vec<f64>,
}

/// Extremes and means of a cycle.
#[derive(Clone, Debug)]
pub struct Measures {
    /// Duration of a cycle \[s\].
    pub period: f64,
    /// Of the masses \[rad/s\].
    pub speed: Vec<Extremes>,
    /// Of the masses \[rad/s²\].
    pub acceleration: Vec<Extremes>,
    /// Of the links \[rad\].
    pub twist: Vec<Extremes>,
    /// Of the links \[N m\].
    pub torque: Vec<Extremes>,
    /// Mean torques of the links over time \[N m\].
    pub torque_mean: Vec<f64>,
    /// Root mean square torques over time \[N m\].
    pub torque_rms: Vec<f64>,
    /// Work that the dampers of the links take in a cycle \[J\].
    pub loss: Vec<f64>,
    /// Torques of the drivers \[N m\].
    pub drive: Vec<Extremes>,
    /// Mean torques of the drivers over time \[N m\].
    pub drive_mean: Vec<f64>,
    /// Work of the drivers in a cycle \[J\].
    pub drive_work: Vec<f64>,
    /// Work that loads and damping from outside take in a cycle \[J\].
    pub load_work: f64,
}

/// A steady motion with the machine that it is of.
pub struct Reading<'a> {
    /// The machine.
    pub equation: Equation<'a>,
    /// Its motion.
    pub steady: &'a Steady,
}

impl<'a> Reading<'a> {
    fn plan(&self) -> &'a Plan {
        self.equation.plan
    }

    /// Extremes, means and work of a cycle.
    pub fn measures(&self) -> Measures {
        let (chain, steady) = (self.equation.chain, self.steady);
        let (n, links, steps) = (chain.masses(), &chain.links, steady.mesh.steps());
        let mut rates = Rates::new(chain);
        // Of accelerations, then drivers, what stages have.
        let drivers = chain.drivers.len();
        let mut at_stages = vec![0.0; (n + drivers) * steps * S];
        let mut work = Work::new(chain);
        for k in 0..steps {
            let h = steady.mesh.length(k);
            for i in 0..S {
                let (y, row) = (steady.solution.stage(k, i), steady.mesh.rows.row(k * S + i));
                if i == S - 1 {
                    self.equation.rates_before(&row, y, None, &mut rates);
                } else {
                    self.equation.rates(&row, y, &mut rates);
                }
                for (part, &x) in rates.acceleration.iter().chain(&rates.drive).enumerate() {
                    at_stages[(part * steps + k) * S + i] = x;
                }
                work.add(chain, &rates, y, h * B[i]);
            }
        }
        let of = |at: &dyn Fn(&[f64]) -> f64| self.of_state(at);
        let torques = |which: usize| (0..links.len()).map(|link| work.torques(link)[which]).collect();
        let stages = |part: usize| &at_stages[part * steps * S..][..steps * S];
        Measures {
            period: work.period,
            speed: (0..n).map(|mass| of(&|y| chain.speed(mass, y))).collect(),
            acceleration: (0..n)
                .map(|mass| self.of_rates(stages(mass), &|rates| rates.acceleration[mass]))
                .collect(),
            twist: links.iter().map(|link| of(&|y| chain.twist(link, y)[0])).collect(),
            torque: links.iter().map(|link| of(&|y| chain.torque(link, y).value)).collect(),
            torque_mean: torques(0),
            torque_rms: torques(1),
            loss: work.links.iter().map(|sums| sums[2]).collect(),
            drive: (0..drivers)
                .map(|driver| self.of_rates(stages(n + driver), &|rates| rates.drive[driver]))
                .collect(),
            drive_mean: (0..drivers).map(|driver| work.mean_drive(driver)).collect(),
            drive_work: work.drivers.iter().map(|sums| sums[1]).collect(),
            load_work: work.load,
        }
    }

    /// Extremes of something that the state tells.
    fn of_state(&self, of: &dyn Fn(&[f64]) -> f64) -> Extremes {
        let solution = &self.steady.solution;
        let mut y = vec![0.0; solution.states()];
        let sample =
            |k: usize, j: usize| of(if j == 0 { solution.start_of(k) } else { solution.stage(k, j - 1) });
        self.extremes(&sample, &mut |k, share| {
            solution.state(k, share, &mut y);
            of(&y)
        })
    }

    /// Extremes of an acceleration or the torque of a driver, of which the stages have samples.
    fn of_rates(&self, at_stages: &[f64], of: &dyn Fn(&Rates) -> f64) -> Extremes {
        let (steady, chain) = (self.steady, self.equation.chain);
        let (plan, q) = (self.plan(), self.equation.q);
        let mut motion = Motion::new(&plan.mechanism, q);
        let mut geometry = Vec::new();
        let (mut y, mut rates) = (vec![0.0; chain.states()], Rates::new(chain));
        let sample = |k: usize, j: usize| at_stages[k * S + j.max(1) - 1];
        self.extremes(&sample, &mut |k, share| {
            steady.solution.state(k, share, &mut y);
            let share = share.clamp(INSIDE, 1.0 - INSIDE);
            let phi = steady.mesh.edges[k] + share * steady.mesh.length(k);
            let reduced = plan.reduce::<f64, 2>(q, Angle::new(phi), 1.0, &mut motion);
            geometry.clear();
            plan.add_geometry(q, phi, &motion, &mut geometry);
            self.equation.rates(&Row { phi, reduced, geometry: &geometry }, &y, &mut rates);
            of(&rates)
        })
    }

    /// Extremes by samples at start and stages of every step, and by values at any share of a step.
    fn extremes(
        &self,
        sample: &dyn Fn(usize, usize) -> f64,
        at: &mut dyn FnMut(usize, f64) -> f64,
    ) -> Extremes {
        let steps = self.steady.mesh.steps();
        let samples: Vec<f64> =
            (0..steps).flat_map(|k| (0..N).map(move |j| (k, j))).map(|(k, j)| sample(k, j)).collect();
        let [low, high] = samples
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &x| [low.min(x), high.max(x)]);
        let mut best = [(low, 0.0), (high, 0.0)];
        for ((value, angle), sign) in best.iter_mut().zip([-1.0, 1.0]) {
            let (top, mut highest) = (if sign > 0.0 { high } else { -low }, f64::NEG_INFINITY);
            let least = top - LOWER * (high - low);
            for (i, &x) in samples.iter().enumerate() {
                let near = |i: usize| samples.get(i).map_or(f64::NEG_INFINITY, |x| sign * x);
                let before = if i == 0 { f64::NEG_INFINITY } else { near(i - 1) };
                if sign * x < least || sign * x < before || sign * x < near(i + 1) {
                    continue;
                }
                let (k, j) = (i / N, i % N);
                let bracket = [AT[j.saturating_sub(1)], AT[(j + 1).min(N - 1)]];
                let (share, found) = peak(bracket, &mut |share| sign * at(k, share));
                if found > highest {
                    highest = found;
                    *angle = self.steady.mesh.edges[k] + share * self.steady.mesh.length(k);
                    *value = sign * found;
                }
            }
        }
        let [(min, min_at), (max, max_at)] = best;
        Extremes { min, min_at, max, max_at }
    }

    /// Curves at crank angles of the cycle.
    pub fn curves(&self, phi: &[f64]) -> Curves {
        let (steady, chain) = (self.steady, self.equation.chain);
        let (mesh, solution) = (&steady.mesh, &steady.solution);
        let times = self.times();
        let rows = Rows::at(&self.equation, phi);
        let (mut y, mut rates) = (vec![0.0; chain.states()], Rates::new(chain));
        let mut found = Curves::default();
        let (mut masses, mut links) = (Vec::new(), Vec::new());
        let drivers = chain.drivers.len();
        found.drive = vec![0.0; drivers * phi.len()];
        let angles = phi.len();
        for (i, &phi) in phi.iter().enumerate() {
            let k = mesh.edges.partition_point(|&edge| edge <= phi).clamp(1, mesh.steps()) - 1;
            let share = (phi - mesh.edges[k]) / mesh.length(k);
            solution.state(k, share, &mut y);
            let row = rows.row(i);
            self.equation.rates(&row, &y, &mut rates);
            found.time.push(times[k] + self.time_within(k, share));
            for (driver, &torque) in rates.drive.iter().enumerate() {
                found.drive[driver * angles + i] = torque;
            }
            found.load.push(rates.load);
            masses.extend((0..chain.masses()).map(|mass| [chain.speed(mass, &y), rates.acceleration[mass]]));
            links.extend(
                chain.links.iter().map(|link| [chain.twist(link, &y)[0], chain.torque(link, &y).value]),
            );
        }
        let by_part = |list: &[[f64; 2]], parts: usize, which: usize| -> Vec<f64> {
            (0..parts)
                .flat_map(|p| list.iter().skip(p).step_by(parts.max(1)).map(move |x| x[which]))
                .collect()
        };
        [found.speed, found.acceleration] = [0, 1].map(|which| by_part(&masses, chain.masses(), which));
        [found.twist, found.torque] = [0, 1].map(|which| by_part(&links, chain.links.len(), which));
        found
    }

    /// Times at the starts of the steps \[s\].
    fn times(&self) -> Vec<f64> {
        let mut time = 0.0;
        (0..self.steady.mesh.steps())
            .map(|k| {
                let start = time;
                time += self.time_within(k, 1.0);
                start
            })
            .collect()
    }

    /// Time from the start of a step to a share of it \[s\], by Radau's quadrature.
    fn time_within(&self, k: usize, share: f64) -> f64 {
        let speed = self.steady.solution.quintic(k, self.equation.chain.states() - 1);
        let length = share * self.steady.mesh.length(k);
        (0..S).map(|i| length * B[i] / value(&speed, share * AT[i + 1])).sum()
    }
}

/// Place and value of a peak between two shares, by parabolas through the three highest values, and by the golden section where these
/// do not narrow it; the ends count too.
///
/// Source: Brent, *Algorithms for Minimization without Derivatives*, ch. 5.
pub(crate) fn peak([mut low, mut high]: [f64; 2], at: &mut dyn FnMut(f64) -> f64) -> (f64, f64) {
    let [first, last] = [low, high].map(|share| (share, at(share)));
    let middle = low + GOLDEN * (high - low);
    let mut top = [(middle, at(middle)); 3];
    let (mut stride, mut before) = (0.0_f64, 0.0_f64);
    for _ in 0..READINGS {
        let [(x, value), (second, lower), (third, lowest)] = top;
        let middle = 0.5 * (low + high);
        if (x - middle).abs() + 0.5 * (high - low) <= 2.0 * PLACE {
            break;
        }
        let (r, q) = ((x - second) * (value - lowest), (x - third) * (value - lower));
        let parabola = 0.5 * ((x - third) * q - (x - second) * r) / (r - q);
        let fits = parabola.abs() < 0.5 * before.abs() && low < x + parabola && x + parabola < high;
        before = if fits {
            stride
        } else if x < middle {
            high - x
        } else {
            low - x
        };
        stride = if fits { parabola } else { GOLDEN * before };
        let is_near = fits && (x + stride - low).min(high - x - stride) < 2.0 * PLACE;
        if is_near || stride.abs() < PLACE {
            stride = PLACE.copysign(if is_near { middle - x } else { stride });
        }
        let next = (x + stride, at(x + stride));
        if next.1 >= value {
            *(if next.0 >= x { &mut low } else { &mut high }) = x;
            top = [next, top[0], top[1]];
        } else {
            *(if next.0 < x { &mut low } else { &mut high }) = next.0;
            if next.1 >= lower || second == x {
                top = [top[0], next, top[1]];
            } else if next.1 >= lowest || third == x || third == second {
                top[2] = next;
            }
        }
    }
    [last, top[0]].into_iter().fold(first, |best, one| if one.1 > best.1 { one } else { best })
}
