//! What a value reference stands for: its upper half is the kind, its lower half the number.

use crate::fault::Fault;
use crate::instant::Instant;
use linkwright_kernel::real::Real;

/// Something with a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Time \[s\].
    Time,
    /// What the other program applies ([`crate::outside::Outside::part`]).
    Outside(usize),
    /// A parameter.
    Parameter(usize),
    /// A state: angle and speed of the crank, then twists of the other masses against it and their speeds against it.
    State(usize),
    /// Its rate.
    Rate(usize),
    /// An event indicator.
    Indicator(usize),
    /// Something at the crank or the motor ([`Instant::crank`]).
    Crank(usize),
    /// x, y, their speeds and accelerations of a point.
    Point(usize, usize),
    /// Direction, angular speed and acceleration of a link.
    Link(usize, usize),
    /// Coordinate, speed and acceleration of a slide.
    Slide(usize, usize),
    /// Angle, speed and acceleration of a mass.
    Mass(usize, usize),
    /// Twist and torque of a link of the driveline.
    Shaft(usize, usize),
    /// Whether the supply is on.
    Supply,
    /// Whether the crank is held at rest.
    AtRest,
}

impl Quantity {
    /// Of a value reference.
    ///
    /// # Errors
    /// There is no such kind.
    pub fn of(reference: u32) -> Result<Self, Fault> {
        let (kind, n) = (reference >> 16, (reference & 0xffff) as usize);
        Ok(match (kind, n) {
            (0, 0) => Quantity::Time,
            (1, 0) => Quantity::Supply,
            (1, n) => Quantity::Outside(n - 1),
            (2, n) => Quantity::Parameter(n),
            (3, n) => Quantity::State(n),
            (4, n) => Quantity::Rate(n),
            (5, n) => Quantity::Indicator(n),
            (6, 16) => Quantity::AtRest,
            (6, n) => Quantity::Crank(n),
            (7, n) => Quantity::Point(n / 6, n % 6),
            (8, n) => Quantity::Link(n / 4, n % 4),
            (9, n) => Quantity::Slide(n / 4, n % 4),
            (10, n) => Quantity::Mass(n / 4, n % 4),
            (11, n) => Quantity::Shaft(n / 2, n % 2),
            _ => return Err(Fault::Reference(reference)),
        })
    }

    /// Its value at an instant; none where there is no such part.
    pub fn at<N: Real>(self, instant: &Instant<N>) -> Option<N> {
        let others = instant.speed.len() - 1;
        let omega = instant.speed[others];
        let along = |d1: N| d1 * omega;
        let bent = |d1: N, d2: N| d1 * instant.acceleration[others] + d2 * omega.squared();
        match self {
            Quantity::State(n) => instant.state(n),
            Quantity::Rate(n) => instant.rate(n),
            Quantity::Crank(n) => instant.crank(n),
            Quantity::Point(point, part) => {
                let place = instant.motion.points.get(point)?;
                Some(match part {
                    0 => place.p.x,
                    1 => place.p.y,
                    2 => along(place.d1.x),
                    3 => along(place.d1.y),
                    4 => bent(place.d1.x, place.d2.x),
                    _ => bent(place.d1.y, place.d2.y),
                })
            }
            Quantity::Link(link, part) => {
                let heading = instant.motion.links.get(link)?;
                Some(match part {
                    0 => heading.e.y.atan2(heading.e.x),
                    1 => along(heading.d1),
                    2 => bent(heading.d1, heading.d2),
                    _ => return None,
                })
            }
            Quantity::Slide(slide, part) => {
                let slide = instant.motion.slides.get(slide)?;
                Some(match part {
                    0 => slide.s,
                    1 => along(slide.d1),
                    2 => bent(slide.d1, slide.d2),
                    _ => return None,
                })
            }
            Quantity::Mass(mass, part) => match part {
                0 => instant.angle.get(mass).copied(),
                1 => instant.speed.get(mass).copied(),
                2 => instant.acceleration.get(mass).copied(),
                _ => None,
            },
            Quantity::Shaft(link, part) => instant.links.get(link).map(|link| link[part]),
            _ => None,
        }
    }
}
