//! Knives of toppers against closed forms, and the ways of the kernel against each other.

use linkwright_kernel::lanes::{Job, scalar};
use linkwright_kernel::motion_law::{MotionLaw, Piece};
use linkwright_kernel::real::Real;
use linkwright_topper::heads::{Heads, RESULTS, cover};
use linkwright_topper::knife::{Head, Knife, Law};
use linkwright_topper::needed::{Stations, needed};
use linkwright_topper::retreat;
use std::f64::consts::{PI, TAU};

const ANGLE: f64 = 0.35;
const FORWARD: f64 = 1.9;

/// A sine of stroke 0.06 m, its mean speed 0.55 m/s; harmonics beyond the first are small but there.
fn harmonic() -> Knife {
    let rate = PI * 0.55 / 0.06;
    let law = Law::Harmonics(vec![[0.0, 0.0], [0.0, 0.03], [0.002, -0.001], [0.0, 0.0005]]);
    let knife = Knife {
        law,
        corners: vec![],
        direction: ANGLE.sin_cos().into(),
        forward: FORWARD,
        rate,
        drift: 0.0,
        reach: 0.04,
        speeds: [-1.2, 1.2],
    };
    assert!(!knife.retreats(), "an edge that goes on");
    knife
}

/// The same speed in both directions.
fn to_and_fro(stroke: f64, speed: f64, angle: f64) -> Knife {
    let half = 0.5 * stroke;
    let piece = |start, length, polynomial| Piece { start, length, polynomial, harmonics: vec![] };
    let law = MotionLaw::new(vec![
        piece(0.0, 0.5 * PI, vec![0.0, half]),
        piece(0.5 * PI, PI, vec![half, -stroke]),
        piece(1.5 * PI, 0.5 * PI, vec![-half, half]),
    ]);
    Knife {
        law: Law::Pieces(law.expect("a whole revolution")),
        corners: vec![0.5 * PI, 1.5 * PI],
        direction: angle.sin_cos().into(),
        forward: FORWARD,
        rate: PI * speed / stroke,
        drift: 0.0,
        reach: half,
        speeds: [-speed, speed],
    }
}

/// A knife that does not turn back.
fn one_way(drift: f64, angle: f64) -> Knife {
    let law = Law::Harmonics(vec![[0.0, 0.0]]);
    let speeds = [drift; 2];
    Knife {
        law,
        corners: vec![],
        direction: angle.sin_cos().into(),
        forward: FORWARD,
        rate: 0.0,
        drift,
        reach: 0.0,
        speeds,
    }
}

/// Heads of several sizes, places and phases.
fn field(n: usize) -> [Vec<f64>; 3] {
    let spread = |k: usize, step: f64| (k as f64 * step).fract();
    [
        (0..n).map(|k| 0.03 + 0.03 * spread(k, 0.618_034)).collect(),
        (0..n).map(|k| 0.05 * (spread(k, 0.414_214) - 0.5)).collect(),
        (0..n).map(|k| TAU * spread(k, 0.732_051)).collect(),
    ]
}

fn covered(knife: &Knife, columns: &[Vec<f64>; 3], length: Option<f64>, fine: usize) -> Vec<[f64; RESULTS]> {
    let n = columns.iter().map(Vec::len).max().unwrap_or(0);
    let mut out: [Vec<f64>; RESULTS] = std::array::from_fn(|_| vec![0.0; n]);
    let heads = Heads { radius: &columns[0], offset: &columns[1], phase: &columns[2], n };
    cover(knife, &heads, length, fine, out.each_mut().map(Vec::as_mut_slice));
    (0..n).map(|k| out.each_ref().map(|column| column[k])).collect()
}

/// Area of a disc beyond a line at a distance from its centre.
fn segment(r: f64, distance: f64) -> f64 {
    let h = distance.clamp(-r, r);
    r * r * (h / r).acos() - h * (r * r - h * h).sqrt()
}

#[test]
fn a_steady_knife_needs_its_band() {
    for (drift, angle) in [(0.55, ANGLE), (-0.55, ANGLE), (0.8, -0.9), (0.0, 0.0), (0.3, 1.2)] {
        let (r, delta, length) = (0.049, 0.02, 0.12);
        let found = covered(&one_way(drift, angle), &[vec![r], vec![delta], vec![0.0]], Some(length), 32)[0];
        let speed = FORWARD.hypot(drift);
        let advance = (FORWARD * angle.cos() - drift * angle.sin()).abs();
        // The centre stands δ v/u beside the middle of the band, whose width is L (v cos α − w sin α)/u.
        let beside = delta * FORWARD / speed;
        let wanted = 2.0 * (r + beside) * speed / advance;
        assert!((found[0] - wanted).abs() < 1e-14, "w = {drift}, α = {angle}: {} for {wanted}", found[0]);
        let half = 0.5 * length * advance / speed;
        let areas = [segment(r, half + beside), segment(r, half - beside)];
        for (area, wanted) in found[3..5].iter().zip(areas) {
            assert!(
                (area - wanted).abs() < 1e-11 * r * r,
                "w = {drift}, α = {angle}: {area:e} for {wanted:e}"
            );
        }
        assert_eq!(found[5], 0.0, "one pass has nothing between");
    }
}

#[test]
fn the_worst_phase_needs_stroke_and_band() {
    let (r, delta, stroke) = (0.049, 0.02, 0.06);
    for knife in [to_and_fro(stroke, 0.55, ANGLE), to_and_fro(stroke, 0.8, -0.6)] {
        let phases: Vec<f64> = (0..3600).map(|k| TAU * f64::from(k) / 3600.0).collect();
        let found = covered(&knife, &[vec![r], vec![delta], phases], None, 32);
        let most = found.iter().map(|row| row[0]).fold(0.0, f64::max);
        let wanted = (stroke + 2.0 * r + 2.0 * delta) / knife.direction[1];
        // A phase beside the worst: the knife goes on with 0.8 m/s for no more than half a step.
        let step = 0.8 * 0.5 * (TAU / 3600.0) / knife.rate;
        assert!(most <= wanted + 1e-14 && most > wanted - 4.0 * step, "{most} for {wanted}");
    }
}

#[test]
fn the_point_reached_last_is_on_the_rim_and_asks_for_the_length() {
    let knife = harmonic();
    let columns = field(200);
    for (k, row) in covered(&knife, &columns, None, 64).iter().enumerate() {
        let [needed, x, y, ..] = *row;
        assert!((x.hypot(y) - columns[0][k]).abs() < 1e-12, "head {k}: on the rim");
        // When the edge's line passes the point, the point lies half the length from its middle.
        let head = Head { radius: columns[0][k], offset: columns[1][k], phase: columns[2][k] };
        let [sin, cos] = knife.direction;
        let t = knife.time(&head, x * cos - y * sin);
        let away = (x * sin + y * cos - knife.place(&head, t).q[0]).abs();
        assert!((away - 0.5 * needed).abs() < 1e-12, "head {k}: {away} for {}", 0.5 * needed);
    }
}

/// One head after the other, without lanes.
struct OneByOne<'a>(&'a Knife, &'a [Vec<f64>; 3], usize);
impl Job for OneByOne<'_> {
    type Output = f64;
    fn run<R: Real>(self) -> f64 {
        let Self(knife, columns, k) = self;
        let [radius, offset, phase] = [0, 1, 2].map(|c: usize| R::splat(columns[c][k]));
        let head = Head { radius, offset, phase };
        let window = [knife.time(&head, -radius), knife.time(&head, radius)];
        let stations = Stations::new(48);
        let mut rows = vec![[R::splat(0.0); 2]; stations.turns.len()];
        let found = needed(knife, &head, window, knife.turns(0.2), &stations, &mut rows);
        2.0 * found.half.max_lane()
    }
}

#[test]
fn lanes_are_the_scalar_truth() {
    let columns = field(37);
    for knife in [harmonic(), to_and_fro(0.06, 0.55, ANGLE)] {
        let lanes = covered(&knife, &columns, None, 48);
        for (k, row) in lanes.iter().enumerate() {
            let one = scalar(OneByOne(&knife, &columns, k));
            assert!((row[0] - one).abs() < 1e-12, "head {k}: {} for {one}", row[0]);
        }
    }
}

/// Chord by chord with all crossings of each, as for an edge that runs backwards: nothing is shared but the place.
#[test]
fn chords_one_by_one_say_the_same() {
    let columns = field(24);
    let (length, stations) = (0.11, Stations::new(96));
    for knife in [harmonic(), to_and_fro(0.06, 0.55, ANGLE), to_and_fro(0.02, 0.8, 0.5)] {
        for (k, row) in covered(&knife, &columns, Some(length), 64).iter().enumerate() {
            let head = Head { radius: columns[0][k], offset: columns[1][k], phase: columns[2][k] };
            let left = retreat::cover(&knife, &head, Some(0.5 * length), &stations);
            assert!((row[0] - 2.0 * left.half).abs() < 1e-9, "head {k}: {} for {}", row[0], 2.0 * left.half);
            let disc = PI * head.radius * head.radius;
            for (area, wanted) in row[3..].iter().zip(left.area) {
                // What kinks leave inside a panel of the chords.
                assert!((area - wanted).abs() < 1e-5 * disc, "head {k}: {area:e} for {wanted:e}");
            }
        }
    }
}

#[test]
fn a_knife_at_rest_leaves_segments() {
    let (r, delta, length) = (0.05, 0.013, 0.09);
    let found = covered(&one_way(0.0, 0.0), &[vec![r], vec![delta], vec![0.0]], Some(length), 32)[0];
    assert!((found[0] - 2.0 * (r + delta)).abs() < 1e-15, "needs twice the way to its far side");
    assert!((found[4] - segment(r, 0.5 * length - delta)).abs() < 1e-12 * r * r, "left, where the head lies");
    assert!((found[3] - segment(r, 0.5 * length + delta)).abs() < 1e-12 * r * r, "right");
}

#[test]
fn an_edge_along_its_own_way_that_turns_back_cuts_from_both_sides() {
    // Beyond v = v_h tan α the edge runs backwards in one sense of the knife; it still passes every chord.
    let knife = to_and_fro(0.06, 0.8, 1.3);
    assert!(knife.retreats(), "0.8 tan 1.3 > 1.9");
    let columns = [vec![0.049], vec![0.0], (0..40).map(|k| TAU * f64::from(k) / 40.0).collect()];
    let most = covered(&knife, &columns, Some(5.0), 64);
    for row in &most {
        assert!(row[0] <= (0.06 + 0.098) / 1.3_f64.cos() + 1e-12, "no more than without a second pass");
        assert_eq!(row[3..], [0.0; 3], "a long edge leaves nothing");
    }
}
