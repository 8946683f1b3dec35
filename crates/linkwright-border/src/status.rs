//! Why a machine has no answer.

use linkwright_kernel::status::Status as CoreStatus;
use pyo3::prelude::*;

/// Outcome for one machine.
#[pyclass(frozen, eq, eq_int, hash, rename_all = "SCREAMING_SNAKE_CASE", module = "linkwright._core")]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Status {
    Ok = CoreStatus::Ok as isize,
    DoesNotClose = CoreStatus::DoesNotClose as isize,
    NoSteadyMotion = CoreStatus::NoSteadyMotion as isize,
    Inaccurate = CoreStatus::Inaccurate as isize,
    TwoTurns = CoreStatus::TwoTurns as isize,
    Slides = CoreStatus::Slides as isize,
    Neutral = CoreStatus::Neutral as isize,
    Undecided = CoreStatus::Undecided as isize,
    NotConverged = CoreStatus::NotConverged as isize,
}

impl From<CoreStatus> for Status {
    fn from(status: CoreStatus) -> Self {
        match status {
            CoreStatus::Ok => Status::Ok,
            CoreStatus::DoesNotClose => Status::DoesNotClose,
            CoreStatus::NoSteadyMotion => Status::NoSteadyMotion,
            CoreStatus::Inaccurate => Status::Inaccurate,
            CoreStatus::TwoTurns => Status::TwoTurns,
            CoreStatus::Slides => Status::Slides,
            CoreStatus::Neutral => Status::Neutral,
            CoreStatus::Undecided => Status::Undecided,
            CoreStatus::NotConverged => Status::NotConverged,
        }
    }
}

#[pymethods]
impl Status {
    /// What each number means.
    #[staticmethod]
    fn sentences() -> Vec<(u8, &'static str)> {
        CoreStatus::ALL.iter().map(|&each| (each as u8, each.sentence())).collect()
    }
}
