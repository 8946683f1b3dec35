//! Which discs are connected by shafts, and in which order each is connected to an earlier one.
//!
//! A train falls apart where a shaft has no stiffness, as the fluid of a damper has none: its ring is then a train of
//! its own. Each part begins with a disc at an end, so that a chain is in its own order.

use super::{Train, is_positive};

/// The end of a shaft that is held.
pub const HELD: i32 = -1;

/// A train that is connected, and which disc of the whole each of its own is.
#[derive(Clone, Debug, Default)]
pub struct Part {
    pub train: Train,
    pub discs: Vec<usize>,
}

/// What a list of shafts makes of discs.
#[derive(Clone, Debug)]
pub enum Forest {
    /// Trees; shafts in parallel are taken together.
    Trees(Vec<Part>),
    /// Somewhere shafts close a loop.
    Loops,
    /// An inertia is not positive, a stiffness negative, or an end is no disc.
    Wrong,
}

impl Forest {
    /// From the inertias of the discs, and the two ends and the stiffness of every shaft; one end may be [`HELD`].
    pub fn new(inertia: &[f64], ends: &[[i32; 2]], stiffness: &[f64]) -> Self {
        let n = inertia.len() as i32;
        let sound = inertia.iter().all(|&j| is_positive(j))
            && ends.len() == stiffness.len()
            && stiffness.iter().all(|&k| k == 0.0 || is_positive(k))
            && ends.iter().flatten().all(|end| (HELD..n).contains(end));
        if !sound {
            return Forest::Wrong;
        }
        let net = Net::new(inertia.len(), ends, stiffness);
        let mut traversal =
            Traversal { place: vec![NOWHERE; inertia.len()], joined: vec![false; ends.len()] };
        let mut parts = Vec::with_capacity(1);
        for start in 0..inertia.len() {
            if traversal.place[start] == NOWHERE {
                let root = net.end_of(start);
                match traversal.grow(&net, root, inertia) {
                    Some(part) => parts.push(part),
                    None => return Forest::Loops,
                }
            }
        }
        Forest::Trees(parts)
    }
}

/// Not yet in any part.
const NOWHERE: usize = usize::MAX;

/// The shafts about each disc.
struct Net<'a> {
    ends: &'a [[i32; 2]],
    stiffness: &'a [f64],
    /// Where the shafts of each disc begin in `about`.
    first: Vec<usize>,
    about: Vec<usize>,
    /// To the ground, of each disc.
    ground: Vec<f64>,
}

impl<'a> Net<'a> {
    fn new(n: usize, ends: &'a [[i32; 2]], stiffness: &'a [f64]) -> Self {
        let mut net = Net {
            ends,
            stiffness,
            first: vec![0; n + 2],
            about: vec![0; 2 * ends.len()],
            ground: vec![0.0; n],
        };
        for (&pair, &k) in ends.iter().zip(stiffness) {
            match pair {
                [HELD, HELD] => (),
                [HELD, disc] | [disc, HELD] => net.ground[disc as usize] += k,
                _ => (),
            }
        }
        // Counted, summed up, and filled in: as a row of lists, without a list for each.
        for disc in joins(ends, stiffness).flat_map(|(_, pair)| pair) {
            net.first[disc + 2] += 1;
        }
        for disc in 2..n + 2 {
            net.first[disc] += net.first[disc - 1];
        }
        for (shaft, pair) in joins(ends, stiffness) {
            for disc in pair {
                net.about[net.first[disc + 1]] = shaft;
                net.first[disc + 1] += 1;
            }
        }
        net
    }

    fn shafts(&self, disc: usize) -> &[usize] {
        &self.about[self.first[disc]..self.first[disc + 1]]
    }

    fn other(&self, shaft: usize, disc: usize) -> usize {
        let [a, b] = self.ends[shaft].map(|end| end as usize);
        if a == disc { b } else { a }
    }

    /// A disc at an end of the part that a disc belongs to: as far as one comes without turning back.
    fn end_of(&self, disc: usize) -> usize {
        let (mut at, mut by) = (disc, NOWHERE);
        for _ in 0..self.ground.len() {
            match self.shafts(at).iter().find(|&&shaft| shaft != by) {
                Some(&shaft) => (at, by) = (self.other(shaft, at), shaft),
                None => break,
            }
        }
        at
    }
}

/// Shafts that join two discs, and which.
fn joins(ends: &[[i32; 2]], stiffness: &[f64]) -> impl Iterator<Item = (usize, [usize; 2])> {
    let each = ends.iter().zip(stiffness).enumerate();
    each.filter(|(_, ([a, b], k))| **k > 0.0 && a != b && *a != HELD && *b != HELD)
        .map(|(shaft, (pair, _))| (shaft, pair.map(|end| end as usize)))
}

/// What has been reached.
struct Traversal {
    /// Place of each disc in its part.
    place: Vec<usize>,
    /// Whether a shaft has been passed.
    joined: Vec<bool>,
}

impl Traversal {
    /// All that is connected with a disc; `None` if shafts close a loop.
    fn grow(&mut self, net: &Net<'_>, root: usize, inertia: &[f64]) -> Option<Part> {
        let n = inertia.len();
        let mut part = Part { discs: Vec::with_capacity(n), ..Part::default() };
        part.train.reserve(n);
        let mut waiting = vec![(root, 0, 0.0)];
        while let Some((disc, parent, k)) = waiting.pop() {
            self.place[disc] = part.discs.len();
            part.discs.push(disc);
            part.train.push(parent, inertia[disc], k, net.ground[disc]);
            for &shaft in net.shafts(disc) {
                if std::mem::replace(&mut self.joined[shaft], true) {
                    continue;
                }
                let (other, k) = (net.other(shaft, disc), net.stiffness[shaft]);
                match waiting.iter_mut().find(|each| each.0 == other) {
                    // In parallel to a shaft of this very disc, or else around a loop.
                    Some(each) if each.1 == self.place[disc] => each.2 += k,
                    Some(_) => return None,
                    None => waiting.push((other, self.place[disc], k)),
                }
            }
        }
        Some(part)
    }
}

impl Train {
    fn reserve(&mut self, n: usize) {
        self.parent.reserve(n);
        for list in [&mut self.inertia, &mut self.stiffness, &mut self.ground] {
            list.reserve(n);
        }
    }

    fn push(&mut self, parent: usize, inertia: f64, stiffness: f64, ground: f64) {
        self.parent.push(parent);
        self.inertia.push(inertia);
        self.stiffness.push(stiffness);
        self.ground.push(ground);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(inertia: &[f64], ends: &[[i32; 2]], stiffness: &[f64]) -> Vec<Part> {
        match Forest::new(inertia, ends, stiffness) {
            Forest::Trees(parts) => parts,
            other => panic!("no trees but {other:?}"),
        }
    }

    #[test]
    fn a_chain_in_any_order_is_a_chain() {
        let forest = parts(&[1.0, 2.0, 3.0, 4.0], &[[2, 0], [1, 3], [3, 2]], &[20.0, 13.0, 32.0]);
        assert_eq!(forest.len(), 1, "one part");
        let (train, discs) = (&forest[0].train, &forest[0].discs);
        assert_eq!(*discs, [1, 3, 2, 0], "from one end to the other");
        assert_eq!(train.parent, [0, 0, 1, 2], "each hangs on the one before");
        assert_eq!(train.stiffness[1..], [13.0, 32.0, 20.0], "by its shaft");
        assert_eq!(train.inertia, [2.0, 4.0, 3.0, 1.0], "with its inertia");
    }

    #[test]
    fn shafts_in_parallel_and_to_the_ground_add_up() {
        let ends = [[0, 1], [1, 0], [-1, 1], [1, -1], [0, 0], [0, 1]];
        let forest = parts(&[1.0, 1.0], &ends, &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0]);
        let train = &forest[0].train;
        assert_eq!(train.stiffness[1], 35.0, "between both");
        assert_eq!(train.ground.iter().sum::<f64>(), 12.0, "to the ground");
    }

    #[test]
    fn without_stiffness_it_falls_apart() {
        let forest = parts(&[1.0, 2.0, 3.0], &[[0, 1], [1, 2]], &[5.0, 0.0]);
        let inertia: Vec<&[f64]> = forest.iter().map(|part| &part.train.inertia[..]).collect();
        assert_eq!(inertia, [&[2.0, 1.0][..], &[3.0]], "the ring is alone");
        assert!(forest.iter().all(|part| part.train.is_free()), "both turn as they like");
    }

    #[test]
    fn loops_and_nonsense_are_told() {
        let shafts = |ends: &[[i32; 2]]| Forest::new(&[1.0; 4], ends, &vec![1.0; ends.len()]);
        assert!(matches!(shafts(&[[0, 1], [1, 2], [2, 0]]), Forest::Loops), "a ring");
        assert!(matches!(shafts(&[[0, 1], [2, 3], [1, 2], [1, 3]]), Forest::Loops), "a ring at the end");
        assert!(matches!(shafts(&[[0, 4]]), Forest::Wrong), "no such disc");
        assert!(matches!(shafts(&[[0, -2]]), Forest::Wrong), "no such disc");
        assert!(matches!(Forest::new(&[1.0, 0.0], &[[0, 1]], &[1.0]), Forest::Wrong), "no inertia");
        assert!(matches!(Forest::new(&[1.0, 1.0], &[[0, 1]], &[-1.0]), Forest::Wrong), "no stiffness");
    }
}
