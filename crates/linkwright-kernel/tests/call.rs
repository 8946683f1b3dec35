//! A call ends when it is no longer wanted, and a panic in it becomes a failure with message and place.

use linkwright_kernel::call::{Failure, Inquiry, in_threads, keep_panic, poll, run};
use rayon::prelude::*;
use std::time::{Duration, Instant};

const WANTED: Inquiry = || None;
const UNWANTED: Inquiry = || Some(Box::new("enough"));

/// Longest that a stopped call may take: ten times what it takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(10);

fn long_work() {
    let start = Instant::now();
    while start.elapsed() < 3 * PATIENCE {
        poll();
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn divided(task: impl Fn(u64) -> u64 + Sync) -> u64 {
    in_threads(|crew| (0..64).into_par_iter().map(|i| crew.task(|| task(i))).sum())
}

#[test]
fn a_call_that_is_wanted_returns_its_result() {
    assert_eq!(run(WANTED, || divided(|i| i)).ok(), Some(2016));
    assert_eq!(divided(|i| i), 2016, "without anybody who could stop it");
}

#[test]
fn a_call_that_is_no_longer_wanted_ends_with_the_reason() {
    for work in [long_work as fn(), || {
        _ = divided(|_| {
            long_work();
            0
        })
    }] {
        let start = Instant::now();
        let Err(Failure::Stopped(reason)) = run(UNWANTED, work) else {
            panic!("the call was not stopped");
        };
        assert_eq!(reason.downcast_ref(), Some(&"enough"));
        assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
    }
}

#[test]
fn a_call_within_a_look_leaves_the_outer_one_alone() {
    // A signal handler may compute something.
    const NESTED: Inquiry = || {
        let inner = run(WANTED, || divided(|i| 2 * i));
        assert_eq!(inner.ok(), Some(4032), "the inner call");
        Some(Box::new("enough"))
    };
    assert!(matches!(run(NESTED, long_work), Err(Failure::Stopped(_))));
}

#[test]
fn a_panic_is_a_failure_with_message_and_place() {
    std::panic::set_hook(Box::new(|info| assert!(keep_panic(info), "no call is under way")));
    let few = [0_u64; 8];
    for work in [(|few| divided(|i| few[i as usize])) as fn(&[u64]) -> u64, |few| few[few.len()]] {
        let Err(Failure::Panic(text)) = run(WANTED, || work(&few)) else {
            panic!("the index is out of range");
        };
        assert!(text.contains("index out of bounds") && text.contains("call.rs"), "{text}");
    }
    let _default = std::panic::take_hook();
}
