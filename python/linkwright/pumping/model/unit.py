r"""Beam pumping units, described by the letters of API Spec 11E, and the mechanism that such a unit is.

| letter | is |
| --- | --- |
| `A` | front arm: saddle bearing to the polished rod, the radius of the horsehead |
| `C` | arm of the pitman: saddle bearing to the equalizer bearing |
| `I` | horizontal distance of the saddle bearing from the crankshaft |
| `H`, `G` | heights of the saddle bearing and of the crankshaft above the base |
| `P` | pitman: equalizer bearing to crank pin |
| `R` | crank: crankshaft to crank pin |
| `K` | crankshaft to saddle bearing, :math:`K^2 = I^2 + (H - G)^2` (in place of H and G) |

A conventional unit is a lever of class I: the pitman pulls behind the saddle bearing, and the shaft lies
behind it. Mark II and air-balanced units are levers of class III: the pitman pushes between saddle and
horsehead, and the shaft lies in front of the saddle.

The crank angle is that of API: from 12 o'clock for class I, from 6 o'clock for class III, in the direction of
rotation. Linkwright turns counter-clockwise, so a unit that turns clockwise, seen with the well to the
right, is drawn from its other side, with the well to the left.

Expressions are written with NumPy: an entry may be an array over many units.

References
----------
.. [1] API Spec 11E, Specification for Pumping Units, 17th ed. 1994 (ISO 10431): annexes on torque factors of
units
   with rear-mounted geometry (class I) and front-mounted geometry (class III).
.. [2] Takács, Sucker-Rod Pumping Handbook, 2015, 3.7: kinematics by API, rotation and zero of the three
kinds.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Any, Literal, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import Description, Whole, fault, raise_faults
from linkwright.kernel.description.curve import unread_file
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.marks import Force, Length, not_negative
from linkwright.linkages.model.element import PositiveLength
from linkwright.pumping.model.polished_rod_load import PolishedRodLoad

# Names of the parts that a unit expands into.
CRANKSHAFT, SADDLE, CRANK, BEAM, ROD = "crankshaft", "saddle", "crank", "beam", "polished_rod"
BEAM_LINK = f"{BEAM}.rocker"

Geometry = Literal["conventional", "mark_ii", "air_balanced"]
Rotation = Literal["clockwise", "counter_clockwise"]

# Direction of rotation in API's tables, seen with the well to the right.
_USUAL: dict[str, Rotation] = {
    "conventional": "clockwise",
    "mark_ii": "counter_clockwise",
    "air_balanced": "clockwise",
}


class PumpingUnit(Description):
    """A beam pumping unit by the letters of API Spec 11E."""

    geometry: Geometry = Field("conventional", description="Kind of unit.")
    designation: str | None = Field(
        None,
        description="API designation, such as C-114D-133-54: gearbox rating in 1000 lbf in, structure "
        "rating in 100 lbf, stroke in inches.",
    )
    file: str | None = Field(
        None,
        description='CSV file of units beside the machine file, with units in the header: "type, A [in], '
        'C [in], I [in], K [in], P [in], R [in]".',
    )
    catalogue: str | None = Field(None, description="Type of the unit in the file.")
    hole: Annotated[Whole, Field(ge=1)] | None = Field(
        None, description="Crank hole of the type, 1 the outermost."
    )
    A: PositiveLength = Field(description="Saddle bearing to polished rod.")
    C: PositiveLength = Field(description="Saddle bearing to equalizer bearing.")
    I: Length = Field(  # noqa: E741
        description="Horizontal distance from saddle bearing to crankshaft."
    )
    P: PositiveLength = Field(description="Pitman.")
    H: Length | None = Field(None, description="Saddle bearing above the base.")
    G: Length | None = Field(None, description="Crankshaft above the base.")
    K: PositiveLength | None = Field(
        None, description="Crankshaft to saddle bearing, in place of H and G; the saddle bearing is above."
    )
    R: PositiveLength = Field(description="Crank.")
    rotation: Rotation | None = Field(
        None,
        description="Sense of rotation with the well to the right. Default: clockwise; Mark II: "
        "counter-clockwise.",
    )
    structural_unbalance: Force = Field(
        0.0,
        description="Force at the polished rod that holds the beam horizontal with the pitmans disconnected.",
    )
    cable: Annotated[float, not_negative(LENGTH)] = Field(
        1.0,
        description="Free length of the cable from the horsehead to the hanger, at the top of the stroke.",
    )
    load: PolishedRodLoad | None = Field(None, description="Load on the polished rod.")

    @model_validator(mode="after")
    def _entries_fit(self) -> Self:
        raise_faults("PumpingUnit", self._faults())
        return self

    def _faults(self) -> Iterator[InitErrorDetails]:
        load, is_air = self.load, self.geometry == "air_balanced"
        if self.file is not None:
            yield unread_file(self.file)
        for key in ("catalogue", "hole"):
            if getattr(self, key) is not None:
                yield fault(key, found=getattr(self, key), expected="nothing without file")
        yield from self._place_faults()
        if load is None:
            return
        if is_air and isinstance(load.counterbalance, float):
            remedy = "an air-balanced unit has no counterweights: write counterbalance_effect"
            yield fault(
                "load", "counterbalance", found=load.counterbalance, expected="no moment", remedy=remedy
            )
        if not is_air and load.counterbalance_effect is not None:
            remedy = "only air-balanced units have a cylinder: write counterbalance"
            found = load.counterbalance_effect
            yield fault("load", "counterbalance_effect", found=found, expected="nothing", remedy=remedy)

    def _place_faults(self) -> Iterator[InitErrorDetails]:
        """The saddle bearing is placed by H and G, or by K."""
        if self.K is not None:
            for key in ("H", "G"):
                if getattr(self, key) is not None:
                    yield fault(key, found=getattr(self, key), expected="nothing beside K")
            if abs(self.I) > self.K:
                yield fault("K", found=self.K, expected=f"at least I, {abs(self.I):.6g} m")
            return
        missing = [key for key in ("H", "G") if getattr(self, key) is None]
        for key in missing:
            yield fault(key, expected="a length; H and G are given together, or K in their place")
        if not missing and self.H == self.G and self.I == 0:
            yield fault("H", found=self.H, expected="a saddle bearing away from the crankshaft")

    @property
    def is_class_3(self) -> bool:
        """Whether the pitman pushes between saddle and horsehead."""
        return self.geometry != "conventional"

    @property
    def is_mirrored(self) -> bool:
        """Whether it is drawn from its other side, with the well to the left, because it turns clockwise."""
        return (self.rotation or _USUAL[self.geometry]) == "clockwise"

    @property
    def rise(self) -> Any:
        """Saddle bearing above the crankshaft [m]."""
        if self.K is not None:
            return np.sqrt((self.K - self.I) * (self.K + self.I))
        assert self.H is not None
        assert self.G is not None
        return self.H - self.G

    @property
    def distance(self) -> Any:
        """Crankshaft to saddle bearing [m]."""
        return np.hypot(self.I, self.rise) if self.K is None else self.K

    @property
    def saddle(self) -> tuple[Any, Any]:
        """Place of the saddle bearing from the crankshaft, as drawn [m]."""
        toward_well = -self.I if self.is_class_3 else self.I
        return (-toward_well if self.is_mirrored else toward_well), self.rise

    @property
    def crank_phase(self) -> float:
        """Direction of the crank at crank angle zero: 12 o'clock, or 6 o'clock for class III [rad]."""
        return -np.pi / 2 if self.is_class_3 else np.pi / 2

    def psi(self, reach: Any) -> Any:
        """Angle ψ between C and K with equalizer bearing and crankshaft a distance apart [rad]."""
        # A unit that does not close is reported by the analyses; it still has a place on paper.
        return np.arccos(np.clip(self._cosine(reach), -1.0, 1.0))

    @property
    def reaches_ends(self) -> Any:
        """Whether crank and pitman come into line at both ends of the stroke."""
        return (np.abs(self._cosine(self.P + self.R)) <= 1) & (np.abs(self._cosine(self.P - self.R)) <= 1)

    def _cosine(self, reach: Any) -> Any:
        """Cosine of ψ by the sides of its triangle, beyond ±1 where they do not meet."""
        return (self.C**2 + self.distance**2 - reach**2) / (2 * self.C * self.distance)

    @property
    def psi_bottom(self) -> Any:
        """ψ at the bottom of the stroke: crank and pitman in line [rad]."""
        return self.psi(self.P - self.R if self.is_class_3 else self.P + self.R)

    @property
    def psi_top(self) -> Any:
        """ψ at the top of the stroke [rad]."""
        return self.psi(self.P + self.R if self.is_class_3 else self.P - self.R)

    @property
    def stroke(self) -> Any:
        """Stroke of the polished rod, exact [m]."""
        return self.A * np.abs(self.psi_bottom - self.psi_top)

    @property
    def is_left(self) -> bool:
        """Whether the equalizer bearing lies to the left, as drawn, seen from the crank pin to the saddle."""
        return self.is_class_3 == self.is_mirrored

    def turned_arm(self, psi: Any) -> Any:
        """`arm_angle` counted on from the angle that the arm has at crank angle zero [rad]."""
        x, y = self.saddle
        pin = (-x, -self.R - y) if self.is_class_3 else (-x, self.R - y)
        J = np.hypot(*pin)
        chi = np.arccos(np.clip((self.C**2 + J**2 - self.P**2) / (2 * self.C * J), -1.0, 1.0))
        start = np.arctan2(pin[1], pin[0]) + (-chi if self.is_left else chi)
        start, turn = np.arctan2(np.sin(start), np.cos(start)), self.arm_angle(psi) - start
        return start + np.arctan2(np.sin(turn), np.cos(turn))

    def arm_angle(self, psi: Any) -> Any:
        """Direction of the arm C as drawn, from −π to π [rad], for an angle ψ [rad]."""
        toward_shaft = np.arctan2(-self.rise, self.I if self.is_class_3 else -self.I)
        angle = toward_shaft + (psi if self.is_class_3 else -psi)
        angle = np.pi - angle if self.is_mirrored else angle
        return np.arctan2(np.sin(angle), np.cos(angle))

    def front_angle(self, psi: Any) -> Any:
        """Angle of the front arm above the horizontal, up positive [rad], for an angle ψ [rad]."""
        toward_shaft = np.arctan2(-self.rise, self.I if self.is_class_3 else -self.I)
        angle = toward_shaft + (psi if self.is_class_3 else np.pi - psi)
        return np.arctan2(np.sin(angle), np.cos(angle))

    @property
    def rating(self) -> Rating | None:
        """What the designation says; None if it is none of API."""
        return rating_of(self.designation) if self.designation else None


class Rating(NamedTuple):
    """What the designation of a unit says."""

    torque: float  # peak torque of the gearbox [N m]
    load: float  # maximum load of the polished rod [N]
    stroke: float  # longest nominal stroke [m]


# Type, gear rating with D for double reduction, load, stroke; makers put further letters before the numbers.
_DESIGNATION = re.compile(r"\s*([A-Z]{1,3})-?([A-Z]?)(\d+)([A-Z]{0,2})-(\d+)-(\d+)\s*", re.IGNORECASE)

INCH = 0.0254
POUND_FORCE = 4.4482216152605


def rating_of(designation: str) -> Rating | None:
    """The rating [SI] of a designation of API Spec 11E such as ``"C-114D-133-54"``; None if it has another
    form.

    >>> round(rating_of("C-114D-133-54").stroke, 4)
    1.3716
    """
    match = _DESIGNATION.fullmatch(designation)
    if match is None:
        return None
    torque, load, stroke = (float(match[n]) for n in (3, 5, 6))
    return Rating(1e3 * torque * POUND_FORCE * INCH, 1e2 * load * POUND_FORCE, stroke * INCH)
