//! Means and work of a cycle: sums over its stages with Radau's weights, in plain numbers or duals.

use crate::chain::{Driver, Link};
use crate::equation::{Equation, Row};
use linkwright_kernel::real::Real;

/// Sums of a cycle, of which each stage adds its part.
pub struct Work<N> {
    /// Duration \[s\].
    pub period: N,
    /// Work of the driver \[J\].
    pub drive: N,
    /// Work that the loads take \[J\].
    pub load: N,
    /// Of every link: ∫ T dt, ∫ T² dt, and the work that its damper takes.
    pub links: Vec<[N; 3]>,
}

impl<N: Real> Work<N> {
    /// Nothing yet, for a number of links.
    pub fn new(links: usize) -> Self {
        let zero = N::splat(0.0);
        Work { period: zero, drive: zero, load: zero, links: vec![[zero; 3]; links] }
    }

    /// Adds a stage that stands for an angle \[rad\].
    #[inline(always)]
    pub fn add(&mut self, equation: &Equation<'_, N>, row: &Row<'_, N>, y: &[N], angle: N) {
        let chain = equation.chain;
        let omega = chain.speed(chain.masses() - 1, y);
        let dt = angle / omega;
        self.period = self.period + dt;
        self.drive = self.drive + dt * equation.drive(y) * chain.speed(chain.driven, y);
        self.load = self.load + angle * equation.load(row, omega).value;
        for (link, sums) in chain.links.iter().zip(&mut self.links) {
            let (torque, rate) = (chain.torque(link, y), chain.twist(link, y)[1]);
            sums[0] = sums[0] + dt * torque;
            sums[1] = sums[1] + dt * torque * torque;
            sums[2] = sums[2] + dt * link.damping * rate * rate;
        }
    }

    /// Mean and root mean square torque of a link over time \[N m\].
    #[inline(always)]
    pub fn torques(&self, link: usize) -> [N; 2] {
        let [sum, squares, _] = self.links[link];
        [sum / self.period, (squares / self.period).sqrt()]
    }
}

impl<N: Real> Equation<'_, N> {
    /// Torque of the driver at its mass \[N m\]; one that keeps its speed gives what the links take.
    #[inline(always)]
    pub fn drive(&self, y: &[N]) -> N {
        let chain = self.chain;
        match chain.driver {
            Driver::Motor => self.motor(chain.speed(chain.driven, y)).value,
            Driver::Held(_) => {
                let sign = |link: &Link<N>| {
                    f64::from(u8::from(link.first == chain.driven))
                        - f64::from(u8::from(link.second == chain.driven))
                };
                let taken = |sum: N, link: &Link<N>| sum + chain.torque(link, y) * sign(link);
                chain.links.iter().fold(N::splat(0.0), taken)
            }
        }
    }
}
