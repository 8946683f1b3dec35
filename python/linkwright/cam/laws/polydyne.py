r"""The lift that moves an elastic follower exactly by a wanted law at one speed.

For one mass on a train of stiffness k without damper of its own, with a closing spring k_r and a damper to
the frame,

.. math:: s = \frac1\kappa\left(x + 2\zeta_f\frac{\omega}{\Omega}\,x' + \frac{\omega^2}{\Omega^2}\,x''\right),
    \qquad \kappa = \frac{k}{k + k_r}, \qquad \Omega^2 = \frac{k + k_r}{m}

Source: W. M. Dudley, *New methods in valve cam design*, SAE Quarterly Transactions 2, 1948, 19–33;
D. A. Stoddart, *Polydyne cam design*, Machine Design 25, 1953.
"""

from __future__ import annotations

from linkwright.cam.laws.motion_law import MotionLaw, combined


def polydyne_correction(wanted: MotionLaw, slow: float, damping_ratio: float) -> MotionLaw:
    """What the lift is more than the wanted motion, both at the mass: κs − x.

    Parameters
    ----------
    wanted : MotionLaw
        x over the cam angle [m over rad].
    slow : float
        ω/Ω, speed of the cam over the natural frequency [–].
    damping_ratio : float
        ζ_f of the damper to the frame [–].

    Returns
    -------
    MotionLaw
        Over the cam angle [m over rad].
    """
    return combined((2 * damping_ratio * slow, wanted.derivative(1)), (slow**2, wanted.derivative(2)))


def polydyne_lift(wanted: MotionLaw, slow: float, damping_ratio: float, share: float) -> MotionLaw:
    """The lift.

    Parameters
    ----------
    wanted : MotionLaw
        x over the cam angle [m over rad].
    slow : float
        ω/Ω, speed of the cam over the natural frequency [–].
    damping_ratio : float
        ζ_f of the damper to the frame [–].
    share : float
        κ = k/(k + k_r) [–].

    Returns
    -------
    MotionLaw
        s over the cam angle [m over rad].
    """
    correction = polydyne_correction(wanted, slow, damping_ratio)
    return combined((1.0, wanted), (1.0, correction)).scaled(1 / share)
