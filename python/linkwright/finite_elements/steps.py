r"""Steps of CalculiX and Abaqus with the loads on a link at its instants.

The link stands at rest in its own axes. Forces act on node sets, one for each joint; weight and inertia act
on all elements, per unit mass

.. math:: \mathbf b = (\mathbf g - \mathbf a_0) + \omega^2 \mathbf r - \alpha \times \mathbf r

| part | keyword |
| --- | --- |
| forces and moments at joints | `*CLOAD`; a moment acts on the reference node of the joint |
| g − a₀ | `*DLOAD`, GRAV |
| ω² r | `*DLOAD`, CENTRIF |
| −α × r | `*DLOAD`, ROTA in Abaqus; CalculiX has no such load: GRAV of each element by its centre there |

Sources: Dhondt, *CalculiX CrunchiX User's Manual*, `*CLOAD`, `*DLOAD`, `*RIGID BODY`; Dassault Systèmes,
*Abaqus Keywords Reference Guide*, `*CLOAD`, `*DLOAD`; *Abaqus Theory Guide*, section 6.1.4: CENTRIF and ROTA
are the d'Alembert forces in a system that rotates with ω and α, so that a positive α pulls along −α × r.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from linkwright.finite_elements.mesh import Mesh
from linkwright.finite_elements.result import Instant, LinkLoad, LinkLoads
from linkwright.kernel.errors import InputError

Solver = Literal["abaqus", "calculix"]

# Share of the peak force below which a component is rounding.
_ROUNDING = 1e-12


class NodeSet(NamedTuple):
    """A node set of the model, and over how many nodes it shares a force."""

    name: str
    nodes: int = 1


@dataclass(frozen=True)
class Model:
    """The model of a link that the steps are for."""

    solver: Solver
    length: float = 1e-3  # its unit of length [m]: 1e-3 with N, mm, t, s; 1 with N, m, kg, s
    elements: str = "EALL"  # set of all elements
    sets: Mapping[str, NodeSet] = field(default_factory=dict)  # of joints by name
    mesh: Mesh | None = None  # for the angular acceleration in CalculiX

    def node_set(self, name: str) -> NodeSet:
        """The node set of a joint, a drive or a load."""
        return self.sets.get(name) or NodeSet("N_" + re.sub(r"\W", "_", name, flags=re.ASCII).upper())


def step_text(loads: LinkLoads, model: Model) -> str:
    """The steps of all instants. Raises InputError: a node set has no load, or cannot take a moment."""
    if unknown := [name for name in model.sets if name not in loads.loads]:
        known = ", ".join(loads.loads)
        raise InputError(f'nodes: found "{unknown[0]}", expected a load of {loads.link}: {known}')
    lines = [*_head(loads, model)]
    for instant in loads.instants:
        lines += _step(loads, instant, model)
    return "\n".join(lines) + "\n"


def _head(loads: LinkLoads, model: Model) -> Iterator[str]:
    units = "N, mm, t, s" if model.length == 1e-3 else "N, m, kg, s"
    yield f"** Loads on {loads.link} in its own axes: x from start to end, y to the left. Units: {units}"
    yield f"** Mass of the link {loads.mass:.9g} kg: density and volume of the model must give the same."
    yield "** Hold three components in the plane, statically determinate: their reactions vanish."
    for name, load in loads.loads.items():
        own = model.node_set(name)
        where = "at a place of its own in every step"
        if load.is_fixed:
            where = _where(load, 0, model)
        turning = f", moments on {own.name}_ROT" if model.solver == "calculix" else ""
        yield f"** {name}: node set {own.name} {where}{turning}"


def _where(load: LinkLoad, i: int, model: Model) -> str:
    """Coordinates of a load; rounding beside the other one is zero."""
    largest = float(abs(load.place[i]).max())
    x, y = (0.0 if abs(value) < 1e-9 * largest else value / model.length for value in load.place[i].tolist())
    return f"at x = {x:.9g}, y = {y:.9g}"


def _step(loads: LinkLoads, instant: Instant, model: Model) -> Iterator[str]:
    i = instant.place
    yield f"** {'; '.join(instant.names)}: crank angle {math.degrees(loads.crank_angle[i]):.6g} deg"
    yield "*STEP"
    yield "*STATIC"
    forces = [line for name, load in loads.loads.items() for line in _forces(name, load, i, loads, model)]
    yield from ["*CLOAD, OP=NEW", *forces] if forces else []
    bodies = list(_bodies(loads, i, model))
    yield from ["*DLOAD, OP=NEW", *bodies] if bodies else []
    yield "*END STEP"


def _forces(name: str, load: LinkLoad, i: int, loads: LinkLoads, model: Model) -> Iterator[str]:
    own = model.node_set(name)
    scale = max(loads.force_max.values(), default=0.0)
    if not load.is_fixed:
        yield f"** {own.name} {_where(load, i, model)}"
    for axis, force in enumerate(load.force[i].tolist(), start=1):
        if abs(force) > _ROUNDING * scale:
            yield f"{own.name}, {axis}, {force / own.nodes:.12g}"
    moment = float(load.moment[i])
    if abs(moment) <= _ROUNDING * scale * loads.size:
        return
    if own.nodes > 1:
        raise InputError(
            f"nodes: {name} has a moment of {moment:.4g} N m, which {own.nodes} nodes cannot take; couple "
            "them to a reference node and name its set with one node"
        )
    # The rotational node of a rigid body takes moments as forces along its axes.
    turning = f"{own.name}_ROT, 3" if model.solver == "calculix" else f"{own.name}, 6"
    yield f"{turning}, {moment / model.length:.12g}"


def _bodies(loads: LinkLoads, i: int, model: Model) -> Iterator[str]:
    """Weight and inertia on the elements."""
    b = loads.gravity[i] - loads.origin_acceleration[i]
    square, alpha = float(loads.speed[i]) ** 2, float(loads.acceleration[i])
    axis = "0., 0., 0., 0., 0., 1."
    if alpha == 0.0 or model.solver == "abaqus" or model.mesh is None:
        yield from _pull(model.elements, *(b / model.length).tolist())
    else:
        for element, (x, y) in model.mesh.centres.items():
            # −α × r = α (y, −x); a load of one kind for each element, whatever the solver does with several.
            along, across = (b / model.length).tolist()
            yield from _pull(str(element), along + alpha * y, across - alpha * x)
    if square > _ROUNDING * float((loads.speed**2).max()):
        yield f"{model.elements}, CENTRIF, {square:.12g}, {axis}"
    if alpha and model.solver == "abaqus":
        yield f"{model.elements}, ROTA, {alpha:.12g}, {axis}"
    elif alpha and model.mesh is None:
        yield f"** The angular acceleration of {alpha:.12g} rad/s^2 is left out: it needs the mesh."


def _pull(elements: str, along: float, across: float) -> Iterator[str]:
    """A force per unit mass on elements."""
    size = math.hypot(along, across)
    if size > 0:
        yield f"{elements}, GRAV, {size:.12g}, {along / size:.12g}, {across / size:.12g}, 0."
