//! Kernels of Linkwright: a planar mechanism driven by a crank, reduced to the crank, and its motion; cams, trains,
//! knives.
//!
//! A subject is a room, as in the Python package; rooms use what stands below them, and modules of a room likewise.
//! Rooms that know of no mechanism are crates:
//!
//! | room | answers | stands on |
//! | --- | --- | --- |
//! | [`plan`] | a machine's structure as it is put together, each part checked where it is added | [`drive`], [`linkage`] |
//! | [`drive`] | reduction to the crank, steady motion, motion in time, many machines | [`linkage`] |
//! | [`linkage`] | positions and transfer functions of points, links and slides | [`kernel`] |
//! | [`cam`] | profiles of cams: contact, pressure angle, curvature, many cams | [`kernel`] |
//! | [`torsion`] | natural frequencies, mode shapes and motion in time of trains of discs and shafts | [`kernel`] |
//! | [`topper`] | knives over the heads of roots: what they cut, and what they leave | [`kernel`] |
//! | [`kernel`] | numbers, vectors, tables, formulas, laws, methods, calls | |
//!
//! Everything is SI: m, kg, s, rad, N, N m, J. φ is the crank angle, counter-clockwise positive.

// Fields of enum variants and of plain records are named as in the equations beside them.
#![allow(missing_docs)]

pub use linkwright_kernel as kernel;

pub mod drive;
pub mod linkage;
pub mod plan;
