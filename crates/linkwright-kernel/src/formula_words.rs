//! The words of formulas: each variable, operator and function by the name that a user writes, said once.

use crate::formula::{Op, Variable};

impl Variable {
    /// The variable of a name.
    pub fn named(name: &str) -> Option<Variable> {
        Some(match name {
            "phi" => Variable::Phi,
            "omega" => Variable::Omega,
            "t" => Variable::Time,
            "x" => Variable::X,
            "y" => Variable::Y,
            "vx" => Variable::Vx,
            "vy" => Variable::Vy,
            "v" => Variable::V,
            "s" => Variable::S,
            "psi" => Variable::Psi,
            "psi_dot" => Variable::PsiDot,
            _ => return None,
        })
    }
}

impl Op {
    /// The instruction of an operator or function, which takes what it needs from the stack.
    pub fn named(name: &str) -> Option<Op> {
        Some(match name {
            "+" => Op::Add,
            "-" => Op::Sub,
            "*" => Op::Mul,
            "/" => Op::Div,
            "negative" => Op::Neg,
            "pow" => Op::Pow,
            "sin" => Op::Sin,
            "cos" => Op::Cos,
            "tan" => Op::Tan,
            "asin" => Op::Asin,
            "acos" => Op::Acos,
            "atan" => Op::Atan,
            "atan2" => Op::Atan2,
            "exp" => Op::Exp,
            "log" => Op::Log,
            "sqrt" => Op::Sqrt,
            "tanh" => Op::Tanh,
            "abs" => Op::Abs,
            "sign" => Op::Sign,
            "step" => Op::Step,
            "min" => Op::Min,
            "max" => Op::Max,
            "where" => Op::Where,
            _ => return None,
        })
    }
}
