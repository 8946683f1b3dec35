//! Where over the turn the reduced machine is not smooth: dead centres under dry friction, knots of tables.
//!
//! A dry resistance enters the energy equation as F·|s′|, which has a kink where the slide turns back
//! (s′ = 0); a table has one at each knot; a formula where the argument of `abs`, `sign`, `step`, `min`,
//! `max` or `where` changes sign. Between these angles everything is smooth, so a method of high
//! order keeps its order when it goes from kink to kink.

use crate::drive::cycle::Machine;
use crate::drive::loads::{ForceElement, FormulaLoad, Law, Load};
use crate::drive::structure::Plan;
use crate::kernel::formula::Degree;
use crate::kernel::plane::Angle;
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use crate::linkage::mechanism::Element;
use crate::linkage::motion::{Motion, stretch};
use std::f64::consts::TAU;

/// A quantity whose zeros over the turn are kinks.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Watch {
    /// The slide turns back.
    SlideTurns(usize),
    /// The link turns back.
    LinkTurns(usize),
    /// The point comes to rest, on whatever path.
    PointRests(usize),
    /// The slide passes a knot of a table.
    SlideAt(usize, f64),
    /// Two points stop parting or nearing each other.
    StretchTurns(usize, usize),
    /// The distance of two points passes a knot of a table.
    StretchAt(usize, usize, f64),
    /// A spring of this free length passes, or nearly passes, through its own anchor.
    Anchor(usize, usize, Slot),
    /// A switch of a formula.
    Switch(FormulaLoad, usize),
}

/// A spring that gets shorter than this share of its free length turns round so fast that it counts as a
/// kink.
const SHORT: f64 = 0.1;

/// A point rests where its path speed p′ falls below this share of p″.
const AT_REST: f64 = 1e-6;

/// Angles at which zeros are looked for. Two zeros between neighbours go unseen: that costs accuracy:
/// the comparison of meshes may then err by some tens of times the accuracy asked for.
const SCAN: usize = 48;

/// Share of a scan interval by which the scan is shifted, so that the round angles at which dead centres
/// tend to lie (0°, 90°, …) fall inside intervals.
const SHIFT: f64 = 0.37;

/// Zeros closer than this \[rad\] to the end of the turn count as its start: rounding must not decide.
const WRAP: f64 = 1e-7;

impl Plan {
    /// All quantities to be watched, each once: two loads may ask for the same.
    fn watches(&self) -> Vec<Watch> {
        let mut watches = Vec::new();
        for watch in self.all_watches() {
            if !watches.contains(&watch) {
                watches.push(watch);
            }
        }
        watches
    }

    fn all_watches(&self) -> Vec<Watch> {
        let mut watches = Vec::new();
        let switches = self.still_switches().into_iter();
        watches.extend(switches.map(|(load, at)| Watch::Switch(load, at)));
        for law in &self.laws {
            if let Law::Damper { from, to, .. } = *law {
                watches.push(Watch::StretchTurns(from, to));
            }
        }
        for load in &self.force_elements {
            if let ForceElement::SpringTable { from, to, table } = *load {
                let knots = self.tables[table].knots().iter();
                watches.extend(knots.map(|&knot| Watch::StretchAt(from, to, knot)));
            }
        }
        for load in &self.loads {
            match *load {
                Load::Spring { from, to, free_length, .. } => {
                    watches.push(Watch::Anchor(from, to, free_length));
                }
                Load::DrySlide { slide, .. } => watches.push(Watch::SlideTurns(slide)),
                Load::DryLink { link, .. } => watches.push(Watch::LinkTurns(link)),
                Load::DryPoint { point, .. } => {
                    watches.push(Watch::PointRests(point));
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

    /// Formulas in all loads with the switches whose zeros are crank angles that no speed moves.
    fn still_switches(&self) -> Vec<(FormulaLoad, usize)> {
        let in_laws = self.laws.iter().filter_map(|law| match law {
            Law::Formula(load) => Some(*load),
            Law::Damper { .. } => None,
        });
        let mut found = Vec::new();
        for load in self.formula_loads().chain(in_laws) {
            let switches = &self.formulas[load.formula].switches;
            found.extend(switches.iter().filter(|s| s.degree != Degree::Mixed).map(|s| (load, s.at)));
        }
        found
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

/// ½ d(L²)/dφ of the distance L of two points, and its derivative.
#[inline(always)]
fn stretch_turns<R: Real>(from: usize, to: usize, m: &Motion<R>) -> (R, R) {
    let (a, b) = (&m.points[from], &m.points[to]);
    let (u, u1, u2) = (b.p - a.p, b.d1 - a.d1, b.d2 - a.d2);
    (u.dot(u1), u1.dot(u1) + u.dot(u2))
}

impl<R: Real> Machine<'_, R> {
    /// The watched quantity and its derivative by φ.
    #[inline(always)]
    fn watched(&self, watch: Watch, phi: R, m: &Motion<R>) -> (R, R) {
        match watch {
            Watch::SlideTurns(slide) => (m.slides[slide].d1, m.slides[slide].d2),
            Watch::LinkTurns(link) => (m.links[link].d1, m.links[link].d2),
            Watch::PointRests(point) => {
                let place = &m.points[point];
                // ½ d|p′|²/dφ; where the point rests p′·p‴ is none of its slope.
                (place.d1.dot(place.d2), place.d2.dot(place.d2))
            }
            Watch::SlideAt(slide, knot) => (m.slides[slide].s - R::splat(knot), m.slides[slide].d1),
            Watch::StretchTurns(from, to) | Watch::Anchor(from, to, _) => stretch_turns(from, to, m),
            Watch::StretchAt(from, to, knot) => {
                let (length, length1) = stretch(m, from, to);
                (length - R::splat(knot), length1)
            }
            Watch::Switch(load, at) => self.plan.switch_over_angle((load, at), self.q, phi, m),
        }
    }

    /// Ends of the smooth pieces of the turn of each lane: increasing from 0 to 2π.
    #[inline(always)]
    pub fn breaks(&self, m: &mut Motion<R>) -> Vec<Vec<f64>> {
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
        self.programme_joints(&mut lanes);
        for lane in &mut lanes {
            lane.extend(self.plan.angle_knots());
            for angle in lane.iter_mut() {
                *angle = if *angle > TAU - WRAP { 0.0 } else { *angle };
            }
            lane.push(TAU);
            lane.sort_by(f64::total_cmp);
            lane.dedup();
        }
        lanes
    }

    /// Adds the joints of motion laws in pieces, where a derivative jumps.
    #[inline(always)]
    fn programme_joints(&self, lanes: &mut [Vec<f64>]) {
        let mut row = vec![0.0; R::LANES];
        for element in &self.plan.mechanism.elements {
            let Element::Programme(programme) = element else { continue };
            for piece in programme.law.pieces() {
                (self.q[programme.phase] + piece.start).store(&mut row);
                for (lane, joint) in lanes.iter_mut().zip(&row) {
                    lane.push(joint.rem_euclid(TAU));
                }
            }
        }
    }

    /// All watched quantities over the scan angles: watch by watch, angle by angle, lane by lane.
    #[inline(always)]
    fn scan(&self, watches: &[Watch], m: &mut Motion<R>) -> Vec<f64> {
        let mut values = vec![0.0; watches.len() * SCAN * R::LANES];
        for i in 0..SCAN {
            let phi = R::splat(scan_angle(i));
            self.plan.mechanism.place::<R, 2>(self.q, Angle::new(phi), m);
            for (w, watch) in watches.iter().enumerate() {
                self.watched(*watch, phi, m).0.store(&mut values[(w * SCAN + i) * R::LANES..]);
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
            let (value, slope) = self.watched(watch, phi, m);
            phi = (phi - value / slope).max(low).min(high);
        }
        if let Watch::Anchor(from, to, free_length) = watch {
            // Where the spring stays long its extremes are smooth: no break there.
            let length = stretch(m, from, to).0;
            phi = length.select_lt(self.q[free_length] * SHORT, phi, R::splat(f64::NAN));
        }
        if let Watch::PointRests(point) = watch {
            // Elsewhere the path speed has an extreme only.
            let place = &m.points[point];
            let (speed, bend) = (place.d1.dot(place.d1), place.d2.dot(place.d2));
            phi = speed.select_lt(bend * (AT_REST * AT_REST), phi, R::splat(f64::NAN));
        }
        phi
    }
}

/// Ends of the smooth pieces of one machine's turn \[rad\].
pub fn kinks(plan: &Plan, q: &[f64]) -> Vec<f64> {
    Machine { plan, q }.breaks(&mut Motion::new(&plan.mechanism, q)).swap_remove(0)
}

fn scan_angle(i: usize) -> f64 {
    (i as f64 + SHIFT) * TAU / SCAN as f64
}
