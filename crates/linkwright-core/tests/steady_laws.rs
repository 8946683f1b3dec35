//! Laws of steady motion on random drives over twelve decades of steepness, on the curves and not only at
//! the ends of the steps: the speed is the integral of the acceleration, the acceleration that of the
//! torques, extremes are extremes of the curves, a revolution closes. Together these say that what is returned
//! solves the equation of motion.

mod common;

use common::{Builder, Random, SampleMachine};
use linkwright_core::drive::batch::{QUANTITIES, Rows, row_of_steady, steady_rows};
use linkwright_core::drive::between::Between;
use linkwright_core::drive::loads::{At, What};
use linkwright_core::drive::motor::Motor;
use linkwright_core::drive::reading::{Curves, ReadCurves};
use linkwright_core::drive::steady::{Steady, steady};
use linkwright_core::kernel::gauss::{B, C};
use linkwright_core::kernel::lanes::in_lanes;
use linkwright_core::kernel::plane::Angle;
use linkwright_core::kernel::status::Status;
use linkwright_core::linkage::motion::Motion;
use std::f64::consts::TAU;

/// What errors may be, as a share of the peaks.
const AGREES: f64 = 1e-6;

/// Parts of a step between whose ends the speed must be the integral of the acceleration.
const PARTS: usize = 3;

/// A slider-crank with dry friction and weight whose drive has the given steepness ∂ε/∂u \[1/rad\] on
/// average.
fn drive(random: &mut Random, steepness: f64) -> SampleMachine {
    let mut b = Builder::new();
    let r = random.between(0.05, 0.3);
    let (pin, crank) = b.crank(r, random.between(-3.0, 3.0));
    let [point, link, slide] =
        b.slider(pin, r * random.between(2.0, 5.0), r * random.between(-0.5, 0.5), 0.3, 1.0);
    let (speed, torque) = (random.between(5.0, 20.0), random.between(200.0, 400.0));
    // M_d = torque (1 − ω/speed): ∂ε/∂u = torque/(speed J ω).
    let inertia = torque / (speed * speed * steepness);
    let share = random.between(0.0, 0.9);
    b.mass(point, share * inertia / (r * r));
    b.rod(link, pin, r, 0.1 * share * inertia / (r * r));
    b.rod(crank, 0, r, 0.1 * inertia / (r * r));
    b.dry_slide(slide, random.between(0.0, 0.3) * torque / r);
    if random.between(0.0, 1.0) < 0.5 {
        let (stiffness, free_length, preload) =
            (b.number(random.between(0.0, 0.5) * torque / (r * r)), b.number(r), b.number(0.0));
        let anchor = b.fixed(2.0 * r, 3.0 * r);
        b.load(At::Between { from: point, to: anchor }, What::Spring { stiffness, free_length, preload });
    }
    let start = speed * 9.8 / 9.8;
    let reverse = [0.9, 1.0 / 0.9][usize::from(random.between(0.0, 1.0) < 0.5)];
    let motor = if random.between(0.0, 1.0) < 0.5 {
        Motor::Line { torque: b.number(torque / 9.8 / 0.9), inverse_speed: b.number(1.0 / (speed * 9.8)) }
    } else {
        let knots = [0.0, 0.7, 0.9, 1.1].map(|share| share * speed * 9.8);
        let table = b.table(&knots, &[1.2, 1.0, 0.35, -0.4].map(|share| share * torque / 9.8));
        Motor::Table { table }
    };
    b.finish(motor, [9.8, 0.9, reverse, (1.0 - share) * inertia + 1e-3 * inertia, start])
}

/// Ends of parts of all steps, and Gauss's nodes in them.
fn angles(found: &Steady) -> (Vec<f64>, Vec<f64>) {
    let (mut ends, mut nodes) = (vec![0.0], Vec::new());
    for (k, mark) in found.marks.iter().enumerate() {
        let h = (found.marks.get(k + 1).map_or(TAU, |next| next.phi) - mark.phi) / PARTS as f64;
        for part in 0..PARTS {
            let start = mark.phi + h * part as f64;
            nodes.extend(C.map(|c| start + c * h));
            ends.push(if part + 1 < PARTS { start + h } else { mark.phi + h * PARTS as f64 });
        }
    }
    if let Some(last) = ends.last_mut() {
        *last = TAU;
    }
    (ends, nodes)
}

/// Checks all laws of a solution, read as it is and by steps alone; gives its worst violation as a share of what is allowed.
fn violation(built: &SampleMachine, found: &Steady) -> f64 {
    let by_steps = violation_of(built, found, None);
    found.between.as_deref().map_or(by_steps, |series| by_steps.max(violation_of(built, found, Some(series))))
}

fn violation_of(built: &SampleMachine, found: &Steady, between: Option<&[Between<f64>]>) -> f64 {
    let SampleMachine { plan, q } = built;
    let (ends, nodes) = angles(found);
    let read = |phi: &[f64]| in_lanes(ReadCurves { plan, q, marks: &found.marks, between, phi });
    let (at_ends, at_nodes) = (read(&ends), read(&nodes));
    let peak = at_nodes.epsilon.iter().fold(0.0_f64, |peak, e| peak.max(e.abs()));
    let top = at_nodes.omega.iter().fold(0.0_f64, |top, &w| top.max(w));
    let peak = peak.max(1e-4 * top * top);
    let u = |curves: &Curves, i: usize| 0.5 * curves.omega[i].powi(2);
    let mut worst = ((u(&at_ends, ends.len() - 1) / u(&at_ends, 0) - 1.0) / AGREES).abs();
    for part in 0..ends.len() - 1 {
        let h = ends[part + 1] - ends[part];
        let integral: f64 = (0..4).map(|j| B[j] * at_nodes.epsilon[4 * part + j]).sum::<f64>() * h;
        let gained = u(&at_ends, part + 1) - u(&at_ends, part);
        let allowed = AGREES * peak * h + 1e-14 * u(&at_ends, part);
        worst = worst.max((gained - integral).abs() / allowed);
    }
    let mut m = Motion::new(&plan.mechanism, q);
    for (i, &phi) in nodes.iter().enumerate() {
        let omega = at_nodes.omega[i];
        let r = plan.reduce::<f64, 2>(q, Angle::new(phi), 1.0, &mut m);
        let torque =
            |omega: f64| plan.drive.torque(&plan.tables, q, omega) - r.load - r.dry - r.viscous * omega;
        let epsilon = (torque(omega) - 0.5 * r.J_d1 * omega * omega) / r.J;
        // The torque at the next number above tells what rounding of the speed makes of it.
        let rounding = 1e-15 * (torque(omega * (1.0 + 1e-6)) - torque(omega)).abs() * 1e6 / r.J;
        let rounding =
            rounding + 1e-14 * (plan.drive.torque(&plan.tables, q, omega).abs() + r.load.abs()) / r.J;
        worst = worst.max((at_nodes.epsilon[i] - epsilon).abs() / (AGREES * peak + 4.0 * rounding));
    }
    worst.max(outside(found, &at_ends, peak)).max(outside(found, &at_nodes, peak))
}

/// By how much curves leave the extremes, as a share of what is allowed.
fn outside(found: &Steady, curves: &Curves, peak: f64) -> f64 {
    let e = &found.extremes;
    let mut worst = 0.0_f64;
    for (&omega, &epsilon) in curves.omega.iter().zip(&curves.epsilon) {
        assert!(omega.is_finite() && epsilon.is_finite(), "a number in the curves");
        let speed = (e.speed_min.value - omega).max(omega - e.speed_max.value) / (AGREES * omega);
        let gain = (e.acceleration_min.value - epsilon).max(epsilon - e.acceleration_max.value);
        worst = worst.max(speed).max(gain / (AGREES * peak));
    }
    worst
}

/// 1 000 random drives, steepness from 1e-6 to 1e6 a radian.
#[test]
fn curves_solve_the_equation_of_motion_for_any_steepness() {
    let mut random = Random(21);
    let mut refused = 0;
    for i in 0..1000 {
        let steepness = 10_f64.powf(-6.0 + 12.0 * f64::from(i) / 1000.0);
        let built = drive(&mut random, steepness);
        match steady(&built.plan, &built.q, 1e-9) {
            Ok(found) => {
                // Rounding of u shows in the acceleration as many times as large as the drive is steep.
                let worst = violation(&built, &found) / (1e-11 * steepness / AGREES).max(1.0);
                assert!(worst <= 1.0, "drive {i}, steepness {steepness:.1e}: {worst:.2e} of what is allowed");
                let reached = found.reached;
                assert!(reached < AGREES.max(1e-11 * steepness), "drive {i}: {reached:e} reached");
            }
            Err(failure) => {
                assert_eq!(failure.status, Status::NoSteadyMotion, "drive {i}: {failure:?}");
                refused += 1;
            }
        }
    }
    assert!(refused < 150, "{refused} drives refused");
}

/// A row of a batch is the single answer to 1e-7, its extremes of acceleration to 1e-6, or has its status.
#[test]
fn rows_are_the_single_answer_for_any_steepness() {
    let mut random = Random(22);
    for i in 0..40 {
        let built = drive(&mut random, 10_f64.powf(-3.0 + 7.0 * f64::from(i) / 40.0));
        let slot = built.plan.drive.inertia;
        let n = 12;
        let values: Vec<f64> = (0..n).map(|k| built.q[slot] * 1.15_f64.powi(k)).collect();
        let rows = Rows { base: &built.q, slots: &[slot], values: &values, n: n as usize };
        let mut out = vec![0.0; n as usize * QUANTITIES];
        let status = steady_rows(&built.plan, &rows, 1e-8, &mut out).status;
        for row in 0..n as usize {
            match steady(&built.plan, &rows.row(row), 1e-10) {
                Err(failure) => assert_eq!(status[row], failure.status, "machine {i}, row {row}"),
                Ok(found) => {
                    assert_eq!(status[row], Status::Ok, "machine {i}, row {row}");
                    let exact = row_of_steady(&found);
                    let peak = exact[2].abs().max(exact[3].abs()).max(1e-4 * exact[1].powi(2));
                    for k in 0..5 {
                        let scale = if k == 2 || k == 3 { peak } else { exact[k].abs() };
                        let error = (out[row * QUANTITIES + k] - exact[k]).abs() / scale;
                        // Extremes of the acceleration are read at fewer places in lanes.
                        let allowed = if k == 2 || k == 3 { 1e-6 } else { 1e-7 };
                        assert!(error < allowed, "machine {i}, row {row}, number {k}: off by {error:e}");
                    }
                }
            }
        }
    }
}
