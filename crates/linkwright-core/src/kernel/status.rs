//! Why one machine has no answer, while the call itself made sense.

/// Outcome for one machine; the numbers are what crosses the border.
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
}
