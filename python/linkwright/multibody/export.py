"""A machine as MJCF or URDF: what is written, and what it stands on."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.drive.model.drive import Drive
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.files.output import write_file
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import ANGLE, SPEED, TIME
from linkwright.kernel.units.marks import Quantity
from linkwright.kinetostatics.applied import gravity
from linkwright.kinetostatics.motion import Motion
from linkwright.kinetostatics.places import Scene
from linkwright.linkages.closure import closure, require_full_turn
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.drive_line import drive_inertia, speed_guess
from linkwright.multibody.linear_laws import Law, load_laws, motor_law
from linkwright.multibody.mjcf_file import IMPEDANCE, TIME_CONSTANT, Setting, mjcf_text
from linkwright.multibody.refusals import require_guides, require_laws, require_tree
from linkwright.multibody.transmission import Transmission, start_speeds, transmission
from linkwright.multibody.tree import Tree, tree
from linkwright.multibody.urdf_file import urdf_text

# Mass of a body without one, as a share of all masses: programs refuse zero, and less would be rounding.
_MASSLESS = 1e-8

# Inertia of a body with a point mass alone: the smallest that is safely above MuJoCo's limit of 1e-15.
_POINT_INERTIA = 1e-12

# Inertia that keeps the crank's speed, over that of all masses at a mean length from the crank.
_KEEPS_SPEED = 1e8

# Time steps per revolution where nobody chose a time step.
_STEPS = 2000

# Intervals of the transmission table.
_INTERVALS = 360


@dataclass(frozen=True)
class _File(Result):
    """What all exports have."""

    bodies: Annotated[tuple[str, ...], About("Names of the bodies, each followed by all that it carries.")]
    joints: Annotated[tuple[str, ...], About("Names of the joints of the tree.")]
    loops: Annotated[tuple[str, ...], About("Names of the pins that close loops.")]
    massless: Annotated[tuple[str, ...], About("Bodies without mass, which are given a small one.")]
    mass_min: Annotated[float, Label("mass given to bodies without one", "", "kg")]
    text: Annotated[str, About("Content of the file.")]

    @public
    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the file.

        Parameters
        ----------
        path : str or path-like
            It is replaced if it exists.

        Raises
        ------
        InputError
            The path is no file, or cannot be written.
        """
        write_file(path, self.text)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """All but the content."""
        return {name: x for name, x in super().to_dict(curves=curves).items() if name != "text"}


@dataclass(frozen=True)
class Mjcf(_File):
    """A machine as MJCF, with its loops closed and its loads as actuators."""

    step: Annotated[float, Label("time step", "h", "s")]
    time_constant: Annotated[float, Label("time constant of the loops", "T", "s")]
    impedance: Annotated[float, Label("impedance of the loops", "d", "")]
    armature: Annotated[float, Label("inertia on the crankshaft", "", "kg m²")]
    speed_start: Annotated[float, Label("crank speed at the start", "", "rad/s")]
    is_constant_speed: Annotated[bool, About("Whether a large inertia keeps the speed of the crank.")]
    loads: Annotated[tuple[str, ...], About("Loads, and the motor, as MJCF names them, without weight.")]
    moves: Annotated[bool, About("Whether it has a speed at the start, or a load or weight that moves it.")]


@dataclass(frozen=True)
class Urdf(_File):
    """A machine as URDF: a tree of joints that follow a table over the crank angle."""

    transmission: Annotated[Transmission, About("Positions of all joints over a cycle.")]


@public
def mjcf(
    machine: Machine,
    *,
    angle: float = 0.0,
    speed: float | None = None,
    speed_start: float = 0.0,
    step: float | None = None,
    leave_out: Sequence[str] = (),
) -> Mjcf:
    """Export a machine for MuJoCo.

    Parameters
    ----------
    machine : Machine
        A linkage that a crank drives.
    angle : float
        Crank angle of the initial position [rad].
    speed : float, optional
        Constant speed of the crank [rad/s], kept by a large inertia. Default: that of a motor of constant
        speed; without a motor, the design speed, unless `speed_start` is given.
    speed_start : float
        Crank speed at the start of a motion under motor and loads [rad/s].
    step : float, optional
        Time step [s]; without it 2000 per revolution.
    leave_out : sequence of str
        Loads, or ``"motor"``, that the receiving program applies itself.

    Returns
    -------
    Mjcf
        Its keyframe ``start`` has the initial position, all speeds, and the supply of the motor switched on.

    Raises
    ------
    AssemblyError
        The mechanism does not close at the initial crank angle.
    InputError
        The machine has a part, a motor or a load that MJCF has not; all are listed with their remedies.

    References
    ----------
    .. [1] Todorov, Erez, Tassa, MuJoCo: A physics engine for model-based control, IROS 2012.
    """
    in_range(
        angle=(angle, Quantity(ANGLE)),
        speed=(speed, Quantity(SPEED)),
        speed_start=(speed_start, Quantity(SPEED)),
        step=(step, Quantity(TIME)),
    )
    if step is not None and not step > 0:
        raise InputError(f"step: found {step:g} s, expected a time greater than 0")
    kept = _kept_speed(machine, speed, speed_start)
    made = _tree(machine, angle)
    laws = _laws(made, leave_out, motor=kept is None)
    armature, masses = _inertias(made, is_constant=kept is not None)
    first = speed_start if kept is None else kept
    h = _step(machine, first) if step is None else float(step)
    setting = Setting(
        name=machine.name,
        step=h,
        gravity=gravity(machine, leave_out),
        armature=armature,
        masses=masses,
        laws=laws,
        speeds=start_speeds(made, first),
    )
    return Mjcf(
        **_common(made, masses, mjcf_text(made, setting)),
        step=h,
        time_constant=TIME_CONSTANT * h,
        impedance=IMPEDANCE,
        armature=armature,
        speed_start=first,
        is_constant_speed=kept is not None,
        loads=tuple(law.name for law in laws),
        moves=bool(first or setting.gravity.any() or any(law.constant or law.per_length for law in laws)),
    )


@public
def urdf(machine: Machine, *, angle: float = 0.0, n: int = _INTERVALS) -> Urdf:
    """Export a machine as URDF with the transmission table of its loops.

    Parameters
    ----------
    machine : Machine
        A linkage that a crank drives.
    angle : float
        Crank angle of the initial position, at which all joints are at zero [rad].
    n : int
        Intervals of the table in a revolution.

    Returns
    -------
    Urdf
        The file, and positions of all joints with two derivatives over a cycle.

    Raises
    ------
    AssemblyError
        The mechanism does not close over the whole revolution.
    InputError
        The machine has a part that URDF has not; all are listed with their remedies.

    References
    ----------
    .. [1] URDF XML specification, http://wiki.ros.org/urdf/XML.
    """
    in_range(angle=(angle, Quantity(ANGLE)))
    if not 1 <= n <= 100_000:
        raise InputError(f"n: found {show(n)}, expected a number of intervals from 1 to 100 000")
    made = _tree(machine, angle)
    require_full_turn(compile_machine(machine), machine)
    turns = closure(machine).turns or 1
    scene = _scene(machine, angle + np.linspace(0.0, 2 * np.pi * turns, n * turns + 1))
    table = transmission(made, scene)
    _, masses = _inertias(made, is_constant=False)
    return Urdf(**_common(made, masses, urdf_text(made, machine.name, masses, table)), transmission=table)


def _tree(machine: Machine, angle: float) -> Tree:
    """The tree at a crank angle; what it cannot hold is refused."""
    require_tree(machine)
    scene = _scene(machine, np.array([float(angle)]))
    require_guides(scene)
    return tree(scene)


def _scene(machine: Machine, angles: Any) -> Scene:
    """The machine at crank angles; speeds play no part."""
    still = np.zeros(len(angles))
    return Scene(machine, Motion(angles, still, still, angles))


def _kept_speed(machine: Machine, speed: float | None, speed_start: float) -> float | None:
    """The constant speed of the crank; None for a motion under motor and loads."""
    if speed is not None:
        if speed_start:
            raise InputError("speed, speed_start: found both, expected a constant speed or one at the start")
        return float(speed)
    drive = machine.drive or Drive()
    if isinstance(drive.motor, ConstantSpeedMotor):
        return float(speed_guess(drive))
    if drive.motor is None and not speed_start and machine.design_speed is not None:
        return float(machine.design_speed)
    return None


def _laws(made: Tree, leave_out: Sequence[str], *, motor: bool) -> tuple[Law, ...]:
    """Motor and loads that are not left out; of a constant speed no motor."""
    machine = made.scene.machine
    known = [*machine.all_loads, "motor"]
    for name in leave_out:
        if name not in known:
            expected = f"one of {', '.join(known)}"
            raise InputError(f"leave_out: found {show(name)}, expected {expected}")
    require_laws(made, leave_out, motor=motor)
    own = motor_law(made, machine.drive) if motor and "motor" not in leave_out else None
    names = [name for name in machine.all_loads if name not in leave_out]
    return (*([own] if own is not None else []), *load_laws(made, names))


def _inertias(made: Tree, *, is_constant: bool) -> tuple[float, dict[str, tuple[float, float]]]:
    """Inertia on the crankshaft, and mass and inertia of each body, none of them zero."""
    scene = made.scene
    shaft = float(drive_inertia(scene.machine.drive or Drive()))
    # Without any mass all bodies are alike: what a crank of constant speed moves does not matter.
    total = sum(body.mass for body in made.bodies.values()) + shaft / scene.size**2 or 1.0 / _MASSLESS
    small = _MASSLESS * total
    masses = {
        body.name: (
            body.mass or small,
            max(body.inertia, _POINT_INERTIA if body.mass else small * scene.size**2),
        )
        for body in made.bodies.values()
    }
    return (_KEEPS_SPEED * total * scene.size**2 if is_constant else shaft), masses


def _step(machine: Machine, speed: float) -> float:
    """A time step of one digit: about 1/2000 of a revolution at the fastest speed."""
    fastest = max(abs(speed), float(speed_guess(machine.drive or Drive())))
    return float(f"{2 * math.pi / (_STEPS * fastest):.1g}")


def _common(made: Tree, masses: Mapping[str, tuple[float, float]], text: str) -> dict[str, Any]:
    """What all exports have, by name."""
    massless = tuple(body.name for body in made.bodies.values() if not body.mass)
    return {
        "bodies": tuple(made.bodies),
        "joints": tuple(made.joints()),
        "loops": tuple(loop.name for loop in made.loops),
        "massless": massless,
        "mass_min": masses[massless[0]][0] if massless else 0.0,
        "text": text,
    }
