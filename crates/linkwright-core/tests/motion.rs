//! Steady motion and motion in time: laws of energy, closed forms, promised accuracy, batch against single.

mod common;

use common::{Builder, Random, SampleMachine, mixed, two_carts};
use linkwright_core::drive::batch::{Outcome, QUANTITIES, Rows, row_of_steady, steady_rows};
use linkwright_core::drive::equation::Machine;
use linkwright_core::drive::loads::{At, What};
use linkwright_core::drive::motor::Motor;
use linkwright_core::drive::steady::steady;
use linkwright_core::drive::transient::{End, Start, Trajectory, Turning, follow};
use linkwright_core::kernel::status::Status;
use linkwright_core::linkage::mechanism::Element;
use linkwright_core::linkage::motion::Motion;
use std::f64::consts::{FRAC_PI_2, TAU};

const FOREVER: f64 = 1e9;

fn from_rest(duration: f64, turns: f64) -> Start {
    Start { phi: 0.0, omega: 0.0, turning: Turning::FORWARD, duration, turns, accuracy: 1e-10 }
}

/// Published data of two carts: ω = 9.919…10.799 rad/s, δ = 0.0850, H = 0.1254 (recomputation, method 1).
#[test]
fn two_carts_move_as_recomputed() {
    let built = two_carts(FRAC_PI_2, 0.9);
    let found = steady(&built.plan, &built.q, 1e-12).expect("steady motion");
    let e = &found.extremes;
    let mean = 0.5 * (e.speed_min.value + e.speed_max.value);
    let delta = (e.speed_max.value - e.speed_min.value) / mean;
    let h = e.acceleration_max.value.max(-e.acceleration_min.value) / mean.powi(2);
    assert!((e.speed_min.value - 9.919).abs() < 5e-4, "ω_min {}", e.speed_min.value);
    assert!((e.speed_max.value - 10.799).abs() < 5e-4, "ω_max {}", e.speed_max.value);
    assert!((delta - 0.0850).abs() < 5e-5, "δ {delta}");
    assert!((h - 0.1254).abs() < 5e-5, "H {h}");
}

/// Over a revolution of steady motion the drive's work at the crank is the loads' work.
#[test]
fn work_over_a_turn_is_balanced() {
    let mut random = Random(5);
    for _ in 0..30 {
        let built = mixed(&mut random);
        let found = steady(&built.plan, &built.q, 1e-11).expect("steady motion");
        let (given, taken) = (found.totals.crank_work, found.totals.load_work);
        assert!((given / taken - 1.0).abs() < 1e-10, "{given} J given, {taken} J taken");
    }
}

/// The accuracy asked for is kept, for every decade down to 1e-12.
#[test]
fn accuracy_is_kept() {
    let mut random = Random(9);
    let machines = [two_carts(1.27, 0.9), two_carts(0.4, 1.0 / 0.9), mixed(&mut random), mixed(&mut random)];
    for built in &machines {
        let exact = steady(&built.plan, &built.q, 1e-12).expect("steady motion");
        for decade in 4..=11 {
            let accuracy = 10_f64.powi(-decade);
            let found = steady(&built.plan, &built.q, accuracy).expect("steady motion");
            let numbers = |s| {
                let row = row_of_steady(s);
                [row[0], row[1], row[2], row[3], row[4], row[6], row[7], row[8], row[9], row[10]]
            };
            for (found, exact) in numbers(&found).into_iter().zip(numbers(&exact)) {
                let error = (found / exact - 1.0).abs();
                assert!(error <= accuracy, "asked for {accuracy:e}, got {error:e}");
            }
            assert!(found.reached <= accuracy, "{:e} reached of {accuracy:e}", found.reached);
        }
    }
}

/// Newton's sweeps and the mesh: the work for two carts at 1e-10, pinned so that more work is noticed.
#[test]
fn work_of_the_search_is_as_before() {
    let built = two_carts(FRAC_PI_2, 0.9);
    let found = steady(&built.plan, &built.q, 1e-10).expect("steady motion");
    assert_eq!((found.sweeps, found.marks.len()), (5, 44), "sweeps and steps");
}

/// The same of a batch above breakdown: from a rough motion two sweeps a row.
#[test]
fn rows_start_from_a_rough_motion() {
    let built = two_carts(FRAC_PI_2, 0.9);
    let n = 64;
    let slot = built.q.iter().position(|&q| q == 1000.0).expect("the first cart's mass");
    let values: Vec<f64> = (0..n).map(|i| 950.0 + 1.5 * i as f64).collect();
    let rows = Rows { base: &built.q, slots: &[slot], values: &values, n };
    let Outcome { status, sweeps, .. } =
        steady_rows(&built.plan, &rows, 1e-9, &mut vec![0.0; n * QUANTITIES]);
    assert!(status.iter().all(|&s| s == Status::Ok), "all solved");
    assert!(sweeps <= 2 * n as u64, "{sweeps} sweeps of {n} rows");
}

/// Steady motion is what a long run-up ends in, and the multiplier is how a disturbance shrinks.
#[test]
fn run_up_ends_in_steady_motion() {
    let mut b = Builder::new();
    let (pin, _) = b.crank(0.2, 0.0);
    let [point, link, slide] = b.slider(pin, 0.8, 0.05, 0.3, 1.0);
    b.mass(point, 300.0);
    b.rod(link, pin, 0.8, 40.0);
    b.dry_slide(slide, 900.0);
    b.gravity(9.81);
    let (torque, inverse_speed) = (b.number(80.0), b.number(1.0 / 120.0));
    let built = b.finish(Motor::Line { torque, inverse_speed }, [10.0, 0.9, 0.9, 60.0, 12.0]);
    let cycle = steady(&built.plan, &built.q, 1e-12).expect("steady motion");
    let omega = (2.0 * cycle.marks[0].u).sqrt();

    let run_up = follow(&built.plan, &built.q, &from_rest(FOREVER, 40.0));
    assert_eq!(run_up.end, End::Turns, "how it ended");
    let last = *run_up.omega.last().expect("a motion");
    // 40 revolutions leave nothing of the start; 1e-10 a step over a thousand steps.
    assert!((last / omega - 1.0).abs() < 1e-8, "{last} rad/s after the run-up, {omega} in steady motion");

    let disturbed = |by: f64| {
        let start = Start {
            phi: 0.0,
            omega: omega + by,
            turning: Turning::FORWARD,
            duration: FOREVER,
            turns: 1.0,
            accuracy: 1e-12,
        };
        *follow(&built.plan, &built.q, &start).omega.last().expect("a motion")
    };
    let shrinks = (disturbed(1e-3) - disturbed(-1e-3)) / 2e-3;
    let multiplier = cycle.multiplier;
    // Central difference of a smooth map: error of order (1e-3)².
    assert!((shrinks - multiplier).abs() < 1e-5, "{shrinks} measured, {multiplier} predicted");
}

/// Inertia and loads read from polynomials over the angle move the machine as the mechanism itself does, which a high
/// accuracy asks for, whichever way it turns.
#[test]
fn motion_in_time_is_that_of_the_mechanism_itself() {
    let mut random = Random(31);
    for _ in 0..6 {
        let built = mixed(&mut random);
        for crank in [1.0, -1.0] {
            let run = |accuracy: f64| {
                let turning = Turning { crank, motor: crank };
                let start = Start { phi: 0.3, omega: 6.0, turning, duration: FOREVER, turns: 2.5, accuracy };
                follow(&built.plan, &built.q, &start)
            };
            let exact = run(1e-13);
            assert_eq!(exact.end, End::Turns, "how it ended");
            let time = |of: &Trajectory| *of.t.last().expect("a motion");
            let speed = |of: &Trajectory| *of.omega.last().expect("a motion");
            for accuracy in [1e-5, 1e-7, 1e-9, 1e-11] {
                let found = run(accuracy);
                // Some tens of steps, each of which errs by the accuracy at most.
                for (found, exact) in [(time(&found), time(&exact)), (speed(&found), speed(&exact))] {
                    let off = (found / exact - 1.0).abs();
                    assert!(off < 40.0 * accuracy, "{found} for {exact} at {accuracy:e}: off by {off:e}");
                }
            }
        }
    }
}

/// Without drive and load the kinetic energy ½ J ω² stays.
#[test]
fn free_motion_keeps_its_energy() {
    let mut b = Builder::new();
    let (pin, crank) = b.crank(0.1, 0.4);
    let [point, link, _] = b.slider(pin, 0.35, 0.02, 0.2, -1.0);
    let pivot = b.fixed(0.4, 0.0);
    let [_, _, rocker] = b.rocker(pin, pivot, 0.38, 0.3, 1.0);
    b.mass(point, 12.0);
    b.rod(link, pin, 0.35, 3.0);
    b.rod(rocker, pivot, 0.3, 4.0);
    b.rod(crank, 0, 0.1, 1.0);
    let built = b.finish(Motor::Off, [1.0, 1.0, 1.0, 0.3, 20.0]);
    let start = Start {
        phi: 0.3,
        omega: 20.0,
        turning: Turning::FORWARD,
        duration: FOREVER,
        turns: 50.0,
        accuracy: 1e-12,
    };
    let path = follow(&built.plan, &built.q, &start);
    let machine = Machine::new(&built.plan, &built.q);
    let mut m = Motion::new(&built.plan.mechanism, &built.q);
    let mut energy = |i: usize| 0.5 * machine.state(path.phi[i], 1.0, &mut m).J * path.omega[i].powi(2);
    let (first, last) = (energy(0), energy(path.t.len() - 1));
    // 1e-12 a step over some thousand steps.
    assert!((last / first - 1.0).abs() < 1e-9, "{first} J became {last} J");
}

/// Constant torque on a flywheel: ω = M t/J, φ = M t²/(2J).
#[test]
fn flywheel_under_constant_torque_has_its_closed_form() {
    let mut b = Builder::new();
    b.crank(0.1, 0.0);
    let torque = b.number(12.0);
    let built = b.finish(Motor::Constant { torque }, [5.0, 0.8, 1.0, 3.0, 10.0]);
    let path = follow(&built.plan, &built.q, &from_rest(2.5, FOREVER));
    let (epsilon, t) = (12.0 * 5.0 * 0.8 / 3.0, 2.5);
    let n = path.t.len() - 1;
    assert!((path.t[n] - t).abs() < 1e-15, "ends at {}", path.t[n]);
    assert!((path.omega[n] / (epsilon * t) - 1.0).abs() < 1e-12, "ω = {}", path.omega[n]);
    assert!((path.phi[n] / (0.5 * epsilon * t * t) - 1.0).abs() < 1e-12, "φ = {}", path.phi[n]);
}

/// A flywheel of 1 kg m² on a motor with the torque k (1 − ω/10): ω = 10 (1 − exp(−k t/10)), however steep, at the ends of the
/// steps and between them; each of the 159 revolutions takes a step in two halves, hardly more.
#[test]
fn a_steep_motor_follows_its_closed_form() {
    for k in [1e2, 1e5, 1e8, 1e11] {
        let mut b = Builder::new();
        b.crank(0.1, 0.0);
        let (torque, inverse_speed) = (b.number(k), b.number(0.1));
        let built = b.finish(Motor::Line { torque, inverse_speed }, [1.0, 1.0, 1.0, 1.0, 10.0]);
        let path = follow(&built.plan, &built.q, &from_rest(100.0, FOREVER));
        assert_eq!(path.end, End::Time, "steepness {k:e}");
        let exact = |t: f64| {
            let (rate, gone) = (0.1 * k, (-0.1 * k * t).exp_m1());
            [10.0 * (t + gone / rate), -10.0 * gone]
        };
        for i in 0..path.t.len() {
            let (t, [angle, speed]) = (path.t[i], exact(path.t[i]));
            // 1e-10 a step over some tens of steps.
            assert!(
                (path.omega[i] - speed).abs() < 1e-7,
                "{k:e}: speed {} for {speed} at {t}",
                path.omega[i]
            );
            assert!((path.phi[i] - angle).abs() < 1e-7, "{k:e}: angle {} for {angle} at {t}", path.phi[i]);
        }
        for (i, between) in path.between.iter().enumerate() {
            let h = path.t[i + 1] - path.t[i];
            for share in [0.03, 0.4, 0.77] {
                let [angle, speed] = exact(path.t[i] + share * h);
                let rise = |factors: &[f64; 7]| {
                    let term = |(i, factor): (usize, &f64)| {
                        factor * share.powi(i as i32 / 2 + 1) * (1.0 - share).powi((i as i32 + 1) / 2)
                    };
                    factors.iter().enumerate().map(term).sum::<f64>()
                };
                let off =
                    [path.phi[i] + rise(&between[0]) - angle, path.omega[i] + rise(&between[1]) - speed];
                assert!(off.iter().all(|off| off.abs() < 1e-7), "{k:e}: off by {off:?} inside step {i}");
            }
        }
        assert!(path.t.len() < 500, "{k:e}: {} steps", path.t.len());
        assert_eq!(path.implicit.len(), path.between.len());
        assert!(path.implicit.contains(&true), "{k:e}: no step by the implicit method");
    }
}

/// Run-down under dry friction on the crank: stops after ω²J/(2M) radians, and stays.
#[test]
fn dry_brake_stops_after_its_closed_form() {
    let mut b = Builder::new();
    b.crank(0.1, 0.0);
    let torque = b.number(7.0);
    b.load(At::Crank, What::Dry { size: torque });
    let built = b.finish(Motor::Off, [1.0, 1.0, 1.0, 2.0, 10.0]);
    let start = Start {
        phi: 0.0,
        omega: 9.0,
        turning: Turning::FORWARD,
        duration: FOREVER,
        turns: FOREVER,
        accuracy: 1e-10,
    };
    let path = follow(&built.plan, &built.q, &start);
    let angle = 9.0_f64.powi(2) * 2.0 / (2.0 * 7.0);
    assert_eq!(path.end, End::Stall, "how it ended");
    let last = *path.phi.last().expect("a motion");
    assert!((last / angle - 1.0).abs() < 1e-10, "stops after {last}, not {angle} rad");
}

/// A hanging crank too heavy for its motor: does not start, falls back, or stalls on the way up.
#[test]
fn standstill_is_told() {
    let lifted = |torque: f64, friction: f64, phi: f64| {
        let mut b = Builder::new();
        let (pin, _) = b.crank(1.0, 0.0);
        b.mass(pin, 10.0);
        b.gravity(10.0);
        let torque = b.number(torque);
        let friction = b.number(friction);
        b.load(At::Crank, What::Dry { size: friction });
        let built = b.finish(Motor::Constant { torque }, [1.0, 1.0, 1.0, 1.0, 5.0]);
        follow(&built.plan, &built.q, &Start { phi, ..from_rest(FOREVER, 3.0) })
    };
    // The weight needs 100 N m · cos φ.
    assert_eq!(lifted(90.0, 20.0, 0.0).end, End::DoesNotStart, "held by friction");
    assert_eq!(lifted(70.0, 20.0, 0.0).end, End::StartsBackwards, "pulled back");
    assert_eq!(lifted(60.0, 50.0, -FRAC_PI_2).end, End::Stall, "comes to rest and is held");
    assert_eq!(lifted(30.0, 5.0, -FRAC_PI_2).end, End::Reversal, "comes to rest and falls back");
    let there = lifted(90.0, 20.0, 0.0);
    assert!((there.drive_torque - 90.0).abs() < 1e-12, "drive {}", there.drive_torque);
    assert!((there.load_torque - 120.0).abs() < 1e-12, "load {}", there.load_torque);
    assert_eq!(lifted(150.0, 20.0, 0.0).end, End::Turns, "strong enough");
}

/// A speed that is rounding only is rest; a torque over speed holds at rest like a dry one.
#[test]
fn almost_at_rest_is_at_rest() {
    let build = |table: Option<f64>| {
        let mut b = Builder::new();
        b.crank(0.1, 0.0);
        let (drag, torque) = (b.number(20.0), b.number(5.0));
        b.load(At::Crank, What::Dry { size: drag });
        let table = table.map(|y| b.table(&[0.0, 10.0], &[y, 0.0]));
        let mut built = b.finish(Motor::Constant { torque }, [1.0, 1.0, 1.0, 1.0, 5.0]);
        built.plan.drive.speed_loads.extend(table);
        built
    };
    let machine = build(None);
    let start = Start { omega: 1e-12, ..from_rest(1.0, FOREVER) };
    let path = follow(&machine.plan, &machine.q, &start);
    assert_eq!(path.end, End::DoesNotStart, "5 N m against 20 N m");
    let held = build(Some(100.0));
    let path = follow(&held.plan, &held.q, &from_rest(1.0, FOREVER));
    assert_eq!(path.end, End::DoesNotStart, "a resisting table does not drive backwards");
    assert!((path.drive_torque - 5.0).abs() < 1e-12, "the motor gives {}", path.drive_torque);
    assert!((path.load_torque - 120.0).abs() < 1e-12, "the load needs {}", path.load_torque);
}

/// A dry force on a rocker's joint, along its path or across the rocker, is the same load as a dry torque on the rocker, alone or
/// against the frame, to any accuracy: where a load acts has its kinks.
#[test]
fn dry_force_on_a_joint_is_a_torque_on_its_rocker() {
    let (force, torque) = (60.0, 18.0);
    let build = |at: &dyn Fn(usize, usize, [usize; 2]) -> At, size: f64| {
        let mut b = Builder::new();
        let (pin, _) = b.crank(0.1, 0.0);
        let pivot = b.fixed(0.4, 0.0);
        let [joint, _, rocker] = b.rocker(pin, pivot, 0.35, 0.3, 1.0);
        b.mass(joint, 5.0);
        let [size, zero, one] = [size, 0.0, 1.0].map(|x| b.number(x));
        b.load(at(joint, rocker, [zero, one]), What::Dry { size });
        let (torque, inverse_speed) = (b.number(20.0), b.number(1.0 / 100.0));
        b.finish(Motor::Line { torque, inverse_speed }, [5.0, 1.0, 1.0, 0.5, 20.0])
    };
    let period = |built: &SampleMachine| {
        let found = steady(&built.plan, &built.q, 1e-10).expect("steady motion");
        (found.totals.period, found.marks.len())
    };
    let others = [
        build(&|point, _, _| At::Point { point }, force),
        build(&|point, link, [cos, sin]| At::Along { point, link, cos, sin }, force),
        build(&|_, link, [sin, cos]| At::BetweenLinks { link, other: None, cos, sin }, torque),
    ];
    let rocker = period(&build(&|_, link, _| At::Link { link }, torque));
    for other in others.iter().map(period) {
        assert!((other.0 / rocker.0 - 1.0).abs() < 1e-10, "{} and {} s", other.0, rocker.0);
        assert_eq!(other.1, rocker.1, "as many steps");
    }
}

/// A dry force on a slider in the direction of its guide is one along its guide, and one between it and a point far on the guide.
#[test]
fn dry_force_in_the_direction_of_a_guide_is_one_along_it() {
    let build = |at: &dyn Fn(usize, usize, usize, [usize; 2]) -> At| {
        let mut b = Builder::new();
        let (pin, _) = b.crank(0.1, 0.4);
        let far = b.fixed(-3.0, 0.0);
        let [point, _, slide] = b.slider(pin, 0.35, 0.0, 0.0, 1.0);
        b.mass(point, 5.0);
        let [size, zero, one] = [60.0, 0.0, 1.0].map(|x| b.number(x));
        b.load(at(slide, point, far, [one, zero]), What::Dry { size });
        let (torque, inverse_speed) = (b.number(20.0), b.number(1.0 / 100.0));
        b.finish(Motor::Line { torque, inverse_speed }, [5.0, 1.0, 1.0, 0.5, 20.0])
    };
    let period =
        |built: &SampleMachine| steady(&built.plan, &built.q, 1e-10).expect("steady motion").totals.period;
    let along = period(&build(&|slide, point, _, _| At::Slide { slide, point }));
    for built in [
        build(&|_, point, _, [cos, sin]| At::Toward { point, cos, sin }),
        build(&|_, to, from, _| At::Between { from, to }),
    ] {
        let other = period(&built);
        assert!((other / along - 1.0).abs() < 1e-10, "{other} and {along} s");
    }
}

/// Rows for which the fixed mesh of the lanes is too coarse are solved on their own: a light drive.
#[test]
fn a_light_drive_in_a_batch_is_as_good_as_alone() {
    let mut b = Builder::new();
    let (pin, _) = b.crank(0.1, 0.0);
    let [point, _, slide] = b.slider(pin, 0.3, 0.0, 0.0, 1.0);
    b.mass(point, 50.0);
    b.dry_slide(slide, 100.0);
    let (torque, inverse_speed) = (b.number(200.0), b.number(1.0 / 100.0));
    let built = b.finish(Motor::Line { torque, inverse_speed }, [5.0, 1.0, 1.0, 1.0, 20.0]);
    let slot = built.plan.drive.inertia;
    let inertias: Vec<f64> = (0..20).map(|i| 0.02 * 1.4_f64.powi(i)).collect();
    let rows = Rows { base: &built.q, slots: &[slot], values: &inertias, n: 20 };
    let mut out = vec![0.0; 20 * QUANTITIES];
    let status = steady_rows(&built.plan, &rows, 1e-9, &mut out).status;
    for row in 0..20 {
        assert_eq!(status[row], Status::Ok, "row {row}");
        let exact = row_of_steady(&steady(&built.plan, &rows.row(row), 1e-11).expect("steady"));
        for k in [0, 1, 4] {
            let error = (out[row * QUANTITIES + k] / exact[k] - 1.0).abs();
            assert!(error < 1e-7, "inertia {}, number {k}: off by {error:e}", inertias[row]);
        }
    }
}

/// A swing that comes to rest where it says: energy from the bottom, (M − T) φ = m g r (1 − cos φ).
#[test]
fn reversal_is_where_the_energy_is_used_up() {
    let mut b = Builder::new();
    let (pin, _) = b.crank(1.0, 0.0);
    b.mass(pin, 10.0);
    b.gravity(10.0);
    let torque = b.number(25.0);
    let built = b.finish(Motor::Constant { torque }, [1.0, 1.0, 1.0, 0.5, 5.0]);
    let path = follow(&built.plan, &built.q, &Start { phi: -FRAC_PI_2, ..from_rest(FOREVER, 3.0) });
    let swing = path.phi.last().expect("a motion") + FRAC_PI_2;
    let excess = 25.0 * swing - 100.0 * (1.0 - swing.cos());
    assert!(excess.abs() < 1e-8, "{excess} J left at {swing} rad");
}

/// A machine that the motor cannot keep turning has no steady motion.
#[test]
fn too_small_a_motor_has_no_steady_motion() {
    let mut b = Builder::new();
    let (pin, _) = b.crank(0.2, 0.0);
    let [point, _, slide] = b.slider(pin, 0.8, 0.0, 0.0, 1.0);
    b.mass(point, 100.0);
    b.dry_slide(slide, 5000.0);
    let (torque, inverse_speed) = (b.number(10.0), b.number(1.0 / 100.0));
    let built = b.finish(Motor::Line { torque, inverse_speed }, [10.0, 1.0, 1.0, 10.0, 10.0]);
    let failure = steady(&built.plan, &built.q, 1e-8).expect_err("the motor is too small");
    assert_eq!(failure.status, Status::NoSteadyMotion, "status");
    assert!(failure.omega > 10.0 && (0.0..TAU).contains(&failure.phi), "{failure:?}");
}

/// A batch in lanes and threads gives what the single search gives, also where the motor's curve has a kink.
#[test]
fn batch_is_the_single_machine() {
    for reverse in [0.9, 1.0 / 0.9] {
        let built = two_carts(FRAC_PI_2, reverse);
        let n = 300;
        // The second crank's phase (cos, sin), from 60° to 120°.
        let phase = |i: usize| TAU / 6.0 + TAU / 6.0 * i as f64 / n as f64;
        let cranks = built.plan.mechanism.elements.iter().filter_map(|element| match element {
            Element::Crank { cos, sin, .. } => Some((*cos, *sin)),
            _ => None,
        });
        let (cos, sin) = cranks.fold(None, |_, slots| Some(slots)).expect("two cranks");
        let values: Vec<f64> = (0..n).map(|i| phase(i).cos()).chain((0..n).map(|i| phase(i).sin())).collect();
        let rows = Rows { base: &built.q, slots: &[cos, sin], values: &values, n };
        let mut out = vec![0.0; n * QUANTITIES];
        let status = steady_rows(&built.plan, &rows, 1e-10, &mut out).status;
        assert!(status.iter().all(|&s| s == Status::Ok), "all solved");
        for row in 0..n {
            let exact = row_of_steady(&steady(&built.plan, &rows.row(row), 1e-12).expect("steady"));
            for k in 0..11 {
                let scale = exact[k].abs().max(if k == 5 { 1.0 } else { 1e-12 });
                let error = (out[row * QUANTITIES + k] - exact[k]).abs() / scale;
                // What lanes promise, also where the speed passes the synchronous one only between two stages of a step.
                assert!(error < 1e-7, "row {row}, number {k}: off by {error:e}");
            }
        }
    }
}

/// The same bits for any number of threads.
#[test]
fn threads_do_not_change_the_answer() {
    let built = two_carts(1.1, 0.9);
    let n = 700;
    let values: Vec<f64> = (0..n).map(|i| 900.0 + i as f64).collect();
    let slot = built.q.iter().position(|&q| q == 1000.0).expect("the first cart's mass");
    let rows = Rows { base: &built.q, slots: &[slot], values: &values, n };
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let mut out = vec![0.0; n * QUANTITIES];
        pool.install(|| steady_rows(&built.plan, &rows, 1e-9, &mut out));
        out
    };
    assert_eq!(run(1), run(2), "one and two threads");
}

/// What a row gives depends on that row alone, also where its motion passes the motor's breakdown and gets ends of
/// steps there: the same bits in any company.
#[test]
fn neighbours_do_not_change_a_row() {
    let built = two_carts(1.27, 0.9);
    let slot = built.q.iter().position(|&q| q == 1000.0).expect("the first cart's mass");
    let force = built.q.iter().position(|&q| q == 3562.0).expect("the first cart's resistance");
    let n = 60;
    let mass = |i: usize| 700.0 + 10.0 * i as f64;
    let resistance = |i: usize| 2400.0 + 1700.0 * ((i * 37) % n) as f64 / n as f64;
    let run = |order: &[usize]| {
        let values: Vec<f64> =
            order.iter().map(|&i| mass(i)).chain(order.iter().map(|&i| resistance(i))).collect();
        let rows = Rows { base: &built.q, slots: &[slot, force], values: &values, n: order.len() };
        let mut out = vec![0.0; order.len() * QUANTITIES];
        let status = steady_rows(&built.plan, &rows, 1e-9, &mut out).status;
        assert!(status.iter().all(|&s| s == Status::Ok), "all solved");
        out
    };
    let all: Vec<usize> = (0..n).collect();
    let together = run(&all);
    // Breakdown of the motor of paper 1, at the crank.
    let breakdown = 94.95 / 9.8;
    let passes = |row: &&[f64]| row[0] < breakdown && breakdown < row[1];
    let passing = together.chunks_exact(QUANTITIES).filter(passes).count();
    assert!(10 < passing && passing < 50, "{passing} of {n} rows pass breakdown");
    let reversed: Vec<usize> = (0..n).rev().collect();
    for order in [&reversed[..], &all[40..], &all[7..9]] {
        for (&i, row) in order.iter().zip(run(order).chunks_exact(QUANTITIES)) {
            assert_eq!(row, &together[i * QUANTITIES..(i + 1) * QUANTITIES], "row {i} of {}", order.len());
        }
    }
}

/// Scaling lengths by k at equal masses scales J by k², and the time of a free turn not at all.
#[test]
fn inertia_scales_with_the_square_of_length() {
    let size = |k: f64| {
        let mut b = Builder::new();
        let (pin, _) = b.crank(0.2 * k, 0.0);
        let [point, link, _] = b.slider(pin, 0.7 * k, 0.1 * k, 0.0, 1.0);
        b.mass(point, 10.0);
        b.rod(link, pin, 0.7 * k, 6.0);
        b.finish(Motor::Off, [1.0, 1.0, 1.0, 0.0, 1.0])
    };
    let J = |built: &SampleMachine| {
        let machine = Machine::new(&built.plan, &built.q);
        machine.state(0.7, 1.0, &mut Motion::new(&built.plan.mechanism, &built.q)).J
    };
    let (one, three) = (J(&size(1.0)), J(&size(3.0)));
    assert!((three / one - 9.0).abs() < 1e-13, "ratio {}", three / one);
}
