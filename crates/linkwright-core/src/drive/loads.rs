//! Bodies and loads of a machine: what hangs on its points, links and slides. A load is where it acts ([`At`]) times what
//! it is ([`What`]).

use crate::kernel::slot::Slot;
use serde::{Deserialize, Serialize};

/// A body: a mass at a point, or a link with its centre of mass `along`, `across` from the link's start.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub enum Body {
    Point { point: usize, mass: Slot },
    Link { link: usize, origin: usize, along: Slot, across: Slot, mass: Slot, inertia: Slot },
}

/// Where a load acts. Each but `Bodies` has a transfer function, positive in the direction of a positive force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum At {
    /// All bodies, in proportion to their mass, in the direction (`cos`, `sin`).
    Bodies { cos: Slot, sin: Slot },
    /// The crankshaft, counter-clockwise.
    Crank,
    /// A slide, along its guide; `point` is the point that slides.
    Slide { slide: usize, point: usize },
    /// A point, along its path.
    Point { point: usize },
    /// A point, in the direction (`cos`, `sin`).
    Toward { point: usize, cos: Slot, sin: Slot },
    /// A point, in a direction that turns with a link: (`cos`, `sin`) in the frame of the link.
    Along { point: usize, link: usize, cos: Slot, sin: Slot },
    /// A link, counter-clockwise.
    Link { link: usize },
    /// Two points, away from each other.
    Between { from: usize, to: usize },
    /// A link against another, or against the frame, counter-clockwise; at the free angle (`cos`, `sin`) to it its position
    /// is zero.
    BetweenLinks { link: usize, other: Option<usize>, cos: Slot, sin: Slot },
}

/// What a load is: a force, or a torque where what it acts on turns.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub enum What {
    /// Of one size; on all bodies an acceleration.
    Constant { size: Slot },
    /// Of one size, against the motion.
    Dry { size: Slot },
    /// In proportion to the speed, against it.
    Viscous { damping: Slot },
    /// Against the position, in proportion to it; `preload` at the free length.
    Spring { stiffness: Slot, free_length: Slot, preload: Slot },
    /// `force`·(column/(column − way))ⁿ after being pressed in by the way from `length`.
    Gas { force: Slot, length: Slot, column: Slot, exponent: Slot },
    /// Against the position by a table over it.
    Curve { table: usize },
    /// Against the motion by tables over the position, one for each direction.
    Resistance { forward: usize, back: usize },
    /// By a table over the crank angle that repeats after some turns.
    OverAngle { table: usize, turns: u32 },
    /// Against the motion by a table over the speed.
    OverSpeed { table: usize },
    /// By a formula. The crank angle that it knows starts again from 0 after some turns.
    Formula { formula: usize, turns: u32 },
}

/// A load.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Load {
    pub at: At,
    pub what: What,
}

/// A formula and where it acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FormulaLoad {
    pub formula: usize,
    pub at: At,
    pub turns: u32,
}

impl What {
    /// Whether it depends on the position of what it acts on.
    pub fn knows_position(&self) -> bool {
        matches!(self, What::Spring { .. } | What::Gas { .. } | What::Curve { .. } | What::Resistance { .. })
    }

    /// Whether it has a kink where what it acts on turns back.
    pub fn bends_at_rest(&self) -> bool {
        matches!(self, What::Dry { .. } | What::Resistance { .. } | What::OverSpeed { .. })
    }

    /// Whether it depends on the speed in its own way, so that it is evaluated with the speed of the moment; a formula does by its
    /// degree.
    pub fn is_law(&self) -> bool {
        matches!(self, What::OverSpeed { .. })
    }

    /// Parameters and tables that it has.
    pub fn numbers(&self) -> (Vec<Slot>, Vec<usize>) {
        match *self {
            What::Constant { size } | What::Dry { size } | What::Viscous { damping: size } => {
                (vec![size], vec![])
            }
            What::Spring { stiffness, free_length, preload } => {
                (vec![stiffness, free_length, preload], vec![])
            }
            What::Gas { force, length, column, exponent } => (vec![force, length, column, exponent], vec![]),
            What::Curve { table } | What::OverAngle { table, .. } | What::OverSpeed { table } => {
                (vec![], vec![table])
            }
            What::Resistance { forward, back } => (vec![], vec![forward, back]),
            What::Formula { .. } => (vec![], vec![]),
        }
    }
}

impl Load {
    /// Whether what it is can act where it is.
    pub fn fits(&self) -> bool {
        match self.at {
            At::Bodies { .. } => matches!(self.what, What::Constant { .. }),
            At::Crank | At::Point { .. } | At::Toward { .. } | At::Along { .. } | At::Link { .. } => {
                !self.what.knows_position()
            }
            At::Slide { .. } => true,
            At::Between { .. } | At::BetweenLinks { .. } => !matches!(self.what, What::Formula { .. }),
        }
    }

    /// Whether it has a potential: constant forces, gravity, springs.
    pub fn is_conservative(&self) -> bool {
        match self.what {
            What::Constant { .. } => matches!(self.at, At::Bodies { .. } | At::Toward { .. }),
            What::Spring { .. } | What::Gas { .. } | What::Curve { .. } => true,
            _ => false,
        }
    }

    /// The same as a load by a formula, if it is one.
    pub fn formula(&self) -> Option<FormulaLoad> {
        match self.what {
            What::Formula { formula, turns } => Some(FormulaLoad { formula, at: self.at, turns }),
            _ => None,
        }
    }
}
