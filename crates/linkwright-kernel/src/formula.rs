//! Formulas: what a user writes as text, `-200*v - 50*sign(v)`, as a program for a small stack.
//!
//! The text is read and checked before it comes here; a [`Formula`] is its postfix form, worked through with
//! any kind of number: lanes do many angles or many machines, duals bring the exact derivative along.
//!
//! Three things are found out about a formula before it is used. Its **degree** in the speed of the crank: all
//! velocities are in proportion to ω, so a product of two of them has degree 2, and `sign(v)` has degree 0.
//! Its **switches**, the arguments of `abs`, `sign`, `step`, `min`, `max` and `where` whose zeros are
//! kinks or jumps. And where it may be **steep**: the instructions whose result may change within a small part of the
//! range of the variables.

use crate::out_of_line;
use crate::real::{Lift, Real};
use crate::slot::Slot;
use serde::{Deserialize, Serialize};

/// What a formula may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum Variable {
    /// Crank angle within the revolution \[rad\].
    Phi,
    /// Speed of the crank \[rad/s\].
    Omega,
    /// Time \[s\].
    Time,
    /// Position of the loaded point \[m\].
    X,
    Y,
    /// Its velocity \[m/s\].
    Vx,
    Vy,
    /// Speed along the guide; of a point, the size of its velocity \[m/s\].
    V,
    /// Coordinate along the guide \[m\].
    S,
    /// Angle of the link, within ±π \[rad\].
    Psi,
    /// Its angular speed \[rad/s\].
    PsiDot,
}

/// One instruction. What it takes is on top of the stack, the last argument uppermost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Op {
    /// Puts a parameter there.
    Number(Slot),
    /// Puts zero there, which has any degree.
    Zero,
    /// Puts a variable there.
    Variable(Variable),
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    /// A whole power.
    Power(i32),
    /// Any power of a number that is not negative.
    Pow,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Exp,
    Log,
    Sqrt,
    Tanh,
    Abs,
    /// −1, 0 or 1.
    Sign,
    /// 0 below zero, else 1.
    Step,
    Min,
    Max,
    /// Of a, b, x, y: x where a < b, else y.
    Where,
}

/// Values of the variables.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<N> {
    pub phi: N,
    pub omega: N,
    pub time: N,
    pub x: N,
    pub y: N,
    pub vx: N,
    pub vy: N,
    pub v: N,
    pub s: N,
    pub psi: N,
    pub psi_dot: N,
}

/// How a quantity grows with the speed of the crank when the speeds of all points grow with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Degree {
    /// Zero, whatever the speed.
    Any,
    /// In proportion to this power of ω > 0.
    Of(i32),
    /// Not in proportion to a power of ω, or it depends on time.
    Mixed,
}

impl Degree {
    /// Of a sum.
    fn with(self, other: Degree) -> Degree {
        match (self, other) {
            (Degree::Any, only) | (only, Degree::Any) => only,
            (Degree::Of(a), Degree::Of(b)) if a == b => self,
            _ => Degree::Mixed,
        }
    }

    /// Of a product (`sign` 1) or quotient (−1).
    fn times(self, other: Degree, sign: i32) -> Degree {
        match (self, other) {
            (Degree::Of(a), Degree::Of(b)) => Degree::Of(a + sign * b),
            (Degree::Mixed, _) | (_, Degree::Mixed) => Degree::Mixed,
            _ => Degree::Any,
        }
    }

    /// Of a function that is no power.
    fn through(self) -> Degree {
        if matches!(self, Degree::Any | Degree::Of(0)) { Degree::Of(0) } else { Degree::Mixed }
    }

    /// Of a function of the sign alone.
    fn sign(self) -> Degree {
        if self == Degree::Mixed { Degree::Mixed } else { Degree::Of(0) }
    }

    fn root(self) -> Degree {
        match self {
            Degree::Of(n) if n % 2 == 0 => Degree::Of(n / 2),
            Degree::Any => Degree::Any,
            _ => Degree::Mixed,
        }
    }
}

/// An argument whose zero is a kink or a jump, in front of the instruction at this place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Switch {
    pub at: usize,
    /// How it grows with speed: where it is of one degree, its zeros are angles that no speed moves.
    pub degree: Degree,
    /// Whether it has kinks or waves or may be steep: there may be zeros wherever one looks.
    pub winds: bool,
    /// Whether what is made of the result may jump there; of others it has a kink.
    pub jumps: bool,
}

impl Switch {
    /// Whether its zeros are angles that no speed moves.
    pub fn is_still(&self) -> bool {
        self.degree != Degree::Mixed
    }
}

/// An instruction whose result may change within a small part of the range of the variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Steep {
    pub at: usize,
    /// Whether it does so at other angles at other speeds, or times.
    pub moves: bool,
    /// Whether it is a switch, which may jump at the zeros of its argument and have a kink there.
    pub jumps: bool,
}

/// A formula, checked.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Formula {
    ops: Vec<Op>,
    /// How it grows with speed.
    pub degree: Degree,
    /// Where it has kinks or jumps.
    pub switches: Vec<Switch>,
    /// Where it may be steep.
    pub steep: Vec<Steep>,
}

/// A polynomial of no more than this degree has no pulse that is narrow within the range of its variables: x⁸ falls to half
/// within a twelfth of it.
const SMOOTH_POWER: u32 = 8;

/// As a factor, what may be steep itself counts as such a power of a variable, and so does what a wave may be too short in.
const STEEP_POWER: u32 = 3;

/// Numbers that a formula may keep at once.
pub const DEPTH: usize = 16;

impl Variable {
    fn degree(self) -> Degree {
        match self {
            Variable::Time => Degree::Mixed,
            Variable::Omega | Variable::Vx | Variable::Vy | Variable::V | Variable::PsiDot => Degree::Of(1),
            _ => Degree::Of(0),
        }
    }
}

impl Op {
    /// How many numbers it takes.
    fn takes(self) -> usize {
        match self {
            Op::Number(_) | Op::Zero | Op::Variable(_) => 0,
            Op::Add | Op::Sub | Op::Mul | Op::Div | Op::Pow | Op::Atan2 | Op::Min | Op::Max => 2,
            Op::Where => 4,
            _ => 1,
        }
    }

    /// Degree of the result for those of the arguments.
    fn degree(self, from: &[Degree]) -> Degree {
        match (self, from) {
            (Op::Number(_), _) => Degree::Of(0),
            (Op::Variable(variable), _) => variable.degree(),
            (Op::Add | Op::Sub | Op::Min | Op::Max, &[a, b]) => a.with(b),
            (Op::Mul, &[a, b]) => a.times(b, 1),
            (Op::Div, &[a, b]) => a.times(b, -1),
            (Op::Neg | Op::Abs, &[a]) => a,
            (Op::Power(n), &[Degree::Of(a)]) => Degree::Of(a * n),
            (Op::Power(0), _) => Degree::Of(0),
            (Op::Power(_), &[a]) => a,
            (Op::Sign | Op::Step, &[a]) => a.sign(),
            (Op::Sqrt, &[a]) => a.root(),
            (Op::Atan2, &[a, b]) => a.with(b).sign(),
            (Op::Pow, &[a, b]) => a.through().with(b.through()),
            (Op::Where, &[a, b, x, y]) if a.with(b) != Degree::Mixed => x.with(y),
            (Op::Where, _) => Degree::Mixed,
            (_, &[a]) => a.through(),
            _ => Degree::Any,
        }
    }
}

impl Op {
    /// Degree of the result as a polynomial of the variables for those of the arguments, where a wave counts as the variable
    /// that it is of; `None` for what may be steep.
    fn power(self, from: &[u32]) -> Option<u32> {
        let power = match (self, from) {
            (Op::Variable(_), _) => 1,
            (Op::Add | Op::Sub, &[a, b]) => a.max(b),
            (Op::Mul, &[a, b]) => a.saturating_add(b),
            (Op::Neg | Op::Abs, &[a]) | (Op::Div, &[a, 0]) => a,
            (Op::Sin | Op::Cos, &[a]) if a < STEEP_POWER => a.min(1),
            (Op::Power(n), &[a]) if n >= 0 => a.saturating_mul(n.unsigned_abs()),
            _ if from.iter().all(|&a| a == 0) => 0,
            _ => return None,
        };
        (power <= SMOOTH_POWER).then_some(power)
    }
}

/// The instructions whose result may be steep; `None` where one has too few numbers.
fn steep(ops: &[Op]) -> Option<Vec<usize>> {
    let (mut stack, mut found) = (Vec::new(), Vec::new());
    for (at, op) in ops.iter().enumerate() {
        let from = stack.split_off(stack.len().checked_sub(op.takes())?);
        let power = op.power(&from);
        found.extend(power.is_none().then_some(at));
        stack.push(power.unwrap_or(STEEP_POWER));
    }
    Some(found)
}

impl Formula {
    /// From instructions; `None` unless they leave one number and never keep more than [`DEPTH`].
    pub fn new(ops: Vec<Op>) -> Option<Formula> {
        let steep = steep(&ops)?;
        // v/|v| jumps although |v| does not.
        let divides = ops.iter().any(|op| matches!(op, Op::Div | Op::Pow | Op::Power(..0)));
        let mut stack: Vec<(Degree, bool)> = Vec::new();
        let (mut switches, mut degrees) = (Vec::new(), Vec::new());
        for (at, op) in ops.iter().enumerate() {
            let (from, wind): (Vec<_>, Vec<_>) =
                stack.split_off(stack.len().checked_sub(op.takes())?).into_iter().unzip();
            let argument = match op {
                Op::Abs | Op::Sign | Op::Step => Some(from[0]),
                Op::Min | Op::Max | Op::Where => Some(from[0].with(from[1])),
                _ => None,
            };
            let argument_winds = wind.iter().take(2).any(|&winds| winds);
            let jumps = divides || matches!(op, Op::Sign | Op::Step | Op::Where);
            switches.extend(argument.map(|degree| Switch { at, degree, winds: argument_winds, jumps }));
            degrees.push(op.degree(&from));
            let is_bent = argument.is_some() || matches!(op, Op::Sin | Op::Cos) || steep.contains(&at);
            stack.push((degrees[at], is_bent || wind.contains(&true)));
            if stack.len() > DEPTH {
                return None;
            }
        }
        let &[(degree, _)] = stack.as_slice() else { return None };
        let of = |at| {
            let switch = switches.iter().find(|switch| switch.at == at);
            let moves = [Some(degrees[at]), switch.map(|s| s.degree)].contains(&Some(Degree::Mixed));
            Steep { at, moves, jumps: switch.is_some() }
        };
        let steep = steep.into_iter().map(of).collect();
        Some(Formula { ops, degree, switches, steep })
    }

    /// The parameters that it asks for.
    pub fn slots(&self) -> impl Iterator<Item = Slot> + '_ {
        self.ops.iter().filter_map(|op| match op {
            Op::Number(slot) => Some(*slot),
            _ => None,
        })
    }

    /// Whether it asks for a variable.
    pub fn reads(&self, variable: Variable) -> bool {
        self.ops.contains(&Op::Variable(variable))
    }

    /// Its value.
    #[inline(always)]
    pub fn value<R: Real, N: Lift<R>>(&self, q: &[R], inputs: &Inputs<N>) -> N {
        out_of_line!(N, {
            let mut stack = [N::splat(0.0); DEPTH];
            self.run(self.ops.len(), q, inputs, &mut stack);
            stack[0]
        })
    }

    /// What one of its instructions gives.
    #[inline(always)]
    pub fn result<R: Real, N: Lift<R>>(&self, at: usize, q: &[R], inputs: &Inputs<N>) -> N {
        out_of_line!(N, {
            let mut stack = [N::splat(0.0); DEPTH];
            let height = self.run(at + 1, q, inputs, &mut stack);
            stack[height - 1]
        })
    }

    /// The argument of a switch.
    #[inline(always)]
    pub fn switch<R: Real, N: Lift<R>>(&self, at: usize, q: &[R], inputs: &Inputs<N>) -> N {
        out_of_line!(N, {
            let mut stack = [N::splat(0.0); DEPTH];
            let height = self.run(at, q, inputs, &mut stack);
            let first = height - self.ops[at].takes();
            match self.ops[at] {
                Op::Min | Op::Max | Op::Where => stack[first] - stack[first + 1],
                _ => stack[first],
            }
        })
    }

    /// Works through the first instructions; returns how many numbers are on the stack.
    #[inline(always)]
    fn run<R: Real, N: Lift<R>>(
        &self,
        until: usize,
        q: &[R],
        inputs: &Inputs<N>,
        stack: &mut [N; DEPTH],
    ) -> usize {
        let mut height = 0;
        for &op in &self.ops[..until] {
            let first = height - op.takes();
            let a = stack[first];
            stack[first] = match op {
                Op::Number(slot) => N::lift(q[slot]),
                Op::Zero => N::splat(0.0),
                Op::Variable(variable) => inputs.get(variable),
                Op::Add => a + stack[first + 1],
                Op::Sub => a - stack[first + 1],
                Op::Mul => a * stack[first + 1],
                Op::Div => a / stack[first + 1],
                Op::Neg => -a,
                Op::Power(n) => power(a, n),
                Op::Pow => pow(a, stack[first + 1]),
                Op::Sin => a.sin_cos().0,
                Op::Cos => a.sin_cos().1,
                Op::Tan => {
                    let (sin, cos) = a.sin_cos();
                    sin / cos
                }
                Op::Asin => a.atan2(beside(a)),
                Op::Acos => beside(a).atan2(a),
                Op::Atan => a.atan(),
                Op::Atan2 => a.atan2(stack[first + 1]),
                Op::Exp => a.exp(),
                Op::Log => a.ln(),
                Op::Sqrt => root(a),
                Op::Tanh => a.tanh(),
                Op::Abs => a.abs(),
                Op::Sign => sign(a),
                Op::Step => a.select_lt(N::splat(0.0), N::splat(0.0), N::splat(1.0)) + a * 0.0,
                Op::Min => -larger(-a, -stack[first + 1]),
                Op::Max => larger(a, stack[first + 1]),
                Op::Where => a.select_lt(stack[first + 1], stack[first + 2], stack[first + 3]),
            };
            height = first + 1;
        }
        height
    }
}

impl<N: Real> Inputs<N> {
    /// The crank angle alone; everything else is zero.
    #[inline(always)]
    pub fn of_angle(phi: N) -> Self {
        Inputs { phi, ..Inputs::all(N::splat(0.0)) }
    }

    /// Of what each variable is in three others.
    #[inline(always)]
    pub fn of_three<M: Real>(all: [&Inputs<M>; 3], f: impl Fn([M; 3]) -> N) -> Self {
        Inputs::by(|variable| f(all.map(|inputs| inputs.get(variable))))
    }

    /// With something done to each.
    #[inline(always)]
    #[must_use]
    pub fn map(&self, f: impl Fn(N) -> N) -> Self {
        Inputs::by(|variable| f(self.get(variable)))
    }

    /// The same for each.
    pub fn all(each: N) -> Self {
        Inputs::by(|_| each)
    }

    #[inline(always)]
    fn by(of: impl Fn(Variable) -> N) -> Self {
        Inputs {
            phi: of(Variable::Phi),
            omega: of(Variable::Omega),
            time: of(Variable::Time),
            x: of(Variable::X),
            y: of(Variable::Y),
            vx: of(Variable::Vx),
            vy: of(Variable::Vy),
            v: of(Variable::V),
            s: of(Variable::S),
            psi: of(Variable::Psi),
            psi_dot: of(Variable::PsiDot),
        }
    }

    #[inline(always)]
    fn get(&self, variable: Variable) -> N {
        match variable {
            Variable::Phi => self.phi,
            Variable::Omega => self.omega,
            Variable::Time => self.time,
            Variable::X => self.x,
            Variable::Y => self.y,
            Variable::Vx => self.vx,
            Variable::Vy => self.vy,
            Variable::V => self.v,
            Variable::S => self.s,
            Variable::Psi => self.psi,
            Variable::PsiDot => self.psi_dot,
        }
    }
}

/// A whole power by repeated squaring.
#[inline(always)]
fn power<N: Real>(x: N, n: i32) -> N {
    let (mut result, mut square, mut rest) = (N::splat(1.0), x, n.unsigned_abs());
    while rest > 0 {
        if rest & 1 == 1 {
            result = result * square;
        }
        square = square.squared();
        rest >>= 1;
    }
    if n < 0 { result.recip() } else { result }
}

/// `f(x)` for x > 0, zero at zero (with slope zero, the one from the other side of `max(0, …)`), NaN below.
#[inline(always)]
fn from_zero<N: Real>(x: N, value: N) -> N {
    let zero = N::splat(0.0);
    zero.select_lt(x, value, x.select_lt(zero, N::splat(f64::NAN), x * 0.0))
}

/// x, or 1 where x is not positive, so that a derivative there is finite.
#[inline(always)]
fn positive<N: Real>(x: N) -> N {
    N::splat(0.0).select_lt(x, x, N::splat(1.0))
}

#[inline(always)]
fn root<N: Real>(x: N) -> N {
    from_zero(x, positive(x).sqrt())
}

/// xʸ = exp(y ln x); at x = 0 it is 0, 1 or infinite as y is positive, zero or negative.
#[inline(always)]
fn pow<N: Real>(x: N, y: N) -> N {
    let zero = N::splat(0.0);
    let at_zero = y.select_lt(zero, N::splat(f64::INFINITY), zero.select_lt(y, zero, N::splat(1.0)));
    from_zero(x, (positive(x).ln() * y).exp()) + x.abs().select_lt(N::splat(f64::MIN_POSITIVE), at_zero, zero)
}

/// √(1 − x²) without loss of digits near ±1: the other side of the triangle with hypotenuse 1.
#[inline(always)]
fn beside<N: Real>(x: N) -> N {
    root((N::splat(1.0) - x) * (x + 1.0))
}

#[inline(always)]
fn sign<N: Real>(x: N) -> N {
    let (zero, one) = (N::splat(0.0), N::splat(1.0));
    x.select_lt(zero, -one, zero.select_lt(x, one, zero)) + x * 0.0
}

/// The larger of two; NaN if either is.
#[inline(always)]
fn larger<N: Real>(a: N, b: N) -> N {
    b.select_lt(N::splat(f64::INFINITY), a.max(b), b)
}
