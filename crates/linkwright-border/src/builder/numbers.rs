//! What is known of a function beforehand: tables, formulas, motion laws.

use linkwright_kernel::error::PlanError;
use linkwright_kernel::formula::{Formula as CoreFormula, Op, Variable};
use linkwright_kernel::motion_law::{MotionLaw as CoreLaw, Piece as CorePiece};
use linkwright_kernel::table::Table as CoreTable;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::plan_error;

/// Straight lines between points.
#[pyclass(frozen, from_py_object, name = "Table", module = "linkwright._core")]
#[derive(Clone)]
pub(crate) struct Knots(pub(crate) CoreTable);

#[pymethods]
impl Knots {
    /// `first`: the first of the parameters that the points are as well, all places before all values.
    #[new]
    #[pyo3(signature = (x, y, first=None))]
    fn new(x: Vec<f64>, y: Vec<f64>, first: Option<usize>) -> PyResult<Self> {
        let table = CoreTable::new(&x, &y);
        let table = table.map(|table| match first {
            Some(first) => table.with_parameters(first),
            None => table,
        });
        table.map(Knots).ok_or_else(|| {
            PyValueError::new_err("table: knots must be finite and increase, with one value each")
        })
    }
}

/// Instructions in postfix order.
#[pyclass(frozen, from_py_object, module = "linkwright._core")]
#[derive(Clone)]
pub(crate) struct Formula(pub(crate) CoreFormula);

/// What an instruction takes along: a slot or an exponent, the name of a variable, nothing.
#[derive(FromPyObject)]
enum Operand {
    Number(i64),
    Name(String),
    Nothing(Option<bool>),
}

fn instruction((op, operand): (String, Operand)) -> Option<Op> {
    match (op.as_str(), operand) {
        ("number", Operand::Number(slot)) => usize::try_from(slot).ok().map(Op::Number),
        ("zero", _) => Some(Op::Zero),
        ("name", Operand::Name(name)) => Variable::named(&name).map(Op::Variable),
        ("power", Operand::Number(exponent)) => i32::try_from(exponent).ok().map(Op::Power),
        (name, Operand::Nothing(None)) => Op::named(name),
        _ => None,
    }
}

#[pymethods]
impl Formula {
    #[new]
    fn new(instructions: Vec<(String, Operand)>) -> PyResult<Self> {
        let ops: Option<Vec<Op>> = instructions.into_iter().map(instruction).collect();
        let ops = ops.ok_or_else(|| PyValueError::new_err("formula: there is no such instruction"))?;
        CoreFormula::new(ops).map(Formula).ok_or_else(|| {
            PyValueError::new_err("formula: it does not leave one number, or keeps too many at once")
        })
    }
}

/// a cos ku + b sin ku.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone, Copy)]
pub(crate) struct Harmonic {
    frequency: f64,
    cosine: f64,
    sine: f64,
}

#[pymethods]
impl Harmonic {
    #[new]
    #[pyo3(signature = (*, frequency, cosine, sine))]
    fn new(frequency: f64, cosine: f64, sine: f64) -> Self {
        Harmonic { frequency, cosine, sine }
    }
}

/// One piece of a motion law.
#[pyclass(frozen, from_py_object, get_all, module = "linkwright._core")]
#[derive(Clone)]
pub(crate) struct Piece {
    start: f64,
    length: f64,
    polynomial: Vec<f64>,
    harmonics: Vec<Harmonic>,
}

#[pymethods]
impl Piece {
    #[new]
    #[pyo3(signature = (*, start, length, polynomial, harmonics))]
    fn new(start: f64, length: f64, polynomial: Vec<f64>, harmonics: Vec<Harmonic>) -> Self {
        Piece { start, length, polynomial, harmonics }
    }
}

/// A motion law over a revolution.
#[pyclass(frozen, from_py_object, module = "linkwright._core")]
#[derive(Clone)]
pub(crate) struct MotionLaw(pub(crate) CoreLaw);

#[pymethods]
impl MotionLaw {
    /// `first`: the first of the parameters that the numbers of the pieces are as well.
    #[new]
    #[pyo3(signature = (pieces, first=None))]
    fn new(pieces: Vec<Piece>, first: Option<usize>) -> PyResult<Self> {
        let piece = |Piece { start, length, polynomial, harmonics }| CorePiece {
            start,
            length,
            polynomial,
            harmonics: harmonics.iter().map(|wave| [wave.frequency, wave.cosine, wave.sine]).collect(),
        };
        let law = CoreLaw::new(pieces.into_iter().map(piece).collect());
        let law = law.map(|law| match first {
            Some(first) => law.with_parameters(first),
            None => law,
        });
        law.map(MotionLaw).ok_or_else(|| plan_error(PlanError::MotionLaw))
    }
}
