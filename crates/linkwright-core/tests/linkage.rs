//! Positions and transfer functions: closed forms, laws on random mechanisms, lanes against the scalar.

mod common;

use common::{Builder, Random, SampleMachine, mixed};
use linkwright_core::drive::batch::Rows;
use linkwright_core::drive::motions::motions;
use linkwright_core::drive::motor::Motor;
use linkwright_core::kernel::plane::{Angle, Place};
use linkwright_core::linkage::chain::Chain;
use linkwright_core::linkage::in_line::in_line;
use linkwright_core::linkage::motion::Channel;
use linkwright_core::linkage::motion::Motion;

fn place(built: &SampleMachine, phi: f64) -> Motion<f64> {
    let mut motion = Motion::new(&built.plan.mechanism, &built.q);
    built.plan.mechanism.place::<f64, 2>(&built.q, Angle::new(phi), &mut motion);
    motion
}

/// In-line slider-crank: x = r cos φ + √(l² − r² sin² φ), its derivatives, and the rod's angle.
#[test]
fn slider_crank_has_its_closed_form() {
    let (r, l) = (0.2_f64, 0.8_f64);
    let mut b = Builder::new();
    let (pin, _) = b.crank(r, 0.0);
    let [_, rod, slide] = b.slider(pin, l, 0.0, 0.0, 1.0);
    let built = b.finish(Motor::Off, [1.0; 5]);
    for i in 0..100 {
        let phi = 0.0631 * f64::from(i);
        let (s, c) = phi.sin_cos();
        let d = (l * l - r * r * s * s).sqrt();
        let m = place(&built, phi);
        let x1 = -r * s * (1.0 + r * c / d);
        let x2 = -r * c - r * r * ((c * c - s * s) / d + r * r * s * s * c * c / d.powi(3));
        let beta1 = -r * c / d;
        // Sums of three terms below one: a few ulps.
        for (found, exact) in
            [(m.slides[slide].s, r * c + d), (m.slides[slide].d1, x1), (m.slides[slide].d2, x2)]
        {
            assert!((found - exact).abs() < 1e-15, "at {phi}: {found} for {exact}");
        }
        assert!((m.links[rod].d1 - beta1).abs() < 1e-15, "rod at {phi}");
    }
}

/// A guide turned by α, with the crank's phase turned as well, is the same mechanism turned.
#[test]
fn inclined_guide_is_the_same_mechanism_turned() {
    let build = |angle: f64| {
        let mut b = Builder::new();
        let (pin, _) = b.crank(0.13, angle);
        b.slider(pin, 0.5, 0.07, angle, 1.0);
        b.finish(Motor::Off, [1.0; 5])
    };
    let (straight, turned) = (build(0.0), build(0.83));
    for i in 0..50 {
        let (a, b) = (place(&straight, 0.13 * f64::from(i)), place(&turned, 0.13 * f64::from(i)));
        let (a, b) = (a.slides[0], b.slides[0]);
        for (a, b) in [(a.s, b.s), (a.d1, b.d1), (a.d2, b.d2)] {
            assert!((a - b).abs() < 2e-15, "{a} and {b}");
        }
    }
}

/// A parallelogram moves its coupler without turning it: ψ_coupler′ = 0, ψ_rocker′ = 1.
#[test]
fn parallelogram_coupler_does_not_turn() {
    let mut b = Builder::new();
    let (pin, _) = b.crank(0.3, 0.0);
    let pivot = b.fixed(1.0, 0.0);
    let [joint, coupler, rocker] = b.rocker(pin, pivot, 1.0, 0.3, -1.0);
    let built = b.finish(Motor::Off, [1.0; 5]);
    // For φ in (0, π) the joint of the parallelogram lies right of the line pin → pivot … or left: one of
    // the two assemblies is the parallelogram, the other the antiparallelogram.
    for i in 1..30 {
        let phi = 0.1 * f64::from(i);
        let m = place(&built, phi);
        let to_joint = m.points[joint].p - m.points[pin].p;
        let is_parallel = (to_joint.y).abs() < 1e-9;
        let other = {
            let mut b = Builder::new();
            let (pin, _) = b.crank(0.3, 0.0);
            let pivot = b.fixed(1.0, 0.0);
            b.rocker(pin, pivot, 1.0, 0.3, 1.0);
            b.finish(Motor::Off, [1.0; 5])
        };
        let m = if is_parallel { m } else { place(&other, phi) };
        // Near the change points at 0 and π the conditioning costs digits like 1/sin φ.
        let tolerance = 1e-13 / phi.sin().abs().powi(2);
        assert!(m.links[coupler].d1.abs() < tolerance, "coupler turns by {} at {phi}", m.links[coupler].d1);
        assert!((m.links[rocker].d1 - 1.0).abs() < tolerance, "rocker turns by {}", m.links[rocker].d1);
    }
}

/// Lengths of all links are kept: the loop closes.
#[test]
fn loops_close() {
    let mut random = Random(7);
    for _ in 0..200 {
        let built = mixed(&mut random);
        for i in 0..24 {
            let m = place(&built, 0.27 * f64::from(i));
            // Points in the order of `mixed`: origin, pin, slider, pivot, joint.
            let length = |a: usize, b: usize| {
                let u = m.points[a].p - m.points[b].p;
                u.dot(u).sqrt()
            };
            let elements = &built.plan.mechanism.elements;
            for element in elements {
                use linkwright_core::linkage::mechanism::Element;
                let (found, exact) = match element {
                    Element::SliderRod(e) => (length(e.point, e.pin), built.q[e.rod]),
                    Element::Rocker(e) => (length(e.joint, e.pivot), built.q[e.rocker]),
                    _ => continue,
                };
                // Links are below one metre.
                assert!((found - exact).abs() < 1e-14, "{found} for {exact}");
            }
        }
    }
}

/// First and second transfer functions against central differences of order 4.
#[test]
fn derivatives_agree_with_differences() {
    let mut random = Random(11);
    for _ in 0..50 {
        let built = mixed(&mut random);
        for i in 0..8 {
            let phi = 0.79 * f64::from(i);
            // Truncation h⁴ and rounding ε/h balance near h = 1e-3 at about 1e-12.
            let h = 1e-3;
            let m: Vec<_> = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| place(&built, phi + k * h)).into();
            let slope = |f: &dyn Fn(&Motion<f64>) -> f64| {
                (f(&m[0]) - 8.0 * f(&m[1]) + 8.0 * f(&m[3]) - f(&m[4])) / (12.0 * h)
            };
            for (p, place) in m[2].points.iter().enumerate() {
                let pairs = [
                    (slope(&|m| m.points[p].p.x), place.d1.x),
                    (slope(&|m| m.points[p].p.y), place.d1.y),
                    (slope(&|m| m.points[p].d1.x), place.d2.x),
                    (slope(&|m| m.points[p].d1.y), place.d2.y),
                ];
                for (difference, exact) in pairs {
                    assert!((difference - exact).abs() < 1e-9, "point {p}: {difference} for {exact}");
                }
            }
            for (l, link) in m[2].links.iter().enumerate() {
                let turn = slope(&|m| m.links[l].e.y) * link.e.x - slope(&|m| m.links[l].e.x) * link.e.y;
                assert!((turn - link.d1).abs() < 1e-9, "link {l}: {turn} for {}", link.d1);
                let bend = slope(&|m| m.links[l].d1);
                assert!((bend - link.d2).abs() < 1e-8, "link {l}: {bend} for {}", link.d2);
            }
        }
    }
}

/// A rod shorter than the crank leaves a negative radicand and NaN, in its own lane only.
#[test]
fn what_does_not_close_says_so() {
    let mut b = Builder::new();
    let (pin, _) = b.crank(0.2, 0.0);
    let [point, ..] = b.slider(pin, 0.15, 0.0, 0.0, 1.0);
    let built = b.finish(Motor::Off, [1.0; 5]);
    let m = place(&built, 1.5);
    assert!(m.gaps[0] < 0.0, "radicand {}", m.gaps[0]);
    assert!(m.points[point].p.x.is_nan(), "placed at {}", m.points[point].p.x);
    assert!(place(&built, 0.3).points[point].p.x.is_finite(), "closes at 0.3 rad");
}

/// Many machines in lanes and threads give what each gives alone.
#[test]
fn lanes_are_the_scalar() {
    let built = mixed(&mut Random(3));
    let phi: Vec<f64> = (0..77).map(|i| 0.083 * f64::from(i) - 1.0).collect();
    let n = 50;
    let slot = 2;
    let radii: Vec<f64> = (0..n).map(|i| 1e-3 * i as f64).collect();
    let rows = Rows { base: &built.q, slots: &[slot], values: &radii, n };
    let channels = [Channel::Point(4), Channel::Link(2), Channel::Slide(0)];
    let mut out = vec![0.0; n * 13 * phi.len()];
    motions(&built.plan, &rows, &phi, &channels, &mut out);
    for row in 0..n {
        let one = SampleMachine { plan: built.plan.clone(), q: rows.row(row) };
        for (i, &phi_i) in phi.iter().enumerate() {
            let m = place(&one, phi_i);
            let (p, l, s) = (m.points[4], m.links[2], m.slides[0]);
            let exact =
                [p.p.x, p.p.y, p.d1.x, p.d1.y, p.d2.x, p.d2.y, l.e.x, l.e.y, l.d1, l.d2, s.s, s.d1, s.d2];
            for (k, exact) in exact.into_iter().enumerate() {
                let found = out[(row * 13 + k) * phi.len() + i];
                // Fused multiply-add in lanes, none in the scalar: some ulps, a little more near the
                // rocker's dead points.
                let tolerance = 1e-13 * exact.abs().max(1.0);
                assert!((found - exact).abs() < tolerance, "row {row}, number {k}: {found} for {exact}");
            }
        }
    }
}

/// What is found along a chain is what the whole mechanism has there: every kind of point, link and slide, with angles
/// that fill the lanes and with a few left over.
#[test]
fn a_chain_leads_to_what_the_mechanism_has() {
    let mut b = Builder::new();
    let pivot = b.fixed(0.4, 0.02);
    let (pin, crank) = b.crank(0.1, 0.3);
    let on_crank = b.rigid_point(crank, 0, 0.05, 0.02);
    let [joint, coupler, rocker] = b.rocker(pin, pivot, 0.35, 0.3, 1.0);
    let on_coupler = b.rigid_point(coupler, pin, 0.2, 0.1);
    let on_rocker = b.rigid_point(rocker, pivot, 0.25, -0.03);
    let [slider, rod, slide] = b.slider(on_coupler, 0.9, 0.01, 0.4, 1.0);
    let on_rod = b.rigid_point(rod, on_coupler, 0.3, 0.04);
    let built = b.finish(Motor::Off, [1.0; 5]);
    let phi: Vec<f64> = (0..77).map(|i| 0.1 * f64::from(i)).collect();
    let points = [0, pivot, pin, on_crank, joint, on_coupler, on_rocker, slider, on_rod].map(Channel::Point);
    let links = [crank, coupler, rocker, rod].map(Channel::Link);
    let rows = Rows { base: &built.q, slots: &[], values: &[], n: 1 };
    for channel in points.into_iter().chain(links).chain([Channel::Slide(slide)]) {
        assert!(Chain::to(&built.plan.mechanism, channel).is_some(), "no chain to {channel:?}");
        let mut out = vec![f64::NAN; channel.width() * phi.len()];
        motions(&built.plan, &rows, &phi, &[channel], &mut out);
        for (i, &phi_i) in phi.iter().enumerate() {
            for (k, expected) in numbers(&place(&built, phi_i), channel).into_iter().enumerate() {
                let found = out[k * phi.len() + i];
                // The same formulas, with products and sums fused or not.
                assert!((found - expected).abs() < 1e-13, "{channel:?}, number {k} at {phi_i}");
            }
        }
    }
}

/// What a channel tells of a motion.
fn numbers(m: &Motion<f64>, channel: Channel) -> Vec<f64> {
    match channel {
        Channel::Point(i) => {
            let Place { p, d1, d2 } = m.points[i];
            vec![p.x, p.y, d1.x, d1.y, d2.x, d2.y]
        }
        Channel::Link(i) => vec![m.links[i].e.x, m.links[i].e.y, m.links[i].d1, m.links[i].d2],
        Channel::Slide(i) => vec![m.slides[i].s, m.slides[i].d1, m.slides[i].d2],
    }
}

/// Links that come into line are found, and links with room to spare are not, whichever of lengths and positions tells.
#[test]
fn links_in_line_are_told_from_links_with_room() {
    let crank = 0.1;
    for angle in [0.0, 0.7, 2.5] {
        for offset in [0.0, 0.04, -0.06] {
            for (factor, points) in [(1.0, if offset == 0.0 { 2 } else { 1 }), (1.005, 0), (1.03, 0)] {
                let mut b = Builder::new();
                let (pin, _) = b.crank(crank, 0.4);
                b.slider(pin, (crank + f64::abs(offset)) * factor, offset, angle, 1.0);
                let built = b.finish(Motor::Off, [1.0; 5]);
                let found = in_line(&built.plan.mechanism, 1, &built.q);
                assert_eq!(found.len(), points, "guide at {angle}, offset {offset}, rod {factor}");
            }
        }
    }
    for (coupler, rocker, points) in [(0.3, 0.2, 1), (0.45, 0.15, 1), (0.302, 0.2, 0), (0.35, 0.3, 0)] {
        let mut b = Builder::new();
        let (pin, _) = b.crank(crank, 0.4);
        let pivot = b.fixed(0.4, 0.0);
        b.rocker(pin, pivot, coupler, rocker, 1.0);
        let built = b.finish(Motor::Off, [1.0; 5]);
        let found = in_line(&built.plan.mechanism, 1, &built.q);
        assert_eq!(found.len(), points, "coupler {coupler}, rocker {rocker}");
    }
}
