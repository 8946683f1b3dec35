"""Classes of ISO 286: the tables against the formulas they are rounded from, printed limits, and refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError
from linkwright.machine import iso286

# Geometric means of the ends of the ranges [mm]; the first is counted from 1 mm.
_MEANS = np.sqrt(np.array([1, 3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400]) * np.array(iso286._SIZES))

# Standard tolerances are 7, 10, 16, … times i = 0.45 ∛D + 0.001 D [µm], ISO 286-1:1988, annex A.
# Grade 4 lies between 1, 0.8 + 0.02 D, and 5 in a geometric series.
_TIMES = {5: 7, 6: 10, 7: 16, 8: 25, 9: 40, 10: 64, 11: 100, 12: 160, 13: 250, 14: 400}


def test_grades_are_those_of_the_formula() -> None:
    """But for roundings, a tenth where numbers have one or two digits; to 3 mm there is more."""
    i = 0.45 * np.cbrt(_MEANS) + 0.001 * _MEANS
    for grade, times in _TIMES.items():
        assert np.array(iso286.GRADES[grade])[1:] == pytest.approx(times * i[1:], rel=0.1, abs=0.6), grade
    first = 0.8 + 0.02 * _MEANS
    four = first * (7 * i / first) ** 0.75
    assert np.array(iso286.GRADES[4])[1:] == pytest.approx(four[1:], rel=0.1, abs=0.8)


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
        (25, "r6", (28, 41)),
        (60, "s6", (53, 72)),
        (70, "s6", (59, 78)),
        (25, "K7", (-15, 6)),
        (25, "M7", (-21, 0)),
        (25, "M8", (-29, 4)),
        (25, "M9", (-60, -8)),
        (300, "M6", (-41, -9)),
        (25, "N7", (-28, -7)),
        (25, "N9", (-52, 0)),
        (2, "N9", (-29, -4)),
        (2, "N7", (-14, -4)),
        (25, "P7", (-35, -14)),
        (25, "P9", (-74, -22)),
        (100, "R7", (-73, -38)),
        (100, "S7", (-93, -58)),
    ],
)
def test_printed_limits(size: float, code: str, limits: tuple[float, float]) -> None:
    found = iso286.deviations(size * 1e-3, code[:-1], int(code[-1]))
    assert found == pytest.approx(tuple(1e-6 * each for each in limits), abs=1e-15)


@pytest.mark.parametrize("grade", [6, 7, 8])
def test_a_fit_by_the_basis_of_the_shaft_is_that_by_the_hole(grade: int) -> None:
    """Maximum and minimum interference of H7/p6 and P7/h6 are the same, for every size above 3 mm."""

    def interference(hole: str, pin: str, size: float) -> tuple[float, float]:
        of_hole = iso286.deviations(size, hole, grade)
        of_pin = iso286.deviations(size, pin, grade - 1)
        assert of_hole is not None
        assert of_pin is not None
        return of_pin[1] - of_hole[0], of_pin[0] - of_hole[1]

    for letter in "kmn" if grade == 8 else "kmnprs":
        for size in 1e-3 * np.array([4, 8, 15, 20, 40, 60, 70, 110, 150, 170, 220, 245, 260, 380, 420, 480]):
            # M6 of 250 to 315 mm is the exception of the standard.
            if (letter, grade) == ("m", 6) and 0.25 < size <= 0.315:
                continue
            assert interference(letter.upper(), "h", size) == pytest.approx(
                interference("H", letter, size), abs=1e-12
            )


def test_r_and_s_follow_from_formulas() -> None:
    """s: IT8 and 1 to 4 µm to 50 mm, IT7 and 0.4 D beyond; r: the geometric mean of p and s."""
    ends = np.array([3, *iso286._PRESS_SIZES[1:]])
    lower = np.array([1, *iso286._PRESS_SIZES[:-1]])
    means = np.sqrt(ends * lower)
    seven, eight = (np.array([iso286._width(end, grade) for end in ends]) for grade in (7, 8))
    s = np.where(ends <= 50, eight + 2, seven + 0.4 * means)
    assert np.array(iso286.PRESSED["s"]) == pytest.approx(s, rel=0.04, abs=2.5)
    p = np.array([iso286._lower_of_shaft(float(end), "p", 6) for end in ends])
    assert np.array(iso286.PRESSED["r"]) == pytest.approx(np.sqrt(p * iso286.PRESSED["s"]), rel=0.03, abs=1.0)


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
    with pytest.raises(InputError, match="to 500 mm"):
        axis("H7", "mechanism.sliders.cart1.rod")
    with pytest.raises(InputError, match="classes are of lengths"):
        axis("H7", "bodies.cart1.mass")
