//! The functions of FMI 2.0.

use crate::instance::{ERROR, INSTANCES, Instance, OK, Outcome, Phase, Trouble, call, instantiate};
use crate::memory::{answer, list, room, text};
use crate::saved::{deserialize, free, serialize, size_of_saved};
use linkwright_exchange::Purpose;
use std::ffi::{CString, c_char, c_int, c_uint, c_void};

type Handle = *mut c_void;
type Texts = *mut *const c_char;

/// Functions of the importer.
#[repr(C)]
pub struct Callbacks {
    logger: Option<unsafe extern "C" fn(Handle, *const c_char, c_int, *const c_char, *const c_char, ...)>,
    allocate: Option<unsafe extern "C" fn(usize, usize) -> Handle>,
    free: Option<unsafe extern "C" fn(Handle)>,
    step_finished: Option<unsafe extern "C" fn(Handle, c_int)>,
    environment: Handle,
}

/// What `fmi2NewDiscreteStates` answers.
#[repr(C)]
pub struct EventInfo {
    new_discrete_states_needed: c_int,
    terminate_simulation: c_int,
    nominals_changed: c_int,
    values_changed: c_int,
    next_event_time_defined: c_int,
    next_event_time: f64,
}

/// Sends messages to the logger of the importer.
fn log_of(callbacks: *const Callbacks, name: *const c_char) -> impl Fn(c_int, &str) + 'static {
    // SAFETY: the standard binds the importer to give its functions, or null.
    let found = unsafe { callbacks.as_ref() }.map(|own| (own.logger, own.environment));
    let name = CString::new(text(name).unwrap_or("")).unwrap_or_default();
    move |status, message| {
        let Some((Some(logger), environment)) = found else { return };
        let (category, message) = (c"logStatusError", CString::new(message.replace('%', "%%")));
        if let Ok(message) = message {
            // SAFETY: the logger takes these texts and, without a directive in the message, no further arguments.
            unsafe { logger(environment, name.as_ptr(), status, category.as_ptr(), message.as_ptr()) };
        }
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetDebugLogging(
    component: Handle,
    _on: c_int,
    _count: usize,
    _categories: Texts,
) -> c_int {
    call(component, |_| Ok(()))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    guid: *const c_char,
    location: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging: c_int,
) -> Handle {
    let purpose = if kind == 0 { Purpose::Exchange } else { Purpose::Stepping };
    let log = Box::new(log_of(callbacks, name));
    instantiate(text(location), text(guid), purpose, log)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(component: Handle) {
    drop(INSTANCES.take::<Instance>(component));
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    component: Handle,
    has_tolerance: c_int,
    tolerance: f64,
    start: f64,
    _has_stop: c_int,
    _stop: f64,
) -> c_int {
    call(component, |instance| {
        instance.require(&[Phase::Instantiated])?;
        instance.set_up((has_tolerance != 0).then_some(tolerance), start)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(component: Handle) -> c_int {
    call(component, |instance| instance.enter(&[Phase::Instantiated], Phase::Initialization))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(component: Handle) -> c_int {
    call(component, Instance::begin)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(component: Handle) -> c_int {
    let running = [Phase::Event, Phase::Continuous, Phase::Step];
    call(component, |instance| instance.enter(&running, Phase::Terminated))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(component: Handle) -> c_int {
    call(component, |instance| {
        instance.reset();
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetReal(
    component: Handle,
    references: *const c_uint,
    count: usize,
    to: *mut f64,
) -> c_int {
    call(component, |instance| instance.read(list(references, count)?, room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetReal(
    component: Handle,
    references: *const c_uint,
    count: usize,
    values: *const f64,
) -> c_int {
    call(component, |instance| instance.write(list(references, count)?, list(values, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetBoolean(
    component: Handle,
    references: *const c_uint,
    count: usize,
    to: *mut c_int,
) -> c_int {
    call(component, |instance| {
        for (&reference, to) in list(references, count)?.iter().zip(room(to, count)?) {
            *to = c_int::from(instance.model.truth(reference)?);
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetBoolean(
    component: Handle,
    references: *const c_uint,
    count: usize,
    values: *const c_int,
) -> c_int {
    call(component, |instance| {
        for (&reference, &value) in list(references, count)?.iter().zip(list(values, count)?) {
            instance.model.set_truth(reference, value != 0)?;
        }
        Ok(())
    })
}

/// No variable has this type.
fn none_of(component: Handle, count: usize, kind: &str) -> c_int {
    call(component, |_| {
        let wrong = || Err(Trouble::error(&format!("the machine has no variable of the type {kind}")));
        if count == 0 { Ok(()) } else { wrong() }
    })
}

macro_rules! without_variables {
    ($($get:ident, $set:ident, $kind:literal, $value:ty;)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $get(component: Handle, _: *const c_uint, count: usize, _: *mut $value) -> c_int {
            none_of(component, count, $kind)
        }

        #[unsafe(no_mangle)]
        pub extern "C" fn $set(component: Handle, _: *const c_uint, count: usize, _: *const $value) -> c_int {
            none_of(component, count, $kind)
        }
    )*};
}

without_variables! {
    fmi2GetInteger, fmi2SetInteger, "Integer", c_int;
    fmi2GetString, fmi2SetString, "String", *const c_char;
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetFMUstate(component: Handle, state: *mut Handle) -> c_int {
    call(component, |instance| instance.save(room(state, 1)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(component: Handle, state: Handle) -> c_int {
    call(component, |instance| instance.restore(state))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeFMUstate(component: Handle, state: *mut Handle) -> c_int {
    call(component, |_| {
        free(room(state, usize::from(!state.is_null()))?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SerializedFMUstateSize(component: Handle, state: Handle, size: *mut usize) -> c_int {
    call(component, |_| {
        answer(size, size_of_saved(state)?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SerializeFMUstate(
    component: Handle,
    state: Handle,
    bytes: *mut u8,
    size: usize,
) -> c_int {
    call(component, |_| serialize(state, room(bytes, size)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2DeSerializeFMUstate(
    component: Handle,
    bytes: *const u8,
    size: usize,
    state: *mut Handle,
) -> c_int {
    call(component, |_| deserialize(list(bytes, size)?, room(state, 1)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetDirectionalDerivative(
    component: Handle,
    unknowns: *const c_uint,
    n_unknowns: usize,
    knowns: *const c_uint,
    n_knowns: usize,
    direction: *const f64,
    to: *mut f64,
) -> c_int {
    call(component, |instance| {
        let (unknowns, knowns) = (list(unknowns, n_unknowns)?, list(knowns, n_knowns)?);
        instance.derivative(unknowns, knowns, list(direction, n_knowns)?, room(to, n_unknowns)?)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterEventMode(component: Handle) -> c_int {
    call(component, |instance| {
        instance.require_purpose(Purpose::Exchange)?;
        instance.enter(&[Phase::Continuous, Phase::Event], Phase::Event)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2NewDiscreteStates(component: Handle, info: *mut EventInfo) -> c_int {
    call(component, |instance| {
        let values_changed = c_int::from(instance.update()?);
        answer(
            info,
            EventInfo {
                new_discrete_states_needed: 0,
                terminate_simulation: 0,
                nominals_changed: 0,
                values_changed,
                next_event_time_defined: 0,
                next_event_time: 0.0,
            },
        );
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterContinuousTimeMode(component: Handle) -> c_int {
    call(component, |instance| instance.enter(&[Phase::Event], Phase::Continuous))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2CompletedIntegratorStep(
    component: Handle,
    _no_set_before: c_int,
    enter_event_mode: *mut c_int,
    terminate: *mut c_int,
) -> c_int {
    call(component, |instance| {
        instance.require(&[Phase::Continuous])?;
        answer(enter_event_mode, 0);
        answer(terminate, 0);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetTime(component: Handle, time: f64) -> c_int {
    call(component, |instance| instance.set_time(time))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetContinuousStates(component: Handle, values: *const f64, count: usize) -> c_int {
    call(component, |instance| instance.set_continuous(list(values, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetDerivatives(component: Handle, to: *mut f64, count: usize) -> c_int {
    call(component, |instance| instance.rates(room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetEventIndicators(component: Handle, to: *mut f64, count: usize) -> c_int {
    call(component, |instance| instance.indicators(room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetContinuousStates(component: Handle, to: *mut f64, count: usize) -> c_int {
    call(component, |instance| instance.continuous(room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetNominalsOfContinuousStates(component: Handle, to: *mut f64, count: usize) -> c_int {
    call(component, |instance| instance.nominals(room(to, count)?))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(component: Handle, from: f64, size: f64, _no_set_before: c_int) -> c_int {
    call(component, |instance| instance.step(from, size))
}

/// What the machine does not offer.
fn not_offered(_: &mut Instance) -> Outcome {
    Err(Trouble::error("the call is not offered: see the capabilities in modelDescription.xml"))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetRealInputDerivatives(
    component: Handle,
    _: *const c_uint,
    _: usize,
    _: *const c_int,
    _: *const f64,
) -> c_int {
    call(component, not_offered)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetRealOutputDerivatives(
    component: Handle,
    _: *const c_uint,
    _: usize,
    _: *const c_int,
    _: *mut f64,
) -> c_int {
    call(component, not_offered)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(component: Handle) -> c_int {
    call(component, not_offered)
}

/// Steps are done when `fmi2DoStep` returns: there is no status to wait for but the time that was reached.
const LAST_SUCCESSFUL_TIME: c_int = 2;

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetRealStatus(component: Handle, kind: c_int, to: *mut f64) -> c_int {
    call(component, |instance| {
        if kind != LAST_SUCCESSFUL_TIME {
            return not_offered(instance);
        }
        answer(to, instance.model.time());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStatus(component: Handle, _kind: c_int, to: *mut c_int) -> c_int {
    answer(to, OK);
    if INSTANCES.at::<Instance>(component).is_some() { OK } else { ERROR }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetIntegerStatus(component: Handle, _kind: c_int, _to: *mut c_int) -> c_int {
    call(component, not_offered)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetBooleanStatus(component: Handle, _kind: c_int, to: *mut c_int) -> c_int {
    call(component, |_| {
        answer(to, 0);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStringStatus(component: Handle, _kind: c_int, _to: Texts) -> c_int {
    call(component, not_offered)
}
