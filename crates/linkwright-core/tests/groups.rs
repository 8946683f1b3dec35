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
