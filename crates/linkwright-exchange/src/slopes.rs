//! Derivatives of values along a direction of others: the equation in duals.

use crate::fault::Fault;
use crate::instant::Instant;
use crate::model::Model;
use crate::numbers::along;
use crate::quantity::Quantity;
use linkwright_kernel::dual::Dual;

impl Model {
    /// Derivatives of unknowns along a direction of knowns.
    ///
    /// # Errors
    /// Something has no derivative, or lists differ in length.
    pub fn derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        direction: &[f64],
    ) -> Result<Vec<f64>, Fault> {
        if knowns.len() != direction.len() {
            return Err(Fault::Length { found: direction.len(), expected: knowns.len() });
        }
        let modes = self.modes();
        let mut y: Vec<_> = self.state.y.iter().copied().map(Dual::constant).collect();
        let mut outside = self.state.outside.lifted();
        let mut ways = vec![0.0; self.state.parameters.len()];
        for (&reference, &d) in knowns.iter().zip(direction) {
            let none = Fault::Derivative(reference);
            match Quantity::of(reference)? {
                Quantity::Outside(n) => outside.part(n).ok_or(none)?.d += d,
                Quantity::Parameter(n) => *ways.get_mut(n).ok_or(none)? += d,
                Quantity::State(n) if n < y.len() => {
                    y[Instant::<f64>::place(n, self.chain.masses() - 1)].d += d;
                }
                _ => return Err(none),
            }
        }
        let (q, chain) = along(&self.data, &self.state.parameters, &ways);
        let around = self.around(&modes, outside);
        let instant = Instant::of(&self.data.plan, &q, &chain, y, &around);
        let of = |&reference: &u32| {
            let found = Quantity::of(reference)?.at(&instant).ok_or(Fault::Derivative(reference))?;
            Ok(found.d * self.scale(reference))
        };
        unknowns.iter().map(of).collect()
    }
}
