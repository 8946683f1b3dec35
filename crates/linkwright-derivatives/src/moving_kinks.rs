//! Kinks over the revolution as they move with the numbers of the machine.
//!
//! A kink at the zero of a watched quantity w moves by φ′ = −w_p/w′; one whose angle is a number, as the joint of a motion
//! law or the knot of a table over the crank angle, by the derivative of that number.

use linkwright_core::drive::equation::Machine;
use linkwright_core::drive::kinks::{ON_KINK, Watch};
use linkwright_core::linkage::mechanism::Element;
use linkwright_core::linkage::motion::Motion;
use linkwright_kernel::dual::Dual;
use linkwright_kernel::plane::Angle;
use linkwright_kernel::real::Real;
use std::f64::consts::TAU;

/// A zero is simple where the slope is more than this share \[rad\] of its own change with the angle, which is
/// measured over the second number \[rad\].
const TOUCHES: f64 = 1e-6;
const BESIDE: f64 = 1e-2;

/// Joints that move by the same but for rounding move together.
const TOGETHER: f64 = 1e-9;

/// A kink whose angle is a number of the machine.
struct Joint<R> {
    /// Crank angle \[rad\], that after which it repeats, and the derivative.
    angle: f64,
    period: f64,
    d: R,
    /// Whether inertia or its slope jump there; elsewhere the motion only bends.
    jumps: bool,
}

impl<R> Joint<R> {
    fn is_at(&self, angle: f64) -> bool {
        let apart = (self.angle - angle).rem_euclid(self.period);
        apart.min(self.period - apart) < ON_KINK
    }
}

/// A machine whose kinks move.
pub(crate) struct MovingKinks<'a, R>(pub(crate) Machine<'a, Dual<R>>);

impl<R: Real> MovingKinks<'_, R> {
    /// Crank angles with their derivatives: one on a kink moves with it, others stay. Of several kinks at one angle the joint of
    /// a motion law counts before others, and the knot of a table, where the motion only bends, behind them: as small as
    /// changes are, the motion does not depend on the place of a bend. It is no number where jumps at one angle move apart.
    #[inline(always)]
    pub(crate) fn moving(&self, angles: &[f64], m: &mut Motion<Dual<R>>) -> Vec<Dual<R>> {
        let (watches, joints, knots) = (self.0.plan.all_watches(), self.joints(), self.angle_knots());
        let mut moving = Vec::with_capacity(angles.len());
        for &angle in angles {
            let zeros = self.zeros_at(&watches, angle, m);
            let of_slides = zeros.iter().filter(|(watch, _)| is_knot(*watch)).map(|(_, d)| *d);
            let knot =
                farthest(knots.iter().filter(|knot| knot.is_at(angle)).map(|knot| knot.d).chain(of_slides));
            let zero = zeros.iter().rfind(|(watch, _)| !is_knot(*watch)).map(|(_, d)| *d);
            let d = joint_at(&joints, angle).or(zero).or(knot).unwrap_or(R::splat(0.0));
            moving.push(Dual { value: R::splat(angle), d });
        }
        moving
    }

    /// Watched quantities whose simple zero, a kink, is at a crank angle, with its derivatives.
    #[inline(always)]
    fn zeros_at(&self, watches: &[Watch], angle: f64, m: &mut Motion<Dual<R>>) -> Vec<(Watch, R)> {
        let mut zeros = Vec::new();
        let beside = self.watched_at(watches, angle + BESIDE, m);
        for ((&watch, [value, slope, room]), [_, next, _]) in
            watches.iter().zip(self.watched_at(watches, angle, m)).zip(beside)
        {
            let bend = (next.value - slope.value) * (1.0 / BESIDE);
            let is_zero =
                (value.value.abs() - slope.value.abs() * ON_KINK).max_lane() <= 0.0 && room.max_lane() > 0.0;
            // Where the quantity only touches zero, a change of the machine makes two kinks, or none.
            let is_simple = (bend.abs() * TOUCHES - slope.value.abs()).max_lane() < 0.0;
            if is_zero && is_simple {
                zeros.push((watch, -value.d / slope.value));
            }
        }
        zeros
    }

    /// All watched quantities with their slopes at a crank angle, and whether zeros are kinks there ([`Machine::room`]).
    #[inline(always)]
    fn watched_at(&self, watches: &[Watch], angle: f64, m: &mut Motion<Dual<R>>) -> Vec<[Dual<R>; 3]> {
        let phi = Dual::splat(angle);
        self.0.plan.mechanism.place::<Dual<R>, 2>(self.0.q, Angle::new(phi), m);
        let mut values = Vec::with_capacity(watches.len());
        for &watch in watches {
            let (value, slope) = self.0.watched(watch, phi, m);
            values.push([value, slope, self.0.room(watch, m)]);
        }
        values
    }

    /// Joints of motion laws in pieces.
    #[inline(always)]
    fn joints(&self) -> Vec<Joint<R>> {
        let mut joints = Vec::new();
        for element in &self.0.plan.mechanism.elements {
            let Element::Programme(programme) = element else { continue };
            for (nth, jumps) in programme.law.jumps().into_iter().enumerate() {
                let joint = self.0.q[programme.phase] + programme.law.start(nth, self.0.q);
                joints.push(Joint { angle: joint.value.max_lane(), period: TAU, d: joint.d, jumps });
            }
        }
        joints
    }

    /// Knots of tables over the crank angle.
    #[inline(always)]
    fn angle_knots(&self) -> Vec<Joint<R>> {
        let mut knots = Vec::new();
        for (table, turns) in self.0.plan.angle_tables() {
            for knot in table.moving_knots() {
                let (d, period) = (knot.number(self.0.q).d, TAU * f64::from(turns));
                knots.push(Joint { angle: knot.x, period, d, jumps: false });
            }
        }
        knots
    }
}

/// How the joints at an angle move: those at which the motion may jump count, else the one that moves farthest.
#[inline(always)]
fn joint_at<R: Real>(joints: &[Joint<R>], angle: f64) -> Option<R> {
    let mut jump: Option<R> = None;
    for joint in joints.iter().filter(|joint| joint.jumps && joint.is_at(angle)) {
        let by = jump.unwrap_or(joint.d);
        let apart = (joint.d - by).abs();
        jump = Some((by.abs() * TOGETHER).select_lt(apart, R::splat(f64::NAN), by));
    }
    jump.or_else(|| farthest(joints.iter().filter(|joint| joint.is_at(angle)).map(|joint| joint.d)))
}

/// Lane by lane the one that moves farthest; none of none.
#[inline(always)]
fn farthest<R: Real>(moves: impl Iterator<Item = R>) -> Option<R> {
    moves.reduce(
        #[inline(always)]
        |most, by| most.abs().select_lt(by.abs(), by, most),
    )
}

/// Whether a watched quantity is a knot of a table, where the motion bends and does not jump.
fn is_knot(watch: Watch) -> bool {
    matches!(watch, Watch::Passes(..))
}
