//! A group that does not split into dyads: its joints are found together by Newton's method.
//!
//! Unknown are the coordinates of n joints. Points fixed to bars of the group are combinations of their ends,
//! `K = A + (α + iβ)(B − A)` in the complex plane, so every point is linear in the unknowns. Each condition
//! has the form **a·b = c**: a bar u·u = l², a guide n·(P − G) = offset, a cylinder u·u = L(φ)². One Jacobian serves
//! the position and all derivatives:
//!
//! ```text
//! F = a·b − c        J Δx = −F
//! F′ = a′·b + a·b′ − c′ = J x′ + (what moves without x)    J x′ = −F′ at x′ = 0
//! F″ = a″·b + 2a′·b′ + a·b″ − c″                          J x″ = −F″ at x″ = 0
//! ```
//!
//! Of a bar and a guide c is constant; of a cylinder c′ = 2LL′, c″ = 2(L′² + LL″).
//!
//! The start is read from a table over the crank angle that was made by following the motion
//! ([`super::trace`]): so the group stays on its branch however it is asked. Linear equations are solved by
//! orthogonalisation, which needs no exchange of rows and so is the same in every lane.
//!
//! Source: natural coordinates, e.g. García de Jalón and Bayo, *Kinematic and Dynamic Simulation of
//! Multibody Systems*, chapter 2.

use super::guided::{Line, bar};
use super::motion::Motion;
use crate::kernel::out_of_line;
use crate::kernel::plane::{Angle, Place, Vec2};
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;
use crate::kernel::table::Table;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A point fixed to a bar of the group: `along`, `across` in lengths of the bar.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct BarPoint {
    pub point: usize,
    pub from: usize,
    pub to: usize,
    pub along: Slot,
    pub across: Slot,
}

/// A link between two points of the group.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Bar {
    pub link: usize,
    pub from: usize,
    pub to: usize,
    /// 1/length.
    pub inverse_length: Slot,
}

/// One equation.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub enum Condition {
    /// Two points at a distance.
    Distance { from: usize, to: usize, length: Slot },
    /// Two points at a distance that is a coordinate known before: the length of a cylinder.
    Length { from: usize, to: usize, slide: usize },
    /// A point on a guide that turns with a link known before.
    OnLine { point: usize, line: Line, slide: usize },
    /// A point on a guide fixed to a bar of the group, which runs from `from` to `to`.
    OnBar { point: usize, line: Line, slide: usize, bar: Bar },
}

/// The group.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Group {
    pub unknowns: Vec<usize>,
    pub bar_points: Vec<BarPoint>,
    pub bars: Vec<Bar>,
    pub conditions: Vec<Condition>,
    pub gap: usize,
    /// Where to start, x and y of each unknown over φ·`inverse_turns`.
    pub starts: Vec<Table>,
    /// One over the revolutions of the crank after which the motion repeats.
    pub inverse_turns: Slot,
    /// Whether the tables repeat; otherwise the group moves from their first knot to their last.
    pub repeats: bool,
}

// Pieces that are used more than once are functions of their own (`R::out_of_line`).

/// Newton rounds at most: from the table some three are needed; more when the lengths of a row of a batch
/// differ from those that the table was made for.
const ROUNDS_MAX: usize = 12;

/// Correction in lengths of the group's size at which Newton has converged: squared, it is below rounding.
const CONVERGED: f64 = 1e-9;

/// The two factors of a condition and which points they depend on.
struct Factors<R> {
    a: [Vec2<R>; 3],
    b: [Vec2<R>; 3],
    /// c with two derivatives.
    c: [R; 3],
}

impl<R: Real> Factors<R> {
    /// F at the present position.
    #[inline(always)]
    fn value(&self) -> R {
        self.a[0].dot(self.b[0]) - self.c[0]
    }
}

impl Group {
    /// Rows of the linear system: as many as unknown coordinates.
    fn size(&self) -> usize {
        2 * self.unknowns.len()
    }

    /// Places joints, carried points and bars, from the table of starts.
    #[inline(always)]
    pub(super) fn place<R: Real, const ORDER: u8>(&self, q: &[R], angle: Angle<R>, m: &mut Motion<R>) {
        let share = angle.phi * q[self.inverse_turns];
        let knots = self.starts.first().map_or(&[0.0][..], Table::knots);
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let share = share.map(|x| (first + (x - first).rem_euclid(TAU), 1.0));
        for (k, &unknown) in self.unknowns.iter().enumerate() {
            let (x, y) = (&self.starts[2 * k], &self.starts[2 * k + 1]);
            let start =
                Vec2::new(share.map(|phi| x.periodic(phi, TAU)), share.map(|phi| y.periodic(phi, TAU)));
            m.points[unknown] = Place::fixed(start);
        }
        self.solve::<R, ORDER>(q, m);
        if !self.repeats {
            let gap = m.gaps[self.gap];
            m.gaps[self.gap] = R::splat(last).select_lt(share, R::splat(-1.0), gap);
        }
        self.poison(m);
    }

    /// Where the group does not close, what it places is NaN as with any dyad.
    #[inline(always)]
    fn poison<R: Real>(&self, m: &mut Motion<R>) {
        let zero = R::splat(0.0);
        let mask = m.gaps[self.gap].select_lt(zero, R::splat(f64::NAN), zero);
        let mask = Vec2::new(mask, mask);
        let bar_points = self.bar_points.iter().map(|each| each.point);
        for point in self.unknowns.iter().copied().chain(bar_points) {
            let place = &mut m.points[point];
            (place.p, place.d1, place.d2) = (place.p + mask, place.d1 + mask, place.d2 + mask);
        }
        for each in &self.bars {
            let link = &mut m.links[each.link];
            (link.e, link.d1, link.d2) = (link.e + mask, link.d1 + mask.x, link.d2 + mask.x);
        }
    }

    /// Newton from where the unknowns are, then the derivatives.
    #[inline(always)]
    pub(super) fn solve<R: Real, const ORDER: u8>(&self, q: &[R], m: &mut Motion<R>) {
        let n = self.size();
        let mut system = System::new(n, self.bar_points.len());
        let (zero, mut rounds_left) = (R::splat(0.0), R::ROUNDS);
        // 1 in lanes that have not converged. The others keep what they have: no lane's bits depend on how long another
        // takes. Numbers with derivatives go on together until those have converged too.
        let mut moves = R::splat(1.0);
        for _ in 0..ROUNDS_MAX {
            self.carry::<R, 0>(q, m);
            self.linearise(q, m, &mut system);
            for (row, condition) in self.conditions.iter().enumerate() {
                system.rhs[row] = -self.factors(condition, q, m).value();
            }
            system.factorise();
            system.solve();
            let mut largest = zero;
            for (k, &unknown) in self.unknowns.iter().enumerate() {
                let mut step = Vec2::new(system.rhs[2 * k], system.rhs[2 * k + 1]);
                if R::ROUNDS == 0 {
                    step.x = zero.select_lt(moves, step.x, zero);
                    step.y = zero.select_lt(moves, step.y, zero);
                }
                m.points[unknown].p = m.points[unknown].p + step;
                largest = largest.max(step.x.abs()).max(step.y.abs());
            }
            // A length of the group as its scale; a NaN is not below the limit.
            moves = largest.select_lt(self.scale(q, m) * CONVERGED, zero, moves);
            if moves.max_lane() <= 0.0 {
                if rounds_left == 0 {
                    break;
                }
                rounds_left -= 1;
            }
        }
        self.finish::<R, ORDER>(q, m, &mut system);
    }

    /// Derivatives at the position found, bars, and the closure measure.
    #[inline(always)]
    fn finish<R: Real, const ORDER: u8>(&self, q: &[R], m: &mut Motion<R>, system: &mut System<R>) {
        out_of_line!(R, {
            self.carry::<R, 0>(q, m);
            self.linearise(q, m, system);
            system.factorise();
            let mut residual = R::splat(0.0);
            for condition in &self.conditions {
                residual = residual.max(self.factors(condition, q, m).value().abs());
            }
            for order in 1..=ORDER {
                for &unknown in &self.unknowns {
                    let place = &mut m.points[unknown];
                    if order == 1 {
                        (place.d1, place.d2) = (Vec2::zero(), Vec2::zero());
                    } else {
                        place.d2 = Vec2::zero();
                    }
                }
                self.carry::<R, ORDER>(q, m);
                for (row, condition) in self.conditions.iter().enumerate() {
                    let f = self.factors(condition, q, m);
                    let [a, b] = [f.a, f.b];
                    system.rhs[row] = if order == 1 {
                        f.c[1] - (a[1].dot(b[0]) + a[0].dot(b[1]))
                    } else {
                        f.c[2] - (a[2].dot(b[0]) + a[1].dot(b[1]) * 2.0 + a[0].dot(b[2]))
                    };
                }
                system.solve();
                for (k, &unknown) in self.unknowns.iter().enumerate() {
                    let found = Vec2::new(system.rhs[2 * k], system.rhs[2 * k + 1]);
                    let place = &mut m.points[unknown];
                    if order == 1 {
                        place.d1 = found;
                    } else {
                        place.d2 = found;
                    }
                }
            }
            self.carry::<R, ORDER>(q, m);
            for each in &self.bars {
                let (from, to) = (m.points[each.from], m.points[each.to]);
                bar(m, each.link, &from, &to, q[each.inverse_length]);
            }
            self.slide(q, m);
            // Not converged: reported as not closing.
            let scale = self.scale(q, m);
            let open = (residual - scale.squared() * 1e-10).select_lt(
                R::splat(0.0),
                system.determinant().squared(),
                R::splat(-1.0),
            );
            m.gaps[self.gap] = residual.select_lt(R::splat(f64::INFINITY), open, R::splat(-1.0));
        })
    }

    /// The maximum of the given lengths, or one where there is none.
    pub(super) fn length_scale(&self, q: &[f64]) -> f64 {
        let lengths = self.conditions.iter().filter_map(|condition| match *condition {
            Condition::Distance { length, .. } => Some(q[length]),
            _ => None,
        });
        let most = lengths.fold(0.0, f64::max);
        if most > 0.0 { most } else { 1.0 }
    }

    /// A length of the group, at least the distance between two of its points.
    #[inline(always)]
    fn scale<R: Real>(&self, q: &[R], m: &Motion<R>) -> R {
        let mut scale = R::splat(0.0);
        for condition in &self.conditions {
            let length = match *condition {
                Condition::Distance { length, .. } => q[length],
                Condition::Length { slide, .. } => m.slides[slide].s.abs(),
                Condition::OnLine { point, line, .. } | Condition::OnBar { point, line, .. } => {
                    let u = m.points[point].p - m.points[line.through].p;
                    u.x.abs() + u.y.abs()
                }
            };
            scale = scale.max(length);
        }
        scale
    }

    /// Places the points carried by bars.
    #[inline(always)]
    fn carry<R: Real, const ORDER: u8>(&self, q: &[R], m: &mut Motion<R>) {
        for each in &self.bar_points {
            let (from, to) = (&m.points[each.from], &m.points[each.to]);
            let (along, across) = (q[each.along], q[each.across]);
            let p = combine(from.p, to.p, along, across);
            let (mut d1, mut d2) = (Vec2::zero(), Vec2::zero());
            if ORDER > 0 {
                d1 = combine(from.d1, to.d1, along, across);
            }
            if ORDER > 1 {
                d2 = combine(from.d2, to.d2, along, across);
            }
            m.points[each.point].set(p, d1, d2);
        }
    }

    /// Coordinates of points along their guides.
    #[inline(always)]
    fn slide<R: Real>(&self, q: &[R], m: &mut Motion<R>) {
        for condition in &self.conditions {
            let (Condition::OnLine { slide, .. } | Condition::OnBar { slide, .. }) = *condition else {
                continue;
            };
            let Factors { a: n, b: c, .. } = self.factors(condition, q, m);
            let mut s = [R::splat(0.0); 3];
            // t = −n⊥ with all its derivatives, s = t·c.
            let t =
                [n[0].left() * R::splat(-1.0), n[1].left() * R::splat(-1.0), n[2].left() * R::splat(-1.0)];
            s[0] = t[0].dot(c[0]);
            s[1] = t[1].dot(c[0]) + t[0].dot(c[1]);
            s[2] = t[2].dot(c[0]) + t[1].dot(c[1]) * 2.0 + t[0].dot(c[2]);
            m.slides[slide].set(s[0], s[1], s[2]);
        }
    }

    /// Both factors of a condition and their product, with two derivatives.
    #[inline(always)]
    fn factors<R: Real>(&self, condition: &Condition, q: &[R], m: &Motion<R>) -> Factors<R> {
        let zero = R::splat(0.0);
        out_of_line!(
            R,
            match *condition {
                Condition::Distance { from, to, length } => {
                    let u = between(&m.points[from], &m.points[to]);
                    Factors { a: u, b: u, c: [q[length].squared(), zero, zero] }
                }
                Condition::Length { from, to, slide } => {
                    let u = between(&m.points[from], &m.points[to]);
                    let length = &m.slides[slide];
                    let c1 = length.s * length.d1 * 2.0;
                    let c2 = (length.d1.squared() + length.s * length.d2) * 2.0;
                    Factors { a: u, b: u, c: [length.s.squared(), c1, c2] }
                }
                Condition::OnLine { point, line, .. } => {
                    let c = between(&m.points[line.through], &m.points[point]);
                    let link = &m.links[line.link];
                    let t = (link.e * q[line.cos]).plus(link.e.left(), q[line.sin]);
                    let n = t.left();
                    let n1 = t * -link.d1;
                    let n2 = (t * -link.d2).plus(n, -(link.d1.squared()));
                    Factors { a: [n, n1, n2], b: c, c: [q[line.offset], zero, zero] }
                }
                Condition::OnBar { point, line, bar, .. } => {
                    let c = between(&m.points[line.through], &m.points[point]);
                    let u = between(&m.points[bar.from], &m.points[bar.to]);
                    let (cos, sin) =
                        (q[line.cos] * q[bar.inverse_length], q[line.sin] * q[bar.inverse_length]);
                    let mut n = u;
                    for each in &mut n {
                        *each = (*each * cos).plus(each.left(), sin).left();
                    }
                    Factors { a: n, b: c, c: [q[line.offset], zero, zero] }
                }
            }
        )
    }

    /// The Jacobian: for each condition its gradient by the points it depends on, carried to the unknowns.
    #[inline(always)]
    fn linearise<R: Real>(&self, q: &[R], m: &Motion<R>, system: &mut System<R>) {
        out_of_line!(R, {
            system.clear();
            for (row, condition) in self.conditions.iter().enumerate() {
                let Factors { a, b, .. } = self.factors(condition, q, m);
                let minus = R::splat(-1.0);
                match *condition {
                    Condition::Distance { from, to, .. } | Condition::Length { from, to, .. } => {
                        self.spread(to, a[0] * R::splat(2.0), row, system);
                        self.spread(from, a[0] * R::splat(-2.0), row, system);
                    }
                    Condition::OnLine { point, line, .. } => {
                        self.spread(point, a[0], row, system);
                        self.spread(line.through, a[0] * minus, row, system);
                    }
                    Condition::OnBar { point, line, bar, .. } => {
                        self.spread(point, a[0], row, system);
                        self.spread(line.through, a[0] * minus, row, system);
                        // n·c by u: n = Z u with Z a rotation and a factor, so Zᵀ c.
                        let (cos, sin) =
                            (q[line.cos] * q[bar.inverse_length], q[line.sin] * q[bar.inverse_length]);
                        let back = b[0].left() * minus;
                        let by_u = (back * cos).plus(back.left(), -sin);
                        self.spread(bar.to, by_u, row, system);
                        self.spread(bar.from, by_u * minus, row, system);
                    }
                }
                self.hand_on(row, q, system);
            }
        })
    }

    /// Adds a gradient by a point to the row; a carried point keeps it for [`Group::hand_on`].
    #[inline(always)]
    fn spread<R: Real>(&self, point: usize, gradient: Vec2<R>, row: usize, system: &mut System<R>) {
        out_of_line!(R, {
            if let Some(k) = self.unknowns.iter().position(|&unknown| unknown == point) {
                system.add(row, 2 * k, gradient);
            } else if let Some(c) = self.bar_points.iter().position(|each| each.point == point) {
                system.kept[c] = system.kept[c] + gradient;
            }
        })
    }

    /// Hands the gradients that carried points keep on to their ends, from the last to the first: each depends on
    /// points that come before it. K ↦ (α + iβ) B turns back to g ↦ (α − iβ) g.
    #[inline(always)]
    fn hand_on<R: Real>(&self, row: usize, q: &[R], system: &mut System<R>) {
        for (c, each) in self.bar_points.iter().enumerate().rev() {
            let gradient = system.kept[c];
            system.kept[c] = Vec2::zero();
            let to_end = (gradient * q[each.along]).plus(gradient.left(), -q[each.across]);
            self.spread(each.to, to_end, row, system);
            self.spread(each.from, gradient - to_end, row, system);
        }
    }
}

/// a + (along + i across)(b − a).
#[inline(always)]
fn combine<R: Real>(a: Vec2<R>, b: Vec2<R>, along: R, across: R) -> Vec2<R> {
    let u = b - a;
    a.plus(u, along).plus(u.left(), across)
}

/// b − a with two derivatives.
#[inline(always)]
fn between<R: Real>(a: &Place<R>, b: &Place<R>) -> [Vec2<R>; 3] {
    [b.p - a.p, b.d1 - a.d1, b.d2 - a.d2]
}

/// A square system by modified Gram–Schmidt: J = Q R, x = R⁻¹ Qᵀ rhs. Columns lie one after the other.
struct System<R> {
    n: usize,
    columns: Vec<R>,
    upper: Vec<R>,
    rhs: Vec<R>,
    /// Gradients by the points carried by bars, until they are handed on.
    kept: Vec<Vec2<R>>,
}

impl<R: Real> System<R> {
    #[inline(always)]
    fn new(n: usize, n_carried: usize) -> Self {
        let zero = R::splat(0.0);
        System {
            n,
            columns: vec![zero; n * n],
            upper: vec![zero; n * n],
            rhs: vec![zero; n],
            kept: vec![Vec2::zero(); n_carried],
        }
    }

    #[inline(always)]
    fn clear(&mut self) {
        self.columns.fill(R::splat(0.0));
    }

    /// Adds a gradient to the entries of two neighbouring columns.
    #[inline(always)]
    fn add(&mut self, row: usize, column: usize, gradient: Vec2<R>) {
        let (x, y) = (column * self.n + row, (column + 1) * self.n + row);
        self.columns[x] = self.columns[x] + gradient.x;
        self.columns[y] = self.columns[y] + gradient.y;
    }

    #[inline(always)]
    fn factorise(&mut self) {
        out_of_line!(R, {
            let n = self.n;
            for k in 0..n {
                let (before, rest) = self.columns.split_at_mut(k * n);
                let column = &mut rest[..n];
                for j in 0..k {
                    let share = dot(&before[j * n..(j + 1) * n], column);
                    self.upper[j * n + k] = share;
                    for i in 0..n {
                        column[i] = column[i] - before[j * n + i] * share;
                    }
                }
                let length = dot(column, column).sqrt();
                self.upper[k * n + k] = length;
                let inverse = length.recip();
                for x in column {
                    *x = *x * inverse;
                }
            }
        })
    }

    /// Turns `rhs` into the solution.
    #[inline(always)]
    fn solve(&mut self) {
        out_of_line!(R, {
            let n = self.n;
            let mut x = vec![R::splat(0.0); n];
            for k in 0..n {
                // Modified: what is found is taken out before the next.
                x[k] = dot(&self.columns[k * n..(k + 1) * n], &self.rhs);
                for i in 0..n {
                    self.rhs[i] = self.rhs[i] - self.columns[k * n + i] * x[k];
                }
            }
            for k in (0..n).rev() {
                for j in k + 1..n {
                    x[k] = x[k] - self.upper[k * n + j] * x[j];
                }
                x[k] = x[k] / self.upper[k * n + k];
            }
            self.rhs.copy_from_slice(&x);
        })
    }

    /// |det J|: zero where the group is at a limit of its motion.
    #[inline(always)]
    fn determinant(&self) -> R {
        let mut product = R::splat(1.0);
        for k in 0..self.n {
            product = product * self.upper[k * self.n + k];
        }
        product
    }
}

#[inline(always)]
fn dot<R: Real>(a: &[R], b: &[R]) -> R {
    let mut sum = R::splat(0.0);
    for (a, b) in a.iter().zip(b) {
        sum = a.mul_add(*b, sum);
    }
    sum
}
