//! Elements of the mechanism: `linkage::mechanism::Element` of the core, with the same names. A dyad with change points is
//! the dyad with a list of them; `Element::Bar` is a link by itself.

use linkwright_core::linkage::coupled::{AngleOf, Law, Programme, Runner, Turn};
use linkwright_core::linkage::dyads::{Rocker, SliderRod};
use linkwright_core::linkage::folding::{Folding, FoldingRod};
use linkwright_core::linkage::group::Group;
use linkwright_core::linkage::guided::{Crossing, GuidedRod, SlottedLever};
use linkwright_core::linkage::mechanism::{self, Element as CoreElement};
use linkwright_kernel::table::Table;
use pyo3::prelude::*;

use super::numbers::{Formula, Knots, MotionLaw};
use super::parts::{Bar, BarPoint, ChangePoint, Condition, Line, Sum};

/// A point of the ground.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct GroundPoint {
    point: usize,
    x: usize,
    y: usize,
}

#[pymethods]
impl GroundPoint {
    #[new]
    #[pyo3(signature = (*, point, x, y))]
    fn new(point: usize, x: usize, y: usize) -> Self {
        GroundPoint { point, x, y }
    }
}

impl GroundPoint {
    pub(super) fn core(&self) -> mechanism::GroundPoint {
        mechanism::GroundPoint { point: self.point, x: self.x, y: self.y }
    }
}

/// One element. Points, links, slides and dyads by their index; lengths, angles and factors by their slot.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) enum Element {
    #[pyo3(constructor = (*, pin, link, pivot, radius, cos, sin))]
    Crank { pin: usize, link: usize, pivot: usize, radius: usize, cos: usize, sin: usize },
    #[pyo3(constructor = (*, point, link, slide, dyad, pin, through, rod, inverse_rod, offset, cos, sin, sign))]
    SliderRod {
        point: usize,
        link: usize,
        slide: usize,
        dyad: usize,
        pin: usize,
        through: usize,
        rod: usize,
        inverse_rod: usize,
        offset: usize,
        cos: usize,
        sin: usize,
        sign: usize,
    },
    #[pyo3(constructor = (*, joint, coupler_link, rocker_link, dyad, pin, pivot, coupler, rocker, inverse_coupler,
        inverse_rocker, sign, change_points))]
    Rocker {
        joint: usize,
        coupler_link: usize,
        rocker_link: usize,
        dyad: usize,
        pin: usize,
        pivot: usize,
        coupler: usize,
        rocker: usize,
        inverse_coupler: usize,
        inverse_rocker: usize,
        sign: usize,
        change_points: Vec<ChangePoint>,
    },
    #[pyo3(constructor = (*, point, link, origin, along, across))]
    RigidPoint { point: usize, link: usize, origin: usize, along: usize, across: usize },
    #[pyo3(constructor = (*, point, link, slide, dyad, pin, line, rod, inverse_rod, sign, change_points))]
    GuidedRod {
        point: usize,
        link: usize,
        slide: usize,
        dyad: usize,
        pin: usize,
        line: Line,
        rod: usize,
        inverse_rod: usize,
        sign: usize,
        change_points: Vec<ChangePoint>,
    },
    #[pyo3(constructor = (*, link, slide, dyad, pin, pivot, offset, sign))]
    SlottedLever {
        link: usize,
        slide: usize,
        dyad: usize,
        pin: usize,
        pivot: usize,
        offset: usize,
        sign: usize,
    },
    #[pyo3(constructor = (*, point, slides, dyad, lines))]
    Crossing { point: usize, slides: [usize; 2], dyad: usize, lines: [Line; 2] },
    #[pyo3(constructor = (*, link, slide, angle))]
    Turn { link: usize, slide: usize, angle: Sum },
    #[pyo3(constructor = (*, point, slide, line, place))]
    Runner { point: usize, slide: usize, line: Line, place: Sum },
    #[pyo3(constructor = (*, link, slide, winding, centre))]
    AngleOf { link: usize, slide: usize, winding: usize, centre: usize },
    #[pyo3(constructor = (*, dyad, unknowns, bar_points, bars, conditions, starts, inverse_turns, repeats))]
    Group {
        dyad: usize,
        unknowns: Vec<usize>,
        bar_points: Vec<BarPoint>,
        bars: Vec<Bar>,
        conditions: Vec<Condition>,
        starts: Vec<Knots>,
        inverse_turns: usize,
        repeats: bool,
    },
    #[pyo3(constructor = (*, bar))]
    Link { bar: Bar },
    #[pyo3(constructor = (*, slide, formula))]
    Law { slide: usize, formula: Formula },
    #[pyo3(constructor = (*, slide, phase, law))]
    Programme { slide: usize, phase: usize, law: MotionLaw },
}

impl Element {
    pub(super) fn core(&self) -> CoreElement {
        match *self {
            Element::Crank { pin, link, pivot, radius, cos, sin } => {
                CoreElement::Crank { pin, link, pivot, radius, cos, sin }
            }
            Element::SliderRod {
                point,
                link,
                slide,
                dyad: gap,
                pin,
                through,
                rod,
                inverse_rod,
                offset,
                cos,
                sin,
                sign,
            } => CoreElement::SliderRod(SliderRod {
                point,
                link,
                slide,
                gap,
                pin,
                through,
                rod,
                inverse_rod,
                offset,
                cos,
                sin,
                sign,
            }),
            Element::Rocker {
                joint,
                coupler_link,
                rocker_link,
                dyad: gap,
                pin,
                pivot,
                coupler,
                rocker,
                inverse_coupler,
                inverse_rocker,
                sign,
                ref change_points,
            } => through_change_points(
                Rocker {
                    joint,
                    coupler_link,
                    rocker_link,
                    gap,
                    pin,
                    pivot,
                    coupler,
                    rocker,
                    inverse_coupler,
                    inverse_rocker,
                    sign,
                },
                change_points,
            ),
            Element::RigidPoint { point, link, origin, along, across } => {
                CoreElement::RigidPoint { point, link, origin, along, across }
            }
            Element::GuidedRod {
                point,
                link,
                slide,
                dyad: gap,
                pin,
                line,
                rod,
                inverse_rod,
                sign,
                ref change_points,
            } => rod_through_change_points(
                GuidedRod { point, link, slide, gap, pin, line: line.core(), rod, inverse_rod, sign },
                change_points,
            ),
            Element::SlottedLever { link, slide, dyad: gap, pin, pivot, offset, sign } => {
                CoreElement::SlottedLever(SlottedLever { link, slide, gap, pin, pivot, offset, sign })
            }
            Element::Crossing { point, slides, dyad: gap, lines } => {
                CoreElement::Crossing(Crossing { point, slides, gap, lines: lines.map(Line::core) })
            }
            Element::Turn { link, slide, ref angle } => {
                CoreElement::Turn(Turn { link, slide, angle: angle.core() })
            }
            Element::Runner { point, slide, line, ref place } => {
                CoreElement::Runner(Runner { point, slide, line: line.core(), place: place.core() })
            }
            Element::AngleOf { link, slide, winding, centre } => {
                CoreElement::AngleOf(AngleOf { link, slide, winding, centre })
            }
            Element::Group {
                dyad: gap,
                ref unknowns,
                ref bar_points,
                ref bars,
                ref conditions,
                ref starts,
                inverse_turns,
                repeats,
            } => CoreElement::Group(Group {
                unknowns: unknowns.clone(),
                bar_points: bar_points.iter().copied().map(BarPoint::core).collect(),
                bars: bars.iter().copied().map(Bar::core).collect(),
                conditions: conditions.iter().copied().map(Condition::core).collect(),
                gap,
                starts: tables(starts),
                inverse_turns,
                repeats,
            }),
            Element::Link { bar } => CoreElement::Bar(bar.core()),
            Element::Law { slide, ref formula } => {
                CoreElement::Law(Law { slide, formula: formula.0.clone() })
            }
            Element::Programme { slide, phase, ref law } => {
                CoreElement::Programme(Programme { slide, phase, law: law.0.clone() })
            }
        }
    }
}

fn tables(given: &[Knots]) -> Vec<Table> {
    given.iter().map(|each| each.0.clone()).collect()
}

/// A rocker, which passes change points if there are any.
fn through_change_points(rocker: Rocker, given: &[ChangePoint]) -> CoreElement {
    if given.is_empty() {
        return CoreElement::Rocker(rocker);
    }
    let change_points = given.iter().copied().map(ChangePoint::core).collect();
    CoreElement::Folding(Folding { rocker, change_points })
}

/// The same of a rod.
fn rod_through_change_points(rod: GuidedRod, given: &[ChangePoint]) -> CoreElement {
    if given.is_empty() {
        return CoreElement::GuidedRod(rod);
    }
    let change_points = given.iter().copied().map(ChangePoint::core).collect();
    CoreElement::FoldingRod(FoldingRod { rod, change_points })
}
