//! The drive: motor characteristic, gearbox with efficiency by direction, loads that depend on speed.
//!
//! All torques are given at the crankshaft; ω is the crank speed, i the ratio, ω_m = i ω the motor's.
//!
//! * Kloss with stator resistance: `M = 2 M_k (1 + a s_k) / (s/s_k + s_k/s + 2 a s_k)`, s = (ω₀ − ω_m)/ω₀,
//!   a = R₁/R₂′; a = 0 is the simplified formula, paper 1 (8). Source: M. Kloss, *Drehmoment und Schlüpfung
//!   des Drehstrommotors*, 1909; e.g. Fischer, *Elektrische Maschinen*, section on the torque curve.
//! * Catalogue curve below breakdown: a parabola, then a cubic, through start, pull-up and breakdown, monotone between
//!   them, level at pull-up and breakdown, so the slope is continuous.
//! * Gearbox: the motor's torque reaches the crank as `M i η` when the motor drives and as `M i · reverse`
//!   when the load drives it (reverse = 1/η unless the machine says otherwise).

use crate::kernel::real::{Lift, Real};
use crate::kernel::slot::Slot;
use crate::kernel::table::Table;
use serde::{Deserialize, Serialize};

/// Torque against speed at the motor shaft.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Motor {
    /// Switched off, or none.
    Off,
    /// The same torque at any speed.
    Constant { torque: Slot },
    /// Straight line through `torque` at standstill and zero at 1/`inverse_speed`.
    Line { torque: Slot, inverse_speed: Slot },
    /// Induction motor; `spans` describe the curve below breakdown, none for Kloss everywhere.
    Induction { inverse_synchronous: Slot, torque: Slot, slip: Slot, resistance: Slot, spans: Vec<Span> },
    /// Straight lines between points.
    Table { table: usize },
}

/// A cubic from (`x0`, `y0`) to (`x1`, `y1`), level at its right end; `is_level` at its left end too,
/// otherwise the parabola with twice the chord's slope there.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Span {
    pub x0: Slot,
    pub y0: Slot,
    pub x1: Slot,
    pub y1: Slot,
    /// 1/(x1 − x0).
    pub inverse_width: Slot,
    pub is_level: bool,
}

/// The driveline: motor, gearbox, and the inertia that turns with the crank.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Drive {
    pub motor: Motor,
    /// Motor speed / crank speed.
    pub ratio: Slot,
    /// Factor on `M i` when the motor drives.
    pub forward: Slot,
    /// Factor on `M i` when the load drives.
    pub reverse: Slot,
    /// Constant part of J_red \[kg m²\].
    pub inertia: Slot,
    /// Crank speed at which the search for steady motion starts \[rad/s\].
    pub speed_start: Slot,
    /// Tables of load torque over crank speed.
    pub speed_loads: Vec<usize>,
}

impl Drive {
    /// Motor torque at the motor shaft \[N m\] at crank speed ω.
    #[inline(always)]
    pub fn motor_torque<R: Real, N: Lift<R>>(&self, tables: &[Table], q: &[R], omega: N) -> N {
        let speed = omega * N::lift(q[self.ratio]);
        match &self.motor {
            Motor::Off => N::splat(0.0),
            Motor::Constant { torque } => N::lift(q[*torque]),
            Motor::Line { torque, inverse_speed } => {
                N::lift(q[*torque]) * (N::splat(1.0) - speed * N::lift(q[*inverse_speed]))
            }
            Motor::Table { table } => tables[*table].held_at(speed, q),
            Motor::Induction { inverse_synchronous, torque, slip, resistance, spans } => {
                let s = N::splat(1.0) - speed * N::lift(q[*inverse_synchronous]);
                let mut m = kloss(s, q[*torque], q[*slip], q[*resistance]);
                for span in spans.iter().rev() {
                    // Most motions stay above breakdown: where all lanes do, nothing of the span is needed.
                    let end = N::lift(q[span.x1]);
                    if speed.any_below(end) {
                        m = speed.select_lt(end, cubic(span, q, speed), m);
                    }
                }
                m
            }
        }
    }

    /// Torque of the motor at the crank \[N m\], through the gearbox.
    #[inline(always)]
    pub fn geared_torque<R: Real, N: Lift<R>>(&self, q: &[R], motor_torque: N) -> N {
        let (forward, reverse) = (N::lift(q[self.forward]), N::lift(q[self.reverse]));
        let factor = motor_torque.select_lt(N::splat(0.0), reverse, forward);
        motor_torque * N::lift(q[self.ratio]) * factor
    }

    /// Load torque of loads over speed \[N m\] at crank speed ω.
    #[inline(always)]
    pub fn speed_load<R: Real, N: Lift<R>>(&self, tables: &[Table], q: &[R], omega: N) -> N {
        let mut sum = N::splat(0.0);
        for &table in &self.speed_loads {
            sum = sum + tables[table].held_at(omega, q);
        }
        sum
    }

    /// Torque on the crank by motor and loads over speed \[N m\]: all that depends on ω alone.
    #[inline(always)]
    pub fn torque<R: Real, N: Lift<R>>(&self, tables: &[Table], q: &[R], omega: N) -> N {
        let torque = self.geared_torque(q, self.motor_torque(tables, q, omega));
        if self.speed_loads.is_empty() { torque } else { torque - self.speed_load(tables, q, omega) }
    }

    /// The same in the direction in which the crank turns, at its speed in that direction; `along` is +1 where the motor
    /// drives that way, −1 where it drives the other way. Loads over speed resist in both directions alike.
    pub fn torque_turning<N: Lift<f64>>(&self, tables: &[Table], q: &[f64], speed: N, along: f64) -> N {
        let sense = N::splat(along);
        let torque = self.geared_torque(q, self.motor_torque(tables, q, speed * sense) * sense);
        if self.speed_loads.is_empty() { torque } else { torque - self.speed_load(tables, q, speed) }
    }

    /// Crank speeds at which [`Drive::torque_turning`] has a kink.
    pub fn kinks_turning(&self, tables: &[Table], q: &[f64], along: f64) -> Vec<f64> {
        let motor = self.motor_kinks(tables, q).into_iter().map(|speed| along * speed);
        positive_in_order(motor.chain(self.load_kinks(tables, q)).collect())
    }

    /// Crank speeds at which the drive's torque has a kink: points of tables, breakdown where the catalogue
    /// curve begins, and where the motor's torque changes sign when the gearbox tells the directions apart.
    #[inline(always)]
    pub fn speed_kinks<R: Real>(&self, tables: &[Table], q: &[R]) -> Vec<R> {
        positive_in_order(self.kinks_of_lanes(tables, q))
    }

    /// The same of machines in lanes, in any order; not a number, or not above zero, in a lane without the kink.
    #[inline(always)]
    pub fn kinks_of_lanes<R: Real>(&self, tables: &[Table], q: &[R]) -> Vec<R> {
        let mut kinks = self.motor_kinks(tables, q);
        kinks.extend(self.load_kinks(tables, q));
        kinks
    }

    /// Points of the loads over speed.
    fn load_kinks<R: Real>(&self, tables: &[Table], q: &[R]) -> impl Iterator<Item = R> {
        let knots = self.speed_loads.iter().flat_map(|&table| tables[table].moving_knots());
        knots.map(|knot| knot.number(q))
    }

    /// Those of the motor, as crank speeds.
    #[inline(always)]
    fn motor_kinks<R: Real>(&self, tables: &[Table], q: &[R]) -> Vec<R> {
        let ratio = q[self.ratio];
        // Where the gearbox does not tell the directions apart a change of sign is no kink.
        let if_apart = |speed: R| {
            let apart = (q[self.forward] - q[self.reverse]).abs();
            R::splat(0.0).select_lt(apart, speed, R::splat(f64::NAN))
        };
        let mut at_motor = Vec::new();
        match &self.motor {
            Motor::Off | Motor::Constant { .. } => {}
            Motor::Line { inverse_speed, .. } => at_motor.push(if_apart(q[*inverse_speed].recip())),
            Motor::Induction { inverse_synchronous, spans, .. } => {
                at_motor.push(if_apart(q[*inverse_synchronous].recip()));
                for span in spans {
                    at_motor.push(q[span.x1]);
                }
            }
            Motor::Table { table } => {
                let table = &tables[*table];
                for knot in table.moving_knots() {
                    at_motor.push(knot.number(q));
                }
                at_motor.extend(zeros(table, q).into_iter().map(if_apart));
            }
        }
        for speed in &mut at_motor {
            *speed = *speed / ratio;
        }
        at_motor
    }
}

/// Speeds above zero, each once, in their order.
#[inline(always)]
fn positive_in_order<R: Real>(mut speeds: Vec<R>) -> Vec<R> {
    speeds.retain(|speed| speed.max_lane() > 0.0);
    speeds.sort_by(|a, b| a.max_lane().total_cmp(&b.max_lane()));
    speeds.dedup_by(|a, b| a.max_lane() == b.max_lane());
    speeds
}

/// Zeros of a table between its knots.
#[inline(always)]
fn zeros<R: Real>(table: &Table, q: &[R]) -> Vec<R> {
    let points: Vec<[R; 2]> = table.points(q).collect();
    let crossing = |(ends, pair): (&[f64], &[[R; 2]])| {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        let crosses = table.held(ends[0]).0 * table.held(ends[1]).0 < 0.0;
        crosses.then(|| x0 - y0 * (x1 - x0) / (y1 - y0))
    };
    table.knots().windows(2).zip(points.windows(2)).filter_map(crossing).collect()
}

/// Kloss, multiplied out so that s = 0 needs no special case.
#[inline(always)]
fn kloss<R: Real, N: Lift<R>>(s: N, torque: R, slip: R, resistance: R) -> N {
    let stator = resistance * slip;
    let top = torque * (stator + 1.0) * slip * 2.0;
    let denominator = s.mul_add(s + N::lift(stator * slip * 2.0), N::lift(slip.squared()));
    N::lift(top) * s / denominator
}

/// The span at speed x; below its left end the left end's torque is held.
#[inline(always)]
fn cubic<R: Real, N: Lift<R>>(span: &Span, q: &[R], x: N) -> N {
    let (x0, y0, y1) = (q[span.x0], q[span.y0], q[span.y1]);
    let z = ((x - N::lift(x0)) * N::lift(q[span.inverse_width])).max(N::splat(0.0));
    // Blend from 0 to 1 with level right end: z(2 − z), or z²(3 − 2z) when level on the left as well.
    let blend = if span.is_level { z.squared() * (N::splat(3.0) - z - z) } else { z * (N::splat(2.0) - z) };
    N::lift(y1 - y0).mul_add(blend, N::lift(y0))
}
