//! When an element with dry friction sticks, slips or comes to the next point of its curve, within a step.
//!
//! The slip is that of the method's own polynomial, the torque of stuck elements that of the equations there. Where one of
//! them crosses its bound, the step is taken again up to that instant.

use super::friction::State;
use super::rates::Rates;
use super::settle::Event;
use super::stepper::Stepper;

/// Places in a step where the slip is looked at.
const PLACES: usize = 8;

/// Part of the change of a margin over a step that a parabola may miss.
const DOUBT: f64 = 0.3;

/// Shortest share of a step to an event, so that time goes on.
const SHORTEST: f64 = 1e-4;

/// Slip that is rounding, over the largest speed so far: this, or some accuracies of a step.
const SMALL: f64 = 1e-9;

/// Speed of a train below which it counts as turning that fast, lest rounding be all of its slip \[rad/s\].
const SLOWEST: f64 = 1e-4;

/// Watches the elements of a train.
#[derive(Clone, Debug)]
pub struct Watch {
    /// What happens at the end of the step.
    pub event: Option<Event>,
    /// Torques of all elements in the middle of the step, then their powers.
    pub middle: Vec<f64>,
    /// Margin at the start and at the end of the step.
    margins: [f64; 2],
    /// Largest speed so far, and share of it below which a slip is none.
    fastest: f64,
    share: f64,
    state: Vec<f64>,
    slopes: Vec<f64>,
}

impl Watch {
    /// For a system, and the accuracy of its steps.
    pub fn new(rates: &Rates<'_>, accuracy: f64) -> Self {
        let n = rates.system.len();
        Watch {
            event: None,
            middle: vec![0.0; 2 * rates.system.frictions.len()],
            margins: [f64::INFINITY; 2],
            fastest: 0.0,
            share: SMALL.max(2.0 * accuracy),
            state: vec![0.0; 2 * n],
            slopes: vec![0.0; 2 * n],
        }
    }

    /// Slip that counts as none \[rad/s\].
    pub fn small(&self) -> f64 {
        self.share * self.fastest.max(SLOWEST)
    }

    /// Takes note of the instant last evaluated, where a step begins anew.
    pub fn begin(&mut self, rates: &mut Rates<'_>) {
        self.margins[0] = rates.carry().0;
    }

    /// Takes note of speeds at the instant last evaluated.
    pub fn widen(&mut self, rates: &Rates<'_>) {
        let n = rates.system.len();
        self.fastest = rates.omega[..n].iter().fold(self.fastest, |most, w| most.max(w.abs()));
    }

    /// Takes note of the instant last evaluated, the end of a step.
    pub fn look(&mut self, rates: &mut Rates<'_>) {
        self.margins[1] = rates.carry().0;
    }

    /// Lets the end of the step be the start of the next.
    pub fn advance(&mut self) {
        self.margins[0] = self.margins[1];
    }

    /// The first event within a step, as a share of it.
    pub fn first(
        &mut self,
        rates: &mut Rates<'_>,
        stepper: &impl Stepper,
        at: (f64, &Vec<f64>),
        h: f64,
    ) -> Option<(f64, Event)> {
        let mut found: Option<(f64, Event)> = None;
        let mut note = |share: f64, event: Event| {
            if found.is_none_or(|(first, _)| share < first) {
                found = Some((share.max(SHORTEST), event));
            }
        };
        for e in 0..rates.system.frictions.len() {
            self.slides(rates, stepper, (at.1, h), e, &mut note);
        }
        let middle = self.margin(rates, stepper, at, h, 0.5).0;
        self.keep_middle(rates);
        if let Some(share) = self.breaks(rates, stepper, at, h, middle)
            && let (_, Some(breaks)) = self.margin(rates, stepper, at, h, share)
        {
            note(share, Event::Break(breaks));
        }
        found
    }

    /// Events of an element that slides.
    fn slides(
        &self,
        rates: &Rates<'_>,
        stepper: &impl Stepper,
        (state, h): (&[f64], f64),
        e: usize,
        note: &mut impl FnMut(f64, Event),
    ) {
        let friction = &rates.system.frictions[e];
        let State::Slip { forward, piece } = rates.contacts.states[e] else { return };
        let sign = if forward { 1.0 } else { -1.0 };
        let slip = |share: f64| sign * rates.slip_at(friction, |i| stepper.component(share, state, i));
        let small = self.small().max(self.share * h * rates.slip_rate(friction).abs());
        if let Some(share) = crossing(slip, small) {
            note(share, Event::Rest(e));
        }
        let Some(curve) = friction.grip(forward).and_then(|grip| grip.curve) else { return };
        let knots = rates.system.curves[curve].knots();
        let mut passes = |share: Option<f64>, up: bool| {
            share.into_iter().for_each(|share| note(share, Event::Knot { element: e, up }));
        };
        if let Some(&knot) = knots.get(piece) {
            passes(crossing(|share| knot - slip(share), small), true);
        }
        let below = piece.checked_sub(1).and_then(|below| knots.get(below));
        if let Some(&knot) = below.filter(|knot| **knot > 0.0) {
            passes(crossing(|share| slip(share) - knot, small), false);
        }
    }

    /// Share of the step at which a stuck element carries all that it can.
    fn breaks(
        &mut self,
        rates: &mut Rates<'_>,
        stepper: &impl Stepper,
        at: (f64, &Vec<f64>),
        h: f64,
        middle: f64,
    ) -> Option<f64> {
        let [start, end] = self.margins;
        if !start.is_finite() {
            return None;
        }
        let (low, high) = (start.min(middle).min(end), start.max(middle).max(end));
        if low > DOUBT * (high - low) {
            return None;
        }
        crossing(|share| self.margin(rates, stepper, at, h, share).0, 0.0)
    }

    /// Smallest margin at a share of the step, and the element that has it.
    fn margin(
        &mut self,
        rates: &mut Rates<'_>,
        stepper: &impl Stepper,
        at: (f64, &Vec<f64>),
        h: f64,
        share: f64,
    ) -> (f64, Option<super::contacts::Break>) {
        self.evaluate(rates, stepper, at, h, share);
        rates.carry()
    }

    /// Evaluates the equations at a share of the step.
    fn evaluate(
        &mut self,
        rates: &mut Rates<'_>,
        stepper: &impl Stepper,
        (t, start): (f64, &Vec<f64>),
        h: f64,
        share: f64,
    ) {
        stepper.components(share, start, &mut self.state);
        rates.derivative(t + share * h, &self.state, &mut self.slopes);
    }

    /// Torque of an element at a share of the step, or its power.
    pub fn value(
        &mut self,
        rates: &mut Rates<'_>,
        stepper: &impl Stepper,
        at: (f64, &Vec<f64>),
        h: f64,
        (share, row): (f64, usize),
    ) -> f64 {
        self.margin(rates, stepper, at, h, share);
        value(rates, row)
    }

    /// Keeps torques and powers at the instant last evaluated, the middle of the step.
    fn keep_middle(&mut self, rates: &Rates<'_>) {
        self.middle.iter_mut().enumerate().for_each(|(row, to)| *to = value(rates, row));
    }
}

/// Torque of an element at the instant last evaluated; from the number of elements on, its power.
pub fn value(rates: &Rates<'_>, row: usize) -> f64 {
    let frictions = &rates.system.frictions;
    let e = row % frictions.len();
    let torque = rates.contacts.torques[e];
    match rates.contacts.states[e] {
        _ if row == e => torque,
        State::Slip { .. } => torque * rates.slip(&frictions[e]),
        _ => 0.0,
    }
}

/// First share of a step at which a number that is above zero falls below; one that starts from zero has to be small before.
fn crossing(mut value: impl FnMut(f64) -> f64, small: f64) -> Option<f64> {
    let mut before = (0.0, value(0.0));
    let mut counts = before.1 > small;
    for place in 1..=PLACES {
        let share = place as f64 / PLACES as f64;
        let now = (share, value(share));
        let level = if counts { 0.0 } else { -small };
        if now.1 < level {
            let lift = |(share, value): (f64, f64)| (share, value - level);
            return Some(root(|share| value(share) - level, lift(before), lift(now)));
        }
        counts |= now.1 > small;
        before = now;
    }
    None
}

/// Where a number passes zero between two places (Illinois' variant of regula falsi; Dowell and Jarratt, BIT 11 (1971)).
fn root(mut value: impl FnMut(f64) -> f64, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
    if a.1 <= 0.0 {
        return a.0;
    }
    let mut kept = 0;
    for _ in 0..60 {
        let share = (a.0 - a.1 * (b.0 - a.0) / (b.1 - a.1)).clamp(a.0, b.0);
        let here = (share, value(share));
        if here.1 == 0.0 || b.0 - a.0 < 1e-15 {
            return share;
        }
        if here.1 > 0.0 {
            a = here;
            b.1 *= if kept == 1 { 0.5 } else { 1.0 };
            kept = 1;
        } else {
            b = here;
            a.1 *= if kept == -1 { 0.5 } else { 1.0 };
            kept = -1;
        }
    }
    b.0
}
