//! Kernels of Linkwright that know mechanisms: a planar mechanism driven by a crank, reduced to the crank, and its motion.
//!
//! A subject is a room, as in the Python package; rooms use what stands below them, and modules of a room likewise. Rooms that know of
//! no mechanism, and derivatives, are crates of their own.
//!
//! | room | answers | stands on |
//! | --- | --- | --- |
//! | [`plan`] | a machine's structure as it is put together, each part checked where it is added | [`drive`], [`linkage`] |
//! | [`drive`] | reduction to the crank, steady motion, motion in time, many machines | [`linkage`] |
//! | [`linkage`] | positions and transfer functions of points, links and slides | [`kernel`] |
//! | [`kernel`] | numbers, vectors, tables, formulas, laws, methods, calls | |
//!
//! Everything is SI: m, kg, s, rad, N, N m, J. φ is the crank angle, counter-clockwise positive.

// Fields of enum variants and of plain records are named as in the equations beside them.
#![allow(missing_docs)]

pub use linkwright_kernel as kernel;

pub mod drive;
pub mod linkage;
pub mod plan;
