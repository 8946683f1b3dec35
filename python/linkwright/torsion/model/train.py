r"""A torsional train: discs that turn, elastic shafts between them, gear stages.

A shaft of sections in a row has the compliance of all of them together,

.. math:: \frac1k = \sum \frac{L}{G I_p}, \qquad I_p = \frac{\pi}{32} (d^4 - d_i^4)

Angles of discs are counted in the sense in which each disc turns when the train runs, so that a gear stage
does not change the sign of an amplitude. Whether a stage reverses the sense counts where stages close a loop.

Modes of the train as a whole may be damped by ratios ζ, measured or assumed, whatever damps [2]_:

.. math:: \ddot p_k + 2\zeta_k\omega_k\,\dot p_k + \omega_k^2 p_k = \Phi_k^T M

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 1, 1956, chapter 3: stiffness of
   shafts.
.. [2] Clough and Penzien, Dynamics of Structures, 2nd ed. 1993, section 12-4: damping of given
   modal ratios.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import CheckedDescription, Description, Name, Whole, fault
from linkwright.kernel.numerics.tangent import tan, total
from linkwright.kernel.units.kinds import ANGLE, COUNT, INERTIA, RATIO
from linkwright.kernel.units.marks import (
    FRACTION,
    SHARE,
    Angle,
    Bound,
    Quantity,
    QuantityList,
    not_negative,
    positive,
)
from linkwright.linkages.model.element import PositiveNumber
from linkwright.torsion.model.clutch import Brake, Clutch, Freewheel
from linkwright.torsion.model.coupling import Coupling, Damper, Pendulum
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.measured_response import MeasuredResponse
from linkwright.torsion.model.shaft_limit import ShaftLimit
from linkwright.torsion.model.shaft_row import fillet_faults, flexibilities, place
from linkwright.torsion.model.shaft_section import Density, Modulus, ShaftSection
from linkwright.torsion.model.train_base import (
    GROUND,
    Damping,
    LossFactor,
    PositiveSpeed,
    PositiveStiffness,
    PositiveTorque,
)
from linkwright.torsion.model.train_mechanism import TrainMechanism
from linkwright.torsion.model.train_torques import (
    Excitation,
    InstalledEngine,
    TrainDriver,
    TrainEngine,
    TrainLoad,
)
from linkwright.torsion.model.train_transient import TrainMotor, TrainTransient

_BELOW = "a ratio from 0 to below 1, for an oscillatory mode"


class ModalDamping(CheckedDescription):
    """Damping ratios of the modes of vibration, in addition to what damps single parts."""

    ratios: Annotated[tuple[float, ...], QuantityList(RATIO)] = Field(
        (), description="Damping ratios ζ of the modes by frequency, from the lowest above zero."
    )
    others: Annotated[float, Quantity(RATIO)] = Field(0.0, description="Damping ratio ζ of all higher modes.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        for n, ratio in enumerate(self.ratios):
            if not 0 <= ratio < 1:
                yield fault("ratios", n, found=ratio, expected=_BELOW)
        if not 0 <= self.others < 1:
            yield fault("others", found=self.others, expected=_BELOW)
        if not self.ratios and not self.others:
            remedy = 'give the same for all modes as others = "1 %"'
            yield fault(expected="ratios of some modes", remedy=remedy)


# As far as gas torques are computed.
_HIGHEST = 48.0
_ORDER = Bound(
    f" from 1 to {_HIGHEST:.0f},",
    {"minimum": 1, "maximum": _HIGHEST},
    lambda value: 1 <= value <= _HIGHEST,
)

ShaftInertia = Literal["ends", "distributed"]


class TrainRun(CheckedDescription):
    """The range of speeds of the first disc, and how far orders count."""

    speed_min: PositiveSpeed = Field(description="Lowest speed of the first disc.")
    speed_max: PositiveSpeed = Field(description="Highest speed of the first disc.")
    points: Whole = Field(200, ge=2, le=100_000, description="Number of speeds, evenly spaced.")
    speed_rated: PositiveSpeed | None = Field(
        None, description="Service speed, at which waveforms are shown. Default: the highest."
    )
    orders_max: Annotated[float, Quantity(COUNT, _ORDER)] = Field(
        24.0, description="Highest order of gas and inertia torques."
    )
    loads_follow: bool = Field(
        False,
        description="Scale the loads at each speed to the mean torque of the engine; otherwise the excess "
        "torque accelerates the train.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.speed_max <= self.speed_min:
            least = f"{self.speed_min:.6g} rad/s or {self.speed_min * 30 / math.pi:.6g} rpm"
            expected = f"more than speed_min, {least}"
            yield fault("speed_max", found=self.speed_max, expected=expected)

    @property
    def speeds(self) -> Floats:
        """All speeds, (n,) [rad/s]: even, with both ends of the range; that of service is in the place of the
        nearest between them, or with two points beside them.
        """
        even = np.linspace(self.speed_min, self.speed_max, self.points)
        if not self.speed_min < self.service < self.speed_max:
            return even
        if self.points == 2:
            return np.insert(even, 1, self.service)
        even[1 + np.abs(even[1:-1] - self.service).argmin()] = self.service
        return even

    @property
    def service(self) -> float:
        """Speed of service [rad/s]."""
        return self.speed_max if self.speed_rated is None else self.speed_rated


__all__ = ["GROUND", "Disc", "ElasticShaft", "Shaft", "ShaftSection", "Train", "TrainGear"]


class Disc(Description):
    """A disc: all that turns with one place of the train."""

    inertia: Annotated[float, positive(INERTIA)] = Field(
        description="Moment of inertia about the axis, at the disc's own speed."
    )
    damping: Damping = Field(
        0.0,
        description="External viscous damping: torque per vibratory angular velocity, from outside "
        "the train.",
    )


class ElasticShaft(CheckedDescription):
    """What makes a shaft twist: its stiffness, or its sections."""

    stiffness: PositiveStiffness | None = Field(
        None, description="Torsional stiffness: torque per angle of twist."
    )
    sections: tuple[ShaftSection, ...] | None = Field(
        None, description="Sections in order, from the first end, instead of the stiffness."
    )
    shear_modulus: Modulus = Field(79.3e9, description="Shear modulus of the sections.")
    damping: Damping = Field(
        0.0, description="Viscous damping: torque per relative angular velocity of the two ends."
    )
    loss_factor: LossFactor = Field(
        0.0,
        description="Loss factor η (hysteresis): complex stiffness k(1 + iη); loss per cycle 2πη of "
        "the peak strain energy.",
    )
    limit: ShaftLimit | None = Field(None, description="Permitted stress.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (self.stiffness is None) == (self.sections is None):
            found = "neither" if self.stiffness is None else "both"
            yield fault(found=found, expected="either stiffness or sections")
        if self.sections is not None and not self.sections:
            yield fault("sections", found="an empty list", expected="a list of at least one section")
        limit = self.limit
        if limit is not None and limit.needs_section and not limit.has_section and self.sections is None:
            expected = "the diameter where the stress counts, as the shaft has no sections"
            yield fault("limit", "diameter", expected=expected)
        for fillet_fault in fillet_faults(self.sections or ()):
            yield InitErrorDetails(
                type=fillet_fault["type"], loc=("sections", *fillet_fault["loc"]), input=fillet_fault["input"]
            )

    @property
    def compliances(self) -> tuple[float, ...]:
        """Twist per torque of each section; of the whole where a stiffness is given [rad/(N m)]."""
        if self.sections is None:
            assert self.stiffness is not None
            return (1.0 / self.stiffness,)
        return tuple(flexibility / self.shear_modulus for flexibility in flexibilities(self.sections))

    @property
    def rate(self) -> float:
        """Torque per twist, given or of the sections [N m/rad]."""
        if self.stiffness is not None:
            return self.stiffness
        rate: float = 1.0 / total(self.compliances)
        return rate

    def distance(self, share: float) -> float | None:
        """How far from the first end a share of the twist lies [m]; None without sections."""
        if self.sections is None:
            return None
        return place(self.sections, share)


# Joints work far below this angle.
_JOINT = Bound(
    " above 0 and up to 60°,", {"minimum": 0, "maximum": math.pi / 3}, lambda x: 0 < x <= math.pi / 3
)
JointAngle = Annotated[float, Quantity(ANGLE, _JOINT)]

# Share of the twist of the first harmonic of a joint below which further ones do not count.
_JOINT_HARMONIC = 1e-6


class Shaft(ElasticShaft):
    """An elastic shaft between two discs, or between a disc and the ground."""

    between: tuple[str, str] = Field(
        description='The two discs that it connects; one end may be "ground" (fixed).'
    )
    density: Density | None = Field(
        None,
        description="Density of the sections. Given, the shaft has its own inertia, treated "
        "according to `inertia`.",
    )
    own_inertia: Annotated[float, positive(INERTIA)] | None = Field(
        None,
        description="Moment of inertia of a uniform shaft about its axis, together with its "
        "stiffness and instead of a density.",
    )
    inertia: ShaftInertia | None = Field(
        None,
        description='Inertia of the shaft: "ends" adds half to the disc at each end; "distributed" treats '
        "it exactly along the shaft. Default: that of [train].",
    )
    joint_angle: JointAngle | None = Field(
        None,
        description="Angle of a Hooke's joint at the first end, whose uneven speed ratio excites vibration.",
    )
    joint_phase: Angle = Field(
        0.0, description="Angle of the first fork from the plane of both axes, at the zero of the disc angle."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        if self.joint_phase and self.joint_angle is None:
            yield fault("joint_angle", expected="the angle of the joint whose phase is given")
        if self.joint_angle is not None and GROUND in self.between:
            yield fault("between", found=list(self.between), expected="two discs, with a joint between them")
        if self.density is not None and self.sections is None:
            expected = "the sections whose inertia it gives"
            remedy = "leave density out, or give own_inertia beside the stiffness"
            yield fault("density", found=self.density, expected=expected, remedy=remedy)
        if self.own_inertia is not None and self.stiffness is None:
            remedy = "give the density of the sections instead"
            yield fault(
                "own_inertia", found=self.own_inertia, expected="the stiffness beside it", remedy=remedy
            )
        if self.inertia is not None and not self.is_heavy:
            expected = "an inertia of the shaft: the density of its sections, or own_inertia"
            yield fault("inertia", found=self.inertia, expected=expected)

    @property
    def joint_harmonics(self) -> tuple[float, ...]:
        """Amplitudes of sin 2φ, sin 4φ, … by which the joint drives the shaft ahead [rad].

        With tan ψ = tan φ/cos α the angle behind the joint is ψ = φ + Σ tᵏ/k sin 2kφ, t = tan²(α/2).
        """
        if self.joint_angle is None:
            return ()
        t = tan(self.joint_angle / 2) ** 2
        count = 1
        while t**count / (count + 1) > _JOINT_HARMONIC:
            count += 1
        return tuple(t**k / k for k in range(1, count + 1))

    @property
    def is_heavy(self) -> bool:
        """Whether it has an inertia of its own."""
        return self.density is not None or self.own_inertia is not None


# Ratio of a gear stage: beyond it nothing of one side is left in the motion of the other but rounding.
_RATIO_MAX = 1e6


class TrainGear(CheckedDescription):
    """A gear stage between two discs, rigid, or elastic in its mesh."""

    between: tuple[str, str] = Field(
        description='The two discs that it connects; on a carrier the second may be "ground" (fixed).'
    )
    ratio: PositiveNumber | None = Field(None, description="Speed of the first disc over that of the second.")
    teeth: tuple[PositiveNumber, PositiveNumber] | None = Field(
        None, description="Numbers of teeth of the first and second gear, instead of the ratio."
    )
    kind: Literal["external", "internal", "belt", "crossed_belt"] = Field(
        "external",
        description="Kind of stage; external gears and a crossed belt reverse the sense of rotation, "
        "which matters in closed loops.",
    )
    stiffness: PositiveStiffness | None = Field(
        None, description="Mesh stiffness, referred to the first disc: torque per angle. Default: rigid."
    )
    damping: Damping = Field(
        0.0,
        description="Damping of an elastic mesh, referred to the first disc: torque per angular velocity; "
        "with backlash, in contact only.",
    )
    loss_factor: LossFactor = Field(0.0, description="Loss factor of an elastic mesh.")
    backlash: Annotated[float, not_negative(ANGLE)] = Field(
        0.0,
        description="Backlash of an elastic mesh, from flank to flank, as angle of the first disc; for "
        "motion in time.",
    )
    efficiency: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0, description="Efficiency while the first disc drives; for motion in time."
    )
    efficiency_reverse: Annotated[float, Quantity(RATIO, SHARE)] | None = Field(
        None,
        description="Efficiency while the second disc drives; 0 for a self-locking stage, which no load "
        "drives (worm, screw). Default: as `efficiency`.",
    )
    torque_permitted: PositiveTorque | None = Field(
        None, description="Maximum torque at the first disc, in steady running and in manoeuvres."
    )
    carrier: str | None = Field(
        None,
        description="Disc that carries the bearings of both gears: a planet carrier, or a housing on an "
        "elastic seat; the ratio then holds relative to it (Willis). Default: the ground.",
    )
    carrier_speed: Annotated[float, Quantity(RATIO)] | None = Field(
        None,
        description="Speed of the carrier over that of the first disc of the train, negative in the opposite "
        "sense; only where the other connections leave it open.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from self._carrier_faults()
        if (self.ratio is None) == (self.teeth is None):
            found = "neither" if self.ratio is None else "both"
            yield fault(found=found, expected="either ratio or teeth")
        elif not 1 / _RATIO_MAX <= abs(self.speed_ratio) <= _RATIO_MAX:
            key, size = "teeth" if self.ratio is None else "ratio", abs(self.speed_ratio)
            yield fault(key, found=f"a ratio of {size:.3g}", expected=f"{1 / _RATIO_MAX:g} to {_RATIO_MAX:g}")
        for name in ("damping", "loss_factor"):
            if self.stiffness is None and getattr(self, name):
                remedy = "give the stiffness of the mesh, or the damping to its discs"
                yield fault(name, found=getattr(self, name), expected="none with a rigid mesh", remedy=remedy)
        if self.backlash and "belt" in self.kind:
            yield fault("backlash", found=self.backlash, expected="none with a belt", remedy="leave it out")
        elif self.backlash and self.stiffness is None:
            remedy = "give the stiffness of the mesh"
            yield fault("backlash", found=self.backlash, expected="none with a rigid mesh", remedy=remedy)

    @property
    def losses(self) -> tuple[float, float] | None:
        """Torque at the first disc over that of the teeth while it drives, and while the second does."""
        reverse = self.efficiency if self.efficiency_reverse is None else self.efficiency_reverse
        return None if self.efficiency == 1 == reverse else (1 / self.efficiency, reverse)

    def _carrier_faults(self) -> Iterator[InitErrorDetails]:
        if self.carrier is None:
            if self.carrier_speed is not None:
                yield fault("carrier", expected="the disc whose speed carrier_speed is")
            return
        if self.stiffness is None:
            remedy = "give the stiffness of the mesh, referred to the first disc"
            yield fault("stiffness", expected="an elastic mesh between gears on a carrier", remedy=remedy)
        for name in ("backlash", "efficiency", "efficiency_reverse"):
            found = getattr(self, name)
            if name in self.model_fields_set and found != (0.0 if name == "backlash" else 1.0):
                yield fault(name, found=found, expected="none with a carrier", remedy="leave it out")

    @property
    def speed_ratio(self) -> float:
        """Speed of the first disc over that of the second, relative to the carrier; negative if reversed."""
        size = self.ratio
        if size is None:
            assert self.teeth is not None
            size = self.teeth[1] / self.teeth[0]
        return -size if self.kind in ("external", "crossed_belt") else size


class Planetary(CheckedDescription):
    """A planetary stage: sun, ring, carrier, each free, driven or held, with equal planets between them."""

    sun: str = Field(description='Disc of the sun gear; "ground" where it is held.')
    ring: str = Field(description='Disc of the ring gear; "ground" where it is held.')
    carrier: str = Field(
        description="Disc of the carrier, whose inertia includes the masses of the planets at their centres."
    )
    teeth: tuple[PositiveNumber, PositiveNumber] = Field(description="Numbers of teeth of sun and ring.")
    planet_teeth: PositiveNumber | None = Field(
        None, description="Number of teeth of a planet. Default: half the difference of ring and sun."
    )
    planets: Whole = Field(3, ge=1, le=20, description="Number of planets.")
    planet_inertia: Annotated[float, positive(INERTIA)] = Field(
        description="Moment of inertia of one planet about its own axis."
    )
    sun_stiffness: PositiveStiffness = Field(
        description="Mesh stiffness of the sun with one planet, as torque of the sun per angle."
    )
    ring_stiffness: PositiveStiffness = Field(
        description="Mesh stiffness of the ring with one planet, as torque of the ring per angle."
    )
    loss_factor: LossFactor = Field(0.0, description="Loss factor of all meshes.")
    carrier_speed: Annotated[float, Quantity(RATIO)] | None = Field(
        None,
        description="Speed of the carrier over that of the first disc of the train, negative in the opposite "
        "sense; only where all three members turn and the other connections leave it open.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.teeth[1] <= self.teeth[0]:
            yield fault("teeth", 1, found=self.teeth[1], expected="more teeth of the ring than of the sun")
        if self.sun == GROUND == self.ring:
            yield fault("ring", found=self.ring, expected="a disc: two held members leave no motion")

    def planet_names(self, name: str) -> tuple[str, ...]:
        """Names of the discs that its planets are."""
        return tuple(f"{name}_planet_{n + 1}" for n in range(self.planets))

    def meshes(self, name: str) -> dict[str, TrainGear]:
        """Its meshes, that of the sun with each planet, then those of the ring."""
        of_planet = self.planet_teeth or (self.teeth[1] - self.teeth[0]) / 2
        meshes: dict[str, TrainGear] = {}
        members: tuple[tuple[str, str, float, float, Literal["external", "internal"]], ...] = (
            ("sun", self.sun, self.teeth[0], self.sun_stiffness, "external"),
            ("ring", self.ring, self.teeth[1], self.ring_stiffness, "internal"),
        )
        for word, disc, teeth, stiffness, kind in members:
            # A mesh is counted at its first disc, which cannot be the ground.
            held = disc == GROUND
            for n, planet in enumerate(self.planet_names(name)):
                meshes[f"{name}_{word}_{n + 1}"] = TrainGear.model_construct(
                    between=(planet, disc) if held else (disc, planet),
                    teeth=(of_planet, teeth) if held else (teeth, of_planet),
                    kind=kind,
                    stiffness=stiffness * (of_planet / teeth) ** 2 if held else stiffness,
                    loss_factor=self.loss_factor,
                    carrier=self.carrier,
                    carrier_speed=self.carrier_speed,
                )
        return meshes


class Train(Description):
    """Discs, shafts and gear stages by name, what damps them and what excites them."""

    discs: dict[Name, Disc] = Field(default_factory=dict, description="Rotating discs, by name.")
    shafts: dict[Name, Shaft] = Field(default_factory=dict, description="Shafts between the discs, by name.")
    gears: dict[Name, TrainGear] = Field(default_factory=dict, description="Gear stages by name.")
    planetaries: dict[Name, Planetary] = Field(
        default_factory=dict,
        description="Planetary stages by name, each with discs NAME_planet_1, … and meshes NAME_sun_1, …, "
        "NAME_ring_1, …",
    )
    couplings: dict[Name, Coupling] = Field(default_factory=dict, description="Elastic couplings by name.")
    clutches: dict[Name, Clutch] = Field(default_factory=dict, description="Friction clutches by name.")
    brakes: dict[Name, Brake] = Field(
        default_factory=dict,
        description="Brakes, and dry friction of bearings and drill bits, by name; for motion in time.",
    )
    freewheels: dict[Name, Freewheel] = Field(
        default_factory=dict, description="Freewheels (one-way clutches) and backstops by name."
    )
    dampers: dict[Name, Damper] = Field(default_factory=dict, description="Torsional dampers by name.")
    pendulums: dict[Name, Pendulum] = Field(
        default_factory=dict, description="Centrifugal pendulum absorbers by name; they need [train.run]."
    )
    loads: dict[Name, TrainLoad] = Field(default_factory=dict, description="Driven machines, by name.")
    excitations: dict[Name, Excitation] = Field(
        default_factory=dict, description="Pulsating torques, by name."
    )
    engine: ReciprocatingEngine | None = Field(
        None, description="Reciprocating engine; it adds the discs throw_1, throw_2, … and their shafts."
    )
    engines: dict[Name, TrainEngine] = Field(
        default_factory=dict,
        description="Several engines, by name, each with discs NAME_throw_1, NAME_throw_2, … and shafts "
        "NAME_crank_1, … Default: [train.engine] alone.",
    )
    driver: str | None = Field(None, description="Driving disc if there is no engine. Default: the first.")
    drivers: dict[Name, TrainDriver] = Field(
        default_factory=dict,
        description="Several turbines or motors that drive the loads, by name, instead of one driver.",
    )
    motors: dict[Name, TrainMotor] = Field(
        default_factory=dict,
        description="Motors by name, for steady motion and motion in time; the discs have their inertias.",
    )
    mechanisms: dict[Name, TrainMechanism] = Field(
        default_factory=dict,
        description="Mechanisms by name, with their inertia and loads at every crank angle; motion is "
        "counted by the crank angle of the first one.",
    )
    inertia: ShaftInertia = Field(
        "ends",
        description='Inertia of shafts with a density or own_inertia, unless the shaft states it: "ends" '
        'adds half to the disc at each end; "distributed" treats it exactly along the shaft.',
    )
    modes: Whole | None = Field(
        None,
        ge=1,
        le=200,
        description="Number of modes with distributed inertia. Default: number of discs and sections of "
        "such shafts, plus two.",
    )
    modal_damping: ModalDamping | None = Field(
        None, description="Damping ratios of the modes, in addition to the damping of the parts."
    )
    run: TrainRun | None = Field(None, description="Speeds and orders of forced vibration.")
    measured: dict[Name, MeasuredResponse] = Field(
        default_factory=dict, description="Measured curves for comparison, by name."
    )
    transient: TrainTransient | None = Field(None, description="Manoeuvre in time.")

    @property
    def coaxial(self) -> dict[str, tuple[str, str]]:
        """Pairs of discs that clutches and freewheels connect, by name."""
        pairs = {name: clutch.between for name, clutch in self.clutches.items()}
        wheels = {name: wheel.between for name, wheel in self.freewheels.items()}
        return pairs | {name: pair for name, pair in wheels.items() if GROUND not in pair}

    @property
    def engaged(self) -> list[tuple[str, str]]:
        """Pairs of discs that move as one where the train runs: of closed clutches, and of freewheels."""
        is_open = {name for name, clutch in self.clutches.items() if not clutch.closed}
        return [pair for name, pair in self.coaxial.items() if name not in is_open]

    @property
    def rubs(self) -> bool:
        """Whether it has parts with dry friction."""
        return bool(self.clutches or self.brakes or self.freewheels)

    @property
    def installed(self) -> tuple[InstalledEngine, ...]:
        """All engines, each in its place."""
        if not self.engines:
            return () if self.engine is None else (InstalledEngine("", self.engine, 0.0),)
        return tuple(
            InstalledEngine(
                name, engine.model_copy(update={"factors": one.factors or engine.factors}), one.phase
            )
            for name, one in self.engines.items()
            if (engine := one.engine or self.engine) is not None
        )

    @property
    def is_driven(self) -> bool:
        """Whether its drivers give what loads and compressors need: no engine drives."""
        return all(one.engine.machine == "compressor" for one in self.installed)

    @property
    def shares(self) -> dict[str, float]:
        """Share of each disc that drives in the power that loads need, of all 1; none beside engines."""
        if not self.is_driven:
            return {}
        sharing = [driver for driver in self.drivers.values() if driver.torque is None]
        if not sharing:
            driving = [self.driver] if self.driver else [motor.on for motor in self.motors.values()]
            driving = driving or [next(iter(self.discs))]
            return {} if self.drivers else {on: driving.count(on) / len(driving) for on in driving}
        total = sum(driver.share for driver in sharing)
        shares: dict[str, float] = {}
        for driver in sharing:
            shares[driver.on] = shares.get(driver.on, 0.0) + driver.share / total
        return shares
