//! The numbers of the machine for values of its parameters: plain, or with derivatives along a direction of them.

use crate::data::Data;
use linkwright_driveline::chain::Chain;
use linkwright_kernel::dual::Dual;

/// Numbers of the plan and of the driveline.
pub type Numbers<N> = (Vec<N>, Chain<N>);

/// The machine with other values of its parameters.
pub fn plain(data: &Data, values: &[f64]) -> Numbers<f64> {
    let mut numbers = exported(data);
    for (slot, Dual { value, .. }) in changes(data, values, &vec![0.0; values.len()]) {
        numbers[slot] += value;
    }
    let behind = numbers.split_off(data.q.len());
    (numbers, data.chain.with(&behind))
}

/// The same with derivatives along a direction of the values.
pub fn along(data: &Data, values: &[f64], direction: &[f64]) -> Numbers<Dual<f64>> {
    let mut numbers: Vec<_> = exported(data).into_iter().map(Dual::constant).collect();
    for (slot, change) in changes(data, values, direction) {
        numbers[slot] = numbers[slot] + change;
    }
    let behind = numbers.split_off(data.q.len());
    (numbers, data.chain.with(&behind))
}

fn exported(data: &Data) -> Vec<f64> {
    [&data.q[..], &data.chain.numbers()].concat()
}

/// Slots that differ from the machine as exported, or have a derivative.
fn changes(data: &Data, values: &[f64], direction: &[f64]) -> Vec<(usize, Dual<f64>)> {
    let mut found = Vec::new();
    for ((parameter, &value), &d) in data.parameters.iter().zip(values).zip(direction) {
        for &(slot, factor, power) in &parameter.effects {
            if value != parameter.value || d != 0.0 {
                let change = factor * (value.powf(power) - parameter.value.powf(power));
                found.push((slot, Dual { value: change, d: factor * power * value.powf(power - 1.0) * d }));
            }
        }
    }
    found
}
