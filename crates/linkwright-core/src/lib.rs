//! Kernels of Linkwright: a planar mechanism driven by a crank, reduced to the crank, and its motion.
//!
//! In the order of the computation:
//!
//! | module | answers |
//! | --- | --- |
//! | [`real`], [`lanes`], [`dual`], [`jet`] | what a number is: scalar, SIMD lanes, with a derivative, with many |
//! | [`plane`], [`table`], [`motion_law`] | vectors and motions in the plane; tables; laws in pieces |
//! | [`plan`], [`error`] | a machine's structure as it crosses the border |
//! | [`linkage`] | positions and transfer functions of points, links and slides |
//! | [`formula`] | what a user writes as text, as a program |
//! | [`reduce`] | J_red(φ) and M_red(φ) of bodies and loads |
//! | [`further`] | loads that few machines have |
//! | [`law`] | loads by formulas and tables that depend on speed or time |
//! | [`drive`] | motor, gearbox: torque on the crank over speed |
//! | [`gauss`], [`radau`] | quadrature of order 8; collocation of order 9 |
//! | [`kinks`] | where the reduced machine is not smooth |
//! | [`layout`] | what the lanes of a turn hold: machines or steps |
//! | [`cycle`] | steady motion on one mesh, in any lanes |
//! | [`mesh`], [`check`] | steps of one machine's turn; the error in each, measured |
//! | [`reading`], [`measures`], [`extremes`] | curves; work and torque of a turn; its extremes |
//! | [`levels`] | whether a machine may have other periodic motions than one that is known |
//! | [`march`] | all motions over one turn, from the fastest down: which repeat, and whether any does |
//! | [`steady`] | steady motion of one machine to a wanted accuracy |
//! | [`rk`], [`transient`] | motion in time from given angle and speed, with its events |
//! | [`batch`] | many machines: lanes and threads |
//! | [`call`] | threads of a call, and how it is stopped |
//! | [`cam`] | profiles of cams: contact, pressure angle, curvature, many cams |
//! | [`topper`] | knives over the heads of roots: what they cut, and what they leave |
//! | [`torsion`] | natural frequencies, mode shapes and motion in time of trains of discs and shafts |
//! | [`status`] | why a machine has no answer |
//!
//! Everything is SI: m, kg, s, rad, N, N m, J. φ is the crank angle, counter-clockwise positive.

// Fields of enum variants and of plain records are named as in the equations beside them.
#![allow(missing_docs)]

pub mod batch;
pub mod call;
pub mod cam;
pub mod check;
pub mod cycle;
pub mod drive;
pub mod dual;
pub mod error;
pub mod extremes;
pub mod formula;
pub mod further;
pub mod gauss;
pub mod jet;
pub mod kinks;
pub mod lanes;
pub mod law;
pub mod layout;
pub mod levels;
pub mod linkage;
pub mod march;
pub mod measures;
pub mod mesh;
pub mod motion_law;
pub mod plan;
pub mod plane;
pub mod radau;
pub mod reading;
pub mod real;
pub mod reduce;
pub mod rk;
pub mod status;
pub mod steady;
pub mod table;
pub mod topper;
pub mod torsion;
pub mod transient;
