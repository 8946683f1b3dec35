"""Outside barred speed ranges every shaft is within its limit, and they cover what the rule asks for.

On random trains, on every shipped machine and every example, with limits that part of their stress is above.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from sizes import cases, generator

import linkwright as lw
from linkwright.torsion import ShaftLimit, Survey, survey
from linkwright.torsion.excitation.excited_train import is_excited
from linkwright.torsion.limits.barred_range import surveyed_ranges
from linkwright.torsion.limits.criteria import VIBRATORY_STRESS
from linkwright.torsion.limits.survey import torque_peaks

ROOT = Path(__file__).parents[2]
FILES = [
    path
    for path in sorted([*ROOT.glob("machines/*.toml"), *ROOT.glob("examples/*/machine.toml")])
    if "[train" in path.read_text(encoding="utf-8")
]
# Shares of the largest stress that shafts bear.
SHARES = (0.85, 0.6, 0.4)
SPEEDS = 1500
TWINS = 0.01

Floats = NDArray[np.float64]


def random_train(seed: int) -> str:
    """Three to six discs in a row, a ring in a fluid, orders that meet several modes."""
    rng = generator(seed)
    n = int(rng.integers(3, 7))
    discs = "".join(f"d{k} = {{ inertia = {10 ** rng.uniform(-1, 1):.6g} }}\n" for k in range(n))
    shafts = "".join(
        f'[train.shafts.s{k}]\nbetween = ["d{k}", "d{k + 1}"]\nstiffness = {10 ** rng.uniform(4, 5.5):.6g}\n'
        f"loss_factor = {10 ** rng.uniform(-2.5, -1):.4g}\n"
        "limit = { diameter = 0.05, stress_permitted = 1, stress_transient = 1e12 }\n"
        for k in range(n - 1)
    )
    waves = ", ".join(
        f"{{ order = {order}, torque = {rng.uniform(20, 200):.5g}, phase = {rng.uniform(0, 6):.4g} }}"
        for order in rng.choice([1, 1.5, 2, 3, 4, 5, 6], 3, replace=False)
    )
    damper = ""
    if rng.random() < 0.7:
        damper = (
            f'[train.dampers.ring]\non = "d0"\nring_inertia = {10 ** rng.uniform(-1, 0.5):.4g}\n'
            f"damping = {10 ** rng.uniform(0.5, 2.5):.4g}\n"
        )
    return (
        f'format = 1\nname = "Train {seed}"\n[train.discs]\n{discs}{shafts}{damper}'
        f'[train.excitations.e]\non = "d{n - 1}"\nharmonics = [{waves}]\n'
        "[train.run]\nspeed_min = 20\nspeed_max = 150\npoints = 200\nspeed_rated = 210\n"
    )


def with_limits(machine: lw.Machine, share: float) -> Survey | None:
    """The machine with limits of a share of the largest stress of each shaft; None without any section."""
    seen = survey(machine)
    found = lw.shaft_stress(machine, seen.found, seen.service)
    train = machine.train
    if train is None or not found.shafts:
        return None
    limits = {
        name: ShaftLimit(
            section_modulus=float(W), stress_permitted=share * float(size.max()), stress_transient=1e15
        )
        for name, W, size in zip(found.shafts, found.section_modulus, found.vibratory, strict=True)
    }
    own = {name: limit for name, limit in limits.items() if name in train.shafts}
    entries = {f"train.shafts.{name}.limit": limit for name, limit in own.items()}
    if train.engine is not None and train.engine.limit is not None:
        least = min(float(size.max()) for name, size in zip(found.shafts, found.vibratory, strict=True))
        entries["train.engine.limit"] = ShaftLimit(stress_permitted=share * least, stress_transient=1e15)
    return survey(lw.replace(machine, entries)) if entries else None


def test_peaks_of_torque_are_the_largest() -> None:
    seen = survey(lw.read(ROOT / "machines" / "v8_diesel.toml"))
    speeds = np.linspace(*seen.at.torques.speeds[[0, -1]], SPEEDS)
    dense = seen.carried_at(speeds).shaft_torque_vibratory.max(axis=1)
    found = torque_peaks(seen).vibratory
    assert (found >= dense * (1 - 1e-9)).all()
    # Not beside them either: a step of the dense speeds is a thousandth of them.
    np.testing.assert_allclose(found, dense, rtol=2e-3)


def check(seen: Survey) -> int:
    ranges = surveyed_ranges(seen)
    lowest, highest = seen.at.torques.speeds[[0, -1]]
    speeds = np.linspace(lowest, highest, SPEEDS)
    for each, known in zip(seen.criteria_at(speeds), seen.criteria, strict=True):
        # No speed between those looked at has more.
        assert each.ratio.max() <= known.ratio.max() * (1 + 1e-7), each.part
        if each.what != VIBRATORY_STRESS:
            continue
        mine = [one.barred for one in ranges if one.shaft == each.part]
        inside = [(low <= speeds) & (speeds <= high) for low, high in mine]
        outside = each.ratio[~np.any(inside, axis=0)] if mine else each.ratio
        # The search for bounds stops at 10⁻¹⁰ of the limit.
        assert outside.max(initial=0.0) <= 1 + 1e-9, each.part
        for peak in _peaks(speeds, each.found, each.ratio > 1):
            ratio = peak / seen.service
            wanted = 16 * peak / (18 - ratio), (18 - ratio) * peak / 16
            # Twin peaks closer than this count as one.
            near = TWINS * peak
            covered = [low <= wanted[0] + near and wanted[1] - near <= high for low, high in mine]
            assert any(covered), (each.part, peak)
    return len(ranges)


def _peaks(speeds: Floats, values: Floats, counts: NDArray[np.bool_]) -> Floats:
    here = (values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:]) & counts[1:-1]
    return speeds[1:-1][here]


@pytest.mark.deep
@pytest.mark.parametrize("seed", range(cases(4, 40)))
def test_random_trains(seed: int) -> None:
    machine = lw.loads(random_train(seed))
    seen = [with_limits(machine, share) for share in SHARES]
    assert sum(check(each) for each in seen if each is not None) > 0


@pytest.mark.parametrize("path", FILES[:: cases(2, 1)], ids=lambda path: path.parent.name + "/" + path.stem)
def test_shipped_machines_and_examples(path: Path) -> None:
    machine = lw.read(path)
    if not is_excited(machine):
        return
    check(survey(machine))
    stricter = [with_limits(machine, share) for share in SHARES[1 : cases(2, 3)]]
    for each in stricter:
        if each is not None:
            assert check(each) > 0
