r"""Forces of the rods on the crank pins over a working cycle, and the bending of a throw under them.

In the frame of a cylinder, its axis x, with the rod at the angle ψ from it, let :math:`a_p` be the
acceleration of the piston and :math:`a_S` that of the rod's centre of mass at c from the big end. The wall
pushes with

.. math:: N \cos\psi = \frac{J_S \ddot\psi + c\,\hat d \times m\,a_S}{l} + R \sin\psi, \qquad
    R = -(p - p_c) A - m_p a_p

and the rod pushes the pin with :math:`F = R + iN - m\,a_S`. Seen from the crank, its real part is radial,
away from the shaft, its imaginary part tangential, in the sense of rotation; weight is left out.

A throw is a beam on two supports in the middles of its main journals, a distance L_3 apart. A force at the
distance a bends the place x by the triangle

.. math:: M = F\,\frac{\min(x, a)\,(L_3 - \max(x, a))}{L_3}

References
----------
.. [1] IACS, UR M53 Calculation of Crankshafts for I.C. Engines, Rev. 2, 2011, M53.2.1: statically determinate
   throw.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.torsion.model.engine.cylinder import Cylinder
from linkwright.torsion.model.engine.engine import ReciprocatingEngine, firing_angles
from linkwright.torsion.model.engine.engine_motion import piston_positions, running_gears
from linkwright.torsion.model.engine.running_gear import throw_motion
from linkwright.torsion.model.engine.throw import CrankThrow

# Angles in a revolution: half a degree apart, where a cycle's peak is good to 1e-4.
_STEPS = 720


class PinForces(NamedTuple):
    """Forces of the rods on the pin of one throw over a working cycle."""

    crank_angle: Floats  # (n,) φ of the first throw [rad]
    # (rods, n) radial and i times tangential force of each rod on the pin [N].
    forces: Complexes


def pin_forces(engine: ReciprocatingEngine, speed: float) -> Iterator[PinForces]:
    """Forces on the pin of each throw, cylinders sound. `speed`: of the crank [rad/s]."""
    phi = 2 * math.pi * np.arange(_STEPS * engine.strokes // 2) / _STEPS
    fires, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    gears = running_gears(engine)
    cylinders = [Cylinder(engine.bore, engine.strokes, x) for x in piston_positions(engine)]
    gases = [engine.gas.cycle_pressure(cylinder, np.array([speed])) for cylinder in cylinders]
    for n, angle in enumerate(engine.throws):
        motions = throw_motion(engine.radius, gears, phi + angle)
        rods = []
        for c, place in enumerate(engine.places):
            if place.throw != n:
                continue
            k = place.bank
            gear, motion, gas, cylinder = gears[k], motions[k], gases[k], cylinders[k]
            pressure = gas.at(phi - fires[c] - cylinder.top)[0][0] - gas.crankcase_pressure
            m, centre, J = gear.rod.body
            # In the frame of the cylinder.
            acceleration = motion.point(centre).d2 * np.exp(-1j * gear.bank_angle) * speed**2
            d = np.exp(1j * motion.angle)
            R = -pressure * cylinder.area - gear.piston_mass * motion.piston_d2 * speed**2
            moment = J * motion.angle_d2 * speed**2 + centre * m * (d.conj() * acceleration).imag
            N = (moment / gear.rod.length + R * d.imag) / d.real
            force = (R + 1j * N - m * acceleration) * np.exp(1j * (gear.bank_angle - phi - angle))
            rods.append(force)
        yield PinForces(phi, np.array(rods))


def rod_places(engine: ReciprocatingEngine, throw: CrankThrow) -> Floats:
    """Distance of the middle of each rod from that of the main journal, (rods,) [m]."""
    start, count = throw.journal.length / 2 + throw.web.thickness, len(engine.banks)
    if engine.rods != "side_by_side":
        return np.full(count, start + throw.pin.length / 2)
    return start + throw.pin.length * (np.arange(count) + 0.5) / count


def bending(throw: CrankThrow, places: Floats, forces: Complexes, x: float) -> Complexes:
    """Bending moment of a throw at the distance x from the middle of its first journal, (n,) [N m].

    Radial, and i times tangential. `places`: (rods,) [m]; `forces`: (rods, n) [N].
    """
    L = throw.length
    share = np.minimum(x, places) * (L - np.maximum(x, places)) / L
    moment: Complexes = share @ forces
    return moment


def shear(throw: CrankThrow, places: Floats, forces: Complexes, first: bool) -> Complexes:
    """Force that a web carries, the first or the second of a throw, (n,) [N]."""
    share = 1 - places / throw.length if first else places / throw.length
    force: Complexes = share @ forces
    return force
