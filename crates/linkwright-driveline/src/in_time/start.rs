//! What is to be followed.

/// What to follow.
#[derive(Clone, Debug)]
pub struct Start {
    /// Twists against the crank, speeds against it, speed and angle of the crank; without works.
    pub state: Vec<f64>,
    /// Time \[s\].
    pub time: f64,
    /// Direction in which the motor drives, +1 or −1.
    pub motor: f64,
    /// Torque of the brake on every mass, at the speed of the crank \[N m\].
    pub brakes: Vec<f64>,
    /// Share of the torque of the motors that is there: 1, or 0 with the supply off.
    pub supply: f64,
    /// Torque from outside on every mass, counter-clockwise, at the speed of the crank \[N m\].
    pub torques: Vec<f64>,
    /// Torque that opposes the crank per its speed: of a coupling with what is outside \[N m s\].
    pub coupling: f64,
    /// Speed of the crank about which the machine works \[rad/s\].
    pub speed: f64,
    /// Time at which the motion ends at the latest \[s\].
    pub until: f64,
    /// Most revolutions of the crank from the start angle, either way.
    pub turns: f64,
    /// Relative accuracy of a step, at its end and on the way there.
    pub accuracy: f64,
}
