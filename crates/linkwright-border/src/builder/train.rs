//! A train in motion: `torsion::transient::system` of the core, with the same names.

use linkwright_torsion::transient::controllers::Controller;
use linkwright_torsion::transient::curve::Curve as CoreCurve;
use linkwright_torsion::transient::friction;
use linkwright_torsion::transient::pendulums::Pendulum;
use linkwright_torsion::transient::periodic::Periodic as CorePeriodic;
use linkwright_torsion::transient::system::{self, System};
use linkwright_torsion::transient::torque;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Floats;

/// Cubics through points, with a slope at both sides of each.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct Curve(CoreCurve);

#[pymethods]
impl Curve {
    #[new]
    #[pyo3(signature = (*, x, y, before, after))]
    fn new(x: Floats<'_>, y: Floats<'_>, before: Floats<'_>, after: Floats<'_>) -> PyResult<Self> {
        let curve = CoreCurve::new(x.as_slice()?, y.as_slice()?, before.as_slice()?, after.as_slice()?);
        curve.map(Curve).ok_or_else(|| {
            PyValueError::new_err("curve: points must be finite and never decrease, with two slopes each")
        })
    }
}

/// A function that repeats with an angle, by value, slope and bend at even knots.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) struct Periodic(CorePeriodic);

#[pymethods]
impl Periodic {
    #[new]
    #[pyo3(signature = (*, period, value, slope, bend))]
    fn new(period: f64, value: Floats<'_>, slope: Floats<'_>, bend: Floats<'_>) -> PyResult<Self> {
        let table = CorePeriodic::new(period, value.as_slice()?, slope.as_slice()?, bend.as_slice()?);
        table.map(Periodic).ok_or_else(|| {
            PyValueError::new_err("periodic table: knots must be finite, and the period more than zero")
        })
    }
}

/// Discs that move as one.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionMass {
    inertia: f64,
    damping: f64,
    swing_damping: f64,
    turns: bool,
}

#[pymethods]
impl TorsionMass {
    #[new]
    #[pyo3(signature = (*, inertia, damping, swing_damping, turns=true))]
    fn new(inertia: f64, damping: f64, swing_damping: f64, turns: bool) -> Self {
        TorsionMass { inertia, damping, swing_damping, turns }
    }
}

/// What twists between two masses, or a mass and the ground.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionLink {
    first: Option<usize>,
    second: Option<usize>,
    ratio: f64,
    stiffness: f64,
    damping: f64,
    curve: Option<Py<Curve>>,
    rigid: bool,
    contact: bool,
    loss: Option<(f64, f64)>,
    joint: Option<(f64, f64)>,
    carrier: Option<(usize, [f64; 3])>,
}

#[pymethods]
impl TorsionLink {
    #[new]
    #[pyo3(signature = (
        *, first, second, ratio, stiffness, damping, curve, rigid=false, contact=false, loss=None, joint=None, carrier=None
    ))]
    fn new(
        first: Option<usize>,
        second: Option<usize>,
        ratio: f64,
        stiffness: f64,
        damping: f64,
        curve: Option<Py<Curve>>,
        rigid: bool,
        contact: bool,
        loss: Option<(f64, f64)>,
        joint: Option<(f64, f64)>,
        carrier: Option<(usize, [f64; 3])>,
    ) -> Self {
        TorsionLink { first, second, ratio, stiffness, damping, curve, rigid, contact, loss, joint, carrier }
    }
}

impl TorsionLink {
    /// Beyond a spring and a damper.
    fn manner(&self) -> system::Manner {
        system::Manner {
            rigid: self.rigid,
            contact: self.contact,
            loss: self.loss.map(|(forward, reverse)| system::Loss { forward, reverse }),
            joint: self.joint.map(|(cosine, phase)| system::Joint { cosine, phase }),
            carrier: self.carrier.map(|(mass, shares)| system::Carrier { mass, shares }),
        }
    }
}

/// Centrifugal pendulums on a disc, and the mass that their angle is.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionPendulum {
    disc: usize,
    bob: usize,
    ratio: f64,
    mass: f64,
    radius: f64,
    length: f64,
}

#[pymethods]
impl TorsionPendulum {
    #[new]
    #[pyo3(signature = (*, disc, bob, ratio, mass, radius, length))]
    fn new(disc: usize, bob: usize, ratio: f64, mass: f64, radius: f64, length: f64) -> Self {
        TorsionPendulum { disc, bob, ratio, mass, radius, length }
    }
}

/// A controller of the speed of a mass, and the mass whose speed its integral is.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionController {
    mass: usize,
    integral: usize,
    ratio: f64,
    gain: f64,
    inverse_time: f64,
    offset: f64,
    limit: f64,
    set_point: Py<Curve>,
}

#[pymethods]
impl TorsionController {
    #[new]
    #[pyo3(signature = (*, mass, integral, ratio, gain, inverse_time, offset, limit, set_point))]
    fn new(
        mass: usize,
        integral: usize,
        ratio: f64,
        gain: f64,
        inverse_time: f64,
        offset: f64,
        limit: f64,
        set_point: Py<Curve>,
    ) -> Self {
        TorsionController { mass, integral, ratio, gain, inverse_time, offset, limit, set_point }
    }
}

/// An inertia that changes with the angle of its part.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionRotor {
    mass: usize,
    ratio: f64,
    phase: f64,
    inertia: Py<Periodic>,
}

#[pymethods]
impl TorsionRotor {
    #[new]
    #[pyo3(signature = (*, mass, ratio, phase, inertia))]
    fn new(mass: usize, ratio: f64, phase: f64, inertia: Py<Periodic>) -> Self {
        TorsionRotor { mass, ratio, phase, inertia }
    }
}

/// How a torque depends on the speed of its part, or on time.
#[pyclass(frozen, module = "linkwright._core")]
pub(crate) enum TorqueLaw {
    #[pyo3(constructor = ())]
    Constant {},
    #[pyo3(constructor = (*, speed, exponent))]
    Even { speed: f64, exponent: f64 },
    #[pyo3(constructor = (*, speed, exponent))]
    Odd { speed: f64, exponent: f64 },
    #[pyo3(constructor = (*, curve))]
    OverSpeed { curve: Py<Curve> },
    #[pyo3(constructor = (*, gain, curve))]
    Following { gain: f64, curve: Py<Curve> },
    #[pyo3(constructor = (*, start, end, rate, speed, phase))]
    Decaying { start: f64, end: f64, rate: f64, speed: f64, phase: f64 },
}

/// How a torque depends on the angle.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorqueShape {
    table: Py<Periodic>,
    pitch: f64,
    phase: f64,
}

#[pymethods]
impl TorqueShape {
    #[new]
    #[pyo3(signature = (*, table, pitch, phase))]
    fn new(table: Py<Periodic>, pitch: f64, phase: f64) -> Self {
        TorqueShape { table, pitch, phase }
    }
}

/// A torque on a mass from outside.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionTorque {
    mass: usize,
    ratio: f64,
    scale: f64,
    law: Py<TorqueLaw>,
    weight: Option<Py<Curve>>,
    shape: Option<Py<TorqueShape>>,
}

#[pymethods]
impl TorsionTorque {
    #[new]
    #[pyo3(signature = (*, mass, ratio, scale, law, weight, shape))]
    fn new(
        mass: usize,
        ratio: f64,
        scale: f64,
        law: Py<TorqueLaw>,
        weight: Option<Py<Curve>>,
        shape: Option<Py<TorqueShape>>,
    ) -> Self {
        TorsionTorque { mass, ratio, scale, law, weight, shape }
    }
}

/// Friction in one sense of slip.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionGrip {
    held: f64,
    sliding: f64,
    rise: f64,
    speed: f64,
    curve: Option<Py<Curve>>,
}

#[pymethods]
impl TorsionGrip {
    #[new]
    #[pyo3(signature = (*, held, sliding, rise, speed, curve))]
    fn new(held: f64, sliding: f64, rise: f64, speed: f64, curve: Option<Py<Curve>>) -> Self {
        TorsionGrip { held, sliding, rise, speed, curve }
    }
}

/// An element with dry friction between two masses, or a mass and the ground.
#[pyclass(frozen, get_all, module = "linkwright._core")]
pub(crate) struct TorsionFriction {
    first: Option<usize>,
    second: Option<usize>,
    ratio: f64,
    forward: Option<Py<TorsionGrip>>,
    backward: Option<Py<TorsionGrip>>,
    engagement: Option<Py<Curve>>,
}

#[pymethods]
impl TorsionFriction {
    #[new]
    #[pyo3(signature = (*, first, second, ratio, forward, backward, engagement))]
    fn new(
        first: Option<usize>,
        second: Option<usize>,
        ratio: f64,
        forward: Option<Py<TorsionGrip>>,
        backward: Option<Py<TorsionGrip>>,
        engagement: Option<Py<Curve>>,
    ) -> Self {
        TorsionFriction { first, second, ratio, forward, backward, engagement }
    }
}

/// Things that several parts share, each once, in the order in which they are met.
struct Shelf<T>(Vec<Py<T>>);

impl<T> Shelf<T> {
    /// Where a thing stands.
    fn place(&mut self, py: Python<'_>, thing: &Py<T>) -> usize {
        self.0.iter().position(|known| known.is(thing)).unwrap_or_else(|| {
            self.0.push(thing.clone_ref(py));
            self.0.len() - 1
        })
    }
}

/// Parts that not every train has: pendulums, speed controllers, elements with dry friction.
type Others<'p, 'py> = (
    &'p [PyRef<'py, TorsionPendulum>],
    &'p [PyRef<'py, TorsionController>],
    &'p [PyRef<'py, TorsionFriction>],
);

/// The system of masses, links, rotors and torques, not yet checked.
pub(crate) fn system(
    py: Python<'_>,
    masses: &[PyRef<'_, TorsionMass>],
    links: &[PyRef<'_, TorsionLink>],
    rotors: &[PyRef<'_, TorsionRotor>],
    torques: &[PyRef<'_, TorsionTorque>],
    (pendulums, controllers, frictions): Others<'_, '_>,
) -> System {
    let (mut curves, mut tables) = (Shelf(Vec::new()), Shelf(Vec::new()));
    let ground = masses.len();
    let links = links.iter().map(|link| system::Link {
        ends: [link.first.unwrap_or(ground), link.second.unwrap_or(ground)],
        ratio: link.ratio,
        stiffness: link.stiffness,
        damping: link.damping,
        curve: link.curve.as_ref().map(|curve| curves.place(py, curve)),
        manner: link.manner(),
    });
    let links = links.collect();
    let rotors = rotors.iter().map(|rotor| system::Rotor {
        mass: rotor.mass,
        ratio: rotor.ratio,
        phase: rotor.phase,
        table: tables.place(py, &rotor.inertia),
    });
    let rotors = rotors.collect();
    let torques = torques.iter().map(|torque| torque::Torque {
        mass: torque.mass,
        ratio: torque.ratio,
        scale: torque.scale,
        law: law(py, torque.law.get(), &mut curves),
        weight: torque.weight.as_ref().map(|weight| curves.place(py, weight)),
        shape: torque.shape.as_ref().map(|shape| {
            let shape = shape.get();
            let table = tables.place(py, &shape.table);
            torque::Shape { table, pitch: shape.pitch, phase: shape.phase }
        }),
    });
    let torques = torques.collect();
    let controllers = controllers.iter().map(|one| Controller {
        mass: one.mass,
        integral: one.integral,
        ratio: one.ratio,
        gain: one.gain,
        inverse_time: one.inverse_time,
        offset: one.offset,
        limit: one.limit,
        set_point: curves.place(py, &one.set_point),
    });
    let controllers = controllers.collect();
    let frictions = frictions.iter().map(|friction| friction::Friction {
        ends: [friction.first.unwrap_or(ground), friction.second.unwrap_or(ground)],
        ratio: friction.ratio,
        forward: friction.forward.as_ref().map(|one| grip(py, one.get(), &mut curves)),
        backward: friction.backward.as_ref().map(|one| grip(py, one.get(), &mut curves)),
        engagement: friction.engagement.as_ref().map(|curve| curves.place(py, curve)),
    });
    let frictions = frictions.collect();
    System {
        inertia: masses.iter().map(|mass| mass.inertia).collect(),
        damping: masses.iter().map(|mass| mass.damping).collect(),
        swing_damping: masses.iter().map(|mass| mass.swing_damping).collect(),
        turns: masses.iter().map(|mass| f64::from(mass.turns)).collect(),
        links,
        rotors,
        torques,
        pendulums: pendulums
            .iter()
            .map(|one| Pendulum::new([one.disc, one.bob], one.ratio, one.mass, [one.radius, one.length]))
            .collect(),
        controllers,
        frictions,
        tables: tables.0.iter().map(|table| table.get().0.clone()).collect(),
        curves: curves.0.iter().map(|curve| curve.get().0.clone()).collect(),
    }
}

fn grip(py: Python<'_>, grip: &TorsionGrip, curves: &mut Shelf<Curve>) -> friction::Grip {
    friction::Grip {
        held: grip.held,
        sliding: grip.sliding,
        rise: grip.rise,
        inverse_speed: 1.0 / grip.speed,
        curve: grip.curve.as_ref().map(|curve| curves.place(py, curve)),
    }
}

fn law(py: Python<'_>, law: &TorqueLaw, curves: &mut Shelf<Curve>) -> torque::Law {
    match *law {
        TorqueLaw::Constant {} => torque::Law::Constant,
        TorqueLaw::Even { speed, exponent } => torque::Law::Even { inverse_speed: 1.0 / speed, exponent },
        TorqueLaw::Odd { speed, exponent } => torque::Law::Odd { inverse_speed: 1.0 / speed, exponent },
        TorqueLaw::OverSpeed { ref curve } => torque::Law::OverSpeed { curve: curves.place(py, curve) },
        TorqueLaw::Following { gain, ref curve } => {
            torque::Law::Following { gain, curve: curves.place(py, curve) }
        }
        TorqueLaw::Decaying { start, end, rate, speed, phase } => {
            torque::Law::Decaying { from: start, until: end, rate, omega: speed, phase }
        }
    }
}
