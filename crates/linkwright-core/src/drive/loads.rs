//! Bodies and loads of a machine: what hangs on its points, links and slides.
//!
//! Loads are of three kinds, since each is worked out at its own place: those that most machines have, with the bodies
//! ([`Load`]); force elements, in a loop of their own, so that other machines do not pay for them ([`ForceElement`]);
//! and laws, which are evaluated with the speed of the moment ([`Law`]).

use crate::kernel::slot::Slot;

/// A body: a mass at a point, or a link with its centre of mass `along`, `across` from the link's start.
#[derive(Clone, Copy, Debug)]
pub enum Body {
    Point { point: usize, mass: Slot },
    Link { link: usize, origin: usize, along: Slot, across: Slot, mass: Slot, inertia: Slot },
}

/// A load. `Dry*` have a constant size and oppose the motion; `Viscous*` are proportional to speed.
#[derive(Clone, Copy, Debug)]
pub enum Load {
    DrySlide {
        slide: usize,
        force: Slot,
    },
    DryPoint {
        point: usize,
        force: Slot,
    },
    DryLink {
        link: usize,
        torque: Slot,
    },
    DryCrank {
        torque: Slot,
    },
    ViscousSlide {
        slide: usize,
        damping: Slot,
    },
    ViscousPoint {
        point: usize,
        damping: Slot,
    },
    ViscousLink {
        link: usize,
        damping: Slot,
    },
    /// A force fixed in direction and size.
    Force {
        point: usize,
        x: Slot,
        y: Slot,
    },
    /// A torque on a link, counter-clockwise positive.
    Torque {
        link: usize,
        torque: Slot,
    },
    /// Weight of every body; `x`, `y` is the acceleration of free fall.
    Gravity {
        x: Slot,
        y: Slot,
    },
    Spring {
        from: usize,
        to: usize,
        stiffness: Slot,
        free_length: Slot,
        /// Pull at the free length.
        preload: Slot,
    },
    /// Force opposing the motion of a slide by tables over its position, one for each direction.
    ForcePosition {
        slide: usize,
        forward: usize,
        back: usize,
    },
    /// Torque on the crankshaft opposing positive rotation by a table over φ that repeats after some turns.
    TorqueAngle {
        table: usize,
        turns: u32,
    },
    /// Force along a guide by a table over φ that repeats after some turns.
    ForceAngle {
        slide: usize,
        table: usize,
        turns: u32,
    },
}

impl Load {
    /// Whether it has a potential: constant force, gravity, springs.
    pub fn is_conservative(&self) -> bool {
        matches!(self, Load::Force { .. } | Load::Gravity { .. } | Load::Spring { .. })
    }
}

/// A spring by a curve, a gas spring, a torsional spring, a damper, a force that turns with a link, or a formula that
/// belongs to the reduction.
#[derive(Clone, Copy, Debug)]
pub enum ForceElement {
    /// A force of fixed size that turns with a link: `along` it, and `across` to its left.
    Follow { point: usize, link: usize, along: Slot, across: Slot },
    /// Pull by a table over the length.
    SpringTable { from: usize, to: usize, table: usize },
    /// Resistance in proportion to the speed at which two points part.
    Damper { from: usize, to: usize, damping: Slot },
    /// Push `force`·(column/(column − way))ⁿ after being pressed in by the way from `length`.
    GasSpring { from: usize, to: usize, force: Slot, length: Slot, column: Slot, exponent: Slot },
    /// Torque against the turning of a link from where it stands at the free angle (`cos`, `sin`) to
    /// another, or to the frame.
    TorsionSpring { link: usize, other: Option<usize>, stiffness: Slot, cos: Slot, sin: Slot },
    /// Torque in proportion to the speed of a link against another, or against the frame.
    TorsionDamper { link: usize, other: Option<usize>, damping: Slot },
    /// A formula that does not depend on the size of the speed.
    Formula(FormulaLoad),
    /// A formula in proportion to the speed.
    ViscousFormula(FormulaLoad),
}

impl ForceElement {
    /// Whether it has a potential: springs.
    pub fn is_conservative(&self) -> bool {
        matches!(
            self,
            ForceElement::SpringTable { .. }
                | ForceElement::TorsionSpring { .. }
                | ForceElement::GasSpring { .. }
        )
    }
}

/// What a formula acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// A slide, along its guide; `point` is the point that slides.
    Slide { slide: usize, point: usize },
    /// A point, in the direction (`cos`, `sin`).
    Point { point: usize, cos: Slot, sin: Slot },
    /// A point, in a direction that turns with a link: (`cos`, `sin`) in the frame of the link.
    Along { point: usize, link: usize, cos: Slot, sin: Slot },
    /// A link, counter-clockwise.
    Link { link: usize },
}

/// A formula and what it acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FormulaLoad {
    pub formula: usize,
    pub carrier: Carrier,
    /// Turns after which the crank angle that the formula knows starts again from 0.
    pub turns: u32,
}

/// A load that depends on the speed of the crank in its own way, or on time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    Formula(FormulaLoad),
    /// Resistance between two points by a table over the speed at which they part.
    Damper {
        from: usize,
        to: usize,
        table: usize,
    },
}
