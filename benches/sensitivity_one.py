"""How long do the derivatives of all results of a drive by all entries of its file take, on one thread?"""

from __future__ import annotations

import machines
from common import Row, seconds

import linkwright as lw

# Relative step of differences, and how far they may be off: their error is of its square.
_STEP, _AGREE = 1e-5, 1e-6

_ANALYSES = ["steady_state", "forces"]
_RESPONSE, _ENTRY = "forces.reaction_max.A1", "mechanism.sliders.cart1.rod"


def rows(quick: bool) -> list[Row]:
    """Those of the drive with two carts: steady motion, with forces, and with run-up and run-down."""
    machine = machines.two_carts()
    agree(machine)
    found = []
    for words, analyses, target in (
        ("steady motion", _ANALYSES[:1], None),
        ("steady motion and forces", _ANALYSES, 20.0),
        ("with run-up and run-down", [*_ANALYSES, "run_up", "run_down"], None),
    ):
        # A copy is a machine of which nothing is known yet.
        act = lambda analyses=analyses: lw.gradient(machine.model_copy(), analyses)  # noqa: E731
        gradient, time = act(), seconds([act], repeats=5 if quick else 31)[0]
        n, m = gradient.derivatives.shape
        note = f"{n} results by {m} entries, {', '.join(analyses)}"
        found.append(Row(f"derivatives, {words}", "ms", 1e3 * time, target=target, aim="at most", note=note))
    return found


def agree(machine: lw.Machine) -> None:
    """Stop where a derivative is not that of differences."""
    exact = lw.gradient(machine, [_RESPONSE], [_ENTRY])
    rod = float(exact.at[0])

    def peak(length: float) -> float:
        return lw.forces(lw.replace(machine, {_ENTRY: length})).reaction_max["A1"]

    h = _STEP * rod
    slope = (peak(rod + h) - peak(rod - h)) / (2 * h)
    off = abs(slope / float(exact.derivatives[0, 0]) - 1)
    assert off < _AGREE, f"the derivative of {_RESPONSE} by {_ENTRY} is {off:g} off that of differences"
