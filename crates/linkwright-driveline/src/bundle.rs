//! The periodic solutions of some machines of one structure at once, one a lane, on meshes whose steps correspond.
//!
//! The sweeps are those of [`crate::cycle`], with one order of pivots for all lanes. A lane in which they go wrong does not converge,
//! or shows its error, and is left to the solver of one machine.

use crate::chain::Chain;
use crate::cycle::FALLS;
use crate::equation::{Equation, Rates, Row};
use crate::error::{ERROR_OF_DEFECT, GAMMA, WATCHED};
use crate::mesh::Solution;
use crate::scale::scales;
use linkwright_core::drive::law::LawGeometry;
use linkwright_core::drive::layout::{bundle, unbundle};
use linkwright_core::drive::reduce::Reduction;
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::lanes::Job;
use linkwright_kernel::out_of_line;
use linkwright_kernel::plane::Angle;
use linkwright_kernel::radau::{A, C, N, S, slope_and_bend, through, value};
use linkwright_kernel::real::{LANES_MAX, Real};

/// Sweeps at most.
const SWEEPS_MAX: usize = 12;

/// A sweep lowers the speed of the crank to no less than this share.
const SPEED_LEFT: f64 = 0.3;

/// A machine of a bundle.
pub(crate) struct Begun {
    /// Its numbers, and those of its driveline.
    pub(crate) q: Vec<f64>,
    pub(crate) numbers: Vec<f64>,
    /// Ends of its steps.
    pub(crate) edges: Vec<f64>,
    /// Where Newton's method begins.
    pub(crate) start: Solution,
}

/// Some machines, as many as there are lanes or fewer.
pub(crate) struct Bundle<'a> {
    pub(crate) plan: &'a Plan,
    /// Driveline of the first machine of all, whose structure they have.
    pub(crate) chain: &'a Chain,
    pub(crate) machines: &'a [Begun],
    /// What corrections are measured with.
    pub(crate) scale: &'a [f64],
    /// Corrections at which sweeps end.
    pub(crate) ends: f64,
    /// Sweeps behind which corrections fall.
    pub(crate) patience: usize,
}

/// What was found of one machine.
pub(crate) struct Found {
    pub(crate) solution: Solution,
    pub(crate) monodromy: Vec<f64>,
    /// Error of each step over the size of what it is of.
    pub(crate) errors: Vec<f64>,
    /// Last correction.
    pub(crate) left: f64,
}

impl Job for Bundle<'_> {
    type Output = Vec<Found>;

    #[inline(always)]
    fn run<R: Real>(self) -> Vec<Found> {
        let machines = &self.machines[..self.machines.len().min(R::LANES)];
        let lanes = |of: fn(&Begun) -> &Vec<f64>| -> Vec<R> {
            let first = of(&machines[0]);
            let mut all = Vec::with_capacity(first.len());
            for at in 0..first.len() {
                let mut lanes = [first[at]; LANES_MAX];
                for (lane, machine) in lanes.iter_mut().zip(machines) {
                    *lane = of(machine)[at];
                }
                all.push(R::load(&lanes));
            }
            all
        };
        let (q, chain, edges) =
            (lanes(|m| &m.q), self.chain.with(&lanes(|m| &m.numbers)), lanes(|m| &m.edges));
        let equation = Equation { plan: self.plan, q: &q, chain: &chain };
        let mut steps = Steps::new(equation, edges, &C);
        let mut states = States { start: lanes(|m| &m.start.start), stages: lanes(|m| &m.start.stages) };
        let (monodromy, left) = out_of_line!(R, steps.periodic(&mut states, &self));
        let [start, stages, monodromy, left] =
            [&states.start, &states.stages, &monodromy, &vec![left]].map(|list| unbundle(list));
        let lane = |list: &[f64], at: usize| list.iter().skip(at).step_by(R::LANES).copied().collect();
        let mut found: Vec<Found> = (0..machines.len())
            .map(|at| Found {
                solution: Solution { start: lane(&start, at), stages: lane(&stages, at) },
                monodromy: lane(&monodromy, at),
                errors: Vec::new(),
                left: left[at],
            })
            .collect();
        // Each is measured with its own sizes.
        let mut own = vec![1.0; R::LANES * states.start.len()];
        for (at, found) in found.iter().enumerate() {
            let scale = scales(&found.solution, &self.chain.with(&machines[at].numbers));
            own.iter_mut().skip(at).step_by(R::LANES).zip(scale).for_each(|(to, x)| *to = x);
        }
        let watched = Steps::new(equation, steps.edges, &WATCHED);
        let errors = unbundle(&out_of_line!(R, watched.errors(&states, &bundle::<R>(&own))));
        for (at, found) in found.iter_mut().enumerate() {
            found.errors = lane(&errors, at);
        }
        found
    }
}

/// States at the start and at all stages.
struct States<R> {
    start: Vec<R>,
    stages: Vec<R>,
}

impl<R: Real> States<R> {
    /// State at the start of a step.
    #[inline(always)]
    fn start_of(&self, k: usize) -> &[R] {
        let m = self.start.len();
        if k == 0 { &self.start } else { &self.stages[(k * S - 1) * m..][..m] }
    }

    #[inline(always)]
    fn quintic(&self, k: usize, number: usize) -> [R; N] {
        let mut values = [self.start_of(k)[number]; N];
        for i in 0..S {
            values[i + 1] = self.stages[(k * S + i) * self.start.len() + number];
        }
        through(&values)
    }
}

/// The steps of a cycle with the mechanism at some shares of each.
struct Steps<'a, R> {
    equation: Equation<'a, R>,
    edges: Vec<R>,
    angles: Vec<R>,
    reduced: Vec<Reduction<R>>,
    geometry: Vec<LawGeometry<R>>,
}

impl<'a, R: Real> Steps<'a, R> {
    #[inline(always)]
    fn new(equation: Equation<'a, R>, edges: Vec<R>, shares: &[f64]) -> Self {
        let Equation { plan, q, .. } = equation;
        let mut m = Motion::new(&plan.mechanism, q);
        let (mut angles, mut reduced, mut geometry) = (Vec::new(), Vec::new(), Vec::new());
        for ends in edges.windows(2) {
            for &share in shares {
                let phi = (ends[1] - ends[0]) * share + ends[0];
                angles.push(phi);
                reduced.push(out_of_line!(R, plan.reduce::<R, 2>(q, Angle::new(phi), 1.0, &mut m)));
                plan.add_geometry(q, phi, &m, &mut geometry);
            }
        }
        Steps { equation, edges, angles, reduced, geometry }
    }

    #[inline(always)]
    fn row(&self, i: usize) -> Row<'_, R> {
        let laws = self.equation.plan.laws.len();
        Row { phi: self.angles[i], reduced: self.reduced[i], geometry: &self.geometry[i * laws..][..laws] }
    }

    /// Sweeps of Newton's method; the monodromy matrix of the last, and its largest correction.
    #[inline(always)]
    fn periodic(&mut self, states: &mut States<R>, asked: &Bundle<'_>) -> (Vec<R>, R) {
        let m = states.start.len();
        let (n, wide, steps) = (S * m, 1 + m, self.edges.len() - 1);
        let zero = R::splat(0.0);
        let mut rates = Rates::new(self.equation.chain);
        let mut table = Vec::new();
        let mut solved = vec![zero; steps * n * wide];
        let (mut end, mut left) = (Vec::new(), R::splat(f64::INFINITY));
        for sweep in 0..SWEEPS_MAX {
            end = vec![zero; m * wide];
            for r in 0..m {
                end[r * wide + 1 + r] = R::splat(1.0);
            }
            for k in 0..steps {
                self.linear_step(k, states, &mut rates, &mut table);
                let kept = &mut solved[k * n * wide..][..n * wide];
                for (to, row) in kept.chunks_exact_mut(wide).zip(table.chunks_exact(n + wide)) {
                    to.copy_from_slice(&row[n..]);
                }
                end = chained(&kept[(n - m) * wide..], &end, m);
            }
            let mut closing = Vec::with_capacity(m * (m + 1));
            for r in 0..m {
                for c in 0..m {
                    closing.push(R::splat(f64::from(u8::from(r == c))) - end[r * wide + 1 + c]);
                }
                let close = states.stages[(steps * S - 1) * m + r];
                closing.push(end[r * wide] + close - states.start[r]);
            }
            solve(&mut closing, m, 1);
            let last = std::mem::replace(&mut left, correct(states, &solved, &closing, asked.scale));
            // A lane that does not come nearer is not waited for.
            let waited =
                if sweep < asked.patience { left } else { (last * FALLS).select_lt(left, zero, left) };
            if waited.max_lane() <= asked.ends {
                break;
            }
        }
        ((0..m * m).map(|at| end[at / m * wide + 1 + at % m]).collect(), left)
    }

    /// Corrections of the stages of a step, for its start as it is and by that of the start, in the last columns of the table.
    #[inline(always)]
    fn linear_step(&self, k: usize, states: &States<R>, rates: &mut Rates<R>, table: &mut Vec<R>) {
        let m = states.start.len();
        let (n, h, y) = (S * m, self.edges[k + 1] - self.edges[k], states.start_of(k));
        let (width, stages) = (n + 1 + m, &states.stages[k * n..][..n]);
        table.clear();
        table.resize(n * width, R::splat(0.0));
        for i in 0..n {
            let row = &mut table[i * width..][..width];
            row[n] = y[i % m] - stages[i];
            row[n + 1 + i % m] = R::splat(1.0);
        }
        for j in 0..S {
            self.equation.rates(&self.row(k * S + j), &stages[j * m..][..m], rates);
            for i in 0..S {
                let weight = h * A[i][j];
                for r in 0..m {
                    let row = &mut table[(i * m + r) * width..][..width];
                    for (to, &slope) in row[j * m..].iter_mut().zip(&rates.jacobian[r * m..][..m]) {
                        *to = -(weight * slope);
                    }
                    row[n] = weight.mul_add(rates.rate[r], row[n]);
                }
            }
        }
        for i in 0..n {
            table[i * width + i] = table[i * width + i] + 1.0;
        }
        out_of_line!(R, solve(table, n, 1 + m));
    }

    /// Error of the solutions in every step, as [`crate::error`] measures it; the mechanism is at its places.
    #[inline(always)]
    fn errors(&self, states: &States<R>, scale: &[R]) -> Vec<R> {
        let m = states.start.len();
        let mut rates = Rates::new(self.equation.chain);
        let mut table = vec![R::splat(0.0); m * (m + 1)];
        let mut found = Vec::with_capacity(self.edges.len() - 1);
        for k in 0..self.edges.len() - 1 {
            let h = self.edges[k + 1] - self.edges[k];
            let mut quintics = Vec::with_capacity(m);
            for number in 0..m {
                quintics.push(states.quintic(k, number));
            }
            let (mut worst, mut unknown) = (R::splat(0.0), R::splat(0.0));
            for (w, at) in WATCHED.into_iter().enumerate() {
                let mut y = Vec::with_capacity(m);
                for quintic in &quintics {
                    y.push(value(quintic, R::splat(at)));
                }
                self.equation.rates(&self.row(k * WATCHED.len() + w), &y, &mut rates);
                for r in 0..m {
                    let row = &mut table[r * (m + 1)..][..m + 1];
                    for c in 0..m {
                        let one = R::splat(f64::from(u8::from(r == c)));
                        row[c] = one - h * GAMMA * rates.jacobian[r * m + c];
                    }
                    let defect = slope_and_bend(&quintics[r], R::splat(at)).0 - h * rates.rate[r];
                    row[m] = defect * ERROR_OF_DEFECT[w];
                }
                solve(&mut table, m, 1);
                for r in 0..m {
                    let error = table[r * (m + 1) + m].abs() / scale[r];
                    // What is no number is not lost.
                    (worst, unknown) = (worst.max(error), unknown + error * 0.0);
                }
            }
            found.push(worst + unknown);
        }
        found
    }
}

/// Corrects states; the largest correction of each lane.
#[inline(always)]
fn correct<R: Real>(states: &mut States<R>, solved: &[R], closing: &[R], scale: &[f64]) -> R {
    let m = states.start.len();
    let wide = 1 + m;
    let start: Vec<R> = closing.iter().skip(m).step_by(m + 1).copied().collect();
    let mut before = start.clone();
    let mut corrections = Vec::with_capacity(states.stages.len());
    for rows in solved.chunks_exact(S * m * wide) {
        for row in rows.chunks_exact(wide) {
            let mut d = row[0];
            for (&u, &b) in row[1..].iter().zip(&before) {
                d = u.mul_add(b, d);
            }
            corrections.push(d);
        }
        before.copy_from_slice(&corrections[corrections.len() - m..]);
    }
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let (mut size, mut share) = (zero, one);
    for (i, (&y, &d)) in states.stages.iter().zip(&corrections).enumerate() {
        size = size.max(d.abs() * (1.0 / scale[i % m]));
        if i % m == m - 1 {
            let allowed = d.select_lt(zero, y * (SPEED_LEFT - 1.0) / d, one);
            share = share.min(allowed);
        }
    }
    for (to, &d) in states.stages.iter_mut().zip(&corrections) {
        *to = share.mul_add(d, *to);
    }
    for (to, &d) in states.start.iter_mut().zip(&start) {
        *to = share.mul_add(d, *to);
    }
    share.select_lt(one, size.max(one), size)
}

/// p and U of a step behind those of what is before it.
#[inline(always)]
fn chained<R: Real>(step: &[R], before: &[R], m: usize) -> Vec<R> {
    let mut found = vec![R::splat(0.0); m * (1 + m)];
    for (row, to) in step.chunks_exact(1 + m).zip(found.chunks_exact_mut(1 + m)) {
        to[0] = row[0];
        for (&u, before) in row[1..].iter().zip(before.chunks_exact(1 + m)) {
            for (to, &x) in to.iter_mut().zip(before) {
                *to = u.mul_add(x, *to);
            }
        }
    }
    found
}

/// Solves A X = B in the rows (A | B) of a table, with one order of pivots for all lanes.
#[inline(always)]
fn solve<R: Real>(table: &mut [R], n: usize, sides: usize) {
    let width = n + sides;
    for k in 0..n {
        let size = |i: usize| table[i * width + k].abs().max_lane();
        let (mut pivot, mut best) = (k, size(k));
        for i in k + 1..n {
            let own = size(i);
            if own > best {
                (pivot, best) = (i, own);
            }
        }
        if pivot != k {
            let (above, below) = table.split_at_mut(pivot * width);
            above[k * width..][..width].swap_with_slice(&mut below[..width]);
        }
        let (above, below) = table.split_at_mut((k + 1) * width);
        let row = &above[k * width + k..];
        let inverse = row[0].recip();
        for other in below.chunks_exact_mut(width) {
            let factor = -(other[k] * inverse);
            for (x, &p) in other[k + 1..].iter_mut().zip(&row[1..]) {
                *x = factor.mul_add(p, *x);
            }
        }
    }
    for k in (0..n).rev() {
        let (above, from) = table.split_at_mut(k * width);
        let inverse = from[k].recip();
        let solved = &mut from[n..width];
        for x in solved.iter_mut() {
            *x = *x * inverse;
        }
        for other in above.chunks_exact_mut(width) {
            let factor = -other[k];
            for (x, &s) in other[n..].iter_mut().zip(&*solved) {
                *x = factor.mul_add(s, *x);
            }
        }
    }
}
