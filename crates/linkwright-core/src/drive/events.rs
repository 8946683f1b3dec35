//! Kinks and jumps of the equation of motion at angles that depend on the motion: a speed at which the characteristic of
//! the drive has a kink, a switch of a formula, a knot of a damper's table.
//!
//! Where the motion passes one is found from its steps, becomes the end of a step, and stays there while the motion is
//! solved again, until neither moves. What depends on the side (a slope, a torque that jumps) is taken on the branch of
//! the step ([`crate::kernel::branch`]).

use crate::drive::cycle::Machine;
use crate::drive::law::SpeedKink;
use crate::drive::mesh::{Piece, crossing};
use crate::drive::structure::Plan;
use crate::kernel::radau::S;
use crate::kernel::real::Real;
use crate::linkage::motion::Motion;

/// Relative distance of a speed from a kink's below which it counts as the kink's. A break that is off by
/// 1e-9 rad changes the solution by the square of that.
const ON_KINK: f64 = 1e-10;

/// A kink this close to the end of a step, as a share of the step, lies at the end: what is left of it
/// changes the solution by the square of that. Where a law may jump it changes the solution in proportion.
const KINK_SHARE: f64 = 1e-6;
const KINK_SHARE_JUMP: f64 = 1e-10;

/// Angles \[rad\] to both sides of a jump at which the machine is looked at: far from where rounding hides the jump, near
/// enough that what extrapolation to it leaves is of the order of their product.
const BESIDE: f64 = 1e-5;

/// A change of the acceleration at a kink below this share of it is no jump.
const NO_JUMP: f64 = 1e-8;

/// Distance of u from a jump, as a share, at which its two sides are looked at.
const ASIDE: f64 = 1e-6;

/// What the motion may pass where its equation has a kink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A speed of the crank: the number of a kink of the drive.
    Speed(usize),
    /// A kink of a law.
    Law(SpeedKink),
}

/// Newton steps to the zero of an event: g is nearly linear in u.
const LEVEL_SWEEPS: usize = 4;

/// What the torques beside a jump do with a motion that is on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pull {
    /// Drive it back from either side.
    Holds,
    /// Drive it to where u is larger.
    Up,
    /// Drive it to where u is smaller.
    Down,
}

/// Where the motion passes a kink.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    /// Crank angle \[rad\], the end of a step.
    pub phi: f64,
    /// What it passes.
    pub event: Event,
    /// Factor by which it changes a small disturbance.
    pub factor: f64,
    /// How far the kink itself is \[rad\].
    away: f64,
}

impl Plan {
    /// How close to its kinks the ends of steps have to be, as a share of the step.
    pub fn kink_share(&self) -> f64 {
        if self.may_jump() { KINK_SHARE_JUMP } else { KINK_SHARE }
    }
}

/// The quantities whose zeros are kinks, of one machine or of its derivatives along several directions.
pub struct Events<'a, R> {
    machine: Machine<'a, R>,
    /// Speeds of the crank at which the drive has kinks \[rad/s\].
    speeds: Vec<R>,
    /// Kinks of laws.
    laws: Vec<SpeedKink>,
}

impl<'a, R: Real> Events<'a, R> {
    /// Those of a machine.
    #[inline(always)]
    pub fn new(machine: Machine<'a, R>) -> Self {
        let speeds = machine.plan.drive.speed_kinks(&machine.plan.tables, machine.q);
        Events { machine, speeds, laws: machine.plan.speed_kinks() }
    }

    /// All of them.
    fn all(&self) -> impl Iterator<Item = Event> {
        (0..self.speeds.len()).map(Event::Speed).chain(self.laws.iter().copied().map(Event::Law))
    }

    /// The quantity whose zero the event is.
    #[inline(always)]
    pub fn value(&self, event: Event, phi: R, u: R, m: &mut Motion<R>) -> R {
        let omega = (u * 2.0).sqrt();
        match event {
            Event::Speed(nth) => omega - self.speeds[nth],
            Event::Law(kink) => {
                let mut geometry = Vec::new();
                self.machine.row(phi, m, &mut geometry);
                self.machine.plan.speed_kink_value(self.machine.q, kink, &geometry, omega)
            }
        }
    }

    /// Its derivatives by φ and by u, by central differences.
    #[inline(always)]
    pub fn slopes(&self, event: Event, phi: R, u: R, m: &mut Motion<R>) -> [R; 2] {
        let (over_phi, over_u) = (R::splat(BESIDE), u * BESIDE);
        let by_phi = self.value(event, phi + over_phi, u, m) - self.value(event, phi - over_phi, u, m);
        let by_u = self.value(event, phi, u + over_u, m) - self.value(event, phi, u - over_u, m);
        [by_phi / (over_phi * 2.0), by_u / (over_u * 2.0)]
    }

    /// How the passing of a jump changes a small disturbance: the later the motion passes it, the longer the acceleration
    /// `before` lasts. With g the quantity whose zero the jump is, and g′ its derivative along the motion, the factor is
    /// g′ behind over g′ before (the saltation of Aizerman and Gantmacher, *PMM* 22, 1958); 1
    /// where the acceleration is continuous.
    #[inline(always)]
    pub fn saltation(&self, slopes: [R; 2], before: R, behind: R) -> R {
        let [by_phi, by_u] = slopes;
        let factor = (by_phi + by_u * behind) / (by_phi + by_u * before);
        let size = before.abs().max(behind.abs());
        // Rounding of an acceleration that does not jump would otherwise count.
        (behind - before).abs().select_lt(size * NO_JUMP, R::splat(1.0), factor)
    }
}

impl Events<'_, f64> {
    /// The size of a quantity, against which a value counts as zero.
    fn size(&self, event: Event, values: &[f64]) -> f64 {
        match event {
            Event::Speed(nth) => self.speeds[nth],
            Event::Law(_) => values.iter().fold(0.0, |size, value| value.abs().max(size)),
        }
    }

    /// Where a step passes the kink that lies between its ends, as a length from its start.
    fn place(&self, event: Event, piece: &Piece, [left, right]: [f64; 2], m: &mut Motion<f64>) -> f64 {
        let excess = |h: f64| {
            let end = self.machine.advance(piece.phi, piece.u, h, m).0.end();
            self.value(event, piece.phi + h, end, m)
        };
        crossing(excess, piece.h, left, right)
    }

    /// Angles inside steps at which the solution passes a kink of the drive or of a law, in order.
    pub fn crossings(&self, pieces: &[Piece], m: &mut Motion<f64>) -> Vec<f64> {
        let passed = self.passed_inside(pieces, ON_KINK, m);
        let mut crossings: Vec<f64> = passed.into_iter().map(|(k, h)| pieces[k].phi + h).collect();
        let cycle = self.machine.plan.cycle();
        crossings.retain(|phi| *phi > 0.0 && *phi < cycle);
        crossings.sort_by(f64::total_cmp);
        crossings.dedup();
        crossings
    }

    /// Crank angle and acceleration where the solution passes a kink inside a step, however near to its end: the curve of
    /// the acceleration has a corner there.
    pub fn corners(&self, pieces: &[Piece], m: &mut Motion<f64>) -> Vec<(f64, f64)> {
        let passed = self.passed_inside(pieces, 0.0, m);
        let corner = |(k, h): (usize, f64)| {
            let piece = &pieces[k];
            (piece.phi + h, self.machine.advance(piece.phi, piece.u, h, m).0.K[S - 1])
        };
        passed.into_iter().map(corner).collect()
    }

    /// Steps that pass a kink, with its distance from their starts. A kink within the share `near` of the speed, or of the
    /// law's quantity, at an end of a step lies at that end.
    fn passed_inside(&self, pieces: &[Piece], near: f64, m: &mut Motion<f64>) -> Vec<(usize, f64)> {
        let mut passed = Vec::new();
        let stages = || pieces.iter().flat_map(|piece| piece.X);
        let (low, high) = stages().fold((f64::INFINITY, 0.0_f64), |(low, high), u| (low.min(u), high.max(u)));
        // With room for what lies between the stages.
        let may_be_passed = |event: &Event| match *event {
            Event::Speed(nth) => (0.8 * low..1.2 * high).contains(&(0.5 * self.speeds[nth].powi(2))),
            Event::Law(_) => true,
        };
        for event in self.all().filter(may_be_passed) {
            let values: Vec<f64> =
                pieces.iter().map(|piece| self.value(event, piece.phi, piece.u, m)).collect();
            let near = near * self.size(event, &values);
            for (k, piece) in pieces.iter().enumerate() {
                let (left, right) = (values[k], values[(k + 1) % values.len()]);
                if left * right < 0.0 && left.abs() > near && right.abs() > near {
                    passed.push((k, self.place(event, piece, [left, right], m)));
                }
            }
        }
        passed
    }

    /// Where a step passes a kink of a law first, as a length from its start; none where it passes none.
    pub fn first_of_laws(&self, piece: &Piece, m: &mut Motion<f64>) -> Option<f64> {
        let mut first: Option<f64> = None;
        for event in self.laws.iter().copied().map(Event::Law) {
            let left = self.value(event, piece.phi, piece.u, m);
            let right = self.value(event, piece.phi + piece.h, piece.X[S - 1], m);
            let near = ON_KINK * self.size(event, &[left, right]);
            if left * right < 0.0 && left.abs() > near && right.abs() > near {
                let at = self.place(event, piece, [left, right], m);
                first = Some(first.map_or(at, |first| first.min(at)));
            }
        }
        first
    }

    /// All passages of a solved revolution among the given starts of steps. Of two within sight of one kink the nearer counts.
    pub fn passages<'p>(&self, starts: impl Iterator<Item = &'p Piece>, m: &mut Motion<f64>) -> Vec<Passage> {
        let mut passages: Vec<Passage> = Vec::new();
        for piece in starts {
            let Some(next) = self.passed_at(piece.phi, piece.u, m) else { continue };
            match passages.last_mut() {
                Some(last) if last.event == next.event && next.phi - last.phi < 2.0 * BESIDE => {
                    if next.away < last.away {
                        *last = next;
                    }
                }
                _ => passages.push(next),
            }
        }
        passages
    }

    /// The jump of a law on which the motion is held: there, within the share `near` of u, the torques of both sides drive it
    /// back. It slides along the jump then (Filippov, *Differential Equations with Discontinuous Righthand Sides*, 1988,
    /// § 4), and the law has some value between those of its sides.
    pub fn held(&self, phi: f64, u: f64, near: f64, m: &mut Motion<f64>) -> Option<Event> {
        self.laws.iter().copied().map(Event::Law).find(|&event| {
            let level = self.level(event, phi, u, m);
            (level / u - 1.0).abs() <= near && self.pull(event, phi, level, m) == Pull::Holds
        })
    }

    /// u on the zero of an event, near the one given, by Newton.
    pub fn level(&self, event: Event, phi: f64, mut u: f64, m: &mut Motion<f64>) -> f64 {
        for _ in 0..LEVEL_SWEEPS {
            u -= self.value(event, phi, u, m) / self.slopes(event, phi, u, m)[1];
        }
        u
    }

    /// What the torques beside the zero of an event do with a motion that is on it.
    pub fn pull(&self, event: Event, phi: f64, u: f64, m: &mut Motion<f64>) -> Pull {
        let [by_phi, by_u] = self.slopes(event, phi, u, m);
        let mut geometry = Vec::new();
        let row = self.machine.row(phi, m, &mut geometry);
        let epsilon = |share: f64| self.machine.acceleration(&row, &geometry, u * (1.0 + share)).value;
        // How fast u leaves the zero on either side of it.
        let [below, above] = [-ASIDE, ASIDE].map(|x| 2.0 * epsilon(x) - epsilon(2.0 * x) + by_phi / by_u);
        if below > 0.0 && above < 0.0 && below - above > NO_JUMP * u {
            Pull::Holds
        } else if above > 0.0 {
            Pull::Up
        } else {
            Pull::Down
        }
    }

    /// Growth of a step that ends on a kink of the drive.
    pub fn growth_on_side(&self, piece: &Piece, m: &mut Motion<f64>) -> f64 {
        let (step, geometry) = self.machine.step_of(piece.phi, piece.h, piece.u, piece.X, m);
        self.machine.growth_on_side(&step, &geometry)
    }

    /// ε before and behind an angle, from both sides.
    fn sides(&self, phi: f64, u: f64, m: &mut Motion<f64>) -> [f64; 2] {
        let mut geometry = Vec::new();
        let mut epsilon = |phi: f64, u: f64, m: &mut Motion<f64>| {
            geometry.clear();
            let row = self.machine.row(phi, m, &mut geometry);
            self.machine.acceleration(&row, &geometry, u).value
        };
        let there = epsilon(phi, u, m);
        [-BESIDE, BESIDE].map(|x| {
            2.0 * epsilon(phi + x, u + there * x, m) - epsilon(phi + 2.0 * x, u + 2.0 * there * x, m)
        })
    }

    /// What the motion passes at the end of a step, with the factor of a disturbance there; none where it passes nothing.
    pub fn passed_at(&self, phi: f64, u: f64, m: &mut Motion<f64>) -> Option<Passage> {
        let [before, behind] = self.sides(phi, u, m);
        for event in self.all() {
            let left = self.value(event, phi - BESIDE, u - before * BESIDE, m);
            let right = self.value(event, phi + BESIDE, u + behind * BESIDE, m);
            if left * right < 0.0 {
                let factor = self.saltation(self.slopes(event, phi, u, m), before, behind);
                let away = (self.value(event, phi, u, m) / (right - left)).abs() * (2.0 * BESIDE);
                return Some(Passage { phi, event, factor, away });
            }
        }
        None
    }
}
