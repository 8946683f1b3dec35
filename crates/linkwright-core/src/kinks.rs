//! Where over the turn the reduced machine is not smooth: dead centres under dry friction, knots of tables.
//!
//! A dry resistance enters the energy equation as F·|s′|, which has a kink where the slide turns back
//! (s′ = 0); a table has one at each knot. Between these angles everything is smooth, so a method of high
//! order keeps its order when it goes from kink to kink.

use crate::cycle::Machine;
use crate::linkage::Motion;
use crate::plan::Plan;
use crate::plane::Angle;
use crate::real::Real;
use crate::reduce::Load;
use std::f64::consts::TAU;

/// A quantity whose zeros over the turn are kinks.
#[derive(Clone, Copy, Debug)]
enum Watch {
    /// The slide turns back.
    SlideTurns(usize),
    /// The link turns back.
    LinkTurns(usize),
    /// The slide passes a knot of a table.
    SlideAt(usize, f64),
}

/// Angles at which zeros are looked for. Two zeros between neighbours go unseen: that costs accuracy:
/// the comparison of meshes may then err by some tens of times the accuracy asked for.
const SCAN: usize = 48;

/// Share of a scan interval by which the scan is shifted, so that the round angles at which dead centres
/// tend to lie (0°, 90°, …) fall inside intervals.
const SHIFT: f64 = 0.37;

/// Zeros closer than this \[rad\] to the end of the turn count as its start: rounding must not decide.
const WRAP: f64 = 1e-7;

impl Plan {
    fn watches(&self) -> Vec<Watch> {
        let mut watches = Vec::new();
        for load in &self.loads {
            match *load {
                Load::DrySlide { slide, .. } => watches.push(Watch::SlideTurns(slide)),
                Load::DryLink { link, .. } => watches.push(Watch::LinkTurns(link)),
                Load::DryPoint { point, .. } => {
                    watches.extend(self.mechanism.arm_of(point).map(Watch::LinkTurns));
                }
                Load::ForcePosition { slide, forward, back } => {
                    watches.push(Watch::SlideTurns(slide));
                    let knots = self.tables[forward].knots().iter().chain(self.tables[back].knots());
                    watches.extend(knots.map(|&knot| Watch::SlideAt(slide, knot)));
                }
                _ => {}
            }
        }
        watches
    }

    fn angle_knots(&self) -> impl Iterator<Item = f64> + '_ {
        self.loads
            .iter()
            .filter_map(|load| match *load {
                Load::TorqueAngle { table } => Some(self.tables[table].knots()),
                _ => None,
            })
            .flatten()
            .map(|knot| knot.rem_euclid(TAU))
    }
}

/// The watched quantity and its derivative by φ.
#[inline(always)]
fn watched<R: Real>(watch: Watch, m: &Motion<R>) -> (R, R) {
    match watch {
        Watch::SlideTurns(slide) => (m.slides[slide].d1, m.slides[slide].d2),
        Watch::LinkTurns(link) => (m.links[link].d1, m.links[link].d2),
        Watch::SlideAt(slide, knot) => (m.slides[slide].s - R::splat(knot), m.slides[slide].d1),
    }
}

impl<R: Real> Machine<'_, R> {
    /// Ends of the smooth pieces of the turn: increasing from 0 to 2π, as many in every lane (a lane with
    /// fewer kinks repeats 2π).
    #[inline(always)]
    pub fn breaks(&self, m: &mut Motion<R>) -> Vec<R> {
        let mut lanes: Vec<Vec<f64>> = vec![vec![0.0]; R::LANES];
        let watches = self.plan.watches();
        if !watches.is_empty() {
            let scan = R::outline(
                #[inline(always)]
                || self.scan(&watches, m),
            );
            for (watch, values) in watches.iter().zip(scan.chunks_exact(SCAN * R::LANES)) {
                self.zeros(*watch, values, &mut lanes, m);
            }
        }
        for lane in &mut lanes {
            lane.extend(self.plan.angle_knots());
            for angle in lane.iter_mut() {
                *angle = if *angle > TAU - WRAP { 0.0 } else { *angle };
            }
            lane.sort_by(f64::total_cmp);
        }
        level(lanes)
    }

    /// All watched quantities over the scan angles: watch by watch, angle by angle, lane by lane.
    #[inline(always)]
    fn scan(&self, watches: &[Watch], m: &mut Motion<R>) -> Vec<f64> {
        let mut values = vec![0.0; watches.len() * SCAN * R::LANES];
        for i in 0..SCAN {
            self.plan.mechanism.place::<R, 1>(self.q, Angle::new(R::splat(scan_angle(i))), m);
            for (w, watch) in watches.iter().enumerate() {
                watched(*watch, m).0.store(&mut values[(w * SCAN + i) * R::LANES..]);
            }
        }
        values
    }

    /// Adds the zeros of one watched quantity to each lane's list.
    #[inline(always)]
    fn zeros(&self, watch: Watch, values: &[f64], lanes: &mut [Vec<f64>], m: &mut Motion<R>) {
        let at = |i: usize, lane: usize| values[(i % SCAN) * R::LANES + lane];
        let brackets: Vec<Vec<usize>> = (0..R::LANES)
            .map(|lane| (0..SCAN).filter(|&i| at(i, lane) * at(i + 1, lane) < 0.0).collect())
            .collect();
        let most = brackets.iter().map(Vec::len).max().unwrap_or(0);
        let mut low = vec![0.0; R::LANES];
        let mut guess = vec![0.0; R::LANES];
        for nth in 0..most {
            for lane in 0..R::LANES {
                if let Some(&i) = brackets[lane].get(nth) {
                    let (a, b) = (at(i, lane), at(i + 1, lane));
                    low[lane] = scan_angle(i);
                    guess[lane] = low[lane] + a / (a - b) * TAU / SCAN as f64;
                }
            }
            let root = R::outline(
                #[inline(always)]
                || self.polish(watch, R::load(&low), R::load(&guess), m),
            );
            root.store(&mut guess);
            for lane in 0..R::LANES {
                if brackets[lane].len() > nth && guess[lane].is_finite() {
                    lanes[lane].push(guess[lane].rem_euclid(TAU));
                }
            }
        }
    }

    /// Newton from a linear guess, kept inside the bracket.
    #[inline(always)]
    fn polish(&self, watch: Watch, low: R, guess: R, m: &mut Motion<R>) -> R {
        let high = low + TAU / SCAN as f64;
        let mut phi = guess;
        // The guess is good to (2π/48)² ~ 1e-2; Newton squares it: 1e-4, 1e-8, 1e-16.
        for _ in 0..4 {
            self.plan.mechanism.place::<R, 2>(self.q, Angle::new(phi), m);
            let (value, slope) = watched(watch, m);
            phi = (phi - value / slope).max(low).min(high);
        }
        phi
    }
}

/// Ends of the smooth pieces of one machine's turn \[rad\].
pub fn kinks(plan: &Plan, q: &[f64]) -> Vec<f64> {
    Machine { plan, q }.breaks(&mut Motion::new(&plan.mechanism, q))
}

fn scan_angle(i: usize) -> f64 {
    (i as f64 + SHIFT) * TAU / SCAN as f64
}

/// Turns lists by lane into lanes by list, each filled up with 2π.
fn level<R: Real>(lanes: Vec<Vec<f64>>) -> Vec<R> {
    let most = lanes.iter().map(Vec::len).max().unwrap_or(1);
    let mut row = vec![0.0; R::LANES];
    (0..=most)
        .map(|k| {
            for (slot, lane) in row.iter_mut().zip(&lanes) {
                *slot = lane.get(k).copied().unwrap_or(TAU);
            }
            R::load(&row)
        })
        .collect()
}
