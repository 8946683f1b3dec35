//! Links from masses to their neighbours in the list, side by side in lanes: most of a train.

use super::system::{Link, System};
use linkwright_kernel::real::Real;

/// Links of a system: those between neighbours, and all others.
#[derive(Clone, Debug)]
pub struct Links {
    pub chain: Chain,
    /// Places of the others in the list of links.
    pub others: Vec<usize>,
}

/// Links without curves, at most one from each mass to the next, of the last mass to the ground. A list has a place for the link
/// behind each mass, and one before the first; numbers are zero where there is no link.
#[derive(Clone, Debug)]
pub struct Chain {
    ratio: Vec<f64>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    /// Mass before each link, with its place in the list of links.
    places: Vec<(usize, usize)>,
}

/// Torques of the links at some masses.
#[derive(Clone, Copy, Debug)]
pub struct Twists<R> {
    /// Torque on the masses.
    pub torque: R,
    /// Loss in the links behind them.
    pub loss: R,
}

impl Links {
    /// Of a system, with places for at least as many masses as it has.
    pub fn of(system: &System, places: usize) -> Self {
        let mut chain = Chain::without_links(places);
        let others = system.links.iter().enumerate().filter(|&(place, link)| !chain.takes(place, link));
        let others = others.map(|(place, _)| place).collect();
        Links { chain, others }
    }

    /// Loss in each link, from those behind masses and those of the other links.
    pub fn losses(&self, behind: &[f64], others: &[f64]) -> Vec<f64> {
        let mut found = vec![0.0; self.chain.places.len() + self.others.len()];
        self.chain.places.iter().for_each(|&(mass, place)| found[place] = behind[mass]);
        self.others.iter().zip(others).for_each(|(&place, &loss)| found[place] = loss);
        found
    }
}

impl Chain {
    fn without_links(places: usize) -> Self {
        let none = vec![0.0; places + 1];
        Chain { ratio: none.clone(), stiffness: none.clone(), damping: none, places: Vec::new() }
    }

    /// Takes a link if it joins neighbours that no other one joins.
    fn takes(&mut self, place: usize, link: &Link) -> bool {
        let [mass, next] = link.ends;
        let takes = link.is_plain() && next == mass + 1 && self.ratio[next] == 0.0;
        if takes {
            (self.ratio[next], self.stiffness[next], self.damping[next]) =
                (link.ratio, link.stiffness, link.damping);
            self.places.push((mass, place));
        }
        takes
    }

    /// Mass before each link, with its place in the list of links.
    pub fn links(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.places.iter().copied()
    }

    /// Torques at some masses, the first of which has a place, from lists of angles and speeds that begin with a number before
    /// the first mass and end with the ground.
    #[inline(always)]
    pub fn twists<R: Real>(&self, at: usize, angle: &[f64], speed: &[f64]) -> Twists<R> {
        let before = [R::load(&angle[at..]), R::load(&speed[at..])];
        let here = [R::load(&angle[at + 1..]), R::load(&speed[at + 1..])];
        let behind = [R::load(&angle[at + 2..]), R::load(&speed[at + 2..])];
        let (pulled, _) = self.torque(at, before, here);
        let (pulls, loss) = self.torque(at + 1, here, behind);
        Twists { torque: pulled - pulls, loss }
    }

    /// Torques and losses of some links, from angles and speeds of the masses before and behind.
    #[inline(always)]
    fn torque<R: Real>(&self, at: usize, a: [R; 2], b: [R; 2]) -> (R, R) {
        let (ratio, stiffness) = (R::load(&self.ratio[at..]), R::load(&self.stiffness[at..]));
        let damping = R::load(&self.damping[at..]);
        let (twist, rate) = (ratio * (a[0] - b[0]), ratio * (a[1] - b[1]));
        let friction = damping * rate;
        (ratio * stiffness.mul_add(twist, friction), friction * rate)
    }
}
