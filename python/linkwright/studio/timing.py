"""The timing diagram of cams and axes as the page draws it, with the entries that move ends of sections.

An end that is dragged lengthens its section and shortens the next one, so that all others stay where they
are; the end of the last section of an axis changes the dwell that is left of the cycle; the start of the
first changes the phase.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from linkwright.axes.model.follower import cycle_time_of
from linkwright.axes.timing import Track
from linkwright.kernel.description.place import join
from linkwright.machine.machine import Machine

# Curves of a track, in the order of the panels.
CURVES = ("position", "velocity", "acceleration", "torque")


def timing_view(machine: Machine, tracks: Sequence[Track]) -> dict[str, Any]:
    """Tracks over one revolution of the master.

    ``angles``; of each track ``name``, ``curves`` with their unit, and ``sections``.
    """
    return {
        "kind": "timing",
        "angles": tracks[0].crank_angle,
        "tracks": [
            {
                "name": track.name,
                "curves": [
                    {"name": curve, "unit": track.unit_of(curve), "values": getattr(track, curve)}
                    for curve in CURVES
                ],
                **_sections(machine, track),
            }
            for track in tracks
        ],
    }


def _sections(machine: Machine, track: Track) -> dict[str, Any]:
    """Sections of a track: the entry of its phase, and of each section its entry, length, and what it is."""
    cam, axis = machine.mechanism.cams.get(track.driver), machine.axes.get(track.name)
    place = ("mechanism", "cams", track.driver) if cam is not None else ("axes", track.name)
    own = cam if cam is not None else axis
    if own is None or not own.sections:
        return {"phase": 0.0, "sections": []}
    sections = list(_lengths(place, own.sections, cycle_time_of(machine.master, machine.drive)))
    return {"phase": float(own.phase), "address": join((*place, "phase")), "sections": sections}


def _lengths(
    place: tuple[str, ...], sections: Sequence[Any], cycle_time: float | None
) -> Iterator[dict[str, Any]]:
    for n, section in enumerate(sections):
        time = getattr(section, "time", None)
        # Units of the entry in a radian of the master.
        rate = 1.0 if time is None or cycle_time is None else cycle_time / (2 * math.pi)
        yield {
            "address": join((*place, "sections", str(n), "angle" if time is None else "time")),
            "unit": "rad" if time is None else "s",
            "rate": rate,
            "angle": float(section.angle if time is None else time / rate),
            "dwells": section.is_dwell,
        }
