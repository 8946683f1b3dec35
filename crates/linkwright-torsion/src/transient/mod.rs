//! Motion of a train in time: start, stop, resonance passed, step of load, short circuit.
//!
//! | module | answers |
//! | --- | --- |
//! | [`periodic`], [`curve`] | functions of an angle; curves through points |
//! | [`torque`] | torques from outside over speed, angle and time |
//! | [`system`] | masses, links and torques as they cross the border |
//! | [`bank`] | functions of the angles of many masses, in lanes |
//! | [`between`] | errors between the ends of a step |
//! | [`chains`] | links that follow each other, in lanes |
//! | [`bond`] | a link at one instant: joints, meshes on carriers, flanks |
//! | [`stages`], [`losses`] | gear stages with efficiency: direction of power, stuck at rest |
//! | [`kinks`] | where the equations bend |
//! | [`pendulums`] | centrifugal pendulums of any swing |
//! | [`controllers`] | speed controllers |
//! | [`friction`] | clutches, brakes, freewheels: elements with dry friction, and what they do |
//! | [`contacts`] | masses that they hold together, and the torques that hold them |
//! | [`rubbing`] | their slip, and what holds those that stick |
//! | [`settle`] | states that agree with the motion at an event |
//! | [`watch`] | when an element sticks or slips in a step |
//! | [`rates`] | the equations of motion |
//! | [`stepper`] | what a method of integration can do |
//! | [`explicit`] | steps of order 8, as long as the fastest swing allows |
//! | [`implicit`] | steps of order 5, whatever the stiffness |
//! | [`equilibrium`] | torques of shafts as good as rigid |
//! | [`rounding`] | what the rounding of angles leaves of torques |
//! | [`extremes`] | Maximum and minimum torques and speeds, with their times |
//! | [`course`] | the motion from event to event, sampled |

pub mod bank;
pub mod between;
pub mod bond;
pub mod chains;
pub mod contacts;
pub mod controllers;
pub mod course;
pub mod curve;
pub mod equilibrium;
pub mod explicit;
pub mod extremes;
pub mod friction;
pub mod implicit;
pub mod kinks;
pub mod losses;
pub mod pendulums;
pub mod periodic;
pub mod rates;
pub mod rounding;
pub mod rubbing;
pub mod settle;
pub mod stages;
pub mod stepper;
pub mod system;
pub mod torque;
pub mod watch;
