r"""Blades of a propeller that meet ice: half-sine pulses of torque over its angle, by rules of ice classes.

.. math:: Q(\varphi) = C_q Q_\mathrm{max} \sin\frac{\pi\varphi}{\alpha_i}, \quad 0 \le \varphi \le \alpha_i

for each blade and each block of ice, and zero in the rest of the revolution. The largest ice torque on a
propeller, in kN m with D in m and n in revolutions per second, is

.. math:: Q_\mathrm{max} = k \left(1 - \tfrac dD\right) \left(\tfrac{P_{0.7}}D\right)^{0.16} (nD)^{0.17} D^3
    \quad\text{for } D < D_\mathrm{limit} = 1.8\,H_\mathrm{ice}

and above that diameter with :math:`1.9\,H_\mathrm{ice}^{1.1} D^{1.9}` in place of :math:`D^3`.

The numbers of the rules have not been compared with a printed edition; all of them can be given instead.

References
----------
.. [1] IACS, UR I3 Machinery Requirements for Polar Class Ships, Rev. 2, 2023.
.. [2] Finnish Transport and Communications Agency, Ice Class Regulations, 2021, chapter 6.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Whole, fault
from linkwright.kernel.units.kinds import ANGLE, LENGTH, RATIO, TIME
from linkwright.kernel.units.marks import not_negative, positive
from linkwright.torsion.model.train_base import PositiveSpeed, PositiveTorque

PositiveLength = Annotated[float, positive(LENGTH)]

IceClass = Literal["PC1", "PC2", "PC3", "PC4", "PC5", "PC6", "PC7", "IA_super", "IA", "IB", "IC"]

# Thickness of the design ice of each class [m]: I3 table of design ice; the last four those of the Baltic.
_THICKNESS: dict[IceClass, float] = {
    "PC1": 4.0,
    "PC2": 3.5,
    "PC3": 3.0,
    "PC4": 2.5,
    "PC5": 2.0,
    "PC6": 1.75,
    "PC7": 1.5,
    "IA_super": 1.75,
    "IA": 1.5,
    "IB": 1.2,
    "IC": 1.0,
}

# Classes of strong ice, and k of open and of ducted propellers in them and in the others.
_STRONG = ("PC1", "PC2", "PC3", "PC4", "PC5")
_STRONG_ICE, _OTHER_ICE = (14.7, 10.4), (10.9, 7.7)

# Diameter over the thickness of the ice from which on the ice no longer covers the blade.
_LIMIT = 1.8

# Revolutions of a milling sequence per metre of ice.
_REVOLUTIONS = 2.0

# Shortest pulse [rad]: of a shorter one the table of the torque over the angle has few samples, or none.
_SHORTEST = math.radians(5.0) * (1 - 1e-9)

# Bounds of pitch over diameter within which propellers are built, with room on either side.
_SLOW, _STEEP = 0.2, 3.0


class IcePulse(NamedTuple):
    """The pulse of one blade."""

    amplitude: float  # C_q, of the largest ice torque
    duration: float  # α_i [rad]
    blocks: int  # of ice, each met by every blade in a revolution


# C_q, blocks, and α_i in degrees for 3, 4, 5 and 6 blades.
_CASES: dict[int, tuple[float, int, tuple[float, ...]]] = {
    1: (0.75, 1, (90.0, 90.0, 72.0, 60.0)),
    2: (1.0, 1, (135.0, 135.0, 135.0, 135.0)),
    3: (0.5, 2, (45.0, 45.0, 36.0, 30.0)),
    4: (0.5, 1, (45.0, 45.0, 36.0, 30.0)),
}
_BLADES = (3, 4, 5, 6)


class IcePropeller(CheckedDescription):
    """A propeller of which the ice class gives the largest ice torque."""

    ice_class: IceClass = Field(description="Polar class of IACS, or ice class of the Baltic.")
    diameter: PositiveLength = Field(description="Diameter D of the propeller.")
    hub_diameter: PositiveLength = Field(description="Diameter d of the hub.")
    pitch: PositiveLength = Field(description="Pitch P_0.7 at 0.7 of the radius, in the bollard condition.")
    speed: PositiveSpeed = Field(
        description="Speed in the bollard condition: the rated speed; for a fixed-pitch propeller driven "
        "by a diesel engine 0.85 of it, unless known."
    )
    ducted: bool = Field(False, description="Ducted propeller.")
    ice_thickness: PositiveLength | None = Field(
        None, description="Thickness H_ice of the design ice. Default: that of the ice class."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.hub_diameter >= self.diameter:
            expected = f"less than diameter, {self.diameter:.6g} m"
            yield fault("hub_diameter", found=self.hub_diameter, expected=expected)
        if not _SLOW <= self.pitch / self.diameter <= _STEEP:
            low, high = _SLOW * self.diameter, _STEEP * self.diameter
            yield fault("pitch", found=self.pitch, expected=f"{low:.4g} m to {high:.4g} m, a length")

    @property
    def thickness(self) -> float:
        """H_ice [m]."""
        return _THICKNESS[self.ice_class] if self.ice_thickness is None else self.ice_thickness

    @property
    def revolutions(self) -> float:
        """Of a milling sequence."""
        return _REVOLUTIONS * self.thickness

    @property
    def torque(self) -> float:
        """Largest ice torque Q_max [N m]."""
        D, H = self.diameter, self.thickness
        k = (_STRONG_ICE if self.ice_class in _STRONG else _OTHER_ICE)[int(self.ducted)]
        depth = D**3 if _LIMIT * H > D else 1.9 * H**1.1 * D**1.9
        turning = (self.speed / (2 * math.pi) * D) ** 0.17
        torque: float = 1e3 * k * (1 - self.hub_diameter / D) * (self.pitch / D) ** 0.16 * turning * depth
        return torque


class IceImpacts(CheckedDescription):
    """Half-sine pulses of torque over the angle of a propeller whose blades meet ice."""

    kind: Literal["ice_impacts"]
    time: Annotated[float, not_negative(TIME)] = Field(description="Time at which the first blade meets ice.")
    on: str = Field(description="Disc of the propeller.")
    blades: Whole = Field(ge=1, le=12, description="Number Z of propeller blades.")
    torque: PositiveTorque | None = Field(
        None, description="Maximum ice torque Q_max, instead of `propeller`."
    )
    propeller: IcePropeller | None = Field(
        None, description="Data of the propeller, from which the ice class gives Q_max."
    )
    case: Literal[1, 2, 3, 4] | None = Field(
        None, description="Excitation case of the rules, instead of amplitude and duration."
    )
    amplitude: Annotated[float, positive(RATIO)] | None = Field(
        None, description="C_q: peak of a pulse over Q_max."
    )
    duration: Annotated[float, positive(ANGLE)] | None = Field(
        None, description="Duration α_i of a pulse, as angle of the propeller."
    )
    blocks: Whole = Field(
        1, ge=1, le=6, description="Number of ice blocks that each blade meets per revolution, evenly spaced."
    )
    impacts: Whole | None = Field(
        None,
        ge=1,
        description="Number of blade impacts on each block. Default: by the rules, Z impacts in each of 2 "
        "H_ice/m revolutions.",
    )
    ramp: Annotated[float, not_negative(ANGLE)] = Field(
        1.5 * math.pi,
        description="Angle of the propeller over which the pulses build up at the beginning and decay at "
        "the end.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (self.torque is None) == (self.propeller is None):
            found = "neither" if self.torque is None else "both"
            yield fault(found=found, expected="either torque or propeller")
        own = [name for name in ("amplitude", "duration") if getattr(self, name) is not None]
        if self.case is not None and (own or self.blocks != 1):
            yield fault(own[0] if own else "blocks", expected="none beside case, which says it")
        if self.case is None and len(own) < 2:
            yield fault(found=own or "neither", expected="either case, or amplitude and duration")
        if self.case is not None and self.blades not in _BLADES:
            remedy = "give amplitude and duration"
            yield fault(
                "blades", found=self.blades, expected="3 to 6, for which the case holds", remedy=remedy
            )
        if self.duration is not None and not _SHORTEST <= self.duration <= 2 * math.pi:
            found = f"{math.degrees(self.duration):.6g} deg"
            yield fault("duration", found=found, expected="5 deg to a revolution, 360 deg")
        if self.impacts is None and self.propeller is None:
            yield fault("impacts", expected="their number, as no ice class gives it")

    @property
    def largest_torque(self) -> float:
        """Q_max [N m]."""
        if self.propeller is not None:
            return self.propeller.torque
        assert self.torque is not None
        return self.torque

    @property
    def pulse(self) -> IcePulse:
        """Of one blade."""
        if self.case is None:
            assert self.amplitude is not None
            assert self.duration is not None
            return IcePulse(self.amplitude, self.duration, self.blocks)
        amplitude, blocks, durations = _CASES[self.case]
        return IcePulse(amplitude, math.radians(durations[_BLADES.index(self.blades)]), blocks)

    @property
    def count(self) -> int:
        """Impacts of blades on each block."""
        if self.impacts is not None:
            return self.impacts
        assert self.propeller is not None
        # Half an impact counts as one, in every number of blades.
        return max(math.floor(self.blades * self.propeller.revolutions + 0.5), 1)

    @property
    def begins(self) -> list[float]:
        """Angle of the propeller at which each pulse begins, from the first [rad]."""
        pitch, blocks = 2 * math.pi / self.blades, self.pulse.blocks
        return [pitch * (n + m / blocks) for n in range(self.count) for m in range(blocks)]

    @property
    def length(self) -> float:
        """Angle of the propeller from the beginning of the first pulse to the end of the last [rad]."""
        return self.begins[-1] + self.pulse.duration
