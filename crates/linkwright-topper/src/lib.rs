//! The knife of a root-crop topper: what its edge cuts of the heads of roots.
//!
//! | module | answers |
//! | --- | --- |
//! | [`knife`] | where the edge is, seen from the centre of a head |
//! | [`needed`] | how long the edge must be to cut all of a head |
//! | [`uncut`] | what a shorter one leaves |
//! | [`retreat`] | both, for an edge that runs backwards at times |
//! | [`heads`] | all of it for many heads, in lanes and threads |
//!
//! The machine goes along x with speed v, the knife across it with the law y(t); its edge is a segment of length L along
//! e = (sin α, cos α), and n = (cos α, −sin α) is normal to it. Seen from the centre of a head at (0, δ), the middle
//! of the edge is at
//!
//! ```text
//! q = v t sin α + (y − δ) cos α    along e
//! p = v t cos α − (y − δ) sin α    along n
//! ```
//!
//! The edge moves parallel to itself: at p it crosses the chord ±c = ±√(r² − p²) of the head, and cuts of it what lies
//! within q ± L/2. So the head is cut all through if at some crossing of each chord L/2 is no less than |q| + c; where p rises
//! all the time there is one crossing.

// Fields of enum variants and of plain records are named as in the equations beside them.
#![allow(missing_docs)]

pub mod heads;
pub mod knife;
pub mod needed;
pub mod retreat;
pub mod uncut;
