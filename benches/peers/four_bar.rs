//! A four-bar linkage and nothing else, by hand: crank angle in, joint of coupler and rocker out with first and second
//! derivative. Plain loops over arrays that the compiler turns into vector instructions; all lengths are constants.

const R: f64 = 0.1;
const D: f64 = 0.4;
const A: f64 = 0.35;
const B: f64 = 0.3;

/// Angles at once: their numbers stay in the nearest cache.
const BLOCK: usize = 64;

/// sin and cos without branches: reduction to ±π/4 in three parts, Taylor polynomials to x¹⁵ and x¹⁶.
#[inline(always)]
fn sin_cos(x: f64) -> (f64, f64) {
    const MAGIC: f64 = 6_755_399_441_055_744.0;
    let k = (x * std::f64::consts::FRAC_2_PI + MAGIC) - MAGIC;
    let y = (x - k * 1.570_796_251_296_997) - k * 7.549_789_415_861_596e-8 - k * 5.390_302_529_957_765e-15;
    let z = y * y;
    let s = y
        * (1.0
            + z * (-1.0 / 6.0
                + z * (1.0 / 120.0
                    + z * (-1.0 / 5040.0
                        + z * (1.0 / 362_880.0
                            + z * (-1.0 / 39_916_800.0
                                + z * (1.0 / 6_227_020_800.0 - z * (1.0 / 1_307_674_368_000.0))))))));
    let c = 1.0
        + z * (-0.5
            + z * (1.0 / 24.0
                + z * (-1.0 / 720.0
                    + z * (1.0 / 40_320.0
                        + z * (-1.0 / 3_628_800.0
                            + z * (1.0 / 479_001_600.0
                                + z * (-1.0 / 87_178_291_200.0 + z * (1.0 / 20_922_789_888_000.0))))))));
    let quadrant = k - 4.0 * ((k * 0.25 - 0.375 + MAGIC) - MAGIC);
    let odd = quadrant == 1.0 || quadrant == 3.0;
    let (s1, c1) = if odd { (c, s) } else { (s, c) };
    let sin = if quadrant >= 2.0 { -s1 } else { s1 };
    let cos = if quadrant == 1.0 || quadrant == 2.0 { -c1 } else { c1 };
    (sin, cos)
}

/// Writes x, y, x′, y′, x″, y″ of the joint, each a run of `n`.
///
/// # Safety
/// `phi` points to `n` numbers, `out` to `6 n`.
#[no_mangle]
pub unsafe extern "C" fn four_bar(n: usize, phi: *const f64, out: *mut f64) {
    let phi = std::slice::from_raw_parts(phi, n);
    let out = std::slice::from_raw_parts_mut(out, 6 * n);
    let mut rows = out.chunks_exact_mut(n);
    let mut row = || rows.next().unwrap();
    let (x, y, x1, y1, x2, y2) = (row(), row(), row(), row(), row(), row());
    let mut start = 0;
    while start < n {
        let end = (start + BLOCK).min(n);
        block(
            &phi[start..end],
            &mut x[start..end],
            &mut y[start..end],
            &mut x1[start..end],
            &mut y1[start..end],
            &mut x2[start..end],
            &mut y2[start..end],
        );
        start = end;
    }
}

#[inline(never)]
#[allow(clippy::too_many_arguments)]
fn block(
    phi: &[f64],
    x: &mut [f64],
    y: &mut [f64],
    x1: &mut [f64],
    y1: &mut [f64],
    x2: &mut [f64],
    y2: &mut [f64],
) {
    let n = phi.len();
    let (x, y, x1, y1, x2, y2) =
        (&mut x[..n], &mut y[..n], &mut x1[..n], &mut y1[..n], &mut x2[..n], &mut y2[..n]);
    for i in 0..n {
        let (s, c) = sin_cos(phi[i]);
        let (ax, ay) = (R * c, R * s);
        let (ux, uy) = (D - ax, -ay);
        let u2 = ux * ux + uy * uy;
        let k = u2 + (A - B) * (A + B);
        let area = (4.0 * A * A * u2 - k * k).sqrt();
        let half = 0.5 / u2;
        let (bx, by) = (half * (k * ux - area * uy), half * (k * uy + area * ux));
        let (ex, ey) = (bx / A, by / A);
        let (fx, fy) = ((bx - ux) / B, (by - uy) / B);
        let over = 2.0 / area;
        // u′ = −a′ = (ay, −ax), u″ = a
        let chi1 = (ay * fx - ax * fy) * over * B;
        let psi1 = (ay * ex - ax * ey) * over * A;
        let wx = ax + A * chi1 * chi1 * ex - B * psi1 * psi1 * fx;
        let wy = ay + A * chi1 * chi1 * ey - B * psi1 * psi1 * fy;
        let chi2 = (wx * fx + wy * fy) * over * B;
        x[i] = ax + bx;
        y[i] = ay + by;
        x1[i] = -ay - chi1 * by;
        y1[i] = ax + chi1 * bx;
        x2[i] = -ax - chi2 * by - chi1 * chi1 * bx;
        y2[i] = -ay + chi2 * bx - chi1 * chi1 * by;
    }
}
