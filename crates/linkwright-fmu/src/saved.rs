//! What an importer saves of an instance: restored, or as bytes.

use crate::instance::{Instance, Outcome, Phase, Trouble};
use crate::memory::Handles;
use linkwright_exchange::data::checksum;
use linkwright_exchange::model::State;
use linkwright_exchange::{Fault, Model};
use std::ffi::c_void;

const PHASES: [Phase; 6] = [
    Phase::Instantiated,
    Phase::Initialization,
    Phase::Event,
    Phase::Continuous,
    Phase::Step,
    Phase::Terminated,
];

/// What an importer saves.
pub(crate) struct Saved {
    phase: Phase,
    state: State,
    /// Checksum of what the machine is known by.
    machine: u64,
}

impl Saved {
    /// As bytes: a checksum, the machine, the phase and the state.
    fn to_bytes(&self) -> Result<Vec<u8>, Trouble> {
        let state = Model::to_bytes(&self.state)?;
        let parts = [&self.machine.to_le_bytes()[..], &[self.phase as u8], &state].concat();
        Ok([&checksum(&parts).to_le_bytes()[..], &parts].concat())
    }

    fn from_bytes(bytes: &[u8]) -> Result<Self, Trouble> {
        let (sum, parts) = bytes.split_first_chunk().ok_or(Fault::State)?;
        let (machine, rest) = parts.split_first_chunk().ok_or(Fault::State)?;
        let (&phase, rest) = rest.split_first().ok_or(Fault::State)?;
        let phase = *PHASES.get(usize::from(phase)).ok_or(Fault::State)?;
        if u64::from_le_bytes(*sum) != checksum(parts) {
            return Err(Fault::State.into());
        }
        Ok(Saved { phase, state: Model::from_bytes(rest)?, machine: u64::from_le_bytes(*machine) })
    }
}

/// All that was saved.
static SAVED: Handles = Handles::new();

impl Instance {
    /// Saves what changes, under a new handle or in the place of what was saved before.
    pub(crate) fn save(&self, to: &mut [*mut c_void]) -> Outcome {
        let machine = checksum(self.model.token().as_bytes());
        let saved = Saved { phase: self.phase, state: self.model.saved(), machine };
        let [handle] = to else { return Err(Trouble::error("the place of the state is missing")) };
        if handle.is_null() {
            *handle = SAVED.give(saved);
        } else {
            *at(*handle)? = saved;
        }
        Ok(())
    }

    /// Takes what was saved.
    pub(crate) fn restore(&mut self, handle: *mut c_void) -> Outcome {
        let saved = at(handle)?;
        if saved.machine != checksum(self.model.token().as_bytes()) {
            return Err(Fault::State.into());
        }
        self.model.restore(saved.state.clone(), saved.phase > Phase::Initialization)?;
        self.phase = saved.phase;
        Ok(())
    }
}

fn at<'a>(handle: *mut c_void) -> Result<&'a mut Saved, Trouble> {
    SAVED.at(handle).ok_or_else(|| Trouble::error("the state is not one that was saved, or was freed"))
}

/// Bytes that a saved state takes.
pub(crate) fn size_of_saved(handle: *mut c_void) -> Result<usize, Trouble> {
    Ok(at(handle)?.to_bytes()?.len())
}

/// Writes a saved state as bytes.
pub(crate) fn serialize(handle: *mut c_void, to: &mut [u8]) -> Outcome {
    let bytes = at(handle)?.to_bytes()?;
    let room = to.len();
    let to = to.get_mut(..bytes.len()).ok_or(Fault::Length { found: room, expected: bytes.len() })?;
    to.copy_from_slice(&bytes);
    Ok(())
}

/// Reads a saved state from bytes, under a new handle.
pub(crate) fn deserialize(bytes: &[u8], to: &mut [*mut c_void]) -> Outcome {
    let saved = Saved::from_bytes(bytes)?;
    let [handle] = to else { return Err(Trouble::error("the place of the state is missing")) };
    *handle = SAVED.give(saved);
    Ok(())
}

/// Frees a saved state; the importer's handle becomes null.
pub(crate) fn free(to: &mut [*mut c_void]) {
    if let [handle] = to {
        drop(SAVED.take::<Saved>(*handle));
        *handle = std::ptr::null_mut();
    }
}
