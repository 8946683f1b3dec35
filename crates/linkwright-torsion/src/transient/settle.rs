//! States of elements with dry friction that agree with the motion at an instant.
//!
//! Elements without slip are supposed to hold; one that carries more than it can begins to slide, with its sliding torque,
//! and the others are asked again; one that would slide against its own sense holds. States that come back have no end, and
//! that is said.
//!
//! Source: Otter, Elmqvist and Mattsson, CACSD 1999: the finite automaton of an element; coupled ones iterate over it.

use super::contacts::Break;
use super::friction::{Friction, State};
use super::rates::Rates;

/// What happens to an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// Its slip ends.
    Rest(usize),
    /// It carries all that it can.
    Break(Break),
    /// Its slip comes to the next point of its curve, upwards or downwards.
    Knot { element: usize, up: bool },
}

/// Sets states that agree with a motion after an event, and the speeds that stuck elements join; whether there are any.
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
    let mut seen: Vec<Vec<State>> = Vec::new();
    let mut joined = state.to_vec();
    while !seen.contains(&states) {
        seen.push(states.clone());
        rates.contacts.set(frictions, &states);
        joined.copy_from_slice(state);
        join(rates, &mut joined);
        rates.derivative(t, &joined, &mut state.to_vec());
        let (margin, breaks) = rates.carry();
        if let (true, Some(Break { element, forward })) = (margin < 0.0, breaks) {
            states[element] = sliding(rates, element, forward, 0.0);
            continue;
        }
        let against = (0..states.len()).find(|&e| resting[e] && slides_against(rates, e));
        let Some(element) = against else {
            state.copy_from_slice(&joined);
            return true;
        };
        states[element] = State::Stuck;
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

/// Lets a sliding element go on to the next piece of its curve.
fn pass_knot(rates: &mut Rates<'_>, element: usize, up: bool) -> bool {
    if let State::Slip { forward, piece } = rates.contacts.states[element] {
        let piece = if up { piece + 1 } else { piece - 1 };
        rates.contacts.states[element] = State::Slip { forward, piece };
    }
    true
}

/// Gives the masses of each group their common speed.
fn join(rates: &Rates<'_>, state: &mut [f64]) {
    if !rates.contacts.holds() {
        return;
    }
    rates.to_absolute(state);
    let speeds = rates.system.len();
    rates.contacts.join(&mut state[speeds..], rates.inertias());
    rates.to_relative(state);
}

/// Whether an element of a system is turned against a sense in which it cannot slide, beyond a small slip.
pub fn is_forced(rates: &Rates<'_>, friction: &Friction, small: f64) -> bool {
    let slip = rates.slip(friction);
    slip.abs() > small && friction.grip(slip > 0.0).is_none()
}
