"""Limit deviations of sizes up to 500 mm by the ISO code system: ``H7``, ``g6``, ``js9``.

A class is a letter, the deviation of the nearer limit from the nominal size, and a grade, the width of the
interval. Deviations of shafts are tabulated. A hole with clearance mirrors them, EI = −es. Another is so much
wider, ES = −ei + IT_n − IT_n−1, that a hole one grade coarser than its pin has the fit that both have by the
basis of the hole: H7/p6 as P7/h6.

References
----------
.. [1] ISO 286-1:2010, Geometrical product specifications, ISO code system for tolerances on linear sizes,
tables 1 to 5.
"""

from __future__ import annotations

import re
from bisect import bisect_left

# Upper ends of the ranges of nominal sizes [mm], each with its end.
_SIZES = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)

# Largest nominal size [mm].
GREATEST = _SIZES[-1]

# Standard tolerances by grade [µm], [1] table 1.
GRADES = {
    4: (3, 4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20),
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
    12: (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630),
    13: (140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970),
    14: (250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550),
}

# Upper deviations es of shafts above which nothing is [µm], [1] table 4.
BELOW = {
    "d": (-20, -30, -40, -50, -65, -80, -100, -120, -145, -170, -190, -210, -230),
    "e": (-14, -20, -25, -32, -40, -50, -60, -72, -85, -100, -110, -125, -135),
    "f": (-6, -10, -13, -16, -20, -25, -30, -36, -43, -50, -56, -62, -68),
    "g": (-2, -4, -5, -6, -7, -9, -10, -12, -14, -15, -17, -18, -20),
    "h": (0,) * len(_SIZES),
}

# Lower deviations ei of shafts [µm], [1] table 5; k holds for grades to 7, and is 0 beyond.
ABOVE = {
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
}

# Upper ends of the narrower ranges of press fits [mm], and lower deviations ei of their shafts [µm], [1]
# table 5.
_PRESS_SIZES = (
    *(3, 6, 10, 18, 30, 50, 65, 80, 100, 120, 140),
    *(160, 180, 200, 225, 250, 280, 315, 355, 400, 450, 500),
)
PRESSED = {
    "r": (
        *(10, 15, 19, 23, 28, 34, 41, 43, 51, 54, 63),
        *(65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132),
    ),
    "s": (
        *(14, 19, 23, 28, 35, 43, 53, 59, 71, 79, 92),
        *(100, 108, 122, 130, 140, 158, 170, 190, 208, 232, 252),
    ),
}

# Holes whose letters to these grades take what their pins lack; coarser ones have the deviation of the pin.
_FINE = {"K": 8, "M": 8, "N": 8, "P": 7, "R": 7, "S": 7}

# "H7", "25 H7", "25 mm H7": nominal size in mm, letter, grade.
CODE = re.compile(r"\s*(?:([\d.]++)(?:\s*+mm)?\s++)?([A-Za-z]{1,2})(\d{1,2})\s*")

# "25 H7/g6": nominal size in mm, hole, pin.
FIT = re.compile(r"\s*+([\d.]++)(?:\s*+mm)?\s++([A-Za-z]{1,2})(\d{1,2})\s*/\s*([A-Za-z]{1,2})(\d{1,2})\s*")

# What is known, for messages.
KNOWN = "d to h, js, k, m, n, p, r, s of shafts or D to H, JS, K, M, N, P, R, S of holes, with grades 5 to 14"


def deviations(size: float, letter: str, grade: int) -> tuple[float, float] | None:
    """Lower and upper deviation of a nominal `size` [m]; None of a class or size that is not known."""
    # Sizes belong to the range that they end, also when 18 mm is 17.999999999999996.
    millimetres = round(size * 1e3, 9)
    if not 5 <= grade <= max(GRADES) or not 0 < millimetres <= _SIZES[-1]:
        return None
    width = _width(millimetres, grade)
    limits = _limits(millimetres, letter, grade, width)
    return None if limits is None else (1e-6 * limits[0], 1e-6 * limits[1])


def _width(millimetres: float, grade: int) -> int:
    return GRADES[grade][bisect_left(_SIZES, millimetres)]


def _limits(millimetres: float, letter: str, grade: int, width: int) -> tuple[float, float] | None:
    if letter in ("js", "JS"):
        return -0.5 * width, 0.5 * width
    at = bisect_left(_SIZES, millimetres)
    if letter in BELOW:
        return BELOW[letter][at] - width, BELOW[letter][at]
    if letter.isupper() and letter.lower() in BELOW:
        return -BELOW[letter.lower()][at], width - BELOW[letter.lower()][at]
    if letter in _FINE:
        upper = _upper_of_hole(millimetres, letter, grade)
        return None if upper is None else (upper - width, upper)
    nearer = _lower_of_shaft(millimetres, letter, grade)
    return None if nearer is None else (nearer, nearer + width)


def _lower_of_shaft(millimetres: float, letter: str, grade: int) -> int | None:
    """Lower deviation ei of a shaft above the nominal size [µm]; None of another letter."""
    if letter in PRESSED:
        return PRESSED[letter][bisect_left(_PRESS_SIZES, millimetres)]
    if letter not in ABOVE:
        return None
    return ABOVE[letter][bisect_left(_SIZES, millimetres)] if letter != "k" or grade <= 7 else 0


def _upper_of_hole(millimetres: float, letter: str, grade: int) -> int | None:
    """Upper deviation ES of a hole that is made for no clearance [µm], [1] table 3; None where K ends."""
    is_small, is_fine = millimetres <= _SIZES[0], grade <= _FINE[letter]
    # By the deviation of k in its finer grades.
    nearer = _lower_of_shaft(millimetres, letter.lower(), 5)
    assert nearer is not None
    if is_small or not is_fine:
        if letter == "K" and not is_fine and not is_small:
            return None
        # Coarse holes N above 3 mm end at the nominal size.
        return 0 if letter == "N" and not is_small else -nearer
    if letter == "M" and grade == 6 and 250 < millimetres <= 315:
        return -9  # in place of −11
    return -nearer + _width(millimetres, grade) - _width(millimetres, grade - 1)
