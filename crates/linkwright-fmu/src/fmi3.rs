//! The functions of FMI 3.0.

use crate::instance::{ERROR, INSTANCES, Instance, Outcome, Phase, Trouble, call, instantiate};
use crate::memory::{answer, list, room, text};
use crate::saved::{deserialize, free, serialize, size_of_saved};
use linkwright_exchange::{Fault, Purpose};
use std::ffi::{CString, c_char, c_int, c_uint, c_void};

type Handle = *mut c_void;

/// A Boolean of C as a byte: any value but 0 is true.
type Truth = u8;

/// The function of the importer that takes messages.
type Logger = Option<unsafe extern "C" fn(Handle, c_int, *const c_char, *const c_char)>;

fn log_of(environment: Handle, logger: Logger) -> impl Fn(c_int, &str) + 'static {
    move |status, message| {
        if let (Some(logger), Ok(message)) = (logger, CString::new(message)) {
            // SAFETY: the standard binds the importer to give a function that takes these texts.
            unsafe { logger(environment, status, c"logStatusError".as_ptr(), message.as_ptr()) };
        }
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetDebugLogging(
    instance: Handle,
    _on: Truth,
    _count: usize,
    _categories: *const *const c_char,
) -> c_int {
    call(instance, |_| Ok(()))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: Truth,
    _logging: Truth,
    environment: Handle,
    logger: Logger,
) -> Handle {
    let log = Box::new(log_of(environment, logger));
    instantiate(text(resources), text(token), Purpose::Exchange, log)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: Truth,
    _logging: Truth,
    _event_mode: Truth,
    _early_return: Truth,
    _intermediate: *const c_uint,
    _count: usize,
    environment: Handle,
    logger: Logger,
    _update: Handle,
) -> Handle {
    let log = Box::new(log_of(environment, logger));
    instantiate(text(resources), text(token), Purpose::Stepping, log)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: Truth,
    _logging: Truth,
    environment: Handle,
    logger: Logger,
    _update: Handle,
    _lock: Handle,
    _unlock: Handle,
) -> Handle {
    log_of(environment, logger)(ERROR, "scheduled execution is not offered: use co-simulation");
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(instance: Handle) {
    drop(INSTANCES.take::<Instance>(instance));
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    instance: Handle,
    has_tolerance: Truth,
    tolerance: f64,
    start: f64,
    _has_stop: Truth,
    _stop: f64,
) -> c_int {
    call(instance, |instance| {
        instance.require(&[Phase::Instantiated])?;
        instance.set_up((has_tolerance != 0).then_some(tolerance), start)?;
        instance.enter(&[Phase::Instantiated], Phase::Initialization)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitInitializationMode(instance: Handle) -> c_int {
    call(instance, Instance::begin)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterEventMode(instance: Handle) -> c_int {
    call(instance, |instance| {
        instance.require_purpose(Purpose::Exchange)?;
        instance.enter(&[Phase::Continuous, Phase::Event], Phase::Event)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Terminate(instance: Handle) -> c_int {
    let running = [Phase::Event, Phase::Continuous, Phase::Step];
    call(instance, |instance| instance.enter(&running, Phase::Terminated))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(instance: Handle) -> c_int {
    call(instance, |instance| {
        instance.reset();
        Ok(())
    })
}

/// Every variable is a number by itself: there are as many values as references.
fn alike(references: usize, values: usize) -> Outcome {
    if references == values {
        return Ok(());
    }
    Err(Fault::Length { found: values, expected: references }.into())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetFloat64(
    instance: Handle,
    references: *const c_uint,
    count: usize,
    to: *mut f64,
    values: usize,
) -> c_int {
    call(instance, |instance| {
        alike(count, values)?;
        instance.read(list(references, count)?, room(to, count)?)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFloat64(
    instance: Handle,
    references: *const c_uint,
    count: usize,
    from: *const f64,
    values: usize,
) -> c_int {
    call(instance, |instance| {
        alike(count, values)?;
        instance.write(list(references, count)?, list(from, count)?)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetBoolean(
    instance: Handle,
    references: *const c_uint,
    count: usize,
    to: *mut Truth,
    values: usize,
) -> c_int {
    call(instance, |instance| {
        alike(count, values)?;
        for (&reference, to) in list(references, count)?.iter().zip(room(to, count)?) {
            *to = Truth::from(instance.model.truth(reference)?);
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetBoolean(
    instance: Handle,
    references: *const c_uint,
    count: usize,
    from: *const Truth,
    values: usize,
) -> c_int {
    call(instance, |instance| {
        alike(count, values)?;
        for (&reference, &value) in list(references, count)?.iter().zip(list(from, count)?) {
            instance.model.set_truth(reference, value != 0)?;
        }
        Ok(())
    })
}

// What is not asked for is left out of the arguments: the caller cleans up after the call.
macro_rules! without_variables {
    ($($name:ident)*) => {$(
        /// No variable has this type.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(instance: Handle, _references: *const c_uint, count: usize) -> c_int {
            call(instance, |_| {
                let wrong = || Err(Trouble::error("the machine has no variable of this type"));
                if count == 0 { Ok(()) } else { wrong() }
            })
        }
    )*};
}

without_variables! {
    fmi3GetFloat32 fmi3GetInt8 fmi3GetUInt8 fmi3GetInt16 fmi3GetUInt16 fmi3GetInt32 fmi3GetUInt32 fmi3GetInt64
    fmi3GetUInt64 fmi3GetString fmi3GetBinary fmi3GetClock
    fmi3SetFloat32 fmi3SetInt8 fmi3SetUInt8 fmi3SetInt16 fmi3SetUInt16 fmi3SetInt32 fmi3SetUInt32 fmi3SetInt64
    fmi3SetUInt64 fmi3SetString fmi3SetBinary fmi3SetClock
    fmi3GetIntervalDecimal fmi3GetIntervalFraction fmi3GetShiftDecimal fmi3GetShiftFraction
    fmi3SetIntervalDecimal fmi3SetIntervalFraction fmi3SetShiftDecimal fmi3SetShiftFraction
}

macro_rules! not_offered {
    ($($name:ident)*) => {$(
        /// What the machine does not offer.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(instance: Handle) -> c_int {
            call(instance, |_| {
                Err(Trouble::error("the call is not offered: see the capabilities in modelDescription.xml"))
            })
        }
    )*};
}

not_offered! {
    fmi3GetNumberOfVariableDependencies fmi3GetVariableDependencies fmi3GetAdjointDerivative
    fmi3EnterConfigurationMode fmi3ExitConfigurationMode fmi3GetOutputDerivatives fmi3ActivateModelPartition
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetFMUState(instance: Handle, state: *mut Handle) -> c_int {
    call(instance, |instance| instance.save(room(state, 1)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(instance: Handle, state: Handle) -> c_int {
    call(instance, |instance| instance.restore(state))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeFMUState(instance: Handle, state: *mut Handle) -> c_int {
    call(instance, |_| {
        free(room(state, usize::from(!state.is_null()))?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SerializedFMUStateSize(instance: Handle, state: Handle, size: *mut usize) -> c_int {
    call(instance, |_| {
        answer(size, size_of_saved(state)?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SerializeFMUState(
    instance: Handle,
    state: Handle,
    bytes: *mut u8,
    size: usize,
) -> c_int {
    call(instance, |_| serialize(state, room(bytes, size)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3DeserializeFMUState(
    instance: Handle,
    bytes: *const u8,
    size: usize,
    state: *mut Handle,
) -> c_int {
    call(instance, |_| deserialize(list(bytes, size)?, room(state, 1)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetDirectionalDerivative(
    instance: Handle,
    unknowns: *const c_uint,
    n_unknowns: usize,
    knowns: *const c_uint,
    n_knowns: usize,
    seed: *const f64,
    n_seed: usize,
    to: *mut f64,
    n_to: usize,
) -> c_int {
    call(instance, |instance| {
        let (unknowns, knowns) = (list(unknowns, n_unknowns)?, list(knowns, n_knowns)?);
        instance.derivative(unknowns, knowns, list(seed, n_seed)?, room(to, n_to)?)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EvaluateDiscreteStates(instance: Handle) -> c_int {
    call(instance, |_| Ok(()))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3UpdateDiscreteStates(
    instance: Handle,
    needs_update: *mut Truth,
    terminate: *mut Truth,
    nominals_changed: *mut Truth,
    values_changed: *mut Truth,
    has_next_event: *mut Truth,
    next_event: *mut f64,
) -> c_int {
    call(instance, |instance| {
        let changed = instance.update()?;
        for (to, value) in [
            (needs_update, false),
            (terminate, false),
            (nominals_changed, false),
            (values_changed, changed),
            (has_next_event, false),
        ] {
            answer(to, Truth::from(value));
        }
        answer(next_event, 0.0);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterContinuousTimeMode(instance: Handle) -> c_int {
    call(instance, |instance| instance.enter(&[Phase::Event], Phase::Continuous))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3CompletedIntegratorStep(
    instance: Handle,
    _no_set_before: Truth,
    enter_event_mode: *mut Truth,
    terminate: *mut Truth,
) -> c_int {
    call(instance, |instance| {
        instance.require(&[Phase::Continuous])?;
        answer(enter_event_mode, 0);
        answer(terminate, 0);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetTime(instance: Handle, time: f64) -> c_int {
    call(instance, |instance| instance.set_time(time))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetContinuousStates(instance: Handle, values: *const f64, count: usize) -> c_int {
    call(instance, |instance| instance.set_continuous(list(values, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetContinuousStateDerivatives(instance: Handle, to: *mut f64, count: usize) -> c_int {
    call(instance, |instance| instance.rates(room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetEventIndicators(instance: Handle, to: *mut f64, count: usize) -> c_int {
    call(instance, |instance| instance.indicators(room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetContinuousStates(instance: Handle, to: *mut f64, count: usize) -> c_int {
    call(instance, |instance| instance.continuous(room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetNominalsOfContinuousStates(instance: Handle, to: *mut f64, count: usize) -> c_int {
    call(instance, |instance| instance.nominals(room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetNumberOfEventIndicators(instance: Handle, count: *mut usize) -> c_int {
    call(instance, |instance| {
        instance.require_purpose(Purpose::Exchange)?;
        answer(count, instance.model.indicator_count());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetNumberOfContinuousStates(instance: Handle, count: *mut usize) -> c_int {
    call(instance, |instance| {
        instance.require_purpose(Purpose::Exchange)?;
        answer(count, instance.model.states());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterStepMode(instance: Handle) -> c_int {
    call(instance, |instance| {
        instance.require_purpose(Purpose::Stepping)?;
        instance.require(&[Phase::Step])
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3DoStep(
    instance: Handle,
    from: f64,
    size: f64,
    _no_set_before: Truth,
    needs_events: *mut Truth,
    terminate: *mut Truth,
    early_return: *mut Truth,
    last_time: *mut f64,
) -> c_int {
    call(instance, |instance| {
        for to in [needs_events, terminate, early_return] {
            answer(to, 0);
        }
        let outcome = instance.step(from, size);
        answer(last_time, instance.model.time());
        outcome
    })
}
