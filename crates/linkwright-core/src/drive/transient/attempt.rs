//! Steps of any length from one instant, and the polynomial of the one that was tried last.
//!
//! [`Attempts`] is what events are met with; here by the explicit method, in [`super::stiff`] by the implicit one.

use super::equation::{Equation, Jump, Y};
use crate::kernel::real::Real;
use crate::kernel::rk::{Stages, Trial, over, rise, worse};

/// Share of the working speed that is added to a speed before the accuracy is taken of it.
const SMALL: f64 = 0.01;

/// A step, or a part of one, that one polynomial describes.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// Length \[s\].
    pub h: f64,
    /// State at its end.
    pub y: Y,
    /// Derivative there.
    pub rate: Y,
    /// Polynomials of angle and speed.
    pub between: [[f64; 7]; 2],
}

impl Piece {
    /// State at a share of the piece, which starts from another.
    pub fn state<R: Real>(&self, from: &Y, share: R) -> [R; 2] {
        std::array::from_fn(|n| rise(&self.between[n], share) + from[n])
    }
}

/// Angle and speed at a time since the start of a step, from which its pieces begin.
pub fn state<R: Real>(start: &Y, pieces: &[Piece], time: R) -> [R; 2] {
    let (mut from, mut left) = (*start, time);
    for piece in &pieces[..pieces.len() - 1] {
        if left.max_lane() <= piece.h {
            return piece.state(&from, left * (1.0 / piece.h));
        }
        (from, left) = (piece.y, left - piece.h);
    }
    let last = &pieces[pieces.len() - 1];
    last.state(&from, left * (1.0 / last.h))
}

/// Steps of any length from one instant.
pub trait Attempts {
    /// Tries a length.
    fn to(&mut self, h: f64) -> Trial<2>;

    /// Times since the start and speeds where the pieces of the length tried last end.
    fn speeds(&self) -> Vec<(f64, f64)>;

    /// Makes the polynomials of the length tried last, which led to `end`; the error on the way over the tolerance.
    fn fill(&mut self, h: f64, end: &Y) -> f64;

    /// The pieces, after [`Attempts::fill`].
    fn pieces(&self) -> Vec<Piece>;

    /// Order of the error that `fill` tells.
    fn order(&self) -> f64;

    /// The quantities whose zeros are kinks of laws, at a time and a state.
    fn at_law_kinks(&mut self, t: f64, y: &Y) -> Vec<f64>;

    /// The kink of a law with a number, at a time and a state that lies on it.
    fn jump(&mut self, nth: usize, t: f64, y: &Y) -> Jump;

    /// The share of pieces from a time and a state after which the step is to end for a pulse that its stages may not see.
    fn first_unseen(&mut self, from: (f64, &Y), pieces: &[Piece]) -> Option<f64>;
}

/// Attempts from `(t, y)` by the explicit method.
pub struct ExplicitAttempt<'a, 'm> {
    equation: &'a mut Equation<'m>,
    stages: Stages<Y>,
    from: (f64, Y),
    accuracy: f64,
    aside: f64,
    /// Length and end of what was tried last.
    tried: (f64, Y),
}

impl<'a, 'm> ExplicitAttempt<'a, 'm> {
    /// From an instant, its state and the derivative there.
    pub fn new(equation: &'a mut Equation<'m>, (t, y, rate): (f64, &Y, &Y), accuracy: f64) -> Self {
        let mut stages = Stages::new(y);
        *stages.start() = *rate;
        let aside = aside_of(equation.speed_scale);
        ExplicitAttempt { equation, stages, from: (t, *y), accuracy, aside, tried: (0.0, *y) }
    }
}

impl Attempts for ExplicitAttempt<'_, '_> {
    fn to(&mut self, h: f64) -> Trial<2> {
        let (t, y) = self.from;
        let (accuracy, aside) = (self.accuracy, self.aside);
        let mut end = y;
        let equation = &mut *self.equation;
        let mut f = |t: f64, y: &Y, to: &mut Y| *to = equation.derivative(t, y);
        let scale = |n: usize, size: f64| tolerance(accuracy, aside, n, size);
        let error = self.stages.try_step(&mut f, (t, &y), h, &scale, &mut end);
        self.tried = (h, end);
        Trial { y: end, error }
    }

    fn speeds(&self) -> Vec<(f64, f64)> {
        let (h, end) = self.tried;
        vec![(h, end[1])]
    }

    fn fill(&mut self, h: f64, end: &Y) -> f64 {
        self.tried = (h, *end);
        let (t, y) = self.from;
        let (accuracy, aside) = (self.accuracy, self.aside);
        let equation = &mut *self.equation;
        *self.stages.end() = equation.derivative(t + h, end);
        let mut f = |t: f64, y: &Y, to: &mut Y| *to = equation.derivative(t, y);
        let measure = |y: &[f64], error: &[f64]| {
            let share = |n: usize| over(error[n], tolerance(accuracy, aside, n, y[n].abs()), y[n].abs());
            worse(share(0), share(1))
        };
        self.stages.fill(&mut f, (t, &y), h, end);
        self.stages.error_between(&mut f, (t, &y), h, &measure)
    }

    fn pieces(&self) -> Vec<Piece> {
        let (h, y) = self.tried;
        let between = [0, 1].map(|n| self.stages.polynomial(n));
        vec![Piece { h, y, rate: self.stages.end_rate(), between }]
    }

    fn order(&self) -> f64 {
        8.0
    }

    fn at_law_kinks(&mut self, t: f64, y: &Y) -> Vec<f64> {
        self.equation.at_law_kinks(t, y)
    }

    fn jump(&mut self, nth: usize, t: f64, y: &Y) -> Jump {
        self.equation.jump(nth, t, y)
    }

    fn first_unseen(&mut self, from: (f64, &Y), pieces: &[Piece]) -> Option<f64> {
        self.equation.first_unseen(from, pieces)
    }
}

/// Speed that is added to a speed before the accuracy is taken of it.
pub fn aside_of(speed_scale: f64) -> f64 {
    SMALL * speed_scale
}

/// Error that the angle (0) or the speed (1) may have.
pub fn tolerance(accuracy: f64, aside: f64, n: usize, size: f64) -> f64 {
    if n == 0 { accuracy } else { accuracy * (size + aside) }
}
