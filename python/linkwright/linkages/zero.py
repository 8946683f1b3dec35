"""Crank angles counted from a dead centre: where that dead centre of a slide or rocker is.

The outer dead centre is the extreme position farthest along the guide, or the largest angle of a link that
swings; the inner one is the other. The top is the extreme position that is higher in the drawing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.linkages.cycle import ElementMotion, linkage
from linkwright.linkages.pose import pose
from linkwright.machine.machine import Machine

ENDS = ("outer", "inner", "top", "bottom")


class Zero(NamedTuple):
    """A crank angle from which others are counted.

    Attributes
    ----------
    angle : float
        Within one revolution [rad].
    words : str
        Such as ``"inner dead centre of ram"``; empty where angles are those of the file.
    """

    angle: float = 0.0
    words: str = ""


@public
def zero_angle(machine: Machine, where: str) -> Zero:
    """The crank angle of a dead centre, to count others from it.

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
        Crank angle [rad] and words.

    Raises
    ------
    InputError
        It is none of these, no such output moves back and forth, or there are several and none is named; the
        top of what does not move up or down.
    AssemblyError
        The mechanism closes nowhere.
    """
    name, end = _parts(where)
    output = _output(machine, name)
    if end in ("top", "bottom"):
        end, said = _end_at(machine, output, end), end
    else:
        said = end
    angle = output.high_angle if end == "outer" else output.low_angle
    return Zero(float(angle % (2 * np.pi)), f"{said} dead centre of {output.output}")


def _parts(where: str) -> tuple[str, str]:
    """The output that is named, if any, and the end."""
    name, _, end = where.strip().rpartition(" ")
    if end not in ENDS:
        expected = f"one of {', '.join(ENDS)}, with the name of an output before it if there are several"
        raise InputError(f'zero: found "{where}", expected {expected}')
    return name.strip(), end


def _output(machine: Machine, name: str) -> ElementMotion:
    """The output that is named, or the only one."""
    outputs = [element for element in linkage(machine).elements if element.turns is None]
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
    raise InputError(f'zero: found "{wanted}", expected one of {", ".join(names)}')


def _end_at(machine: Machine, output: ElementMotion, end: str) -> str:
    """Which end is the higher or the lower one."""
    heights = []
    for angle in (output.low_angle, output.high_angle):
        points = pose(machine, float(angle)).points
        place = points.get(output.output) or points.get(output.element)
        if place is None:
            raise InputError(
                f"zero: {output.output} has no point whose height tells its {end}; use outer, inner"
            )
        heights.append(float(place.position[1]))
    low, high = heights
    travel = output.high - output.low
    if abs(high - low) <= 1e-6 * travel:
        raise InputError(f"zero: {output.output} is as high at both dead centres; use outer or inner")
    return "outer" if (high > low) == (end == "top") else "inner"
