//! Cams: extremes, passes and curves against samples and differences; lanes and threads against the scalar.

use linkwright_cam::search::{Cams, RESULTS, search};
use linkwright_cam::shape::{Quantity, Shape};
use linkwright_cam::{Cam, Dimensions, Kind};
use linkwright_kernel::motion_law::{MotionLaw, Piece};
use std::f64::consts::{PI, TAU};

const KINDS: [Kind; 4] =
    [Kind::TranslatingRoller, Kind::TranslatingFlat, Kind::OscillatingRoller, Kind::OscillatingFlat];

/// Rows of a shape.
const BEND: usize = 9;
const SOUNDNESS: usize = 10;

/// A cycloidal rise over 100°, a dwell, a harmonic return whose acceleration jumps at both ends, a dwell.
fn law(h: f64) -> MotionLaw {
    let degree = PI / 180.0;
    let [a, b, c] = [100.0 * degree, 150.0 * degree, 260.0 * degree];
    let piece = |start: f64, end: f64, polynomial: Vec<f64>, harmonics: Vec<[f64; 3]>| Piece {
        start,
        length: end - start,
        polynomial,
        harmonics,
    };
    MotionLaw::new(vec![
        piece(0.0, a, vec![0.0, h], vec![[TAU, 0.0, -h / TAU]]),
        piece(a, b, vec![h], vec![]),
        piece(b, c, vec![0.5 * h], vec![[PI, 0.5 * h, 0.0]]),
        piece(c, TAU, vec![0.0], vec![]),
    ])
    .expect("a whole revolution")
}

/// Dimensions with which all kinds are sound.
fn size(kind: Kind) -> Dimensions<f64> {
    let roller = kind.is_roller();
    Dimensions {
        base_radius: 0.045,
        roller_radius: if roller { 0.01 } else { 0.0 },
        offset: match kind {
            Kind::TranslatingRoller => 0.012,
            Kind::OscillatingFlat => 0.008,
            _ => 0.0,
        },
        distance: 0.14,
        arm: 0.11,
        tilt: if kind == Kind::TranslatingFlat { 0.2 } else { 0.0 },
    }
}

fn lift(kind: Kind) -> f64 {
    match kind {
        Kind::TranslatingRoller | Kind::TranslatingFlat => 0.02,
        Kind::OscillatingRoller => 0.2,
        Kind::OscillatingFlat => 0.1,
    }
}

/// All kinds, both senses, both sides.
fn every(check: impl Fn(Cam<f64>, &MotionLaw, &str)) {
    for kind in KINDS {
        for sense in [1.0, -1.0] {
            for side in [1.0, -1.0] {
                let cam = Cam::new(kind, sense, side, size(kind));
                check(cam, &law(lift(kind)), &format!("{kind:?}, sense {sense}, side {side}"));
            }
        }
    }
}

fn row_of(what: Quantity) -> usize {
    match what {
        Quantity::PressureAngle => 8,
        Quantity::Bend => BEND,
        Quantity::Along => 11,
    }
}

#[test]
fn extremes_are_no_smaller_than_any_sample_and_are_reached() {
    every(|cam, law, name| {
        let (coarse, fine) = (cam.shape(law, 120), cam.shape(law, 40_000));
        for &what in Quantity::of_kind(cam.kind) {
            for sign in [1.0, -1.0] {
                let found = cam.extreme(what, sign, law, &coarse);
                let best = fine.rows[row_of(what)].iter().map(|x| sign * x).fold(f64::MIN, f64::max);
                let scale = fine.rows[row_of(what)].iter().fold(1e-6_f64, |m, x| m.max(x.abs()));
                let more = sign * found.value - best;
                // Samples miss a smooth maximum by (step)²/8 of its second derivative, some 1e-8 of it.
                assert!((-1e-13 * scale..1e-6 * scale).contains(&more), "{name}, {what:?}: {more:e}");
                let reached = [true, false].map(|before| {
                    let (piece, phi) = law.piece(found.phi, before);
                    (cam.row(piece, phi)[row_of(what)] - found.value).abs()
                });
                let nearest = reached[0].min(reached[1]);
                assert!(nearest < 1e-12 * scale, "{name}, {what:?}: {nearest:e} from its own place");
            }
        }
    });
}

#[test]
fn passes_are_zeros_with_the_sign_of_what_follows() {
    every(|cam, law, name| {
        let shape = cam.shape(law, 180);
        let (least, most) =
            shape.rows[BEND].iter().fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
        let level = 0.4 * least + 0.6 * most;
        let found = cam.passes(BEND, level, law, &shape);
        assert!(!found.is_empty() && found.len() % 2 == 0, "{name}: {} passes", found.len());
        assert!(found.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 != w[1].1), "{name}: in turn");
        for (phi, sign) in found {
            let at = |x: f64, before: bool| {
                let (piece, x) = law.piece(x, before);
                cam.row(piece, x)[BEND] - level
            };
            assert!(
                at(phi + 1e-6, false) * sign > 0.0 && at(phi - 1e-6, true) * sign < 0.0,
                "{name} at {phi}"
            );
        }
    });
}

/// A row that is negative up to the end of the revolution, where it jumps.
#[test]
fn a_jump_where_the_turn_closes_is_a_pass() {
    let h = 0.03;
    let law = MotionLaw::new(vec![
        Piece { start: 0.0, length: PI, polynomial: vec![h], harmonics: vec![] },
        // From rest to a curvature at its end: s″ = −2h/π² · 3u.
        Piece { start: PI, length: PI, polynomial: vec![h, 0.0, 0.0, -h], harmonics: vec![] },
    ])
    .expect("a whole revolution");
    // ρ = r₀ + s + s″ falls from r₀ + h to r₀ − 6h/π².
    let size = Dimensions {
        base_radius: 0.5 * 6.0 * h / (PI * PI),
        roller_radius: 0.0,
        offset: 0.0,
        distance: 0.0,
        arm: 0.0,
        tilt: 0.0,
    };
    let cam = Cam::new(Kind::TranslatingFlat, 1.0, 1.0, size);
    let found = cam.passes(SOUNDNESS, 0.0, &law, &cam.shape(&law, 100));
    assert_eq!(found.len(), 2, "{found:?}");
    assert_eq!(found[0], (0.0, 1.0), "sound again from the start of the revolution");
    assert!(found[1].0 > PI && found[1].1 == -1.0);
}

#[test]
fn curves_have_the_derivatives_of_their_places() {
    every(|cam, law, name| {
        for phi in [0.4, 1.3, 3.3, 4.0] {
            let (piece, _) = law.piece(phi, false);
            for away in [0.0, -0.01, 0.013] {
                let h = 1e-3;
                let p: Vec<_> =
                    [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| cam.curve(piece, phi + k * h, away)).into();
                for axis in 0..2 {
                    let at = |k: usize| p[k][0][axis];
                    // Differences of order 4: h⁴ and rounding ε/h balance at about 1e-12 of lengths below 0.2.
                    let first = (at(0) - 8.0 * at(1) + 8.0 * at(3) - at(4)) / (12.0 * h);
                    let second = (16.0 * (at(1) + at(3)) - at(0) - at(4) - 30.0 * at(2)) / (12.0 * h * h);
                    assert!((first - p[2][1][axis]).abs() < 1e-10, "{name} at {phi}, {away}");
                    assert!((second - p[2][2][axis]).abs() < 2e-8, "{name} at {phi}, {away}");
                }
            }
        }
    });
}

/// κ from the derivatives of the pitch curve, ρ from those of the profile: nothing of the envelope's formulas.
#[test]
fn bends_are_those_of_the_curves() {
    every(|cam, law, name| {
        for phi in [0.4, 1.3, 2.2, 3.3, 4.0, 5.0] {
            let (piece, _) = law.piece(phi, false);
            let [_, d1, d2] = cam.curve(piece, phi, 0.0);
            let cross = d1[0] * d2[1] - d1[1] * d2[0];
            // The profile runs backwards as the cam turns forwards.
            let curvature = -cam.sense * cross / d1[0].hypot(d1[1]).powi(3);
            let bend = cam.row(piece, phi)[BEND];
            let found = if cam.kind.is_roller() { bend } else { 1.0 / bend };
            assert!((curvature - found).abs() < 1e-11 * found.abs().max(1.0), "{name} at {phi}");
        }
    });
}

/// s = e (1 − cos φ) under a flat face without tilt.
#[test]
fn a_harmonic_law_makes_an_eccentric_circle() {
    let (e, r0) = (0.01, 0.03);
    let law = MotionLaw::new(vec![Piece {
        start: 0.0,
        length: TAU,
        polynomial: vec![e],
        harmonics: vec![[TAU, -e, 0.0]],
    }])
    .expect("a whole revolution");
    let unchanged =
        Dimensions { base_radius: r0, roller_radius: 0.0, offset: 0.0, distance: 0.0, arm: 0.0, tilt: 0.0 };
    for sense in [1.0, -1.0] {
        let shape: Shape = Cam::new(Kind::TranslatingFlat, sense, 1.0, unchanged).shape(&law, 360);
        for i in 0..shape.phi.len() {
            let away = (shape.rows[4][i] + e).hypot(shape.rows[5][i]);
            assert!((away - r0 - e).abs() < 2e-17, "{away} at {}", shape.phi[i]);
            assert!((shape.rows[BEND][i] - r0 - e).abs() < 3e-17, "ρ at {}", shape.phi[i]);
        }
    }
}

/// Columns for many cams of a kind, with one that cannot be.
fn columns(kind: Kind, n: usize) -> Vec<Vec<f64>> {
    let unchanged = size(kind);
    let vary = |x: f64, by: f64| (0..n).map(|i| x * (1.0 + by * (i as f64 * 0.7).sin())).collect::<Vec<_>>();
    let mut base = vary(unchanged.base_radius, 0.3);
    // Out of reach of the arm, inside the offset: no place, and so no number.
    base[3] = f64::NAN;
    vec![
        base,
        vary(unchanged.roller_radius, 0.5),
        vary(unchanged.offset, 1.0),
        vec![unchanged.distance],
        vary(unchanged.arm, 0.05),
        vec![unchanged.tilt],
        vary(1.0, 0.4),
    ]
}

fn searched(kind: Kind, columns: &[Vec<f64>], n: usize, threads: usize) -> Vec<f64> {
    let cams = Cams {
        kind,
        sense: 1.0,
        side: 1.0,
        size: Dimensions {
            base_radius: &columns[0],
            roller_radius: &columns[1],
            offset: &columns[2],
            distance: &columns[3],
            arm: &columns[4],
            tilt: &columns[5],
        },
        lift: &columns[6],
        n,
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let mut out = vec![0.0; n * RESULTS];
    pool.install(|| search(&law(lift(kind)), &cams, 180, &mut out));
    out
}

#[test]
fn searched_cams_are_the_scalar_ones_for_any_number_of_threads() {
    // More than two tasks, and not a whole number of lanes.
    let n = 603;
    for kind in KINDS {
        let columns = columns(kind, n);
        let found = searched(kind, &columns, n, 1);
        let again = searched(kind, &columns, n, 2);
        assert!(found.iter().zip(&again).all(|(a, b)| a.to_bits() == b.to_bits()), "{kind:?}: threads");
        for i in 0..n {
            let of = |k: usize| if columns[k].len() == 1 { columns[k][0] } else { columns[k][i] };
            let size = Dimensions {
                base_radius: of(0),
                roller_radius: of(1),
                offset: of(2),
                distance: of(3),
                arm: of(4),
                tilt: of(5),
            };
            let here = &found[i * RESULTS..(i + 1) * RESULTS];
            if i == 3 {
                assert!(here.iter().all(|x| x.is_nan()), "{kind:?}: no number without a place");
                continue;
            }
            let shape = Cam::new(kind, 1.0, 1.0, size).shape(&law(lift(kind) * of(6)), 180);
            let most = |row: usize| shape.rows[row].iter().copied().fold(f64::MIN, f64::max);
            let least = |row: usize| shape.rows[row].iter().copied().fold(f64::MAX, f64::min);
            let lead = shape.rows[8].iter().map(|g| g.tan().abs()).fold(0.0, f64::max);
            let wanted = [lead, least(SOUNDNESS), most(BEND), least(BEND)];
            for (k, (a, b)) in here.iter().zip(wanted).enumerate() {
                // The lift is scaled after its evaluation here and before it there.
                assert!((a - b).abs() < 1e-12 * b.abs().max(1e-3), "{kind:?} {i}, {k}: {a} for {b}");
            }
        }
    }
}
