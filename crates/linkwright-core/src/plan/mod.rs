//! How a machine's structure is put together: elements, bodies, loads and the drive one after another, each checked
//! where it is added.
//!
//! | module | holds |
//! | --- | --- |
//! | [`builder`] | the plan as it grows; indices that are used and made |
//! | [`elements`] | elements of the mechanism: each is made of what was made before it |
//! | [`loads`] | bodies, loads, laws |
//! | [`finish`] | the drive, and the whole |
//!
//! Points, links, slides and dyads are numbered from zero in the order in which elements make them, so that an element
//! can be placed from what stands before it, and nothing is left without a place. A plan says *what* is there and in
//! which slot of the parameter list each number is found; the numbers come separately, so that a batch of machines
//! shares one plan.

pub mod builder;
pub mod elements;
pub mod finish;
pub mod loads;

/// Number of the language in which machines, cams and trains cross the border: names of classes and of their fields,
/// order of lists and of results. It goes up with every change of what was there, here and in
/// `linkwright.machine.program.core`, whose `require` asks for what is new.
pub const FORMAT: u32 = 30;
