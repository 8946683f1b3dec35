//! The unit tests beside the code, of the rooms that know no mechanism, compiled with these rooms alone.
//!
//! As tests of the library they would compile every kernel of the drive a second time, which takes longer than
//! all tests together. `[lib] test = false` in Cargo.toml stands for the same reason.
#![allow(missing_docs, dead_code, unreachable_pub)]

#[path = "../src/cam/mod.rs"]
pub mod cam;
#[path = "../src/kernel/mod.rs"]
pub mod kernel;
#[path = "../src/torsion/mod.rs"]
pub mod torsion;
