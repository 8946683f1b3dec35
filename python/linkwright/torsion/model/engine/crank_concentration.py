r"""Stress concentration in the fillets and at the oil bore of a crank throw, by IACS UR M53.

With the diameter D of the crank pin and s = S/D, w = W/D, b = B/D, r = R_H/D (in the journal fillet R_G/D),
d_G = D_BG/D, d_H = D_BH/D, t = T/D, d_O = D_O/D, where S is the overlap of pin and journal,

.. math:: \alpha_B = 2.6914\, f(s,w)\, f(w)\, f(b)\, f(r)\, f(d_G)\, f(d_H)\, f_{rec}, \qquad
    \alpha_T = 0.8\, f(r,s)\, f(b)\, f(w)

in the crank pin fillet,

.. math:: \beta_B = 2.7146\, f_B(s,w)\, f_B(w)\, f_B(b)\, f_B(r)\, f_B(d_G)\, f_B(d_H)\, f_{rec}, \qquad
    \beta_Q = 3.0128\, f_Q(s)\, f_Q(w)\, f_Q(b)\, f_Q(r)\, f_Q(d_H)\, f_{rec}

in the journal fillet, with β_T as α_T for the radius of its fillet over the diameter of the journal, and

.. math:: \gamma_B = 3 - 5.88\, d_O + 34.6\, d_O^2, \qquad \gamma_T = 4 - 6\, d_O + 30\, d_O^2

at the outlet of the oil bore. They hold for 0.2 ≤ w ≤ 0.8, 1.1 ≤ b ≤ 2.2, 0.03 ≤ r ≤ 0.13,
0 ≤ d_G, d_H ≤ 0.8, d_O ≤ 0.2 and s ≤ 0.5. Below s = −0.5 that value takes its place in f(s, w) and
f(r, s); a recess counts where it raises the stress.

References
----------
.. [1] IACS, UR M53 Calculation of Crankshafts for I.C. Engines, Rev. 2, 2011, M53.3: concentration factors.
"""

from __future__ import annotations

from typing import NamedTuple

# Minimum overlap that the formulas count with.
_OVERLAP_MIN = -0.5

# Where the formulas hold: minimum and maximum of each ratio.
RANGES: dict[str, tuple[float, float]] = {
    "s": (float("-inf"), 0.5),
    "w": (0.2, 0.8),
    "b": (1.1, 2.2),
    "r": (0.03, 0.13),
    "r_G": (0.03, 0.13),
    "d_G": (0.0, 0.8),
    "d_H": (0.0, 0.8),
    "d_O": (0.0, 0.2),
}


class ThrowRatios(NamedTuple):
    """Sizes of a throw over the diameter of its crank pin."""

    s: float  # overlap of pin and journal
    w: float  # thickness of the web
    b: float  # width of the web
    r: float  # radius of the fillet of the pin
    r_G: float  # radius of the fillet of the journal
    r_T: float  # the same over the diameter of the journal
    d_G: float  # bore of the journal
    d_H: float  # bore of the pin
    t: float  # recesses of both fillets together
    d_O: float | None  # oil bore

    @property
    def outside(self) -> tuple[str, ...]:
        """Names of the ratios for which the formulas are not made."""
        values = {name: getattr(self, name) for name in RANGES}
        return tuple(
            name
            for name, value in values.items()
            if value is not None and not RANGES[name][0] <= value <= RANGES[name][1]
        )

    @property
    def overlap(self) -> float:
        """Overlap that the formulas count with."""
        return max(self.s, _OVERLAP_MIN)

    @property
    def recess(self) -> float:
        """Factor of the recesses."""
        return max(1.0, 1.0 + self.t * (1.8 + 3.2 * self.s))


def _sum(x: float, *factors: float) -> float:
    """Value of a polynomial by its coefficients, the constant first."""
    return float(sum(factor * x**n for n, factor in enumerate(factors)))


def pin_bending(ratios: ThrowRatios) -> float:
    """α_B of the crank pin fillet."""
    w, u = ratios.w, 1.0 - ratios.overlap
    of_overlap = (
        _sum(w, -4.1883, 29.2004, -77.5925, 91.9454, -40.0416)
        + u * _sum(w, 9.5440, -58.3480, 159.3415, -192.5846, 85.2916)
        + u**2 * _sum(w, -3.8399, 25.0444, -70.5571, 87.0328, -39.1832)
    )
    return float(
        2.6914
        * of_overlap
        * (2.1790 * w**0.7171)
        * _sum(ratios.b, 0.6840, -0.0077, 0.1473)
        * (0.2081 * ratios.r**-0.5231)
        * _sum(ratios.d_G, 0.9993, 0.27, -1.0211, 0.5306)
        * _sum(ratios.d_H, 0.9978, 0.3145, -1.5241, 2.4147)
        * ratios.recess
    )


def torsion(ratios: ThrowRatios, radius: float) -> float:
    """α_T or β_T. `radius`: of the fillet, over the diameter of the pin or of the journal."""
    of_radius = radius ** (-0.322 + 0.1015 * (1.0 - ratios.overlap))
    return float(0.8 * of_radius * _sum(ratios.b, 7.8955, -10.654, 5.3482, -0.857) * ratios.w**-0.145)


def journal_bending(ratios: ThrowRatios) -> float:
    """β_B of the journal fillet."""
    w, u = ratios.w, 1.0 - ratios.overlap
    of_overlap = (
        _sum(w, -1.7625, 2.9821, -1.5276)
        + u * _sum(w, 5.1169, -5.8089, 3.1391)
        + u**2 * _sum(w, -2.1567, 2.3297, -1.2952)
    )
    return float(
        2.7146
        * of_overlap
        * (2.2422 * w**0.7548)
        * _sum(ratios.b, 0.5616, 0.1197, 0.1176)
        * (0.1908 * ratios.r_G**-0.5568)
        * _sum(ratios.d_G, 1.0012, -0.6441, 1.2265)
        * _sum(ratios.d_H, 1.0022, -0.1903, 0.0073)
        * ratios.recess
    )


def journal_shear(ratios: ThrowRatios) -> float:
    """β_Q of the journal fillet, for radial forces."""
    w, u = ratios.w, 1.0 - ratios.overlap
    return float(
        3.0128
        * _sum(u, 0.4368, 2.1630, -1.5212)
        * (w / (0.0637 + 0.9369 * w))
        * (ratios.b - 0.5)
        * (0.5331 * ratios.r_G**-0.2038)
        * _sum(ratios.d_H, 0.9937, -1.1949, 1.7373)
        * ratios.recess
    )


def bore_bending(bore: float) -> float:
    """γ_B of the oil bore. `bore`: d_O."""
    return _sum(bore, 3.0, -5.88, 34.6)


def bore_torsion(bore: float) -> float:
    """γ_T of the oil bore. `bore`: d_O."""
    return _sum(bore, 4.0, -6.0, 30.0)
