//! Elements beyond crank, rod and rocker: derivatives, third transfer functions, lanes, closure at and near
//! change points, groups against dyads.

mod common;

use common::{Builder, Built};
use linkwright_core::batch::{Channel, Rows, motions, third};
use linkwright_core::drive::Motor;
use linkwright_core::linkage::Motion;
use linkwright_core::linkage::coupled::Source;
use linkwright_core::plane::{Angle, Vec2};
use std::f64::consts::PI;

fn place(built: &Built, phi: f64) -> Motion<f64> {
    let mut motion = Motion::new(&built.plan.mechanism, &built.q);
    built.plan.mechanism.place::<f64, 2>(&built.q, Angle::new(phi), &mut motion);
    motion
}

fn distance(m: &Motion<f64>, a: usize, b: usize) -> f64 {
    let u = m.points[a].p - m.points[b].p;
    u.dot(u).sqrt()
}

/// A crank-rocker that moves one of each: a rod on a guide of its coupler, a slotted lever, two guides that
/// cross, a gear on the rocker, a rack on a guide of the crank.
fn one_of_each() -> Built {
    let mut b = Builder::new();
    let frame = b.frame();
    let pivot = b.fixed(0.4, 0.0);
    let far = b.fixed(0.1, -0.5);
    let (pin, crank) = b.crank(0.1, 0.3);
    let [_, coupler, rocker] = b.rocker(pin, pivot, 0.38, 0.28, 1.0);
    let on_coupler = b.line(pin, coupler, 0.4, 0.05);
    b.guided_rod(pivot, on_coupler, 0.6, 1.0);
    let [lever, _] = b.slotted_lever(pin, far, 0.06, 1.0);
    b.slotted_lever(pin, far, -0.1, -1.0);
    let lines = [b.line(far, lever, 0.2, 0.03), b.line(pin, coupler, -0.5, 0.1)];
    b.crossing(lines);
    let yoke = [b.line(0, frame, 0.3, -0.2), b.line(pin, frame, 1.4, 0.0)];
    b.crossing(yoke);
    let swing = b.angle_of(rocker, 0.0, 1.9);
    let turn = b.angle_of(crank, 1.0, 0.3);
    let [gear, angle] = b.gear(0.2, &[(Source::Slide(swing), -2.5), (Source::Slide(turn), 1.5)]);
    let on_gear = b.line(pivot, gear, 0.1, 0.02);
    b.runner(on_gear, 0.3, &[(Source::Slide(angle), 0.04), (Source::Drive, 0.01)]);
    b.finish(Motor::Off, [1.0; 5])
}

/// A platform of three joints on bars to the crank and to two fixed points.
fn triad() -> Built {
    let mut b = Builder::new();
    let (p, q) = (b.fixed(0.15, -0.04), b.fixed(0.33, -0.02));
    let (pin, _) = b.crank(0.04, 0.0);
    let (left, right) = (b.joint(), b.joint());
    let corner = b.carried(left, right, 0.03 / 0.17, 0.06 / 0.17);
    let bars = [(p, left, 0.15), (q, right, 0.14), (left, right, 0.17), (pin, corner, 0.19)];
    let turns = b.group(&bars, &[left, right], &[0.14, 0.11, 0.31, 0.12]);
    assert_eq!(turns, Some(1), "comes back after one turn");
    b.finish(Motor::Off, [1.0; 5])
}

/// A parallelogram (`sign` +1) or antiparallelogram (−1), with how many change points were found.
fn folding(sign: f64) -> (Built, [usize; 3]) {
    let mut b = Builder::new();
    let (pin, _) = b.crank(0.1, 0.0);
    let pivot = b.fixed(0.3, 0.0);
    let made = b.rocker(pin, pivot, 0.3, 0.1, sign);
    assert_eq!(b.fold(&[0.01, 3.13]), 2, "change points at 0 and π");
    (b.finish(Motor::Off, [1.0; 5]), made)
}

/// Angles at, near and far from both change points.
fn around_change_points() -> Vec<f64> {
    let mut phi: Vec<f64> = (0..200).map(|i| 0.0314 * f64::from(i) + 0.01).collect();
    for at in [0.0, PI, 2.0 * PI] {
        phi.push(at);
        for k in 2..=12 {
            phi.extend([at - 10f64.powi(-k), at + 10f64.powi(-k)]);
        }
    }
    phi
}

/// Difference of order 4 of a number of the motion.
fn slope(built: &Built, phi: f64, f: impl Fn(&Motion<f64>) -> f64) -> f64 {
    // Truncation h⁴ and rounding ε/h balance near h = 1e-3.
    let h = 1e-3;
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(&place(built, phi + k * h)));
    (a - 8.0 * b + 8.0 * c - d) / (12.0 * h)
}

fn check_derivatives(built: &Built) {
    for i in 0..12 {
        let phi = 0.53 * f64::from(i);
        let m = place(built, phi);
        // Fourth powers of rates of a few per radian times 1e-12, and rounding over 1e-3.
        let near = |what: &str, k: usize, found: f64, exact: f64| {
            assert!(
                (found - exact).abs() < 1e-7 * exact.abs().max(1.0),
                "{what} {k} at {phi}: {found} for {exact}"
            );
        };
        for (k, p) in m.points.iter().enumerate() {
            near("x′ of point", k, slope(built, phi, |m| m.points[k].p.x), p.d1.x);
            near("y″ of point", k, slope(built, phi, |m| m.points[k].d1.y), p.d2.y);
        }
        for (k, link) in m.links.iter().enumerate() {
            let turn = slope(built, phi, |m| m.links[k].e.y) * link.e.x
                - slope(built, phi, |m| m.links[k].e.x) * link.e.y;
            near("ψ′ of link", k, turn, link.d1);
            near("ψ″ of link", k, slope(built, phi, |m| m.links[k].d1), link.d2);
        }
        for (k, s) in m.slides.iter().enumerate() {
            near("s′ of slide", k, slope(built, phi, |m| m.slides[k].s), s.d1);
            near("s″ of slide", k, slope(built, phi, |m| m.slides[k].d1), s.d2);
        }
    }
}

#[test]
fn derivatives_of_all_elements_agree_with_differences() {
    check_derivatives(&one_of_each());
}

#[test]
fn derivatives_of_a_group_agree_with_differences() {
    check_derivatives(&triad());
}

#[test]
fn derivatives_through_change_points_agree_with_differences() {
    for sign in [1.0, -1.0] {
        check_derivatives(&folding(sign).0);
    }
}

/// Jets of the kernels against differences of their second derivatives.
#[test]
fn third_transfer_functions_agree_with_differences() {
    for built in [one_of_each(), triad(), folding(-1.0).0] {
        let mechanism = &built.plan.mechanism;
        for i in 0..8 {
            let phi = 0.77 * f64::from(i);
            for k in 0..mechanism.n_points {
                let mut found = [0.0; 2];
                third(&built.plan, &built.q, &[phi], &[Channel::Point(k)], &mut found);
                let exact = slope(&built, phi, |m| m.points[k].d2.x);
                assert!(
                    (found[0] - exact).abs() < 1e-7 * exact.abs().max(1.0),
                    "point {k}: {} {exact}",
                    found[0]
                );
            }
            for k in 0..mechanism.n_links {
                let mut found = [0.0];
                third(&built.plan, &built.q, &[phi], &[Channel::Link(k)], &mut found);
                let exact = slope(&built, phi, |m| m.links[k].d2);
                assert!(
                    (found[0] - exact).abs() < 1e-6 * exact.abs().max(1.0),
                    "link {k}: {} {exact}",
                    found[0]
                );
            }
        }
    }
}

/// Many angles in lanes give what each gives alone.
#[test]
fn lanes_are_the_scalar_for_all_elements() {
    for built in [one_of_each(), triad(), folding(1.0).0] {
        let (n_points, n_links) = (built.plan.mechanism.n_points, built.plan.mechanism.n_links);
        let phi: Vec<f64> = (0..77).map(|i| 0.083 * f64::from(i) - 1.0).collect();
        let rows = Rows { base: &built.q, slots: &[], values: &[], n: 1 };
        let channels: Vec<_> =
            (0..n_points).map(Channel::Point).chain((0..n_links).map(Channel::Link)).collect();
        let mut out = vec![0.0; (6 * n_points + 4 * n_links) * phi.len()];
        motions(&built.plan, &rows, &phi, &channels, &mut out);
        for (i, &phi_i) in phi.iter().enumerate() {
            let m = place(&built, phi_i);
            let points = m.points.iter().flat_map(|p| [p.p.x, p.p.y, p.d1.x, p.d1.y, p.d2.x, p.d2.y]);
            let links = m.links[..n_links].iter().flat_map(|l| [l.e.x, l.e.y, l.d1, l.d2]);
            for (k, exact) in points.chain(links).enumerate() {
                let found = out[k * phi.len() + i];
                // Fused multiply-add in lanes, none in the scalar; near change points rates lose 1/δ² of that.
                let tolerance = 1e-10 * exact.abs().max(1.0);
                assert!((found - exact).abs() < tolerance, "number {k} at {phi_i}: {found} for {exact}");
            }
        }
    }
}

/// Both linkages keep their lengths at, near and far from the change points, and never jump.
#[test]
fn loops_close_through_change_points() {
    for sign in [1.0, -1.0] {
        let (built, [joint, coupler, rocker]) = folding(sign);
        let mut phi = around_change_points();
        phi.sort_by(f64::total_cmp);
        let mut before: Option<(f64, Vec2<f64>)> = None;
        for &phi in &phi {
            let m = place(&built, phi);
            // Points: origin, pin, pivot, joint.
            assert!((distance(&m, joint, 1) - 0.3).abs() < 1e-12, "coupler at {phi}");
            assert!((distance(&m, joint, 2) - 0.1).abs() < 1e-12, "rocker at {phi}");
            let (l, r) = (0.3_f64, 0.1_f64);
            // The parallelogram turns with the crank; the antiparallelogram by the ratio of the parts into which
            // its long links cut each other.
            let exact =
                if sign > 0.0 { 1.0 } else { -(l * l - r * r) / (l * l + r * r - 2.0 * l * r * phi.cos()) };
            assert!(
                (m.links[rocker].d1 - exact).abs() < 1e-11,
                "{} for {exact} at {phi}",
                m.links[rocker].d1
            );
            if sign > 0.0 {
                assert!(m.links[coupler].d1.abs() < 1e-11, "coupler turns at {phi}");
            }
            if let Some((at, p)) = before {
                let step = m.points[joint].p - p;
                // The joint is never faster than the driven crank: 0.1 m at twice the speed of the crank.
                assert!(step.dot(step).sqrt() <= 0.201 * (phi - at) + 1e-14, "a jump at {phi}");
            }
            before = Some((phi, m.points[joint].p));
        }
    }
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

/// All four lengths of the triad, and the corner where the platform carries it.
#[test]
fn a_triad_closes() {
    let built = triad();
    for i in 0..200 {
        let m = place(&built, 0.0721 * f64::from(i) - 3.0);
        // Points: origin, two pivots, pin, two joints, corner.
        for (a, b, length) in [(1, 4, 0.15), (2, 5, 0.14), (4, 5, 0.17), (3, 6, 0.19)] {
            assert!((distance(&m, a, b) - length).abs() < 1e-12, "{a}–{b}");
        }
        let corner = (0.03_f64 * 0.03 + 0.06 * 0.06).sqrt();
        assert!((distance(&m, 4, 6) - corner).abs() < 1e-12, "corner");
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
