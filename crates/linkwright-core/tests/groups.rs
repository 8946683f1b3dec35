//! Groups solved together, against the same linkage as a dyad, and at their limits.

mod common;

use common::{Builder, SampleMachine};
use linkwright_core::drive::motor::Motor;
use linkwright_core::kernel::plane::Angle;
use linkwright_core::linkage::motion::Motion;
use std::f64::consts::PI;

fn place(built: &SampleMachine, phi: f64) -> Motion<f64> {
    let mut motion = Motion::new(&built.plan.mechanism, &built.q);
    built.plan.mechanism.place::<f64, 2>(&built.q, Angle::new(phi), &mut motion);
    motion
}

/// The joint of a four-bar linkage, found by Newton, is where the dyad puts it.
#[test]
fn a_group_of_one_is_the_dyad() {
    let mut b = Builder::new();
    let pivot = b.fixed(0.4, 0.1);
    let (pin, _) = b.crank(0.1, 0.2);
    let [joint, ..] = b.rocker(pin, pivot, 0.38, 0.28, 1.0);
    let other = b.joint();
    assert_eq!(b.group(&[(pin, other, 0.38), (pivot, other, 0.28)], &[other], &[0.3, 0.4]), Some(1));
    let built = b.finish(Motor::Off, [1.0; 5]);
    for i in 0..100 {
        let m = place(&built, 0.0628 * f64::from(i));
        let (a, b) = (m.points[joint], m.points[other]);
        for (a, b) in [(a.p, b.p), (a.d1, b.d1), (a.d2, b.d2)] {
            let u = a - b;
            assert!(u.dot(u).sqrt() < 1e-13, "{a:?} and {b:?}");
        }
    }
}

/// A bar r about the origin, a cylinder of length L = 0.3 sin φ from a point at distance t on x: x = (r² + t² − L²)/2t.
#[test]
fn a_cylinder_follows_the_law_of_cosines() {
    let mut b = Builder::new();
    let (foot, trunnion) = (b.fixed(0.0, 0.0), b.fixed(0.4, 0.0));
    let length = b.law_of_sine();
    let joint = b.cylinder((foot, 0.3), (trunnion, length), [0.25, 0.16]);
    let built = b.finish(Motor::Off, [1.0; 5]);
    for i in 0..20 {
        // Between the angles where the cylinder is as short as t − r.
        let phi = 0.6 + 0.09 * f64::from(i);
        let p = place(&built, phi).points[joint];
        let x = (0.09 + 0.16 - 0.09 * phi.sin().powi(2)) / 0.8;
        let (x1, x2) = (-0.09 * (2.0 * phi).sin() / 0.8, -0.18 * (2.0 * phi).cos() / 0.8);
        let y = (0.09 - x * x).sqrt();
        let y1 = -x * x1 / y;
        let y2 = -(x1 * x1 + x * x2 + y1 * y1) / y;
        for (found, (x, y)) in [(p.p, (x, y)), (p.d1, (x1, y1)), (p.d2, (x2, y2))] {
            assert!((found.x - x).abs() + (found.y - y).abs() < 1e-12, "{found:?} at {phi}");
        }
    }
}

/// Where a group cannot go it says so, and what it would place is NaN.
#[test]
fn a_group_beyond_its_limit_says_so() {
    let mut b = Builder::new();
    let pivot = b.fixed(0.5, 0.0);
    let (pin, _) = b.crank(0.2, 0.0);
    let joint = b.joint();
    // Reaches 0.65 m; pin and pivot are 0.7 m apart at φ = π.
    assert_eq!(b.group(&[(pin, joint, 0.3), (pivot, joint, 0.35)], &[joint], &[0.3, 0.3]), None);
    let built = b.finish(Motor::Off, [1.0; 5]);
    let m = place(&built, PI);
    assert!(m.gaps[0] < 0.0, "radicand {}", m.gaps[0]);
    assert!(m.points[joint].p.x.is_nan(), "placed at {}", m.points[joint].p.x);
    assert!(place(&built, 1.0).points[joint].p.x.is_finite(), "closes at 1 rad");
}
