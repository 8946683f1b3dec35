r"""Fatigue of a crankshaft by IACS UR M53: nominal stresses, equivalent alternating stress, acceptability Q.

Amplitudes are half of the range over a working cycle at the speed of service. In the middle of the web,

.. math:: \sigma_{BFN} = K_e \frac{M_{BRFN}}{B W^2/6}, \qquad \sigma_{QFN} = K_e \frac{Q_{RFN}}{B W}, \qquad
    \sigma_{BON} = \frac{M_{BON}}{W_e}

K_e is 0.8 of two-stroke and 1 of four-stroke engines. The nominal torsional stress
:math:`\tau_N = M_{TN}/W_p` is the largest of all shafts between the throws, with all cylinders firing or one
misfiring, at all speeds that are not barred. With the factors of `crank_concentration`,

.. math::

    \sigma_v &= \sqrt{(\alpha_B \sigma_{BFN} + \sigma_{add})^2 + 3 (\alpha_T \tau_N)^2} \\
    \sigma_v &= \sqrt{(\beta_B \sigma_{BFN} + \beta_Q \sigma_{QFN} + \sigma_{add})^2
    + 3 (\beta_T \tau_N)^2} \\
    \sigma_v &= \tfrac13 \gamma_B \sigma_{BON} \left[ 1 + 2 \sqrt{1 + \tfrac94
    \left( \frac{\gamma_T \tau_N}{\gamma_B \sigma_{BON}} \right)^2} \right]

in the crank pin fillet, the journal fillet and at the oil bore. Each :math:`Q = \sigma_{DW}/\sigma_v` must be
1.15 or more.

References
----------
.. [1] IACS, UR M53 Calculation of Crankshafts for I.C. Engines, Rev. 2, 2011, M53.2 to M53.7.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.torsion.limits.barred_range import not_barred
from linkwright.torsion.limits.misfire import MisfireVerdict, misfire_verdict
from linkwright.torsion.limits.survey import Survey, survey
from linkwright.torsion.limits.verdict import Verdict, verdict
from linkwright.torsion.model.engine.crank_concentration import (
    ThrowRatios,
    bore_bending,
    bore_torsion,
    journal_bending,
    journal_shear,
    pin_bending,
    torsion,
)
from linkwright.torsion.model.engine.crank_fatigue import CrankFatigue
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.engine.throw import CrankThrow, Journal
from linkwright.torsion.model.train_torques import InstalledEngine
from linkwright.torsion.response.crank_bending import bending, pin_forces, rod_places, shear

# Minimum Q of M53.7.
ACCEPTABLE = 1.15

# K_e of M53.2 by the strokes of a cycle.
_EMPIRICAL = {2: 0.8, 4: 1.0}


class FatiguePlace(NamedTuple):
    """A place of a throw: alternating stresses there, and what the steel bears.

    Attributes
    ----------
    place : str
        Crank pin fillet, journal fillet, or oil bore.
    bending, torsion : float
        With their concentration [Pa].
    equivalent, strength : float
        σ_v, with the additional bending, and σ_DW [Pa].
    """

    place: str
    bending: float
    torsion: float
    equivalent: float
    strength: float

    @property
    def acceptability(self) -> float:
        """Q."""
        return self.strength / self.equivalent if self.equivalent else math.inf


@dataclass(frozen=True)
class CrankshaftFatigue(Result):
    """Fatigue of the crankshaft of one engine."""

    engine: Annotated[str, About("Name of one of several engines, else empty.")]
    torque: Annotated[
        float,
        Label("largest vibratory torque between the throws", "M_TN", "N m", "At speeds that are not barred."),
    ]
    shaft: Annotated[str, About("The shaft that carries it.")]
    speed: Annotated[float, Label("speed of the first disc there", "ω", "rad/s")]
    cylinder: Annotated[str, About("That misfires there; empty with all cylinders firing.")]
    bending_nominal: Annotated[float, Label("nominal alternating bending stress of the web", "σ_BFN", "Pa")]
    shear_nominal: Annotated[float, Label("nominal alternating radial stress of the web", "σ_QFN", "Pa")]
    bore_nominal: Annotated[
        float | None, Label("nominal alternating bending stress at the oil bore", "σ_BON", "Pa")
    ]
    torsion_pin: Annotated[float, Label("nominal alternating torsional stress of the pin", "τ_N", "Pa")]
    torsion_journal: Annotated[float, Label("the same of the journal", "", "Pa")]
    factors: Annotated[dict[str, float], About("Stress concentration factors by their symbols.")]
    places: Annotated[tuple[FatiguePlace, ...], About("Fillets and oil bore.")]
    outside: Annotated[tuple[str, ...], About("Dimension ratios outside the range of the factors.")]

    @property
    def acceptability(
        self,
    ) -> Annotated[float, Label("acceptability factor", "Q", "")]:
        """Minimum Q of all places."""
        return min(place.acceptability for place in self.places)

    @property
    def is_acceptable(self) -> bool:
        """Whether Q is 1.15 or more everywhere."""
        return self.acceptability >= ACCEPTABLE

    @property
    def words(self) -> str:
        """The verdict as a sentence."""
        worst = min(self.places, key=lambda place: place.acceptability)
        name = f"Crankshaft {self.engine}".rstrip()
        text = f"{name}: acceptability factor {worst.acceptability:.3g} in the {worst.place}, required 1.15"
        return f"{text}: {'sufficient' if self.is_acceptable else 'not sufficient'} (IACS UR M53)"

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Numbers, with factors and places as tables."""
        rows = [place._asdict() | {"acceptability": place.acceptability} for place in self.places]
        more = {"factors": self.factors, "places": rows, "acceptability": self.acceptability}
        return super().to_dict(curves=curves) | more | {"is_acceptable": self.is_acceptable}


@public
def crankshaft_fatigue(machine: Machine) -> tuple[CrankshaftFatigue, ...]:
    """Fatigue of the crankshafts of a train by IACS UR M53.

    Parameters
    ----------
    machine : Machine
        With engines that have a `fatigue` table.

    Returns
    -------
    tuple of CrankshaftFatigue
        One for each engine with such a table.

    Raises
    ------
    InputError
        Nothing excites the train, or it has no speeds.

    References
    ----------
    .. [1] IACS, UR M53 Calculation of Crankshafts for I.C. Engines, Rev. 2, 2011.
    """
    seen = survey(machine)
    judged = verdict(machine, seen)
    return surveyed_fatigue(seen, judged, misfire_verdict(machine, seen, judged.barred))


def surveyed_fatigue(
    seen: Survey, judged: Verdict, misfire: MisfireVerdict | None
) -> tuple[CrankshaftFatigue, ...]:
    """Fatigue of the crankshafts of a train that has been examined."""
    train = seen.machine.train
    installed = () if train is None else train.installed
    speeds = dict(zip(seen.at.referred.discs, seen.at.referred.speed.tolist(), strict=True))
    return tuple(
        _judged(one, one.engine.fatigue, abs(speeds[one.throws[0]]) * seen.service, seen, judged, misfire)
        for one in installed
        if one.engine.fatigue is not None
    )


def _judged(
    one: InstalledEngine,
    fatigue: CrankFatigue,
    speed: float,
    seen: Survey,
    judged: Verdict,
    misfire: MisfireVerdict | None,
) -> CrankshaftFatigue:
    engine, throw = one.engine, one.engine.throw
    assert throw is not None
    torque, shaft, at, cylinder = _torsion(one, seen, judged, misfire)
    bent, sheared, bored = _nominal(engine, fatigue, throw, speed)
    ratios = fatigue.ratios(throw)
    tau, tau_journal = torque / _polar(throw.pin), torque / _polar(throw.journal)
    factors = _factors(ratios)
    places = [
        _fillet(
            "crank pin fillet",
            factors["α_B"] * bent,
            factors["α_T"] * tau,
            fatigue,
            fatigue.strength(throw.pin.diameter, fatigue.pin_fillet),
        ),
        _fillet(
            "journal fillet",
            factors["β_B"] * bent + factors["β_Q"] * sheared,
            factors["β_T"] * tau_journal,
            fatigue,
            fatigue.strength(throw.journal.diameter, fatigue.journal_fillet),
        ),
    ]
    if fatigue.oil_bore is not None and bored is not None:
        strength = fatigue.strength(throw.pin.diameter, fatigue.oil_bore / 2)
        places.append(_bore(factors["γ_B"] * bored, factors["γ_T"] * tau, strength))
    return CrankshaftFatigue(
        engine=one.name,
        torque=torque,
        shaft=shaft,
        speed=at,
        cylinder=cylinder,
        bending_nominal=bent,
        shear_nominal=sheared,
        bore_nominal=bored,
        torsion_pin=tau,
        torsion_journal=tau_journal,
        factors=factors,
        places=tuple(places),
        outside=ratios.outside,
    )


def _torsion(
    one: InstalledEngine, seen: Survey, judged: Verdict, misfire: MisfireVerdict | None
) -> tuple[float, str, float, str]:
    kept = not_barred(seen.speeds, [span.barred for span in judged.barred])
    torques = seen.vibratory_at(seen.speeds)[:, kept]
    listed = [(0.0, "", seen.service, "")]
    for name in one.cranks:
        row = torques[seen.found.shafts.index(name)]
        n = int(np.nan_to_num(row, nan=np.inf).argmax())
        listed.append((float(row[n]), name, float(seen.speeds[kept][n]), ""))
    if misfire is not None:
        listed += [
            (case.torque, case.shaft, case.speed, case.cylinder)
            for case in misfire.torques
            if case.shaft in one.cranks
        ]
    return max(listed)


def _nominal(
    engine: ReciprocatingEngine, fatigue: CrankFatigue, throw: CrankThrow, speed: float
) -> tuple[float, float, float | None]:
    """σ_BFN and σ_QFN of the web, σ_BON at the oil bore: of the worst web and throw [Pa]."""
    thickness, width = fatigue.web(throw)
    places, L = rod_places(engine, throw), throw.length
    middle = (throw.journal.length + throw.web.thickness) / 2
    bent, sheared, bored = [], [], []
    psi = fatigue.oil_bore_angle
    for on in pin_forces(engine, speed):
        for first, x in ((True, middle), (False, L - middle)):
            bent.append(_half_range(bending(throw, places, on.forces, x).real))
            sheared.append(_half_range(shear(throw, places, on.forces, first).real))
        for x in places.tolist():
            moment = bending(throw, places, on.forces, x)
            bored.append(_half_range(moment.imag * math.cos(psi) + moment.real * math.sin(psi)))
    K_e = _EMPIRICAL[engine.strokes]
    bending_stress = K_e * max(bent) / (width * thickness**2 / 6)
    shear_stress = K_e * max(sheared) / (width * thickness)
    # The section modulus against bending is half of that against torsion.
    bore_stress = None if fatigue.oil_bore is None else max(bored) / (_polar(throw.pin) / 2)
    return bending_stress, shear_stress, bore_stress


def _half_range(curve: Floats) -> float:
    return 0.5 * float(np.ptp(curve))


def _polar(part: Journal) -> float:
    """W_p of a pin or a journal [m³]."""
    d = part.diameter
    return math.pi / 16 * (d**4 - part.inner_diameter**4) / d


def _factors(ratios: ThrowRatios) -> dict[str, float]:
    factors = {
        "α_B": pin_bending(ratios),
        "α_T": torsion(ratios, ratios.r),
        "β_B": journal_bending(ratios),
        "β_Q": journal_shear(ratios),
        "β_T": torsion(ratios, ratios.r_T),
    }
    if ratios.d_O is not None:
        factors |= {"γ_B": bore_bending(ratios.d_O), "γ_T": bore_torsion(ratios.d_O)}
    return factors


def _fillet(place: str, bent: float, twisted: float, fatigue: CrankFatigue, strength: float) -> FatiguePlace:
    equivalent = math.sqrt((bent + fatigue.additional_bending) ** 2 + 3 * twisted**2)
    return FatiguePlace(place, bent, twisted, equivalent, strength)


def _bore(bent: float, twisted: float, strength: float) -> FatiguePlace:
    equivalent = (bent + 2 * math.sqrt(bent**2 + 2.25 * twisted**2)) / 3
    return FatiguePlace("oil bore", bent, twisted, equivalent, strength)
