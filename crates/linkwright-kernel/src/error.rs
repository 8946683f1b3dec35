//! Why a call made no sense: the caller's mistake, with the numbers in the variants.

use std::fmt;

/// A plan that contradicts itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanError {
    /// What is used and was not made before.
    Missing { what: &'static str, value: usize, made: usize },
    /// What is made and is not the next of its kind.
    Order { what: &'static str, value: usize, next: usize },
    /// An error in one element.
    In { what: &'static str, number: usize, error: Box<PlanError> },
    /// A list of the wrong length.
    Length { what: &'static str, found: usize, expected: usize },
    /// A load that cannot act where it is said to.
    Load,
    /// A motion law whose pieces do not make a revolution.
    MotionLaw,
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlanError::Missing { what, value, made } => {
                write!(f, "{what} {value} does not exist: there are {made} so far")
            }
            PlanError::Order { what, value, next } => {
                write!(f, "{what} {value} is made where {what} {next} is the next")
            }
            PlanError::In { what, number, error } => write!(f, "element {number}, a {what}: {error}"),
            PlanError::Length { what, found, expected } => {
                write!(f, "{what} has {found} entries, {expected} are needed")
            }
            PlanError::Load => write!(f, "a load of this kind cannot act there"),
            PlanError::MotionLaw => {
                write!(f, "the pieces of a motion law must follow one another over one revolution")
            }
        }
    }
}

impl std::error::Error for PlanError {}
