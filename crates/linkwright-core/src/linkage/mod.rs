//! Positions and transfer functions of a planar mechanism driven by a crank.
//!
//! | module | holds |
//! | --- | --- |
//! | [`mechanism`] | the mechanism as a program; crank, point of a link |
//! | [`motion`] | what moves, at one crank angle |
//! | [`dyads`] | rod on a fixed guide (RRP), rocker (RRR) |
//! | [`chain`] | the way from the crank to one point, link or slide, in registers |
//! | [`guided`] | guides that may turn: RRP, RPR, PRP, RPP |
//! | [`coupled`] | gears, belts, racks, cables, linear drivers, cam followers |
//! | [`folding`] | the dyads RRR and RRP through their change points |
//! | [`arm`] | where the pin of a dyad RRR passes over its pivot there |
//! | [`in_line`] | where change points are, and what is known of the motion there beforehand |
//! | [`group`] | groups that do not split into dyads |
//! | [`trace`] | what groups need to know of the motion beforehand |
//!
//! Source of the method: Assur groups solved in closed form, e.g. Artobolevsky, *Theory of Mechanisms and
//! Machines*, chapters 4–5; the derivatives follow by differentiating the loop equations written at each
//! function. A group that cannot be assembled gives NaN from its square root; its [`motion::Motion::gaps`] entry,
//! the radicand, says by how much.

pub mod arm;
pub mod chain;
pub mod coupled;
pub mod dyads;
pub mod folding;
pub mod group;
pub mod guided;
pub mod in_line;
pub mod mechanism;
pub mod motion;
pub mod trace;
