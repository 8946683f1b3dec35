"""Published numbers of torsional trains, each to its printed digits."""

from __future__ import annotations

import pytest

import linkwright as lw

# Thomson, Theory of Vibration with Applications, 5th ed., example 12.4-1 (table 12.4-1): J = 5, 11, 22,
# K = 0.10·10⁶, 0.20·10⁶ in consistent units; ω [rad/s], θ₂, θ₃, T₁, T₂, T₃, T₃ being what is left over.
THOMSON = """
format = 1
name = "Three discs"
source = "Thomson, Theory of Vibration with Applications, example 12.4-1"
[train.discs]
one = { inertia = 5 }
two = { inertia = 11 }
three = { inertia = 22 }
[train.shafts]
first = { between = ["one", "two"], stiffness = 0.10e6 }
second = { between = ["two", "three"], stiffness = 0.20e6 }
"""

# Half a unit of the last printed digit of each number, as they are printed.
HALF_DIGITS = (0.0005, 0.0005, 50.0, 5.0, 10.0)


@pytest.mark.parametrize(
    ("omega", "printed"),
    [
        (20.0, (0.980, 0.9484, 2.0e3, 6.312e3, 14.66e3)),
        (40.0, (0.920, 0.799, 8.0e3, 24.19e3, 52.32e3)),
    ],
)
def test_holzer_table_of_thomson(omega: float, printed: tuple[float, ...]) -> None:
    found = lw.holzer_table(lw.loads(THOMSON), omega / (2 * 3.141592653589793))
    numbers = (*found.amplitude[1:], *found.shaft_torque, found.residual_torque)
    for number, wanted, half in zip(numbers, printed, HALF_DIGITS, strict=True):
        assert number == pytest.approx(wanted, abs=half)
