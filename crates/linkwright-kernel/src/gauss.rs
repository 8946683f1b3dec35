//! Gauss–Legendre quadrature with four nodes: exact to degree 7, all nodes inside the piece.
//!
//! Source: Abramowitz, Stegun, *Handbook of Mathematical Functions*, 25.4.30; to 18 digits.

/// Nodes.
pub const S: usize = 4;

/// Places of the nodes in the piece.
pub const C: [f64; S] = [
    0.069_431_844_202_973_712,
    0.330_009_478_207_571_868,
    0.669_990_521_792_428_132,
    0.930_568_155_797_026_288,
];

/// Weights of the nodes.
pub const B: [f64; S] = [
    0.173_927_422_568_726_929,
    0.326_072_577_431_273_071,
    0.326_072_577_431_273_071,
    0.173_927_422_568_726_929,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_is_exact_to_degree_seven() {
        for q in 0..8_u32 {
            let sum: f64 = (0..S).map(|j| B[j] * C[j].powi(q as i32)).sum();
            assert!((sum - 1.0 / f64::from(q + 1)).abs() < 4e-16, "degree {q}: {sum}");
        }
    }
}
