//! Motion in time of stages with losses, meshes on a carrier, joints, pendulums and controllers: energy, momentum, both methods.

mod common;

use common::require_derivatives;
use linkwright_torsion::transient::controllers::Controller;
use linkwright_torsion::transient::course::{Course, End, Method, Request, follow};
use linkwright_torsion::transient::curve::Curve;
use linkwright_torsion::transient::pendulums::Pendulum;
use linkwright_torsion::transient::system::{Carrier, Joint, Link, Loss, Manner, System};
use linkwright_torsion::transient::torque::{Law, Torque};

const LOSS: Option<Loss> = Some(Loss { forward: 1.0 / 0.9, reverse: 0.8 });

fn link(a: usize, b: usize, stiffness: f64, damping: f64) -> Link {
    Link { ends: [a, b], ratio: 1.0, stiffness, damping, curve: None, manner: Manner::default() }
}

fn line(x: &[f64], y: &[f64], slopes: [f64; 2]) -> Curve {
    let inside: Vec<f64> =
        x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0])).collect();
    let before = [&slopes[..1], &inside].concat();
    let after = [&inside, &slopes[1..]].concat();
    Curve::new(x, y, &before, &after).expect("ordered points")
}

/// Motor with a controller – rigid stage with losses – disc with a pendulum – elastic stage with losses and backlash – joint – sun,
/// planet and carrier with a ring on its seat, which rests.
fn everything() -> System {
    let mesh = |a: usize, b: usize, shares: [f64; 3]| Link {
        manner: Manner { carrier: Some(Carrier { mass: 6, shares }), ..Manner::default() },
        ..link(a, b, 4e5, 30.0)
    };
    let (m, r, l) = (0.8, 0.12, 0.04);
    System {
        // Motor, pinion, disc, pendulum; shaft; sun, carrier, planet, ring; integral of the controller.
        inertia: vec![0.4, 0.1, 0.3, m * (r + l) * (r + l), 0.05, 0.08, 0.9, 0.02, 0.6, 1.0],
        damping: vec![0.01, 0.0, 0.0, 0.0, 0.0, 0.02, 0.3, 0.0, 0.0, 0.0],
        swing_damping: vec![0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0, 0.0],
        turns: vec![1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0],
        links: vec![
            Link { manner: Manner { rigid: true, loss: LOSS, ..Manner::default() }, ..link(0, 1, 0.0, 0.0) },
            link(1, 2, 3e4, 4.0),
            Link {
                curve: Some(0),
                manner: Manner { contact: true, loss: LOSS, ..Manner::default() },
                ratio: 1.5,
                ..link(2, 4, 0.0, 6.0)
            },
            Link {
                manner: Manner { joint: Some(Joint { cosine: 0.9, phase: 0.3 }), ..Manner::default() },
                ..link(4, 5, 2e4, 2.0)
            },
            // θ of sun, planet and carrier, at which all turn with one: 1·s − 2·p + 1·c.
            mesh(5, 7, [1.0, -2.0, 1.0]),
            mesh(8, 7, [2.5, -0.8, 0.8]),
            link(8, 10, 7e5, 20.0),
            link(2, 3, 0.0, 0.002),
        ],
        torques: vec![Torque {
            mass: 6,
            ratio: 1.0,
            scale: -40.0,
            law: Law::Odd { inverse_speed: 0.01, exponent: 2.0 },
            weight: Some(1),
            shape: None,
        }],
        pendulums: vec![Pendulum::new([2, 3], 1.0, m, [r, l])],
        controllers: vec![Controller {
            mass: 0,
            integral: 9,
            ratio: 1.0,
            gain: 3.0,
            inverse_time: 8.0,
            offset: 30.0,
            limit: 120.0,
            set_point: 2,
        }],
        curves: vec![
            line(&[-0.01, 0.01], &[0.0, 0.0], [9e4, 9e4]),
            line(&[0.2, 0.21], &[1.0, 3.0], [0.0, 0.0]),
            line(&[0.4, 0.5], &[100.0, 60.0], [0.0, 0.0]),
        ],
        ..System::default()
    }
}

fn run(system: &System, state: [&[f64]; 2], times: &[f64], accuracy: f64, method: Method) -> Course {
    let request = Request {
        angle: state[0],
        speed: state[1],
        times,
        start: 0.0,
        duration: *times.last().expect("times"),
        accuracy,
        method,
        steps_max: 1_000_000,
    };
    let course = follow(system, &request);
    assert_eq!(course.end, End::Time, "{method:?} at {accuracy:e} reached {} s", course.time);
    course
}

fn imbalance(system: &System, course: &Course) -> f64 {
    let m = system.torques.len() + system.controllers.len();
    let [t0, v0, t1, v1] = course.energies;
    let (given, lost): (f64, f64) = (course.work[..m].iter().sum(), course.work[m..].iter().sum());
    let size = course.work.iter().chain(&course.energies).fold(0.0_f64, |most, x| most.max(x.abs()));
    ((t1 + v1) - (t0 + v0) - (given - lost)) / size
}

fn start() -> [Vec<f64>; 2] {
    let mut speed = vec![100.0; 10];
    (speed[8], speed[9]) = (0.0, 0.0);
    (speed[3], speed[1]) = (90.0, 100.0);
    [vec![0.0; 10], speed]
}

#[test]
fn energy_is_balanced() {
    let (system, [angle, speed]) = (everything(), start());
    let times: Vec<f64> = (0..61).map(|i| 0.01 * f64::from(i)).collect();
    for (method, accuracy, allowed) in [(Method::Explicit, 1e-11, 1e-9), (Method::Implicit, 1e-10, 1e-6)] {
        let course = run(&system, [&angle, &speed], &times, accuracy, method);
        let off = imbalance(&system, &course);
        assert!(off.abs() < allowed, "{method:?}: {off:e}");
        let losses = &course.work[2..];
        assert!(losses.iter().all(|&loss| loss >= 0.0), "{method:?}: losses {losses:?}");
        assert!(losses[0] > 1.0, "{method:?}: teeth of the rigid stage");
    }
}

#[test]
fn methods_agree() {
    let (system, [angle, speed]) = (everything(), start());
    let times: Vec<f64> = (0..61).map(|i| 0.01 * f64::from(i)).collect();
    let exact = run(&system, [&angle, &speed], &times, 1e-12, Method::Explicit);
    let course = run(&system, [&angle, &speed], &times, 1e-9, Method::Implicit);
    let (n, k) = (system.len(), times.len());
    for row in n..2 * n + system.links.len() {
        let [found, wanted] = [&course, &exact].map(|one| &one.samples[row * k..(row + 1) * k]);
        let size = wanted.iter().fold(1e-3_f64, |most, x| most.max(x.abs()));
        let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size;
        assert!(off < 1e-3, "row {row}: {off:e}");
    }
}

/// The derivatives that Newton uses against differences of the accelerations.
#[test]
fn derivatives_of_the_accelerations() {
    let angle = [0.3, 0.3, 0.29, 0.28, 0.24, 0.23, 0.24, 0.23, 1e-4, 0.0];
    let speed = [101.0, 101.0, 103.0, 90.5, 97.0, 98.0, 99.0, 97.0, 0.4, -5.0];
    require_derivatives(&everything(), 0.1, [&angle, &speed], 1e-7);
}
