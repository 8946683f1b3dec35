"""The drawing of a machine: what the report's sketch draws, with rates of its points, forces and handles.

Handles are points that can be dragged; the entries of the file follow.

| point | entries |
| --- | --- |
| fixed point | its coordinates |
| pin of a crank | radius and phase |
| slider | length of the rod |
| joint of a coupler and a rocker | both lengths |
| point of a link | its place on the link |
| joint of bars | lengths of the bars and driving cylinders that end there |
| linear driver | its place at crank angle zero |
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np

from linkwright.app.report.scene import moving_scene
from linkwright.drive.steady_state import SteadyState
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.place import join
from linkwright.kernel.reader.numbers import cycle_of_angles
from linkwright.kinetostatics.result import Forces
from linkwright.linkages.centrodes import centrodes_of
from linkwright.linkages.kinematics import Kinematics
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.linkages.model.structure import structure
from linkwright.linkages.model.topology import ORIGIN
from linkwright.linkages.motion import rates_of
from linkwright.linkages.sweep import Output, outputs_of
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Order of the derivative → its words, and what stands behind the symbol.
_WORDS = ("position", "first transfer function", "second transfer function")
_MARKS = ("", "′", "″")

# Kind of an output → its words, symbol, and the unit of each derivative.
_KINDS: dict[Literal["stroke", "swing"], tuple[str, str, tuple[str, str, str]]] = {
    "stroke": ("sliders", "s", ("m", "m/rad", "m/rad²")),
    "swing": ("links", "ψ", ("rad", "", "1/rad")),
}


def drawing(
    machine: Machine, steady: SteadyState | None, acting: Forces | None, string: Any = None
) -> dict[str, Any] | None:
    """All that the page draws of a mechanism along its steady motion, with forces; None where nothing moves.

    As of `moving_scene`; ``velocities`` and ``accelerations`` of moving points, (n, 2) each; ``forces`` with
    the point where they act; ``handles``, points that can be dragged with the entries that follow;
    ``transfer``, plots of transfer functions.
    """
    scene = moving_scene(machine, steady, string=string)
    if scene is None:
        return None
    if scene["motion"] is None:
        # A rod string without a unit.
        del scene["motion"]
        return (
            scene
            | {key: {} for key in ("velocities", "accelerations", "centres")}
            | {key: [] for key in ("forces", "handles", "transfer")}
        )
    if steady is None and machine.drive is not None and machine.drive.speed:
        # Without a motor the crank turns at its design speed.
        ratio = machine.drive.speed / scene["speeds"]
        scene |= {"speeds": scene["speeds"] * ratio, "times": scene["times"] / ratio, "true_speed": True}
    motion, speeds = scene.pop("motion"), scene["speeds"]
    accelerations = np.zeros_like(speeds) if steady is None else _along(scene, steady)
    rates = {
        name: rates_of(motion.points[name], speeds[:, None], accelerations[:, None])
        for name in machine.linkage.moving_points()
        if name in motion.points
    }
    return scene | {
        "velocities": {name: velocity for name, (velocity, _) in rates.items()},
        "accelerations": {name: acceleration for name, (_, acceleration) in rates.items()},
        "forces": _acting(machine, scene, acting) if acting is not None else [],
        "handles": handles(machine),
        "centres": dict(_centres(machine, motion)),
        "transfer": transfer_functions(machine, motion),
    }


def _centres(machine: Machine, motion: Kinematics) -> Iterator[tuple[str, dict[str, Any]]]:
    # ``fixed`` and ``moving``, the centrodes, (n, 2) each, the second along and across the link; ``at``, its
    # start, and ``angle``, its direction.
    still = machine.linkage.fixed_points().keys() | {ORIGIN}
    for name, link in machine.linkage.links().items():
        if name in motion.links and link.start in motion.points and not {link.start, link.end} & still:
            traced = centrodes_of(machine, name, motion)
            yield (
                name,
                {
                    "at": link.start,
                    "angle": motion.links[name].angle,
                    "fixed": np.stack([traced.x, traced.y], axis=-1),
                    "moving": np.stack([traced.along, traced.across], axis=-1),
                },
            )


def _along(scene: dict[str, Any], steady: SteadyState) -> Floats:
    """Angular acceleration of the crank at the angles of the scene [rad/s²]."""
    within = np.mod(scene["angles"], cycle_of_angles(steady.crank_angle))
    along: Floats = np.interp(within, steady.crank_angle, steady.acceleration)
    return along


def _acting(machine: Machine, scene: dict[str, Any], acting: Forces) -> list[dict[str, Any]]:
    points = {name: pair.point for name, pair in structure(machine.linkage).pairs.items()}
    within = np.mod(scene["angles"], cycle_of_angles(acting.crank_angle))
    forces = []
    for name, pair in acting.pairs.items():
        if pair.kind in ("pin", "guide") and points.get(name) in scene["points"]:
            force = np.stack(
                [np.interp(within, acting.crank_angle, pair.force[:, k]) for k in (0, 1)], axis=-1
            )
            if np.isfinite(force).all():
                forces.append({"name": name, "point": points[name], "force": force})
    return forces


# Table of the mechanism → entries that place its point.
_PLACES = {
    "points": ("x", "y"),
    "cranks": ("radius", "phase"),
    "sliders": ("rod",),
    "rockers": ("coupler", "rocker"),
    "rigid_points": ("along", "across"),
    "linear_drivers": ("start",),
}


def handles(machine: Machine) -> list[dict[str, Any]]:
    """The points that can be dragged: ``point``, its name, and ``entries``, addresses of what follows."""
    points = dict(_handles(machine.mechanism))
    return [{"point": name, "entries": addresses} for name, addresses in points.items() if addresses]


def entries_of(machine: Machine, point: str) -> list[str]:
    """Addresses of the entries that follow a point; none if it cannot be dragged."""
    return dict(_handles(machine.mechanism)).get(point, [])


def _handles(mechanism: Mechanism) -> Iterator[tuple[str, list[str]]]:
    for table, names in _PLACES.items():
        for name, element in getattr(mechanism, table).items():
            if name != ORIGIN or table != "points":
                # What the file does not have stays out of it.
                given = [name for name in names if name in element.model_fields_set]
                yield name, [join(("mechanism", table, name, entry)) for entry in given]
    for name in mechanism.joints:
        bars = [joint for joint, bar in mechanism.bars.items() if name in (bar.start, bar.end)]
        driving = [
            cylinder
            for cylinder, own in mechanism.cylinders.items()
            if own.drives and name in (own.start, own.end)
        ]
        yield (
            name,
            [
                *(join(("mechanism", "bars", bar, "length")) for bar in bars),
                *(join(("mechanism", "cylinders", one, "start_length")) for one in driving),
            ],
        )


def transfer_functions(machine: Machine, motion: Kinematics) -> list[dict[str, Any]]:
    """Plots as of `shown`, those of sliders before those of links; none where nothing is moved."""
    outputs = outputs_of(compile_machine(machine), machine.linkage)
    return [plot for kind in _KINDS for plot in _plots(kind, outputs, motion)]


def _plots(
    kind: Literal["stroke", "swing"], outputs: list[Output], motion: Kinematics
) -> Iterator[dict[str, Any]]:
    names = [output.name for output in outputs if output.kind == kind and _curves(motion, output.name)]
    words, symbol, units = _KINDS[kind]
    for order, (word, mark, unit) in enumerate(zip(_WORDS, _MARKS, units, strict=True)):
        if names:
            yield {
                "key": f"transfer.{kind}{order}",
                "title": f"{word} of {words}",
                "unit": unit,
                "x": {"name": "crank_angle", "word": "crank angle", "symbol": "φ", "unit": "rad"}
                | {"values": motion.angles},
                "curves": [
                    {"name": name, "word": name, "symbol": f"{symbol}{mark} {name}", "own": True}
                    | {"unit": unit, "values": _curves(motion, name)[order]}
                    for name in names
                ],
            }


def _curves(motion: Kinematics, name: str) -> tuple[Floats, ...]:
    """Position and derivatives of a slide or a link; none if it is neither."""
    if name in motion.slides:
        slide = motion.slides[name]
        return slide.position, slide.d1, slide.d2
    if name in motion.links:
        link = motion.links[name]
        return link.angle, link.d1, link.d2
    return ()
