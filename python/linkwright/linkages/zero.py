"""Crank angles counted from a dead centre: where that dead centre of a slide or rocker is.

The outer dead centre is the extreme position farthest along the guide, or the largest angle of a link that
swings; the inner one is the other. The top is the extreme position that is higher in the drawing.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.kernel.errors import InputError, cut
from linkwright.kernel.public import public
from linkwright.kernel.reader.angle_zero import Zero
from linkwright.linkages.closure import Closure, in_cycle
from linkwright.linkages.cycle import ElementMotion, Linkage, linkage
from linkwright.linkages.kinematics import kinematics_of
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# An extreme this near to the end of a range is that end [rad]: rounding of the search for both.
_LIMIT = 1e-6

ENDS = ("outer", "inner", "top", "bottom")


@public
def zero_angle(machine: Machine, where: str) -> Zero:
    """Crank angle of a dead centre, as zero for other angles.

    Parameters
    ----------
    machine : Machine
        The machine; of a batch, the first.
    where : str
        ``"outer"``, ``"inner"``, ``"top"`` or ``"bottom"``; with several outputs, the name of one before it:
        ``"ram inner"``.

    Returns
    -------
    Zero
        Crank angle [rad], words, and the cycle after which the mechanism repeats [rad].

    Raises
    ------
    InputError
        It is none of these, no such output moves back and forth, or there are several and none is named; the
        top of what does not move up or down; an end of the travel where the crank is at a limit.
    AssemblyError
        The mechanism closes nowhere.
    """
    name, end = _parts(where)
    cycle = linkage(machine)
    output = _output(cycle, name)
    if end in ("top", "bottom"):
        end, said = _end_at(machine, output, end), end
    else:
        said = end
    angle = float(output.high_angle if end == "outer" else output.low_angle)
    _require_dead_centre(cycle.closure, angle, f"the {said} end of {output.output}")
    turns = cycle.closure.turns if cycle.closure.turns_fully else None
    words = f"{said} dead centre of {output.output}"
    return Zero(in_cycle(cycle.closure, angle), words, 2 * np.pi * (turns or 0))


def zero_of(machine: Machine, where: str | None) -> Zero:
    """The zero that an option names; that of the file without one."""
    return Zero() if where is None else zero_angle(machine, where)


def zero_over(machine: Machine, where: str | None, *motions: Any) -> Zero:
    """The same over the whole revolutions of the longest of motions, of which some may be None."""
    zero = zero_of(machine, where)
    spans = [motion.crank_angle[-1] - motion.crank_angle[0] for motion in motions if motion is not None]
    turns = round(float(max(spans, default=0.0)) / (2 * np.pi))
    return zero._replace(cycle=2 * np.pi * turns) if zero.cycle and spans else zero


def _require_dead_centre(closed: Closure, angle: float, what: str) -> None:
    """Refuse an end of the travel where the mechanism closes no farther: its output does not rest there."""
    limits = () if closed.turns_fully else closed.ranges
    if any(abs(angle - limit) <= _LIMIT for limits_of_range in limits for limit in limits_of_range):
        raise InputError(
            f"zero: at {what} the crank is at a limit of its rotation ({np.degrees(angle):.6g}°), no dead "
            "centre; name the other end"
        )


def _parts(where: str) -> tuple[str, str]:
    name, _, end = where.strip().rpartition(" ")
    if end not in ENDS:
        expected = f"one of {', '.join(ENDS)}, with the name of an output before it if there are several"
        raise InputError(f'zero: found "{cut(where)}", expected {expected}')
    return name.strip(), end


def _output(cycle: Linkage, name: str) -> ElementMotion:
    outputs = [element for element in cycle.elements if element.turns is None]
    names = list(dict.fromkeys(output.output for output in outputs))
    if not names:
        raise InputError(
            "zero: no link or slide of the machine moves back and forth, so it has no dead centre"
        )
    if not name and len(names) > 1:
        listed = ", ".join(names)
        raise InputError(f'zero: several outputs have dead centres ({listed}): name one, "{names[0]} inner"')
    wanted = name or names[0]
    for output in outputs:
        if wanted in (output.output, output.element):
            return output
    raise InputError(f'zero: found "{cut(wanted)}", expected one of {", ".join(names)}')


def _end_at(machine: Machine, output: ElementMotion, end: str) -> str:
    compiled = compile_machine(machine).first()
    name = next((name for name in (output.output, output.element) if name in compiled.points), None)
    if name is None:
        raise InputError(f"zero: {output.output} has no point whose height tells its {end}; use outer, inner")
    # At a limit of crank rotation the mechanism has a position, but no velocity.
    ends = np.array([output.low_angle, output.high_angle])
    low, high = kinematics_of(compiled, ends, [("points", name)]).points[name].position[:, 1]
    travel = output.high - output.low
    if abs(high - low) <= 1e-6 * travel:
        raise InputError(f"zero: {output.output} is as high at both dead centres; use outer or inner")
    return "outer" if (high > low) == (end == "top") else "inner"
