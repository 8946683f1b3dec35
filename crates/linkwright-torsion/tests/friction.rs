//! Clutches, brakes, freewheels and stick–slip in time: closed forms and the balance of energy.

use linkwright_torsion::transient::course::{Course, End, Method, Request, follow};
use linkwright_torsion::transient::curve::Curve;
use linkwright_torsion::transient::friction::{Friction, Grip};
use linkwright_torsion::transient::system::{Link, Manner, System};
use linkwright_torsion::transient::torque::{Law, Torque};
use std::f64::consts::PI;

const BOTH: [Method; 2] = [Method::Explicit, Method::Implicit];

fn masses(inertia: &[f64]) -> System {
    System {
        inertia: inertia.to_vec(),
        damping: vec![0.0; inertia.len()],
        swing_damping: vec![0.0; inertia.len()],
        ..System::default()
    }
}

fn grip(held: f64, sliding: f64) -> Grip {
    Grip { held, sliding, rise: 0.0, inverse_speed: 0.0, curve: None }
}

fn clutch(ends: [usize; 2], held: f64, sliding: f64) -> Friction {
    let grip = Some(grip(held, sliding));
    Friction { ends, ratio: 1.0, forward: grip, backward: grip, engagement: None }
}

fn freewheel(ends: [usize; 2]) -> Friction {
    Friction { forward: None, ..clutch(ends, 0.0, 0.0) }
}

fn torque(mass: usize, scale: f64) -> Torque {
    Torque { mass, ratio: 1.0, scale, law: Law::Constant, weight: None, shape: None }
}

fn run(system: &System, state: [&[f64]; 2], duration: f64, accuracy: f64, method: Method) -> Course {
    let times: Vec<f64> = (0..=200).map(|i| duration * f64::from(i) / 200.0).collect();
    let request = Request {
        angle: state[0],
        speed: state[1],
        times: &times,
        start: 0.0,
        duration,
        accuracy,
        method,
        steps_max: 1_000_000,
    };
    system.check().expect("a sound system");
    let course = follow(system, &request);
    assert_eq!(course.end, End::Time, "{method:?} reached {} s", course.time);
    let (given, lost) = course.work.split_at(system.torques.len());
    let [t0, v0, t1, v1] = course.energies;
    let size = course.work.iter().chain(&course.energies).fold(0.0_f64, |most, x| most.max(x.abs()));
    let left = t1 + v1 - t0 - v0 - given.iter().sum::<f64>() + lost.iter().sum::<f64>();
    assert!(left.abs() <= 1e-9 * size, "{method:?}: energy is off by {:e}", left / size);
    course
}

fn row(course: &Course, row: usize) -> &[f64] {
    &course.samples[row * 201..(row + 1) * 201]
}

/// Two discs that a clutch of constant torque brings together: time Δω/(T(1/J₁ + 1/J₂)), heat ½ J₁J₂/(J₁ + J₂) Δω², common
/// speed by momentum.
#[test]
fn clutch_brings_two_discs_together() {
    let (j1, j2, t, w) = (2.0, 3.0, 40.0, 50.0);
    let mut system = masses(&[j1, j2]);
    system.frictions.push(clutch([0, 1], 60.0, t));
    for method in BOTH {
        let course = run(&system, [&[0.0; 2], &[w, 0.0]], 3.0, 1e-11, method);
        let together = w / (t * (1.0 / j1 + 1.0 / j2));
        let tally = course.tallies[0];
        assert!((tally.slipping - together).abs() < 1e-10, "{method:?}: slips for {} s", tally.slipping);
        assert!((tally.stuck - (3.0 - together)).abs() < 1e-10);
        assert_eq!(tally.engagements, 1);
        let heat = 0.5 * j1 * j2 / (j1 + j2) * w * w;
        assert!((course.work[2] / heat - 1.0).abs() < 1e-10, "{method:?}: heat {}", course.work[2]);
        for mass in [0, 1] {
            let speed = row(&course, 2 + mass)[200];
            assert!((speed - w * j1 / (j1 + j2)).abs() < 1e-10, "{method:?}: {speed} rad/s");
        }
        let [torque, power] = [course.extremes[2][0], course.extremes[3][0]];
        assert!((torque - t).abs() < 1e-10 && (power - t * w).abs() < 1e-7, "{torque} N m, {power} W");
    }
}

/// A brake stops a driven disc, and holds it as long as the drive is below its capacity.
#[test]
fn brake_stops_a_disc_and_holds_it() {
    let mut system = masses(&[4.0]);
    system.torques.push(torque(0, 30.0));
    system.frictions.push(clutch([0, 1], 110.0, 90.0));
    for method in BOTH {
        let course = run(&system, [&[0.0], &[120.0]], 12.0, 1e-11, method);
        // J ω/(T − M), and the angle ½ ω t.
        let stops = 4.0 * 120.0 / 60.0;
        assert!((course.tallies[0].slipping - stops).abs() < 1e-9, "{:?}", course.tallies);
        let (angle, speed) = (row(&course, 0)[200], row(&course, 1)[200]);
        assert!((angle - 60.0 * stops).abs() < 1e-7 && speed == 0.0, "{angle} rad, {speed} rad/s");
        assert!((row(&course, 4)[200] - 30.0).abs() < 1e-12, "it carries the drive");
    }
}

/// Stick–slip of a mass on a spring whose end moves at v, Coulomb friction with static R above sliding S: it sticks until
/// the spring carries R, then swings by x(t) = vt + (R − S)/k (1 − cos ωt) − v/ω sin ωt, and slips for
/// (2π − 2 arctan((R − S) ω/(k v)))/ω.
#[test]
fn stick_slip_on_a_spring() {
    let (j, k, v, held, sliding) = (0.5, 200.0, 0.4, 30.0, 18.0);
    let omega = f64::sqrt(k / j);
    let rise = (held - sliding) * omega / (k * v);
    let slips = (2.0 * PI - 2.0 * f64::atan(rise)) / omega;
    let sticks = 2.0 * (held - sliding) / (k * v);
    // The end of the spring is a disc so heavy that nothing slows it.
    let mut system = masses(&[1e12, j]);
    system.links.push(Link {
        ends: [0, 1],
        ratio: 1.0,
        stiffness: k,
        damping: 0.0,
        curve: None,
        manner: Manner::default(),
    });
    system.frictions.push(clutch([1, 2], held, sliding));
    let first = held / (k * v);
    let cycles = 7.0;
    let duration = first + cycles * (slips + sticks);
    let times: Vec<f64> = vec![0.0, first + 0.5 * slips, duration - 1e-9];
    for (method, off) in [(Method::Explicit, 1e-8), (Method::Implicit, 1e-5)] {
        let request = Request {
            angle: &[0.0; 2],
            speed: &[v, 0.0],
            times: &times,
            start: 0.0,
            duration,
            accuracy: 1e-11,
            method,
            steps_max: 1_000_000,
        };
        let course = follow(&system, &request);
        assert_eq!(course.end, End::Time, "{method:?}");
        let tally = course.tallies[0];
        assert!((tally.slipping - cycles * slips).abs() < off, "{method:?}: {tally:?} against {slips}");
        assert!((tally.stuck - first - cycles * sticks).abs() < off, "{method:?}: {tally:?}");
        // It is fastest half-way: v + √(v² + ((R − S)/(kω)… )²).
        let fastest = v + (v * v + ((held - sliding) * omega / k).powi(2)).sqrt();
        let [most, ..] = course.extremes[2];
        assert!((most / fastest - 1.0).abs() < off, "{method:?}: fastest {most}, {fastest}");
        assert!((course.extremes[3][0] - held).abs() < off * held, "{method:?}: {:?}", course.extremes[3]);
    }
}

/// A freewheel lets the driven disc overrun, and holds once the driver has caught up; then both are one.
#[test]
fn freewheel_is_overrun_and_holds() {
    let (j1, j2, drive) = (1.0, 3.0, 8.0);
    let mut system = masses(&[j1, j2]);
    system.torques.push(torque(0, drive));
    system.frictions.push(freewheel([0, 1]));
    for method in BOTH {
        let course = run(&system, [&[0.0; 2], &[0.0, 20.0]], 5.0, 1e-11, method);
        let catches = 20.0 * j1 / drive;
        assert!((course.tallies[0].slipping - catches).abs() < 1e-10, "{method:?}: {:?}", course.tallies);
        let speed = 20.0 + drive / (j1 + j2) * (5.0 - catches);
        assert!((row(&course, 3)[200] - speed).abs() < 1e-9, "{method:?}");
        let carried = drive * j2 / (j1 + j2);
        assert!((course.extremes[2][0] - carried).abs() < 1e-9, "{method:?}: {:?}", course.extremes[2]);
    }
}

/// Parallel clutches share by their capacities, and hold together what either could not.
#[test]
fn parallel_clutches_share() {
    let mut system = masses(&[1.0, 1.0]);
    system.torques.push(torque(0, 100.0));
    system.frictions.push(clutch([0, 1], 20.0, 20.0));
    system.frictions.push(clutch([0, 1], 40.0, 40.0));
    let course = run(&system, [&[0.0; 2], &[0.0; 2]], 1.0, 1e-10, Method::Explicit);
    assert!((row(&course, 6)[100] - 50.0 / 3.0).abs() < 1e-9, "{}", row(&course, 6)[100]);
    assert!((row(&course, 7)[100] - 100.0 / 3.0).abs() < 1e-9);
    assert_eq!(course.tallies[0].slipping, 0.0);
    // With 130 N m they slide: 65 N m would be needed.
    system.torques[0].scale = 130.0;
    let course = run(&system, [&[0.0; 2], &[0.0; 2]], 1.0, 1e-10, Method::Explicit);
    assert_eq!((course.tallies[0].stuck, course.tallies[1].stuck), (0.0, 0.0));
    assert!((row(&course, 2)[200] - 70.0).abs() < 1e-9);
    // A brake on either side of a clutch: three hold two discs, and what the first brake cannot take goes on.
    let mut system = masses(&[1.0, 1.0]);
    system.torques.push(torque(0, 25.0));
    system.frictions.extend([
        clutch([0, 2], 10.0, 10.0),
        clutch([0, 1], 50.0, 50.0),
        clutch([1, 2], 20.0, 20.0),
    ]);
    let course = run(&system, [&[0.0; 2], &[0.0; 2]], 1.0, 1e-10, Method::Explicit);
    assert_eq!(row(&course, 2)[200], 0.0, "held");
    let carried: Vec<f64> = (6..9).map(|r| row(&course, r)[100]).collect();
    assert!((carried[0] + carried[1] - 25.0).abs() < 1e-9 && (carried[1] - carried[2]).abs() < 1e-9);
    assert!(carried[0] <= 10.0 + 1e-9 && carried[2] <= 20.0 + 1e-9, "{carried:?}");
}

/// Engagement over time, knots of the sliding torque and coupled clutches keep the balance of energy on random trains.
#[test]
fn energy_is_balanced_on_random_trains() {
    let mut seed = 7_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    for case in 0..40 {
        let n = 3 + (4.0 * random()) as usize;
        let inertia: Vec<f64> = (0..n).map(|_| 0.05 + random()).collect();
        let mut system = masses(&inertia);
        for i in 0..n - 1 {
            if random() < 0.5 {
                let (stiffness, damping) = (1e3 * (0.1 + random()), 0.5 * random());
                let manner = Manner::default();
                system.links.push(Link {
                    ends: [i, i + 1],
                    ratio: 1.0,
                    stiffness,
                    damping,
                    curve: None,
                    manner,
                });
                continue;
            }
            let (held, slides) = (40.0 * (0.2 + random()), 0.6 + 0.4 * random());
            let mut one = clutch([i, i + 1], held, held * slides);
            match (4.0 * random()) as usize {
                0 => one.forward = None,
                1 => {
                    let x = [0.0, 2.0 + 5.0 * random(), 20.0];
                    let y = [held * slides, held * slides * 0.5, held * slides * 0.8];
                    let s = [(y[1] - y[0]) / x[1], (y[2] - y[1]) / (x[2] - x[1])];
                    let curve = Curve::new(&x, &y, &[0.0, s[0], s[1]], &[s[0], s[1], 0.0]).expect("points");
                    let grip = Grip { curve: Some(system.curves.len()), ..one.forward.expect("a clutch") };
                    (one.forward, one.backward) = (Some(grip), Some(grip));
                    system.curves.push(curve);
                }
                2 => {
                    let t = 0.5 * random();
                    let x = [0.0, t, t + 0.2];
                    let curve =
                        Curve::new(&x, &[0.0, 0.0, 1.0], &[0.0, 0.0, 5.0], &[0.0, 5.0, 0.0]).expect("points");
                    one.engagement = Some(system.curves.len());
                    system.curves.push(curve);
                }
                _ => {}
            }
            system.frictions.push(one);
        }
        let mut brake = clutch([n - 1, n], 12.0, 8.0);
        (brake.forward, brake.backward) = [1.0, 1.0]
            .map(|_| Some(Grip { held: 12.0, sliding: 6.0, rise: 5.0, inverse_speed: 0.3, curve: None }))
            .into();
        system.frictions.push(brake);
        for mass in [0, n / 2] {
            let omega = 3.0 + 20.0 * random();
            let law = Law::Decaying { from: -1.0, until: 1e9, rate: 0.0, omega, phase: random() };
            system.torques.push(Torque { law, ..torque(mass, 60.0 * random()) });
        }
        // Nothing turns against a freewheel at first: the first discs are slower.
        let speed: Vec<f64> = (0..n).map(|i| 3.0 * i as f64 * random() / n as f64).collect();
        let slowest = |i: usize| speed[..=i].iter().copied().fold(0.0, f64::max);
        let speed: Vec<f64> = (0..n).map(slowest).collect();
        let course = run(&system, [&vec![0.0; n], &speed], 2.0, 1e-11, Method::Explicit);
        let lost = &course.work[system.torques.len()..];
        assert!(lost.iter().all(|&x| x >= -1e-9), "case {case}: losses {lost:?}");
    }
}
