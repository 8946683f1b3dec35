//! Elements of the mechanism, each made of what was made before it.

use super::builder::{Builder, FRAME};
use crate::kernel::error::PlanError;
use crate::linkage::arm::{self, Arm};
use crate::linkage::coupled::{Source, Sum};
use crate::linkage::dyads::Rocker;
use crate::linkage::folding::{ChangePoint, TERMS};
use crate::linkage::group::{Bar, Condition, Group};
use crate::linkage::guided::{GuidedRod, Line};
use crate::linkage::mechanism::{Element, GroundPoint};

/// What an element is called in messages.
fn name(element: &Element) -> &'static str {
    match element {
        Element::Crank { .. } => "crank",
        Element::SliderRod(_) => "rod to a slider",
        Element::Rocker(_) => "rocker",
        Element::RigidPoint { .. } => "rigid point",
        Element::GuidedRod(_) => "rod to a guide",
        Element::SlottedLever(_) => "slotted lever",
        Element::Crossing(_) => "crossing",
        Element::Turn(_) => "turn",
        Element::Runner(_) => "runner",
        Element::AngleOf(_) => "angle of a link",
        Element::Folding(_) => "rocker with change points",
        Element::FoldingRod(_) => "rod with change points",
        Element::Group(_) => "group",
        Element::Bar(_) => "bar",
        Element::Law(_) => "law",
        Element::Programme(_) => "programme",
    }
}

/// The guides of an element.
pub(super) fn lines_of(element: &mut Element) -> Vec<&mut Line> {
    match element {
        Element::GuidedRod(e) => vec![&mut e.line],
        Element::FoldingRod(e) => vec![&mut e.rod.line],
        Element::Crossing(e) => e.lines.iter_mut().collect(),
        Element::Runner(e) => vec![&mut e.line],
        Element::Group(e) => e.conditions.iter_mut().filter_map(line_of).collect(),
        _ => Vec::new(),
    }
}

fn line_of(condition: &mut Condition) -> Option<&mut Line> {
    match condition {
        Condition::Distance { .. } | Condition::Length { .. } => None,
        Condition::OnLine { line, .. } | Condition::OnBar { line, .. } => Some(line),
    }
}

fn length(what: &'static str, found: usize, expected: usize) -> Result<(), PlanError> {
    if found == expected { Ok(()) } else { Err(PlanError::Length { what, found, expected }) }
}

impl Builder {
    /// Adds a point of the ground.
    ///
    /// # Errors
    /// It is not the next point, or a parameter does not exist.
    pub fn fixed(&mut self, fixed: GroundPoint) -> Result<(), PlanError> {
        self.slots(&[fixed.x, fixed.y])?;
        self.makes(&[fixed.point], &[], &[], &[])?;
        self.mechanism.ground.push(fixed);
        Ok(())
    }

    /// Adds an element behind those that it depends on; gives its number.
    ///
    /// # Errors
    /// It uses what was not made before, what it makes is not the next of its kind, a list has the wrong length, or a
    /// parameter does not exist. The plan is then as it was.
    pub fn element(&mut self, element: Element) -> Result<usize, PlanError> {
        let m = &self.mechanism;
        let (number, before) = (m.elements.len(), (m.n_points, m.n_links, m.n_slides, m.n_gaps));
        if let Err(error) = self.check(&element) {
            let m = &mut self.mechanism;
            (m.n_points, m.n_links, m.n_slides, m.n_gaps) = before;
            return Err(PlanError::In { what: name(&element), number, error: Box::new(error) });
        }
        self.mechanism.elements.push(element);
        Ok(number)
    }

    fn check(&mut self, element: &Element) -> Result<(), PlanError> {
        match element {
            &Element::Crank { pin, link, pivot, radius, cos, sin } => {
                self.slots(&[radius, cos, sin])?;
                self.points(&[pivot])?;
                self.makes(&[pin], &[link], &[], &[])
            }
            Element::SliderRod(e) => {
                self.slots(&[e.rod, e.inverse_rod, e.offset, e.cos, e.sin, e.sign])?;
                self.points(&[e.pin, e.through])?;
                self.makes(&[e.point], &[e.link], &[e.slide], &[e.gap])
            }
            Element::Rocker(e) => self.check_rocker(e),
            &Element::RigidPoint { point, link, origin, along, across } => {
                self.slots(&[along, across])?;
                self.points(&[origin])?;
                self.links(&[link])?;
                self.makes(&[point], &[], &[], &[])
            }
            Element::GuidedRod(e) => self.check_rod(e),
            Element::SlottedLever(e) => {
                self.slots(&[e.offset, e.sign])?;
                self.points(&[e.pin, e.pivot])?;
                self.makes(&[], &[e.link], &[e.slide], &[e.gap])
            }
            Element::Crossing(e) => {
                e.lines.iter().try_for_each(|line| self.check_line(line))?;
                self.makes(&[e.point], &[], &e.slides, &[e.gap])
            }
            Element::Turn(e) => {
                self.check_sum(&e.angle)?;
                self.makes(&[], &[e.link], &[e.slide], &[])
            }
            Element::Runner(e) => {
                self.check_line(&e.line)?;
                self.check_sum(&e.place)?;
                self.makes(&[e.point], &[], &[e.slide], &[])
            }
            Element::AngleOf(e) => {
                self.slots(&[e.winding, e.centre])?;
                self.links(&[e.link])?;
                self.makes(&[], &[], &[e.slide], &[])
            }
            Element::Folding(e) => {
                self.check_rocker(&e.rocker)?;
                e.change_points.iter().try_for_each(|at| self.check_change_point(at))
            }
            Element::FoldingRod(e) => {
                self.check_rod(&e.rod)?;
                e.change_points.iter().try_for_each(|at| self.check_change_point(at))
            }
            Element::Group(e) => self.check_group(e),
            Element::Bar(e) => {
                self.check_bar(e)?;
                self.makes(&[], &[e.link], &[], &[])
            }
            Element::Law(e) => {
                self.check_formula(&e.formula)?;
                self.makes(&[], &[], &[e.slide], &[])
            }
            Element::Programme(e) => {
                self.slots(&[e.phase])?;
                self.last_of(e.law.parameters())?;
                self.makes(&[], &[], &[e.slide], &[])
            }
        }
    }

    fn check_rocker(&mut self, e: &Rocker) -> Result<(), PlanError> {
        self.slots(&[e.coupler, e.rocker, e.inverse_coupler, e.inverse_rocker, e.sign])?;
        self.points(&[e.pin, e.pivot])?;
        self.makes(&[e.joint], &[e.coupler_link, e.rocker_link], &[], &[e.gap])
    }

    fn check_rod(&mut self, e: &GuidedRod) -> Result<(), PlanError> {
        self.slots(&[e.rod, e.inverse_rod, e.sign])?;
        self.points(&[e.pin])?;
        self.check_line(&e.line)?;
        self.makes(&[e.point], &[e.link], &[e.slide], &[e.gap])
    }

    fn check_line(&self, line: &Line) -> Result<(), PlanError> {
        self.slots(&[line.cos, line.sin, line.offset])?;
        self.points(&[line.through])?;
        if line.link == FRAME { Ok(()) } else { self.links(&[line.link]) }
    }

    fn check_sum(&self, sum: &Sum) -> Result<(), PlanError> {
        self.slots(&[sum.start])?;
        sum.terms.iter().try_for_each(|&(source, factor)| {
            self.slots(&[factor])?;
            match source {
                Source::Drive => Ok(()),
                Source::Slide(slide) => self.slides(&[slide]),
            }
        })
    }

    fn check_change_point(&self, at: &ChangePoint) -> Result<(), PlanError> {
        self.slots(&[at.cos, at.sin, at.half_cos, at.half_sin, at.reach])?;
        length("series of a change point", at.series.len(), TERMS)?;
        self.slots(&at.series)?;
        at.arms.iter().flatten().try_for_each(|arm| self.check_arm(arm))
    }

    fn check_arm(&self, arm: &Arm) -> Result<(), PlanError> {
        self.slots(&[arm.inverse_width, arm.reach])?;
        for coordinate in [&arm.x, &arm.y] {
            length("series of an arm", coordinate.len(), arm::TERMS)?;
            self.slots(coordinate)?;
        }
        Ok(())
    }

    /// The ends of a bar, and its length.
    fn check_bar(&self, bar: &Bar) -> Result<(), PlanError> {
        self.slots(&[bar.inverse_length])?;
        self.points(&[bar.from, bar.to])
    }

    /// Joints first, then points on bars, bars, and what holds them.
    fn check_group(&mut self, e: &Group) -> Result<(), PlanError> {
        length("starts of a group", e.starts.len(), 2 * e.unknowns.len())?;
        length("conditions of a group", e.conditions.len(), 2 * e.unknowns.len())?;
        self.slots(&[e.inverse_turns])?;
        self.makes(&e.unknowns, &[], &[], &[e.gap])?;
        for each in &e.bar_points {
            self.slots(&[each.along, each.across])?;
            self.points(&[each.from, each.to])?;
            self.makes(&[each.point], &[], &[], &[])?;
        }
        for bar in &e.bars {
            self.check_bar(bar)?;
            self.makes(&[], &[bar.link], &[], &[])?;
        }
        e.conditions.iter().try_for_each(|condition| self.check_condition(condition))
    }

    fn check_condition(&mut self, condition: &Condition) -> Result<(), PlanError> {
        match *condition {
            Condition::Distance { from, to, length } => {
                self.slots(&[length])?;
                self.points(&[from, to])
            }
            Condition::Length { from, to, slide } => {
                self.slides(&[slide])?;
                self.points(&[from, to])
            }
            Condition::OnLine { point, line, slide } => {
                self.points(&[point])?;
                self.check_line(&line)?;
                self.makes(&[], &[], &[slide], &[])
            }
            Condition::OnBar { point, line, slide, bar } => {
                self.points(&[point])?;
                self.check_line(&line)?;
                self.check_bar(&bar)?;
                self.links(&[bar.link])?;
                self.makes(&[], &[], &[slide], &[])
            }
        }
    }
}
