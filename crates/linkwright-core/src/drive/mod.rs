//! A machine reduced to its crank, and its motion. In the order of the computation:
//!
//! | module | answers |
//! | --- | --- |
//! | [`loads`] | bodies and loads: what hangs on points, links and slides |
//! | [`motor`] | motor, gearbox: torque on the crank over speed |
//! | [`motor_extremes`] | extremes of its torque and power over the speeds of a revolution |
//! | [`structure`] | what a machine consists of |
//! | [`way`] | how what a load acts on moves |
//! | [`reduce`] | J_red(φ) and M_red(φ) of bodies and loads |
//! | [`law`] | loads by formulas and tables that depend on speed or time |
//! | [`kinks`] | where the reduced machine is not smooth |
//! | `steep` | where along a motion a formula is steep |
//! | `pulses` | ends of steps there |
//! | [`layout`] | what the lanes of a revolution hold: machines or steps |
//! | [`equation`] | the equation of motion over the crank angle |
//! | [`step`], [`cycle`] | a step of its solution; steady motion on one mesh, in any lanes |
//! | [`mesh`], [`check`] | steps of one machine's turn; the error in each, measured |
//! | [`events`] | kinks and jumps at angles that depend on the motion |
//! | [`between`] | the solution inside the steps as series |
//! | `nested` | the solution at ten nodes a step: corrected, and its error |
//! | [`reading`], [`measures`], [`extremes`] | curves; work and torque of a revolution; its extremes |
//! | [`levels`] | whether a machine may have other periodic motions than one that is known |
//! | [`march`] | all motions over one revolution, from the fastest down: which repeat, and whether any does |
//! | [`steady`] | steady motion of one machine to a wanted accuracy |
//! | [`transient`] | motion in time from given angle and speed, with its events |
//! | `rows` | parameters and results of the rows of a batch |
//! | `row_mesh` | the mesh of each row of a batch, with ends of steps at kinks of the drive |
//! | `rough` | a rough motion of each row to start from |
//! | `row_lanes` | rows of a batch side by side |
//! | [`batch`] | steady motions of many machines: lanes and threads |
//! | [`motions`] | motions of many machines over the crank angle |

pub mod batch;
mod beside;
pub mod between;
pub mod check;
pub mod cycle;
mod differences;
pub mod equation;
pub mod events;
pub mod extremes;
pub mod kinks;
pub mod law;
pub mod layout;
pub mod levels;
pub mod loads;
pub mod march;
pub mod measures;
pub mod mesh;
pub mod motions;
pub mod motor;
pub mod motor_extremes;
mod nested;
mod pulses;
pub mod reading;
pub mod reduce;
mod rough;
mod row_lanes;
mod row_mesh;
mod rows;
pub mod steady;
mod steep;
pub mod step;
pub mod structure;
pub mod transient;
pub mod way;
