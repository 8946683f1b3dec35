"""Forces without the shares of each load are the same forces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import FindingError, Friction
from linkwright.kernel.limits import Limit
from linkwright.kinetostatics import equilibrium
from linkwright.kinetostatics.figures import captioned_forces


@pytest.mark.parametrize("friction", [None, {"cart1": Friction(coefficient=0.1, radius=0.02, viscous=3.0)}])
def test_the_sum_is_solved_as_the_shares_are(friction: dict[str, Friction] | None) -> None:
    machine = lw.read("roller_two_carts")
    whole = lw.forces(machine, friction=friction)
    alone = lw.forces(machine, friction=friction, contributions=False)
    assert whole.contributions
    assert not alone.contributions
    for name in ("torque_drive", "shaking_force", "shaking_moment", "power_load", "power_friction"):
        wanted = getattr(whole, name)
        # Sums in another order.
        assert getattr(alone, name) == pytest.approx(wanted, abs=1e-9 * (1 + np.abs(wanted).max()))
    for name, pair in whole.pairs.items():
        assert alone.pairs[name].force == pytest.approx(pair.force, abs=1e-9 * np.abs(pair.force).max())


def test_more_forces_than_fit_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """600 sliders would take 26 GB."""
    monkeypatch.setattr(equilibrium, "FORCES", Limit(10_000, "of all", "a smaller limit is met sooner"))
    machine = lw.read("roller_two_carts")
    lw.forces(machine, n=10)
    with pytest.raises(FindingError, match=r"found 361 crank angles, 18 equations .* at most 10 000 of all"):
        lw.forces(machine, n=360)


def test_where_no_pair_bears_a_force_there_is_no_figure_of_reactions() -> None:
    """A figure without curves says nothing, and its legend warns."""
    machine = lw.read(Path(__file__).parents[2] / "examples/cam_roller_undercut/machine.toml")
    forces = lw.forces(machine, speed=3.0)
    assert not list(captioned_forces(forces))
