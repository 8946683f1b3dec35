//! Formulas: random expressions against plain recursion with the functions of the standard library, lanes
//! against scalar, derivatives against differences, bounds against samples, degrees, and programs that make no sense.

mod common;

use common::Random;
use linkwright_core::kernel::bounds::Bounds;
use linkwright_core::kernel::dual::Dual;
use linkwright_core::kernel::formula::{Degree, Formula, Inputs, Op, Variable};
use linkwright_core::kernel::interval::Interval;
use linkwright_core::kernel::lanes::{Job, in_lanes};
use linkwright_core::kernel::real::{Lift, Real};

/// An expression as a tree.
enum Tree {
    Number(usize),
    Variable(Variable),
    One(Op, Box<Tree>),
    Two(Op, Box<Tree>, Box<Tree>),
    Where([Box<Tree>; 4]),
}

const VARIABLES: [Variable; 4] = [Variable::Phi, Variable::V, Variable::X, Variable::Omega];

/// Functions of one argument that have a value everywhere, or are given one by their argument.
const ONE: [Op; 12] = [
    Op::Neg,
    Op::Power(3),
    Op::Power(-2),
    Op::Sin,
    Op::Cos,
    Op::Atan,
    Op::Exp,
    Op::Log,
    Op::Sqrt,
    Op::Tanh,
    Op::Abs,
    Op::Sign,
];
const TWO: [Op; 8] = [Op::Add, Op::Sub, Op::Mul, Op::Div, Op::Pow, Op::Atan2, Op::Min, Op::Max];

fn pick<T: Copy>(random: &mut Random, from: &[T]) -> T {
    from[(random.between(0.0, from.len() as f64) as usize).min(from.len() - 1)]
}

fn tree(random: &mut Random, depth: usize) -> Tree {
    let below = |random: &mut Random| Box::new(tree(random, depth - 1));
    match if depth == 0 { random.between(0.0, 2.0) } else { random.between(0.0, 9.0) } {
        x if x < 1.0 => Tree::Number(pick(random, &[0, 1, 2])),
        x if x < 2.0 => Tree::Variable(pick(random, &VARIABLES)),
        x if x < 5.0 => Tree::One(pick(random, &ONE), below(random)),
        x if x < 8.5 => Tree::Two(pick(random, &TWO), below(random), below(random)),
        _ => Tree::Where([below(random), below(random), below(random), below(random)]),
    }
}

impl Tree {
    fn program(&self, to: &mut Vec<Op>) {
        match self {
            Tree::Number(slot) => to.push(Op::Number(*slot)),
            Tree::Variable(variable) => to.push(Op::Variable(*variable)),
            Tree::One(op, a) => {
                a.program(to);
                to.push(*op);
            }
            Tree::Two(op, a, b) => {
                a.program(to);
                b.program(to);
                to.push(*op);
            }
            Tree::Where(args) => {
                args.iter().for_each(|a| a.program(to));
                to.push(Op::Where);
            }
        }
    }

    /// The same by recursion.
    fn value(&self, q: &[f64], at: &[f64; 4]) -> f64 {
        match self {
            Tree::Number(slot) => q[*slot],
            Tree::Variable(variable) => at[VARIABLES.iter().position(|v| v == variable).expect("known")],
            Tree::One(op, a) => one(*op, a.value(q, at)),
            Tree::Two(op, a, b) => two(*op, a.value(q, at), b.value(q, at)),
            Tree::Where([a, b, x, y]) => {
                if a.value(q, at) < b.value(q, at) {
                    x.value(q, at)
                } else {
                    y.value(q, at)
                }
            }
        }
    }
}

fn one(op: Op, x: f64) -> f64 {
    match op {
        Op::Neg => -x,
        Op::Power(n) => x.powi(n),
        Op::Sin => x.sin(),
        Op::Cos => x.cos(),
        Op::Atan => x.atan(),
        Op::Exp => x.exp(),
        Op::Log => x.ln(),
        Op::Sqrt => x.sqrt(),
        Op::Tanh => x.tanh(),
        Op::Abs => x.abs(),
        Op::Sign => {
            // Unlike the library's, what is not finite has no sign.
            if x == 0.0 || !x.is_finite() { x * 0.0 } else { x.signum() }
        }
        _ => unreachable!("not of one argument"),
    }
}

fn two(op: Op, a: f64, b: f64) -> f64 {
    match op {
        Op::Add => a + b,
        Op::Sub => a - b,
        Op::Mul => a * b,
        Op::Div => a / b,
        // Whole powers have an instruction of their own; here the base must not be negative.
        Op::Pow if a < 0.0 => f64::NAN,
        Op::Pow => a.powf(b),
        Op::Atan2 => a.atan2(b),
        // Unlike the library's, a missing value does not vanish.
        Op::Min | Op::Max if a.is_nan() || b.is_nan() => f64::NAN,
        Op::Min => a.min(b),
        Op::Max => a.max(b),
        _ => unreachable!("not of two arguments"),
    }
}

fn inputs<N: Real>(at: [N; 4]) -> Inputs<N> {
    let zero = N::splat(0.0);
    let [phi, v, x, omega] = at;
    Inputs { phi, omega, time: zero, x, y: zero, vx: zero, vy: zero, v, s: zero, psi: zero, psi_dot: zero }
}

/// Expressions with the places at which they have a moderate value, far from overflow and poles.
fn samples() -> Vec<(Tree, Formula, [f64; 4])> {
    let mut random = Random(3);
    let mut found = Vec::new();
    while found.len() < 400 {
        let tree = tree(&mut random, 4);
        let mut ops = Vec::new();
        tree.program(&mut ops);
        let formula = Formula::new(ops).expect("a sound program");
        let at = [0.0; 4].map(|_| random.between(-2.0, 2.0));
        let value = tree.value(&Q, &at);
        let slope = (tree.value(&Q, &moved(at, 1e-4)) - tree.value(&Q, &moved(at, -1e-4))) / 2e-4;
        if value.is_finite() && value.abs() < 1e3 && slope.abs() < 1e3 {
            found.push((tree, formula, at));
        }
    }
    found
}

const Q: [f64; 3] = [0.7, -1.3, 2.5];

/// The place moved along a direction that no expression is special in.
fn moved(at: [f64; 4], by: f64) -> [f64; 4] {
    [at[0] + by, at[1] - 0.7 * by, at[2] + 0.4 * by, at[3] + 0.9 * by]
}

#[test]
fn values_are_those_of_the_expression() {
    for (tree, formula, at) in samples() {
        let (found, exact) = (formula.value(&Q, &inputs(at)), tree.value(&Q, &at));
        // powf and tanh are composed of exp and ln: some ulps, magnified where steep (up to 1e3).
        assert!((found - exact).abs() <= 1e-11 * (1.0 + exact.abs()), "{found} for {exact}: {formula:?}");
    }
}

/// A load that saturates with speed balances a drive that creeps: its digits count however small it is.
#[test]
fn hyperbolic_tangent_keeps_its_digits_near_zero() {
    let formula = Formula::new(vec![Op::Variable(Variable::Phi), Op::Tanh]).expect("a sound program");
    for k in -1200..=200 {
        for sign in [-1.0, 1.0] {
            let x = sign * 10.0_f64.powf(f64::from(k) / 100.0);
            let found: Dual<f64> =
                formula.value(&Q, &inputs([x, 0.0, 0.0, 0.0].map(|x| Dual { value: x, d: 1.0 })));
            assert!((found.value / x.tanh() - 1.0).abs() < 2e-15, "{} for {}", found.value, x.tanh());
            // 1 − tanh² in the form that keeps its digits far out.
            let slope = x.cosh().powi(-2);
            assert!((found.d - slope).abs() < 1e-14, "{} for {slope} at {x}", found.d);
        }
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    let mut compared = 0;
    for (tree, formula, at) in samples() {
        let along = [1.0, -0.7, 0.4, 0.9];
        let dual: [Dual<f64>; 4] = std::array::from_fn(|i| Dual { value: at[i], d: along[i] });
        let found: Dual<f64> = formula.value(&Q, &inputs(dual));
        let difference =
            |h: f64| (tree.value(&Q, &moved(at, h)) - tree.value(&Q, &moved(at, -h))) / (2.0 * h);
        let (wide, fine) = (difference(2e-4), difference(1e-4));
        // Where two differences disagree there is a kink or a pole nearby, and they say nothing.
        if (wide - fine).abs() > 1e-6 * (1.0 + fine.abs()) {
            continue;
        }
        compared += 1;
        // Richardson's step leaves h⁴ of the difference and rounding of 1e-16/1e-4 of the value.
        let exact = fine + (fine - wide) / 3.0;
        assert!((found.d - exact).abs() < 1e-6 * (1.0 + exact.abs()), "{} for {exact}: {formula:?}", found.d);
    }
    assert!(compared > 250, "only {compared} derivatives compared");
}

/// Whether a number lies in an interval but for some ulps, magnified where the expression is steep.
fn encloses(interval: Interval, x: f64) -> bool {
    let room = 1e-9 * (1.0 + x.abs());
    interval.widened(room).contains(x)
}

#[test]
fn bounds_enclose_values_and_slopes() {
    let (mut random, along, mut narrow) = (Random(5), [1.0, -0.7, 0.4, 0.9], 0);
    for (_, formula, at) in samples() {
        for _ in 0..8 {
            let h = 10.0_f64.powf(random.between(-4.0, 0.5));
            let bounds: [Bounds; 4] = std::array::from_fn(|i| Bounds {
                value: Interval::around([at[i], at[i] + h * along[i]]),
                slope: Interval::at(along[i]),
            });
            let all: Bounds = formula.value(&Q, &inputs(bounds));
            narrow += u32::from(h < 1e-2 && all.value.width() < 1.0 && all.slope.width() < 10.0);
            for k in 0..=64 {
                let place = moved(at, h * f64::from(k) / 64.0);
                let dual: [Dual<f64>; 4] = std::array::from_fn(|i| Dual { value: place[i], d: along[i] });
                let one: Dual<f64> = formula.value(&Q, &inputs(dual));
                let is_in = one.value.is_nan() || encloses(all.value, one.value);
                assert!(is_in, "{} outside {:?}: {formula:?}", one.value, all.value);
                let is_in = !one.value.is_finite() || one.d.is_nan() || encloses(all.slope, one.d);
                assert!(is_in, "slope {} outside {:?}: {formula:?}", one.d, all.slope);
            }
        }
    }
    // Most of those over a small piece say something.
    assert!(narrow > 1000, "only {narrow} bounds are narrow");
}

#[test]
fn bounds_of_functions_are_their_ranges() {
    let over = |op: Op, low: f64, high: f64| {
        let x = Bounds { value: Interval { low, high }, slope: Interval::at(1.0) };
        value_of(&[Op::Variable(Variable::X), op], x).value
    };
    let pi = std::f64::consts::PI;
    for (op, of, range) in [
        (Op::Sin, [0.3, 3.0], [3.0_f64.sin(), 1.0]),
        (Op::Sin, [-2.0, 0.5], [-1.0, 0.5_f64.sin()]),
        (Op::Sin, [1e3, 1e3 + 7.0], [-1.0, 1.0]),
        (Op::Cos, [-0.1, 0.2], [0.2_f64.cos(), 1.0]),
        (Op::Power(2), [-2.0, 1.0], [0.0, 4.0]),
        (Op::Power(-2), [-2.0, 1.0], [0.25, f64::INFINITY]),
        (Op::Abs, [-2.0, 1.0], [0.0, 2.0]),
        (Op::Exp, [-1e3, 1.0], [0.0, 1.0_f64.exp()]),
        (Op::Tanh, [-1e3, 1e3], [-1.0, 1.0]),
        (Op::Sign, [-1.0, 1.0], [-1.0, 1.0]),
        (Op::Sqrt, [0.0, 4.0], [0.0, 2.0]),
        (Op::Sqrt, [-1.0, 4.0], [f64::NEG_INFINITY, f64::INFINITY]),
        (Op::Acos, [-0.5, 0.5], [pi / 3.0, 2.0 * pi / 3.0]),
    ] {
        let found = over(op, of[0], of[1]);
        let off = |found: f64, exact: f64| found != exact && (found - exact).abs() > 1e-12;
        // What occurs twice, as in the root of 1 − x², may leave more.
        let is_wide = op == Op::Acos && found.low < range[0] && found.high > range[1];
        assert!(is_wide || !(off(found.low, range[0]) || off(found.high, range[1])), "{op:?} {found:?}");
    }
    assert!(over(Op::Sqrt, -2.0, -1.0).is_empty(), "root of negative numbers");
    assert_eq!(over(Op::Log, 0.0, 1.0), Interval { low: f64::NEG_INFINITY, high: 0.0 });
}

#[test]
fn smooth_formulas_are_not_steep() {
    let [phi, v, number] = [Op::Variable(Variable::Phi), Op::Variable(Variable::V), Op::Number(0)];
    for (ops, steep) in [
        (vec![v, number, Op::Mul], vec![]),
        (vec![phi, number, Op::Mul, Op::Cos, v, Op::Abs, Op::Mul], vec![]),
        (vec![phi, number, Op::Div, Op::Power(8)], vec![]),
        (vec![phi, number, Op::Div, Op::Power(9)], vec![3]),
        (vec![phi, Op::Cos, Op::Power(400)], vec![2]),
        (vec![number, Op::Exp, v, Op::Mul], vec![]),
        (vec![phi, number, Op::Div, Op::Power(2), Op::Neg, Op::Exp], vec![5]),
        (vec![v, Op::Tanh, phi, Op::Tanh, Op::Sub], vec![1, 3]),
        (vec![number, v, Op::Div], vec![2]),
        (vec![v, Op::Tanh, number, Op::Mul, Op::Sin], vec![1, 4]),
        (vec![v, number, Op::Sub, Op::Step], vec![3]),
        (vec![phi, number, Op::Sub, Op::Step], vec![3]),
    ] {
        let formula = Formula::new(ops).expect("a sound program");
        let found: Vec<usize> = formula.steep.iter().map(|steep| steep.at).collect();
        assert_eq!(found, steep, "{formula:?}");
        let is_switch = |at| formula.switches.iter().any(|switch| switch.at == at);
        assert!(formula.steep.iter().all(|steep| steep.jumps == is_switch(steep.at)), "{formula:?}");
    }
}

#[test]
fn arguments_that_wind_are_known() {
    let [phi, number] = [Op::Variable(Variable::Phi), Op::Number(0)];
    for (argument, winds) in [
        (vec![phi, number, Op::Sub], false),
        (vec![phi, Op::Sin], true),
        (vec![phi, number, Op::Sub, Op::Abs, number, Op::Sub], true),
        (vec![phi, number, Op::Div, Op::Exp], true),
        (vec![phi, phi, Op::Mul, number, Op::Mul], false),
    ] {
        let formula = Formula::new([argument, vec![Op::Step]].concat()).expect("a sound program");
        let last = formula.switches.last().expect("a switch");
        assert_eq!(last.winds, winds, "{formula:?}");
    }
}

/// Values and derivatives in lanes.
struct InLanes<'a>(&'a Formula, &'a [[f64; 4]]);

impl Job for InLanes<'_> {
    type Output = Vec<(f64, f64)>;
    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let q: Vec<R> = Q.iter().map(|&x| R::splat(x)).collect();
        let mut found = Vec::new();
        let (mut values, mut slopes) = (vec![0.0; R::LANES], vec![0.0; R::LANES]);
        for places in self.1.chunks_exact(R::LANES) {
            let column = |i: usize| {
                let lanes: Vec<f64> = places.iter().map(|at| at[i]).collect();
                Dual::variable(R::load(&lanes))
            };
            let dual: Dual<R> = self.0.value(&q, &inputs([column(0), column(1), column(2), column(3)]));
            dual.value.store(&mut values);
            dual.d.store(&mut slopes);
            found.extend(values.iter().copied().zip(slopes.iter().copied()));
        }
        found
    }
}

#[test]
fn lanes_are_scalar() {
    let mut random = Random(8);
    for (_, formula, _) in samples() {
        let places: Vec<[f64; 4]> = (0..32).map(|_| [0.0; 4].map(|_| random.between(-2.0, 2.0))).collect();
        for ((value, slope), at) in in_lanes(InLanes(&formula, &places)).into_iter().zip(&places) {
            let exact: Dual<f64> = formula.value(&Q, &inputs(at.map(Dual::variable)));
            for (found, exact) in [(value, exact.value), (slope, exact.d)] {
                if exact.is_nan() {
                    assert!(found.is_nan(), "{found} for NaN: {formula:?}");
                } else if exact.abs() < 1e6 {
                    // Lanes fuse products and sums: an ulp each, magnified where the expression is steep.
                    assert!(
                        (found - exact).abs() < 1e-8 * (1.0 + exact.abs()),
                        "{found}, {exact}: {formula:?}"
                    );
                }
            }
        }
    }
}

fn value_of<N: Lift<f64>>(ops: &[Op], x: N) -> N {
    let formula = Formula::new(ops.to_vec()).expect("a sound program");
    formula.value(&Q, &inputs([N::splat(0.0), N::splat(0.0), x, N::splat(0.0)]))
}

#[test]
fn functions_have_their_values_at_the_edges() {
    let x = Op::Variable(Variable::X);
    for (op, at, value) in [
        (Op::Sign, -0.0, 0.0),
        (Op::Step, 0.0, 1.0),
        (Op::Step, -1e-300, 0.0),
        (Op::Sqrt, 0.0, 0.0),
        (Op::Asin, 1.0, std::f64::consts::FRAC_PI_2),
        (Op::Acos, -1.0, std::f64::consts::PI),
        (Op::Acos, 1.0, 0.0),
        (Op::Tanh, 40.0, 1.0),
    ] {
        let found = value_of(&[x, op], at);
        assert!((found - value).abs() < 1e-15, "{op:?} of {at}: {found}");
    }
    assert!(value_of(&[x, Op::Sqrt], -1.0).is_nan(), "root of a negative number");
    assert!(value_of(&[x, Op::Zero, Op::Max], f64::NAN).is_nan(), "NaN does not vanish in a maximum");
    assert!(value_of(&[Op::Zero, x, Op::Min], f64::NAN).is_nan(), "NaN does not vanish in a minimum");
    // max(0, x)^2.5 below zero: value and slope are zero, not NaN.
    let below = value_of(&[Op::Zero, x, Op::Max, Op::Number(2), Op::Pow], Dual::variable(-1.0));
    assert_eq!((below.value, below.d), (0.0, 0.0), "value and slope");
}

#[test]
fn degrees_tell_how_a_formula_grows_with_speed() {
    let (v, x, omega) = (Variable::V, Variable::X, Variable::Omega);
    let [v, x, omega, t] = [v, x, omega, Variable::Time].map(Op::Variable);
    let number = Op::Number(0);
    for (ops, degree) in [
        (vec![v, number, Op::Mul], Degree::Of(1)),
        (vec![v, Op::Sign], Degree::Of(0)),
        (vec![v, v, Op::Abs, Op::Mul], Degree::Of(2)),
        (vec![v, Op::Power(2), omega, Op::Power(2), Op::Add, Op::Sqrt], Degree::Of(1)),
        (vec![Op::Zero, v, Op::Max], Degree::Of(1)),
        (vec![v, number, Op::Sub, Op::Sign], Degree::Mixed),
        (vec![v, omega, Op::Div, x, Op::Sin, Op::Mul], Degree::Of(0)),
        (vec![v, Op::Exp], Degree::Mixed),
        (vec![t], Degree::Mixed),
        (vec![Op::Zero, v, number, x, Op::Where], Degree::Of(0)),
        (vec![v, number, Op::Add], Degree::Mixed),
    ] {
        let formula = Formula::new(ops).expect("a sound program");
        assert_eq!(formula.degree, degree, "{formula:?}");
    }
}

#[test]
fn programs_that_make_no_sense_are_refused() {
    assert!(Formula::new(vec![]).is_none(), "nothing");
    assert!(Formula::new(vec![Op::Add]).is_none(), "nothing to add");
    assert!(Formula::new(vec![Op::Zero, Op::Zero]).is_none(), "two results");
    assert!(Formula::new([vec![Op::Zero; 17], vec![Op::Add; 16]].concat()).is_none(), "too many at once");
}
