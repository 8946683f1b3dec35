//! What went wrong, in words for the log of the program that asked.

// Fields say what they are.
#![allow(missing_docs)]

use std::fmt;

/// Why a model gives no answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// The data are not those of a machine, or were changed.
    Damaged(&'static str),
    /// The data are of another version.
    Version { found: u32, expected: u32 },
    /// The program has another description than the data.
    Token,
    /// No such value, or not of this type.
    Reference(u32),
    /// A value that may not be set, or not now.
    Fixed(u32),
    /// A value out of its range.
    Value { reference: u32, value: f64, range: [f64; 2] },
    /// No derivative by this, or of this.
    Derivative(u32),
    /// A list of another length.
    Length { found: usize, expected: usize },
    /// The mechanism has no acceleration.
    DoesNotClose { time: f64, degrees: f64 },
    /// The accuracy cannot be kept.
    Inaccurate { time: f64, accuracy: f64 },
    /// Events follow one another at one instant.
    Events { time: f64 },
    /// A time that lies behind.
    Time { now: f64, until: f64 },
    /// A state of another machine.
    State,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::Damaged(what) => {
                write!(f, "resources/machine.lw is damaged ({what}): export the FMU again")
            }
            Fault::Version { found, expected } => {
                write!(
                    f,
                    "resources/machine.lw has format {found}, this library reads {expected}: export the FMU again"
                )
            }
            Fault::Token => write!(
                f,
                "the identifier of modelDescription.xml is not that of resources/machine.lw: export the FMU again"
            ),
            Fault::Reference(reference) => write!(f, "value reference {reference}: no variable of this type"),
            Fault::Fixed(reference) => write!(f, "value reference {reference}: the variable cannot be set"),
            Fault::Value { reference, value, range: [low, high] } => {
                write!(
                    f,
                    "value reference {reference}: found {value:?}, expected a number from {low:?} to {high:?}"
                )
            }
            Fault::Derivative(reference) => {
                write!(f, "value reference {reference}: no derivative of or with respect to this variable")
            }
            Fault::Length { found, expected } => write!(f, "found {found} values, expected {expected}"),
            Fault::DoesNotClose { time, degrees } => write!(
                f,
                "at {time:.6} s and a crank angle of {degrees:.2}° there is no acceleration: the mechanism does not close, \
                 or a load has no value"
            ),
            Fault::Inaccurate { time, accuracy } => write!(
                f,
                "the integration stopped at {time:.6} s: steps became too small or too many for an accuracy of {accuracy:e}"
            ),
            Fault::Events { time } => write!(f, "events follow one another without end at {time:.6} s"),
            Fault::Time { now, until } => {
                write!(f, "a step from {now} s to {until} s: expected a later time")
            }
            Fault::State => write!(f, "the saved state is not one of this machine"),
        }
    }
}

impl std::error::Error for Fault {}
