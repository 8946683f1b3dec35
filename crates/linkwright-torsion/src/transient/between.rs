//! Errors between the ends of a step against what they may be, side by side in lanes.

use super::bank::WIDEST;
use super::chains::Links;
use super::system::System;
use linkwright_kernel::lanes::{Job, in_single_lanes};
use linkwright_kernel::real::Real;
use linkwright_kernel::rk::{over, worse};

/// What errors may be, as a share of sizes and of floors beneath them.
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    pub accuracy: f64,
    /// Of angles and twists and of speeds beside the first mass, and of the speed of that one.
    pub angle: f64,
    pub speed: f64,
    pub lead_speed: f64,
    /// Torque of a shaft that counts, if its twist is smaller: without bound where it does not matter.
    pub torque: f64,
}

/// Links between neighbours for their twists: zeros where there is none.
#[derive(Clone, Debug)]
pub struct Between {
    /// Whether the others are counted from the first mass.
    relative: bool,
    places: usize,
    /// Zero for the mass from which the others are counted, else one.
    beside: Vec<f64>,
    /// What the angles of the mass and of the next count in the twist.
    near: Vec<f64>,
    far: Vec<f64>,
    ratio: Vec<f64>,
    flexibility: Vec<f64>,
    others: Vec<usize>,
}

impl Between {
    /// For a system.
    pub fn new(system: &System) -> Self {
        let (n, relative) = (system.len(), system.is_free());
        let places = n.next_multiple_of(WIDEST);
        let links = Links::of(system, places);
        let mut beside = vec![1.0; places];
        if relative {
            beside[0] = 0.0;
        }
        let none = vec![0.0; places];
        let (mut near, mut far, mut ratio) = (none.clone(), none.clone(), none);
        let mut flexibility = vec![f64::INFINITY; places];
        for (mass, place) in links.chain.links() {
            let link = &system.links[place];
            near[mass] = link.ratio * beside[mass];
            far[mass] = if mass + 1 < n { link.ratio } else { 0.0 };
            (ratio[mass], flexibility[mass]) = (link.ratio, link.stiffness.recip());
        }
        Between { relative, places, beside, near, far, ratio, flexibility, others: links.others }
    }

    /// Largest error over what it may be, of the numbers of a state and of the twist of each link, which may be small beside the
    /// angles; their sizes are the larger of two states. All have places for whole registers.
    pub fn worst(&self, system: &System, may: &Tolerances, error: &[f64], [from, to]: [&[f64]; 2]) -> f64 {
        let [most, farthest] = in_single_lanes(Lanes { of: self, may, error, from, to });
        let mut most = if self.relative { worse(most, self.lead(may, error, [from, to])) } else { most };
        for &place in &self.others {
            let link = &system.links[place];
            let twist = |list: &[f64]| link.twist(system.len(), self.relative, |i| list[i]);
            let size = twist(from).abs().max(twist(to).abs());
            let tolerance = may.accuracy * size.max(may.twist_floor(link.stiffness.recip()));
            most = worse(most, over(twist(error), tolerance, size.max(link.ratio * farthest)));
        }
        most
    }

    /// That of the first mass, from which the others are counted: a radian and its speed are what counts.
    fn lead(&self, may: &Tolerances, error: &[f64], [from, to]: [&[f64]; 2]) -> f64 {
        let size = |i: usize| from[i].abs().max(to[i].abs());
        let speed = size(self.places);
        let tolerance = may.accuracy * speed.max(may.lead_speed);
        worse(over(error[0], may.accuracy, size(0)), over(error[self.places], tolerance, speed))
    }
}

impl Tolerances {
    /// Twists of links below which the accuracy is no longer relative to them.
    #[inline(always)]
    fn twist_floor<R: Real>(&self, flexibility: R) -> R {
        (flexibility * self.torque).min(R::splat(self.angle))
    }
}

/// Errors in lanes.
struct Lanes<'a> {
    of: &'a Between,
    may: &'a Tolerances,
    error: &'a [f64],
    from: &'a [f64],
    to: &'a [f64],
}

impl Job for Lanes<'_> {
    /// Largest error over what it may be, and largest angle beside the first mass.
    type Output = [f64; 2];

    #[inline(always)]
    fn run<R: Real>(self) -> [f64; 2] {
        let (mut most, mut lost, mut farthest) = (R::splat(0.0), R::splat(0.0), R::splat(0.0));
        for at in (0..self.of.places).step_by(R::LANES) {
            farthest = farthest.max((R::load(&self.to[at..]) * R::load(&self.of.beside[at..])).abs());
            let angle: R = self.number(at, at, self.may.angle);
            let speed: R = self.number(at, self.of.places + at, self.may.speed);
            most = most.max(angle).max(speed);
            lost = lost + (angle + speed) * 0.0;
        }
        let farthest = farthest.max_lane();
        for at in (0..self.of.places).step_by(R::LANES) {
            let share: R = self.link(at, farthest);
            (most, lost) = (most.max(share), lost + share * 0.0);
        }
        // The largest of several lanes passes over one that is no number; their sum does not.
        let mut lanes = [0.0; WIDEST];
        lost.store(&mut lanes);
        [most.max_lane() + lanes.iter().sum::<f64>(), farthest]
    }
}

impl Lanes<'_> {
    /// For the angles or speeds of some masses, the first of which has a place in the state.
    #[inline(always)]
    fn number<R: Real>(&self, at: usize, first: usize, floor: f64) -> R {
        let size = R::load(&self.from[first..]).abs().max(R::load(&self.to[first..]).abs());
        let tolerance = size.max(R::splat(floor)) * self.may.accuracy;
        over(R::load(&self.error[first..]) * R::load(&self.of.beside[at..]), tolerance, size)
    }

    /// For the links behind some masses.
    #[inline(always)]
    fn link<R: Real>(&self, at: usize, farthest: f64) -> R {
        let size = self.twist::<R>(at, self.from).abs().max(self.twist::<R>(at, self.to).abs());
        let floor = self.may.twist_floor(R::load(&self.of.flexibility[at..]));
        let size_of_angles = R::load(&self.of.ratio[at..]) * farthest;
        over(self.twist(at, self.error), size.max(floor) * self.may.accuracy, size.max(size_of_angles))
    }

    #[inline(always)]
    fn twist<R: Real>(&self, at: usize, list: &[f64]) -> R {
        let (near, far) = (R::load(&self.of.near[at..]), R::load(&self.of.far[at..]));
        near * R::load(&list[at..]) - far * R::load(&list[at + 1..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transient::system::Link;

    /// A free chain of ten masses, the last joined to the fifth as well: an error of one number, or of one twist that is small beside
    /// the angles, is what it is over what it may be, wherever it stands; one that is no number is not lost.
    #[test]
    fn each_error_counts() {
        let n = 10;
        let link =
            |a: usize, b: usize| Link { ends: [a, b], ratio: 1.0, stiffness: 1e3, damping: 0.0, curve: None };
        let system = System {
            inertia: vec![1.0; n],
            damping: vec![0.0; n],
            swing_damping: vec![0.0; n],
            links: (0..n - 1).map(|i| link(i, i + 1)).chain([link(4, 9)]).collect(),
            rotors: Vec::new(),
            torques: Vec::new(),
            frictions: Vec::new(),
            tables: Vec::new(),
            curves: Vec::new(),
        };
        let between = Between::new(&system);
        let (places, may) = (
            between.places,
            Tolerances { accuracy: 1e-6, angle: 1e-3, speed: 2.0, lead_speed: 5.0, torque: f64::INFINITY },
        );
        let mut state = vec![0.0; 2 * places];
        for i in 1..n {
            (state[i], state[places + i]) = (0.5, 3.0);
        }
        (state[0], state[places]) = (700.0, 100.0);
        let worst = |at: usize, size: f64| {
            let mut error = vec![0.0; 2 * places];
            error[at] = size;
            between.worst(&system, &may, &error, [&state, &state])
        };
        let near =
            |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-12, "{found} for {wanted}");
        near(worst(0, 1e-6), 1.0);
        near(worst(places, 1e-4), 1.0);
        for i in 1..n {
            near(worst(places + i, 3e-6), 1.0);
            // Twists between the masses are none, so that their floor counts: a thousandth.
            near(worst(i, 1e-9), 1.0);
            assert!(worst(i, f64::NAN).is_nan() && worst(places + i, f64::NAN).is_nan(), "mass {i}");
        }
    }
}
