//! Steady motion of a torsionally flexible driveline that drives a mechanism with its true inertia J(φ) and loads M(φ, ω).
//!
//! | module | answers |
//! | --- | --- |
//! | [`batch`] | many machines of one structure, each from the solution of another |
//! | `bundle` | the periodic solutions of some machines at once |
//! | [`chain`] | masses, and the springs with dampers between them |
//! | [`equation`] | the equations of motion over the crank angle, and their Jacobian |
//! | `elimination` | a dense system for several right sides |
//! | [`mesh`] | steps of a cycle, the mechanism at their stages, a solution on them |
//! | [`cycle`] | Newton's method for the periodic solution, and motion from cycle to cycle |
//! | [`error`] | error of a solution in every step |
//! | [`steady`] | the periodic solution to a wanted accuracy |
//! | [`reading`] | curves and extremes of every part |
//! | [`work`] | means and work of a cycle |

pub mod batch;
mod bundle;
pub mod chain;
pub mod cycle;
mod elimination;
pub mod equation;
pub mod error;
pub mod mesh;
pub mod reading;
pub mod steady;
pub mod work;
