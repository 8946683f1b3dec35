//! Why one machine has no answer, while the call itself made sense.

/// Outcome for one machine; its number stands in the results of many machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Status {
    /// Solved.
    Ok = 0,
    /// Some dyad cannot be assembled at some crank angle.
    DoesNotClose = 1,
    /// No periodic motion was found.
    NoSteadyMotion = 2,
    /// Solved, but not to the accuracy asked for.
    Inaccurate = 3,
    /// A dyad passes an odd number of change points: told by who has found these, not by a solver.
    TwoTurns = 4,
    /// The motion slides along a jump of a load over the speed.
    Slides = 5,
    /// Drive and loads leave no work at a whole range of speeds: every one of them repeats.
    Neutral = 6,
    /// Whether a motion repeats was not found out within the revolutions that the search may take.
    Undecided = 7,
    /// A motion repeats as far as integration tells, but Newton's method does not hold it.
    NotConverged = 8,
}

impl Status {
    /// All of them, by number.
    pub const ALL: [Status; 9] = [
        Status::Ok,
        Status::DoesNotClose,
        Status::NoSteadyMotion,
        Status::Inaccurate,
        Status::TwoTurns,
        Status::Slides,
        Status::Neutral,
        Status::Undecided,
        Status::NotConverged,
    ];

    /// What it means.
    pub fn sentence(self) -> &'static str {
        match self {
            Status::Ok => "solved",
            Status::DoesNotClose => {
                "the mechanism does not close all round, or its lengths do not tell how it passes a change point"
            }
            Status::NoSteadyMotion => "no steady motion: the drive cannot keep the machine turning",
            Status::Inaccurate => "the accuracy was not reached",
            Status::TwoTurns => "the motion repeats only after two revolutions of the crank",
            Status::Slides => {
                "the motion slides along a jump of a load over the speed, where the load has no value of its own"
            }
            Status::Neutral => {
                "no speed of its own: drive and loads leave no work over a range of speeds, and each of them repeats"
            }
            Status::Undecided => {
                "whether there is a steady motion was not decided: the search took too many revolutions"
            }
            Status::NotConverged => "a periodic motion exists, but Newton's method does not converge to it",
        }
    }
}
