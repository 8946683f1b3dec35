//! Dormand–Prince 8(5,3): explicit Runge–Kutta of order 8 with step-size control, for motion in time.
//!
//! Source: Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, II.5 and the program DOP853
//! by Hairer and Wanner; the coefficients are theirs.

/// Stages.
const S: usize = 12;

const C: [f64; S] = [
    0.0,
    0.052_600_151_958_767_73,
    0.078_900_227_938_151_6,
    0.118_350_341_907_227_4,
    0.281_649_658_092_772_6,
    0.333_333_333_333_333_3,
    0.25,
    0.307_692_307_692_307_7,
    0.651_282_051_282_051_3,
    0.6,
    0.857_142_857_142_857_1,
    1.0,
];

#[rustfmt::skip]
const A: [[f64; S - 1]; S] = [
    [0.0; 11],
    [0.05260015195876773, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0197250569845379, 0.0591751709536137, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.02958758547680685, 0.0, 0.08876275643042054, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
     0.008273789163814023, 0.0, 0.0, 0.0, 0.0],
    [0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671,
     20.154067550477894, -43.48988418106996, 0.0, 0.0, 0.0],
    [0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193,
     15.279233632882423, -33.28821096898486, -0.020331201708508627, 0.0, 0.0],
    [-0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927,
     -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196, 0.0],
    [2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188,
     27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636],
];

#[rustfmt::skip]
const B: [f64; S] = [
    0.054293734116568765, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
    0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259,
];

/// Weights of the difference to the embedded solutions of order 3 and 5.
#[rustfmt::skip]
const E3: [f64; S] = [
    -0.18980075407240762, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
    -0.4226823213237919, -0.1521609496625161, 0.20136540080403034, 0.02265179219836082,
];
#[rustfmt::skip]
const E5: [f64; S] = [
    0.01312004499419488, 0.0, 0.0, 0.0, 0.0, -1.2251564463762044, -0.4957589496572502, 1.6643771824549864,
    -0.35032884874997366, 0.3341791187130175, 0.08192320648511571, -0.022355307863886294,
];

/// A state of `N` numbers.
pub type Vector<const N: usize> = [f64; N];

/// A tried step: where it leads and how large its error is against the tolerance (accept below 1).
#[derive(Clone, Copy, Debug)]
pub struct Trial<const N: usize> {
    /// State at the end.
    pub y: Vector<N>,
    /// Estimated error over tolerance.
    pub error: f64,
}

/// Tries a step of length `h` from `(t, y)` with derivative `k0` there.
pub fn try_step<const N: usize>(
    f: &mut impl FnMut(f64, &Vector<N>) -> Vector<N>,
    (t, y, k0): (f64, &Vector<N>, &Vector<N>),
    h: f64,
    scale: &impl Fn(usize, f64) -> f64,
) -> Trial<N> {
    let mut k = [[0.0; N]; S];
    k[0] = *k0;
    for i in 1..S {
        let mut stage = *y;
        for j in 0..i {
            let weight = h * A[i][j];
            for n in 0..N {
                stage[n] += weight * k[j][n];
            }
        }
        k[i] = f(t + C[i] * h, &stage);
    }
    let weigh = |weights: &[f64; S]| {
        let mut sum = [0.0; N];
        for j in 0..S {
            for n in 0..N {
                sum[n] += weights[j] * k[j][n];
            }
        }
        sum
    };
    let (rise, third, fifth) = (weigh(&B), weigh(&E3), weigh(&E5));
    let end: Vector<N> = std::array::from_fn(|n| y[n] + h * rise[n]);
    let (mut e3, mut e5) = (0.0, 0.0);
    for n in 0..N {
        let size = scale(n, y[n].abs().max(end[n].abs()));
        e3 += (third[n] / size).powi(2);
        e5 += (fifth[n] / size).powi(2);
    }
    let blend = e5 + 0.01 * e3;
    let error = if blend > 0.0 { h.abs() * e5 / (blend * N as f64).sqrt() } else { 0.0 };
    Trial { y: end, error }
}

/// Factor for the next step: nine tenths of the length that would just meet the tolerance, at most six times
/// longer, at least a tenth.
pub fn next_factor(error: f64) -> f64 {
    if error.is_nan() { 0.1 } else { (0.9 * error.powf(-1.0 / 8.0)).clamp(0.1, 6.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_eight() {
        let mut f = |_t: f64, y: &[f64; 2]| [y[1], -y[0]];
        let mut error = |h: f64| {
            let k0 = f(0.0, &[1.0, 0.0]);
            let end = try_step(&mut f, (0.0, &[1.0, 0.0], &k0), h, &|_, _| 1.0).y;
            (end[0] - h.cos()).hypot(end[1] + h.sin())
        };
        let order = (error(1.0) / error(0.5)).log2();
        assert!((order - 9.0).abs() < 0.6, "local error falls with power {order}");
    }
}
