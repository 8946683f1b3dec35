//! Why a call made no sense: the caller's mistake, with the numbers in the variants.

use std::fmt;

/// A plan that contradicts itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanError {
    /// An index beyond its list.
    Index { what: &'static str, value: i32, bound: usize },
    /// A list of the wrong length.
    Length { what: &'static str, found: usize, expected: usize },
    /// An unknown kind of element, body, load or motor.
    Kind { what: &'static str, kind: i32 },
    /// A table whose knots do not increase or are not finite.
    Table { number: usize },
    /// A formula that does not leave one number, or keeps too many at once.
    Formula { number: usize },
    /// A motion law whose list ends early, or whose pieces do not make a turn.
    MotionLaw,
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlanError::Index { what, value, bound } => {
                write!(f, "{what} {value} does not exist: there are {bound}")
            }
            PlanError::Length { what, found, expected } => {
                write!(f, "{what} has {found} entries, {expected} are needed")
            }
            PlanError::Kind { what, kind } => write!(f, "there is no {what} of kind {kind}"),
            PlanError::Table { number } => {
                write!(f, "table {number}: knots must be finite and increase, with one value each")
            }
            PlanError::Formula { number } => {
                write!(f, "formula {number} does not leave one number, or keeps too many at once")
            }
            PlanError::MotionLaw => {
                write!(f, "the pieces of a motion law must follow one another over one revolution")
            }
        }
    }
}

impl std::error::Error for PlanError {}
