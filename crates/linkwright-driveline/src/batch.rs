//! Steady motion of many machines that have one structure, some at once in lanes.
//!
//! Newton's method begins as for one machine alone, with the crank at one speed on few steps, so that it comes to the same one of
//! several steady motions. It ends on the steps of another machine that is near, moved with the kinks. What comes out is measured as for
//! one machine alone, and refined where it is not accurate. Where the method does not converge from one speed it begins with
//! the motion of the other. The next machine for which no stable motion is found so is solved alone, and the rest begin with its motion.

use crate::bundle::{Begun, Bundle, Found};
use crate::chain::Chain;
use crate::equation::Equation;
use crate::finer::{divided, parts_of_step};
use crate::mesh::{Mesh, Solution};
use crate::reading::{Measures, Reading};
use crate::request::Request;
use crate::scale::scales;
use crate::search::steady;
use crate::speed_kinks::speed_kinks;
use crate::starts::{PATIENCE, Rough, STEPS, beginning, first_edges, largest_multiplier};
use crate::steady::{Steady, add_vibration, refined};
use linkwright_core::drive::batch::Rows;
use linkwright_core::drive::kinks::kinks;
use linkwright_core::drive::reduce::reductions;
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::call::in_threads;
use linkwright_kernel::lanes::in_single_lanes;
use rayon::prelude::*;

/// Machines that are solved at once; registers have as many lanes, or half of them.
const TOGETHER: usize = 8;

/// Machines that a thread takes at once, at most: solutions of these are begun with.
const CHUNK: usize = 64 * TOGETHER;

/// Chunks for each thread, so that none waits long for another.
const CHUNKS: usize = 4;

/// A machine alone is solved to this share of the accuracy, so that its steps suffice for others too.
const FINER: f64 = 0.15;

/// Machines alone that all others of a chunk are begun with.
const BEGINNINGS: usize = 8;

/// A mesh that has grown by this factor from machine to machine is begun with no more.
const GROWN: f64 = 2.0;

/// Corrections at which it is known where speeds are passed, for a beginning.
const ROUGHLY: f64 = 1e-2;

/// Cycles that a machine is followed where the motion found at once is unstable: another may be stable.
const AWAY: usize = 100;

/// Sweeps behind which corrections from one speed fall.
const PATIENCE_AT_ONCE: usize = 7;

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
type Motions = Vec<(usize, Option<Motion>)>;

impl Batch<'_> {
    /// The motions, in the order of the rows; nothing of a machine that is to be solved alone.
    pub fn motions(&self) -> Vec<Option<Motion>> {
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
        let machines: Vec<Machine> = rows.iter().map(|&row| self.machine(row)).collect();
        let mut beginnings =
            if self.chain.stations.is_empty() && self.chain.is_linear() { 0 } else { BEGINNINGS };
        let (mut left, mut found): (Vec<&Machine>, _) = (machines.iter().collect(), Vec::new());
        while !left.is_empty() {
            let machine = left.remove(0);
            let alone = self.alone(machine);
            found.push((machine.row, alone.as_ref().map(|steady| self.read(machine, steady))));
            // Others would take an unstable motion from it.
            if let Some(steady) = alone
                && is_stable(&steady.monodromy)
                && beginnings < BEGINNINGS
            {
                let known = self.known(machine, places, steady);
                left = self.solved_from(known, &left, places, beginnings == 0, &mut found);
                beginnings += 1;
            }
        }
        found
    }

    /// Solves machines in lanes on the steps of a known one and of those that are solved so; gives those that are left.
    fn solved_from<'a>(
        &self,
        first: Known,
        machines: &[&'a Machine],
        places: &[Vec<f64>],
        at_once: bool,
        found: &mut Motions,
    ) -> Vec<&'a Machine> {
        let most = GROWN * first.steady.mesh.steps() as f64;
        let kinks = first.kinks.len();
        let (alike, mut left): (Vec<&'a Machine>, Vec<&'a Machine>) =
            machines.iter().partition(|one| one.kinks.len() == kinks);
        let mut known = vec![first];
        for machines in alike.chunks(TOGETHER) {
            let far = |known: &Known| distance(&known.place, &places[machines[0].row]);
            let near =
                known.iter().fold(&known[0], |near, one| if far(one) < far(near) { one } else { near });
            let mut last = None;
            for (&machine, steady) in machines.iter().zip(self.begun(machines, near, at_once)) {
                let Some(steady) = steady else {
                    left.push(machine);
                    continue;
                };
                found.push((machine.row, Some(self.read(machine, &steady))));
                last = Some((machine, steady));
            }
            if let Some((machine, steady)) = last.filter(|(_, steady)| steady.mesh.steps() as f64 <= most) {
                known.push(self.known(machine, places, steady));
            }
        }
        left
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

    /// Its motion alone; where that is unstable the one to which the machine comes in time. Nothing where it repeats after several
    /// cycles.
    fn alone(&self, machine: &Machine) -> Option<Steady> {
        let (chain, request) = (self.chain.with(&machine.numbers), &self.requests[machine.row]);
        let solved = |cycles_first: usize, multiples: usize| {
            let accuracy = FINER * request.accuracy;
            let request = Request { accuracy, cycles_first, multiples, ..request.clone() };
            steady(self.plan, &machine.q, &chain, &request).ok()
        };
        let mut found = solved(0, if chain.is_linear() { 1 } else { request.multiples })?;
        if !is_stable(&found.monodromy) && found.cycles == 0 {
            found = solved(AWAY, request.multiples).unwrap_or(found);
        }
        Some(found).filter(|found| found.multiple == 1)
    }

    fn known(&self, machine: &Machine, places: &[Vec<f64>], steady: Steady) -> Known {
        let marks = self.marks(machine, &steady.mesh.edges, &steady.solution);
        Known { place: places[machine.row].clone(), kinks: machine.kinks.clone(), marks, steady }
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

    /// Stable motions of some machines on the steps of another, from one speed if they may be `at_once`, else from its motion.
    fn begun(&self, machines: &[&Machine], near: &Known, at_once: bool) -> Vec<Option<Steady>> {
        let mut all = Vec::with_capacity(machines.len());
        let (edges, solution) = (&near.steady.mesh.edges, &near.steady.solution);
        let coarse = first_edges(&near.kinks, STEPS);
        let with_edges = |machine: &&Machine| {
            let edges = moved(if at_once { &coarse } else { edges }, &near.kinks, &machine.kinks);
            let start = if at_once {
                let chain = self.chain.with(&machine.numbers);
                Solution::constant(edges.len() - 1, &beginning(&chain, &self.requests[machine.row]).0)
            } else {
                solution.clone()
            };
            Begun { q: machine.q.clone(), numbers: machine.numbers.clone(), edges, start }
        };
        let mut rest = machines;
        while !rest.is_empty() {
            let mut begun: Vec<Begun> = rest.iter().map(with_edges).collect();
            let last = ends(&self.requests[rest[0].row]);
            if at_once || near.marks.len() > near.kinks.len() {
                // Ends of steps go along with the angles at which speeds are passed, as far as these are the same ones.
                let found =
                    self.in_lanes(&begun, near, ROUGHLY, if at_once { PATIENCE_AT_ONCE } else { PATIENCE });
                for ((machine, begun), found) in rest.iter().zip(&mut begun).zip(found) {
                    let rough = is_sound(&found, ROUGHLY).then_some(found.solution);
                    let marks = rough.as_ref().map(|rough| self.marks(machine, &begun.edges, rough));
                    let own = match marks.filter(|marks| marks.len() == near.marks.len()) {
                        Some(marks) => moved(edges, &near.marks, &marks),
                        None => moved(edges, &near.kinks, &machine.kinks),
                    };
                    begun.start =
                        rough.map_or_else(|| solution.clone(), |rough| rough.on(&begun.edges, &own));
                    begun.edges = own;
                }
            }
            let mut found = self.in_lanes(&begun, near, last, PATIENCE);
            let (now, later) = rest.split_at(found.len());
            begun.truncate(now.len());
            for _ in 0..ROUNDS {
                let parts = self.parts(now, &found);
                if parts.iter().all(|&parts| parts == 1) {
                    break;
                }
                for (begun, found) in begun.iter_mut().zip(found) {
                    let finer = divided(&begun.edges, |k| parts[k]);
                    begun.start = found.solution.on(&begun.edges, &finer);
                    begun.edges = finer;
                }
                found = self.in_lanes(&begun, near, last, PATIENCE);
            }
            for ((machine, begun), found) in now.iter().zip(begun).zip(found) {
                all.push(self.measured(machine, begun.edges, found));
            }
            rest = later;
        }
        all
    }

    /// Parts of every step by the largest error of all machines that Newton's method came to.
    fn parts(&self, machines: &[&Machine], found: &[Found]) -> Vec<usize> {
        let mut parts = vec![1; found[0].errors.len()];
        for (machine, found) in machines.iter().zip(found) {
            let request = &self.requests[machine.row];
            if is_sound(found, ends(request)) {
                for (parts, &error) in parts.iter_mut().zip(&found.errors) {
                    *parts = (*parts).max(parts_of_step(error, request.accuracy));
                }
            }
        }
        parts
    }

    fn in_lanes(&self, machines: &[Begun], near: &Known, ends: f64, patience: usize) -> Vec<Found> {
        let scale = scales(&near.steady.solution, self.chain);
        let (plan, chain) = (self.plan, self.chain);
        in_single_lanes(Bundle { plan, chain, machines, scale: &scale, ends, patience })
    }

    /// What lanes found of a machine, refined where it is not accurate; nothing where it is no stable motion.
    fn measured(&self, machine: &Machine, edges: Vec<f64>, found: Found) -> Option<Steady> {
        let (chain, request) = (self.chain.with(&machine.numbers), &self.requests[machine.row]);
        let equation = Equation { plan: self.plan, q: &machine.q, chain: &chain };
        if !is_sound(&found, ends(request)) || !is_stable(&found.monodromy) {
            return None;
        }
        let Found { solution, monodromy, mut errors, .. } = found;
        let mesh = Mesh::new(&equation, edges);
        add_vibration(&mut errors, &mesh, &solution, request);
        let reached = errors.iter().copied().fold(0.0, f64::max);
        if reached <= request.accuracy {
            return Some(Steady { mesh, solution, monodromy, reached, cycles: 0, multiple: 1 });
        }
        let rough = Rough { mesh, solution, monodromy, placed: Vec::new(), cycles: 0, multiple: 1 };
        refined(equation, rough, request).ok().filter(|one| is_stable(&one.monodromy))
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
fn is_sound(found: &Found, ends: f64) -> bool {
    let last = found.solution.states() - 1;
    let turns = found.solution.stages.chunks_exact(last + 1).all(|y| y[last] > 0.0);
    turns && found.left <= ends && found.errors.iter().all(|error| error.is_finite())
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
