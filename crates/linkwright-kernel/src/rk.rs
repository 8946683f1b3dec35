//! Dormand–Prince 8(5,3): explicit Runge–Kutta of order 8 with step-size control, for motion in time.
//!
//! A state is an array on the stack, or a list whose length is known only when it runs. Between the ends of a step, a
//! polynomial of order 7 costs three more evaluations, [`Stages::fill`], and two more tell how large its error is,
//! [`Stages::error_between`].
//!
//! Source: Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, II.5 and the program DOP853
//! by Hairer and Wanner; the coefficients are theirs. Enright, *Continuous numerical methods for ODEs with defect
//! control*, J. Comput. Appl. Math. 125 (2000) 159: the error between the ends from the defect at few places.

use crate::lanes::{Job, in_single_lanes};
use crate::real::{Real, load_part, store_part};

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

/// Stages with those of the polynomial: the derivative at the end of the step, and three inside.
const S_FULL: usize = 16;

/// Times and weights of the three further stages, and the polynomial's weights of all stages.
const C_FURTHER: [f64; 3] = [0.1, 0.2, 0.7777777777777778];
#[rustfmt::skip]
const A_FURTHER: [[f64; S_FULL - 1]; 3] = [
    [0.056167502283047954, 0.0, 0.0, 0.0, 0.0, 0.0, 0.25350021021662483, -0.2462390374708025,
     -0.12419142326381637, 0.15329179827876568, 0.00820105229563469, 0.007567897660545699, -0.008298, 0.0,
     0.0],
    [0.03183464816350214, 0.0, 0.0, 0.0, 0.0, 0.028300909672366776, 0.053541988307438566,
     -0.05492374857139099, 0.0, 0.0, -0.00010834732869724932, 0.0003825710908356584, -0.00034046500868740456,
     0.1413124436746325, 0.0],
    [-0.42889630158379194, 0.0, 0.0, 0.0, 0.0, -4.697621415361164, 7.683421196062599, 4.06898981839711,
     0.3567271874552811, 0.0, 0.0, 0.0, -0.0013990241651590145, 2.9475147891527724, -9.15095847217987],
];
#[rustfmt::skip]
const D: [[f64; S_FULL]; 4] = [
    [-8.428938276109013, 0.0, 0.0, 0.0, 0.0, 0.5667149535193777, -3.0689499459498917, 2.38466765651207,
     2.117034582445028, -0.871391583777973, 2.2404374302607883, 0.6315787787694688, -0.08899033645133331,
     18.148505520854727, -9.194632392478356, -4.436036387594894],
    [10.427508642579134, 0.0, 0.0, 0.0, 0.0, 242.28349177525817, 165.20045171727028, -374.5467547226902,
     -22.113666853125306, 7.733432668472264, -30.674084731089398, -9.332130526430229, 15.697238121770845,
     -31.139403219565178, -9.35292435884448, 35.81684148639408],
    [19.985053242002433, 0.0, 0.0, 0.0, 0.0, -387.0373087493518, -189.17813819516758, 527.8081592054236,
     -11.57390253995963, 6.8812326946963, -1.0006050966910838, 0.7777137798053443, -2.778205752353508,
     -60.19669523126412, 84.32040550667716, 11.99229113618279],
    [-25.69393346270375, 0.0, 0.0, 0.0, 0.0, -154.18974869023643, -231.5293791760455, 357.6391179106141,
     93.40532418362432, -37.45832313645163, 104.0996495089623, 29.8402934266605, -43.53345659001114,
     96.32455395918828, -39.17726167561544, -149.72683625798564],
];

/// Shares of the step at which the polynomial's defect is taken: where it is large for drives and trains alike, far from the
/// places at which it vanishes (0, 0.1, 0.2, 0.5, 0.8, 1).
const WATCHED: [f64; 2] = [0.675, 0.9];

/// Largest error of the polynomial over h times the larger defect there: 0.09 to 0.25 in oscillators, drives with changing
/// inertia and trains of six discs.
const ERROR_OF_DEFECT: f64 = 0.3;

/// Share of the size of a number below which rounding hides the defect: the polynomial's weights are some hundred.
const ROUNDING: f64 = 1e-13;

/// A state of `N` numbers.
pub type Vector<const N: usize> = [f64; N];

/// What can be a state: an array, or a list.
pub trait State: Clone + AsRef<[f64]> + AsMut<[f64]> {}
impl<Y: Clone + AsRef<[f64]> + AsMut<[f64]>> State for Y {}

/// Room for the stages of a step.
#[derive(Clone, Debug)]
pub struct Stages<Y> {
    /// Derivatives; the first is that at the start of the step, the one after the stages that at its end.
    k: [Y; S_FULL],
    stage: Y,
    sums: [Y; 3],
    polynomial: [Y; 7],
    /// Over how many numbers of the state the error is averaged.
    count: usize,
}

impl<Y: State> Stages<Y> {
    /// Room for states like this one.
    pub fn new(like: &Y) -> Self {
        Self::of(like, like.as_ref().len())
    }

    /// Room for states like this one, of whose numbers so many are no zeros that fill registers.
    pub fn of(like: &Y, count: usize) -> Self {
        let room = || like.clone();
        Stages {
            k: std::array::from_fn(|_| room()),
            stage: room(),
            sums: std::array::from_fn(|_| room()),
            polynomial: std::array::from_fn(|_| room()),
            count,
        }
    }

    /// The derivative at the start of the step, to be filled in before it is tried.
    pub fn start(&mut self) -> &mut Y {
        &mut self.k[0]
    }

    /// The derivative at the end of the step, to be filled in before [`Stages::fill`] and [`Stages::advance`].
    pub fn end(&mut self) -> &mut Y {
        &mut self.k[S]
    }

    /// The derivative at the end of the step, once it has been filled in.
    pub fn end_rate(&self) -> Y {
        self.k[S].clone()
    }

    /// Lets the end of the step be the start of the next.
    pub fn advance(&mut self) {
        self.k.swap(0, S);
    }

    /// Tries a step of length `h` from `(t, y)`: writes its end and returns its error over the tolerance.
    pub fn try_step(
        &mut self,
        f: &mut impl FnMut(f64, &Y, &mut Y),
        (t, y): (f64, &Y),
        h: f64,
        scale: &impl Fn(usize, f64) -> f64,
        end: &mut Y,
    ) -> f64 {
        for i in 1..S {
            sum(self.stage.as_mut(), y.as_ref(), h, &A[i][..i], &self.k);
            f(t + C[i] * h, &self.stage, &mut self.k[i]);
        }
        for (sum, weights) in self.sums.iter_mut().zip([&B, &E3, &E5]) {
            start_with(Start::Zero, sum.as_mut(), 1.0, weights, &self.k);
        }
        let [rise, third, fifth] = self.sums.each_ref().map(AsRef::as_ref);
        let (y, end) = (y.as_ref(), end.as_mut());
        let (mut e3, mut e5) = (0.0, 0.0);
        for n in 0..y.len() {
            end[n] = y[n] + h * rise[n];
            let weight = 1.0 / scale(n, y[n].abs().max(end[n].abs()));
            e3 += (third[n] * weight).powi(2);
            e5 += (fifth[n] * weight).powi(2);
        }
        let blend = e5 + 0.01 * e3;
        // An error that is no number stays none.
        if blend == 0.0 { 0.0 } else { h.abs() * e5 / (blend * self.count as f64).sqrt() }
    }

    /// Makes the polynomial of a step that was tried from `(t, y)` and led to `end`.
    pub fn fill(&mut self, f: &mut impl FnMut(f64, &Y, &mut Y), (t, y): (f64, &Y), h: f64, end: &[f64]) {
        for (i, (c, weights)) in C_FURTHER.iter().zip(&A_FURTHER).enumerate() {
            sum(self.stage.as_mut(), y.as_ref(), h, &weights[..S + 1 + i], &self.k);
            f(t + c * h, &self.stage, &mut self.k[S + 1 + i]);
        }
        let (k0, k1) = (self.k[0].as_ref(), self.k[S].as_ref());
        for (n, (&from, &to)) in y.as_ref().iter().zip(end).enumerate() {
            let rise = to - from;
            self.polynomial[0].as_mut()[n] = rise;
            self.polynomial[1].as_mut()[n] = h * k0[n] - rise;
            self.polynomial[2].as_mut()[n] = 2.0 * rise - h * (k0[n] + k1[n]);
        }
        for (row, weights) in self.polynomial[3..].iter_mut().zip(&D) {
            start_with(Start::Zero, row.as_mut(), h, weights, &self.k);
        }
    }

    /// Number `n` of the state, which starts from `y`, at a share 0…1 of the step, after [`Stages::fill`].
    pub fn component(&self, share: f64, y: f64, n: usize) -> f64 {
        y + rise(&self.polynomial(n), share)
    }

    /// Numbers of the state from one on, which start from `y`, at a share of the step, after [`Stages::fill`].
    pub fn components(&self, share: f64, first: usize, y: &[f64], to: &mut [f64]) {
        in_single_lanes(DenseOutput {
            rows: self.polynomial.each_ref().map(|row| &row.as_ref()[first..]),
            share,
            y,
            to,
            slopes: None,
        });
    }

    /// h times the rate of number `n` at a share of the step, after [`Stages::fill`].
    pub fn slope(&self, share: f64, n: usize) -> f64 {
        let (mut sum, mut slope) = (0.0, 0.0);
        for (i, row) in self.polynomial.iter().enumerate().rev() {
            let (factor, rate) = if i % 2 == 0 { (share, 1.0) } else { (1.0 - share, -1.0) };
            sum += row.as_ref()[n];
            slope = slope * factor + sum * rate;
            sum *= factor;
        }
        slope
    }

    /// Error between the ends, after [`Stages::fill`]: from the defect h (p′ − f(t, p)) of the polynomial p, the larger of what
    /// is measured of a state and its error at two places.
    pub fn error_between(
        &mut self,
        f: &mut impl FnMut(f64, &Y, &mut Y),
        (t, y): (f64, &Y),
        h: f64,
        measure: &impl Fn(&[f64], &[f64]) -> f64,
    ) -> f64 {
        let measured = WATCHED.map(|share| {
            let [slopes, error, _] = &mut self.sums;
            let rows = self.polynomial.each_ref().map(AsRef::as_ref);
            let (y, to, slopes) = (y.as_ref(), self.stage.as_mut(), slopes.as_mut());
            in_single_lanes(DenseOutput { rows, share, y, to, slopes: Some(&mut *slopes) });
            f(t + share * h, &self.stage, error);
            for (error, slope) in error.as_mut().iter_mut().zip(slopes.iter()) {
                *error = ERROR_OF_DEFECT * (*slope - h * *error);
            }
            measure(self.stage.as_ref(), error.as_ref())
        });
        worse(measured[0], measured[1])
    }

    /// Factors of the polynomial of number `n`, after [`Stages::fill`]; [`Stages::component`] says what they mean.
    pub fn polynomial(&self, n: usize) -> [f64; 7] {
        self.polynomial.each_ref().map(|row| row.as_ref()[n])
    }
}

/// Value of a polynomial with these factors ([`Stages::polynomial`]) at a share of the step.
pub fn rise<R: Real>(factors: &[f64], share: R) -> R {
    let each = factors.iter().enumerate().rev();
    each.fold(R::splat(0.0), |sum, (i, &factor)| {
        (sum + factor) * if i % 2 == 0 { share } else { -share + 1.0 }
    })
}

/// A polynomial without constant part by its factors of z, z (1 − z), z² (1 − z), … ([`Stages::polynomial`]).
pub fn factors(powers: &[f64]) -> [f64; 7] {
    // What is left of the polynomial, divided by z and by 1 − z in turns.
    let mut rest = [0.0; 7];
    rest[..powers.len() - 1].copy_from_slice(&powers[1..]);
    let mut found = [0.0; 7];
    for (i, factor) in found.iter_mut().enumerate() {
        if i % 2 == 0 {
            // f = r(1), and (r − f)/(1 − z) has the partial sums of the coefficients behind: r − f = (1 − z) s with
            // s_p = −Σ_{q>p} r_q.
            *factor = rest.iter().sum();
            let mut behind = 0.0;
            for coefficient in rest.iter_mut().rev() {
                let own = *coefficient;
                *coefficient = -behind;
                behind += own;
            }
        } else {
            *factor = rest[0];
            rest.rotate_left(1);
            rest[6] = 0.0;
        }
    }
    found
}

/// The larger of two errors over their tolerances; one that is no number is not lost.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// An error over its tolerance, which is no smaller than what rounding of a polynomial leaves of a number of a size.
#[inline(always)]
pub fn over<R: Real>(error: R, tolerance: R, size: R) -> R {
    error.abs() / tolerance.max(size * ROUNDING)
}

/// Weights of the derivatives over a step: the first and those of [`Stages::try_step`]'s stages in order.
pub const WEIGHTS: [f64; S] = B;

/// Adds h Σ w k, in the order of the stages.
#[inline(always)]
pub fn add<Y: AsRef<[f64]>>(to: &mut [f64], h: f64, weights: &[f64], k: &[Y]) {
    start_with(Start::There, to, h, weights, k);
}

/// Writes a state and h Σ w k, in the order of the stages.
#[inline(always)]
fn sum<Y: AsRef<[f64]>>(to: &mut [f64], from: &[f64], h: f64, weights: &[f64], k: &[Y]) {
    start_with(Start::From(from), to, h, weights, k);
}

/// What a sum begins with.
#[derive(Clone, Copy)]
enum Start<'a> {
    Zero,
    /// What is there already.
    There,
    From(&'a [f64]),
}

/// Writes a sum that begins with something.
#[inline(always)]
fn start_with<Y: AsRef<[f64]>>(start: Start<'_>, to: &mut [f64], h: f64, weights: &[f64], k: &[Y]) {
    if to.len() >= LONG {
        return in_single_lanes(Sum { to, start, h, weights, k });
    }
    match start {
        Start::Zero => to.fill(0.0),
        Start::There => (),
        Start::From(from) => to.copy_from_slice(from),
    }
    for (&weight, k) in weights.iter().zip(k) {
        if weight != 0.0 {
            let weight = h * weight;
            for (to, k) in to.iter_mut().zip(k.as_ref()) {
                *to += weight * k;
            }
        }
    }
}

/// Numbers of a state from which on lanes pay.
const LONG: usize = 8;

/// [`add`] and [`sum`] in lanes, each a number of the state.
struct Sum<'a, Y> {
    to: &'a mut [f64],
    start: Start<'a>,
    h: f64,
    weights: &'a [f64],
    k: &'a [Y],
}

impl<Y: AsRef<[f64]>> Job for Sum<'_, Y> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(mut self) {
        let (n, mut first) = (self.to.len(), 0);
        // Sums beside each other do not wait for one another.
        while first + 4 * R::LANES <= n {
            self.block::<R, 4>(first);
            first += 4 * R::LANES;
        }
        while first + 2 * R::LANES <= n {
            self.block::<R, 2>(first);
            first += 2 * R::LANES;
        }
        while first + R::LANES <= n {
            self.block::<R, 1>(first);
            first += R::LANES;
        }
        for i in first..n {
            self.block::<f64, 1>(i);
        }
    }
}

impl<Y: AsRef<[f64]>> Sum<'_, Y> {
    /// Some bundles of neighbours, the first of which has a place in the state.
    #[inline(always)]
    fn block<R: Real, const N: usize>(&mut self, first: usize) {
        let Sum { to, start, h, weights, k } = self;
        let to = &mut to[first..][..N * R::LANES];
        let mut sums: [R; N] = [R::splat(0.0); N];
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum = match start {
                Start::Zero => R::splat(0.0),
                Start::There => R::load(&to[i * R::LANES..]),
                Start::From(from) => R::load(&from[first + i * R::LANES..]),
            };
        }
        for (&weight, k) in weights.iter().zip(*k) {
            if weight != 0.0 {
                let (weight, k) = (R::splat(*h * weight), &k.as_ref()[first..][..N * R::LANES]);
                for (i, sum) in sums.iter_mut().enumerate() {
                    *sum = weight.mul_add(R::load(&k[i * R::LANES..]), *sum);
                }
            }
        }
        for (i, sum) in sums.into_iter().enumerate() {
            sum.store(&mut to[i * R::LANES..]);
        }
    }
}

/// Numbers of a state at a share of a step, and h times their rates; as [`Stages::component`] and [`Stages::slope`] have
/// them, the numbers side by side.
struct DenseOutput<'a> {
    rows: [&'a [f64]; 7],
    share: f64,
    y: &'a [f64],
    to: &'a mut [f64],
    slopes: Option<&'a mut [f64]>,
}

impl Job for DenseOutput<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let DenseOutput { rows, share, y, to, mut slopes } = self;
        let n = to.len();
        let rows = rows.map(|row| &row[..n]);
        let factors: [f64; 7] = std::array::from_fn(|i| if i % 2 == 0 { share } else { 1.0 - share });
        for first in (0..n).step_by(R::LANES) {
            let (mut sum, mut slope) = (R::splat(0.0), R::splat(0.0));
            for (i, row) in rows.iter().enumerate().rev() {
                sum = sum + load_part::<R>(&row[first..]);
                slope = slope * factors[i] + if i % 2 == 0 { sum } else { -sum };
                sum = sum * factors[i];
            }
            store_part(load_part::<R>(&y[first..]) + sum, &mut to[first..]);
            if let Some(slopes) = &mut slopes {
                store_part(slope, &mut slopes[first..]);
            }
        }
    }
}

/// A tried step: where it leads and how large its error is against the tolerance (accept below 1).
#[derive(Clone, Copy, Debug)]
pub struct Trial<const N: usize> {
    /// State at the end.
    pub y: Vector<N>,
    /// Estimated error over tolerance.
    pub error: f64,
}

/// Factor for the next step: nine tenths of the length that would just meet the tolerance, at most six times
/// longer, at least a tenth.
pub fn next_factor(error: f64) -> f64 {
    next_factor_of(error, 8.0)
}

/// The same for an error that grows with this power of the length.
pub fn next_factor_of(error: f64, power: f64) -> f64 {
    if error.is_nan() { 0.1 } else { (0.9 * error.powf(-1.0 / power)).clamp(0.1, 6.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn try_step(f: &mut impl FnMut(f64, &[f64; 2]) -> [f64; 2], y: &[f64; 2], h: f64) -> [f64; 2] {
        let (mut stages, mut end) = (Stages::new(y), *y);
        *stages.start() = f(0.0, y);
        let mut f = |t: f64, y: &[f64; 2], to: &mut [f64; 2]| *to = f(t, y);
        stages.try_step(&mut f, (0.0, y), h, &|_, _| 1.0, &mut end);
        end
    }

    #[test]
    fn order_is_eight() {
        let mut f = |_t: f64, y: &[f64; 2]| [y[1], -y[0]];
        let mut error = |h: f64| {
            let end = try_step(&mut f, &[1.0, 0.0], h);
            (end[0] - h.cos()).hypot(end[1] + h.sin())
        };
        let order = (error(1.0) / error(0.5)).log2();
        assert!((order - 9.0).abs() < 0.6, "local error falls with power {order}");
    }

    /// The polynomial errs with h⁸ locally, one order less than the step.
    #[test]
    fn order_between_the_ends_is_seven() {
        let mut f = |_t: f64, y: &Vec<f64>, to: &mut Vec<f64>| {
            to[0] = y[1];
            to[1] = -y[0];
        };
        let mut error = |h: f64| {
            let (y, mut end) = (vec![1.0, 0.0], vec![0.0; 2]);
            let mut stages = Stages::new(&y);
            f(0.0, &y, stages.start());
            stages.try_step(&mut f, (0.0, &y), h, &|_, _| 1.0, &mut end);
            f(h, &end.clone(), stages.end());
            stages.fill(&mut f, (0.0, &y), h, &end);
            let off = |share: f64| {
                let [x, v] = [0, 1].map(|n| stages.component(share, y[n], n));
                (x - (share * h).cos()).hypot(v + (share * h).sin())
            };
            [0.15, 0.4, 0.7, 0.9].map(off).into_iter().fold(0.0, f64::max)
        };
        let order = (error(1.0) / error(0.5)).log2();
        assert!((order - 8.0).abs() < 0.6, "local error falls with power {order}");
    }

    /// A swing under a torque over the angle: the reported bound covers what the polynomial errs against steps of a hundredth, and
    /// is no more than ten times too large; the slope is that of the polynomial.
    #[test]
    fn error_between_the_ends_is_told() {
        let mut f = |_t: f64, y: &[f64; 2], to: &mut [f64; 2]| {
            *to = [y[1], -2.0 * y[0] + (1.7 * y[0]).sin() - 0.2 * y[1]]
        };
        for (y, h) in [([1.0, 0.3], 0.4), ([0.2, -1.0], 0.8), ([2.0, 2.0], 0.3)] {
            let (mut stages, mut end) = (Stages::new(&y), y);
            f(0.0, &y, stages.start());
            stages.try_step(&mut f, (0.0, &y), h, &|_, _| 1.0, &mut end);
            f(h, &end.clone(), stages.end());
            stages.fill(&mut f, (0.0, &y), h, &end);
            let (mut at, mut worst, parts) = (y, 0.0_f64, 100);
            for part in 1..parts {
                at = try_step(
                    &mut |t, y| {
                        let mut to = *y;
                        f(t, y, &mut to);
                        to
                    },
                    &at,
                    h / f64::from(parts),
                );
                let share = f64::from(part) / f64::from(parts);
                let off = |n: usize| (stages.component(share, y[n], n) - at[n]).abs();
                worst = worst.max(off(0)).max(off(1));
            }
            let told =
                stages.error_between(&mut f, (0.0, &y), h, &|_, off| worse(off[0].abs(), off[1].abs()));
            assert!(worst <= told && told <= 10.0 * worst, "{worst:e}, told {told:e}");
            let slope =
                (stages.component(0.3 + 1e-5, y[1], 1) - stages.component(0.3 - 1e-5, y[1], 1)) / 2e-5;
            assert!((stages.slope(0.3, 1) - slope).abs() < 1e-8, "slope");
        }
    }

    #[test]
    fn factors_are_of_the_same_polynomial() {
        let powers = [0.0, 0.7, -1.3, 2.0, 0.4, -0.9, 1.7];
        let found = factors(&powers);
        for k in 0..=10 {
            let z = f64::from(k) / 10.0;
            let by_powers: f64 = powers.iter().enumerate().map(|(p, a)| a * z.powi(p as i32)).sum();
            let term = |(i, factor): (usize, &f64)| {
                factor * z.powi(i as i32 / 2 + 1) * (1.0 - z).powi((i as i32 + 1) / 2)
            };
            let sum: f64 = found.iter().enumerate().map(term).sum();
            // A few roundings of numbers of size one.
            assert!((sum - by_powers).abs() < 1e-14, "at {z}: {sum} for {by_powers}");
        }
    }
}
