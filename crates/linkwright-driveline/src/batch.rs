//! Steady motion of many machines that have one structure, some at once in lanes, each from the solution of another that is near.
//!
//! Steps of the other are moved with the kinks of the machine, and its stages are where Newton's method begins. What comes out is
//! measured as for one machine alone, and refined where it is not accurate; where the method does not converge from there, the
//! machine is solved alone.

use crate::bundle::{Begun, Bundle, Found};
use crate::chain::Chain;
use crate::equation::Equation;
use crate::finer::parts_of_step;
use crate::mesh::{Mesh, Solution};
use crate::reading::{Measures, Reading};
use crate::request::{Failure, Request};
use crate::scale::scales;
use crate::speed_kinks::speed_kinks;
use crate::starts::{Rough, largest_multiplier};
use crate::steady::{Steady, add_vibration, refined, steady};
use linkwright_core::drive::batch::Rows;
use linkwright_core::drive::kinks::kinks;
use linkwright_core::drive::reduce::reductions;
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::call::in_threads;
use linkwright_kernel::lanes::in_single_lanes;
use linkwright_kernel::radau::C;
use rayon::prelude::*;

/// Machines that are solved at once; registers have as many lanes, or half of them.
const TOGETHER: usize = 8;

/// Machines that a thread takes at once, at most: solutions of these are begun with.
const CHUNK: usize = 16 * TOGETHER;

/// Chunks for each thread, so that none waits long for another.
const CHUNKS: usize = 4;

/// The first machine is solved to this share of the accuracy, so that its steps suffice for others too.
const FINER: f64 = 0.15;

/// A mesh that has grown by this factor from machine to machine is begun with no more.
const GROWN: f64 = 2.0;

/// Corrections at which it is known where speeds are passed, for a beginning.
const ROUGHLY: f64 = 1e-2;

/// Cycles that a machine is followed where the motion found at once is unstable.
const AWAY: usize = 100;

/// Times that steps are divided in lanes.
const ROUNDS: usize = 3;

/// Angles \[rad\] that are one.
const SAME: f64 = 1e-9;

/// Share of the accuracy that the last corrections of Newton's method may leave.
const LEFT: f64 = 0.01;

/// Many machines.
pub struct Batch<'a> {
    /// Structure of all.
    pub plan: &'a Plan,
    /// Their numbers.
    pub rows: &'a Rows<'a>,
    /// Driveline of the first, whose structure all have.
    pub chain: &'a Chain,
    /// Numbers of the drivelines, row by row ([`Chain::numbers`]).
    pub numbers: &'a [f64],
    /// What is asked for of each.
    pub requests: &'a [Request],
}

/// Steady motion of one machine.
#[derive(Debug)]
pub struct Motion {
    /// Extremes, means and work.
    pub measures: Measures,
    /// Derivative of the end of the cycle by its start, row by row.
    pub monodromy: Vec<f64>,
    /// Error that was reached.
    pub reached: f64,
}

/// A machine of the batch.
struct Machine {
    row: usize,
    q: Vec<f64>,
    numbers: Vec<f64>,
    kinks: Vec<f64>,
}

/// A machine that is solved, with which others begin.
struct Known {
    place: Vec<f64>,
    kinks: Vec<f64>,
    /// Its kinks, and the angles at which it passes speeds that are kinks.
    marks: Vec<f64>,
    steady: Steady,
}

/// Motions by row.
type Motions = Vec<(usize, Result<Motion, Failure>)>;

impl Batch<'_> {
    /// The motions, in the order of the rows.
    pub fn motions(&self) -> Vec<Result<Motion, Failure>> {
        let n = self.rows.n;
        let size = n.div_ceil(CHUNKS * rayon::current_num_threads()).clamp(1, CHUNK);
        let places: Vec<Vec<f64>> = (0..n).map(|row| self.place(row)).collect();
        let mut order: Vec<usize> = (0..n).collect();
        sort_near(&mut order, &places);
        let mut found: Motions = in_threads(|crew| {
            let chunks = order.par_chunks(size.next_multiple_of(TOGETHER));
            chunks.flat_map_iter(|rows| crew.task(|| self.chunk(rows, &places))).collect()
        });
        found.sort_by_key(|(row, _)| *row);
        found.into_iter().map(|(_, motion)| motion).collect()
    }

    fn chunk(&self, rows: &[usize], places: &[Vec<f64>]) -> Motions {
        if !(self.chain.stations.is_empty() && self.chain.is_linear()) {
            return rows.iter().map(|&row| self.one(row)).collect();
        }
        let (mut known, mut found) = (Vec::new(), Vec::new());
        for rows in rows.chunks(TOGETHER) {
            let machines: Vec<Machine> = rows.iter().map(|&row| self.machine(row)).collect();
            if known.is_empty() {
                // Others are begun with it, and would take an unstable motion from it.
                let at_once = machines.iter().find_map(|one| self.first(one, places, 0));
                known.extend(at_once.or_else(|| self.first(&machines[0], places, AWAY)));
            }
            let far = |known: &&Known| distance(&known.place, &places[rows[0]]);
            let near = known.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
            let (alike, others): (Vec<Machine>, Vec<Machine>) = machines
                .into_iter()
                .partition(|one| near.is_some_and(|near| near.kinks.len() == one.kinks.len()));
            let mut solved = near.map_or_else(Vec::new, |near| self.begun(&alike, near));
            solved.extend(others.iter().map(|machine| (machine.row, self.alone(machine))));
            let most = known.first().map_or(0.0, |first| GROWN * first.steady.mesh.steps() as f64);
            let kinks_of = |row: usize| alike.iter().chain(&others).find(|one| one.row == row);
            for (row, steady) in solved {
                let Some(machine) = kinks_of(row) else { continue };
                let steady = match steady {
                    Ok(steady) => steady,
                    Err(failure) => {
                        found.push((row, Err(failure)));
                        continue;
                    }
                };
                found.push((row, Ok(self.read(machine, &steady))));
                if row == rows[rows.len() - 1]
                    && is_stable(&steady.monodromy)
                    && steady.mesh.steps() as f64 <= most
                {
                    known.push(self.known(machine, places[row].clone(), steady));
                }
            }
        }
        found
    }

    /// A machine that is solved alone.
    fn one(&self, row: usize) -> (usize, Result<Motion, Failure>) {
        let machine = self.machine(row);
        (row, self.alone(&machine).map(|steady| self.read(&machine, &steady)))
    }

    fn machine(&self, row: usize) -> Machine {
        let q = self.rows.row(row);
        let count = self.chain.numbers().len();
        Machine {
            row,
            kinks: kinks(self.plan, &q),
            q,
            numbers: self.numbers[row * count..][..count].to_vec(),
        }
    }

    /// The stable motion of a first machine, more exactly than it is asked for, behind cycles that are followed.
    fn first(&self, machine: &Machine, places: &[Vec<f64>], cycles_first: usize) -> Option<Known> {
        let request = &self.requests[machine.row];
        let request = Request { accuracy: FINER * request.accuracy, cycles_first, ..request.clone() };
        let steady = steady(self.plan, &machine.q, &self.chain.with(&machine.numbers), &request).ok()?;
        is_stable(&steady.monodromy).then(|| self.known(machine, places[machine.row].clone(), steady))
    }

    /// Its motion alone; where that is unstable the one to which the machine comes in time, if that is stable.
    fn alone(&self, machine: &Machine) -> Result<Steady, Failure> {
        let (chain, request) = (self.chain.with(&machine.numbers), &self.requests[machine.row]);
        let found = steady(self.plan, &machine.q, &chain, request)?;
        if is_stable(&found.monodromy) {
            return Ok(found);
        }
        let away = Request { cycles_first: AWAY, ..request.clone() };
        let other = steady(self.plan, &machine.q, &chain, &away).ok();
        Ok(other.filter(|other| is_stable(&other.monodromy)).unwrap_or(found))
    }

    fn known(&self, machine: &Machine, place: Vec<f64>, steady: Steady) -> Known {
        let marks = self.marks(machine, &steady.mesh.edges, &steady.solution);
        Known { place, kinks: machine.kinks.clone(), marks, steady }
    }

    /// Kinks of a machine, and where its motion passes speeds that are kinks.
    fn marks(&self, machine: &Machine, edges: &[f64], solution: &Solution) -> Vec<f64> {
        let chain = self.chain.with(&machine.numbers);
        let equation = Equation { plan: self.plan, q: &machine.q, chain: &chain };
        let mut marks = machine.kinks.clone();
        marks.extend(speed_kinks(&equation, edges, solution).into_iter().map(|(_, angle)| angle));
        marks.sort_by(f64::total_cmp);
        marks.dedup_by(|a, b| (*a - *b).abs() < SAME);
        marks
    }

    /// Motions of some machines from that of another.
    fn begun(&self, machines: &[Machine], near: &Known) -> Vec<(usize, Result<Steady, Failure>)> {
        let mut all = Vec::with_capacity(machines.len());
        let (edges, solution) = (&near.steady.mesh.edges, &near.steady.solution);
        let with_edges = |machine: &Machine| Begun {
            q: machine.q.clone(),
            numbers: machine.numbers.clone(),
            edges: moved(edges, &near.kinks, &machine.kinks),
            start: solution.clone(),
        };
        let mut rest = machines;
        while !rest.is_empty() {
            let mut begun: Vec<Begun> = rest.iter().map(with_edges).collect();
            let passes = near.marks.len() > near.kinks.len();
            let last = ends(&self.requests[rest[0].row]);
            let mut found = self.in_lanes(&begun, near, if passes { ROUGHLY } else { last });
            if passes {
                // Ends of steps go along with the angles at which speeds are passed, as far as these are the same ones.
                for ((machine, begun), found) in rest.iter().zip(&mut begun).zip(found) {
                    let marks = self.marks(machine, &begun.edges, &found.solution);
                    if marks.len() == near.marks.len() {
                        begun.edges = moved(edges, &near.marks, &marks);
                    }
                    begun.start = found.solution;
                }
                found = self.in_lanes(&begun, near, last);
            }
            let (now, later) = rest.split_at(found.len());
            begun.truncate(now.len());
            for _ in 0..ROUNDS {
                let parts = self.parts(now, &found);
                if parts.iter().all(|&parts| parts == 1) {
                    break;
                }
                for (begun, found) in begun.iter_mut().zip(found) {
                    begun.start = found.solution;
                    divide(begun, &parts);
                }
                found = self.in_lanes(&begun, near, last);
            }
            for ((machine, begun), found) in now.iter().zip(begun).zip(found) {
                all.push((machine.row, self.measured(machine, begun.edges, found)));
            }
            rest = later;
        }
        all
    }

    /// Parts of every step by the largest error of all machines that Newton's method came to.
    fn parts(&self, machines: &[Machine], found: &[Found]) -> Vec<usize> {
        let mut parts = vec![1; found[0].errors.len()];
        for (machine, found) in machines.iter().zip(found) {
            let request = &self.requests[machine.row];
            if is_sound(found, request) {
                for (parts, &error) in parts.iter_mut().zip(&found.errors) {
                    *parts = (*parts).max(parts_of_step(error, request.accuracy));
                }
            }
        }
        parts
    }

    fn in_lanes(&self, machines: &[Begun], near: &Known, ends: f64) -> Vec<Found> {
        let scale = scales(&near.steady.solution, self.chain);
        let (plan, chain) = (self.plan, self.chain);
        in_single_lanes(Bundle { plan, chain, machines, scale: &scale, ends })
    }

    /// What lanes found of a machine, refined where it is not accurate; solved alone where it is none.
    fn measured(&self, machine: &Machine, edges: Vec<f64>, found: Found) -> Result<Steady, Failure> {
        let (chain, request) = (self.chain.with(&machine.numbers), &self.requests[machine.row]);
        let equation = Equation { plan: self.plan, q: &machine.q, chain: &chain };
        if !is_sound(&found, request) || !is_stable(&found.monodromy) {
            return self.alone(machine);
        }
        let Found { solution, monodromy, mut errors, .. } = found;
        let mesh = Mesh::new(&equation, edges);
        add_vibration(&mut errors, &mesh, &solution, request);
        let reached = errors.iter().copied().fold(0.0, f64::max);
        if reached <= request.accuracy {
            return Ok(Steady { mesh, solution, monodromy, reached, cycles: 0, multiple: 1 });
        }
        let rough = Rough { mesh, solution, monodromy, cycles: 0, multiple: 1 };
        refined(equation, rough, request).or_else(|_| self.alone(machine))
    }

    fn read(&self, machine: &Machine, steady: &Steady) -> Motion {
        let chain = self.chain.with(&machine.numbers);
        let equation = Equation { plan: self.plan, q: &machine.q, chain: &chain };
        Motion {
            measures: Reading { equation, steady }.measures(),
            monodromy: steady.monodromy.clone(),
            reached: steady.reached,
        }
    }

    /// Where a machine lies among the others: its numbers that vary, each over its size.
    fn place(&self, row: usize) -> Vec<f64> {
        let size = |x: f64| if x == 0.0 { 1.0 } else { x.abs() };
        let base = self.chain.numbers();
        let own = &self.numbers[row * base.len()..][..base.len()];
        let of_plan = self
            .rows
            .slots
            .iter()
            .enumerate()
            .map(|(i, &slot)| self.rows.values[i * self.rows.n + row] / size(self.rows.base[slot]));
        of_plan.chain(own.iter().zip(&base).map(|(x, base)| x / size(*base))).collect()
    }
}

/// Corrections at which sweeps end: what they leave goes with their square.
fn ends(request: &Request) -> f64 {
    (LEFT * request.accuracy).sqrt()
}

/// Whether disturbances of a motion die away, so that a machine comes to it, and others may be begun with it.
fn is_stable(monodromy: &[f64]) -> bool {
    largest_multiplier(monodromy) < 1.0
}

/// Whether Newton's method came to a motion that turns forward.
fn is_sound(found: &Found, request: &Request) -> bool {
    let last = found.solution.states() - 1;
    let turns = found.solution.stages.chunks_exact(last + 1).all(|y| y[last] > 0.0);
    turns && found.left <= ends(request) && found.errors.iter().all(|error| error.is_finite())
}

/// Divides steps, and reads what is begun with on the stages of their parts.
fn divide(begun: &mut Begun, parts: &[usize]) {
    let (m, mut edges) = (begun.start.states(), vec![begun.edges[0]]);
    let mut stages = Vec::new();
    let mut y = vec![0.0; m];
    for (k, &parts) in parts.iter().enumerate() {
        let (low, h) = (begun.edges[k], begun.edges[k + 1] - begun.edges[k]);
        for part in 0..parts {
            for c in C {
                begun.start.state(k, (part as f64 + c) / parts as f64, &mut y);
                stages.extend_from_slice(&y);
            }
            let share = (part + 1) as f64 / parts as f64;
            edges.push(if part + 1 == parts { begun.edges[k + 1] } else { share.mul_add(h, low) });
        }
    }
    begun.edges = edges;
    begun.start.stages = stages;
}

/// Square of the distance of two places.
fn distance(first: &[f64], second: &[f64]) -> f64 {
    first.iter().zip(second).map(|(a, b)| (a - b).powi(2)).sum()
}

/// Sorts rows so that those that follow each other are near: halves along the number that varies most, again and again.
fn sort_near(rows: &mut [usize], places: &[Vec<f64>]) {
    if rows.len() <= TOGETHER {
        return;
    }
    let range = |at: usize| {
        let values = rows.iter().map(|&row| places[row][at]);
        let [low, high] =
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        high - low
    };
    let Some(widest) = (0..places[rows[0]].len()).max_by(|&a, &b| range(a).total_cmp(&range(b))) else {
        return;
    };
    rows.sort_by(|&a, &b| places[a][widest].total_cmp(&places[b][widest]));
    let (first, second) = rows.split_at_mut((rows.len() / 2).next_multiple_of(TOGETHER));
    sort_near(first, places);
    sort_near(second, places);
}

/// Ends of steps that keep their places between the kinks as these move.
fn moved(edges: &[f64], from: &[f64], to: &[f64]) -> Vec<f64> {
    let at = |&edge: &f64| {
        let k = from.partition_point(|&kink| kink <= edge).clamp(1, from.len() - 1);
        let share = (edge - from[k - 1]) / (from[k] - from[k - 1]);
        if share >= 1.0 { to[k] } else { share.mul_add(to[k] - to[k - 1], to[k - 1]) }
    };
    edges.iter().map(at).collect()
}

/// Minimum inertia reduced to the crank at some angles, of every machine \[kg m²\].
pub fn least_inertias(plan: &Plan, rows: &Rows<'_>, phi: &[f64]) -> Vec<f64> {
    let least = |row: usize| {
        let reduced = reductions(plan, &rows.row(row), phi, 1.0);
        reduced.iter().map(|at| at.J).fold(f64::INFINITY, f64::min)
    };
    in_threads(|crew| (0..rows.n).into_par_iter().map(|row| crew.task(|| least(row))).collect())
}
