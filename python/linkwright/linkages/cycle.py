r"""A linkage over its cycle: extreme positions, time ratios, transmission angles, velocity ratios, Grashof.

.. math::

    i = \frac{d\psi}{d\varphi}\ \text{or}\ \frac{ds}{d\varphi}, \qquad \frac{M_\text{out}}{M_\text{in}} =
    \frac{1}{i}

Extremes are zeros of exact derivatives: bracketed on a grid, then located to rounding.

Dead points are where a linkage stops, turns back or can branch. At a limit a radicand passes zero and the
crank can go no farther. At a change point a radicand touches zero, a double root: both assemblies meet, and
the motion goes on. At a reversal an output is at rest; driven by that output, the mechanism is at a dead
point there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import shown
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record, Result
from linkwright.linkages.closure import Closure, closure_error, closure_of, limiter_at
from linkwright.linkages.grashof import FourBar, four_bars
from linkwright.linkages.period import turns_to_repeat
from linkwright.linkages.sweep import Cycle, LinkageSweep, Output, outputs_of, sweep
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine

if TYPE_CHECKING:
    from linkwright.linkages.sweep import LinkageSweep

LIMIT, END = "limit of crank rotation", "end of travel"
PASSED = "change point passed"
NOT_PASSED = "change point not passed"
REVERSAL = "dead centre of the output"


class DeadPoint(NamedTuple):
    """One of them.

    Attributes
    ----------
    angle : float
        Crank angle, within one revolution, or within the longer period or range [rad].
    element : str
        Name of the dyad, or of the link or slide that turns back.
    kind : str
        ``"limit of crank rotation"``, ``"end of travel"`` of a motion that never repeats,
        ``"change point passed"``, ``"change point not passed"`` (both links in line, their rates not
        determined) or ``"dead centre of the output"``.
    multiplicity : int
        Of the zero: 1 where a sign changes, 2 where a radicand touches zero.
    turns_back : str
        What turns back at a dead centre, ``"angle"`` of a link or ``"position"`` of a slide, which may have
        one name; else empty.
    """

    angle: float
    element: str
    kind: str
    multiplicity: int
    turns_back: str = ""


def dead_points(compiled: CompiledMachine, swept: LinkageSweep, where: Closure) -> list[DeadPoint]:
    """The dead points of a linkage."""
    points = [*_of_closure(compiled, where), *_passed(compiled, swept), *_reversals(swept)]
    return sorted(points)


def _of_closure(compiled: CompiledMachine, where: Closure) -> Iterator[DeadPoint]:
    if where.change_point is not None:
        yield DeadPoint(where.change_point, where.element, NOT_PASSED, 2)
    elif not where.turns_fully:
        for end in (end for limits in where.ranges for end in limits):
            at = end if where.turns is None else end % (2 * np.pi * where.turns)
            kind = END if where.turns is None else LIMIT
            yield DeadPoint(at, limiter_at(compiled, end), kind, 1)


def _passed(compiled: CompiledMachine, swept: LinkageSweep) -> Iterator[DeadPoint]:
    turns = np.arange(swept.cycle.period or 1) * (2 * np.pi)
    for dyad in swept.dyads:
        gaps = compiled.gaps(np.ascontiguousarray(swept.cycle.angles))[compiled.dyads.index(dyad.name)]
        for angle in dyad.change_points:
            at: Floats = np.asarray(angle + turns, dtype=np.float64)
            spare = compiled.gaps(at)[compiled.dyads.index(dyad.name)]
            for passed in at[(spare <= _IN_LINE * np.nanmax(gaps)) | (turns == 0)]:
                yield DeadPoint(float(passed), dyad.name, PASSED, 2)


# Share of its maximum below which the radicand of a dyad whose links are in line lies.
_IN_LINE = 1e-6


def _reversals(swept: LinkageSweep) -> Iterator[DeadPoint]:
    for k, output in enumerate(swept.outputs):
        for angle in swept.reversals(k):
            turns_back = "position" if output.kind == "stroke" else "angle"
            yield DeadPoint(swept.cycle.named(angle), output.name, REVERSAL, 1, turns_back)


_ELEMENT_MOTION_VELOCITY_RATIO_MIN = (
    "Minimum of the output's speed over the crank's [– or m/rad]; None where it grows without limit."
)


@dataclass(frozen=True)
class ElementMotion(Record):
    """One element over the cycle."""

    element: Annotated[str, About("Its name; for bars, that of their joint.")]
    output: Annotated[str, About("Name of the link or slide that is looked at.")]
    swing: Annotated[
        float | None,
        Label(
            "swing of the link",
            "",
            "rad",
            "Between its extreme positions; None for a full rotation, and for a slide.",
        ),
    ]
    stroke: Annotated[
        float | None,
        Label("stroke of the slide", "", "m", "Between its extreme positions; None if there is none."),
    ]
    turns: Annotated[float | None, Label("revolutions of the link in a period", "", "", "Where it turns on.")]
    low: Annotated[float, About("Minimum position [rad or m].")]
    high: Annotated[float, About("Maximum position [rad or m].")]
    low_angle: Annotated[float, Label("crank angle of the minimum position", "", "rad")]
    high_angle: Annotated[float, Label("crank angle of the maximum position", "", "rad")]
    time_ratio: Annotated[
        float | None,
        Label(
            "time ratio", "", "", "Crank angle of the slower stroke over that of the quicker one, at least 1."
        ),
    ]
    velocity_ratio_min: Annotated[float | None, About(_ELEMENT_MOTION_VELOCITY_RATIO_MIN)]
    velocity_ratio_max: Annotated[float | None, About("Its maximum, likewise.")]
    mechanical_advantage_min: Annotated[
        float | None, About("Minimum torque or force out for the torque in, without losses [– or 1/m].")
    ]
    transmission_angle_min: Annotated[
        float | None, Label("minimum transmission angle", "", "rad", "None for what is no dyad.")
    ] = None
    transmission_angle_max: Annotated[
        float | None, Label("maximum transmission angle", "", "rad", "None for what is no dyad.")
    ] = None
    transmission_angle_min_angle: Annotated[
        float | None, Label("crank angle of the minimum transmission angle", "", "rad")
    ] = None
    transmission_angle_max_angle: Annotated[
        float | None, Label("crank angle of the maximum transmission angle", "", "rad")
    ] = None
    four_bar: Annotated[FourBar | None, About("The four-bar loop that the element closes.")] = None

    @property
    def transmission_angle_worst(
        self,
    ) -> Annotated[float | None, Label("worst transmission angle", "", "rad")]:
        """Acute angle between the two links where it is smallest: μ or π − μ."""
        low, high = self.transmission_angle_min, self.transmission_angle_max
        return None if low is None or high is None else min(low, math.pi - high)

    @property
    def grashof(self) -> str | None:
        """Class of its four-bar loop, in words."""
        return None if self.four_bar is None else self.four_bar.grashof

    def to_dict(self) -> dict[str, Any]:
        """Scalars by name, without those that do not exist."""
        entries = {name: value for name, value in vars(self).items() if name not in ("element", "four_bar")}
        entries["transmission_angle_worst"] = self.transmission_angle_worst
        if self.four_bar is not None:
            entries["grashof"] = self.grashof
            entries["grashof_sum_extremes"] = self.four_bar.sum_extremes
            entries["grashof_sum_others"] = self.four_bar.sum_others
        return {name: value for name, value in entries.items() if value is not None}


_VELOCITY_RATIOS = "Speed of the output over that of the crank, by name of the link or slide [– or m/rad]."


@dataclass(frozen=True)
class Linkage(Result):
    """A linkage over its cycle."""

    crank_angle: Annotated[
        Floats, Label("crank angle", "φ", "rad", "Over the period, or over the range in which it closes.")
    ]
    transmission_angles: Annotated[dict[str, Floats], About("μ by element [rad].")] = field(repr=False)
    velocity_ratios: Annotated[dict[str, Floats], About(_VELOCITY_RATIOS)] = field(repr=False)
    elements: Annotated[tuple[ElementMotion, ...], About("In build order.")]
    closure: Annotated[Closure, About("Where it closes.")]
    period_turns: Annotated[
        int | None,
        Label("revolutions of the crank in a period", "", "", "None if it has none or does not turn fully."),
    ]
    dead_points: Annotated[
        tuple[DeadPoint, ...], About("Limits, change points and reversals, by crank angle.")
    ]

    @property
    def names(self) -> list[str]:
        """Names of the entries of `elements`, each once."""
        return names_of([(element.element, element.output) for element in self.elements])

    @public
    def element(self, name: str) -> ElementMotion:
        """Entry of an element, link or slide, of a lever's slot as ``LEVER.slot``; else an `InputError`."""
        for own, element in zip(self.names, self.elements, strict=True):
            if name in (own, element.element, element.output):
                return element
        known = [*self.names, *(element.output for element in self.elements)]
        hint = suggestion(name, known) or "see those of .elements"
        raise InputError(f"name: found {shown(name)}, expected an element, a link or a slide; {hint}")

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Whether the crank turns fully, period, elements by name and dead points, ready for JSON. Returns:
        SI numbers. Of two outputs of an element the second has its own name, a slot ``LEVER.slot``.
        """
        results: dict[str, Any] = {
            "turns_fully": self.closure.turns_fully,
            "period_turns": self.period_turns,
            "elements": {
                name: element.to_dict() for name, element in zip(self.names, self.elements, strict=True)
            },
            "dead_points": [point._asdict() for point in self.dead_points],
        }
        if curves:
            results |= {name: curve.tolist() for name, curve in self.curves().items()}
        return results

    def curves(self) -> dict[str, np.ndarray]:
        """The curves by name: ``R.transmission_angle``, ``R.rocker.velocity_ratio``, ``S.stroke_ratio``."""
        curves = {"crank_angle": self.crank_angle}
        curves |= {f"{name}.transmission_angle": curve for name, curve in self.transmission_angles.items()}
        for element, (name, curve) in zip(self.elements, self.velocity_ratios.items(), strict=True):
            curves[f"{name}.velocity_ratio" if element.stroke is None else f"{name}.stroke_ratio"] = curve
        return curves

    def shown_rows(self) -> Iterator[tuple[str, str, float | tuple[float, float], str]]:
        """Travel, time ratio, ratio of speeds and transmission angle of each element."""
        for name, element in zip(self.names, self.elements, strict=True):
            travel = (
                (element.swing, "swing", "rad") if element.stroke is None else (element.stroke, "stroke", "m")
            )
            for value, word, unit in (
                travel,
                (element.turns, "revolutions in a period", ""),
                (element.time_ratio, "time ratio", ""),
            ):
                if value is not None:
                    yield f"{word} of {name}", "", value, unit
            low, high = element.transmission_angle_min, element.transmission_angle_max
            if low is not None and high is not None:
                yield f"transmission angle of {name}", "μ", (low, high), "rad"

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute or a curve by its name."""
        of, _, last = name.rpartition(".")
        return _UNITS.get(last, "") if of else super().unit_of(name)


def elements_of(machine: Machine) -> list[str]:
    """Names of the entries that `linkage` has for a machine, without computing them."""
    moved = outputs_of(compile_machine(machine).first(), machine.linkage)
    return names_of([(output.element, output.name) for output in moved])


def names_of(moved: Sequence[tuple[str, str]]) -> list[str]:
    """Names of what elements move, `moved`: (element, output): the element's, for a second output its own."""
    elements = [element for element, _ in moved]
    return apart(
        element if elements.index(element) == place else output
        for place, (element, output) in enumerate(moved)
    )


def apart(names: Iterable[str]) -> list[str]:
    """Names one by one; the slot of a lever, which has the lever's name, with ``.slot`` behind it."""
    listed: list[str] = []
    for name in names:
        listed.append(f"{name}.slot" if name in listed else name)
    return listed


# Units of the curves of elements and outputs, by the last word of their name.
_UNITS = {"transmission_angle": "rad", "stroke_ratio": "m/rad", "velocity_ratio": ""}


@public
def linkage(machine: Machine) -> Linkage:
    """Examine a linkage over its cycle.

    Parameters
    ----------
    machine : Machine
        The machine; of a batch, the first.

    Returns
    -------
    Linkage
        Over the period of a mechanism that turns fully; else over the first range in which it closes.

    Raises
    ------
    AssemblyError
        The mechanism closes nowhere, or at single angles alone.

    References
    ----------
    .. [1] Norton, Design of Machinery: transmission angle, mechanical advantage, time ratio.
    .. [2] VDI 2123: transmission angle.
    """
    return examined(*swept_cycle(machine))


def examined(compiled: CompiledMachine, where: Closure, swept: LinkageSweep) -> Linkage:
    """`linkage` of a cycle that is swept, as `swept_cycle` gives it."""
    loops = {bar.element: bar for bar in four_bars(compiled)}
    return Linkage(
        crank_angle=swept.cycle.angles,
        transmission_angles={dyad.name: swept.mu[k] for k, dyad in enumerate(swept.dyads)},
        velocity_ratios=dict(zip(apart(output.name for output in swept.outputs), swept.d1, strict=True)),
        elements=tuple(
            _element(swept, k, output, loops.get(output.element)) for k, output in enumerate(swept.outputs)
        ),
        closure=where,
        period_turns=swept.cycle.period,
        dead_points=tuple(dead_points(compiled, swept, where)),
    )


def swept_cycle(machine: Machine) -> tuple[CompiledMachine, Closure, LinkageSweep]:
    """Program of a machine, where it closes, and the sweep over its cycle. Raises what `linkage` raises."""
    compiled = compile_machine(machine).first()
    where = closure_of(compiled)
    if not where.moves:
        raise closure_error(where, machine)
    period = turns_to_repeat(compiled) if where.turns_fully else None
    return compiled, where, sweep(compiled, machine.linkage, Cycle.of(where, period))


def _element(swept: LinkageSweep, k: int, output: Output, loop: FourBar | None) -> ElementMotion:
    travel = swept.travel(k)
    slow, fast = swept.ratios(k)
    most = max(abs(slow), abs(fast)) if slow is not None and fast is not None else None
    mu = swept.transmission(output.element)
    on = travel.turns is not None
    size = travel.high - travel.low
    return ElementMotion(
        element=output.element,
        output=output.name,
        swing=size if output.kind == "swing" and not on else None,
        stroke=size if output.kind == "stroke" and not on else None,
        turns=travel.turns,
        low=travel.low,
        high=travel.high,
        low_angle=travel.low_angle,
        high_angle=travel.high_angle,
        time_ratio=travel.time_ratio,
        velocity_ratio_min=slow,
        velocity_ratio_max=fast,
        mechanical_advantage_min=1 / most if most else None,
        four_bar=loop,
        **({} if mu is None else dict(zip(_MU, mu, strict=True))),
    )


_MU = (
    "transmission_angle_min",
    "transmission_angle_max",
    "transmission_angle_min_angle",
    "transmission_angle_max_angle",
)
