"""What a synthesis returns is what was asked for when its machine is analysed again, or it is a finding."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import AssemblyError, SynthesisError, crank_rocker, slider_crank
from linkwright.synthesis import verification

# Rounding of dead centres that are found by their zeros, in linkages whose links are up to a thousand times
# as long as one another.
CLOSE = 1e-6


def test_crank_rockers_of_all_kinds() -> None:
    """Swings up to half a revolution, dense at the ends; time ratios near 1 and far from it; any coupler."""
    rng = np.random.default_rng(5)
    made = 0
    for k in range(90):
        swing = np.radians(rng.uniform(*((0.01, 180), (0.01, 3), (170, 180))[k % 3]))
        ratio = (1.0, rng.uniform(0.3, 3), 1 + 10 ** rng.uniform(-9, -2))[k // 3 % 3]
        try:
            found = crank_rocker(swing, ratio, coupler_max=10 ** rng.uniform(0, 3))
        except (SynthesisError, AssemblyError):
            # No such linkage, or one so near to a change point that its lengths do not tell how it goes on.
            continue
        made += 1
        element = next(each for each in lw.linkage(found.machine).elements if each.output == "B.rocker")
        assert element.swing == pytest.approx(swing, rel=CLOSE)
        assert (element.time_ratio or 1.0) == pytest.approx(max(ratio, 1 / ratio), rel=CLOSE)
        assert min(found.crank, found.coupler, found.rocker) > 0
    assert made > 60


def test_slider_cranks_of_all_sizes() -> None:
    rng = np.random.default_rng(6)
    made = 0
    for k in range(90):
        stroke = 10 ** rng.uniform(-4, 4)
        ratio = (1.0, rng.uniform(0.3, 3), 1 + 10 ** rng.uniform(-9, -2))[k % 3]
        try:
            found = slider_crank(stroke, ratio, rod=stroke * 10 ** rng.uniform(-0.3, 2))
        except SynthesisError:
            continue
        made += 1
        (element,) = lw.linkage(found.machine).elements
        assert element.stroke == pytest.approx(stroke, rel=CLOSE)
        assert (element.time_ratio or 1.0) == pytest.approx(max(ratio, 1 / ratio), rel=CLOSE)
    assert made > 30


@pytest.mark.parametrize(
    "make", [lambda: crank_rocker(1.0, 1.2), lambda: slider_crank(0.1, 1.2)], ids=["rocker", "slider"]
)
def test_a_linkage_that_misses_is_a_finding(make: object, monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine that is not the one of the formulas is refused with both numbers."""
    analysed = verification.linkage

    def off(machine: lw.Machine) -> object:
        crank = machine.mechanism.cranks["A"].radius
        return analysed(lw.replace(machine, {"mechanism.cranks.A.radius": crank * (1 + 1e-4)}))

    monkeypatch.setattr(verification, "linkage", off)
    with pytest.raises(SynthesisError, match=r"made for a (swing|stroke) of .* when it is analysed again"):
        make()  # type: ignore[operator]
    with pytest.raises(SynthesisError, match="has none"):
        verification.require_met("a stroke", 1.0, None, "m")
    with pytest.raises(SynthesisError, match="nan m"):
        verification.require_met("a stroke", 1.0, float("nan"), "m")
