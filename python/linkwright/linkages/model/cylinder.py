"""Hydraulic cylinders between two points of any links: drivers by length or flow, or forces.

A cylinder has a barrel, which turns about the trunnion `start`, and a rod, which ends in the eye `end`. One
with a `start_length` is a driver: its length L(φ) follows a formula, or the oil that flows into its chambers,

.. math:: \\dot L = Q/A, \\qquad A = \\pi D^2/4 \\ (Q > 0), \\quad A = \\pi (D^2 - d^2)/4 \\ (Q < 0)

with the bore D and the rod's diameter d (the law of the flow: `cam/model/flow_law.py`). Any other acts with a
force (`kinetostatics/model/cylinder_loads.py`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated, Any

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.numerics.tangent import primal, total
from linkwright.kernel.units.kinds import DAMPING, FORCE, LENGTH, PRESSURE, STIFFNESS, TIME
from linkwright.kernel.units.marks import Angles, Flows, Force, Times, not_negative, positive
from linkwright.linkages.model.element import Constants, PositiveLength, law_faults

# Share of the volume moved by which a cycle of flow may stay open: what the digits of a file leave.
_CLOSES = 1e-6

# Entries that say how a driver moves; how a cylinder without start_length acts.
_MOVES, _ACTS = ("law", "flow"), ("pressure", "pressure_rod", "stiffness", "damping")


class Cylinder(CheckedDescription):
    """A hydraulic cylinder between two points: a driver, or a force."""

    start: str = Field(description="Point at the trunnion, about which the barrel turns.")
    end: str = Field(description="Point at the rod eye.")
    start_length: PositiveLength | None = Field(
        None,
        description="Distance of the two points at crank angle zero. With it the cylinder is a driver; its "
        "motion is given by law or flow.",
    )
    law: str | None = Field(None, description="Extension from `start_length` in m as a formula in phi.")
    constants: Constants = Field(
        default_factory=dict, description="Constants of the law by name, in any unit."
    )
    flow: Flows | None = Field(
        None,
        description="Flow of the pump over the cycle, straight between these values: into the bore side "
        "(extension), negative into the rod side (retraction).",
    )
    flow_time: Times | None = Field(
        None, description="Time of each flow, from 0 to the cycle time, which is one revolution."
    )
    flow_angle: Angles | None = Field(
        None, description="Crank angle of each flow instead, from 0 to 360°; needs `cycle_time`."
    )
    cycle_time: Annotated[float, positive(TIME)] | None = Field(
        None, description="Time of one revolution, for `flow_angle`."
    )
    bore: PositiveLength | None = Field(None, description="Diameter of the bore.")
    rod: Annotated[float, not_negative(LENGTH)] = Field(
        0.0, description="Diameter of the rod; 0 for equal areas on both sides."
    )
    length_min: PositiveLength | None = Field(None, description="Length when fully retracted.")
    length_max: PositiveLength | None = Field(None, description="Length when fully extended.")
    pressure: Annotated[float, not_negative(PRESSURE)] | None = Field(
        None, description="Gauge pressure on the bore side; the cylinder is then a force, not a driver."
    )
    pressure_rod: Annotated[float, not_negative(PRESSURE)] | None = Field(
        None, description="Gauge pressure on the rod side of such a cylinder."
    )
    back_pressure: Annotated[float, not_negative(PRESSURE)] = Field(
        0.0, description="Gauge pressure in the chamber that is open to the tank, of a driver."
    )
    friction: Annotated[float, not_negative(FORCE)] = Field(
        0.0, description="Friction of the seals, against the motion of the rod in the barrel."
    )
    stiffness: Annotated[float, not_negative(STIFFNESS)] | None = Field(
        None, description="Spring rate of a passive cylinder: force per extension."
    )
    free_length: Annotated[float, not_negative(LENGTH)] | None = Field(
        None, description="Length at which the spring is free."
    )
    preload: Force = Field(0.0, description="Tension of the spring at its free length.")
    damping: Annotated[float, not_negative(DAMPING)] | None = Field(
        None, description="Damping coefficient of a passive cylinder: force per velocity."
    )
    barrel_length: PositiveLength | None = Field(
        None, description="Length of the barrel from the trunnion, for its mass and the drawing."
    )
    rod_length: PositiveLength | None = Field(
        None, description="Length of the rod from its eye, for its mass and the drawing."
    )

    @property
    def advance(self) -> None:
        """By how much its law adds up per cycle: it returns."""
        return None

    @property
    def drives(self) -> bool:
        """Whether its length is given, so that it is a driver."""
        return self.start_length is not None

    @property
    def areas(self) -> tuple[Any, Any] | None:
        """Areas of the bore side and of the rod side [m²]; None without a bore."""
        if self.bore is None:
            return None
        quarter = math.pi / 4
        return quarter * self.bore**2, quarter * (self.bore**2 - self.rod**2)

    @property
    def cycle(self) -> Any:
        """Time of one revolution by the flow [s]; None where nothing says it."""
        return self.flow_time[-1] if self.flow_time is not None else self.cycle_time

    def follows(self) -> Any:
        """What its extension follows over the cycle, if it is not a formula."""
        return None

    def stretches(self) -> Iterator[tuple[Any, Any, Any]]:
        """Length as a share of the cycle, and both flows, of each stretch without a change of direction."""
        assert self.flow is not None
        for (low, high), (q, r) in zip(pairwise(self._shares()), pairwise(self.flow), strict=True):
            if primal(q) * primal(r) < 0:
                zero = q / (q - r)
                yield (high - low) * zero, q, 0.0 * q
                yield (high - low) * (1.0 - zero), 0.0 * r, r
            else:
                yield high - low, q, r

    def _shares(self) -> tuple[Any, ...]:
        """Place of each flow in the cycle, from 0 to 1."""
        places = self.flow_angle if self.flow_time is None else self.flow_time
        assert places is not None
        return tuple(place / places[-1] for place in places)

    def travels(self) -> tuple[Any, Any]:
        """Extension by all flow into the bore side, and retraction by all into the rod side [m]."""
        assert self.areas is not None
        moved = [0.5 * (q + r) * length * self.cycle for length, q, r in self.stretches()]
        out, back = ([m for m in moved if (primal(m) > 0) == is_out] for is_out in (True, False))
        return total(out) / self.areas[0], -total(back) / self.areas[1]

    # -- what is wrong -----------------------------------------------------------------------------------

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.start == self.end:
            yield fault("end", found=self.end, expected="another point than the start")
        yield from law_faults(self.law, self.constants, None, LENGTH)
        if self.bore is not None and self.rod >= self.bore:
            expected = f"less than the bore, {self.bore:.6g} m"
            yield fault("rod", found=self.rod, expected=expected)
        if self.length_min is not None and self.length_max is not None and self.length_min >= self.length_max:
            expected = f"less than length_max, {self.length_max:.6g} m"
            yield fault("length_min", found=self.length_min, expected=expected)
        yield from self._kind_faults()
        for key in ("flow", "pressure", "pressure_rod"):
            if self.bore is None and getattr(self, key) is not None:
                yield fault("bore", expected="the diameter of the bore", remedy=f"{key} acts on its area")
        if self.flow is not None and self.bore is not None and self.rod < self.bore:
            yield from self._flow_faults()

    def _kind_faults(self) -> Iterator[InitErrorDetails]:
        """Neither driver nor force, or both."""
        moves = [key for key in _MOVES if getattr(self, key) is not None]
        acts = [key for key in _ACTS if getattr(self, key) is not None]
        if moves and acts:
            remedy = "a cylinder is either moved or a force"
            yield fault(acts[0], found=f"{moves[0]} and {acts[0]}", expected="one of them", remedy=remedy)
        elif len(moves) > 1:
            yield fault("flow", found="law and flow", expected="either law or flow")
        elif moves and self.start_length is None:
            expected = "the distance of both points at crank angle zero"
            yield fault("start_length", expected=expected, remedy=f"{moves[0]} counts from it")
        elif acts and self.start_length is not None:
            expected = f"nothing beside {acts[0]}"
            yield fault("start_length", found=self.start_length, expected=expected)
        if self.stiffness is not None and self.free_length is None:
            yield fault("free_length", expected="a length of 0 or more, which a stiffness counts from")

    def _flow_faults(self) -> Iterator[InitErrorDetails]:
        """A flow without its times, or one that does not bring the rod back."""
        assert self.flow is not None
        places = self.flow_time if self.flow_angle is None else self.flow_angle
        key = "flow_time" if self.flow_angle is None else "flow_angle"
        if places is None or (self.flow_time is not None and self.flow_angle is not None):
            yield fault("flow_time", expected="either flow_time or flow_angle, a place for each flow")
            return
        if len(places) != len(self.flow) or len(places) < 2:
            found = f"{len(places)} and {len(self.flow)} numbers"
            yield fault(key, found=found, expected="as many as there are flows, at least 2")
        elif places[0] != 0 or any(b <= a for a, b in pairwise(places)):
            yield fault(key, found=list(places), expected="increasing values from 0")
        elif self.flow_angle is not None and abs(places[-1] - 2 * math.pi) > _CLOSES:
            yield fault(key, found=f"{math.degrees(places[-1]):.6g}°", expected="values from 0 to 360°")
        elif self.cycle is None:
            yield fault("cycle_time", expected="the time of one revolution, beside flow_angle")
        else:
            yield from self._open_faults()

    def _open_faults(self) -> Iterator[InitErrorDetails]:
        """A cycle of flow that leaves the rod elsewhere."""
        out, back = self.travels()
        if abs(out - back) > _CLOSES * max(out, back) or not out:
            assert self.areas is not None
            side, area = ("rod", self.areas[1]) if out > back else ("bore", self.areas[0])
            found = f"{1e3 * out:.6g} mm out and {1e3 * back:.6g} mm back"
            remedy = f"{1e3 * area * abs(out - back):.6g} litres are missing on the {side} side"
            yield fault("flow", found=found, expected="a cycle that ends where it began", remedy=remedy)
