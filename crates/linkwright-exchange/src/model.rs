//! The machine with its state: values by reference, read and set, and derivatives.

use crate::data::Data;
use crate::fault::Fault;
use crate::instant::{Around, Instant};
use crate::numbers::plain;
use crate::outside::Outside;
use crate::quantity::Quantity;
use linkwright_driveline::chain::Chain;
use linkwright_driveline::equation::Equation;
use linkwright_driveline::in_time::modes::Modes;
use linkwright_driveline::in_time::start::Start;
use linkwright_driveline::in_time::system::System;
use linkwright_driveline::in_time::{Continuation, Pace};
use serde::{Deserialize, Serialize};

/// Share of the working speed at which laws are taken at rest: that of [`linkwright_driveline::in_time`].
const SLOW: f64 = 1e-11;

/// Who integrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The machine itself, over intervals.
    Stepping,
    /// Another program, by rates and indicators.
    Exchange,
}

/// All that changes: what is saved and restored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time \[s\].
    pub time: f64,
    /// Twists and speeds of the masses against the crank, its speed and angle.
    pub y: Vec<f64>,
    /// Whether the supply is on.
    pub supply: bool,
    /// What the other program applies.
    pub outside: Outside<f64>,
    /// Values of the parameters.
    pub parameters: Vec<f64>,
    /// Relative accuracy of a step.
    pub accuracy: f64,
    /// Forms of the laws; none where they follow from the state.
    pub modes: Option<Modes>,
    /// What the solver knows.
    pub pace: Option<Pace>,
}

/// A machine with its state.
pub struct Model {
    pub(crate) data: Data,
    pub(crate) q: Vec<f64>,
    pub(crate) chain: Chain,
    pub(crate) state: State,
    pub(crate) continuation: Option<Continuation>,
    purpose: Purpose,
    /// Whether the motion has begun: from then on events alone change the forms of laws that another program relies on.
    has_begun: bool,
    instant: Option<Instant<f64>>,
}

impl Model {
    /// The machine at its start.
    pub fn new(data: Data, purpose: Purpose) -> Self {
        let others = data.chain.masses() - 1;
        let mut y = vec![0.0; 2 * others + 2];
        [y[2 * others + 1], y[2 * others]] = data.start;
        let state = State {
            time: 0.0,
            y,
            supply: true,
            outside: Outside::default(),
            parameters: data.parameters.iter().map(|one| one.value).collect(),
            accuracy: data.accuracy,
            modes: None,
            pace: None,
        };
        let (q, chain) = plain(&data, &state.parameters);
        Model { data, q, chain, state, continuation: None, purpose, has_begun: false, instant: None }
    }

    /// Takes the machine back to its start.
    pub fn reset(&mut self) {
        let data = self.data.clone();
        *self = Model::new(data, self.purpose);
    }

    /// What the description of the variables is known by.
    pub fn token(&self) -> &str {
        &self.data.token
    }

    /// Begins the motion: all start values are set.
    pub fn begin(&mut self) {
        self.has_begun = true;
        self.state.modes = None;
        self.instant = None;
    }

    /// Who integrates.
    pub fn purpose(&self) -> Purpose {
        self.purpose
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        self.state.y.len()
    }

    /// Time \[s\].
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Sets the time.
    pub fn set_time(&mut self, time: f64) {
        self.state.time = time;
        self.instant = None;
    }

    /// Sets the accuracy of steps, within what the solver can keep.
    pub fn set_accuracy(&mut self, accuracy: f64) {
        if accuracy.is_finite() && accuracy > 0.0 {
            self.state.accuracy = accuracy.clamp(1e-13, 1e-2);
            self.continuation = None;
        }
    }

    /// What is to be followed until a time.
    pub(crate) fn start(&self, until: f64) -> Start {
        let State { time, ref y, supply, outside, accuracy, .. } = self.state;
        let masses = self.chain.masses();
        let on = |mass: usize, x: f64| {
            let mut list = vec![0.0; masses];
            list[mass] = x;
            list
        };
        Start {
            state: y.clone(),
            time,
            motor: self.data.motor,
            brakes: on(self.data.brake, outside.brake),
            supply: f64::from(u8::from(supply)),
            torques: on(masses - 1, outside.torque + outside.coupled(0.0)),
            coupling: outside.coupling,
            speed: self.speed(),
            until,
            turns: f64::INFINITY,
            accuracy,
        }
    }

    /// Speed about which the crank works \[rad/s\].
    pub fn speed(&self) -> f64 {
        self.q[self.data.plan.drive.speed_start].abs()
    }

    /// Something done with the machine and its state in the solver's terms.
    pub(crate) fn in_system<T>(&mut self, work: impl FnOnce(&mut System<'_>, &mut State) -> T) -> T {
        let start = self.start(f64::INFINITY);
        let equation = Equation { plan: &self.data.plan, q: &self.q, chain: &self.chain };
        let accuracy = self.state.accuracy;
        let continuation = self.continuation.get_or_insert_with(|| Continuation::new(equation, accuracy));
        let state = &mut self.state;
        continuation.at(equation, &start, |system| work(system, state))
    }

    /// Forms of the laws: as they were left by the last event, or those of the state.
    pub(crate) fn modes(&mut self) -> Modes {
        if let Some(known) = &self.state.modes {
            return known.clone();
        }
        let speed = self.speed();
        let modes = self.in_system(|system, state| {
            let y = padded(system, &state.y);
            Modes::of(system, (state.time, &y), speed)
        });
        self.state.modes = Some(modes.clone());
        modes
    }

    /// The machine at this instant.
    fn instant(&mut self) -> &Instant<f64> {
        let instant = match self.instant.take() {
            Some(known) => known,
            None => {
                let modes = self.modes();
                let around = self.around(&modes, self.state.outside);
                Instant::of(&self.data.plan, &self.q, &self.chain, self.state.y.clone(), &around)
            }
        };
        self.instant.insert(instant)
    }

    pub(crate) fn around<'a, N>(&self, modes: &'a Modes, outside: Outside<N>) -> Around<'a, N> {
        Around {
            time: self.state.time,
            motor: self.data.motor,
            supply: f64::from(u8::from(self.state.supply)),
            outside,
            braked: self.data.brake,
            slow: SLOW * self.speed(),
            senses: modes.senses(),
            zones: modes.zones(),
        }
    }

    /// A number.
    ///
    /// # Errors
    /// There is none of this reference.
    pub fn number(&mut self, reference: u32) -> Result<f64, Fault> {
        let missing = Fault::Reference(reference);
        let State { time, mut outside, ref parameters, .. } = self.state;
        match Quantity::of(reference)? {
            Quantity::Time => Ok(time),
            Quantity::Outside(n) => outside.part(n).copied().ok_or(missing),
            Quantity::Parameter(n) => parameters.get(n).copied().ok_or(missing),
            Quantity::Indicator(n) => self.indicators()?.get(n).copied().ok_or(missing),
            quantity => {
                let value = quantity.at(self.instant()).ok_or(missing)?;
                Ok(value * self.scale(reference))
            }
        }
    }

    /// What a number is read times.
    pub(crate) fn scale(&self, reference: u32) -> f64 {
        self.data.scales.iter().find(|(of, _)| *of == reference).map_or(1.0, |&(_, factor)| factor)
    }

    /// Between which numbers a number may be set: those of its range, else any.
    fn range(&self, reference: u32) -> [f64; 2] {
        let known = self.data.ranges.iter().find(|(of, ..)| *of == reference);
        known.map_or([f64::MIN, f64::MAX], |&(_, low, high)| [low, high])
    }

    /// Whether something holds.
    ///
    /// # Errors
    /// There is nothing of this reference.
    pub fn truth(&mut self, reference: u32) -> Result<bool, Fault> {
        match Quantity::of(reference)? {
            Quantity::Supply => Ok(self.state.supply),
            Quantity::AtRest => Ok(self.modes().senses().last() == Some(&0.0)),
            _ => Err(Fault::Reference(reference)),
        }
    }

    /// Forgets what follows from what was changed.
    pub(crate) fn changed(&mut self) {
        self.instant = None;
        if self.purpose == Purpose::Stepping || !self.has_begun {
            self.state.modes = None;
        }
    }

    /// Sets a number.
    ///
    /// # Errors
    /// There is none of this reference, it may not be set, or its value is out of range.
    pub fn set_number(&mut self, reference: u32, value: f64) -> Result<(), Fault> {
        let range = self.range(reference);
        if !(range[0]..=range[1]).contains(&value) {
            return Err(Fault::Value { reference, value, range });
        }
        match Quantity::of(reference)? {
            Quantity::Outside(n) => {
                *self.state.outside.part(n).ok_or(Fault::Reference(reference))? = value;
            }
            Quantity::Parameter(n) => {
                let place = self.state.parameters.get_mut(n).ok_or(Fault::Reference(reference))?;
                *place = value;
                self.renumber();
            }
            Quantity::State(n) if n < self.states() => {
                let place = Instant::<f64>::place(n, self.chain.masses() - 1);
                self.state.y[place] = value;
                self.state.modes = None;
            }
            _ => return Err(Fault::Fixed(reference)),
        }
        self.changed();
        Ok(())
    }

    /// Sets whether something holds.
    ///
    /// # Errors
    /// There is nothing of this reference, or it may not be set.
    pub fn set_truth(&mut self, reference: u32, value: bool) -> Result<(), Fault> {
        match Quantity::of(reference)? {
            Quantity::Supply => self.state.supply = value,
            _ => return Err(Fault::Fixed(reference)),
        }
        self.changed();
        Ok(())
    }

    /// Takes the values of the parameters.
    fn renumber(&mut self) {
        (self.q, self.chain) = plain(&self.data, &self.state.parameters);
        self.continuation = None;
    }

    /// The state, to be restored.
    pub fn saved(&self) -> State {
        self.state.clone()
    }

    /// Takes a state that was saved, before the motion began or later.
    ///
    /// # Errors
    /// It is of another machine.
    pub fn restore(&mut self, state: State, has_begun: bool) -> Result<(), Fault> {
        if state.y.len() != self.states() || state.parameters.len() != self.data.parameters.len() {
            return Err(Fault::State);
        }
        let is_other = state.parameters != self.state.parameters || state.accuracy != self.state.accuracy;
        (self.state, self.has_begun) = (state, has_begun);
        if is_other {
            self.renumber();
        }
        self.instant = None;
        Ok(())
    }

    /// The state as bytes.
    ///
    /// # Errors
    /// There is no memory.
    pub fn to_bytes(state: &State) -> Result<Vec<u8>, Fault> {
        postcard::to_allocvec(state).map_err(|_| Fault::State)
    }

    /// A state from bytes.
    ///
    /// # Errors
    /// They are not those of a state.
    pub fn from_bytes(bytes: &[u8]) -> Result<State, Fault> {
        postcard::from_bytes(bytes).map_err(|_| Fault::State)
    }
}

/// A state with room for works.
pub(crate) fn padded(system: &System<'_>, y: &[f64]) -> Vec<f64> {
    let mut padded = vec![0.0; system.layout.size];
    padded[..y.len()].copy_from_slice(y);
    padded
}
