//! States of elements with dry friction and senses of gear stages with losses that agree with the motion at an instant.
//!
//! Elements without slip are supposed to hold; one that carries more than it can begins to slide, with its sliding torque,
//! and the others are asked again; one that would slide against its own sense holds. Where the elements agree, a stage whose
//! teeth do not hold its first end, or whose speed is past rest, changes its sense, and the elements are asked again. States
//! that come back have no end, and that is said.
//!
//! Source: Otter, Elmqvist and Mattsson, CACSD 1999: the finite automaton of an element; coupled ones iterate over it.

use super::contacts::Break;
use super::friction::{Friction, State};
use super::rates::Rates;
use super::stages::{Change, Sense};

/// What happens to an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// Its slip ends.
    Rest(usize),
    /// It carries all that it can.
    Break(Break),
    /// Its slip comes to the next point of its curve, upwards or downwards.
    Knot { element: usize, up: bool },
    /// A gear stage with losses comes to rest or leaves it.
    Stage(Change),
}

/// Sets states that agree with a motion after an event, and speeds that agree with them; whether there are any.
/// `small`: slip below which there is none.
pub fn settle(rates: &mut Rates<'_>, t: f64, state: &mut [f64], small: f64, event: Option<Event>) -> bool {
    rates.derivative(t, state, &mut state.to_vec());
    if let Some(Event::Knot { element, up }) = event {
        return pass_knot(rates, element, up);
    }
    let frictions = &rates.system.frictions;
    let mut states: Vec<State> =
        (0..frictions.len()).map(|e| first_state(rates, t, e, small, event)).collect();
    let resting: Vec<bool> = states.iter().map(|&state| state == State::Stuck).collect();
    if let Some(Event::Break(Break { element, forward })) = event {
        states[element] = sliding(rates, element, forward, 0.0);
    }
    if let Some(Event::Stage(change)) = event {
        turn(rates, change, state);
    }
    let mut seen: Vec<(Vec<State>, Vec<Sense>)> = Vec::new();
    let mut joined = state.to_vec();
    while !seen.iter().any(|(of, senses)| *of == states && *senses == rates.stages.senses) {
        seen.push((states.clone(), rates.stages.senses.clone()));
        rates.contacts.set(frictions, &states);
        joined.copy_from_slice(state);
        join_speeds(rates, &mut joined);
        rates.derivative(t, &joined, &mut state.to_vec());
        let (margin, breaks) = rates.carry();
        if let (true, Some(Break { element, forward })) = (margin < 0.0, breaks) {
            states[element] = sliding(rates, element, forward, 0.0);
            continue;
        }
        let against = (0..states.len()).find(|&e| resting[e] && slides_against(rates, e));
        if let Some(element) = against {
            states[element] = State::Stuck;
            continue;
        }
        let Some(change) = rates.change() else {
            state.copy_from_slice(&joined);
            return true;
        };
        turn(rates, change, state);
    }
    false
}

/// State of an element from its slip alone.
fn first_state(rates: &Rates<'_>, t: f64, e: usize, small: f64, event: Option<Event>) -> State {
    let friction = &rates.system.frictions[e];
    let (slip, now) = (rates.slip(friction), rates.contacts.states[e]);
    if !rates.is_engaged(friction, t) {
        return State::Open;
    }
    let nears = slip * rates.slip_rate(friction) <= 0.0;
    let rests = match now {
        State::Stuck => true,
        State::Open => slip.abs() <= small,
        State::Slip { .. } => event == Some(Event::Rest(e)) || (slip.abs() <= small && nears),
    };
    // What cannot slide in the sense in which it does is taken to rest; [`Follower`](super::course) refuses more.
    if rests || friction.grip(slip > 0.0).is_none() {
        return State::Stuck;
    }
    match now {
        State::Slip { .. } => now,
        _ => sliding(rates, e, slip > 0.0, slip.abs()),
    }
}

/// An element that slides in a sense.
fn sliding(rates: &Rates<'_>, e: usize, forward: bool, slip: f64) -> State {
    let curve = rates.system.frictions[e].grip(forward).and_then(|grip| grip.curve);
    State::Slip { forward, piece: curve.map_or(0, |curve| rates.system.curves[curve].piece(slip)) }
}

/// Whether an element without slip slides the wrong way.
fn slides_against(rates: &Rates<'_>, e: usize) -> bool {
    let State::Slip { forward, .. } = rates.contacts.states[e] else { return false };
    let rate = rates.slip_rate(&rates.system.frictions[e]);
    let along = if forward { rate } else { -rate };
    along < -rates.slip_rate_rounding(e)
}

/// Gives masses that are held together, or by rigid stages, speeds that agree, as an impulse would; what is stuck stands.
fn join_speeds(rates: &Rates<'_>, state: &mut [f64]) {
    if !(rates.stages.any() || rates.contacts.holds()) {
        return;
    }
    let n = rates.system.len();
    rates.to_absolute(state);
    rates.join(&mut state[n..]);
    for (link, sense) in rates.stages.senses_of(&rates.system.links) {
        if sense == Sense::Stuck && link.manner.loss.is_some() {
            state[n + link.ends[0]] = 0.0;
            if link.manner.rigid {
                state[n + link.ends[1]] = 0.0;
            }
        }
    }
    rates.to_relative(state);
}

/// Changes the sense of a stage; what comes to rest or leaves it rests to the last digit.
fn turn(rates: &mut Rates<'_>, change: Change, state: &mut [f64]) {
    join_speeds(rates, state);
    rates.stages.make(change);
    join_speeds(rates, state);
}

/// Lets a sliding element go on to the next piece of its curve.
fn pass_knot(rates: &mut Rates<'_>, element: usize, up: bool) -> bool {
    if let State::Slip { forward, piece } = rates.contacts.states[element] {
        let piece = if up { piece + 1 } else { piece - 1 };
        rates.contacts.states[element] = State::Slip { forward, piece };
    }
    true
}

/// Whether an element of a system is turned against a sense in which it cannot slide, beyond a small slip.
pub fn is_forced(rates: &Rates<'_>, friction: &Friction, small: f64) -> bool {
    let slip = rates.slip(friction);
    slip.abs() > small && friction.grip(slip > 0.0).is_none()
}
