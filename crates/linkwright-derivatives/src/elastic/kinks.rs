//! Kinks that the motion passes where its state has them: laws of links, characteristics of motors, further mechanisms.
//!
//! The rates f are continuous there and the Jacobian is not, so that the angle φ of a kink moves the monodromy matrix though not the
//! motion: M = Π U, and U gains (A⁻ − A⁺) dφ. Since f⁻ = f⁺ at the kink of every neighbouring motion,
//!
//! ```text
//! dφ/dp = −(y′⁻ − y′⁺)_p / (y″⁻ − y″⁺)
//! ```
//!
//! Source: di Bernardo, Budd, Champneys, Kowalczyk, *Piecewise-smooth Dynamical Systems*, 2008, section 2.5 (corrections of the flow
//! at a boundary; where f is continuous, the first one is the identity).

use super::stage::StageRow;
use linkwright_core::linkage::motion::Motion;
use linkwright_driveline::crossings::crossings;
use linkwright_driveline::equation::{Equation, Rates};
use linkwright_driveline::scale::scales;
use linkwright_driveline::steady::Steady;
use linkwright_kernel::dual::Dual;

/// Shares of a step at which both sides of its end are read inside, and from which they are taken on to the end.
const INSIDE: [f64; 2] = [1e-6, 2e-6];

/// An end of a step within this of a kink \[rad\] lies on it.
const ON_KINK: f64 = 1e-7;

/// Share of the rates up to which those of both sides are the same, and share below which nothing bends.
const JUMP: f64 = 1e-4;
/// See [`JUMP`].
const FLAT: f64 = 1e-7;

/// Changes that are not in proportion to those along the motion are of two kinks, above this share of themselves, and of all changes.
const APART: f64 = 1e-4;
/// See [`APART`].
const NOISE: f64 = 1e-7;

/// A kink at the end of a step.
pub(super) struct Kink {
    /// The step behind it.
    pub(super) step: usize,
    /// A⁻ − A⁺, row by row.
    pub(super) bends: Vec<f64>,
    /// y″⁻ − y″⁺.
    along: Vec<f64>,
    /// Whether the rates themselves jump.
    pub(super) jumps: bool,
}

/// What is read just before and just behind a kink, steps and shares of them, taken on to it.
pub(super) fn on_sides(step: usize, mut read: impl FnMut(usize, f64) -> Vec<f64>) -> [Vec<f64>; 2] {
    [(step - 1, INSIDE.map(|share| 1.0 - share)), (step, INSIDE)].map(|(k, [near, far])| {
        let far = read(k, far);
        read(k, near).iter().zip(far).map(|(near, far)| 2.0 * near - far).collect()
    })
}

impl Kink {
    /// By how much the kink moves where the rates before and behind change by these; no number where it has no derivative.
    pub(super) fn moves(&self, before: &[f64], behind: &[f64]) -> f64 {
        let changes = apart(before, behind);
        let size = largest(&self.along);
        let Some(at) = self.along.iter().position(|x| x.abs() == size).filter(|_| size > 0.0) else {
            return 0.0;
        };
        let by = -changes[at] / self.along[at];
        let left: Vec<f64> =
            changes.iter().zip(&self.along).map(|(change, along)| change + by * along).collect();
        let allowed = APART * largest(&changes) + NOISE * largest(before).max(largest(behind));
        if largest(&left) > allowed { f64::NAN } else { by }
    }
}

/// Kinks of a solution, in the order of their angles; those of its own mechanism stand at angles of their own.
pub(super) fn kinks_of(plain: Equation<'_>, steady: &Steady) -> Vec<Kink> {
    let (mesh, solution) = (&steady.mesh, &steady.solution);
    let scale = scales(solution, plain.chain);
    let found = crossings(&plain, mesh, solution, &scale);
    let near = |angle: f64| {
        let step = mesh.edges.partition_point(|&edge| edge < angle - ON_KINK);
        (1..mesh.steps()).contains(&step).then_some(step).filter(|&step| mesh.edges[step] < angle + ON_KINK)
    };
    let mut steps: Vec<usize> = found.iter().filter_map(|crossing| near(crossing.angle)).collect();
    steps.sort_unstable();
    steps.dedup();
    let numbers: Vec<Dual<f64>> = plain.q.iter().copied().map(Dual::constant).collect();
    let of_chain: Vec<_> = plain.chain.numbers().into_iter().map(Dual::constant).collect();
    let chain = plain.chain.with(&of_chain);
    let equation = Equation { plan: plain.plan, q: &numbers, chain: &chain };
    let mut motion = Motion::new(&plain.plan.mechanism, &numbers);
    let at = |step| kink_at(&equation, steady, step, &mut motion);
    steps.into_iter().filter_map(at).collect()
}

/// What bends at the end of a step; nothing where two forms of a law go over into each other smoothly.
fn kink_at(
    equation: &Equation<'_, Dual<f64>>,
    steady: &Steady,
    step: usize,
    motion: &mut Motion<Dual<f64>>,
) -> Option<Kink> {
    let (mut rates, m) = (Rates::new(equation.chain), steady.solution.states());
    // Rates, their derivatives along the motion, and the Jacobian, one behind the other.
    let [before, behind] = on_sides(step, |k, share| {
        let mut y = vec![0.0; m];
        steady.solution.state(k, share, &mut y);
        let phi = steady.mesh.edges[k] + share * steady.mesh.length(k);
        let mut read = |rate: &[f64]| {
            let moving: Vec<_> = y.iter().zip(rate).map(|(&value, &d)| Dual { value, d }).collect();
            equation.rates(&StageRow::new(equation, Dual::variable(phi), motion).row(), &moving, &mut rates);
            rates.rate.iter().map(|rate| rate.value).collect::<Vec<f64>>()
        };
        let mut all = read(&vec![0.0; m]);
        read(&all.clone());
        all.extend(rates.rate.iter().map(|rate| rate.d));
        all.extend(rates.jacobian.iter().map(|slope| slope.value));
        all
    });
    let differences = apart(&before, &behind);
    let parts = [0..m, m..2 * m, 2 * m..before.len()];
    let [jump, along, bends] = parts.clone().map(|part| largest(&differences[part]));
    let [rate, _, slope] = parts.map(|part| largest(&before[part.clone()]).max(largest(&behind[part])));
    let jumps = jump > JUMP * rate;
    (jumps || (along > 0.0 && bends > FLAT * slope)).then(|| Kink {
        step,
        along: differences[m..2 * m].to_vec(),
        bends: differences[2 * m..].to_vec(),
        jumps,
    })
}

fn apart(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter().zip(other).map(|(a, b)| a - b).collect()
}

fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |most, x| most.max(x.abs()))
}
