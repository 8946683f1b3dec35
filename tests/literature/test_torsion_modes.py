"""Published natural frequencies and damped modes of trains, each to its printed digits."""

from __future__ import annotations

import cmath
import math

import pytest

import linkwright as lw

# Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines, 2010, chapter 9, as openTorsion's own tests
# quote it (github.com/Aalto-Arotor/openTorsion, tests.py): natural frequencies in Hz.
FRISWELL = {
    # Example 9.7.1: three cylinders, flywheel and load.
    "9.7.1": (
        """
        format = 1
        name = "Engine with flywheel and load"
        [train.discs]
        one = { inertia = 3.5e-3 }
        two = { inertia = 3.5e-3 }
        three = { inertia = 3.5e-3 }
        flywheel = { inertia = 0.15 }
        load = { inertia = 0.05 }
        [train.shafts]
        a = { between = ["one", "two"], stiffness = 12e3 }
        b = { between = ["two", "three"], stiffness = 12e3 }
        c = { between = ["three", "flywheel"], stiffness = 14e3 }
        d = { between = ["flywheel", "load"], stiffness = 10e3 }
        """,
        (0.0, 81.21, 141.21, 378.95, 536.36),
        0.005,
    ),
    # Two rotors behind two pinions that mesh, driven through a shaft.
    "geared rotors": (
        """
        format = 1
        name = "Two geared rotors and a motor"
        [train.discs]
        motor = { inertia = 400e-6 }
        first = { inertia = 25e-6 }
        second = { inertia = 25e-6 }
        left = { inertia = 700e-6 }
        right = { inertia = 700e-6 }
        [train.shafts]
        motor_shaft = { between = ["motor", "first"], stiffness = 10000 }
        left_shaft = { between = ["second", "left"], stiffness = 5000 }
        right_shaft = { between = ["first", "right"], stiffness = 5000 }
        [train.gears]
        mesh = { between = ["first", "second"], ratio = 1 }
        """,
        (0.0, 425.4, 634.1, 3247.2),
        0.05,
    ),
    # Example 9.6.3: one shaft drives two others through two pairs of wheels of radii 0.5 m and 0.8 m.
    "9.6.3": (
        """
        format = 1
        name = "Branched train"
        [train.discs]
        drive = { inertia = 3200 }
        pinion = { inertia = 200 }
        idler = { inertia = 200 }
        left_wheel = { inertia = 800 }
        right_wheel = { inertia = 800 }
        left = { inertia = 450 }
        right = { inertia = 450 }
        [train.shafts.input]
        between = ["drive", "pinion"]
        sections = [{ length = 2.5, diameter = 0.2 }]
        shear_modulus = 68e9
        [train.shafts.left_shaft]
        between = ["left_wheel", "left"]
        sections = [{ length = 3.5, diameter = 0.25 }]
        shear_modulus = 68e9
        [train.shafts.right_shaft]
        between = ["right_wheel", "right"]
        sections = [{ length = 3.5, diameter = 0.25 }]
        shear_modulus = 68e9
        [train.gears]
        across = { between = ["pinion", "idler"], ratio = 1 }
        to_left = { between = ["pinion", "left_wheel"], ratio = 1.6 }
        to_right = { between = ["idler", "right_wheel"], ratio = 1.6 }
        """,
        (0.0, 10.304, 20.479, 24.423),
        0.0005,
    ),
}


@pytest.mark.parametrize("name", FRISWELL)
def test_natural_frequencies_of_friswell(name: str) -> None:
    text, printed, half = FRISWELL[name]
    found = lw.free_vibration(lw.loads(text)).natural_frequencies
    assert found == pytest.approx(printed, abs=half)


# Ewins, Modal Testing: Theory, Practice and Application, 2nd ed. 2000, chapter 2, the model of three masses
# 0.5, 1.0, 1.5 kg, each tied to the ground and to both others by 1000 N/m; hysteresis of 0.3 in the first
# spring alone. Here they are discs.
EWINS = """
format = 1
name = "Three masses"
[train.discs]
one = { inertia = 0.5 }
two = { inertia = 1.0 }
three = { inertia = 1.5 }
[train.shafts]
ground_one = { between = ["ground", "one"], stiffness = 1000, loss_factor = 0.3 }
ground_two = { between = ["ground", "two"], stiffness = 1000 }
ground_three = { between = ["ground", "three"], stiffness = 1000 }
one_two = { between = ["one", "two"], stiffness = 1000 }
two_three = { between = ["two", "three"], stiffness = 1000 }
three_one = { between = ["three", "one"], stiffness = 1000 }
"""

# Mass-normalised shapes, amplitude and phase in degrees, a row a mass, a column a mode.
SHAPES = (
    ((0.463, -5.5), (0.217, 173), (1.321, 181)),
    ((0.537, 0), (0.784, 181), (0.316, -6.7)),
    ((0.636, 1.0), (0.492, -1.3), (0.142, -3.1)),
)


def test_complex_modes_of_ewins() -> None:
    found = lw.damped_vibration(lw.loads(EWINS))
    square = (-(found.eigenvalues**2)).tolist()
    # λ² (1 + iη) as printed of those that are: 3354, 6690; η₁ = 0.067, η₃ = 0.078.
    assert square[1].real == pytest.approx(3354, abs=0.5)
    assert square[2].real == pytest.approx(6690, abs=0.5)
    assert square[0].imag / square[0].real == pytest.approx(0.067, abs=0.0005)
    assert square[2].imag / square[2].real == pytest.approx(0.078, abs=0.0005)
    for mode, shape in enumerate(found.mode_shapes.tolist()):
        mass = cmath.sqrt(sum(J * q * q for J, q in zip((0.5, 1.0, 1.5), shape, strict=True)))
        unit = [q / mass for q in shape]
        printed = [row[mode] for row in SHAPES]
        assert [abs(q) for q in unit] == pytest.approx([size for size, _ in printed], abs=0.0005)
        # Which way round a shape is printed has no meaning: by the first.
        turned = [math.degrees(cmath.phase(q)) for q in unit]
        whole = 180 * round((printed[0][1] - turned[0]) / 180)
        for (_, phase), own in zip(printed, turned, strict=True):
            off = (own + whole - phase + 180) % 360 - 180
            # Half a unit of the last digit: some are printed to a degree.
            assert off == pytest.approx(0, abs=0.05 if phase != round(phase) or abs(phase) == 1.0 else 0.5)
