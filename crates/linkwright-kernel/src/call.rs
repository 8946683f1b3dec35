//! A call of the core: whether it is still wanted, what went wrong in it, and the threads that work for it.
//!
//! Kernels [`poll`] now and then. The thread that made the call looks every `PERIOD` whether it is still wanted (a
//! signal may have come); if not, every thread of the call unwinds from where it is, without a message, and [`run`]
//! returns the reason. Unwinding keeps kernels free of half results and of ways to return them.
//!
//! The threads are a pool of our own. A forked process has the pool's memory and none of its threads, and would wait
//! for them without end: a pool belongs to one process, and another process makes its own.

use rayon::{ThreadPool, ThreadPoolBuilder};
use std::any::Any;
use std::cell::{Cell, RefCell};
use std::mem::ManuallyDrop;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError, RwLock};
use std::time::{Duration, Instant};

/// Why a call is no longer wanted, in the terms of whoever made it.
pub type Reason = Box<dyn Any + Send>;

/// Asks whoever made a call whether it is still wanted.
pub type Inquiry = fn() -> Option<Reason>;

/// Why a call has no result.
pub enum Failure {
    /// It was no longer wanted.
    Stopped(Reason),
    /// The core contradicted itself: message and place.
    Panic(String),
}

/// Time between two looks: short against the patience of somebody at a keyboard, long against a look.
const PERIOD: Duration = Duration::from_millis(50);

/// What unwinds the threads of a call that is no longer wanted.
struct Cancellation;

#[derive(Default)]
struct Call {
    is_over: AtomicBool,
    reason: Mutex<Option<Reason>>,
    panic: Mutex<Option<String>>,
}

/// How the thread that made a call looks, and when it does so next.
#[derive(Clone, Copy)]
struct Lookout {
    look: Inquiry,
    due: Instant,
}

thread_local! {
    /// The call, which is put back by a guard and needs no destructor: one at the end of a thread would keep a library loaded that
    /// another program wants to unload.
    static CALL: RefCell<ManuallyDrop<Option<Arc<Call>>>> = const { RefCell::new(ManuallyDrop::new(None)) };
    static LOOKOUT: Cell<Option<Lookout>> = const { Cell::new(None) };
}

/// Does the work of a call in this thread.
///
/// # Errors
/// [`Failure`] where it was stopped or panicked.
pub fn run<T>(look: Inquiry, work: impl FnOnce() -> T) -> Result<T, Failure> {
    let call = Arc::new(Call::default());
    let lookout = Lookout { look, due: Instant::now() + PERIOD };
    let _here = CallGuard::enter(Some(call.clone()), Some(lookout));
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| call.failure(payload.as_ref()))
}

/// The call that this thread works for.
fn current() -> Option<Arc<Call>> {
    CALL.with_borrow(|call| (**call).clone())
}

/// Another call in its place; the one before.
fn exchanged(call: Option<Arc<Call>>) -> Option<Arc<Call>> {
    ManuallyDrop::into_inner(CALL.replace(ManuallyDrop::new(call)))
}

/// Unwinds if the call that this thread works for is no longer wanted; costs some ten nanoseconds.
pub fn poll() {
    let is_over = CALL.with_borrow(|call| call.as_ref().is_some_and(|c| c.is_over.load(Ordering::Relaxed)));
    if is_over || look() {
        resume_unwind(Box::new(Cancellation));
    }
}

/// Looks, where this thread made the call and it is time to; whether the call is over.
fn look() -> bool {
    let Some(Lookout { look, due }) = LOOKOUT.get() else { return false };
    let now = Instant::now();
    if now < due {
        return false;
    }
    LOOKOUT.set(Some(Lookout { look, due: now + PERIOD }));
    // Looking may make calls of its own, so nothing is borrowed meanwhile.
    let (reason, call) = (look(), current());
    let (Some(reason), Some(call)) = (reason, call) else { return false };
    *call.reason.lock().unwrap_or_else(PoisonError::into_inner) = Some(reason);
    call.is_over.store(true, Ordering::Relaxed);
    true
}

/// Keeps message and place of a panic for the call that this thread works for, to be installed as part of a panic hook;
/// `false` if there is no call.
pub fn keep_panic(info: &PanicHookInfo<'_>) -> bool {
    let Ok(Some(call)) = CALL.try_with(|call| call.try_borrow().ok().and_then(|call| (**call).clone()))
    else {
        return false;
    };
    let place = info.location().map_or(String::new(), |at| format!(" ({}:{})", at.file(), at.line()));
    let text = format!("{}{place}", message(info.payload()));
    call.panic.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
    true
}

fn message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message")
}

impl Call {
    fn failure(&self, payload: &(dyn Any + Send)) -> Failure {
        let reason = self.reason.lock().unwrap_or_else(PoisonError::into_inner).take();
        match reason.filter(|_| payload.is::<Cancellation>()) {
            Some(reason) => Failure::Stopped(reason),
            None => {
                let kept = self.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
                Failure::Panic(kept.unwrap_or_else(|| message(payload).to_owned()))
            }
        }
    }
}

/// This thread at work for a call; what it did before comes back at the end.
struct CallGuard {
    before: (Option<Arc<Call>>, Option<Lookout>),
}

impl CallGuard {
    fn enter(call: Option<Arc<Call>>, lookout: Option<Lookout>) -> Self {
        CallGuard { before: (exchanged(call), LOOKOUT.replace(lookout)) }
    }
}

impl Drop for CallGuard {
    fn drop(&mut self) {
        drop(exchanged(self.before.0.take()));
        LOOKOUT.set(self.before.1);
    }
}

/// Threads that work for one call.
pub struct Crew(Option<Arc<Call>>);

impl Crew {
    /// A task of the call, in whichever thread.
    pub fn task<T>(&self, work: impl FnOnce() -> T) -> T {
        let _here = CallGuard::enter(self.0.clone(), None);
        poll();
        work()
    }
}

/// Does work that is divided among threads, each part of it a [`Crew::task`], while this thread looks whether the call is
/// still wanted. Within a pool of threads it stays there.
pub fn in_threads<T: Send>(work: impl FnOnce(&Crew) -> T + Send) -> T {
    let crew = Crew(current());
    if rayon::current_thread_index().is_some() {
        return work(&crew);
    }
    let (done, finished) = channel::<()>();
    let mut result = None;
    pool().in_place_scope(|scope| {
        scope.spawn(|_| {
            // Goes with the work, also where that unwinds.
            let _done = done;
            result = Some(work(&crew));
        });
        watch(&finished);
    });
    // The work may be done before it has noticed that it is over.
    poll();
    // What unwinds in the pool unwinds here too.
    result.unwrap_or_else(|| resume_unwind(Box::new(Cancellation)))
}

/// Looks now and then until the work is done or no longer wanted.
fn watch(finished: &Receiver<()>) {
    while matches!(finished.recv_timeout(PERIOD), Err(RecvTimeoutError::Timeout)) {
        if look() {
            return;
        }
    }
}

/// The pool, and the process that it belongs to.
static POOL: RwLock<Option<(u32, Arc<ThreadPool>)>> = RwLock::new(None);

/// The pool of this process.
fn pool() -> Arc<ThreadPool> {
    let process = std::process::id();
    let of_this = |known: &Option<(u32, Arc<ThreadPool>)>| {
        known.as_ref().filter(|(of, _)| *of == process).map(|(_, pool)| pool.clone())
    };
    if let Some(pool) = POOL.try_read().ok().and_then(|known| of_this(&known)) {
        return pool;
    }
    let fresh = Arc::new(started());
    // A lock that another thread held while the process was forked is never let go: then the pool serves this call alone.
    if let Ok(mut known) = POOL.try_write() {
        if let Some(pool) = of_this(&known) {
            return pool;
        }
        // To drop another process's pool would be to wait for its threads.
        std::mem::forget(known.replace((process, fresh.clone())));
    }
    fresh
}

/// A pool with as many threads as `RAYON_NUM_THREADS` says, or as there are processors.
fn started() -> ThreadPool {
    match ThreadPoolBuilder::new().thread_name(|i| format!("linkwright-{i}")).build() {
        Ok(pool) => pool,
        Err(error) => panic!("no threads can be started: {error}"),
    }
}
