//! A machine as a model for other programs: states, inputs, outputs, events and derivatives by number, from data that are read once.
//!
//! | module | answers |
//! | --- | --- |
//! | [`data`] | the machine as bytes, and back |
//! | [`fault`] | what went wrong |
//! | [`quantity`] | what a value reference stands for |
//! | [`instant`] | torques, accelerations and outputs at one instant, in plain numbers or duals |
//! | [`outside`] | torques, a brake and a load behind a coupling, as the other program applies them |
//! | [`numbers`] | the numbers of the machine for values of its parameters |
//! | [`model`] | the machine with its state, and its values by reference |
//! | [`slopes`] | derivatives of values by states, inputs and parameters |
//! | [`stepping`] | the motion over an interval, and what the solver of another program asks for |
//!
//! Rigid and elastic drives have one equation, that of [`linkwright_driveline::in_time`]: a rigid drive is a driveline of the crank alone.

pub mod data;
pub mod fault;
pub mod instant;
pub mod model;
pub mod numbers;
pub mod outside;
pub mod quantity;
pub mod slopes;
pub mod stepping;

pub use self::data::{Data, Parameter};
pub use self::fault::Fault;
pub use self::model::{Model, Purpose};
pub use linkwright_kernel::lanes::{NEEDS, is_supported};
