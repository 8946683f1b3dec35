"""Pictures beside the drawing of the mechanism: a train twisting in its modes, a knife over heads.

The page moves both; nothing is computed there but where things lie on the screen.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.app.report.scene import moving_scene
from linkwright.kernel.errors import LinkwrightError
from linkwright.machine.machine import Machine
from linkwright.machine.read import loads
from linkwright.studio.files import Folder, base, opened

if TYPE_CHECKING:
    from linkwright.app.study import Study
    from linkwright.torsion.figures.scheme_layout import Layout
    from linkwright.torsion.modes.free import FreeVibration
    from linkwright.torsion.modes.scheme import Connection, Scheme

View = dict[str, Any]

# Length of a shaft as it is drawn: of the stiffest, what compliance adds at most; of parts without.
_SHORT, _MORE, _PLAIN = 0.9, 1.5, 0.9

# Room of a disc to either side.
_ROOM = 0.35

# Half height of the largest disc over the distance of two rows, and of the smallest over that.
_HIGH, _LOW = 0.36, 0.12

# Modes that are offered: higher ones are for tables.
_MODES = 12


def train_view(machine: Machine) -> View:
    """A train from the side, and its lowest modes that twist it.

    ``discs`` with place and half height; ``parts`` that join them, ``from`` and ``to`` a place, with the
    ``ends``, places in the list of discs or None at the ground; ``frequencies`` [Hz] and ``shapes``, a row a
    mode, the peak amplitude being 1; ``nodes`` of each mode on ``parts``; ``box``, minimum and maximum x and
    the number of rows.
    """
    from linkwright.torsion.figures.equal_planets import equal_planets_once
    from linkwright.torsion.figures.scheme_layout import layout
    from linkwright.torsion.modes.free import free_vibration
    from linkwright.torsion.modes.scheme import scheme

    free, shown = free_vibration(machine), equal_planets_once(scheme(machine))
    drawn = shown.scheme
    lengths = _lengths(drawn)
    laid = layout(drawn.discs, drawn.connections, lengths, _ROOM)
    twisting = [k for k, f in enumerate(free.natural_frequencies) if f > 0][:_MODES]
    return {
        "kind": "train",
        "discs": list(_discs(drawn, laid)),
        "parts": list(_parts(drawn, laid, free, twisting)),
        "frequencies": free.natural_frequencies[twisting],
        "shapes": free.mode_shapes[twisting][:, shown.kept],
        "nodes": [
            [{"at": shown.names.get(node.at, node.at), "share": node.share} for node in free.nodes[k]]
            for k in twisting
        ],
        "box": _box(laid),
    }


def _lengths(drawn: Scheme) -> dict[str, float]:
    """Drawn lengths of connections: what is soft is long, within limits."""
    soft = [part.equivalent_length for part in drawn.connections if part.equivalent_length]
    longest = max(soft, default=1.0)
    return {
        part.name: _SHORT + _MORE * (part.equivalent_length / longest) ** 0.5
        if part.equivalent_length
        else _PLAIN
        for part in drawn.connections
    }


def _discs(drawn: Scheme, laid: Layout) -> Iterator[View]:
    """Discs with their places; radii of discs of one width, by the fourth root of the inertia."""
    largest = float(drawn.inertia_referred.max()) or 1.0
    for n, name in enumerate(drawn.discs):
        x, row = laid.discs[name]
        share = max((float(drawn.inertia_referred[n]) / largest) ** 0.25, _LOW / _HIGH)
        yield {"name": name, "x": x, "row": row, "half": _HIGH * share}


def _parts(drawn: Scheme, laid: Layout, free: FreeVibration, modes: list[int]) -> Iterator[View]:
    place = {name: n for n, name in enumerate(drawn.discs)}
    along = {shape.name: shape for shape in free.along}

    def ends(part: Connection, *, turned: bool = False) -> list[int | None]:
        names = [part.second, part.first] if turned else [part.first, part.second]
        return [place.get(name) for name in names]

    for span in laid.spans:
        # A span leads away from the disc that it was reached from, which may be the second end of its shaft.
        far = span.part.second
        turned = laid.discs.get(far) != (span.stop, span.row) if far in place else not span.to_ground
        view: View = {"name": span.part.name, "kind": span.part.kind, "ends": ends(span.part, turned=turned)}
        view |= {"from": [span.start, span.row], "to": [span.stop, span.row], "turned": turned}
        if span.part.name in along:
            shape = along[span.part.name]
            view |= {"share": shape.share, "angles": shape.angles[modes]}
        yield view
    for riser in laid.risers:
        # Of gears both ends are discs; a shaft in a row of its own hangs on a line from its disc.
        geared = riser.part.kind in ("gears", "mesh")
        turned = geared and riser.part.first != riser.disc
        joined = ends(riser.part, turned=turned) if geared else [place[riser.disc], None]
        view = {"name": riser.part.name, "kind": riser.part.kind if geared else "arm", "ends": joined}
        yield view | {"turned": turned, "from": [riser.x, riser.row], "to": [riser.x, riser.to_row]}
    for bridge in laid.bridges:
        spots = [list(laid.discs[name]) for name in (bridge.part.first, bridge.part.second)]
        view = {
            "name": bridge.part.name,
            "kind": bridge.part.kind,
            "ends": ends(bridge.part),
            "turned": False,
        }
        yield view | {"from": spots[0], "to": spots[1]}


def _box(laid: Layout) -> list[float]:
    xs = [x for x, _ in laid.discs.values()] + [x for span in laid.spans for x in (span.start, span.stop)]
    rows = [row for _, row in laid.discs.values()]
    return [min(xs), max(xs), 1 + max(rows)]


def knife_view(study: Study) -> View | None:
    """The knife of a topper from above; None without one, or where it does not move."""
    from linkwright.app.report.page import knife_scene

    scene = knife_scene(study)
    if scene is None:
        return None
    return {"kind": "topper", **scene, "law": np.array(scene["law"])}


def thumbnail(folder: Folder, place: str, name: str) -> View:
    """``scene`` at constant speed, or ``view``, of a machine; both None where nothing moves or is none."""
    try:
        machine = loads(opened(folder, place, name), path=base(folder, place, name))
        scene = moving_scene(machine, None)
        view = None if scene is not None else _view(machine)
    except LinkwrightError:
        # silent: a machine that cannot be drawn has no picture; opening it says why
        return {"scene": None, "view": None}
    if scene is not None:
        del scene["motion"]
    return {"scene": scene, "view": view}


def _view(machine: Machine) -> View | None:
    """What is shown of a machine without a mechanism; None if there is nothing."""
    if machine.train is not None:
        return train_view(machine)
    if machine.topper is not None:
        from linkwright.app.study import study

        return knife_view(study(machine))
    if machine.turning_moment is not None:
        return diagram_view(machine)
    return None


def diagram_view(machine: Machine) -> View:
    """A turning-moment diagram: ``curves``, each ``x`` and ``y``: driver and load, or the excess energy."""
    from linkwright.turning.diagram import turning_moment

    diagram = turning_moment(machine)
    curves = [(diagram.crank_angle, torque) for torque in (diagram.torque_driver, diagram.torque_load)]
    if not len(diagram.crank_angle):
        # Areas alone: the energy at their ends.
        energies = [0.0, *(area["energy_after"] for area in diagram.areas)]
        curves = [(np.arange(float(len(energies))), np.array(energies))]
    return {"kind": "turning", "curves": [{"x": x, "y": y} for x, y in curves]}
