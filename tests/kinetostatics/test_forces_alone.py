"""Forces without the shares of each load are the same forces."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright.kernel.errors import FindingError
from linkwright.kinetostatics.friction import Friction


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


def test_more_forces_than_fit_are_refused() -> None:
    """600 sliders would take 26 GB."""
    numbers = range(120)
    sliders = "".join(f'[mechanism.sliders.S{k}]\ncrank = "A"\nrod = 0.8\n' for k in numbers)
    bodies = "".join(f"S{k} = {{ mass = 1 }}\n" for k in numbers)
    machine = lw.loads(
        f'format = 1\nname = "x"\n[mechanism.cranks.A]\nradius = 0.2\n{sliders}[bodies]\n{bodies}'
    )
    with pytest.raises(FindingError, match=r"found 121 crank angles, .* at most 60 000 000"):
        lw.forces(machine, speed=1.0, n=120)
