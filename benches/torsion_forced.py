"""How long does the forced vibration of a train take, order by order over many speeds?"""

from __future__ import annotations

from typing import Any

import numpy as np
from common import Row, faster, is_installed, seconds

import linkwright as lw
from linkwright.torsion.core.response import respond
from linkwright.torsion.excitation.excited_train import excited_train

DISCS, ORDERS = 50, 24


def rows(quick: bool) -> list[Row]:
    """Amplitudes of 50 discs in a chain at 24 orders and 1000 speeds."""
    speeds = np.linspace(10.0, 200.0, 100 if quick else 1000)
    machine = chain(DISCS)
    at = excited_train(machine, speeds)
    first = at.referred_harmonics
    random = np.random.default_rng(DISCS)
    torques = first + random.uniform(1.0, 50.0, first.shape) * np.exp(
        1j * random.uniform(0.0, 6.0, first.shape)
    )
    found: dict[str, Any] = {}

    def product() -> None:
        found["product"] = respond(at.referred, at.operating, at.torques.orders, torques)

    acts = [product]
    if is_installed("opentorsion"):
        acts.append(lambda: found.update(peer=peer(machine, speeds, torques)))
    product()
    once = seconds([product], repeats=3 if quick else 9)[0]
    times = seconds(acts, repeats=1)
    case = f"forced vibration: {DISCS} discs, {ORDERS} orders, {len(speeds)} speeds"
    words = "amplitudes of every disc, from torques that are ready"
    own = Row(case, "ms", 1e3 * once, target=8.0, aim="at most", note=words)
    if len(times) < 2:
        return [own]
    size = np.abs(found["peer"]).max()
    off_by = np.abs(found["product"] - found["peer"]).max() / size
    assert off_by < 1e-8, f"product and openTorsion differ by {off_by:g} of the largest amplitude"
    note = "amplitudes of every disc; openTorsion's steady-state response inverts a matrix for each"
    return [own, faster(case, times[0], "openTorsion ss_response", times[1], target=20.0, note=note)]


def chain(n: int) -> lw.Machine:
    """A free chain, excited at every order."""
    random = np.random.default_rng(n)
    J, k = random.uniform(0.5, 2.0, n), random.uniform(1e4, 4e4, n - 1)
    discs = {f"d{i}": {"inertia": J[i], "damping": 0.3} for i in range(n)}
    shafts = {
        f"s{i}": {"between": [f"d{i}", f"d{i + 1}"], "stiffness": k[i], "damping": 1.0} for i in range(n - 1)
    }
    harmonics = [{"order": 0.5 * (m + 1), "torque": 1.0, "phase": 0.0} for m in range(ORDERS)]
    excitations = {"e": {"on": "d0", "harmonics": harmonics}}
    train = {"discs": discs, "shafts": shafts, "excitations": excitations}
    return lw.Machine.model_validate({"format": 1, "name": "chain", "train": train})


def peer(machine: lw.Machine, speeds: np.ndarray, torques: np.ndarray) -> np.ndarray:
    """The same by openTorsion, (orders, discs, speeds)."""
    from opentorsion import Assembly, Disk, Shaft

    assert machine.train is not None
    discs = [Disk(i, I=each.inertia, c=each.damping) for i, each in enumerate(machine.train.discs.values())]
    shafts = [
        Shaft(i, i + 1, k=each.rate, I=0.0, c=each.damping)
        for i, each in enumerate(machine.train.shafts.values())
    ]
    assembly = Assembly(shafts, disk_elements=discs)
    orders = 0.5 * (np.arange(ORDERS) + 1)
    return np.stack(
        [
            assembly.ss_response(torque, order * speeds)[0]
            for torque, order in zip(torques, orders, strict=True)
        ]
    )
