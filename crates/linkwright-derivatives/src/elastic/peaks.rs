//! Where extremes of an elastic driveline are, as exactly as their derivatives need.
//!
//! A derivative is that of the curve at the place of the extreme, which moves with the ends of its step: within a step, where the
//! slope is zero, that moves nothing; at an end the extreme is a corner, which moves along.

use super::stage::StageRow;
use linkwright_core::linkage::motion::Motion;
use linkwright_driveline::equation::{Equation, Rates};
use linkwright_driveline::steady::Steady;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::out_of_line;
use linkwright_kernel::radau::{slope_and_bend, value};
use linkwright_kernel::real::Real;

/// Share of a step within which an extreme at its end is a corner.
const AT_CORNER: f64 = 4e-6;

/// Share of a step by which its ends are read inside it: kinks lie on them.
const INSIDE: f64 = 1e-9;

/// Share of a step by which the first secant is long. So many secants lead to where the slope is zero, unless that lies farther
/// off than so many times the share.
const ASIDE: f64 = 4e-3;
const SECANTS: usize = 4;
const FAR: f64 = 4.0;

/// What has extremes, by mass or link.
#[derive(Clone, Copy, Debug)]
pub(super) enum Quantity {
    /// Speed of a mass \[rad/s\].
    Speed(usize),
    /// Acceleration of a mass \[rad/s²\].
    Acceleration(usize),
    /// Twist of a link \[rad\].
    Twist(usize),
    /// Torque of a link \[N m\].
    Torque(usize),
    /// Torque of a driver \[N m\].
    Drive(usize),
}

/// A share of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) step: usize,
    pub(super) share: f64,
}

impl Place {
    /// Whether it is at an end of the step, and moves with it.
    pub(super) fn is_corner(self) -> bool {
        self.share <= 0.0 || self.share >= 1.0
    }

    /// The same off the ends of the step.
    pub(super) fn inside(self) -> Place {
        Place { share: self.share.clamp(INSIDE, 1.0 - INSIDE), ..self }
    }
}

/// A quantity in a state at a crank angle.
#[inline(always)]
pub(super) fn read<R: Real>(
    equation: &Equation<'_, Dual<R>>,
    quantity: Quantity,
    phi: Dual<R>,
    y: &[Dual<R>],
    m: &mut Motion<Dual<R>>,
) -> Dual<R> {
    let chain = equation.chain;
    match quantity {
        Quantity::Speed(mass) => chain.speed(mass, y),
        Quantity::Twist(link) => chain.twist(&chain.links[link], y)[0],
        Quantity::Torque(link) => chain.torque(&chain.links[link], y).value,
        Quantity::Acceleration(part) | Quantity::Drive(part) => out_of_line!(Dual<R>, {
            let mut rates = Rates::new(chain);
            equation.rates(&StageRow::new(equation, phi, m).row(), y, &mut rates);
            if let Quantity::Drive(_) = quantity { rates.drive[part] } else { rates.acceleration[part] }
        }),
    }
}

/// The step and the share of it where an extreme lies.
pub(super) fn place_of(
    equation: &Equation<'_, Dual<f64>>,
    steady: &Steady,
    quantity: Quantity,
    (phi, extreme): (f64, f64),
) -> Place {
    let mut motion = Motion::new(&equation.plan.mechanism, equation.q);
    let mut read = |place: Place| value_and_slope(equation, steady, quantity, place, &mut motion);
    let mesh = &steady.mesh;
    let step = mesh.edges.partition_point(|&edge| edge <= phi).clamp(1, mesh.steps()) - 1;
    let share = (phi - mesh.edges[step]) / mesh.length(step);
    if !(AT_CORNER..=1.0 - AT_CORNER).contains(&share) {
        let edge = if share < 0.5 { step } else { step + 1 };
        let (last, steps) = (edge.checked_sub(1).unwrap_or(mesh.steps() - 1), mesh.steps());
        let sides = [Place { step: last, share: 1.0 }, Place { step: edge % steps, share: 0.0 }];
        let off = sides.map(|side| (read(side).value - extreme).abs());
        return if off[1] < off[0] { sides[1] } else { sides[0] };
    }
    Place { step, share: at_level(share, |share| read(Place { step, share }).d) }
}

/// A quantity at a share of a step, and its derivative by that share.
fn value_and_slope(
    equation: &Equation<'_, Dual<f64>>,
    steady: &Steady,
    quantity: Quantity,
    place: Place,
    m: &mut Motion<Dual<f64>>,
) -> Dual<f64> {
    let (mesh, solution) = (&steady.mesh, &steady.solution);
    let Place { step, share } = place.inside();
    let h = mesh.length(step);
    let mut y = Vec::with_capacity(solution.states());
    for number in 0..solution.states() {
        let quintic = solution.quintic(step, number);
        y.push(Dual { value: value(&quintic, share), d: slope_and_bend(&quintic, share).0 });
    }
    let phi = Dual { value: mesh.edges[step] + share * h, d: h };
    read(equation, quantity, phi, &y, m)
}

/// Where a slope is zero within a step, from a share near to it.
fn at_level(share: f64, mut slope: impl FnMut(f64) -> f64) -> f64 {
    let aside = ASIDE * (0.5 - share).signum();
    let mut places = [share, share + aside];
    let mut slopes = places.map(&mut slope);
    for _ in 0..SECANTS {
        let next = places[1] - slopes[1] * (places[1] - places[0]) / (slopes[1] - slopes[0]);
        // There is none where the quantity is constant, nor beyond the end of the step.
        if !((next - share).abs() < FAR * ASIDE && 0.0 < next && next < 1.0) {
            break;
        }
        (places, slopes) = ([places[1], next], [slopes[1], slope(next)]);
    }
    if slopes[1].abs() < slopes[0].abs() { places[1] } else { places[0] }
}
