//! Cams: where follower and cam touch, how steeply, how curved the cam is there.
//!
//! | module | answers |
//! | --- | --- |
//! | here | one contact, exactly, in any number |
//! | [`shape`] | a whole revolution: arrays, extremes, undercut, inflections |
//! | [`crossing`] | where a profile crosses itself |
//! | [`search`] | many cams of one law |
//! | [`along`] | derivatives of all rows by dimensions, lift and angle |
//!
//! The cam turns about the origin by σφ, σ = ±1. A translating follower moves along x, at the distance `offset` to the
//! left of the origin; an oscillating one turns about (`distance`, 0), its arm to the left (side = +1) or
//! right (−1) of the x axis seen from the cam. The lift s(φ) counts from the base circle outwards; it is a length
//! or an angle. P is the roller's centre (of a knife edge: the edge), n the unit normal of the contact away from
//! the cam, d the unit direction in which the contact point of the follower moves as the lift grows.
//!
//! ```text
//! seen from the cam   w = P′ − σ k×P          a = P″ − 2σ k×P′ − P
//! roller              n = σ k×w/|w|           κ = −σ w×a/|w|³        profile P − r n, curvature κ/(1 − r κ)
//! flat face           n(φ), h = n·X           q = h′/β′, X = h n + q k×n,   ρ = h + (h″ − q β″)/β′²
//! pressure angle      tan γ = (d×n)/(d·n)
//! ```
//!
//! with β′ the speed of the face's normal seen from the cam. κ and ρ are positive where the cam is convex.
//!
//! Source: the envelope of a moving circle or line, e.g. Norton, *Cam Design and Manufacturing Handbook*, 2nd
//! ed., chapter 7; the support function of a convex curve for flat faces.

// Fields of enum variants and of plain records are named as in the equations beside them.
#![allow(missing_docs)]

pub mod along;
pub mod crossing;
pub mod search;
pub mod shape;

use linkwright_kernel::plane::Vec2;
use linkwright_kernel::real::Real;

/// How the follower moves and what it touches the cam with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    TranslatingRoller,
    TranslatingFlat,
    OscillatingRoller,
    OscillatingFlat,
}

impl Kind {
    /// From what it is.
    pub fn of(is_oscillating: bool, is_roller: bool) -> Self {
        match (is_oscillating, is_roller) {
            (false, true) => Kind::TranslatingRoller,
            (false, false) => Kind::TranslatingFlat,
            (true, true) => Kind::OscillatingRoller,
            (true, false) => Kind::OscillatingFlat,
        }
    }

    /// Whether the follower touches the cam with a roller; a knife edge is one of radius zero.
    pub fn is_roller(self) -> bool {
        matches!(self, Kind::TranslatingRoller | Kind::OscillatingRoller)
    }
}

/// Lengths and angles of cam and follower, as a designer gives them.
#[derive(Clone, Copy, Debug)]
pub struct Dimensions<R> {
    /// Radius of the base circle r₀: the cam's smallest where the lift is zero.
    pub base_radius: R,
    /// Radius of the roller r, zero for a knife edge.
    pub roller_radius: R,
    /// Of the follower's line to the left of the cam's centre; of an oscillating face from its pivot to the cam.
    pub offset: R,
    /// From the cam's centre to the pivot of an oscillating follower.
    pub distance: R,
    /// From that pivot to the roller.
    pub arm: R,
    /// Of a translating face's normal from the direction of travel \[rad\].
    pub tilt: R,
}

impl<R> Dimensions<R> {
    /// The same in another number.
    #[inline(always)]
    pub fn map<T>(self, f: impl Fn(R) -> T) -> Dimensions<T> {
        Dimensions {
            base_radius: f(self.base_radius),
            roller_radius: f(self.roller_radius),
            offset: f(self.offset),
            distance: f(self.distance),
            arm: f(self.arm),
            tilt: f(self.tilt),
        }
    }
}

/// A cam with its follower, ready to be evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Cam<R> {
    pub kind: Kind,
    /// σ: +1 for a cam that turns counter-clockwise as φ grows, −1 for clockwise.
    pub sense: f64,
    /// +1 for an arm to the left of the line from cam to pivot, −1 to the right.
    pub side: f64,
    pub size: Dimensions<R>,
    /// Place of the follower at zero lift: along its line, distance of the face, or angle of the arm.
    start: R,
    cos: R,
    sin: R,
}

/// Where follower and cam touch, in the ground's frame.
#[derive(Clone, Copy, Debug)]
pub struct Contact<R> {
    /// Centre of the roller, or the point of contact with a flat face.
    pub pitch: Vec2<R>,
    /// Unit normal away from the cam.
    pub normal: Vec2<R>,
    /// Curvature of the pitch curve for a roller, radius of curvature of the profile for a flat face.
    pub bend: R,
    /// Place of the contact on a flat face: from the stem of a translating follower to the left, from the pivot
    /// of an oscillating one along its arm; zero for a roller.
    pub along: R,
    /// d·n and d×n.
    pub lead: Vec2<R>,
}

/// The centre of a roller in the ground's frame: P, w, a and d as in the head of this file.
struct Path<R> {
    p: Vec2<R>,
    w: Vec2<R>,
    a: Vec2<R>,
    d: Vec2<R>,
}

/// What a search over cams compares of their contacts.
#[derive(Clone, Copy, Debug)]
pub struct ContactMeasure<R> {
    /// d·n and d×n, times a positive factor.
    pub lead: Vec2<R>,
    /// A fraction that grows with the bend: κ|κ| of a roller, ρ of a flat face. `under` is not negative.
    pub over: R,
    pub under: R,
}

impl<R> Cam<R> {
    /// The same in another number.
    #[inline(always)]
    pub fn map<T>(&self, f: impl Fn(R) -> T) -> Cam<T>
    where
        R: Copy,
    {
        Cam {
            kind: self.kind,
            sense: self.sense,
            side: self.side,
            size: self.size.map(&f),
            start: f(self.start),
            cos: f(self.cos),
            sin: f(self.sin),
        }
    }
}

impl<R: Real> Cam<R> {
    /// A cam. Dimensions that do not go together give NaN.
    #[inline(always)]
    pub fn new(kind: Kind, sense: f64, side: f64, size: Dimensions<R>) -> Self {
        let prime = size.base_radius + size.roller_radius;
        let start = match kind {
            Kind::TranslatingRoller => (prime.squared() - size.offset.squared()).sqrt(),
            Kind::TranslatingFlat => size.base_radius,
            Kind::OscillatingRoller => {
                let (a, l) = (size.distance, size.arm);
                let cos = (a.squared() + l.squared() - prime.squared()) / (a * l * 2.0);
                (R::splat(1.0) - cos.squared()).sqrt().atan2(cos)
            }
            Kind::OscillatingFlat => {
                let sin = (size.base_radius + size.offset) / size.distance;
                sin.atan2((R::splat(1.0) - sin.squared()).sqrt())
            }
        };
        let (sin, cos) = size.tilt.sin_cos();
        Cam { kind, sense, side, size, start, cos, sin }
    }

    /// The contact where lift and its derivatives are s, s′, s″.
    #[inline(always)]
    pub fn contact(&self, s: [R; 3]) -> Contact<R> {
        match self.kind {
            Kind::TranslatingRoller => self.roller(&self.translating_path(s)),
            Kind::TranslatingFlat => self.translating_flat(s),
            Kind::OscillatingRoller => self.roller(&self.oscillating_path(s)),
            Kind::OscillatingFlat => self.oscillating_flat(s),
        }
    }

    /// The same as a search compares it, without a root or a quotient.
    #[inline(always)]
    pub fn measure(&self, s: [R; 3]) -> ContactMeasure<R> {
        let path = match self.kind {
            Kind::TranslatingRoller => self.translating_path(s),
            Kind::OscillatingRoller => self.oscillating_path(s),
            Kind::TranslatingFlat | Kind::OscillatingFlat => {
                let Contact { lead, bend, .. } = self.contact(s);
                return ContactMeasure { lead, over: bend, under: R::splat(1.0) };
            }
        };
        let turning = path.w.cross(path.a) * -self.sense;
        let square = path.w.dot(path.w);
        ContactMeasure {
            lead: self.lead(&path, path.w.left() * R::splat(self.sense)),
            over: turning * turning.abs(),
            under: square * square * square,
        }
    }

    /// The bend that a fraction of [`ContactMeasure`] stands for.
    #[inline(always)]
    pub fn bend_of(&self, over: R, under: R) -> R {
        let quotient = over / under;
        if !self.kind.is_roller() {
            return quotient;
        }
        let size = quotient.abs().sqrt();
        quotient.select_lt(R::splat(0.0), -size, size)
    }

    /// P = (x, offset), so that w = (s′ + σ offset, −σ x) and a = (s″ − x, −offset − 2σ s′).
    #[inline(always)]
    fn translating_path(&self, [s, s1, s2]: [R; 3]) -> Path<R> {
        let (zero, one, sense) = (R::splat(0.0), R::splat(1.0), R::splat(self.sense));
        let (x, offset) = (self.start + s, self.size.offset);
        Path {
            p: Vec2::new(x, offset),
            w: Vec2::new(offset.mul_add(sense, s1), x * -self.sense),
            a: Vec2::new(s2 - x, s1.mul_add(-(sense + sense), -offset)),
            d: Vec2::new(one, zero),
        }
    }

    /// P = A + l u, u = (−cos ψ, ± sin ψ), u′ = s′ d, d′ = −s′ u.
    #[inline(always)]
    fn oscillating_path(&self, [s, s1, s2]: [R; 3]) -> Path<R> {
        let (u, d) = self.arm_at(s);
        let (l, sense) = (self.size.arm, R::splat(self.sense));
        let p = Vec2::new(self.size.distance, R::splat(0.0)).plus(u, l);
        let (p1, p2) = (d * (l * s1), (d * (l * s2)).plus(u, -(l * s1.squared())));
        Path { p, w: p1.plus(p.left(), -sense), a: (p2 - p).plus(p1.left(), -(sense + sense)), d }
    }

    /// Direction of the arm, and direction in which its end moves as the lift grows.
    #[inline(always)]
    fn arm_at(&self, s: R) -> (Vec2<R>, Vec2<R>) {
        let (sin, cos) = (self.start + s).sin_cos();
        (Vec2::new(-cos, sin * self.side), Vec2::new(sin, cos * self.side))
    }

    /// d·n and d×n of a normal.
    #[inline(always)]
    fn lead(&self, path: &Path<R>, normal: Vec2<R>) -> Vec2<R> {
        match self.kind {
            // d lies along x.
            Kind::TranslatingRoller => normal,
            _ => Vec2::new(path.d.dot(normal), path.d.cross(normal)),
        }
    }

    /// The envelope of a roller whose centre goes along a path.
    #[inline(always)]
    fn roller(&self, path: &Path<R>) -> Contact<R> {
        let sense = R::splat(self.sense);
        let inverse = path.w.dot(path.w).sqrt().recip();
        let normal = path.w.left() * (sense * inverse);
        let bend = -(sense * path.w.cross(path.a) * inverse.squared() * inverse);
        Contact { pitch: path.p, normal, bend, along: R::splat(0.0), lead: self.lead(path, normal) }
    }

    #[inline(always)]
    fn translating_flat(&self, [s, s1, s2]: [R; 3]) -> Contact<R> {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let h = [self.start + s * self.cos, s1 * self.cos, s2 * self.cos];
        let turning = [R::splat(-self.sense), zero];
        let mut contact = self.face(Vec2::new(self.cos, self.sin), h, turning);
        let d = Vec2::new(one, zero);
        contact.lead = Vec2::new(d.dot(contact.normal), d.cross(contact.normal));
        // The stem meets a tilted face beside the foot of the perpendicular from the cam's centre.
        contact.along = contact.along + h[0] * (self.sin / self.cos);
        contact
    }

    /// n = (sin ψ, ± cos ψ), h = a sin ψ − f; the normal turns by ∓s′ against the ground.
    #[inline(always)]
    fn oscillating_flat(&self, [s, s1, s2]: [R; 3]) -> Contact<R> {
        let (sin, cos) = (self.start + s).sin_cos();
        let a = self.size.distance;
        let normal = Vec2::new(sin, cos * self.side);
        let h = [a * sin - self.size.offset, a * cos * s1, a * (cos * s2 - sin * s1.squared())];
        let turning = [-(s1 * self.side) - self.sense, -(s2 * self.side)];
        let mut contact = self.face(normal, h, turning);
        let arm = contact.pitch - Vec2::new(a, R::splat(0.0));
        let d = arm.left() * (arm.dot(arm).sqrt().recip() * -self.side);
        contact.lead = Vec2::new(d.dot(normal), d.cross(normal));
        contact.along = normal.cross(arm) * self.side;
        contact
    }

    /// The envelope of a face with normal n at distance h, h′, h″ whose normal turns with β′, β″.
    #[inline(always)]
    fn face(&self, normal: Vec2<R>, [h, h1, h2]: [R; 3], [b1, b2]: [R; 2]) -> Contact<R> {
        let along = h1 / b1;
        let bend = h + (h2 - along * b2) / b1.squared();
        let pitch = (normal * h).plus(normal.left(), along);
        Contact { pitch, normal, bend, along, lead: Vec2::zero() }
    }

    /// How much the profile moves on as its normal turns, in a sign that is positive on a sound cam: 1 − r κ for
    /// a roller, ρ for a flat face. Zero at a sharp point, negative where the follower undercuts.
    #[inline(always)]
    pub fn soundness(&self, contact: &Contact<R>) -> R {
        self.soundness_of(contact.bend)
    }

    /// The same from the bend alone.
    #[inline(always)]
    pub fn soundness_of(&self, bend: R) -> R {
        if self.kind.is_roller() { R::splat(1.0) - self.size.roller_radius * bend } else { bend }
    }

    /// Vectors of the ground's frame seen from the cam, which has turned by σφ.
    #[inline(always)]
    pub fn from_cam<const N: usize>(&self, vectors: [Vec2<R>; N], phi: R) -> [Vec2<R>; N] {
        let (sin, cos) = phi.sin_cos();
        let sin = sin * self.sense;
        vectors.map(|v| Vec2::new(v.x * cos + v.y * sin, v.y * cos - v.x * sin))
    }
}
