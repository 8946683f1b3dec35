"""Classes of ISO 286: the tables against the formulas they are rounded from, printed limits, and refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.errors import InputError
from linkwright.studies import iso286

# Geometric means of the ends of the ranges [mm]; the first is counted from 1 mm.
_MEANS = np.sqrt(np.array([1, 3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400]) * np.array(iso286._SIZES))

# Standard tolerances are 7, 10, 16, … times i = 0.45 ∛D + 0.001 D [µm], ISO 286-1:1988, annex A.
_TIMES = {5: 7, 6: 10, 7: 16, 8: 25, 9: 40, 10: 64, 11: 100, 12: 160, 13: 250, 14: 400}


def test_grades_are_those_of_the_formula() -> None:
    """But for roundings, a tenth where numbers have one or two digits; to 3 mm there is more."""
    i = 0.45 * np.cbrt(_MEANS) + 0.001 * _MEANS
    for grade, row in iso286.GRADES.items():
        assert np.array(row)[1:] == pytest.approx(_TIMES[grade] * i[1:], rel=0.1, abs=0.6), grade


@pytest.mark.parametrize(
    ("letter", "formula"),
    [
        ("d", -16 * _MEANS**0.44),
        ("e", -11 * _MEANS**0.41),
        ("f", -5.5 * _MEANS**0.41),
        ("g", -2.5 * _MEANS**0.34),
        ("k", 0.6 * np.cbrt(_MEANS)),
        ("n", 5 * _MEANS**0.34),
    ],
)
def test_deviations_are_those_of_the_formulas(letter: str, formula: np.ndarray) -> None:
    row = (iso286.BELOW | iso286.ABOVE)[letter]
    assert np.array(row)[1:] == pytest.approx(formula[1:], rel=0.06, abs=1.3)


def test_m_and_p_follow_from_grades() -> None:
    """m: IT7 − IT6; p: IT7 and 0 to 5 µm."""
    six, seven = (np.array(iso286.GRADES[grade]) for grade in (6, 7))
    assert np.abs(np.array(iso286.ABOVE["m"]) - (seven - six)).max() <= 2.0
    beyond = np.array(iso286.ABOVE["p"])[1:] - seven[1:]
    assert ((beyond >= 0) & (beyond <= 5)).all()


@pytest.mark.parametrize(
    ("size", "code", "limits"),
    [
        # Limit deviations as handbooks print them [µm].
        (25, "H7", (0, 21)),
        (25, "g6", (-20, -7)),
        (18, "H8", (0, 27)),
        (18.001, "H8", (0, 33)),
        (40, "p6", (26, 42)),
        (40, "k6", (2, 18)),
        (40, "k8", (0, 39)),
        (100, "F8", (36, 90)),
        (100, "js7", (-17.5, 17.5)),
    ],
)
def test_printed_limits(size: float, code: str, limits: tuple[float, float]) -> None:
    found = iso286.deviations(size * 1e-3, code[:-1], int(code[-1]))
    assert found == pytest.approx(tuple(1e-6 * each for each in limits), abs=1e-15)


TEXT = """
machine = "roller_two_carts"
[variables.a]
address = "{address}"
tolerance = "{text}"
[responses]
delta = "steady_state.unevenness"
"""


def test_in_a_study(tmp_path: Path) -> None:
    def axis(text: str, address: str = "mechanism.cranks.A1.radius"):
        (tmp_path / "study.toml").write_text(TEXT.format(text=text, address=address))
        return lw.read_study(tmp_path / "study.toml").axes[0]

    for text in ("200 H7", "H7", "200 mm H7"):
        assert (axis(text).low, axis(text).high) == pytest.approx((0.2, 0.200046), abs=1e-15)
    for text, words in (("25 H7", "200 mm"), ("Z7", "D to H"), ("H99", "grades"), ("H7 mm", "such as")):
        with pytest.raises(InputError, match=words):
            axis(text)
    with pytest.raises(InputError, match="beyond 500 mm"):
        axis("H7", "mechanism.sliders.cart1.rod")
    with pytest.raises(InputError, match="classes are of lengths"):
        axis("H7", "bodies.cart1.mass")
