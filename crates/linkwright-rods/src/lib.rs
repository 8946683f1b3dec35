//! A string of sucker rods between the polished rod and the pump.
//!
//! | module | answers |
//! | --- | --- |
//! | [`complex`] | complex numbers of any kind of number |
//! | [`fourier`] | harmonics of real samples of a period, and back |
//! | [`mixing`] | fewer sweeps to a fixed point |
//! | [`string`] | the string at a frequency: transfer matrices, and the heat of its damping |
//! | [`pump`] | load of the plunger by its valves |
//! | [`prediction`] | the periodic load of the pump under a given motion of the polished rod |
//! | [`wells`] | many strings in lanes; derivatives of one |
//! | [`cards`] | position and load at every taper, by the harmonics at the polished rod |

pub mod cards;
pub mod complex;
pub mod fourier;
pub mod mixing;
pub mod prediction;
pub mod pump;
pub mod string;
pub mod wells;
