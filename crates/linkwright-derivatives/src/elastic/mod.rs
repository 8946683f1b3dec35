//! Derivatives of the steady motion of an elastic driveline by the numbers of machine and driveline.
//!
//! The collocation R(X, p) = 0 of [`linkwright_driveline::cycle`] gives dX/dp = −R_X⁻¹ R_p: the sweep of Newton's method from
//! the solution, with a right side for every direction. R_p is the equation of motion in duals. Ends of steps that lie on kinks
//! move with them, so that loads may jump there. An extreme has the derivative of its curve at its place (envelope theorem).
//! The monodromy matrix M is a product of the derivatives of the ends of the steps by their starts; those of the equation's
//! Jacobian along the derivative of the solution give dM/dp, and by it the derivatives of the multipliers.
//!
//! | module | answers |
//! | --- | --- |
//! | `sweep` | the linear system of all steps, for any right sides |
//! | `stage` | the mechanism at a crank angle, along directions |
//! | `solution` | the solution along directions, and its monodromy matrix |
//! | `kinks` | kinks that the motion passes, and how they move the monodromy matrix |
//! | `peaks` | where extremes are, and their derivatives there |

mod kinks;
mod peaks;
mod solution;
mod stage;
mod sweep;

use crate::along::{Directions, put};
use kinks::kinks_of;
use linkwright_core::drive::structure::Plan;
use linkwright_core::linkage::motion::Motion;
use linkwright_driveline::chain::Chain;
use linkwright_driveline::equation::Equation;
use linkwright_driveline::reading::Measures;
use linkwright_driveline::steady::Steady;
use linkwright_driveline::work::Work;
use linkwright_kernel::call::poll;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::lanes::{Job, in_common_lanes};
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;
use peaks::{Place, Quantity, place_of};
use solution::Along;
use sweep::Sweep;

/// A solution, and what it is differentiated by.
#[derive(Clone, Copy)]
pub struct ElasticGradient<'a> {
    /// The machine's structure.
    pub plan: &'a Plan,
    /// Its numbers, and behind them those of its driveline ([`Chain::numbers`]).
    pub numbers: &'a [f64],
    /// Its driveline.
    pub chain: &'a Chain,
    /// The solution.
    pub steady: &'a Steady,
    /// Directions of the numbers, (numbers, directions).
    pub directions: &'a [f64],
}

/// Derivatives, each list part by part and direction by direction; no numbers where a load jumps at a kink that moves with the motion.
#[derive(Clone, Debug)]
pub struct ElasticDerivatives {
    /// Of the duration of a cycle, (directions).
    pub period: Vec<f64>,
    /// Of mean torque and work in a cycle of every driver, (drivers, directions).
    pub drive_mean: Vec<f64>,
    /// See above.
    pub drive_work: Vec<f64>,
    /// Of the work of the loads in a cycle.
    pub load_work: Vec<f64>,
    /// Of mean torque, root mean square torque and the damper's work of every link, (links, directions).
    pub torque_mean: Vec<f64>,
    /// See above.
    pub torque_rms: Vec<f64>,
    /// See above.
    pub loss: Vec<f64>,
    /// Of minimum and maximum of each quantity, (parts, directions).
    pub speed: [Vec<f64>; 2],
    /// See above.
    pub acceleration: [Vec<f64>; 2],
    /// See above.
    pub twist: [Vec<f64>; 2],
    /// See above.
    pub torque: [Vec<f64>; 2],
    /// See above.
    pub drive: [Vec<f64>; 2],
    /// Of the monodromy matrix, row by row, (its numbers, directions); no number where a kink that the motion passes has none.
    pub monodromy: Vec<f64>,
}

impl ElasticGradient<'_> {
    /// How many directions there are.
    fn n(&self) -> usize {
        self.directions.len() / self.numbers.len().max(1)
    }

    fn along(&self) -> Directions<'_> {
        Directions { plan: self.plan, q: self.numbers, values: self.directions, n: self.n() }
    }

    fn equation(&self) -> Equation<'_> {
        Equation { plan: self.plan, q: self.q(), chain: self.chain }
    }

    fn q(&self) -> &[f64] {
        &self.numbers[..self.numbers.len() - self.chain.numbers().len()]
    }

    /// The derivatives. Not inlined: every crate that called it would compile its own kernel.
    #[inline(never)]
    pub fn derivatives(self, measures: &Measures) -> ElasticDerivatives {
        in_common_lanes(Derivation { of: self, measures })
    }

    /// Derivatives of curves at crank angles, (speeds, accelerations, twists and torques of all parts, angles, directions).
    #[inline(never)]
    pub fn curves(self, phi: &[f64]) -> Vec<f64> {
        in_common_lanes(CurvesAlong { of: self, phi })
    }

    /// All that has curves, in their order.
    fn quantities(&self) -> Vec<Quantity> {
        let (masses, links, drivers) =
            (self.chain.masses(), self.chain.links.len(), self.chain.drivers.len());
        let of_masses = [Quantity::Speed as fn(usize) -> Quantity, Quantity::Acceleration];
        let of_links = [Quantity::Twist as fn(usize) -> Quantity, Quantity::Torque];
        let of_masses = of_masses.into_iter().flat_map(|of| (0..masses).map(of));
        let of_links = of_links.into_iter().flat_map(|of| (0..links).map(of));
        of_masses.chain(of_links).chain((0..drivers).map(Quantity::Drive)).collect()
    }
}

/// Derivatives of all numbers of a motion.
struct Derivation<'a> {
    of: ElasticGradient<'a>,
    measures: &'a Measures,
}

impl Job for Derivation<'_> {
    type Output = ElasticDerivatives;

    #[inline(always)]
    fn run<R: Real>(self) -> ElasticDerivatives {
        let Derivation { of, measures } = self;
        let (n, m) = (of.n(), of.chain.states());
        let sweep = Sweep::new(of.equation(), of.steady);
        let places = places(&of, measures);
        let kinks = kinks_of(of.equation(), of.steady);
        let (links, drivers) = (of.chain.links.len(), of.chain.drivers.len());
        let fixed = 2 + 2 * drivers + 3 * links;
        let mut table = vec![0.0; (fixed + places.len()) * n];
        let mut monodromy = vec![0.0; m * m * n];
        let directions = of.along();
        for some in directions.moving().chunks(R::LANES) {
            poll();
            let numbers = directions.numbers::<R>(some);
            let (q, of_chain) = numbers.split_at(of.q().len());
            let chain = of.chain.with(of_chain);
            let equation = Equation { plan: of.plan, q, chain: &chain };
            let mut motion = Motion::new(&of.plan.mechanism, q);
            let along = Along::new(equation, of.steady, &sweep, &kinks, &mut motion);
            let mut rows = table.chunks_exact_mut(n);
            let mut add = |d: R| rows.next().into_iter().for_each(|row| put(d, some, row));
            let work: Work<Dual<R>> = along.work();
            add(work.period.d);
            add(work.load.d);
            for (driver, sums) in work.drivers.iter().enumerate() {
                [work.mean_drive(driver), sums[1]].into_iter().for_each(|number| add(number.d));
            }
            for (link, sums) in work.links.iter().enumerate() {
                let [mean, rms] = work.torques(link);
                [mean, rms, sums[2]].into_iter().for_each(|number| add(number.d));
            }
            for &(quantity, place) in &places {
                add(out_of_line!(R, along.at(quantity, place, &mut motion).d));
            }
            let moved = out_of_line!(R, along.monodromy(&sweep, &kinks));
            for (row, d) in monodromy.chunks_exact_mut(n).zip(moved) {
                put(d, some, row);
            }
        }
        if kinks.iter().any(|kink| kink.jumps) {
            // The motion itself changes with the angle of a jump, which these derivatives hold.
            table.fill(f64::NAN);
        }
        let row = |at: usize| table[at * n..][..n].to_vec();
        let of_links =
            |which: usize| (0..links).flat_map(|link| row(2 + 2 * drivers + 3 * link + which)).collect();
        let of_drivers = |which: usize| (0..drivers).flat_map(|each| row(2 + 2 * each + which)).collect();
        let mut next = fixed;
        let mut extremes = |parts: usize| {
            let first = next;
            next += 2 * parts;
            [0, 1].map(|end| (0..parts).flat_map(|part| row(first + 2 * part + end)).collect())
        };
        let masses = of.chain.masses();
        ElasticDerivatives {
            period: row(0),
            load_work: row(1),
            drive_mean: of_drivers(0),
            drive_work: of_drivers(1),
            torque_mean: of_links(0),
            torque_rms: of_links(1),
            loss: of_links(2),
            speed: extremes(masses),
            acceleration: extremes(masses),
            twist: extremes(links),
            torque: extremes(links),
            drive: extremes(drivers),
            monodromy,
        }
    }
}

/// Where minimum and maximum of every quantity are, in the order of the quantities.
fn places(of: &ElasticGradient<'_>, measures: &Measures) -> Vec<(Quantity, Place)> {
    let constants: Vec<Dual<f64>> = of.numbers.iter().copied().map(Dual::constant).collect();
    let (q, of_chain) = constants.split_at(of.q().len());
    let chain = of.chain.with(of_chain);
    let equation = Equation { plan: of.plan, q, chain: &chain };
    let lists = [&measures.speed, &measures.acceleration, &measures.twist, &measures.torque, &measures.drive];
    let extremes = lists.into_iter().flatten();
    let mut places = Vec::new();
    for (quantity, extreme) in of.quantities().into_iter().zip(extremes) {
        for at in [(extreme.min_at, extreme.min), (extreme.max_at, extreme.max)] {
            places.push((quantity, place_of(&equation, of.steady, quantity, at)));
        }
    }
    places
}

/// Derivatives of curves.
struct CurvesAlong<'a> {
    of: ElasticGradient<'a>,
    phi: &'a [f64],
}

impl Job for CurvesAlong<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run<R: Real>(self) -> Vec<f64> {
        let CurvesAlong { of, phi } = self;
        let (n, quantities) = (of.n(), of.quantities());
        let sweep = Sweep::new(of.equation(), of.steady);
        let mut curves = vec![0.0; quantities.len() * phi.len() * n];
        let directions = of.along();
        for some in directions.moving().chunks(R::LANES) {
            poll();
            let numbers = directions.numbers::<R>(some);
            let (q, of_chain) = numbers.split_at(of.q().len());
            let chain = of.chain.with(of_chain);
            let equation = Equation { plan: of.plan, q, chain: &chain };
            let mut motion = Motion::new(&of.plan.mechanism, q);
            let along = Along::new(equation, of.steady, &sweep, &[], &mut motion);
            for (c, &quantity) in quantities.iter().enumerate() {
                for (i, &angle) in phi.iter().enumerate() {
                    let d = out_of_line!(R, along.at_angle(quantity, angle, &mut motion).d);
                    put(d, some, &mut curves[(c * phi.len() + i) * n..][..n]);
                }
            }
        }
        curves
    }
}
