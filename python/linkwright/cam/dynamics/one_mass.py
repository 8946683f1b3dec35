r"""The follower train as one mass on one stiffness, driven by the lift of the cam.

.. math:: m\ddot x = k(s - x) + c(\dot s - \dot x) - k_r x - c_f\dot x

x is the place of the mass, s the lift; both count from the rest at no lift, where the closing spring presses
with its preload F₀. k and c are those of the train between cam and mass, k_r that of the closing spring, c_f
a damper between mass and frame. The train presses on the cam with

.. math:: F = F_0 + k(s - x) + c(\dot s - \dot x)

Source: M. P. Koster, *Vibrations of Cam Mechanisms*, Macmillan 1974, chapter 2; R. L. Norton, *Cam Design and
Manufacturing Handbook*, Industrial Press, chapters 8 and 10.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from linkwright.cam.model.follower_motion import FollowerTrain
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public_type
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import FORCE, MASS, RATIO, STIFFNESS
from linkwright.kernel.units.marks import Quantity, not_negative, positive


@public_type
@dataclass(frozen=True, slots=True)
class OneMass:
    """One mass on the stiffness of the follower train.

    Attributes
    ----------
    mass : float
        m, of all that moves, reduced to the follower [kg].
    stiffness : float
        k, of the train between cam and mass [N/m].
    damping_ratio : float
        ζ of the damper in the train, c = 2ζΩm [–].
    damping_ratio_frame : float
        ζ_f of the damper to the frame, c_f = 2ζ_f Ω m [–].
    spring_rate : float
        k_r of the closing spring [N/m].
    preload : float
        F₀ of the closing spring at no lift [N].
    """

    mass: float
    stiffness: float
    damping_ratio: float = 0.0
    damping_ratio_frame: float = 0.0
    spring_rate: float = 0.0
    preload: float = 0.0

    def __post_init__(self) -> None:
        """Refuse numbers that make no oscillator."""
        in_range(
            mass=(self.mass, positive(MASS)),
            stiffness=(self.stiffness, positive(STIFFNESS)),
            damping_ratio=(self.damping_ratio, not_negative(RATIO)),
            damping_ratio_frame=(self.damping_ratio_frame, not_negative(RATIO)),
            spring_rate=(self.spring_rate, not_negative(STIFFNESS)),
            preload=(self.preload, Quantity(FORCE)),
        )
        if self.damping_ratio_all >= 1:
            raise InputError(
                f"damping_ratio and damping_ratio_frame: found {self.damping_ratio_all:g} together, "
                "expected less than 1; a follower with more damping does not vibrate"
            )

    @property
    def natural_frequency(self) -> float:
        """Ω = √((k + k_r)/m) [rad/s]."""
        return math.sqrt((self.stiffness + self.spring_rate) / self.mass)

    @property
    def damping_ratio_all(self) -> float:
        """Of both dampers together."""
        return self.damping_ratio + self.damping_ratio_frame

    @property
    def share(self) -> float:
        """κ = k/(k + k_r): how far the mass goes for a slow lift of one."""
        return self.stiffness / (self.stiffness + self.spring_rate)

    @property
    def damping(self) -> float:
        """c, of the damper in the train [N s/m]."""
        return 2 * self.damping_ratio * self.natural_frequency * self.mass


def one_mass(train: FollowerTrain) -> OneMass:
    """The model of a follower train of a machine."""
    return OneMass(
        mass=train.mass,
        stiffness=train.stiffness,
        damping_ratio=train.damping_ratio,
        damping_ratio_frame=train.damping_ratio_frame,
        spring_rate=train.spring_rate,
        preload=train.preload,
    )
