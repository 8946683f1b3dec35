"""The permitted stress of the shaft: where its stress counts, and what is permitted there.

| kind | vibratory stress permitted |
| --- | --- |
| `given` | as given |
| `iacs_m68` | propulsion shafts of ships: IACS UR M68 (`permitted_stress`) |
| `kr_crankshaft` | crankshafts of main engines: Korean Register (`permitted_stress`) |

Torques and the maximum stress, mean and vibration together, may be limited with each kind.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import CheckedDescription, fault, formerly
from linkwright.kernel.units.kinds import PRESSURE, RATIO, SECTION_MODULUS
from linkwright.kernel.units.marks import FRACTION, Quantity, positive
from linkwright.linkages.model.element import PositiveLength
from linkwright.torsion.model import permitted_stress
from linkwright.torsion.model.permitted_stress import (
    DESIGN_FACTORS,
    STRENGTH_COUNTED,
    STRENGTH_MIN,
    Design,
    Firing,
    Steel,
    crank_stress,
    crank_transient_stress,
)
from linkwright.torsion.model.shaft_flexibility import polar_moment
from linkwright.torsion.model.shaft_section import Bore, ShaftSection
from linkwright.torsion.model.train_base import PositiveTorque

Stress = Annotated[float, positive(PRESSURE)]
Kind = Literal["given", "iacs_m68", "kr_crankshaft"]

RULES: dict[Kind, str] = {"given": "given", "iacs_m68": "IACS UR M68", "kr_crankshaft": "Korean Register"}

# Keys of one kind or of several; all others may stand with each kind.
_KINDS: dict[str, tuple[Kind, ...]] = {
    "stress_permitted": ("given",),
    "stress_transient": ("given",),
    "stress_concentration": ("given",),
    "tensile_strength": ("iacs_m68", "kr_crankshaft"),
    "yield_strength": ("kr_crankshaft",),
    "steel": ("iacs_m68", "kr_crankshaft"),
    "design": ("iacs_m68",),
    "design_factor": ("iacs_m68",),
    "firing": ("kr_crankshaft",),
}
_STRESSES = ("stress_permitted", "stress_transient", "stress_max")


class StressedSection(NamedTuple):
    """Where the stress of a shaft counts."""

    section_modulus: float  # torque per nominal shear stress [m³]
    diameter: float | None  # outside [m]


class ShaftLimit(CheckedDescription):
    """The permitted stress of the shaft."""

    kind: Kind = Field(
        "given",
        description="Source of the permitted vibratory stress: given (by the maker or by another rule "
        "such as DNV, LR, ABS), IACS UR M68, or Korean Register.",
    )
    diameter: PositiveLength | None = Field(
        None, description="Outer diameter to which the stress refers. Default: that of the weakest section."
    )
    inner_diameter: Bore = Field(0.0, description="Diameter of the bore there.")
    section_modulus: Annotated[float, positive(SECTION_MODULUS)] | None = Field(
        None, description="Torsional section modulus there, instead of the diameter."
    )
    stress_concentration: Annotated[float, positive(RATIO)] | None = Field(
        None,
        description="Stress concentration factor: maximum over nominal stress; permitted stresses "
        "refer to the maximum. Default: 1.",
    )
    stress_permitted: Stress | None = Field(
        None, description="Amplitude of the shear stress in continuous operation."
    )
    stress_transient: Stress | None = Field(
        None, description="Amplitude of the shear stress in transient passage of barred speed ranges."
    )
    stress_max: Stress | None = Field(
        None,
        validation_alias=formerly("stress_greatest", "stress_max"),
        description="Maximum shear stress, mean and vibratory.",
    )
    torque_permitted: PositiveTorque | None = Field(
        None, description="Permitted sum of mean and vibratory torque."
    )
    vibratory_torque_permitted: PositiveTorque | None = Field(
        None, description="Amplitude of the torque in continuous operation."
    )
    tensile_strength: Stress | None = Field(None, description="Specified tensile strength σ_B of the steel.")
    yield_strength: Stress | None = Field(
        None, description="Yield strength σ_Y of the steel of a crankshaft."
    )
    steel: Steel | None = Field(
        None, description='Kind of steel; "carbon" includes carbon-manganese steel. Default: carbon.'
    )
    design: Design | None = Field(None, description="Design feature of the shaft, for C_K. Default: flanges.")
    design_factor: Annotated[float, Quantity(RATIO, FRACTION)] | None = Field(
        None, description="Design factor C_K, instead of the design."
    )
    firing: Firing | None = Field(
        None,
        description='Firing sequence: "even" for in-line four-stroke engines and V engines that fire '
        "every 45° or 60°. Default: other.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from self._key_faults()
        yield from self._section_faults()
        if self.kind == "iacs_m68" and self.tensile_strength is None:
            yield fault("tensile_strength", expected="the tensile strength of the steel, for IACS UR M68")
        if self.tensile_strength is not None and self.tensile_strength < STRENGTH_MIN:
            expected = "at least 400 MPa, the minimum for which the rules are made"
            yield fault("tensile_strength", found=self.tensile_strength, expected=expected)
        if self.design is not None and self.design_factor is not None:
            yield fault("design_factor", found=self.design_factor, expected="either design or design_factor")
        low, high = self.stress_permitted, self.stress_transient
        if high is not None and (low is None or high < low):
            expected = (
                "stress_permitted beside it" if low is None else f"at least stress_permitted, {low:.6g} Pa"
            )
            yield fault("stress_transient", found=high, expected=expected)

    def _key_faults(self) -> Iterator[InitErrorDetails]:
        for key, kinds in _KINDS.items():
            value = getattr(self, key)
            if value is not None and self.kind not in kinds:
                expected = f'no such entry for the kind "{self.kind}"'
                yield fault(key, found=value, expected=expected, remedy=f"it belongs to: {', '.join(kinds)}")

    def _section_faults(self) -> Iterator[InitErrorDetails]:
        d, bore = self.diameter, self.inner_diameter
        if d is None and bore:
            yield fault("diameter", expected="the diameter outside, beside that of the bore")
        elif d is not None and bore >= d:
            yield fault("inner_diameter", found=bore, expected=f"a bore smaller than the diameter, {d:.6g} m")
        if self.section_modulus is not None and d is not None:
            yield fault("section_modulus", found=self.section_modulus, expected="either it or the diameter")
        if self.section_modulus is not None and self.kind == "iacs_m68":
            expected = "the diameter, which IACS UR M68 asks for"
            yield fault("section_modulus", found=self.section_modulus, expected=expected)
        if self.stress_concentration is not None and self.stress_concentration < 1:
            yield fault("stress_concentration", found=self.stress_concentration, expected="1 or more")

    @property
    def needs_section(self) -> bool:
        """Whether a section must be known: a stress is limited."""
        return self.kind != "given" or any(getattr(self, key) is not None for key in _STRESSES)

    @property
    def has_section(self) -> bool:
        """Whether it gives a section itself."""
        return self.diameter is not None or self.section_modulus is not None

    @property
    def concentration(self) -> float:
        """Maximum over nominal stress."""
        return 1.0 if self.stress_concentration is None else self.stress_concentration

    @property
    def shape_factor(self) -> float:
        """C_K."""
        return DESIGN_FACTORS[self.design or "flange"] if self.design_factor is None else self.design_factor

    @property
    def counted_strength(self) -> float | None:
        """Tensile strength as far as the rule counts it [Pa]."""
        if self.tensile_strength is None:
            return None
        steel = self.steel or "carbon"
        if self.kind == "kr_crankshaft":
            return min(self.tensile_strength, STRENGTH_COUNTED[steel])
        return permitted_stress.counted_strength(self.tensile_strength, steel, self.design or "flange")

    @property
    def barred_ratio_max(self) -> float:
        """Highest λ that speeds may be barred at in normal operation; infinite without a rule."""
        return math.inf if self.kind == "given" else permitted_stress.RATIO_BARRED_MAX

    def permitted_stress(self, speed_ratio: Floats, diameter: float | None) -> tuple[Floats, Floats]:
        """Permitted amplitudes of the vibratory stress in continuous operation and in transient passage.

        Gives `continuous`, `transient`: (n,) [Pa]; NaN where nothing is said. `speed_ratio`: (n,) λ, speed
        over that of service; `diameter`: Outside, where the stress counts [m].
        """
        if self.kind == "iacs_m68":
            assert self.counted_strength is not None
            assert diameter is not None
            C_K = self.shape_factor
            continuous = permitted_stress.continuous_stress(self.counted_strength, diameter, C_K, speed_ratio)
            return continuous, permitted_stress.transient_stress(continuous, C_K)
        if self.kind == "kr_crankshaft":
            firing = self.firing or "other"
            continuous = crank_stress(speed_ratio, firing, self.counted_strength)
            passing = crank_transient_stress(speed_ratio, firing, self.yield_strength)
            # Where speeds may not be barred, passing permits no more.
            return continuous, np.where(np.isnan(passing), continuous, np.maximum(passing, continuous))
        low, high = (
            np.nan if stress is None else stress for stress in (self.stress_permitted, self.stress_transient)
        )
        return np.full_like(speed_ratio, low), np.full_like(speed_ratio, high)

    def severity(self, section: StressedSection) -> float:
        """Stress over permitted stress, but for a factor, at a section."""
        size = 1.0
        if self.kind == "iacs_m68" and section.diameter is not None:
            size = permitted_stress.size_factor(section.diameter)
        return 1.0 / (section.section_modulus * size)

    def section(self, sections: Sequence[ShaftSection] | None) -> StressedSection | None:
        """Where the stress counts: given, else nearest to its limit; None if no section is known."""
        if self.section_modulus is not None:
            return StressedSection(self.section_modulus, None)
        if self.diameter is not None:
            modulus = polar_moment(self.diameter, self.inner_diameter) / (self.diameter / 2)
            return StressedSection(modulus, self.diameter)
        known = [
            StressedSection(section.section_modulus, min(section.diameters)) for section in sections or ()
        ]
        return max(known, key=self.severity, default=None)
