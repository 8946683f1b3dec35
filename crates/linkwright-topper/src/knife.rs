//! Where the edge of the knife is, seen from the centre of a head.

use linkwright_kernel::motion_law::MotionLaw;
use linkwright_kernel::real::Real;
use std::f64::consts::TAU;

/// A periodic law over its phase \[rad\].
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Σ a cos kθ + b sin kθ from k = 0 on: smooth laws.
    Harmonics(Vec<[f64; 2]>),
    /// Any other.
    Pieces(MotionLaw),
}

impl Law {
    /// Value, first and second derivative by the phase.
    #[inline(always)]
    pub fn at<R: Real>(&self, phase: R) -> [R; 3] {
        match self {
            Law::Harmonics(c) => series(c, phase.sin_cos()),
            Law::Pieces(law) => law.at(phase),
        }
    }

    /// The same at two phases beside a middle one, whose sine and cosine are known: those of both follow from those of
    /// their distance.
    #[inline(always)]
    pub fn beside<R: Real>(&self, (middle, (s, c)): (R, (R, R)), distance: R) -> [[R; 3]; 2] {
        match self {
            Law::Harmonics(coefficients) => {
                let (ds, dc) = distance.sin_cos();
                let (sine, cosine) = (s * dc, c * dc);
                let (across, along) = (c * ds, s * ds);
                [
                    series(coefficients, (sine - across, cosine + along)),
                    series(coefficients, (sine + across, cosine - along)),
                ]
            }
            Law::Pieces(law) => [law.at(middle - distance), law.at(middle + distance)],
        }
    }
}

/// The sum and its derivatives at a phase of a sine and cosine; each harmonic is turned on from the one before.
#[inline(always)]
fn series<R: Real>(coefficients: &[[f64; 2]], (s1, c1): (R, R)) -> [R; 3] {
    let Some(([mean, _], waves)) = coefficients.split_first() else { return [R::splat(0.0); 3] };
    let (mut s, mut c) = (s1, c1);
    let [mut y, mut d1, mut d2] = [R::splat(*mean), R::splat(0.0), R::splat(0.0)];
    for (k, &[a, b]) in waves.iter().enumerate() {
        if k > 0 {
            (s, c) = (s * c1 + c * s1, c * c1 - s * s1);
        }
        let (k, value) = ((k + 1) as f64, c * a + s * b);
        y = y + value;
        d1 = d1 + (c * b - s * a) * k;
        d2 = d2 - value * (k * k);
    }
    [y, d1, d2]
}

/// A knife: y(t) = law(θ + `rate` t) + `drift` t.
#[derive(Clone, Debug)]
pub struct Knife {
    pub law: Law,
    /// Phases at which the law or one of its first two derivatives jumps, increasing, in one revolution.
    pub corners: Vec<f64>,
    /// sin α and cos α of the edge's angle to the transverse axis.
    pub direction: [f64; 2],
    /// Speed v along the row.
    pub forward: f64,
    /// Phase per time.
    pub rate: f64,
    /// A constant speed across the row.
    pub drift: f64,
    /// Maximum |y| of the law.
    pub reach: f64,
    /// Minimum and maximum speed across the row, drift included.
    pub speeds: [f64; 2],
}

/// Heads, one a lane.
#[derive(Clone, Copy, Debug)]
pub struct Head<R> {
    /// Radius r of the disc.
    pub radius: R,
    /// Place δ of its centre across the row.
    pub offset: R,
    /// Phase θ of the knife when the middle of the edge is abreast of the centre.
    pub phase: R,
}

/// p and q with their derivatives by the time.
#[derive(Clone, Copy, Debug)]
pub struct Place<R> {
    pub p: [R; 3],
    pub q: [R; 3],
}

/// Rounds in which a crossing is found: a bracket halved if Halley's step would leave it.
const ROUNDS: usize = 24;

/// Share of the bracket below which a step is the last: the next, of its third power, would be rounding.
const CLOSE: f64 = 1e-7;

impl Knife {
    /// Mean speed of the edge along its normal.
    pub fn advance(&self) -> f64 {
        let [sin, cos] = self.direction;
        self.forward * cos - self.drift * sin
    }

    /// Whether the edge runs backwards at times.
    pub fn retreats(&self) -> bool {
        let [sin, cos] = self.direction;
        self.speeds.iter().any(|speed| self.forward * cos - speed * sin <= 0.0)
    }

    /// The edge at a time.
    #[inline(always)]
    pub fn place<R: Real>(&self, head: &Head<R>, t: R) -> Place<R> {
        self.placed(head, t, self.law.at(head.phase + t * self.rate))
    }

    /// The edge at a time, at which the law is known.
    #[inline(always)]
    pub fn placed<R: Real>(&self, head: &Head<R>, t: R, [law, d1, d2]: [R; 3]) -> Place<R> {
        let [sin, cos] = self.direction;
        let y = law + t * self.drift - head.offset;
        let (speed, bend) = (d1 * self.rate + self.drift, d2 * (self.rate * self.rate));
        let x = t * self.forward;
        Place {
            p: [x * cos - y * sin, -speed * sin + self.forward * cos, -bend * sin],
            q: [x * sin + y * cos, speed * cos + self.forward * sin, bend * cos],
        }
    }

    /// Times between which p must come to a level, and their middle.
    #[inline(always)]
    pub fn bracket<R: Real>(&self, head: &Head<R>, level: R) -> [R; 3] {
        let [sin, _] = self.direction;
        let inverse = 1.0 / self.advance();
        let middle = (level - head.offset * sin) * inverse;
        let spare = R::splat((self.reach * sin * inverse).abs());
        [middle - spare, middle, middle + spare]
    }

    /// When p comes to a level, for an edge that never retreats; by Halley's steps, whose errors fall with the third power.
    #[inline(always)]
    pub fn time<R: Real>(&self, head: &Head<R>, level: R) -> R {
        let [mut low, mut t, mut high] = self.bracket(head, level);
        let (zero, close) = (R::splat(0.0), (high - low) * CLOSE);
        for _ in 0..ROUNDS {
            let place = self.place(head, t);
            let miss = place.p[0] - level;
            low = miss.select_lt(zero, t, low);
            high = miss.select_lt(zero, high, t);
            let [_, speed, bend] = place.p;
            let halley = miss * speed / (speed * speed - miss * bend * 0.5);
            let (next, middle) = (t - halley, (low + high) * 0.5);
            let step = next.select_lt(low, middle, high.select_lt(next, middle, next)) - t;
            t = t + step;
            if (step.abs() - close).max_lane() <= 0.0 {
                break;
            }
        }
        t
    }

    /// Turns of the law before and after a pass that a corner may fall into, for times up to `longest` from abreast.
    pub fn turns(&self, longest: f64) -> std::ops::RangeInclusive<i32> {
        let turns = ((self.rate.abs() * longest / TAU).ceil() as i32).saturating_add(1);
        -turns..=turns
    }

    /// Calls `visit` with the ends of each stretch of time between two in which the law has no corner; in lanes, some
    /// have no length.
    #[inline(always)]
    pub fn stretches<R: Real>(
        &self,
        head: &Head<R>,
        [from, to]: [R; 2],
        turns: std::ops::RangeInclusive<i32>,
        mut visit: impl FnMut([R; 2]),
    ) {
        let mut start = from;
        if self.rate > 0.0 && !self.corners.is_empty() {
            let inverse = 1.0 / self.rate;
            for turn in turns {
                for corner in &self.corners {
                    let at = (-head.phase + (corner + TAU * f64::from(turn))) * inverse;
                    let end = at.max(start).min(to);
                    // Most corners lie outside the pass. A NaN is visited all the same.
                    let is_empty = (end - start).max_lane() <= 0.0;
                    if !is_empty {
                        visit([start, end]);
                    }
                    start = end;
                }
            }
        }
        visit([start, to]);
    }
}
