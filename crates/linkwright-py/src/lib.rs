//! The Python module `linkwright._core`, as one file to load. What is in it is `linkwright-border`: a crate that is linked waits for
//! all others, and that one does not.

pub use linkwright_border::_core;
