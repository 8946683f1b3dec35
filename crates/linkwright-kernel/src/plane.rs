//! Vectors of the plane, and the motion of points, links and slides by the crank angle.

use crate::real::Real;
use std::ops::{Add, Mul, Sub};

/// A vector of the plane.
#[derive(Clone, Copy, Debug)]
pub struct Vec2<R> {
    /// Along the ground's x.
    pub x: R,
    /// Along the ground's y.
    pub y: R,
}

impl<R: Real> Vec2<R> {
    /// From its two components.
    #[inline(always)]
    pub fn new(x: R, y: R) -> Self {
        Vec2 { x, y }
    }
    /// The null vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Vec2::new(R::splat(0.0), R::splat(0.0))
    }
    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> R {
        self.x.mul_add(o.x, self.y * o.y)
    }
    /// The component of the vector product across the plane: positive where `o` points to the left of `self`.
    #[inline(always)]
    pub fn cross(self, o: Self) -> R {
        self.x.mul_add(o.y, -(self.y * o.x))
    }
    /// Turned by +90°: the direction to the left of `self`.
    #[inline(always)]
    pub fn left(self) -> Self {
        Vec2::new(-self.y, self.x)
    }
    /// `self + v · k`.
    #[inline(always)]
    pub fn plus(self, v: Self, k: R) -> Self {
        Vec2::new(v.x.mul_add(k, self.x), v.y.mul_add(k, self.y))
    }
}
impl<R: Real> Add for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Vec2::new(self.x + o.x, self.y + o.y)
    }
}
impl<R: Real> Sub for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Vec2::new(self.x - o.x, self.y - o.y)
    }
}
impl<R: Real> Mul<R> for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: R) -> Self {
        Vec2::new(self.x * k, self.y * k)
    }
}

/// A point over the crank angle φ: position \[m\], first and second derivative \[m/rad, m/rad²\].
#[derive(Clone, Copy, Debug)]
pub struct Place<R> {
    /// Position.
    pub p: Vec2<R>,
    /// First transfer function dp/dφ.
    pub d1: Vec2<R>,
    /// Second transfer function d²p/dφ².
    pub d2: Vec2<R>,
}

impl<R: Real> Place<R> {
    /// A point of the ground.
    #[inline(always)]
    pub fn fixed(p: Vec2<R>) -> Self {
        Place { p, d1: Vec2::zero(), d2: Vec2::zero() }
    }

    /// Puts it there, part by part: a bundle of lanes is wide, and a copy of the whole would go through
    /// memory.
    #[inline(always)]
    pub fn set(&mut self, p: Vec2<R>, d1: Vec2<R>, d2: Vec2<R>) {
        self.p = p;
        self.d1 = d1;
        self.d2 = d2;
    }
}

/// A link over the crank angle: its direction as a unit vector, and dψ/dφ, d²ψ/dφ² of its angle ψ.
#[derive(Clone, Copy, Debug)]
pub struct Heading<R> {
    /// Unit vector from the link's start along the link.
    pub e: Vec2<R>,
    /// First transfer function dψ/dφ.
    pub d1: R,
    /// Second transfer function d²ψ/dφ².
    pub d2: R,
}

impl<R: Real> Heading<R> {
    /// Turns it there; see [`Place::set`].
    #[inline(always)]
    pub fn set(&mut self, e: Vec2<R>, d1: R, d2: R) {
        self.e = e;
        self.d1 = d1;
        self.d2 = d2;
    }
}

/// A slide over the crank angle: its coordinate along the guide \[m\] and two derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Slide<R> {
    /// Coordinate along the guide, from the foot of the guide's through point.
    pub s: R,
    /// First transfer function ds/dφ.
    pub d1: R,
    /// Second transfer function d²s/dφ².
    pub d2: R,
}

impl<R: Real> Slide<R> {
    /// Puts it there; see [`Place::set`].
    #[inline(always)]
    pub fn set(&mut self, s: R, d1: R, d2: R) {
        self.s = s;
        self.d1 = d1;
        self.d2 = d2;
    }
}

/// The crank angle φ \[rad\] with its sine and cosine.
#[derive(Clone, Copy, Debug)]
pub struct Angle<R> {
    /// φ.
    pub phi: R,
    /// sin φ.
    pub sin: R,
    /// cos φ.
    pub cos: R,
}

impl<R: Real> Angle<R> {
    /// From φ in radians.
    #[inline(always)]
    pub fn new(phi: R) -> Self {
        let (sin, cos) = phi.sin_cos();
        Angle { phi, sin, cos }
    }
}
