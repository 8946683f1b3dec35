r"""The turning-moment diagram of a machine file: driving and load torques, required speed fluctuation.

A torque is constant, a table or a formula; equal cylinders give the same diagram one after the other. Driver
and load act on one shaft and depend on its angle φ alone, over a cycle of one or two revolutions. Who knows
one of them leaves the other out: it is then constant, at the mean of the one that is given. Who has the areas
of a diagram between its crossings gives these instead.

References
----------
.. [1] S. S. Rattan, Theory of Machines, 4th edition, chapter 13: turning-moment diagrams, flywheels.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.description.curve import curve_faults, unread_file
from linkwright.kernel.description.cycle import ONE_TURN, CycleAngle
from linkwright.kernel.description.formula import NUMBERS, conditions, parse
from linkwright.kernel.description.formula_faults import constant_faults, text_faults
from linkwright.kernel.numerics.formula_value import value
from linkwright.kernel.numerics.tangent import numbers
from linkwright.kernel.units.kinds import COUNT, DENSITY, ENERGY, INERTIA, LENGTH, PRESSURE, RATIO, SPEED
from linkwright.kernel.units.marks import (
    FRACTION,
    Angles,
    AnyQuantity,
    Quantity,
    QuantityList,
    Torque,
    Torques,
    positive,
)

# A table over the whole cycle may close exactly; printed degrees and π are rounded.
_ROUNDED = 1e-9

_LONGER = "set turning_moment.cycle to the angle of a whole cycle, 720 deg for a four-stroke engine"


class ShaftTorque(CheckedDescription):
    """A torque on the shaft, positive against what it stands for: drive or resistance."""

    def at(self, phi: Floats, cycle: float) -> Floats:
        """Torque of all cylinders at shaft angles within the cycle, shape (n,) [N m]."""
        shares = [self.one_at(self._own(phi, start, cycle), cycle) for start in self.starts]
        total = shares[0]
        for share in shares[1:]:
            total = total + share
        return total

    def kinks(self, cycle: float) -> Floats:
        """Angles within the cycle at which it has a corner or a jump [rad]."""
        corners = [np.mod(self.one_kinks(cycle) + start, cycle) for start in self.starts]
        # A diagram that begins later may be broken where it begins.
        begun = [[start % cycle] for start in self.starts if start % cycle]
        return np.unique(np.concatenate([*corners, *begun])) if begun else corners[0]

    def jump_movers(self) -> tuple[str, ...]:
        """Entries that decide at which angle the torque jumps, if it does."""
        return ()

    @property
    def starts(self) -> tuple[float, ...]:
        """Angles at which the diagram of each cylinder begins [rad]."""
        return (0.0,)

    @staticmethod
    def _own(phi: Floats, start: float, cycle: float) -> Floats:
        return phi if start == 0 else np.mod(phi - start, cycle)

    @abstractmethod
    def one_at(self, phi: Floats, cycle: float) -> Floats:
        """Torque of one cylinder at its own angles within the cycle, shape (n,) [N m]."""

    def one_kinks(self, cycle: float) -> Floats:
        """Corners and jumps of one cylinder within its own cycle [rad]."""
        return np.empty(0)

    def cycle_faults(self, cycle: float) -> Iterator[InitErrorDetails]:
        """What does not fit a cycle of this length [rad]."""
        return iter(())


class ConstantShaftTorque(ShaftTorque):
    """The same torque at every angle."""

    kind: Literal["constant"]
    torque: Torque = Field(description="Torque.")

    def one_at(self, phi: Floats, cycle: float) -> Floats:
        return self.torque * np.ones(len(phi))


class CylinderTorque(ShaftTorque):
    """A torque over the angle that several equal cylinders, or strokes, give one after the other."""

    phases: Angles = Field(
        (),
        description="Start angles of the diagrams of several equal cylinders, whose torques add up. "
        "Default: one cylinder, at 0.",
    )

    @property
    def starts(self) -> tuple[float, ...]:
        return tuple(self.phases) or (0.0,)

    def jump_movers(self) -> tuple[str, ...]:
        return tuple(f"phases.{place}" for place in range(len(self.phases)))

    def cycle_faults(self, cycle: float) -> Iterator[InitErrorDetails]:
        for place, start in enumerate(self.phases):
            if not 0 <= start < cycle:
                found = f"{math.degrees(start):.6g} deg"
                expected = f"an angle from 0 to below the cycle of {math.degrees(cycle):.6g} deg"
                remedy = _LONGER
                yield fault("phases", place, found=found, expected=expected, remedy=remedy)


class FormulaShaftTorque(CylinderTorque):
    """A torque by a formula of the angle."""

    kind: Literal["formula"]
    torque: str = Field(description="Formula of the torque in N m; its variable is phi, the shaft angle.")
    constants: dict[str, Annotated[float, AnyQuantity()]] = Field(
        default_factory=dict, description="Constants of the formula by name, in any unit."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from constant_faults(self.constants, self.torque)
        yield from text_faults("torque", self.torque, self.constants, ("phi",))

    def jump_movers(self) -> tuple[str, ...]:
        deciding = conditions(parse(self.torque))
        return (*super().jump_movers(), *(f"constants.{name}" for name in self.constants if name in deciding))

    def one_at(self, phi: Floats, cycle: float) -> Floats:
        # Where a formula has no value the fit says so, with the angle.
        with np.errstate(all="ignore"):
            values = value(parse(self.torque), {**NUMBERS, **self.constants, "phi": phi})
        torques: Floats = values * np.ones(phi.shape)
        return torques


class TableShaftTorque(CylinderTorque):
    """A torque by points of a diagram: linear between them, or in steps."""

    kind: Literal["table"]
    file: str | None = Field(
        None,
        description="CSV file beside the machine file, instead of the lists, with units in the header: "
        '"angle [deg], torque [N m]".',
    )
    angle: Angles = Field((), description="Shaft angles, increasing, within one cycle.")
    torque: Torques = Field((), description="Torque at each angle.")
    between: Literal["linear", "steps"] = Field(
        "linear",
        description="Interpolation between two angles: linear, or constant at the torque of the first.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            yield unread_file(self.file)
            return
        yield from curve_faults(self, "angle", ("torque",))

    def cycle_faults(self, cycle: float) -> Iterator[InitErrorDetails]:
        yield from super().cycle_faults(cycle)
        span = self.angle[-1] - self.angle[0]
        if span > cycle * (1 + _ROUNDED):
            remedy = _LONGER
            found = f"{math.degrees(span):.6g} deg"
            yield fault("angle", found=found, expected="angles within one cycle", remedy=remedy)
        elif self._closes(cycle) and self.torque[0] != self.torque[-1] and self.between == "linear":
            expected = f"{self.torque[0]:.6g} N m, as at the first angle, one cycle before"
            yield fault("torque", len(self.torque) - 1, found=self.torque[-1], expected=expected)

    def _closes(self, cycle: float) -> bool:
        return self.angle[-1] - self.angle[0] >= cycle * (1 - _ROUNDED)

    def one_kinks(self, cycle: float) -> Floats:
        corners: Floats = np.mod(np.asarray(self.angle), cycle)
        return corners

    def one_at(self, phi: Floats, cycle: float) -> Floats:
        angle, torque = numbers(self.angle), numbers(self.torque)
        if self._closes(cycle):
            angle, torque = angle[:-1], torque[:-1]
        from_first = np.mod(phi - angle[0], cycle)
        if self.between == "steps":
            steps = np.searchsorted(np.asarray(angle - angle[0]), np.asarray(from_first), side="right")
            held: Floats = torque[steps - 1]
            return held
        straight: Floats = np.interp(from_first, angle - angle[0], torque, period=cycle)
        return straight


AnyShaftTorque = Annotated[
    ConstantShaftTorque | FormulaShaftTorque | TableShaftTorque, Field(discriminator="kind")
]


class FlywheelRim(CheckedDescription):
    """The rim of a flywheel, a thin ring: its radius, or the hoop stress that gives it."""

    density: Annotated[float, positive(DENSITY)] = Field(
        description="Density of the rim: 7200 kg/m^3 for cast iron, 7850 kg/m^3 for steel."
    )
    radius: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Mean radius of the rim; gives the hoop stress."
    )
    stress: Annotated[float, positive(PRESSURE)] | None = Field(
        None,
        description="Permissible hoop stress at the mean speed, instead of the radius; gives the radius.",
    )
    inertia_share: Annotated[float, Quantity(RATIO, FRACTION)] = Field(
        1.0,
        description="Share of the flywheel's moment of inertia in the rim; the rest is in arms and hub.",
    )
    width_ratio: Annotated[float, positive(RATIO)] | None = Field(
        None, description="Ratio of width to thickness of a rectangular cross-section; gives both."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.radius is None and self.stress is None:
            yield fault(expected="radius, or stress, from which the radius follows")
        if self.radius is not None and self.stress is not None:
            remedy = "leave one of the two out: each follows from the other at the given speed"
            yield fault(
                "stress", found=f"{self.stress:.6g} Pa", expected="nothing beside radius", remedy=remedy
            )


class TurningMoment(CheckedDescription):
    """Torques on a shaft over a cycle, and the speed fluctuation that a flywheel is to keep."""

    speed: Annotated[float, positive(SPEED)] = Field(
        description="Mean speed of the shaft, the mean of its extremes."
    )
    cycle: CycleAngle = Field(
        ONE_TURN,
        description="Shaft angle of one cycle: 360 deg, or 720 deg for a four-stroke engine; for a cycle "
        "given in time, its duration times the mean speed.",
    )
    driver: AnyShaftTorque | None = Field(
        None, description="Driving torque. Default: constant, the mean of the load."
    )
    load: AnyShaftTorque | None = Field(
        None, description="Load torque. Default: constant, the mean of the driver."
    )
    areas: Annotated[tuple[float, ...], QuantityList(COUNT)] = Field(
        (),
        description="Instead of driver and load: areas of the diagram between its crossings with the mean "
        "torque, in order; positive where the driving torque exceeds the load torque.",
    )
    area_scale: Annotated[float, positive(ENERGY)] = Field(1.0, description="Energy of one unit of area.")
    unevenness: Annotated[float, Quantity(RATIO, FRACTION)] | None = Field(
        None, description="Required coefficient of speed fluctuation δ; gives the flywheel."
    )
    inertia: Annotated[float, positive(INERTIA)] | None = Field(
        None, description="Moment of inertia of the shaft, without the flywheel to be sized."
    )
    radius_of_gyration: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Radius of gyration of the flywheel, for its mass."
    )
    rim: FlywheelRim | None = Field(
        None, description="Rim of the flywheel, for its hoop stress, mass and cross-section."
    )

    @property
    def turns(self) -> float:
        """Revolutions of a cycle."""
        turns = self.cycle / ONE_TURN
        return round(turns) if abs(turns - round(turns)) < _ROUNDED * turns else turns

    def _faults(self) -> Iterator[InitErrorDetails]:
        torques = {"driver": self.driver, "load": self.load}
        if self.areas:
            yield from self._area_faults()
        elif self.driver is None and self.load is None:
            yield fault("driver", expected="a table; or load, or areas")
        for key, torque in torques.items():
            if torque is None:
                continue
            for wrong in torque.cycle_faults(self.cycle):
                yield {**wrong, "loc": (key, torque.kind, *wrong["loc"])}
            if self.areas:
                yield fault(key, found="a table", expected="nothing beside areas")
        if self.radius_of_gyration is not None and self.unevenness is None:
            remedy = "give unevenness, or leave the radius out"
            found = f"{self.radius_of_gyration:.6g} m"
            yield fault(
                "radius_of_gyration", found=found, expected="nothing without unevenness", remedy=remedy
            )

    def _area_faults(self) -> Iterator[InitErrorDetails]:
        if len(self.areas) < 2:
            yield fault("areas", found="1 value", expected="at least 2 values")
        for place, area in enumerate(self.areas):
            if area == 0:
                yield fault("areas", place, found=area, expected="an area above or below the mean, not 0")
