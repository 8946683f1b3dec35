//! The functions of FMI 2.0 and 3.0 over one machine ([`linkwright_exchange`]), as a library that any importer loads.
//!
//! | module | answers |
//! | --- | --- |
//! | `instance` | an instance, its phases, and how every call is guarded |
//! | `saved` | what an importer saves of an instance |
//! | `memory` | what crosses the border of C: lists, texts, handles |
//! | `location` | where the importer has put the resources |
//! | `fmi2`, `fmi3` | the functions of each version |
//!
//! Source: Modelica Association, *Functional Mock-up Interface for Model Exchange and Co-Simulation*, version 2.0.4 (2022), and
//! *Functional Mock-up Interface Specification*, version 3.0.2 (2024).

// The importer hands over pointers, as the standard says; every block that follows one says on what it relies.
#![allow(unsafe_code)]
// The names of functions and of their arguments are those of the standard, which describes them.
#![allow(missing_docs, clippy::too_many_arguments, clippy::missing_safety_doc)]

pub mod fmi2;
pub mod fmi3;
mod instance;
mod location;
mod memory;
mod saved;
