//! A branch of steady motions over a parameter of the machine, through folds, by pseudo-arclength.
//!
//! With the state y at the start of the cycle and the parameter λ, both over their scales, the next motion is sought in the plane
//! t · (y − y*, λ − λ*) = s behind the last one, with the tangent t of the branch. In a fold λ turns back while the plane still meets the
//! branch once, so that Newton's matrix stays regular.
//!
//! All numbers of the machine are polynomials of λ through some machines.
//!
//! Source: Keller, in *Applications of Bifurcation Theory*, 1977, 359–384; Berrut, Trefethen, *SIAM Review* 46 (2004) 501–517.

use crate::chain::Chain;
use crate::crossings::crossings;
use crate::cycle::{Cycle, SWEEPS_MAX, closure, correct, damping, is_last, monodromy};
use crate::elimination::solve;
use crate::equation::{Equation, Rates};
use crate::error::errors;
use crate::finer::{STEPS_MAX, finer_edges};
use crate::mesh::{Mesh, Solution};
use crate::request::Request;
use crate::scale::scales;
use crate::steady::{ROUNDS_MAX, Steady, worst_error};
use linkwright_core::drive::structure::Plan;
use linkwright_kernel::call::poll;
use linkwright_kernel::radau::S;

/// Length of the first step, of the longest and of the shortest, over the scales.
const FIRST: f64 = 0.02;
/// See [`FIRST`].
const LONGEST: f64 = 0.06;
/// See [`FIRST`].
const SHORTEST: f64 = 1e-5;

/// Sweeps of Newton's method from which on the next step is shorter.
const MANY_SWEEPS: usize = 6;

/// Largest change of the direction of a branch in a step, as cosine.
const STRAIGHT: f64 = 0.9;

/// Share of the range of the parameter by which it is changed for derivatives.
const DIFFERENCE: f64 = 1e-5;

/// Part of the tangent along the parameter at which a fold is placed.
const LEVEL: f64 = 1e-5;

/// Secant steps to a fold at most.
const SECANTS: usize = 20;

/// Machines over a parameter.
pub struct Family<'a> {
    /// Their structure.
    pub plan: &'a Plan,
    /// Parameter of each.
    pub nodes: Vec<f64>,
    /// Numbers of the plan and of the driveline of each.
    pub machines: Vec<(Vec<f64>, Chain)>,
}

/// One motion of a branch.
pub struct BranchPoint {
    /// The parameter.
    pub parameter: f64,
    /// Numbers of the machine there.
    pub q: Vec<f64>,
    /// Its driveline.
    pub chain: Chain,
    /// The motion.
    pub steady: Steady,
    /// Whether the parameter turns back there.
    pub is_fold: bool,
}

/// Why a branch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The parameter leaves its range.
    Range,
    /// As many motions as were asked for.
    Points,
    /// Steps became too short.
    Short,
}

impl Family<'_> {
    /// Numbers of the machine at a parameter.
    pub fn at(&self, parameter: f64) -> (Vec<f64>, Chain) {
        let weights = self.weights(parameter);
        let sum = |lists: &[Vec<f64>]| -> Vec<f64> {
            let number = |i: usize| {
                let own = lists[0][i];
                // What is the same in all machines is so here.
                if lists.iter().all(|list| list[i] == own) {
                    return own;
                }
                weights.iter().zip(lists).map(|(weight, list)| weight * list[i]).sum()
            };
            (0..lists[0].len()).map(number).collect()
        };
        let plans: Vec<_> = self.machines.iter().map(|(q, _)| q.clone()).collect();
        let chains: Vec<_> = self.machines.iter().map(|(_, chain)| chain.numbers()).collect();
        (sum(&plans), self.machines[0].1.with(&sum(&chains)))
    }

    /// Shares of the machines in the one at a parameter: barycentric weights.
    fn weights(&self, parameter: f64) -> Vec<f64> {
        let nodes = &self.nodes;
        if let Some(own) = nodes.iter().position(|&node| node == parameter) {
            return (0..nodes.len()).map(|j| f64::from(u8::from(j == own))).collect();
        }
        let weight = |j: usize| {
            let others = (0..nodes.len()).filter(|&i| i != j).map(|i| nodes[j] - nodes[i]).product::<f64>();
            1.0 / (others * (parameter - nodes[j]))
        };
        let list: Vec<f64> = (0..nodes.len()).map(weight).collect();
        let sum: f64 = list.iter().sum();
        list.into_iter().map(|weight| weight / sum).collect()
    }

    fn range(&self) -> [f64; 2] {
        let fold = |pick: fn(f64, f64) -> f64, from: f64| self.nodes.iter().copied().fold(from, pick);
        [fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY)]
    }
}

/// Where a step of the branch begins, and in which direction it looks.
struct Plane<'a> {
    /// Start and parameter that it is measured from.
    origin: (&'a [f64], f64),
    /// Direction, over the scales.
    tangent: &'a [f64],
    /// Distance.
    length: f64,
}

/// Follows branches of one family.
struct Follower<'a> {
    family: &'a Family<'a>,
    request: &'a Request,
    width: f64,
}

/// Motion, derivative of its end by its start, and the tangent of the branch there.
struct Solved {
    parameter: f64,
    mesh: Mesh,
    solution: Solution,
    monodromy: Vec<f64>,
    tangent: Vec<f64>,
    reached: f64,
    sweeps: usize,
    /// Ends of steps at kinks.
    placed: Vec<f64>,
}

/// Follows a branch from a motion in a direction of the parameter, to the end of its range.
pub fn branch(
    family: &Family<'_>,
    request: &Request,
    (first, parameter): (Steady, f64),
    direction: f64,
    points_max: usize,
) -> (Vec<BranchPoint>, End) {
    let [low, high] = family.range();
    let follower = Follower { family, request, width: high - low };
    let m = first.solution.states();
    let mut tangent = vec![0.0; m + 1];
    tangent[m] = direction;
    let Some(mut last) = follower.first(first, parameter, &tangent) else { return (Vec::new(), End::Short) };
    let mut found = vec![follower.point(&last, false)];
    let (mut length, mut before): (f64, Option<Solved>) = (FIRST, None);
    while found.len() < points_max {
        poll();
        let next = follower.step(&last, before.as_ref(), length);
        let bends = |next: &Solved| dot(&next.tangent, &last.tangent) < STRAIGHT;
        let Some(next) = next.filter(|next| !bends(next) || length < 4.0 * SHORTEST) else {
            length *= 0.4;
            if length < SHORTEST {
                return (found, End::Short);
            }
            continue;
        };
        if !(low..=high).contains(&next.parameter) {
            let bound = if next.parameter < low { low } else { high };
            if let Some(end) = follower.at_bound(&last, bound) {
                found.push(follower.point(&end, false));
            }
            return (found, End::Range);
        }
        if next.tangent[m] * last.tangent[m] < 0.0
            && let Some(fold) = follower.fold(&last, &next, length)
        {
            found.push(follower.point(&fold, true));
        }
        found.push(follower.point(&next, false));
        length = if next.sweeps > MANY_SWEEPS { 0.6 * length } else { (1.4 * length).min(LONGEST) };
        before = Some(std::mem::replace(&mut last, next));
    }
    (found, End::Points)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Follower<'_> {
    fn point(&self, solved: &Solved, is_fold: bool) -> BranchPoint {
        let (q, chain) = self.family.at(solved.parameter);
        let equation = Equation { plan: self.family.plan, q: &q, chain: &chain };
        let steady = Steady {
            mesh: Mesh::new(&equation, solved.mesh.edges.clone()),
            solution: solved.solution.clone(),
            monodromy: solved.monodromy.clone(),
            reached: solved.reached,
            cycles: 0,
            multiple: 1,
        };
        BranchPoint { parameter: solved.parameter, steady, is_fold, q, chain }
    }

    /// The first motion with its tangent.
    fn first(&self, first: Steady, parameter: f64, tangent: &[f64]) -> Option<Solved> {
        let start = first.solution.start.clone();
        let plane = Plane { origin: (&start, parameter), tangent, length: 0.0 };
        self.refined((first.mesh.edges, Vec::new()), first.solution, parameter, &plane)
    }

    /// The next motion at a distance.
    fn step(&self, last: &Solved, before: Option<&Solved>, length: f64) -> Option<Solved> {
        let plane = Plane { origin: (&last.solution.start, last.parameter), tangent: &last.tangent, length };
        let m = last.solution.states();
        let parameter = last.parameter + length * last.tangent[m] * self.width;
        let mut guess = last.solution.clone();
        if let Some(before) = before {
            let scale = scales(&last.solution, &self.family.machines[0].1);
            let past = before.solution.on(&before.mesh.edges, &last.mesh.edges);
            let apart = distance(
                &last.solution.start,
                &past.start,
                &scale,
                last.parameter - before.parameter,
                self.width,
            );
            let share = (length / apart.max(1e-12)).min(3.0);
            let ahead = |to: &mut [f64], past: &[f64]| {
                to.iter_mut().zip(past).for_each(|(y, old)| *y += share * (*y - old));
            };
            ahead(&mut guess.stages, &past.stages);
            ahead(&mut guess.start, &past.start);
        }
        self.refined((last.mesh.edges.clone(), last.placed.clone()), guess, parameter, &plane)
    }

    /// The motion at an end of the range.
    fn at_bound(&self, last: &Solved, bound: f64) -> Option<Solved> {
        let m = last.solution.states();
        let mut tangent = vec![0.0; m + 1];
        tangent[m] = 1.0;
        let plane = Plane { origin: (&last.solution.start, bound), tangent: &tangent, length: 0.0 };
        self.refined((last.mesh.edges.clone(), last.placed.clone()), last.solution.clone(), bound, &plane)
    }

    /// The fold between two motions, where the tangent has no part along the parameter.
    fn fold(&self, last: &Solved, next: &Solved, length: f64) -> Option<Solved> {
        let m = last.solution.states();
        let (mut low, mut high) = ((0.0, last.tangent[m]), (length, next.tangent[m]));
        for k in 0..SECANTS {
            let secant = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
            // Every third one halves, so that no end stays.
            let at = if k % 3 == 2 { 0.5 * (low.0 + high.0) } else { secant };
            let found = self.step(last, None, at)?;
            let slope = found.tangent[m];
            if slope.abs() < LEVEL {
                return Some(found);
            }
            if slope * low.1 > 0.0 { low = (at, slope) } else { high = (at, slope) }
        }
        None
    }

    /// A motion in a plane to the wanted accuracy.
    fn refined(
        &self,
        (mut edges, mut placed): (Vec<f64>, Vec<f64>),
        mut solution: Solution,
        mut parameter: f64,
        plane: &Plane<'_>,
    ) -> Option<Solved> {
        let mut sweeps = 0;
        for round in 0..ROUNDS_MAX {
            let (end, taken) = self.corrected((&edges, &placed), &mut solution, &mut parameter, plane)?;
            sweeps = sweeps.max(if round == 0 { taken } else { 0 });
            let (q, chain) = self.family.at(parameter);
            let equation = Equation { plan: self.family.plan, q: &q, chain: &chain };
            let mesh = Mesh::new(&equation, edges);
            let scale = scales(&solution, &chain);
            let found = errors(&equation, &mesh, &solution, &scale);
            let crossings = crossings(&equation, &mesh, &solution, &scale);
            let (errors, reached) = worst_error(found, &crossings, &mesh, &solution, self.request, round);
            if reached <= self.request.accuracy {
                let tangent = self.tangent(&end, &solution, &scale, plane.tangent);
                let monodromy = monodromy(&end, solution.states());
                return Some(Solved {
                    parameter,
                    mesh,
                    solution,
                    monodromy,
                    tangent,
                    reached,
                    sweeps,
                    placed,
                });
            }
            let next = finer_edges(&mesh, &errors, &crossings, self.request.accuracy, &mut placed);
            if next.len() > STEPS_MAX {
                return None;
            }
            let finer = Mesh::new(&equation, next);
            solution = solution.on(&mesh.edges, &finer.edges);
            edges = finer.edges;
        }
        None
    }

    /// Newton's method in a plane; gives the end of the cycle over its start and the parameter, and the sweeps taken.
    fn corrected(
        &self,
        (edges, placed): (&[f64], &[f64]),
        solution: &mut Solution,
        parameter: &mut f64,
        plane: &Plane<'_>,
    ) -> Option<(Vec<f64>, usize)> {
        let m = solution.states();
        let (mut last, mut damped) = (f64::INFINITY, 1.0);
        for sweep in 1..=SWEEPS_MAX {
            poll();
            let (q, chain) = self.family.at(*parameter);
            let equation = Equation { plan: self.family.plan, q: &q, chain: &chain };
            let scale = scales(solution, &chain);
            let mesh = Mesh::new(&equation, edges.to_vec()).with_kinks(placed);
            let by_parameter = self.by_parameter(edges, solution, *parameter);
            let (solved, end) = Cycle::new(equation, &mesh).linear(solution, &by_parameter);
            let mut table = closure(&end, solution, 1);
            let row = &mut table[m * (m + 2)..];
            let mut distance = plane.tangent[m] * (*parameter - plane.origin.1) / self.width;
            for r in 0..m {
                row[r] = plane.tangent[r] / scale[r];
                distance += plane.tangent[r] * (solution.start[r] - plane.origin.0[r]) / scale[r];
            }
            (row[m], row[m + 1]) = (plane.tangent[m] / self.width, plane.length - distance);
            solve(&mut table, m + 1, 1);
            let by: Vec<f64> = (0..=m).map(|r| table[r * (m + 2) + m + 1]).collect();
            let [size, share] = correct(solution, &solved, &by, &scale, damped)?;
            *parameter += share * by[m];
            if !parameter.is_finite() {
                return None;
            }
            let size = size.max(by[m].abs() / self.width);
            if is_last(size, last) {
                return Some((end, sweep));
            }
            damped = damping(damped, sweep, size / last);
            last = size;
        }
        None
    }

    /// Derivatives of the rates at all stages by the parameter, by central differences.
    fn by_parameter(&self, edges: &[f64], solution: &Solution, parameter: f64) -> Vec<f64> {
        let (m, step) = (solution.states(), DIFFERENCE * self.width);
        let rates = |parameter: f64| {
            let (q, chain) = self.family.at(parameter);
            let equation = Equation { plan: self.family.plan, q: &q, chain: &chain };
            let mesh = Mesh::new(&equation, edges.to_vec());
            let mut at = Rates::new(&chain);
            let mut list = Vec::with_capacity(solution.stages.len());
            for (i, y) in solution.stages.chunks_exact(m).enumerate() {
                equation.rates(&mesh.rows.row(i), y, &mut at);
                list.extend_from_slice(&at.rate);
            }
            list
        };
        let (below, above) = (rates(parameter - step), rates(parameter + step));
        debug_assert_eq!(above.len(), (edges.len() - 1) * S * m);
        above.iter().zip(below).map(|(above, below)| (above - below) / (2.0 * step)).collect()
    }

    /// Direction of the branch, of length 1, on the side of a given one.
    fn tangent(&self, end: &[f64], solution: &Solution, scale: &[f64], side: &[f64]) -> Vec<f64> {
        let m = solution.states();
        let mut table = closure(end, solution, 1);
        for r in 0..m {
            table[r * (m + 2) + m + 1] = 0.0;
            table[m * (m + 2) + r] = side[r] / scale[r];
        }
        (table[m * (m + 2) + m], table[m * (m + 2) + m + 1]) = (side[m] / self.width, 1.0);
        solve(&mut table, m + 1, 1);
        let size = |r: usize| if r < m { scale[r] } else { self.width };
        let mut found: Vec<f64> = (0..=m).map(|r| table[r * (m + 2) + m + 1] / size(r)).collect();
        let length = dot(&found, &found).sqrt();
        found.iter_mut().for_each(|t| *t /= length);
        found
    }
}

/// Distance of two motions over the scales.
fn distance(a: &[f64], b: &[f64], scale: &[f64], parameters: f64, width: f64) -> f64 {
    let states: f64 = a.iter().zip(b).zip(scale).map(|((a, b), scale)| ((a - b) / scale).powi(2)).sum();
    (states + (parameters / width).powi(2)).sqrt()
}
