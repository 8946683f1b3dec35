"""Measured cards of a day at once: each as the single one, faults by card."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from tests.samples.wells import well

import linkwright as lw
from linkwright.rods.card import SurfaceCard


@cache
def card_of(fillage, n):
    """The predicted surface card at n samples."""
    motion = lw.rod_string(well({"fillage": fillage} if fillage < 1 else {}))
    at, own = np.arange(n) / n, np.arange(len(motion.time)) / len(motion.time)
    position, load = (np.interp(at, own, curve, period=1) for curve in (motion.rod_position, motion.rod_load))
    return SurfaceCard(position, load, motion.period)


def test_each_of_many_cards_is_diagnosed_as_alone():
    """Cards of several fillages and lengths with one damping: the numbers of `diagnose_card` with it."""
    cards = [card_of(fillage, n) for fillage, n in ((1.0, 200), (0.8, 144), (0.6, 200), (0.6, 300))]
    many = lw.diagnose_cards(well(), cards, damping=0.5)
    assert many.faults == ("",) * 4
    for row, card in enumerate(cards):
        one = lw.diagnose_card(well(), card.position, card.load, period=card.period, damping=0.5)
        for name in ("plunger_stroke", "fluid_load", "production", "power_rod", "power_pump", "fillage"):
            assert getattr(many, name)[row] == pytest.approx(getattr(one, name), rel=4e-3), name
        assert many.load_max[row] == card.load.max()


def test_the_damping_of_the_well_is_fitted_to_its_cards():
    """The median of the fits is that of the prediction to 12 %; a card that is none has its fault."""
    cards = [card_of(fillage, 200) for fillage in (1.0, 0.7)]
    wrong = SurfaceCard(cards[0].position[::-1], cards[0].load[::-1], cards[0].period)
    many = lw.diagnose_cards(well(), [cards[0], wrong, cards[1]])
    assert many.damping == pytest.approx(float(well().rod_string.damping_rate), rel=0.12)
    assert "reverse the order" in many.faults[1]
    assert np.isnan(many.fillage[1])
    assert many.fillage[2] == pytest.approx(0.7, abs=0.02)


def test_no_cards_are_refused():
    """None at all, and none of this well."""
    with pytest.raises(lw.InputError, match="found none"):
        lw.diagnose_cards(well(), [])
    card = card_of(1.0, 200)
    with pytest.raises(lw.InputError, match="cards of this well"):
        lw.diagnose_cards(well(), [SurfaceCard(card.position, card.load / 4.448, card.period)])
