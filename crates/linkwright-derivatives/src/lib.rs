//! Exact derivatives of motions by the numbers of a machine, in dual numbers whose lanes are directions of the parameters.
//!
//! | module | answers |
//! | --- | --- |
//! | [`along`] | derivatives of motions, inertias and kinks at given angles |
//! | [`elastic`] | derivatives of the steady motion of an elastic driveline |
//! | [`gradient`] | derivatives of steady motion |
//! | `layers` | steps in which derivatives are as exact as the motion |
//! | `peaks` | where an extreme of the acceleration is |
//! | `moving_kinks` | how kinks move with the numbers of the machine |
//! | [`variation`] | derivatives of a motion in time |

pub mod along;
pub mod elastic;
pub mod gradient;
mod layers;
mod moving_kinks;
mod peaks;
pub mod variation;
