//! What crosses the border of C: lists, texts and handles.

use crate::instance::Trouble;
use std::collections::BTreeSet;
use std::ffi::{CStr, c_char, c_void};
use std::sync::{Mutex, PoisonError};

/// Values that the importer has.
pub(crate) fn list<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], Trouble> {
    match count {
        0 => Ok(&[]),
        _ if pointer.is_null() => Err(Trouble::error("a list is missing (null pointer)")),
        // SAFETY: the standard binds the importer to give a list of so many values, which stays there during the call.
        _ => Ok(unsafe { std::slice::from_raw_parts(pointer, count) }),
    }
}

/// Room that the importer has for values.
pub(crate) fn room<'a, T>(pointer: *mut T, count: usize) -> Result<&'a mut [T], Trouble> {
    match count {
        0 => Ok(&mut []),
        _ if pointer.is_null() => Err(Trouble::error("a list is missing (null pointer)")),
        // SAFETY: as in `list`; no other part of the call has the list.
        _ => Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) }),
    }
}

/// Writes what a call answers beside its status; nothing where the importer does not ask.
pub(crate) fn answer<T>(pointer: *mut T, value: T) {
    if !pointer.is_null() {
        // SAFETY: the standard binds the importer to give room for one value, or null.
        unsafe { pointer.write(value) };
    }
}

/// A text of the importer.
pub(crate) fn text<'a>(pointer: *const c_char) -> Option<&'a str> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: the standard binds the importer to give a text that ends with zero and stays there during the call.
    unsafe { CStr::from_ptr(pointer) }.to_str().ok()
}

/// Things of one kind that the importer holds by handles: a handle that is none of them is an error, not a crash.
pub(crate) struct Handles(Mutex<BTreeSet<usize>>);

impl Handles {
    pub(crate) const fn new() -> Self {
        Handles(Mutex::new(BTreeSet::new()))
    }

    /// Hands something over.
    pub(crate) fn give<T>(&self, thing: T) -> *mut c_void {
        let handle = Box::into_raw(Box::new(thing));
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(handle as usize);
        handle.cast()
    }

    fn has(&self, handle: *mut c_void) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).contains(&(handle as usize))
    }

    /// Something that was handed over.
    pub(crate) fn at<'a, T>(&self, handle: *mut c_void) -> Option<&'a mut T> {
        // SAFETY: it was made by `give` as a thing of this kind and not taken back; the standard forbids calls for one
        // instance at the same time.
        self.has(handle).then(|| unsafe { &mut *handle.cast::<T>() })
    }

    /// Takes something back.
    pub(crate) fn take<T>(&self, handle: *mut c_void) -> Option<Box<T>> {
        let was = self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(&(handle as usize));
        // SAFETY: it was made by `give` as a thing of this kind; from now on its handle is unknown.
        was.then(|| unsafe { Box::from_raw(handle.cast::<T>()) })
    }
}
