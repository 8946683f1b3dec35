"""The same trains in openTorsion: natural frequencies, and damped ones with their ratios."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sizes import cases

import linkwright as lw

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("opentorsion") is None, reason="openTorsion is not installed"
)

number = st.floats(0.1, 10.0)


@st.composite
def trees(draw: st.DrawFn) -> tuple[list[tuple[float, float]], list[tuple[int, int, float, float]]]:
    """Discs with inertia and damping; shafts between them, each disc on an earlier one."""
    n = draw(st.integers(2, 10))
    discs = [(draw(number), 0.05 * draw(number)) for _ in range(n)]
    shafts = [(draw(st.integers(0, j - 1)), j, 1e3 * draw(number), 0.05 * draw(number)) for j in range(1, n)]
    return discs, shafts


def ours(discs: list[tuple[float, float]], shafts: list[tuple[int, int, float, float]]) -> lw.Machine:
    train = {
        "discs": {f"d{n}": {"inertia": J, "damping": c} for n, (J, c) in enumerate(discs)},
        "shafts": {
            f"s{b}": {"between": [f"d{a}", f"d{b}"], "stiffness": k, "damping": c} for a, b, k, c in shafts
        },
    }
    return lw.Machine.model_validate({"format": 1, "name": "A train", "train": train})


@given(trees())
@settings(max_examples=cases(50, 500), deadline=None)
def test_frequencies_and_damping_agree(
    case: tuple[list[tuple[float, float]], list[tuple[int, int, float, float]]],
) -> None:
    from opentorsion import Assembly, Disk, Shaft

    discs, shafts = case
    theirs = Assembly(
        [Shaft(a, b, k=k, c=c) for a, b, k, c in shafts],
        disk_elements=[Disk(n, I=J, c=c) for n, (J, c) in enumerate(discs)],
    )
    square = np.sort(theirs.undamped_modal_analysis()[0].real)
    found = lw.free_vibration(ours(discs, shafts)).angular_frequencies
    # Rounding of a general solver, of the highest ω².
    assert found**2 == pytest.approx(square, rel=1e-9, abs=1e-11 * square[-1])
    _, omega_d, ratios = theirs.modal_analysis()
    mine = lw.damped_vibration(ours(discs, shafts))
    vibrating = mine.eigenvalues.imag > 0
    wanted = sorted(
        zip(
            omega_d[omega_d > 1e-6 * omega_d.max()].tolist(),
            ratios[omega_d > 1e-6 * omega_d.max()].tolist(),
            strict=True,
        )
    )
    both = sorted(
        zip(mine.eigenvalues.imag[vibrating].tolist(), mine.damping_ratios[vibrating].tolist(), strict=True)
    )
    assert np.array(both) == pytest.approx(np.array(wanted), rel=1e-6, abs=1e-7)
