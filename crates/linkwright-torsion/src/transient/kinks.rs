//! Where the equations bend: flanks that meet or part, the direction of power, the limit of a controller.
//!
//! Each has a number that is the same all along a smooth stretch. A step ends where one changes, so that its error is that of a
//! smooth motion.

use super::rates::Rates;

impl Rates<'_> {
    /// Whether something in the train bends.
    pub fn has_kinks(&self) -> bool {
        let system = self.system;
        self.stages.any()
            || !system.controllers.is_empty()
            || system.links.iter().any(|link| link.manner.contact)
    }

    /// The stretch of everything that bends, at the instant last evaluated at a time.
    pub fn stretches(&self, t: f64, to: &mut Vec<u32>) {
        let system = self.system;
        to.clear();
        for link in system.links.iter().filter(|link| link.manner.contact || link.manner.loss.is_some()) {
            let (torque, limited) = if link.manner.rigid {
                (0.0, false)
            } else {
                let bond = self.bond(link);
                let pulls = link.pulls(system, bond.twist, bond.rate);
                let piece = link.curve.map_or(0, |curve| system.curves[curve].piece(bond.twist));
                to.push(piece as u32);
                (pulls.torque, link.manner.contact && pulls.by_rate == 0.0)
            };
            let sense = u32::from(torque > 0.0) + 2 * u32::from(torque < 0.0);
            to.push(if link.manner.loss.is_some() { sense } else { 0 });
            to.push(u32::from(limited));
        }
        to.extend(self.stages.rigid_senses(&system.links));
        for controller in &system.controllers {
            let speeds = [self.omega[controller.mass], self.omega[controller.integral]];
            let command = controller.at(&system.curves, self.stretch(), t, speeds);
            to.push(u32::from(command.is_free));
        }
    }
}
