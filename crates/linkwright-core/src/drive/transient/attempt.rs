//! Steps of any length from one instant, and the polynomial of the one that was tried last.

use super::equation::{Equation, Y};
use crate::kernel::rk::{Stages, Trial, over, worse};

/// Share of the working speed that is added to a speed before the accuracy is taken of it.
const SMALL: f64 = 0.01;

/// Attempts from `(t, y)`.
pub struct Attempt<'a, 'm> {
    equation: &'a mut Equation<'m>,
    stages: Stages<Y>,
    from: (f64, Y),
    accuracy: f64,
    speed_scale: f64,
}

impl<'a, 'm> Attempt<'a, 'm> {
    /// From an instant, its state and the derivative there.
    pub fn new(
        equation: &'a mut Equation<'m>,
        (t, y, rate): (f64, &Y, &Y),
        accuracy: f64,
        speed_scale: f64,
    ) -> Self {
        let mut stages = Stages::new(y);
        *stages.start() = *rate;
        Attempt { equation, stages, from: (t, *y), accuracy, speed_scale }
    }

    /// Tries a length.
    pub fn to(&mut self, h: f64) -> Trial<2> {
        let (t, y) = self.from;
        let (accuracy, aside) = (self.accuracy, SMALL * self.speed_scale);
        let mut end = y;
        let equation = &mut *self.equation;
        let mut f = |t: f64, y: &Y, to: &mut Y| *to = equation.derivative(t, y);
        let scale = |n: usize, size: f64| tolerance(accuracy, aside, n, size);
        let error = self.stages.try_step(&mut f, (t, &y), h, &scale, &mut end);
        Trial { y: end, error }
    }

    /// Makes the polynomial of the length tried last, which led to `end`; its error on the way over the tolerance.
    pub fn fill(&mut self, h: f64, end: &Y) -> f64 {
        let (t, y) = self.from;
        let (accuracy, aside) = (self.accuracy, SMALL * self.speed_scale);
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

    /// Derivative at the end, and polynomials of angle and speed, after [`Attempt::fill`].
    pub fn ended(&mut self) -> (Y, [[f64; 7]; 2]) {
        (*self.stages.end(), [0, 1].map(|n| self.stages.polynomial(n)))
    }
}

/// Error that the angle (0) or the speed (1) may have.
fn tolerance(accuracy: f64, aside: f64, n: usize, size: f64) -> f64 {
    if n == 0 { accuracy } else { accuracy * (size + aside) }
}
