//! Motion in time of a driveline with its mechanism, from any state.
//!
//! ```text
//! J_i a_i = M_d(w_i) + Σ T,   J(φ) a + ½ J′(φ) ω² = Σ T − M_r(φ, ω, t)
//! ```
//!
//! by DOP853 ([`linkwright_kernel::rk`]), or by Radau IIA ([`linkwright_kernel::radau`]) where stability would limit its steps, with the twists and speeds against the crank as unknowns: where links are stiff these are
//! small, and known as exactly as their torque. Steps end on kinks over the angle and over speeds, where a mass comes to rest, and
//! where a torque overcomes what holds it. Works are integrated beside the motion, so that the balance of energy measures it.
//!
//! | module | answers |
//! | --- | --- |
//! | [`mounted`] | a mechanism on a mass |
//! | [`system`] | torques and rates at one instant |
//! | [`events`] | what ends a step |
//! | [`modes`] | the forms that laws have between two events, for the solver of another program |
//! | `attempt` | steps of any length from one instant, by either method |
//! | `path` | accepted steps and their events |
//! | [`start`] | what is to be followed |
//! | [`trajectory`] | a motion that was followed |
//! | [`reading`] | curves and extremes, balance of energy |

mod attempt;
pub mod events;
pub mod modes;
pub mod mounted;
mod path;
pub mod reading;
pub mod start;
pub mod system;
pub mod trajectory;

pub use self::path::{Continuation, Pace, follow};
