//! An instance of the machine, its phases, and how every call is guarded: no panic leaves the library, and a call out of order is an
//! error with a message.

use crate::location::path_of;
use crate::memory::Handles;
use linkwright_exchange::data::Data;
use linkwright_exchange::{Fault, Model, Purpose};
use std::cell::RefCell;
use std::ffi::{c_int, c_void};
use std::mem::ManuallyDrop;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

/// Status of a call, in both versions of the standard.
pub(crate) const OK: c_int = 0;
pub(crate) const DISCARD: c_int = 2;
pub(crate) const ERROR: c_int = 3;
pub(crate) const FATAL: c_int = 4;

/// What an instance is ready for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Phase {
    Instantiated,
    Initialization,
    Event,
    Continuous,
    Step,
    Terminated,
}

/// Why a call fails.
#[derive(Debug)]
pub(crate) struct Trouble {
    pub(crate) status: c_int,
    pub(crate) text: String,
}

impl Trouble {
    pub(crate) fn error(text: &str) -> Self {
        Trouble { status: ERROR, text: text.to_owned() }
    }
}

impl From<Fault> for Trouble {
    fn from(fault: Fault) -> Self {
        Trouble { status: ERROR, text: fault.to_string() }
    }
}

/// What a call comes to.
pub(crate) type Outcome = Result<(), Trouble>;

/// Sends a status and a message to the log of the importer.
pub(crate) type Log = Box<dyn Fn(c_int, &str)>;

/// A machine in the hands of an importer.
pub(crate) struct Instance {
    pub(crate) model: Model,
    pub(crate) phase: Phase,
    log: Log,
    /// After a panic nothing is known of it any more.
    is_lost: bool,
}

/// All instances.
pub(crate) static INSTANCES: Handles = Handles::new();

thread_local! {
    /// Without a destructor: one at the end of a thread would keep the library loaded.
    static PANIC: RefCell<ManuallyDrop<String>> = const { RefCell::new(ManuallyDrop::new(String::new())) };
}

/// Keeps the message of a panic for the log, in place of one on standard error.
fn keep_panics() {
    static KEPT: Once = Once::new();
    KEPT.call_once(|| {
        std::panic::set_hook(Box::new(|info| {
            let text = info.to_string().replace('\n', " ");
            PANIC.with_borrow_mut(|kept| **kept = text);
        }));
    });
}

/// Does something, and turns a panic into trouble.
fn guarded<T>(work: impl FnOnce() -> Result<T, Trouble>) -> Result<T, Trouble> {
    keep_panics();
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        let text = PANIC.with_borrow(|kept| format!("the library contradicts itself: {}", **kept));
        Err(Trouble { status: FATAL, text })
    })
}

/// A new instance from the resources at a location; null, with a message in the log, where there is none.
pub(crate) fn instantiate(
    location: Option<&str>,
    token: Option<&str>,
    purpose: Purpose,
    log: Log,
) -> *mut c_void {
    let made = guarded(|| {
        if !linkwright_exchange::is_supported() {
            return Err(Trouble::error(linkwright_exchange::NEEDS));
        }
        let folder = location.ok_or_else(|| Trouble::error("the location of the resources is missing"))?;
        let path = path_of(folder).join("machine.lw");
        let bytes =
            std::fs::read(&path).map_err(|error| Trouble::error(&format!("{}: {error}", path.display())))?;
        let model = Model::new(Data::from_bytes(&bytes)?, purpose);
        if token != Some(model.token()) {
            return Err(Fault::Token.into());
        }
        Ok(model)
    });
    match made {
        Ok(model) => INSTANCES.give(Instance { model, phase: Phase::Instantiated, log, is_lost: false }),
        Err(trouble) => {
            log(trouble.status, &trouble.text);
            std::ptr::null_mut()
        }
    }
}

/// A call for an instance; its status.
pub(crate) fn call(handle: *mut c_void, work: impl FnOnce(&mut Instance) -> Outcome) -> c_int {
    let Some(instance) = INSTANCES.at::<Instance>(handle) else { return ERROR };
    if instance.is_lost {
        return FATAL;
    }
    match guarded(|| work(instance)) {
        Ok(()) => OK,
        Err(Trouble { status, text }) => {
            instance.is_lost = status == FATAL;
            (instance.log)(status, &text);
            status
        }
    }
}

impl Instance {
    /// Refuses a call that does not belong to a phase.
    pub(crate) fn require(&self, phases: &[Phase]) -> Outcome {
        if phases.contains(&self.phase) {
            return Ok(());
        }
        let text = format!("the call is not allowed in the phase {:?}, but in {phases:?}", self.phase);
        Err(Trouble::error(&text))
    }

    /// Refuses a call that is of another interface.
    pub(crate) fn require_purpose(&self, purpose: Purpose) -> Outcome {
        if self.model.purpose() == purpose {
            return Ok(());
        }
        Err(Trouble::error("the call is not one of the interface that was instantiated"))
    }

    /// Goes from one of some phases to another.
    pub(crate) fn enter(&mut self, from: &[Phase], to: Phase) -> Outcome {
        self.require(from)?;
        self.phase = to;
        Ok(())
    }

    /// Goes back to what it was when it was made.
    pub(crate) fn reset(&mut self) {
        self.model.reset();
        self.phase = Phase::Instantiated;
    }

    /// Begins the initialization at a time, with the accuracy that the importer asks for.
    pub(crate) fn set_up(&mut self, tolerance: Option<f64>, time: f64) -> Outcome {
        if !time.is_finite() {
            return Err(Trouble::error("the start time is not a finite number"));
        }
        // Some programs write 0 where they ask for none.
        if let Some(tolerance) = tolerance.filter(|&tolerance| tolerance != 0.0) {
            if !(0.0..1.0).contains(&tolerance) {
                let text = format!("the tolerance is {tolerance:?}: expected a number above 0 and below 1");
                return Err(Trouble::error(&text));
            }
            self.model.set_accuracy(tolerance);
        }
        self.model.set_time(time);
        Ok(())
    }

    /// Ends the initialization.
    pub(crate) fn begin(&mut self) -> Outcome {
        self.require(&[Phase::Initialization])?;
        self.model.begin();
        self.phase = match self.model.purpose() {
            Purpose::Stepping => Phase::Step,
            Purpose::Exchange => Phase::Event,
        };
        Ok(())
    }

    /// Reads numbers.
    pub(crate) fn read(&mut self, references: &[u32], to: &mut [f64]) -> Outcome {
        for (&reference, to) in references.iter().zip(to) {
            *to = self.model.number(reference)?;
        }
        Ok(())
    }

    /// Sets numbers; a state only before the motion begins.
    pub(crate) fn write(&mut self, references: &[u32], values: &[f64]) -> Outcome {
        let is_start = matches!(self.phase, Phase::Instantiated | Phase::Initialization);
        for (&reference, &value) in references.iter().zip(values) {
            if reference >> 16 == 3 && !is_start {
                return Err(Fault::Fixed(reference).into());
            }
            self.model.set_number(reference, value)?;
        }
        Ok(())
    }

    /// Steps over an interval from a communication point.
    pub(crate) fn step(&mut self, from: f64, size: f64) -> Outcome {
        self.require_purpose(Purpose::Stepping)?;
        self.require(&[Phase::Step])?;
        let now = self.model.time();
        // A point that was summed up otherwise differs by rounding.
        if (from - now).abs() > 1e-9 * (1.0 + now.abs()) {
            let text = format!("the communication point is {from} s, the instance stands at {now} s");
            return Err(Trouble::error(&text));
        }
        Ok(self.model.step(from + size)?)
    }

    /// Takes events into account; whether states have changed.
    pub(crate) fn update(&mut self) -> Result<bool, Trouble> {
        self.require_purpose(Purpose::Exchange)?;
        self.require(&[Phase::Event])?;
        Ok(self.model.update()?)
    }

    /// Rates of the states. Where there are none the importer may try a shorter step.
    pub(crate) fn rates(&mut self, to: &mut [f64]) -> Outcome {
        self.require_motion()?;
        let rates = self.model.rates().map_err(discard)?;
        fill(&rates, to)
    }

    /// Event indicators, likewise.
    pub(crate) fn indicators(&mut self, to: &mut [f64]) -> Outcome {
        self.require_motion()?;
        let indicators = self.model.indicators().map_err(discard)?;
        fill(&indicators, to)
    }

    /// States.
    pub(crate) fn continuous(&mut self, to: &mut [f64]) -> Outcome {
        self.require_motion()?;
        fill(&self.model.continuous(), to)
    }

    /// Sizes that they usually have.
    pub(crate) fn nominals(&mut self, to: &mut [f64]) -> Outcome {
        self.require_purpose(Purpose::Exchange)?;
        fill(&self.model.nominals(), to)
    }

    /// Sets states.
    pub(crate) fn set_continuous(&mut self, values: &[f64]) -> Outcome {
        self.require_purpose(Purpose::Exchange)?;
        self.require(&[Phase::Continuous])?;
        Ok(self.model.set_continuous(values)?)
    }

    /// Sets the time.
    pub(crate) fn set_time(&mut self, time: f64) -> Outcome {
        self.require_purpose(Purpose::Exchange)?;
        self.require(&[Phase::Continuous, Phase::Event])?;
        self.model.set_time(time);
        Ok(())
    }

    /// Derivatives of unknowns along a direction of knowns.
    pub(crate) fn derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        direction: &[f64],
        to: &mut [f64],
    ) -> Outcome {
        fill(&self.model.derivative(unknowns, knowns, direction)?, to)
    }

    fn require_motion(&self) -> Outcome {
        self.require_purpose(Purpose::Exchange)?;
        self.require(&[Phase::Initialization, Phase::Event, Phase::Continuous, Phase::Terminated])
    }
}

fn discard(fault: Fault) -> Trouble {
    Trouble { status: DISCARD, text: fault.to_string() }
}

/// Gives numbers to an importer that has room for as many.
pub(crate) fn fill(from: &[f64], to: &mut [f64]) -> Outcome {
    if from.len() != to.len() {
        return Err(Fault::Length { found: to.len(), expected: from.len() }.into());
    }
    to.copy_from_slice(from);
    Ok(())
}
