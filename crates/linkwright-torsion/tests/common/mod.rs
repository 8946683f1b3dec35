//! What the tests of motion in time share.

use linkwright_torsion::transient::rates::Rates;
use linkwright_torsion::transient::system::System;

/// The derivatives that Newton uses against central differences of the accelerations, over this step of the angles \[rad\].
pub(crate) fn require_derivatives(system: &System, time: f64, [angle, speed]: [&[f64]; 2], step: f64) {
    let n = system.len();
    let mut rates = Rates::new(system);
    rates.enter(time);
    let (mut by_angle, mut by_speed) = (vec![0.0; n * n], vec![0.0; n * n]);
    let state = rates.state(angle, speed);
    rates.set_senses(time, &state);
    let acceleration = |rates: &mut Rates<'_>, angle: &[f64], speed: &[f64]| {
        let state = rates.state(angle, speed);
        rates.derivative(time, &state, &mut state.clone());
        rates.acceleration.clone()
    };
    acceleration(&mut rates, angle, speed);
    rates.jacobian(time, &mut by_angle, &mut by_speed);
    for j in 0..n {
        for (name, matrix, step) in [("angle", &by_angle, step), ("speed", &by_speed, 1e-4)] {
            let mut shifted = |by: f64| {
                let (mut angle, mut speed) = (angle.to_vec(), speed.to_vec());
                if name == "angle" {
                    angle[j] += by
                } else {
                    speed[j] += by
                }
                acceleration(&mut rates, &angle, &speed)
            };
            let (a, b) = (shifted(-step), shifted(step));
            for i in 0..n {
                let difference = (b[i] - a[i]) / (2.0 * step);
                let size = matrix[i * n..(i + 1) * n].iter().fold(1.0_f64, |most, x| most.max(x.abs()));
                let off = (difference - matrix[i * n + j]) / size;
                // Central differences err by step² and by rounding of 1e-16·10⁵ over the step.
                assert!(off.abs() < 1e-6, "∂a{i} by {name} {j}: {off:e}");
            }
        }
    }
}
