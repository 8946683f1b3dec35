//! Motion of trains in time: closed forms, laws of energy and momentum, promised accuracy, work.

mod common;

use common::require_derivatives;
use linkwright_kernel::error::PlanError;
use linkwright_torsion::transient::course::{Course, End, Method, Request, follow};
use linkwright_torsion::transient::curve::Curve;
use linkwright_torsion::transient::periodic::Periodic;
use linkwright_torsion::transient::rates::Rates;
use linkwright_torsion::transient::system::{Link, Manner, Rotor, System};
use linkwright_torsion::transient::torque::{Law, Shape, Torque};
use std::f64::consts::{PI, TAU};

const BOTH: [Method; 2] = [Method::Explicit, Method::Implicit];

/// Masses in a chain, without damping or torques.
fn chain(inertia: &[f64], stiffness: &[f64]) -> System {
    let link = |(i, &k): (usize, &f64)| Link {
        ends: [i, i + 1],
        ratio: 1.0,
        stiffness: k,
        damping: 0.0,
        curve: None,
        manner: Manner::default(),
    };
    System {
        inertia: inertia.to_vec(),
        damping: vec![0.0; inertia.len()],
        swing_damping: vec![0.0; inertia.len()],
        links: stiffness.iter().enumerate().map(link).collect(),
        rotors: Vec::new(),
        torques: Vec::new(),
        tables: Vec::new(),
        curves: Vec::new(),
        ..System::default()
    }
}

/// mean + Σ a cos(kθ + β), exact at 512 knots with its derivatives: so many that their jumps in the third derivative are
/// not felt by steps of 1e-10.
fn waves(period: f64, mean: f64, terms: &[(f64, f64, f64)]) -> Periodic {
    let at =
        |x: f64, f: &dyn Fn(f64, f64, f64, f64) -> f64| terms.iter().map(|&(k, a, b)| f(k, a, b, x)).sum();
    let list = |f: &dyn Fn(f64, f64, f64, f64) -> f64| -> Vec<f64> {
        (0..512).map(|i| at(period * f64::from(i) / 512.0, f)).collect()
    };
    let value: Vec<f64> = list(&|k, a, b, x| a * (k * x + b).cos()).iter().map(|y| mean + y).collect();
    let slope = list(&|k, a, b, x| -k * a * (k * x + b).sin());
    let bend = list(&|k, a, b, x| -k * k * a * (k * x + b).cos());
    Periodic::new(period, &value, &slope, &bend).expect("even knots")
}

/// Straight lines through points; the ends are held.
fn lines(x: &[f64], y: &[f64]) -> Curve {
    let n = x.len();
    let slope = |i: usize| if x[i + 1] > x[i] { (y[i + 1] - y[i]) / (x[i + 1] - x[i]) } else { 0.0 };
    let mut before = vec![0.0; n];
    let mut after = vec![0.0; n];
    for i in 0..n - 1 {
        (after[i], before[i + 1]) = (slope(i), slope(i));
    }
    Curve::new(x, y, &before, &after).expect("ordered points")
}

fn torque(mass: usize, scale: f64, law: Law) -> Torque {
    Torque { mass, ratio: 1.0, scale, law, weight: None, shape: None }
}

fn even_times(duration: f64, n: usize) -> Vec<f64> {
    (0..n).map(|i| duration * i as f64 / (n - 1) as f64).collect()
}

fn run(system: &System, state: [&[f64]; 2], times: &[f64], accuracy: f64, method: Method) -> Course {
    let duration = *times.last().expect("times");
    let request = Request {
        angle: state[0],
        speed: state[1],
        times,
        start: 0.0,
        duration,
        accuracy,
        method,
        steps_max: 1_000_000,
    };
    let course = follow(system, &request);
    assert_eq!(course.end, End::Time, "{method:?} at {accuracy:e} reached {} s", course.time);
    course
}

fn row(course: &Course, times: &[f64], row: usize) -> Vec<f64> {
    course.samples[row * times.len()..(row + 1) * times.len()].to_vec()
}

fn worst(found: &[f64], wanted: impl Iterator<Item = f64>) -> f64 {
    found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// E(T + V) at the end less that at the start, less all work, over the largest of these.
fn imbalance(system: &System, course: &Course) -> f64 {
    let m = system.torques.len();
    let given: f64 = course.work[..m].iter().sum();
    let lost: f64 = course.work[m..].iter().sum();
    let [t0, v0, t1, v1] = course.energies;
    let size = course.work.iter().chain(&course.energies).fold(0.0_f64, |most, x| most.max(x.abs()));
    ((t1 + v1) - (t0 + v0) - (given - lost)) / size
}

/// Two discs under a constant torque on one of them: twist M J₂/(k(J₁ + J₂)) (1 − cos ωt), so that the shaft's torque
/// comes to twice its static value, at half the period; both methods, sampled between their steps.
#[test]
fn step_of_load_doubles_the_static_torque() {
    let (j1, j2, k, m) = (2.0, 3.0, 5e4, 700.0);
    let mut system = chain(&[j1, j2], &[k]);
    system.torques.push(torque(0, m, Law::Constant));
    let omega = (k * (j1 + j2) / (j1 * j2)).sqrt();
    let still = m * j2 / (j1 + j2);
    let times = even_times(0.1, 1001);
    // Steps of order 8 and 5 err over five swings by some dozen times their accuracy; between the implicit ones a cubic
    // of half their order is read.
    for (method, accuracy, ends, inside) in
        [(Method::Explicit, 1e-10, 1e-9, 1e-8), (Method::Implicit, 1e-9, 1e-7, 1e-5)]
    {
        let course = run(&system, [&[0.0; 2], &[0.0; 2]], &times, accuracy, method);
        let found = row(&course, &times, 4);
        let off = worst(&found, times.iter().map(|t| still * (1.0 - (omega * t).cos())));
        assert!(off < inside * still, "{method:?}: {off:e} N m");
        let speed = row(&course, &times, 2);
        let mean = |t: f64| m * t / (j1 + j2) + still / (j1 * omega) * (omega * t).sin();
        assert!(worst(&speed, times.iter().map(|&t| mean(t))) < inside * 10.0, "{method:?}: speed");
        let [most, at, least, _] = course.extremes[0];
        assert!((most - 2.0 * still).abs() < 10.0 * inside * still, "{method:?}: largest {most}");
        // One of the five peaks.
        let phase = (omega * at / TAU).rem_euclid(1.0);
        assert!((phase - 0.5).abs() < 0.01, "{method:?}: phase {phase}");
        assert!(least.abs() < 10.0 * inside * still, "{method:?}: minimum {least}");
        assert!(imbalance(&system, &course).abs() < ends, "{method:?}: energy");
    }
}

/// ½ J(θ) θ̇² stays in free spin, whatever the inertia does, and the speed follows the angle by it.
#[test]
fn free_spin_keeps_its_energy() {
    let table = waves(TAU, 1.5, &[(1.0, 0.3, 0.4), (2.0, 0.6, -1.0), (4.0, 0.05, 0.0)]);
    let mut system = chain(&[0.5], &[]);
    system.rotors.push(Rotor { mass: 0, ratio: 2.0, phase: 0.7, table: 0 });
    system.tables.push(table.clone());
    let inertia = |theta: f64| 0.5 + 4.0 * table.value_and_slope(2.0 * theta + 0.7)[0];
    let times = even_times(1.0, 301);
    let energy = 0.5 * inertia(0.2) * 80.0 * 80.0;
    for method in BOTH {
        for decade in [6, 8, 10] {
            let accuracy = 10_f64.powi(-decade);
            let course = run(&system, [&[0.2], &[80.0]], &times, accuracy, method);
            let (angle, speed) = (row(&course, &times, 0), row(&course, &times, 1));
            let wanted = angle.iter().map(|&x| (2.0 * energy / inertia(x)).sqrt());
            let off = worst(&speed, wanted) / 80.0;
            // 25 revolutions of the table with some twenty steps each.
            let allowed =
                if method == Method::Explicit { 30.0 * accuracy } else { 300.0 * accuracy.powf(0.8) };
            assert!(off < allowed, "{method:?}, asked for {accuracy:e}: {off:e}");
            let [kinetic, ..] = course.energies;
            assert!((kinetic / energy - 1.0).abs() < 1e-15, "energy at the start");
            let lost = (course.energies[2] / energy - 1.0).abs();
            assert!(lost < allowed, "{method:?}, asked for {accuracy:e}: energy off by {lost:e}");
        }
    }
}

/// Complete elliptic integral K(m) by the arithmetic-geometric mean (Abramowitz and Stegun 17.6).
fn elliptic(m: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    for _ in 0..30 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    PI / (2.0 * a)
}

/// Duffing's swing J ẍ + αx + βx³ = 0 has the period 4K(m)/√((α + βA²)/J), m = βA²/(2(α + βA²)).
#[test]
fn stiffening_coupling_swings_as_duffing() {
    let (j, alpha, beta) = (0.4, 3000.0, 8e5);
    // One cubic piece each side holds βx³ exactly: its slope is zero in the middle and 3βx² at the end.
    let x = [-0.2, 0.0, 0.2];
    let slope = x.map(|x: f64| 3.0 * beta * x * x);
    let curve = Curve::new(&x, &x.map(|x: f64| beta * x.powi(3)), &slope, &slope).expect("ordered points");
    let mut system = chain(&[j], &[]);
    system.links.push(Link {
        ends: [1, 0],
        ratio: 1.0,
        stiffness: alpha,
        damping: 0.0,
        curve: Some(0),
        manner: Manner::default(),
    });
    system.curves.push(curve);
    let mut period_before = f64::INFINITY;
    for amplitude in [0.01, 0.05, 0.15] {
        let square = beta * amplitude * amplitude;
        let m = square / (2.0 * (alpha + square));
        let period = 4.0 * elliptic(m) / ((alpha + square) / j).sqrt();
        let times = even_times(5.25 * period, 22);
        let course = run(&system, [&[amplitude], &[0.0]], &times, 1e-11, Method::Explicit);
        let angle = row(&course, &times, 0);
        // Every quarter of a period: amplitude, zero, the other side, zero.
        let wanted = [amplitude, 0.0, -amplitude, 0.0];
        let off = worst(&angle, (0..22).map(|i| wanted[i % 4])) / amplitude;
        assert!(off < 1e-8, "A = {amplitude}: off by {off:e}");
        assert!(period < period_before, "stiffer when it swings further");
        period_before = period;
        // The torque of the link from the ground to the mass is −(αA + βA³) at the start.
        let peak = alpha * amplitude + beta * amplitude.powi(3);
        assert!((course.extremes[0][2] / -peak - 1.0).abs() < 1e-9, "torque {:?}", course.extremes[0]);
    }
}

/// Backlash: through the gap the two discs coast, and they leave it as fast as they came in.
#[test]
fn backlash_is_crossed_coasting() {
    let (j, k, half) = (1.5, 2e4, 0.01);
    let mut system = chain(&[j, j], &[0.0]);
    let curve = Curve::new(&[-half, half], &[0.0; 2], &[k, 0.0], &[0.0, k]).expect("ordered points");
    system.curves.push(curve);
    system.links[0].curve = Some(0);
    // Relative speed v; the period is two gaps at v and two half swings of ω = √(2k/J).
    let (v, omega) = (3.0, (2.0 * k / j).sqrt());
    let period = 2.0 * (2.0 * half / v) + 2.0 * PI / omega;
    let times = even_times(10.0 * period, 11);
    let course = run(&system, [&[0.0; 2], &[0.5 * v, -0.5 * v]], &times, 1e-10, Method::Explicit);
    let relative: Vec<f64> =
        row(&course, &times, 2).iter().zip(row(&course, &times, 3)).map(|(a, b)| a - b).collect();
    // At a kink a step errs more than its estimate says: forty kinks are passed.
    assert!(worst(&relative, std::iter::repeat(v)) < 1e-6 * v, "{relative:?}");
    assert!((course.extremes[0][0] / (k * v / omega) - 1.0).abs() < 1e-6, "maximum torque");
}

/// A torque switched on and off within the motion: the closed form of each stretch, with steps that end on the switches.
#[test]
fn switches_are_met() {
    let (j, m, on, off) = (0.8, 120.0, 0.0123, 0.0617);
    let mut system = chain(&[j], &[]);
    let mut pulse = torque(0, m, Law::Constant);
    pulse.weight = Some(0);
    system.torques.push(pulse);
    system.curves.push(lines(&[on, on, off, off], &[0.0, 1.0, 1.0, 0.0]));
    let times = even_times(0.1, 41);
    let speed = |t: f64| m / j * (t.clamp(on, off) - on);
    for method in BOTH {
        let course = run(&system, [&[0.0], &[0.0]], &times, 1e-6, method);
        let found = row(&course, &times, 1);
        // A constant acceleration is exact for any step; what is left is rounding.
        assert!(worst(&found, times.iter().map(|&t| speed(t))) < 1e-12 * speed(1.0), "{method:?}");
        assert!((course.work[0] - 0.5 * j * speed(1.0).powi(2)).abs() < 1e-10, "{method:?}: work");
    }
}

/// What swings in before zero is not recorded: the same motion, begun earlier, with a pulse in the time before.
#[test]
fn lead_in_is_not_recorded() {
    let mut system = chain(&[0.4, 0.9], &[3e4]);
    system.links[0].damping = 60.0;
    system.torques.push(torque(0, 50.0, Law::Constant));
    system.torques.push(torque(1, -50.0, Law::Constant));
    let mut pulse = torque(0, 4000.0, Law::Constant);
    pulse.weight = Some(0);
    system.torques.push(pulse);
    system.curves.push(lines(&[-0.95, -0.95, -0.9, -0.9], &[0.0, 1.0, 1.0, 0.0]));
    let times = even_times(0.1, 11);
    let request = Request {
        angle: &[0.0; 2],
        speed: &[20.0; 2],
        times: &times,
        start: -1.0,
        duration: 0.1,
        accuracy: 1e-9,
        method: Method::Explicit,
        steps_max: 100_000,
    };
    let course = follow(&system, &request);
    assert_eq!((course.end, course.time), (End::Time, 0.1));
    // Swung out: 50 N m go through the shaft, and nothing but they work.
    let [most, _, least, _] = course.extremes[0];
    assert!((most - 50.0).abs() < 1e-6 && (least - 50.0).abs() < 1e-6, "torque from {least} to {most}");
    let speed = 20.0 + 4000.0 * 0.05 / 1.3;
    assert!((course.extremes[1][0] - speed).abs() < 1e-8, "speed {}", course.extremes[1][0]);
    assert!((course.work[0] - 50.0 * speed * 0.1).abs() < 1e-6, "work {:?}", course.work);
    assert_eq!(course.work[2], 0.0, "the pulse is over");
    assert!(imbalance(&system, &course).abs() < 1e-10, "energy");
}

/// A train with everything, changing speed under load.
fn everything() -> System {
    let mut system = chain(&[0.3, 0.1, 0.2, 4.0, 0.02], &[2e5, 3e5, 0.0]);
    system.damping[0] = 0.05;
    system.swing_damping[2] = 0.8;
    system.links[1].damping = 15.0;
    system.links[2].curve = Some(2);
    // A ring on the second mass, behind a gear, and a shaft that closes a loop.
    system.links.push(Link {
        ends: [1, 4],
        ratio: 1.6,
        stiffness: 4e3,
        damping: 2.0,
        curve: None,
        manner: Manner::default(),
    });
    system.links.push(Link {
        ends: [2, 0],
        ratio: 0.5,
        stiffness: 1e4,
        damping: 1.0,
        curve: None,
        manner: Manner::default(),
    });
    system.tables.push(waves(TAU, 0.2, &[(1.0, 0.02, 0.3), (2.0, 0.07, 1.0)]));
    system.tables.push(waves(2.0 * TAU, 40.0, &[(0.5, 150.0, 0.0), (1.5, 80.0, 1.0), (3.0, 30.0, 2.0)]));
    for mass in [0, 2] {
        let phase = mass as f64;
        system.rotors.push(Rotor { mass, ratio: 1.0 + 0.5 * phase, phase, table: 0 });
        let mut gas = torque(mass, 1.0, Law::Constant);
        gas.shape = Some(Shape { table: 1, pitch: 1.0, phase: 2.0 * phase });
        gas.weight = Some(0);
        system.torques.push(gas);
    }
    system.curves.push(lines(&[0.0, 0.1, 0.1, 0.3], &[1.0, 1.0, 0.6, 1.3]));
    system.curves.push(lines(&[0.0, 90.0, 150.0, 160.0], &[80.0, 110.0, 60.0, -60.0]));
    let (x, y) = ([-0.1, 0.0, 0.1], [-5000.0, 0.0, 5000.0]);
    let slope = [120_000.0, 2e4, 120_000.0];
    system.curves.push(Curve::new(&x, &y, &slope, &slope).expect("ordered points"));
    system.curves.push(lines(&[0.0, 0.4], &[100.0, 140.0]));
    system.torques.push(torque(3, -90.0, Law::Odd { inverse_speed: 0.01, exponent: 2.0 }));
    system.torques.push(torque(3, 1.0, Law::OverSpeed { curve: 1 }));
    system.torques.push(torque(1, 1.0, Law::Following { gain: 0.6, curve: 3 }));
    let law = Law::Decaying { from: 0.15, until: 0.35, rate: 8.0, omega: 314.0, phase: 0.0 };
    system.torques.push(Torque { ratio: 1.2, ..torque(3, 900.0, law) });
    let shaken = Law::Even { inverse_speed: 0.01, exponent: 2.0 };
    let shape = Some(Shape { table: 0, pitch: 3.0, phase: 0.1 });
    system.torques.push(Torque { shape, ..torque(4, 25.0, shaken) });
    system
}

const START: [&[f64]; 2] = [&[0.1, 0.1, 0.1, 0.1, 0.1], &[100.0; 5]];

/// What the energy gains is the work of all torques less all losses; at the kinks of its curves a step errs by more than
/// its estimate says.
#[test]
fn energy_is_balanced() {
    let system = everything();
    let times = even_times(0.5, 51);
    for (method, accuracy, allowed) in [(Method::Explicit, 1e-9, 1e-7), (Method::Implicit, 1e-8, 1e-6)] {
        let course = run(&system, START, &times, accuracy, method);
        let off = imbalance(&system, &course);
        assert!(off.abs() < allowed, "{method:?}: {off:e}");
        let losses = &course.work[system.torques.len()..];
        assert!(losses.iter().all(|&loss| loss >= 0.0), "{method:?}: losses {losses:?}");
    }
}

/// Both methods follow the same motion, over kinks and all; so does the first whatever is sampled.
#[test]
fn methods_agree() {
    let system = everything();
    let times = even_times(0.5, 101);
    let exact = run(&system, START, &times, 1e-12, Method::Explicit);
    for (method, accuracy, allowed) in [(Method::Explicit, 1e-8, 1e-4), (Method::Implicit, 1e-8, 1e-4)] {
        let course = run(&system, START, &times, accuracy, method);
        for link in 0..system.links.len() {
            let (found, wanted) = (row(&course, &times, 10 + link), row(&exact, &times, 10 + link));
            let size = wanted.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let off = worst(&found, wanted.into_iter()) / size;
            assert!(off < allowed, "{method:?}, link {link}: {off:e} of the largest torque");
            let [most, at, ..] = course.extremes[link];
            let [wanted, wanted_at, ..] = exact.extremes[link];
            // The value at a peak is known better than its time.
            assert!((most / wanted - 1.0).abs() < allowed, "{method:?}, link {link}: peak {most}");
            assert!((at - wanted_at).abs() < 1e-4, "{method:?}, link {link}: at {at}");
        }
    }
    let few = run(&system, START, &[0.0, 0.5], 1e-8, Method::Explicit);
    let many = run(&system, START, &times, 1e-8, Method::Explicit);
    assert_eq!((few.steps, &few.extremes), (many.steps, &many.extremes), "sampling changes nothing");
}

/// Damping against the train as a whole does not brake its turning, and damps a swing as damping against the ground does
/// in a frame that turns along: two equal discs, each with d, have the damping ratio d/(2Jω).
#[test]
fn swings_are_damped_and_turning_is_not() {
    let (j, k, d) = (0.5, 2e4, 3.0);
    let mut system = chain(&[j, j], &[k]);
    system.swing_damping = vec![d, d];
    let omega = (2.0 * k / j).sqrt();
    let zeta = d / (2.0 * j * omega);
    let times = even_times(0.2, 401);
    let course = run(&system, [&[0.01, -0.01], &[90.0; 2]], &times, 1e-10, Method::Explicit);
    let (root, decay) = ((1.0 - zeta * zeta).sqrt(), zeta * omega);
    let swing = |t: f64| {
        let phase = omega * root * t;
        0.02 * k * (-decay * t).exp() * (phase.cos() + zeta / root * phase.sin())
    };
    let torque = row(&course, &times, 4);
    assert!(worst(&torque, times.iter().map(|&t| swing(t))) < 1e-7 * swing(0.0), "swing");
    let mean: Vec<f64> =
        row(&course, &times, 2).iter().zip(row(&course, &times, 3)).map(|(a, b)| a + b).collect();
    // Rounding of 180 rad/s over some hundred steps.
    assert!(worst(&mean, std::iter::repeat(180.0)) < 1e-11, "speed of the whole");
}

/// Angular momentum of a train with constant inertias is the impulse of the torques from outside: 200 N m for 0.3 s.
#[test]
fn momentum_is_the_impulse() {
    let inertia = [0.5, 0.1, 0.9];
    let mut system = chain(&inertia, &[4e4, 7e4]);
    system.links[0].damping = 20.0;
    system.torques.push(torque(1, 200.0, Law::Constant));
    let times = even_times(0.3, 4);
    for method in BOTH {
        let course = run(&system, [&[0.0; 3], &[-30.0; 3]], &times, 1e-9, method);
        let momentum: f64 = (0..3).map(|i| inertia[i] * row(&course, &times, 3 + i)[3]).sum();
        let wanted = -30.0 * 1.5 + 200.0 * 0.3;
        // Linear sums of the state: every step keeps them but for rounding.
        assert!((momentum - wanted).abs() < 1e-9, "{method:?}: {momentum}");
    }
}

/// The derivatives that Newton uses against differences of the accelerations.
#[test]
fn derivatives_of_the_accelerations() {
    let angle = [0.3, 0.31, 0.29, 0.28, 0.33];
    let speed = [101.0, 99.0, 103.0, 100.5, 97.0];
    require_derivatives(&everything(), 0.2, [&angle, &speed], 1e-6);
}

/// Twists keep their digits after a million revolutions: the state counts the masses from the first.
#[test]
fn twists_keep_their_digits() {
    let mut system = chain(&[1.0, 1.0], &[1e9]);
    system.torques.push(torque(0, 100.0, Law::Constant));
    system.links[0].damping = 5e3;
    let times = even_times(0.05, 2);
    let turned = 1e6 * TAU;
    let course = run(&system, [&[turned; 2], &[0.0; 2]], &times, 1e-9, Method::Explicit);
    // Damped out: half of the torque goes through the shaft. In angles of 6e6 rad the last digit is 1 N m.
    let off = row(&course, &times, 4)[1] - 50.0;
    assert!(off.abs() < 1e-6, "{off:e} N m");
}

/// Net torques are inertia times acceleration: 40 N m from outside, 2·10³ N m/rad · 0.01 rad through the shaft.
#[test]
fn net_torques_are_told() {
    let mut system = chain(&[2.0, 3.0], &[2e3]);
    system.torques.push(torque(1, 40.0, Law::Constant));
    let mut rates = Rates::new(&system);
    rates.enter(0.0);
    let (mut net, mut inertia) = ([0.0; 2], [0.0; 2]);
    rates.net_torques(0.0, &[0.51, 0.5], &[7.0; 2], &mut net, &mut inertia);
    assert_eq!(inertia, [2.0, 3.0]);
    // The difference of angles near 0.5 is rounded to 1e-16.
    assert!((net[0] + 20.0).abs() < 1e-12 && (net[1] - 60.0).abs() < 1e-12, "{net:?}");
}

/// Shafts as good as rigid: the explicit method takes many steps, the implicit one only what the slow motion needs.
#[test]
fn stiff_shafts_need_few_implicit_steps() {
    let mut system = chain(&[0.5, 0.01, 0.8], &[4e4, 1e12]);
    system.torques.push(torque(
        0,
        300.0,
        Law::Decaying { from: 0.0, until: 9.0, rate: 2.0, omega: 60.0, phase: 0.0 },
    ));
    let times = even_times(0.5, 26);
    let implicit = run(&system, [&[0.0; 3], &[10.0; 3]], &times, 1e-8, Method::Auto);
    assert_eq!(implicit.method, Method::Implicit, "chosen by itself");
    assert!(implicit.steps < 4000, "{} steps", implicit.steps);
    // The same as one mass of both.
    let mut rigid = chain(&[0.5, 0.81], &[4e4]);
    rigid.torques.clone_from(&system.torques);
    let exact = run(&rigid, [&[0.0; 2], &[10.0; 2]], &times, 1e-10, Method::Explicit);
    let (found, wanted) = (row(&implicit, &times, 6), row(&exact, &times, 4));
    // Samples between implicit steps are read from a cubic.
    let size = exact.extremes[0][0];
    assert!(worst(&found, wanted.into_iter()) < 1e-4 * size, "torque of the soft shaft");
    let request = Request {
        angle: &[0.0; 3],
        speed: &[10.0; 3],
        times: &times,
        start: 0.0,
        duration: 0.5,
        accuracy: 1e-8,
        method: Method::Explicit,
        steps_max: 10_000,
    };
    let explicit = follow(&system, &request);
    assert_eq!(explicit.end, End::TooManySteps);
    assert_eq!(explicit.steps, 10_000);
    assert!(explicit.time > 0.0 && explicit.time < 0.05, "reached {} s", explicit.time);
}

/// The accuracy of a step asked for is nearly that of the motion, for every decade.
#[test]
fn accuracy_is_kept() {
    let mut system = chain(&[1.0, 0.7], &[3e4]);
    system.rotors.push(Rotor { mass: 1, ratio: 1.0, phase: 0.0, table: 0 });
    system.tables.push(waves(TAU, 0.3, &[(2.0, 0.1, 0.0)]));
    let times = even_times(0.4, 41);
    let state: [&[f64]; 2] = [&[0.02, 0.0], &[120.0, 118.0]];
    let exact = run(&system, state, &times, 1e-13, Method::Explicit);
    let size = exact.extremes[0][0];
    for method in BOTH {
        for decade in 5..=11 {
            let accuracy = 10_f64.powi(-decade);
            let course = run(&system, state, &times, accuracy, method);
            let off = worst(&row(&course, &times, 4), row(&exact, &times, 4).into_iter()) / size;
            // Errors of some hundred steps over fifteen swings add up.
            assert!(off < 100.0 * accuracy, "{method:?}, asked for {accuracy:e}: {off:e}");
        }
    }
}

/// Work of a known motion, pinned so that more of it is noticed.
#[test]
fn work_is_as_before() {
    let system = everything();
    let times = even_times(0.5, 51);
    let count = |method, accuracy| {
        let course = run(&system, START, &times, accuracy, method);
        [course.steps, course.rejected, course.evaluations]
    };
    assert_eq!(count(Method::Explicit, 1e-8), [1622, 512, 35937], "explicit");
    assert_eq!(count(Method::Implicit, 1e-8), [10294, 510, 117320], "implicit");
}

/// Systems that make no sense are refused.
#[test]
fn bad_systems_are_refused() {
    let good = everything();
    assert_eq!(good.check(), Ok(()), "a good one");
    let n = good.len();
    let refused = |spoil: &dyn Fn(&mut System)| {
        let mut system = good.clone();
        spoil(&mut system);
        system.check().expect_err("a bad one")
    };
    let missing = |what, value, made| PlanError::Missing { what, value, made };
    // The ground is the mass beyond the last, for links alone.
    assert_eq!(refused(&|system| system.links[0].ends[1] = n + 1), missing("mass", n + 1, n + 1));
    assert_eq!(refused(&|system| system.torques[0].mass = n), missing("mass", n, n));
    let tables = good.tables.len();
    assert_eq!(refused(&|system| system.rotors[0].table = tables), missing("table", tables, tables));
    let curves = good.curves.len();
    let law = Law::OverSpeed { curve: curves };
    assert_eq!(refused(&|system| system.torques[0].law = law), missing("curve", curves, curves));
    assert_eq!(refused(&|system| system.torques[0].weight = Some(9)), missing("curve", 9, curves));
    let shape = Some(Shape { table: 7, pitch: 1.0, phase: 0.0 });
    assert_eq!(refused(&|system| system.torques[0].shape = shape), missing("table", 7, tables));
    let short = PlanError::Length { what: "list of damping", found: n - 1, expected: n };
    assert_eq!(refused(&|system| system.damping.truncate(n - 1)), short);
    let none = refused(&|system| system.inertia.clear());
    assert!(matches!(none, PlanError::Length { found: 0, .. }), "no mass");
}
