r"""A knife of a topper whose law and speeds carry derivatives by entries of the machine.

The stroke of a sine or of a constant speed scales its law. A member of a mechanism has harmonics, and so have
the derivatives of its place by the entries of the mechanism; its middle moves as both of its ends do. A
follower has the law of its cam.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from linkwright.cam.laws.motion_law import Harmonic, MotionLaw, Piece
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent, plain, primal
from linkwright.linkages.kinematics import kinematics_of, rows_along
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.tangents import columns, directions
from linkwright.topping.knife import Knife, at_knots, joints, through
from linkwright.topping.model.topper import ConstantKnife, HarmonicKnife, MemberKnife

_TURN = 2 * np.pi

# Crank angles at which derivatives of a member are sampled, as `topping.knife` samples its place.
_ANGLES = 1440


def refused_of_law(machine: Machine, names: Sequence[str], knife: Knife) -> dict[str, str]:
    """Entries by which the law of a knife has no derivatives, with the reason."""
    motion = machine.topper.motion if machine.topper else None
    own = [name for name in names if name.startswith("mechanism.")]
    refused: dict[str, str] = {}
    if not isinstance(motion, MemberKnife):
        return refused
    if motion.of in machine.mechanism.cams:
        columns(machine, own, lambda along: [along.mechanism.cams[motion.of].lift.value(1.0)], refused)
    elif knife.harmonics is None:
        corners = {float(np.mod(joint, _TURN)) for joint in joints(machine)}
        by_entry = columns(machine, own, joints, refused)
        # Corners that are no joints of cams are where the mechanism has them: any entry may move those.
        is_known = corners.issuperset(knife.corners)
        moving = [name for name, column in by_entry.items() if column.any() or not is_known]
        refused |= dict.fromkeys(moving, "it moves segment boundaries of a piecewise motion")
    return refused


def knife_along(machine: Machine, along: Machine, names: Sequence[str], knife: Knife) -> Knife:
    """A knife of a machine with derivatives; `along`: the machine with tangents by some entries."""
    topper = along.topper
    assert topper is not None
    motion = topper.motion
    if isinstance(motion, MemberKnife):
        assert along.drive is not None
        law, speed = _member_law(machine, along, names, knife, motion.of), along.drive.speed
        return replace(knife, law=law, rate=speed or 0.0)
    if not isinstance(motion, ConstantKnife | HarmonicKnife) or motion.stroke is None or not knife.stroke:
        # One that does not turn back, or stands in the middle of its stroke.
        way = np.sign(knife.drift)
        return replace(knife, rate=0.0, drift=way * topper.knife_speed if way else 0.0)
    law = knife.law.scaled(plain(motion.stroke / knife.stroke))
    mean: Any = topper.knife_speed
    return replace(knife, law=law, rate=mean * (np.pi / motion.stroke))


def _member_law(
    machine: Machine, along: Machine, names: Sequence[str], knife: Knife, member: str
) -> MotionLaw:
    if member in machine.mechanism.cams:
        cam = along.mechanism.cams[member]
        phase = float(primal(cam.phase))
        law, late = _centred(cam.lift.shifted(phase)), plain(cam.phase - phase)
        return MotionLaw(tuple(x + late for x in law.breaks), law.pieces)
    compiled, program = compile_machine(machine), directions(machine, names)
    at = [names.index(name) for name in program.variables]

    def slopes(angles: Floats) -> Floats:
        """Derivatives of place, speed and acceleration over the crank angle, (3, angles, entries)."""
        d = np.zeros((3, len(angles), len(names)))
        d[:, :, at] = rows_along(compiled, angles, [("slides", member)], program.values)
        return d

    if knife.harmonics is None:
        knots = np.array(knife.law.breaks)
        parts = []
        for angles in at_knots(knots):
            slide = kinematics_of(compiled, angles, [("slides", member)]).slides[member]
            rows = zip((slide.position, slide.d1, slide.d2), slopes(angles), strict=True)
            parts.append([list(map(Tangent, values.tolist(), d)) for values, d in rows])
        return _centred(through(knots, parts[0], parts[1], parts[2][0]))
    d = slopes(np.linspace(0.0, _TURN, _ANGLES, endpoint=False))[0]
    spectrum = np.fft.rfft(d, axis=0) / _ANGLES
    spectrum[1:] *= 2.0
    pairs = np.stack([spectrum.real, -spectrum.imag], axis=1)[: len(knife.harmonics)]
    number: Any = Tangent
    waves = [
        Harmonic(_TURN * k, number(a, pairs[k, 0]), number(b, pairs[k, 1]))
        for k, (a, b) in enumerate(knife.harmonics.tolist())
    ]
    return _centred(MotionLaw((0.0, _TURN), (Piece((waves[0].cosine,), tuple(waves[1:])),)))


def _centred(law: MotionLaw) -> MotionLaw:
    least, greatest = law.extremes()
    return law.scaled(1.0, -0.5 * (least.value + greatest.value))
