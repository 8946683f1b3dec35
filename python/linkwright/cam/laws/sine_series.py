r"""Laws of a straight line and a few sines: cycloidal, Gutman, Freudenstein.

.. math:: f(z) = z - \frac{1}{2\pi} \sum_n b_n \sin 2\pi n z

Gutman cuts the Fourier series of the parabola after its third harmonic. Freudenstein chooses the amplitudes
so that the peak of the acceleration is small for the harmonics that are allowed.

Source: cycloidal: Bestehorn (1919), VDI 2143 Blatt 1 (1980), "Sinuslinie"; Gutman, "To avoid vibration try
this new cam profile", *Product Engineering* 32 (1961); Freudenstein, "On the dynamics of high-speed cam
profiles", *Int. J. Mech. Sci.* 1 (1960) 342–349; the latter two as printed in Rothbart (ed.), *Cam Design
Handbook* (2004), section 4, equations (4.12), (4.13).
"""

from __future__ import annotations

from math import pi

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Harmonic, Piece


def cycloidal() -> MotionLaw:
    """f = z − sin(2πz)/2π, Bestehorn's law: the acceleration is one sine."""
    return _series({1: 1.0})


def gutman_1_3() -> MotionLaw:
    """f = z − (15 sin 2πz)/(32π) − (sin 6πz)/(96π): the parabola's first and third harmonic."""
    return _series({1: 15 / 16, 3: 1 / 48})


def freudenstein_1_3() -> MotionLaw:
    """f = z − (27/28 sin 2πz + 1/84 sin 6πz)/2π."""
    return _series({1: 27 / 28, 3: 1 / 84})


def freudenstein_1_3_5() -> MotionLaw:
    """f = z − m (sin 2πz + sin(6πz)/54 + sin(10πz)/1250)/2π, m = 1125/1192."""
    m = 1125 / 1192
    return _series({1: m, 3: m / 54, 5: m / 1250})


def _series(amplitudes: dict[int, float]) -> MotionLaw:
    """The law with amplitudes b_n by n."""
    waves = tuple(Harmonic(2 * pi * n, 0.0, -b / (2 * pi)) for n, b in amplitudes.items())
    return MotionLaw((0.0, 1.0), (Piece((0.0, 1.0), waves),))
