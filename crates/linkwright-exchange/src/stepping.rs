//! The motion over an interval, and what the solver of another program asks for.

use crate::fault::Fault;
use crate::instant::Instant;
use crate::model::{Model, padded};
use linkwright_driveline::equation::Equation;
use linkwright_driveline::in_time::Continuation;
use linkwright_driveline::in_time::trajectory::End;

impl Model {
    /// Follows the motion until a time; inputs stay as they are.
    ///
    /// # Errors
    /// The time lies behind, the mechanism does not close, or the accuracy cannot be kept. The state is that before the step.
    pub fn step(&mut self, until: f64) -> Result<(), Fault> {
        let now = self.state.time;
        if until.is_nan() || until < now || !until.is_finite() {
            return Err(Fault::Time { now, until });
        }
        let (start, accuracy) = (self.start(until), self.state.accuracy);
        let equation = Equation { plan: &self.data.plan, q: &self.q, chain: &self.chain };
        let continuation = self.continuation.get_or_insert_with(|| Continuation::new(equation, accuracy));
        continuation.pace.clone_from(&self.state.pace);
        let path = continuation.follow(equation, &start);
        let n = self.state.y.len();
        let last = (path.t.len() - 1) * (path.states.len() / path.t.len());
        let y = &path.states[last..][..n];
        let time = path.t[path.t.len() - 1];
        match path.end {
            End::Time | End::Turns | End::Rest => {}
            End::DoesNotClose => {
                let degrees = y[n - 1].to_degrees().rem_euclid(360.0);
                return Err(Fault::DoesNotClose { time, degrees });
            }
            End::Inaccurate => return Err(Fault::Inaccurate { time, accuracy }),
        }
        self.state.y.copy_from_slice(y);
        self.state.time = until;
        self.state.pace.clone_from(&continuation.pace);
        self.changed();
        Ok(())
    }

    /// States in their order.
    pub fn continuous(&self) -> Vec<f64> {
        let others = self.chain.masses() - 1;
        (0..self.states()).map(|n| self.state.y[Instant::<f64>::place(n, others)]).collect()
    }

    /// Sets the states.
    ///
    /// # Errors
    /// There are others.
    pub fn set_continuous(&mut self, values: &[f64]) -> Result<(), Fault> {
        if values.len() != self.states() {
            return Err(Fault::Length { found: values.len(), expected: self.states() });
        }
        let others = self.chain.masses() - 1;
        for (n, &value) in values.iter().enumerate() {
            self.state.y[Instant::<f64>::place(n, others)] = value;
        }
        self.changed();
        Ok(())
    }

    /// Rates of the states.
    ///
    /// # Errors
    /// The mechanism has no acceleration.
    pub fn rates(&mut self) -> Result<Vec<f64>, Fault> {
        let n = self.states();
        let rates: Vec<f64> = (0..n).map(|k| self.number(4 << 16 | k as u32)).collect::<Result<_, _>>()?;
        if rates.iter().all(|rate| rate.is_finite()) {
            return Ok(rates);
        }
        let degrees = self.state.y[n - 1].to_degrees().rem_euclid(360.0);
        Err(Fault::DoesNotClose { time: self.state.time, degrees })
    }

    /// Sizes that the states usually have.
    pub fn nominals(&self) -> Vec<f64> {
        let (speed, others) = (self.speed().max(1.0), self.chain.masses() - 1);
        let twists = (0..2 * others).map(|n| if n < others { 0.01 } else { 0.01 * speed });
        [1.0, speed].into_iter().chain(twists).collect()
    }

    /// Number of event indicators.
    pub fn indicator_count(&mut self) -> usize {
        self.modes().count()
    }

    /// Event indicators: positive, and below zero where an event has happened.
    ///
    /// # Errors
    /// One has no value.
    pub fn indicators(&mut self) -> Result<Vec<f64>, Fault> {
        let modes = self.modes();
        let found = self.in_system(|system, state| {
            let y = padded(system, &state.y);
            modes.indicators(system, state.time, &y)
        });
        let degrees = self.state.y[self.states() - 1].to_degrees().rem_euclid(360.0);
        let closes = found.iter().all(|x| x.is_finite());
        if closes { Ok(found) } else { Err(Fault::DoesNotClose { time: self.state.time, degrees }) }
    }

    /// Takes into account what has happened; whether states have changed by it.
    ///
    /// # Errors
    /// Events follow one another without end.
    pub fn update(&mut self) -> Result<bool, Fault> {
        let mut modes = self.modes();
        let time = self.state.time;
        let changed = self.in_system(|system, state| {
            let mut y = padded(system, &state.y);
            let changed = modes.update(system, state.time, &mut y);
            let n = state.y.len();
            state.y.copy_from_slice(&y[..n]);
            changed
        });
        self.state.modes = Some(modes);
        self.changed();
        changed.ok_or(Fault::Events { time })
    }
}
