r"""Laws in closed form: parabola, harmonics, sine series, modified sine and trapezoid.

Most are given by the course of their acceleration, which is integrated twice and brought to a lift of one
over a length of one; only its shape counts.

Constant velocity, and the parabola of constant acceleration; simple and double harmonic, with accelerations
of one and of two cosines. Source: VDI 2143 Blatt 1 (1980), "einfache Sinoide"; Rothbart (ed.), *Cam Design
Handbook* (2004), chapter 2.

Laws of a straight line and a few sines: cycloidal, Gutman, Freudenstein.

.. math:: f(z) = z - \frac{1}{2\pi} \sum_n b_n \sin 2\pi n z

Gutman cuts the Fourier series of the parabola after its third harmonic. Freudenstein chooses the amplitudes
so that the peak of the acceleration is small for the harmonics that are allowed.

Source: cycloidal: Bestehorn (1919), VDI 2143 Blatt 1 (1980), "Sinuslinie"; Gutman, "To avoid vibration try
this new cam profile", *Product Engineering* 32 (1961); Freudenstein, "On the dynamics of high-speed cam
profiles", *Int. J. Mech. Sci.* 1 (1960) 342–349; the latter two as printed in Rothbart (ed.), *Cam Design
Handbook* (2004), section 4, equations (4.12), (4.13).

Modified sine: the acceleration is a slow cosine between two quick quarter sines. Modified trapezoid: constant
acceleration with ramps of quarter sines.

Source: Neklutin, *Mechanisms and Cams for Automatic Machines* (1969); VDI 2143 Blatt 1 (1980), "modifizierte
Sinuslinie", "modifiziertes Beschleunigungstrapez"; Norton, *Cam Design and Manufacturing Handbook* (2002).
"""

from __future__ import annotations

from math import pi

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Harmonic, Piece


def rest_to_rest(*stretches: tuple[float, Piece]) -> MotionLaw:
    """The law f(z), z and f from 0 to 1."""
    law = MotionLaw.of(0.0, *stretches).integral().integral().placed(0.0, 1.0)
    return law.scaled(1 / law.value(1.0))


def constant_velocity() -> MotionLaw:
    """The straight line f = z: the minimum velocity, which jumps at both ends."""
    return MotionLaw((0.0, 1.0), (Piece((0.0, 1.0)),))


def parabolic() -> MotionLaw:
    """f = 2 z² up to the middle, its mirror image from there: the minimum acceleration, which jumps."""
    return MotionLaw((0.0, 0.5, 1.0), (Piece((0.0, 0.0, 0.5)), Piece((0.5, 1.0, -0.5))))


def harmonic() -> MotionLaw:
    """f = (1 − cos πz)/2, the motion of a Scotch yoke; its acceleration jumps at both ends."""
    return MotionLaw((0.0, 1.0), (Piece((0.5,), (Harmonic(pi, -0.5, 0.0),)),))


def double_harmonic() -> MotionLaw:
    """f = (1 − cos πz)/2 − (1 − cos 2πz)/8: soft at its start, with a jump of the acceleration at its end."""
    waves = (Harmonic(pi, -0.5, 0.0), Harmonic(2 * pi, 0.125, 0.0))
    return MotionLaw((0.0, 1.0), (Piece((0.375,), waves),))


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
    waves = tuple(Harmonic(2 * pi * n, 0.0, -b / (2 * pi)) for n, b in amplitudes.items())
    return MotionLaw((0.0, 1.0), (Piece((0.0, 1.0), waves),))


def modified_sine(share: float = 1 / 8) -> MotionLaw:
    """Modified sine."""
    return rest_to_rest(
        (share, Piece((), (Harmonic(pi / 2, 0.0, 1.0),))),
        (1 - 2 * share, Piece((), (Harmonic(pi, 1.0, 0.0),))),
        (share, Piece((), (Harmonic(pi / 2, -1.0, 0.0),))),
    )


def modified_trapezoid(share: float = 1 / 8) -> MotionLaw:
    """Modified trapezoid."""
    flat = 0.5 - 2 * share
    up, down = Harmonic(pi / 2, 0.0, 1.0), Harmonic(pi / 2, 1.0, 0.0)
    return rest_to_rest(
        (share, Piece((), (up,))),
        (flat, Piece((1.0,))),
        (2 * share, Piece((), (Harmonic(pi, 1.0, 0.0),))),
        (flat, Piece((-1.0,))),
        (share, Piece((), (down._replace(cosine=-1.0),))),
    )
