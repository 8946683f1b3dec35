//! Guides that turn, gears, change points, groups: derivatives, closure, lanes against the scalar.

mod common;

use common::{Builder, SampleMachine};
use linkwright_core::drive::batch::Rows;
use linkwright_core::drive::motions::{motions, third};
use linkwright_core::drive::motor::Motor;
use linkwright_core::kernel::jet::Jet;
use linkwright_core::kernel::plane::Angle;
use linkwright_core::kernel::real::Real;
use linkwright_core::linkage::motion::Channel;
use linkwright_core::linkage::motion::Motion;
use linkwright_core::linkage::trace::follow;
use std::f64::consts::TAU;

fn place(built: &SampleMachine, phi: f64) -> Motion<f64> {
    let mut motion = Motion::new(&built.plan.mechanism, &built.q);
    built.plan.mechanism.place::<f64, 2>(&built.q, Angle::new(phi), &mut motion);
    motion
}

fn finish(b: Builder) -> SampleMachine {
    b.finish(Motor::Off, [1.0; 5])
}

/// A crank-rocker with one element of every kind that hangs on moving links.
fn everything() -> SampleMachine {
    let mut b = Builder::new();
    let (pin, crank) = b.crank(0.1, 0.2);
    let pivot = b.fixed(0.4, 0.05);
    let far = b.fixed(0.1, 0.6);
    let [joint, coupler, rocker] = b.rocker(pin, pivot, 0.38, 0.27, 1.0);
    let tip = b.rigid_point(rocker, pivot, 0.1, 0.12);
    let on_coupler = b.line(pin, coupler, 0.3, 0.02);
    b.guided_rod(tip, on_coupler, 0.5, 1.0);
    b.slotted_lever(joint, far, 0.03, 1.0);
    let on_rocker = b.line(pivot, rocker, -0.4, 0.01);
    b.crossing(on_coupler, on_rocker);
    let angle = b.angle_of(rocker, 0.0, 1.6);
    b.turn(0.7, &[(None, -1.5), (Some(angle), 2.5)]);
    b.runner(on_coupler, 0.1, &[(Some(angle), 0.2)]);
    b.angle_of(crank, 1.0, 0.2);
    b.law_of_sine();
    finish(b)
}

/// Lengths of the triad's bars: pin to P, P to Q, Q to the first pivot, the plate's corner to the second.
const TRIAD: [f64; 4] = [0.4, 0.3, 0.41, 0.5];

/// A joint plate held by three bars: a triad that no dyads make, driven from a crank.
fn triad() -> (SampleMachine, usize) {
    let mut b = Builder::new();
    let (pin, _) = b.crank(0.05, 0.0);
    let first = b.fixed(0.75, 0.0);
    let second = b.fixed(0.9, 0.2);
    let near = [0.25, 0.35, 0.55, 0.35];
    let element = b.triad(pin, [first, second], TRIAD, (0.15, -0.2), near);
    let mut built = finish(b);
    let path =
        follow(&built.plan.mechanism, element, &built.q, 0.0, &near).expect("closes where it is assembled");
    assert_eq!(path.turns, Some(1), "a short crank turns fully");
    Builder::give_path(&mut built, element, &path);
    (built, element)
}

/// First and second derivatives of all that moves against central differences of order 4.
fn check_derivatives(built: &SampleMachine, phi: f64, tolerance: f64) {
    // Truncation h⁴ and rounding ε/h balance near h = 1e-3 at about 1e-12, over lengths below one.
    let h = 1e-3;
    let m: Vec<_> = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| place(built, phi + k * h)).into();
    let slope = |f: &dyn Fn(&Motion<f64>) -> f64| {
        (f(&m[0]) - 8.0 * f(&m[1]) + 8.0 * f(&m[3]) - f(&m[4])) / (12.0 * h)
    };
    let mut pairs = Vec::new();
    for (k, p) in m[2].points.iter().enumerate() {
        pairs.push((slope(&|m| m.points[k].p.x), p.d1.x));
        pairs.push((slope(&|m| m.points[k].p.y), p.d1.y));
        pairs.push((slope(&|m| m.points[k].d1.x), p.d2.x));
        pairs.push((slope(&|m| m.points[k].d1.y), p.d2.y));
    }
    for (k, link) in m[2].links.iter().enumerate() {
        let turn = slope(&|m| m.links[k].e.y) * link.e.x - slope(&|m| m.links[k].e.x) * link.e.y;
        pairs.push((turn, link.d1));
        pairs.push((slope(&|m| m.links[k].d1), link.d2));
    }
    for (k, slide) in m[2].slides.iter().enumerate() {
        pairs.push((slope(&|m| m.slides[k].s), slide.d1));
        pairs.push((slope(&|m| m.slides[k].d1), slide.d2));
    }
    for (nth, (difference, exact)) in pairs.into_iter().enumerate() {
        assert!((difference - exact).abs() < tolerance, "at {phi}, number {nth}: {difference} for {exact}");
    }
}

#[test]
fn derivatives_agree_with_differences() {
    let built = everything();
    let (group, _) = triad();
    for i in 0..24 {
        check_derivatives(&built, 0.27 * f64::from(i), 2e-8);
        check_derivatives(&group, 0.27 * f64::from(i), 2e-8);
    }
}

/// Third derivatives in series against differences of the second ones.
#[test]
fn third_derivatives_agree_with_differences() {
    for built in [everything(), triad().0] {
        let m = &built.plan.mechanism;
        let mut channels: Vec<Channel> = (0..m.n_points).map(Channel::Point).collect();
        channels.extend((0..m.n_links).map(Channel::Link));
        channels.extend((0..m.n_slides).map(Channel::Slide));
        let phi: Vec<f64> = (0..20).map(|i| 0.31 * f64::from(i)).collect();
        let rows: usize = channels.iter().map(|c| c.third_width()).sum();
        let mut out = vec![0.0; rows * phi.len()];
        third(&built.plan, &built.q, &phi, &channels, &mut out);
        let h = 1e-3;
        for (i, &at) in phi.iter().enumerate() {
            let near: Vec<_> = [-2.0, -1.0, 1.0, 2.0].map(|k| place(&built, at + k * h)).into();
            let slope = |f: &dyn Fn(&Motion<f64>) -> f64| {
                (f(&near[0]) - 8.0 * f(&near[1]) + 8.0 * f(&near[2]) - f(&near[3])) / (12.0 * h)
            };
            let mut row = 0;
            for channel in &channels {
                let exact: Vec<f64> = match *channel {
                    Channel::Point(k) => vec![slope(&|m| m.points[k].d2.x), slope(&|m| m.points[k].d2.y)],
                    Channel::Link(k) => vec![slope(&|m| m.links[k].d2)],
                    Channel::Slide(k) => vec![slope(&|m| m.slides[k].d2)],
                };
                for difference in exact {
                    let found = out[row * phi.len() + i];
                    // The differences are good to 1e-9 of derivatives that grow to some tens.
                    assert!(
                        (found - difference).abs() < 2e-7,
                        "{channel:?} at {at}: {found} for {difference}"
                    );
                    row += 1;
                }
            }
        }
    }
}

/// Lanes and the scalar, element by element.
#[test]
fn lanes_are_the_scalar() {
    for built in [everything(), triad().0] {
        let m = &built.plan.mechanism;
        let phi: Vec<f64> = (0..77).map(|i| 0.083 * f64::from(i) - 1.0).collect();
        let points: Vec<Channel> = (0..m.n_points).map(Channel::Point).collect();
        let rows = Rows { base: &built.q, slots: &[], values: &[], n: 1 };
        let mut out = vec![0.0; 6 * points.len() * phi.len()];
        motions(&built.plan, &rows, &phi, &points, &mut out);
        for (i, &at) in phi.iter().enumerate() {
            let one = place(&built, at);
            for (k, p) in one.points.iter().enumerate() {
                for (n, exact) in [p.p.x, p.p.y, p.d1.x, p.d1.y, p.d2.x, p.d2.y].into_iter().enumerate() {
                    let found = out[(6 * k + n) * phi.len() + i];
                    // Fused multiply-add in lanes, none in the scalar: some ulps of sums of order one.
                    assert!((found - exact).abs() < 1e-12, "point {k}, number {n}: {found} for {exact}");
                }
            }
        }
    }
}

/// The parallelogram and the antiparallelogram through both change points, at any distance from them: the
/// loop closes and the rates are those of the closed forms.
#[test]
fn change_points_are_passed() {
    for (side, is_parallel) in [(1.0, true), (-1.0, false)] {
        let mut b = Builder::new();
        let (pin, _) = b.crank(0.3, 0.0);
        let pivot = b.fixed(1.0, 0.0);
        let [joint, coupler, rocker] = b.rocker(pin, pivot, 1.0, 0.3, side);
        let mut built = finish(b);
        assert_eq!(Builder::give_change_points(&mut built, 1), 2, "folded and stretched");
        for centre in [0.0, TAU / 2.0, TAU] {
            for k in -120..=120 {
                let distance = f64::from(k).signum() * 10.0_f64.powf(-14.0 + f64::from(k).abs() / 10.0);
                let m = place(&built, centre + distance);
                let length = |a: usize, b: usize| {
                    let u = m.points[a].p - m.points[b].p;
                    u.dot(u).sqrt()
                };
                assert!((length(joint, pin) - 1.0).abs() < 1e-14, "coupler at {centre} + {distance}");
                assert!((length(joint, pivot) - 0.3).abs() < 1e-14, "rocker at {centre} + {distance}");
                if is_parallel {
                    assert!(
                        m.links[coupler].d1.abs() < 1e-12,
                        "the coupler turns by {}",
                        m.links[coupler].d1
                    );
                    assert!((m.links[rocker].d1 - 1.0).abs() < 1e-12, "the rocker by {}", m.links[rocker].d1);
                } else {
                    // The antiparallelogram: ψ′ = −(d² − r²)/(d² + r² − 2 d r cos φ) with d the coupler.
                    let (s, c) = (0.3_f64, (centre + distance).cos());
                    let exact = -(1.0 - s * s) / (1.0 + s * s - 2.0 * s * c);
                    let error = (m.links[rocker].d1 - exact).abs();
                    assert!(error < 1e-11, "the rocker turns by {} for {exact}", m.links[rocker].d1);
                }
            }
        }
    }
}

/// All but a rhombus: a parallelogram whose pin passes its pivot at any distance down to none stays one, with rates
/// up to the third, at and near both change points and far from them.
#[test]
fn a_parallelogram_stays_one_however_near_to_a_rhombus() {
    let excesses = (0..=30).map(|k| if k == 30 { 0.0 } else { 10.0_f64.powf(-0.5 * f64::from(k) - 0.5) });
    for excess in excesses {
        let long = 0.3 * (1.0 + excess);
        let mut b = Builder::new();
        let (pin, _) = b.crank(0.3, 0.0);
        let pivot = b.fixed(long, 0.0);
        let [_, coupler, rocker] = b.rocker(pin, pivot, long, 0.3, 1.0);
        let mut built = finish(b);
        assert_eq!(Builder::give_change_points(&mut built, 1), 2, "change points at excess {excess:e}");
        let at = |phi: f64| -> Vec<[f64; 4]> {
            let q: Vec<_> = built.q.iter().map(|&x| Jet::<f64, 4>::constant(x)).collect();
            let mut m = Motion::new(&built.plan.mechanism, &q);
            built.plan.mechanism.place::<_, 2>(&q, Angle::new(Jet::variable(phi)), &mut m);
            [coupler, rocker].map(|link| m.links[link].e.y.atan2(m.links[link].e.x).c).to_vec()
        };
        for centre in [0.0, TAU / 2.0, TAU] {
            for k in (-60..=60).filter(|k| k % 3 == 0) {
                let distance = f64::from(k).signum() * 10.0_f64.powf(-14.0 + f64::from(k).abs() / 4.4);
                let phi = centre + distance;
                let m = place(&built, phi);
                let turned = at(phi);
                let off = (m.links[coupler].e.y).abs().max((m.links[coupler].e.x - 1.0).abs());
                assert!(off < 1e-13, "at {phi} the coupler is off by {off:e} for excess {excess:e}");
                // Outside the series a rate loses a digit for each that the distance is below one, 0.03 rad at
                // the stretched point: some 1e-12, 1e-9, 1e-7 for the three rates.
                for (k, limit) in [2e-12, 2e-9, 1e-6].into_iter().enumerate() {
                    let wanted = if k == 0 { 1.0 } else { 0.0 };
                    let error = turned[0][k + 1].abs().max((turned[1][k + 1] - wanted).abs());
                    assert!(error < limit, "rate {k} at {phi} is off by {error:e} for excess {excess:e}");
                }
            }
        }
    }
}

/// Every condition of the group is met all round, and by turns without end.
#[test]
fn a_group_closes() {
    let (built, _) = triad();
    for i in 0..200 {
        let m = place(&built, 0.173 * f64::from(i) - 9.0);
        let length = |a: usize, b: usize| {
            let u = m.points[a].p - m.points[b].p;
            u.dot(u).sqrt()
        };
        // Points in the order of `triad`: origin, pin, two pivots, P, Q, the plate's third corner.
        for ((a, b), exact) in [(1, 4), (4, 5), (5, 2), (6, 3)].into_iter().zip(TRIAD) {
            assert!((length(a, b) - exact).abs() < 1e-14, "bar {a}–{b}: {} for {exact}", length(a, b));
        }
    }
}
