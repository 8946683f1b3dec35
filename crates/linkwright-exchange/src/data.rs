//! The machine as bytes: a mark, the format, a checksum, and the parts in compact form.

use crate::fault::Fault;
use linkwright_core::drive::structure::Plan;
use linkwright_core::plan::FORMAT;
use linkwright_driveline::chain::{Chain, Source, Torque};
use serde::{Deserialize, Serialize};

/// First bytes of the data; the last is the number of their layout.
const MARK: &[u8; 4] = b"LWF2";

/// Bytes before the parts.
const HEAD: usize = 16;

/// A number that may be set, and what it changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Its value in the machine as it was exported.
    pub value: f64,
    /// Slots, factors and powers: a slot changes by factor · (vᵖ − v₀ᵖ). Behind the slots of the plan are the numbers of the driveline.
    pub effects: Vec<(usize, f64, f64)>,
}

/// A machine.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Data {
    /// Its structure, with the motor.
    pub plan: Plan,
    /// Its numbers.
    pub q: Vec<f64>,
    /// Its driveline; of a rigid drive the crank alone.
    pub chain: Chain,
    /// Direction in which the motor drives, +1 or −1.
    pub motor: f64,
    /// Crank angle \[rad\] and speed \[rad/s\] at the start.
    pub start: [f64; 2],
    /// Relative accuracy of a step.
    pub accuracy: f64,
    /// Numbers that may be set.
    pub parameters: Vec<Parameter>,
    /// Mass on which the brake acts.
    pub brake: usize,
    /// Value references whose numbers are read times a factor: parts that turn at a speed of their own.
    pub scales: Vec<(u32, f64)>,
    /// Value references that may be set within a range alone, with its ends.
    pub ranges: Vec<(u32, f64, f64)>,
    /// What the description of the variables is known by.
    pub token: String,
}

/// The driveline of a rigid drive: its motor acts at the crank.
pub fn rigid() -> Chain {
    Chain {
        inertia: Vec::new(),
        apart: 0.0,
        links: Vec::new(),
        drivers: vec![Torque { mass: 0, source: Source::Own }],
        loads: Vec::new(),
        stations: Vec::new(),
        swing: None,
    }
}

/// Checksum of bytes: Fowler, Noll, Vo, FNV-1a of 64 bits.
pub fn checksum(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |sum, &byte| (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

impl Data {
    /// As bytes.
    ///
    /// # Errors
    /// The machine contradicts itself.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Fault> {
        self.check()?;
        let parts = postcard::to_allocvec(self).map_err(|_| Fault::Damaged("not to be written"))?;
        let sum = checksum(&parts).to_le_bytes();
        Ok([&MARK[..], &FORMAT.to_le_bytes(), &sum, &parts].concat())
    }

    /// From bytes.
    ///
    /// # Errors
    /// They are not those of a machine, of another format, or changed.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Fault> {
        if bytes.len() < HEAD || &bytes[..4] != MARK {
            return Err(Fault::Damaged("not a machine"));
        }
        let mut format = [0; 4];
        format.copy_from_slice(&bytes[4..8]);
        let found = u32::from_le_bytes(format);
        if found != FORMAT {
            return Err(Fault::Version { found, expected: FORMAT });
        }
        let (sum, parts) = (&bytes[8..HEAD], &bytes[HEAD..]);
        if sum != checksum(parts).to_le_bytes() {
            return Err(Fault::Damaged("its checksum differs"));
        }
        let data: Data = postcard::from_bytes(parts).map_err(|_| Fault::Damaged("a part is missing"))?;
        data.check()?;
        Ok(data)
    }

    /// Whether lists are as long as they must be.
    fn check(&self) -> Result<(), Fault> {
        let Data { plan, q, chain, motor, start, accuracy, parameters, brake, scales, ranges, .. } = self;
        let numbers = q.len() + chain.numbers().len();
        let slots = parameters.iter().flat_map(|one| &one.effects).all(|&(slot, ..)| slot < numbers);
        let is_moving = !chain.drivers.iter().any(|driver| matches!(driver.source, Source::Held(_)));
        let factors = scales.iter().map(|(_, factor)| factor);
        let finite = q.iter().chain(start).chain([accuracy]).chain(factors).all(|x| x.is_finite());
        match () {
            () if q.len() != plan.n_parameters || !chain.fits() || !slots || *brake >= chain.masses() => {
                Err(Fault::Damaged("a number is missing"))
            }
            () if !is_moving => Err(Fault::Damaged("a motor keeps its speed")),
            () if !finite
                || motor.abs() != 1.0
                || ranges.iter().any(|(_, low, high)| low.is_nan() || high.is_nan()) =>
            {
                Err(Fault::Damaged("a number is out of range"))
            }
            () => Ok(()),
        }
    }
}
