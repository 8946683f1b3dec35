//! Means and work of a cycle: sums over its stages with Radau's weights, in plain numbers or duals.

use crate::chain::Chain;
use crate::equation::Rates;
use linkwright_kernel::real::Real;

/// Sums of a cycle, of which each stage adds its part.
pub struct Work<N> {
    /// Duration \[s\].
    pub period: N,
    /// Work that loads and damping from outside take \[J\].
    pub load: N,
    /// Of every driver: ∫ M dt, and its work.
    pub drivers: Vec<[N; 2]>,
    /// Of every link: ∫ T dt, ∫ T² dt, and the work that its damper takes.
    pub links: Vec<[N; 3]>,
}

impl<N: Real> Work<N> {
    /// Nothing yet.
    pub fn new(chain: &Chain<N>) -> Self {
        let zero = N::splat(0.0);
        let (drivers, links) = (vec![[zero; 2]; chain.drivers.len()], vec![[zero; 3]; chain.links.len()]);
        Work { period: zero, load: zero, drivers, links }
    }

    /// Adds a stage with its rates that stands for an angle \[rad\].
    #[inline(always)]
    pub fn add(&mut self, chain: &Chain<N>, rates: &Rates<N>, y: &[N], angle: N) {
        let dt = angle / chain.speed(chain.masses() - 1, y);
        self.period = self.period + dt;
        self.load = self.load + dt * rates.load_power;
        for ((sums, &torque), driver) in self.drivers.iter_mut().zip(&rates.drive).zip(&chain.drivers) {
            sums[0] = sums[0] + dt * torque;
            sums[1] = sums[1] + dt * torque * chain.speed(driver.mass, y);
        }
        for (link, sums) in chain.links.iter().zip(&mut self.links) {
            let (torque, rate) = (chain.torque(link, y), chain.twist(link, y)[1]);
            sums[0] = sums[0] + dt * torque.value;
            sums[1] = sums[1] + dt * torque.value * torque.value;
            sums[2] = sums[2] + dt * torque.damper * rate;
        }
    }

    /// Mean torque of a driver over time \[N m\].
    #[inline(always)]
    pub fn mean_drive(&self, driver: usize) -> N {
        self.drivers[driver][0] / self.period
    }

    /// Mean and root mean square torque of a link over time \[N m\].
    #[inline(always)]
    pub fn torques(&self, link: usize) -> [N; 2] {
        let [sum, squares, _] = self.links[link];
        [sum / self.period, (squares / self.period).sqrt()]
    }
}
