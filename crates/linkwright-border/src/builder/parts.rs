//! What elements consist of: guides, sums, bars, points on bars, conditions, change points.

use linkwright_core::linkage::coupled::{Source, Sum as CoreSum};
use linkwright_core::linkage::folding;
use linkwright_core::linkage::group::{self, Condition as CoreCondition};
use linkwright_core::linkage::guided::Line as CoreLine;
use linkwright_core::plan::builder::FRAME;
use pyo3::prelude::*;

/// A straight guide on a link, or on the frame.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct Line {
    through: usize,
    link: Option<usize>,
    cos: usize,
    sin: usize,
    offset: usize,
}

#[pymethods]
impl Line {
    #[new]
    #[pyo3(signature = (*, through, link, cos, sin, offset))]
    fn new(through: usize, link: Option<usize>, cos: usize, sin: usize, offset: usize) -> Self {
        Line { through, link, cos, sin, offset }
    }
}

impl Line {
    pub(crate) fn core(self) -> CoreLine {
        let Line { through, link, cos, sin, offset } = self;
        CoreLine { through, link: link.unwrap_or(FRAME), cos, sin, offset }
    }
}

/// A slide, or the crank angle where there is none, times a factor.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct Term {
    slide: Option<usize>,
    factor: usize,
}

#[pymethods]
impl Term {
    #[new]
    #[pyo3(signature = (*, slide, factor))]
    fn new(slide: Option<usize>, factor: usize) -> Self {
        Term { slide, factor }
    }
}

/// A constant and terms.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone)]
pub(crate) struct Sum {
    start: usize,
    terms: Vec<Term>,
}

#[pymethods]
impl Sum {
    #[new]
    #[pyo3(signature = (*, start, terms))]
    fn new(start: usize, terms: Vec<Term>) -> Self {
        Sum { start, terms }
    }
}

impl Sum {
    pub(crate) fn core(&self) -> CoreSum {
        let term = |&Term { slide, factor }: &Term| (slide.map_or(Source::Drive, Source::Slide), factor);
        CoreSum { start: self.start, terms: self.terms.iter().map(term).collect() }
    }
}

/// A link between two points.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct Bar {
    link: usize,
    start: usize,
    end: usize,
    inverse_length: usize,
}

#[pymethods]
impl Bar {
    #[new]
    #[pyo3(signature = (*, link, start, end, inverse_length))]
    fn new(link: usize, start: usize, end: usize, inverse_length: usize) -> Self {
        Bar { link, start, end, inverse_length }
    }
}

impl Bar {
    pub(crate) fn core(self) -> group::Bar {
        let Bar { link, start: from, end: to, inverse_length } = self;
        group::Bar { link, from, to, inverse_length }
    }
}

/// A point fixed to a bar of a group.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct BarPoint {
    point: usize,
    start: usize,
    end: usize,
    along: usize,
    across: usize,
}

#[pymethods]
impl BarPoint {
    #[new]
    #[pyo3(signature = (*, point, start, end, along, across))]
    fn new(point: usize, start: usize, end: usize, along: usize, across: usize) -> Self {
        BarPoint { point, start, end, along, across }
    }
}

impl BarPoint {
    pub(crate) fn core(self) -> group::BarPoint {
        let BarPoint { point, start: from, end: to, along, across } = self;
        group::BarPoint { point, from, to, along, across }
    }
}

/// What holds the joints of a group.
#[pyclass(frozen, from_py_object, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) enum Condition {
    /// Two points at a distance.
    #[pyo3(constructor = (*, start, end, length))]
    Distance { start: usize, end: usize, length: usize },
    /// Two points at a distance that is a slide.
    #[pyo3(constructor = (*, start, end, slide))]
    Length { start: usize, end: usize, slide: usize },
    /// A point on a guide.
    #[pyo3(constructor = (*, point, line, slide))]
    OnLine { point: usize, line: Line, slide: usize },
    /// A point on a guide fixed to a bar of the group.
    #[pyo3(constructor = (*, point, line, slide, bar))]
    OnBar { point: usize, line: Line, slide: usize, bar: Bar },
}

impl Condition {
    pub(crate) fn core(self) -> CoreCondition {
        match self {
            Condition::Distance { start: from, end: to, length } => {
                CoreCondition::Distance { from, to, length }
            }
            Condition::Length { start: from, end: to, slide } => CoreCondition::Length { from, to, slide },
            Condition::OnLine { point, line, slide } => {
                CoreCondition::OnLine { point, line: line.core(), slide }
            }
            Condition::OnBar { point, line, slide, bar } => {
                CoreCondition::OnBar { point, line: line.core(), slide, bar: bar.core() }
            }
        }
    }
}

/// A change point, whose numbers stand in a row from a slot on.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct ChangePoint {
    first: u32,
    has_arms: bool,
}

#[pymethods]
impl ChangePoint {
    #[new]
    #[pyo3(signature = (*, first, has_arms))]
    fn new(first: u32, has_arms: bool) -> Self {
        ChangePoint { first, has_arms }
    }

    #[getter]
    fn cos(&self) -> usize {
        self.core().cos
    }

    #[getter]
    fn sin(&self) -> usize {
        self.core().sin
    }

    #[getter]
    fn reach(&self) -> usize {
        self.core().reach
    }
}

impl ChangePoint {
    pub(crate) fn core(self) -> folding::ChangePoint {
        folding::ChangePoint::stored(self.first as usize, self.has_arms)
    }
}
