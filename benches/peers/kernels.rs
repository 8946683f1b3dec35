//! Kernels by hand that the product is measured against: a four-bar linkage over many angles, and the motion of a
//! slider-crank with motor over many revolutions, each lane a machine. They know one mechanism and nothing else. Plain loops
//! over arrays of fixed length, which the compiler turns into vector instructions of the processor it runs on.

use std::thread::scope;

/// Numbers at once: they stay in registers and in the nearest cache.
const BLOCK: usize = 64;

type Block = [f64; BLOCK];

/// Lengths of a four-bar linkage: crank, coupler, rocker, frame; coupler point along and across the coupler.
#[derive(Clone, Copy)]
struct FourBar {
    crank: f64,
    coupler: f64,
    rocker: f64,
    frame: f64,
    along: f64,
    across: f64,
}

impl FourBar {
    fn of(row: &[f64]) -> Self {
        let [crank, coupler, rocker, frame, along, across] = row.try_into().unwrap();
        FourBar { crank, coupler, rocker, frame, along, across }
    }

    /// x, y, x′, y′, x″, y″ of the coupler point, ψ′ and ψ″ of the rocker, from cos φ and sin φ. One root and one division:
    /// 1/(u² S) gives 1/u² and 1/S.
    #[inline(always)]
    fn at(&self, cos: f64, sin: f64) -> [f64; 8] {
        let (a, b) = (self.coupler, self.rocker);
        let (ax, ay) = (cos * self.crank, sin * self.crank);
        let (ux, uy) = (self.frame - ax, -ay);
        let square = ux.mul_add(ux, uy * uy);
        let projected = square + (a * a - b * b);
        let S = (square * (4.0 * a * a) - projected * projected).sqrt();
        let inverse = 1.0 / (square * S);
        let half = inverse * S * 0.5;
        let (p, h) = (projected * half, S * half);
        let (bx, by) = (p.mul_add(ux, -(h * uy)), p.mul_add(uy, h * ux));
        let (ex, ey) = (bx * (1.0 / a), by * (1.0 / a));
        let (fx, fy) = ((bx - ux) * (1.0 / b), (by - uy) * (1.0 / b));
        // 1/(e × f), over each length; u′ = −a′ and u″ = a.
        let cross = inverse * square * (2.0 * a * b);
        let (to_a, to_b) = (cross * (-1.0 / a), cross * (-1.0 / b));
        let chi = ax.mul_add(fy, -(ay * fx)) * to_a;
        let psi = ax.mul_add(ey, -(ay * ex)) * to_b;
        let cos_between = ex.mul_add(fx, ey * fy);
        let (at_a, at_b) = (chi * chi * a, psi * psi * b);
        let psi2 = (-(ax.mul_add(ex, ay * ey)) - at_a + at_b * cos_between) * to_b;
        let chi2 = (-(ax.mul_add(fx, ay * fy)) - at_a * cos_between + at_b) * to_a;
        let (qx, qy) = (ex * self.along - ey * self.across, ey * self.along + ex * self.across);
        let square = chi * chi;
        [
            ax + qx,
            ay + qy,
            -(chi.mul_add(qy, ay)),
            chi.mul_add(qx, ax),
            -(chi2.mul_add(qy, square.mul_add(qx, ax))),
            chi2.mul_add(qx, -(square.mul_add(qy, ay))),
            psi,
            psi2,
        ]
    }

    /// All angles of one machine: eight runs of as many numbers.
    fn sweep(&self, cos: &[f64], sin: &[f64], out: &mut [f64]) {
        let n = cos.len();
        let mut found = [[0.0; BLOCK]; 8];
        for (k, (cos, sin)) in cos.chunks(BLOCK).zip(sin.chunks(BLOCK)).enumerate() {
            let (mut c, mut s) = ([1.0; BLOCK], [0.0; BLOCK]);
            c[..cos.len()].copy_from_slice(cos);
            s[..sin.len()].copy_from_slice(sin);
            self.block(&c, &s, &mut found);
            for (run, found) in out.chunks_exact_mut(n).zip(&found) {
                run[k * BLOCK..k * BLOCK + cos.len()].copy_from_slice(&found[..cos.len()]);
            }
        }
    }

    #[inline(never)]
    fn block(&self, cos: &Block, sin: &Block, out: &mut [Block; 8]) {
        let own = *self;
        for i in 0..BLOCK {
            let found = own.at(cos[i], sin[i]);
            for k in 0..8 {
                out[k][i] = found[k];
            }
        }
    }
}

/// Motions of machines at the same angles, over some threads: `lengths` holds six numbers a machine, `out` eight runs of n
/// numbers a machine.
///
/// # Safety
/// The pointers are to as many numbers.
#[no_mangle]
pub unsafe extern "C" fn four_bars(
    machines: usize,
    lengths: *const f64,
    n: usize,
    cos: *const f64,
    sin: *const f64,
    out: *mut f64,
    threads: usize,
) {
    let lengths = std::slice::from_raw_parts(lengths, 6 * machines);
    let (cos, sin) = (std::slice::from_raw_parts(cos, n), std::slice::from_raw_parts(sin, n));
    let out = std::slice::from_raw_parts_mut(out, 8 * n * machines);
    let share = machines.div_ceil(threads);
    let tasks = lengths.chunks(6 * share).zip(out.chunks_mut(8 * n * share)).collect();
    in_threads(tasks, |(lengths, out): (&[f64], &mut [f64])| {
        for (row, out) in lengths.chunks_exact(6).zip(out.chunks_exact_mut(8 * n)) {
            FourBar::of(row).sweep(cos, sin, out);
        }
    });
}

/// A thread for each task but the last, which is done here.
fn in_threads<T: Send>(mut tasks: Vec<T>, work: impl Fn(T) + Sync) {
    let (last, work) = (tasks.pop(), &work);
    scope(|scope| {
        for task in tasks {
            scope.spawn(move || work(task));
        }
        last.map(work);
    });
}

/// One machine at many angles, over some threads: each takes a piece of the angles of all eight runs.
///
/// # Safety
/// The pointers are to as many numbers.
#[no_mangle]
pub unsafe extern "C" fn four_bar_over(
    lengths: *const f64,
    n: usize,
    phi: *const f64,
    out: *mut f64,
    threads: usize,
) {
    let linkage = FourBar::of(std::slice::from_raw_parts(lengths, 6));
    let phi = std::slice::from_raw_parts(phi, n);
    let mut runs: Vec<_> = std::slice::from_raw_parts_mut(out, 8 * n)
        .chunks_exact_mut(n)
        .map(|run| run.chunks_mut(share(n, threads)))
        .collect();
    let mut pieces = || runs.iter_mut().filter_map(Iterator::next).collect::<Vec<_>>();
    let tasks = phi.chunks(share(n, threads)).map(|phi| (phi, pieces())).collect();
    in_threads(tasks, |(phi, mut pieces): (&[f64], Vec<&mut [f64]>)| {
        let mut found = [[0.0; BLOCK]; 8];
        for (k, phi) in phi.chunks(BLOCK).enumerate() {
            let (mut cos, mut sin) = ([1.0; BLOCK], [0.0; BLOCK]);
            turned(phi, &mut cos, &mut sin);
            linkage.block(&cos, &sin, &mut found);
            for (piece, found) in pieces.iter_mut().zip(&found) {
                piece[k * BLOCK..k * BLOCK + phi.len()].copy_from_slice(&found[..phi.len()]);
            }
        }
    });
}

fn share(n: usize, threads: usize) -> usize {
    n.div_ceil(threads).next_multiple_of(BLOCK)
}

/// cos and sin without branches: reduction to ±π/4 in three parts, polynomials of fdlibm.
#[inline(never)]
fn turned(phi: &[f64], cos: &mut Block, sin: &mut Block) {
    let mut angles = [0.0; BLOCK];
    angles[..phi.len()].copy_from_slice(phi);
    for i in 0..BLOCK {
        // 1.5 · 2⁵²: adding it rounds to the nearest whole number.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        let shifted = angles[i].mul_add(std::f64::consts::FRAC_2_PI, ROUND);
        let k = shifted - ROUND;
        let x = k.mul_add(-1.570_796_326_734_125_6, angles[i]);
        let x = k.mul_add(-6.077_100_506_303_966e-11, x);
        let x = k.mul_add(-2.022_266_248_795_950_6e-21, x);
        let z = x * x;
        let s = [
            1.589_690_995_211_55e-10,
            -2.505_076_025_340_686_3e-8,
            2.755_731_370_707_006_8e-6,
            -1.984_126_982_985_795e-4,
            8.333_333_333_322_49e-3,
            -1.666_666_666_666_663_2e-1,
        ];
        let c = [
            -1.135_964_755_778_819_5e-11,
            2.087_572_321_298_175e-9,
            -2.755_731_435_139_066_3e-7,
            2.480_158_728_947_673e-5,
            -1.388_888_888_887_411e-3,
            4.166_666_666_666_66e-2,
        ];
        let (mut ps, mut pc): (f64, f64) = (s[0], c[0]);
        for j in 1..6 {
            ps = ps.mul_add(z, s[j]);
            pc = pc.mul_add(z, c[j]);
        }
        let s = (x * z).mul_add(ps, x);
        let c = (z * z).mul_add(pc, z.mul_add(-0.5, 1.0));
        let quarter = shifted.to_bits();
        let (odd, minus_sin, minus_cos) = (quarter & 1 == 1, quarter & 2 == 2, (quarter + 1) & 2 == 2);
        let (s, c) = if odd { (c, s) } else { (s, c) };
        sin[i] = if minus_sin { -s } else { s };
        cos[i] = if minus_cos { -c } else { c };
    }
}

/// Numbers of a drive: inertia at the crank; mass and inertia of the rod, mass of the slider; crank, rod, share of the rod
/// to its centre of mass; breakdown torque and slip, synchronous speed; force on the slider.
const NUMBERS: usize = 11;

/// Machines at once.
const LANES: usize = 8;

type Lanes = [f64; LANES];

#[inline(always)]
fn each(f: impl Fn(usize) -> f64) -> Lanes {
    let mut found = [0.0; LANES];
    for i in 0..LANES {
        found[i] = f(i);
    }
    found
}

/// 2 M_k s_k/J, M_r/J and J′/2J at one crank angle: what the equation of motion needs besides the speed.
#[inline(always)]
fn reduced(q: &[Lanes; NUMBERS], sin: f64, cos: f64) -> [Lanes; 3] {
    let at = |i: usize| {
        let [j1, m2, j2, m3, r, l, k, breakdown, slip, _, force] = q.map(|x| x[i]);
        let sin_b = r / l * sin;
        let cos_b = (1.0 - sin_b * sin_b).sqrt();
        let b1 = r / l * cos / cos_b;
        let b2 = (b1 * b1 * sin_b - sin_b) / cos_b;
        let (y1, y2) = (l * sin_b * b1, l * (cos_b * b1 * b1 + sin_b * b2));
        let (x1, x2) = (-(r * sin + y1), -(r * cos + y2));
        let (sx1, sx2) = (-(k * y1 + r * sin), -(k * y2 + r * cos));
        let (sy1, sy2) = ((1.0 - k) * r * cos, -(1.0 - k) * r * sin);
        let J = j1 + m2 * (sx1 * sx1 + sy1 * sy1) + j2 * b1 * b1 + m3 * x1 * x1;
        let half = m2 * (sx1 * sx2 + sy1 * sy2) + j2 * b1 * b2 + m3 * x1 * x2;
        let share = 0.5 * (1.0 + sin);
        [2.0 * breakdown * slip / J, -(force * x1) * share * share / J, half / J]
    };
    let found: [[f64; 3]; LANES] = std::array::from_fn(at);
    [each(|i| found[i][0]), each(|i| found[i][1]), each(|i| found[i][2])]
}

/// dω/dφ with Kloss's torque; it and 1/ω share a division.
#[inline(always)]
fn slope(row: &[Lanes; 3], slip: &Lanes, omega: &Lanes) -> Lanes {
    each(|i| {
        let s = 1.0 - omega[i];
        let q = s.mul_add(s, slip[i] * slip[i]);
        let m = (omega[i] * omega[i]).mul_add(row[2][i], row[1][i]);
        (row[0][i] * s - m * q) / (q * omega[i])
    })
}

/// Runge–Kutta of order 4 over a table of one revolution, which every revolution uses again: speeds over the synchronous
/// one after `turns` revolutions. `numbers` holds [`NUMBERS`] columns of machines, a multiple of the lanes; torques and
/// forces are over the square of the synchronous speed.
///
/// # Safety
/// The pointers are to as many numbers.
#[no_mangle]
pub unsafe extern "C" fn drives(
    machines: usize,
    numbers: *const f64,
    steps: usize,
    turns: usize,
    out: *mut f64,
    threads: usize,
) {
    let numbers = std::slice::from_raw_parts(numbers, NUMBERS * machines);
    let out = std::slice::from_raw_parts_mut(out, machines);
    let share = machines.div_ceil(threads).next_multiple_of(LANES);
    let tasks = out.chunks_mut(share).enumerate().collect();
    in_threads(tasks, |(task, out): (usize, &mut [f64])| {
        for (k, out) in out.chunks_exact_mut(LANES).enumerate() {
            let first = task * share + k * LANES;
            let q: [Lanes; NUMBERS] = std::array::from_fn(|n| each(|i| numbers[n * machines + first + i]));
            out.copy_from_slice(&follow(&q, steps, turns));
        }
    });
}

/// The speed of eight machines after some revolutions from 0.93 of the synchronous one.
fn follow(q: &[Lanes; NUMBERS], steps: usize, turns: usize) -> Lanes {
    let h = std::f64::consts::TAU / steps as f64;
    let table: Vec<[Lanes; 3]> = (0..=2 * steps)
        .map(|k| (0.5 * h * k as f64).sin_cos())
        .map(|(sin, cos)| reduced(q, sin, cos))
        .collect();
    let slip = q[8];
    let mut omega = [0.93; LANES];
    for _ in 0..turns {
        for rows in table.windows(3).step_by(2) {
            let k1 = slope(&rows[0], &slip, &omega);
            let k2 = slope(&rows[1], &slip, &each(|i| k1[i].mul_add(0.5 * h, omega[i])));
            let k3 = slope(&rows[1], &slip, &each(|i| k2[i].mul_add(0.5 * h, omega[i])));
            let k4 = slope(&rows[2], &slip, &each(|i| k3[i].mul_add(h, omega[i])));
            omega = each(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]).mul_add(h / 6.0, omega[i]));
        }
    }
    omega
}
