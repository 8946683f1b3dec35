//! What all subjects stand on: numbers, functions of one variable, methods, and the call from outside.
//!
//! | module | answers |
//! | --- | --- |
//! | [`real`], [`lanes`], [`dual`], [`jet`] | what a number is: scalar, SIMD lanes, with a derivative, with many |
//! | [`registers`] | registers that hold several numbers |
//! | [`interval`], [`bounds`] | all that a quantity can be over a piece; with its slope |
//! | [`branch`] | numbers that stay on one branch of a function in pieces |
//! | [`slot`] | where a number of a machine is found |
//! | [`plane`] | vectors and motions in the plane |
//! | [`table`], [`motion_law`] | straight lines between points; laws in pieces |
//! | [`formula`], [`formula_words`] | what a user writes as text, as a program; its words |
//! | [`gauss`], [`radau`], [`rk`] | quadrature of order 8; collocation of order 9; Runge–Kutta of order 8 |
//! | [`matrix`] | dense systems of equations, real or complex |
//! | [`systems`] | many systems of one shape side by side |
//! | [`series`] | series over a step, and collocation by them |
//! | [`nested`] | ten nodes of a step, five of them its stages, and one correction of Newton there |
//! | [`turns`] | where the polynomial of a step turns, past a limit or not |
//! | [`call`] | threads of a call, and how it is stopped |
//! | [`error`], [`status`] | what is wrong with what crosses the border; why a machine has no answer |

// Fields of enum variants and of plain records are named as in the equations beside them.
#![allow(missing_docs)]

pub mod bounds;
pub mod branch;
pub mod call;
pub mod dual;
pub mod error;
pub mod formula;
pub mod formula_words;
pub mod gauss;
pub mod interval;
pub mod jet;
pub mod lanes;
pub mod matrix;
pub mod motion_law;
pub mod nested;
pub mod plane;
pub mod radau;
pub mod real;
pub mod registers;
pub mod rk;
pub mod series;
pub mod slot;
pub mod status;
pub mod systems;
pub mod table;
pub mod turns;
