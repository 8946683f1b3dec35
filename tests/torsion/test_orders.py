"""Tables of every order, curves of a manoeuvre, and the frequencies that Holzer's table is asked for."""

import csv
import io
import math

import numpy as np
import pytest

import linkwright as lw
from linkwright import InputError
from linkwright.torsion import excited_train, orders_together, responded, span
from linkwright.torsion.modes.holzer import holzer_frequency
from linkwright.torsion.tables.orders import excitation_tables, manoeuvre_csv, order_files, order_results


def machine() -> lw.Machine:
    return lw.replace(lw.read("propeller_shaft_line"), {"train.run.points": 5})


def rows_of(text: str) -> list[dict[str, float]]:
    return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(io.StringIO(text))]


def test_orders_are_those_of_the_response() -> None:
    at = excited_train(machine())
    forced = responded(at)
    rows = rows_of(order_files(at, forced)["shaft_torque_orders.csv"])
    assert [row["speed [rad/s]"] for row in rows] == forced.speeds.tolist()
    line = forced.shafts.index("line")
    column = [row["line order 4 [N m]"] for row in rows]
    np.testing.assert_array_equal(column, np.abs(forced.shaft_torques[0, line]))
    told = order_results(at, forced)["shaft_torque"]["line"]
    wave = np.array(told["amplitude"]) * np.exp(1j * np.array(told["phase"]))
    np.testing.assert_allclose(wave, forced.shaft_torques[:, line], rtol=1e-12)


def test_excitation_is_told_with_its_phase() -> None:
    """Shares of the propeller's torque, which resists: half a revolution from the phase of the file."""
    at = excited_train(machine())
    (table,) = excitation_tables(at, 4)
    row = next(row for row in table.rows if row[0] == "order 4")
    torque = 490e3 * (at.torques.speeds[4] / (127 * math.pi / 30)) ** 2
    cells = dict(zip(table.heads, row, strict=True))
    assert float(cells["propeller"].removesuffix(" N m")) == pytest.approx(0.06 * torque, rel=1e-3)
    assert row[-1] == "−165°"


def test_manoeuvre_has_a_column_for_each_disc_and_shaft() -> None:
    moved = lw.torsion_transient(
        lw.Machine.model_validate(
            {
                "format": 1,
                "name": "m",
                "train": {
                    "discs": {"a": {"inertia": 1.0}, "b": {"inertia": 1.0}},
                    "shafts": {"s": {"between": ["a", "b"], "stiffness": 1e3}},
                    "transient": {"duration": 0.01},
                },
            }
        )
    )
    rows = rows_of(manoeuvre_csv(moved))
    assert list(rows[0]) == ["time [s]", "a speed [rad/s]", "b speed [rad/s]", "s torque [N m]"]
    assert len(rows) == len(moved.time)


@pytest.mark.parametrize(
    ("text", "hertz"),
    [("45", 45.0), ("20 rad/s", 10 / math.pi), ("300 rpm", 5.0), ("7.5 Hz", 7.5), ("0.2 kHz", 200.0)],
)
def test_frequencies_in_any_unit(text: str, hertz: float) -> None:
    free = lw.free_vibration(machine())
    assert holzer_frequency(text, free) == pytest.approx(hertz, rel=1e-12)
    assert holzer_frequency("f_2", free) == free.natural_frequencies[2]


@pytest.mark.parametrize("text", ["f_99", "20 N m", "fast"])
def test_other_texts_are_refused(text: str) -> None:
    with pytest.raises(InputError, match="holzer: found"):
        holzer_frequency(text, lw.free_vibration(machine()))


@pytest.mark.parametrize(
    ("orders", "waves"),
    [
        # Behind a stage of 1 : 250; its 7 vanes alone, and with twice as many.
        ([1750.0], [1]),
        ([1750.0, 3500.0], [1, 2]),
        # Nothing is gained by less than a revolution.
        ([4.0], [4]),
        ([2.0, 4.0, 6.0], [2, 4, 6]),
        # Beside order 1 all waves of the revolution are needed; of too many each stands alone.
        ([1.0, 500.0], [1, 500]),
        ([1.0, 1750.0], [1, 0]),
    ],
)
def test_orders_far_above_one_are_counted_by_the_lowest(orders: list[float], waves: list[int]) -> None:
    """A sine has its extremes anywhere; among 1750 waves their search at 200 speeds lasted 75 s."""
    found = orders_together(np.array(orders))
    assert found.harmonic.tolist() == waves
    assert found.turns * orders[0] == pytest.approx(waves[0])
    amplitudes = np.linspace(1.0, 2.0, len(orders))[:, None] * np.exp(0.7j)
    top, bottom = span(found, amplitudes)
    tau = np.linspace(0, 2 * np.pi * found.turns, 40_000)
    wave = sum((a * np.exp(1j * order * tau)).real for a, order in zip(amplitudes[:, 0], orders, strict=True))
    assert [top[0], bottom[0]] == pytest.approx([wave.max(), wave.min()], abs=0.01)
