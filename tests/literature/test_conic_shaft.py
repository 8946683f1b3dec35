"""Published natural frequencies of conic shafts with distributed inertia, by ever finer uniform steps."""

from __future__ import annotations

import math

import pytest

import linkwright as lw

# Torsional Vibrations of a Conic Shaft with Opposite Tapers Carrying Arbitrary Concentrated Elements,
# Mathematical Problems in Engineering 2013, 491062, table 2: exact natural frequencies [rad/s] of a conic
# shaft of constant length and larger diameter. The uniform shaft, free at both ends, has 5000.0416: the
# speed of torsional waves over the length. The dimensions themselves were not at hand: smaller over larger
# diameter is taken as 1 - 40 times the printed taper ratio, with which Bessel functions give what is printed.
UNIFORM = 5000.0416
FREE = {
    0.02: (7384.4129, 11854.5424, 16427.4469),
    0.01: (5374.8958, 10198.6873, 15134.0131),
    0.005: (5074.8956, 10037.9356, 15025.4133),
}
CLAMPED = {0.01: (5128.1859, 10066.7014, 15044.8782)}


def frequencies(taper: float, steps: int, *, clamped: bool) -> list[float]:
    """The lowest three of a cone of so many uniform steps [rad/s]."""
    small, text = 1 - 40 * taper, ""
    # c/L of the print, with L = 1 m: a length of stiffness k = d⁴ c/ℓ has the inertia d⁴ ℓ/c.
    c = UNIFORM / math.pi
    for n in range(steps):
        d4 = (small + (1 - small) * (n + 0.5) / steps) ** 4
        ends = [f"d{n}", f"d{n + 1}"]
        if clamped:
            ends = ["ground" if end in ("d0", f"d{steps}") else end for end in ends]
        text += (
            f'[train.shafts.s{n}]\nbetween = ["{ends[0]}", "{ends[1]}"]\n'
            f"stiffness = {d4 * c * steps!r}\nown_inertia = {d4 / (c * steps)!r}\n"
        )
    inner = range(1, steps) if clamped else range(steps + 1)
    discs = "".join(f"d{n} = {{ inertia = 1e-13 }}\n" for n in inner)
    head = 'format = 1\nname = "Cone"\n[train]\ninertia = "distributed"\nmodes = 4\n[train.discs]\n'
    found = lw.free_vibration(lw.loads(head + discs + text)).natural_frequencies
    return [2 * math.pi * f for f in found.tolist() if f > 1.0][:3]


@pytest.mark.parametrize(
    ("taper", "printed", "clamped"),
    [(taper, row, False) for taper, row in FREE.items()]
    + [(taper, row, True) for taper, row in CLAMPED.items()],
)
def test_conic_shaft(taper: float, printed: tuple[float, ...], clamped: bool) -> None:
    coarse, fine = (frequencies(taper, steps, clamped=clamped) for steps in (24, 48))
    for a, b, wanted in zip(coarse, fine, printed, strict=True):
        # Steps err by the square of their length; without it the fourth power is left.
        limit = b + (b - a) / 3
        assert limit == pytest.approx(wanted, rel=2e-6 if taper < 0.02 else 3e-5)
        assert abs(b - wanted) < abs(a - wanted)
