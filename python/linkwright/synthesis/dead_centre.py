"""Dead-centre design: a crank-rocker for a required swing and time ratio; the slider-crank is in `stroke`.

In the outer dead centre the joint is at p = c + r from the crank's pivot A₀, in the inner one at q = c − r,
and A₀ sees the two places under the angle δ = φ₀ − π, where φ₀ is the crank angle from the outer to the inner
dead centre. With the chord h between the places (h = 2 b sin ψ₀/2 for a rocker b, the stroke for a slider)
the triangle gives

    r = ½ h cos κ/cos(δ/2)          c = ½ h sin κ/sin(δ/2)

κ is free. It is written as sin κ = sin(|δ|/2)/t, so that c = h/(2t) holds for δ = 0 too, and t between
sin(|δ|/2) and 1 is chosen for the best transmission angle.

Source: Alt's construction, VDI 2130 (transmission-optimal crank-rockers for two dead centres); Volmer,
Getriebetechnik: Koppelgetriebe.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import SynthesisError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.units.kinds import ANGLE, LENGTH, RATIO
from linkwright.kernel.units.marks import Bound, Quantity, positive
from linkwright.machine.machine import Machine
from linkwright.synthesis.four_bar import FourBar, cross, turn_spare, worst_transmission
from linkwright.synthesis.verification import (
    TransmissionResult,
    element_of,
    require_met,
    require_transmission,
)

# Values of the free parameter examined before the best is refined; the transmission angle has one hill, or
# two, over each family.
_LOOKS = 2001

SOURCE = "Synthesised by linkwright from its dead centres"


_CRANK_ROCKER_TURNS_ALIKE = (
    "Whether rocker and crank rotate in the same sense from the outer to the inner dead centre."
)


@dataclass(frozen=True)
class CrankRocker(TransmissionResult):
    """A crank-rocker for given dead centres."""

    remedy: ClassVar[str] = "reduce the swing, or choose a time ratio nearer to 1"

    swing: Annotated[float, Label("swing of the rocker", "ψ_0", "rad", "Between the dead centres.")]
    crank_angle_forward: Annotated[
        float,
        Label(
            "crank angle of the forward stroke", "φ_0", "rad", "From the outer dead centre to the inner one."
        ),
    ]
    time_ratio: Annotated[float, Label("time ratio", "", "", "φ₀ over the rest of the revolution.")]
    frame: Annotated[float, Label("length of the frame", "", "m")]
    crank: Annotated[float, Label("length of the crank", "", "m")]
    coupler: Annotated[float, Label("length of the coupler", "", "m")]
    rocker: Annotated[float, Label("length of the rocker", "", "m")]
    transmission_angle_min: Annotated[
        float, Label("minimum transmission angle", "μ_min", "rad", "Over the revolution.")
    ]
    turns_alike: Annotated[bool, About(_CRANK_ROCKER_TURNS_ALIKE)]
    crank_angle_outer: Annotated[
        float, Label("crank angle of the outer dead centre", "", "rad", "In the machine.")
    ]
    crank_angle_inner: Annotated[
        float, Label("crank angle of the inner dead centre", "", "rad", "In the machine.")
    ]
    machine: Annotated[Machine, About("The linkage, its frame along x.")]


_SWING = Bound(
    " between 0 and 180 deg,",
    {"exclusiveMinimum": 0, "exclusiveMaximum": np.pi},
    lambda value: 0 < value < np.pi,
)


@public
def crank_rocker(
    swing: float, time_ratio: float = 1.0, *, frame: float = 1.0, coupler_max: float = 3.0
) -> CrankRocker:
    """Find the crank-rocker of the best transmission angle for a swing and a time ratio.

    Parameters
    ----------
    swing : float
        Angle ψ₀ of the rocker between its dead centres [rad].
    time_ratio : float
        Crank angle from the outer dead centre to the inner one over the rest of the revolution [–].
    frame : float
        Distance of the fixed pivots [m].
    coupler_max : float
        Coupler over rocker, at most [–]. Near a time ratio of 1 the transmission angle grows with the coupler
        without end, towards a right angle less half the swing.

    Returns
    -------
    CrankRocker
        The linkage. Its crank turns counter-clockwise.

    Raises
    ------
    InputError
        A swing not between 0 and 180°, a time ratio or a length that is not positive.
    SynthesisError
        No crank-rocker has this swing and this time ratio, or none that keeps them when it is analysed again.

    References
    ----------
    .. [1] VDI 2130.
    """
    in_range(
        swing=(swing, Quantity(ANGLE, _SWING)),
        time_ratio=(time_ratio, positive(RATIO)),
        frame=(frame, positive(LENGTH)),
        coupler_max=(coupler_max, positive(RATIO)),
    )
    delta = delta_of(time_ratio)
    families = [_Family(swing, delta, side) for side in (1.0, -1.0)]
    low = max(np.sin(abs(delta) / 2), np.sin(swing / 2) / coupler_max)
    linkages = [(family, *best(family.transmission, low)) for family in families]
    family, t, mu = max(linkages, key=lambda linkage: np.nan_to_num(linkage[2]))
    if not mu > 0:
        raise SynthesisError(_no_crank_rocker(swing, time_ratio, coupler_max))
    return _verified(family.result(t, time_ratio, frame))


def _verified(made: CrankRocker) -> CrankRocker:
    """The crank-rocker, if its machine has the dead centres that were asked for."""
    element = element_of(made.machine, "B.rocker")
    require_met("a swing", made.swing, element.swing, "rad")
    require_met("a time ratio", *slow_over_quick(made.time_ratio, element.time_ratio))
    require_transmission(made.transmission_angle_min, element)
    return made


def slow_over_quick(time_ratio: float, default: float | None) -> tuple[float, float | None]:
    """A time ratio as the analysis counts it, the slower way first; without a slower way it is 1."""
    return max(time_ratio, 1 / time_ratio), 1.0 if default is None else default


def delta_of(time_ratio: float) -> float:
    """δ = φ₀ − π of a time ratio k = φ₀/(2π − φ₀) [rad]."""
    return 2 * np.pi * time_ratio / (1 + time_ratio) - np.pi


def best(transmission: Callable[[Floats], Floats], low: float) -> tuple[float, float]:
    """The free parameter of the best transmission angle, and that angle; NaN if there is no linkage."""
    least, high = low, 1.0
    largest, angle = np.nan, np.nan
    # Each look is a thousand times closer than the one before; five pass the limit of rounding.
    for _ in range(5 if low < high else 0):
        t = np.linspace(low, high, _LOOKS + 2)[1:-1]
        angles = transmission(t)
        if np.isnan(angles).all():
            break
        at = int(np.nanargmax(angles))
        largest, angle, step = float(t[at]), float(angles[at]), t[1] - t[0]
        low, high = max(largest - step, least), min(largest + step, 1.0)
    return largest, angle


def joints(t: Floats, delta: float) -> tuple[Floats, Floats, Complexes, Complexes]:
    """Crank, coupler, and the places of the joint in the outer and inner dead centre, for a chord of 2."""
    kappa = np.arcsin(np.sin(abs(delta) / 2) / t)
    crank, coupler = np.cos(kappa) / np.cos(delta / 2), 1 / t
    return crank, coupler, crank + coupler + 0j, (coupler - crank) * np.exp(1j * delta)


@dataclass(frozen=True)
class _Family:
    """The crank-rockers for a swing and δ whose rocker pivot is on one side of the chord, over t."""

    swing: float
    delta: float
    side: float

    def places(self, t: Floats) -> tuple[Floats, Floats, Complexes, Complexes, Complexes]:
        """Crank, coupler, joint in both dead centres, and rocker pivot, for a chord of 2."""
        crank, coupler, outer, inner = joints(t, self.delta)
        pivot = 0.5 * (outer + inner) + self.side * 0.5j * (inner - outer) / np.tan(self.swing / 2)
        return crank, coupler, outer, inner, pivot

    def transmission(self, t: Floats) -> Floats:
        """Minimum transmission angle; NaN where this is no crank-rocker with these dead centres."""
        crank, coupler, outer, inner, pivot = self.places(t)
        rocker, frame = np.full_like(t, 1 / np.sin(self.swing / 2)), np.abs(pivot)
        one_circuit = cross(pivot, outer) * cross(pivot, inner) > 0
        turns = (turn_spare(frame, crank, coupler, rocker) > 0) & (crank < np.minimum(frame, rocker))
        mu = worst_transmission(frame, crank, coupler, rocker)
        return np.where(one_circuit & turns & (crank < coupler), mu, np.nan)

    def result(self, t: float, time_ratio: float, frame: float) -> CrankRocker:
        crank, coupler, outer, inner, pivot = (place[0] for place in self.places(np.array([t])))
        scale = frame / abs(pivot)
        outer, inner = outer / pivot * frame, inner / pivot * frame
        side = "left" if outer.imag > 0 else "right"
        bar = FourBar(0j, frame + 0j, crank * scale, coupler * scale, abs(outer - frame), side)  # type: ignore[arg-type]
        mu = float(worst_transmission(bar.frame, bar.crank, bar.coupler, bar.rocker))  # type: ignore[arg-type]
        degrees = f"{np.degrees(self.swing):.6g}°"
        return CrankRocker(
            swing=float(self.swing),
            crank_angle_forward=float(np.pi + self.delta),
            time_ratio=float(time_ratio),
            frame=float(frame),
            crank=float(bar.crank),
            coupler=float(bar.coupler),
            rocker=float(bar.rocker),
            transmission_angle_min=mu,
            turns_alike=bool(cross(outer - frame, inner - frame) > 0),
            crank_angle_outer=float(np.angle(outer)) % (2 * np.pi),
            crank_angle_inner=float(np.angle(-inner)) % (2 * np.pi),
            machine=bar.machine(f"Crank-rocker, swing {degrees}, time ratio {time_ratio:.6g}", source=SOURCE),
        )


def _no_crank_rocker(swing: float, time_ratio: float, coupler_max: float) -> str:
    """Which crank angles a swing allows (VDI 2130: φ₀ between 90° + ψ₀/2 and 270° + ψ₀/2, or mirrored)."""
    psi, phi = np.degrees(swing), 360 * time_ratio / (1 + time_ratio)
    most = (270 + psi / 2) / (90 - psi / 2)
    return (
        f"no crank-rocker swings {psi:.4g}° with a crank angle of {phi:.4g}° between the dead centres (time "
        f"ratio {time_ratio:.4g}): for this swing the time ratio must lie between {1 / most:.4g} and "
        f"{most:.4g}, and near its ends the coupler may need more than {coupler_max:.4g} times the rocker; "
        "change one of them"
    )
