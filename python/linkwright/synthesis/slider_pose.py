"""Points of a body that stay on a straight line through three poses, and the slider-crank that uses one.

The places of a point a are Z_i = p_i + a e^{iθ_i}. With u = p₂ − p₁, v = e^{iθ₂} − e^{iθ₁} and w, z likewise
for the third pose, they are in line where

    Im[(u + v a)* (w + z a)] = Im(v* z) |a|² + Im(u* z a + v* a* w) + Im(u* w) = 0

This is a circle in the body, the circle of sliders.

Source: Erdman, Sandor, Mechanism Design: Analysis and Synthesis: circle-point and centre-point circles,
circle of sliders. The equation is derived here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import SynthesisError
from linkwright.machine.machine import Machine
from linkwright.synthesis.four_bar import cross, machine_of, plain_place, plain_point
from linkwright.synthesis.task import PoseTask

# Terms of the circle below this share of their size are rounding.
_ZERO = 1e-12


@dataclass(frozen=True)
class SliderGuide:
    """A slider-crank with its place in the plane."""

    # The fixed pivot, and the slider at crank angle zero [m].
    crank_pivot: complex
    slider: complex
    # Lengths [m].
    crank: float
    rod: float
    offset: float
    angle: float  # direction of the guide [rad]
    phase: float  # direction of the crank at crank angle zero [rad]

    @property
    def type(self) -> str:
        """Whether the crank turns fully."""
        return "crank turns" if self.rod > self.crank + abs(self.offset) else "crank swings"

    def height(self, angles: Floats) -> Floats:
        """Distance of the crank pin to the left of the guide at crank angles, (n,) [m]."""
        return self.crank * np.sin(self.phase + np.asarray(angles) - self.angle) - self.offset

    def gap(self, angles: Floats) -> Floats:
        """l² − h² at crank angles, (n,) [m²]; negative where the rod does not reach the guide."""
        return self.rod**2 - self.height(angles) ** 2

    def transmission_angle(self, angles: Floats) -> Floats:
        """Angle between the rod and the normal of the guide at crank angles, (n,) [rad]."""
        return np.arccos(np.clip(np.abs(self.height(angles)) / self.rod, 0, 1))

    def machine(self, name: str, point: complex, source: str) -> Machine:
        """The slider-crank as a machine, with a point ``P`` of the rod at along + i across [m]."""
        slider = {
            "crank": "A",
            "rod": self.rod,
            "through": "A0",
            "offset": self.offset,
            "angle": self.angle,
            "assembly": "positive",
        }
        mechanism = {
            "points": {"A0": plain_place(self.crank_pivot)},
            "cranks": {"A": {"pivot": "A0", "radius": self.crank, "phase": self.phase}},
            "sliders": {"B": slider},
            "rigid_points": {"P": plain_point("B.rod", point)},
        }
        return machine_of(name, mechanism, source)


def circle_of_sliders(origins: Complexes, angles: Floats, wanted: complex) -> complex:
    """The point of a body nearest to a wanted one whose three places are in line.

    `origins` (3,): places of the body's origin [m]; `angles` (3,): angles of the body [rad]; `wanted`: point
    of the body, in its own axes [m]. Returns: point of the body, in its own axes [m]. Raises SynthesisError:
    no point of the body stays on a line.
    """
    turns = np.exp(1j * np.asarray(angles))
    u, w = origins[1] - origins[0], origins[2] - origins[0]
    v, z = turns[1] - turns[0], turns[2] - turns[0]
    square = float(cross(v, z))
    # Im(u* z a + v* a* w) is the scalar product of a with this vector.
    line = complex(np.imag(np.conj(u) * z) + np.imag(np.conj(v) * w), 0) + 1j * (
        np.real(np.conj(u) * z) - np.real(np.conj(v) * w)
    )
    constant = float(cross(u, w))
    if abs(square) <= _ZERO:
        return _on_line(line, constant, wanted, max(abs(u), abs(w)))
    middle = -line / (2 * square)
    # The circle passes through the poles of the poses, so it is real; rounding may say otherwise.
    radius = np.sqrt(max(abs(middle) ** 2 - constant / square, 0.0))
    off = wanted - middle
    # At the centre every direction is as near as any other.
    return complex(middle + radius * (off / abs(off) if abs(off) > 0 else 1.0))


def _on_line(line: complex, constant: float, wanted: complex, size: float) -> complex:
    """The nearest point of the straight line that the circle becomes when two poses are parallel."""
    if abs(line) <= _ZERO * size:
        if abs(constant) <= _ZERO * size**2:
            return wanted
        raise SynthesisError(
            "the body does not turn between the poses and its places are not in line, so no point of it "
            "stays on a straight line; change a pose, or use a four-bar"
        )
    unit = line / abs(line)
    return wanted - unit * (float(np.real(np.conj(unit) * wanted)) + constant / abs(line))


def guide_slider(task: PoseTask, pins: Complexes, crank_pivot: complex) -> SliderGuide:
    """The slider-crank for two or three poses.

    `task`: the poses and the points of the body; `pins` (n,): places of the crank pin [m]; `crank_pivot`: the
    crank's fixed pivot [m]. Returns: with crank angle zero in the first pose. Raises SynthesisError: no such
    point, a slider that does not move, or poses on different sides.
    """
    assert task.slider_point is not None
    point = complex(task.slider_point.x, task.slider_point.y)
    origins = np.asarray(task.poses.x) + 1j * np.asarray(task.poses.y)
    if len(origins) == 3:
        point = circle_of_sliders(origins, np.asarray(task.poses.angle), point)
    sliders = origins + point * np.exp(1j * np.asarray(task.poses.angle))
    far = sliders[np.abs(sliders - sliders[0]).argmax()] - sliders[0]
    if abs(far) <= 1e-9 * max(1e-3, float(np.abs(sliders).max())):
        raise SynthesisError("slider_point does not move between the poses; choose another point of the body")
    along = far / abs(far)
    sides = np.sign(np.real(np.conj(along) * (sliders - pins)))
    if len(set(sides)) > 1:
        raise SynthesisError(
            "the slider is ahead of the crank pin in one pose and behind it in another: the poses lie on "
            "different branches; choose other points of the body"
        )
    # The direction of the guide in which the slider is ahead of the pin.
    along = along * sides[0]
    return SliderGuide(
        crank_pivot,
        complex(sliders[0]),
        float(abs(pins[0] - crank_pivot)),
        float(abs(sliders[0] - pins[0])),
        float(cross(along, sliders[0] - crank_pivot)),
        float(np.angle(along)),
        float(np.angle(pins[0] - crank_pivot)),
    )
