//! Where a number of a machine is found.

/// Index of a number in the machine's list of parameters.
pub type Slot = usize;
