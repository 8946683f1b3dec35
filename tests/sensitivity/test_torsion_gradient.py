"""Derivatives of frequencies, mode shapes and forced torques of trains against extrapolated differences and
laws.
"""

import numpy as np
import pytest
from trains import mode_numbers

import linkwright as lw
from linkwright import InputError
from linkwright.machine import exchanged

GEARED = "examples/geared_train_frequencies/machine.toml"
TURBINE = "examples/marine_turbine/machine.toml"
DAMPER = "examples/viscous_damper/machine.toml"
YOKE = "examples/drive_line_torsion/machine.toml"


def _difference(machine, address, measure):
    """Richardson's extrapolation of central differences with steps h and 2h: errors h⁴, and rounding
    1e-13/h.
    """
    value = lw.get(machine, address)
    h = 2e-4 * abs(value)
    at = {k: measure(exchanged(machine, {address: value + k * h})) for k in (-2, -1, 1, 2)}
    return (8 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12 * h)


@pytest.mark.parametrize("path", [GEARED, YOKE])
def test_frequencies_and_shapes(path):
    """To 1e-9 of the largest influence: the differences are good for 1e-11."""
    machine = lw.read(path)
    names = [name for name, x in lw.addresses(machine).items() if x and name.startswith(("train", "drive"))]
    wanted = ["free_vibration.natural_frequencies", "free_vibration.mode_shapes"]
    usual = lw.gradient(machine, wanted[:1])
    found = lw.gradient(machine, wanted, [name for name in names if name in usual.variables])
    scale = np.abs(found.derivatives * found.at).max(axis=1)
    for place, address in list(enumerate(found.variables))[::3]:
        measured = _difference(
            machine, address, lambda m: mode_numbers(lw.free_vibration(m), found.responses)
        )
        error = np.abs(found.derivatives[:, place] - measured) * abs(found.at[place])
        assert np.all(error <= 1e-9 * np.maximum(scale, 1e-3)), address


def test_frequencies_follow_all_stiffnesses_and_inertias():
    """By dimensions: Σ k ∂f/∂k = f/2, Σ J ∂f/∂J = −f/2."""
    found = lw.gradient(lw.read(TURBINE), ["free_vibration.natural_frequencies"])
    for ending, share in ((".stiffness", 0.5), (".inertia", -0.5)):
        own = [n for n, name in enumerate(found.variables) if name.endswith(ending)]
        assert found.elasticities[:, own].sum(axis=1) == pytest.approx(share, rel=1e-9)


def _twins(k=1.0):
    """A disc in the middle of two like shafts with discs, each end of which is held by no other."""
    return lw.loads(
        "format = 1\nname = 'Spokes'\n[train.discs]\n"
        + "".join(f"arm{n} = {{ inertia = 1 }}\n" for n in range(3))
        + "hub = { inertia = 10 }\n[train.shafts]\n"
        + "".join(
            f'spoke{n} = {{ between = ["hub", "arm{n}"], stiffness = {100 * (k if n == 0 else 1)} }}\n'
            for n in range(3)
        )
    )


def test_a_repeated_frequency_gives_its_invariant():
    """Three arms on a hub: f₂ = f₃, of which the mean square is smooth in every stiffness, by sixths of
    ω².
    """
    machine = _twins()
    names = [f"train.shafts.spoke{n}.stiffness" for n in range(3)]
    found = lw.gradient(machine, ["free_vibration.natural_frequencies"], names)
    assert set(found.ties) == {f"free_vibration.natural_frequencies.{n}" for n in (1, 2)}
    # The two modes without the hub have Σ Δ² of 2/3 in each spoke: d(ω² mean)/dk = 1/3.
    slope = 1 / 3 / (2 * 10.0) / (2 * np.pi)
    assert found.derivatives[:2] == pytest.approx(slope, rel=1e-9)
    # The mean of the squares of both, apart by h.
    h = 1e-5

    def mean(k):
        return np.mean(lw.free_vibration(_twins(1 + k / 100)).angular_frequencies[1:3] ** 2)

    assert (mean(h) - mean(-h)) / (2 * h) == pytest.approx(1 / 3, rel=1e-6)
    with pytest.raises(InputError, match="expected one with a derivative"):
        lw.gradient(machine, ["free_vibration.mode_shapes.1.hub"])


def _hysteretic(path):
    """A machine with hysteresis in its shafts in place of ratios of its modes."""
    machine = lw.read(path)
    if machine.train.modal_damping is None:
        return machine
    plain = machine.with_entries({"train": machine.train.with_entries({"modal_damping": None})})
    return lw.replace(plain, {f"train.shafts.{name}.loss_factor": 0.008 for name in plain.train.shafts})


@pytest.mark.parametrize("path", [TURBINE, DAMPER])
def test_forced_torques(path):
    """At the speeds of the peaks, to 1e-8: the differences are good for 1e-10."""
    machine = _hysteretic(path)
    found = lw.gradient(machine, ["forced_vibration"])
    response = lw.forced_vibration(machine)
    rows = [name.split(".")[1:] for name in found.responses]
    peaks = [int(getattr(response, kind)[response.shafts.index(shaft)].argmax()) for kind, shaft in rows]
    speeds = response.speeds[sorted(set(peaks))]

    def measure(changed):
        at = lw.forced_vibration(changed, speeds)
        nth = [int(np.flatnonzero(speeds == response.speeds[peak])[0]) for peak in peaks]
        return np.array(
            [getattr(at, kind)[at.shafts.index(shaft), n] for (kind, shaft), n in zip(rows, nth, strict=True)]
        )

    assert measure(machine) == pytest.approx(found.values, rel=1e-12)
    scale = np.abs(found.derivatives * found.at).max(axis=1)
    moving = [n for n in range(len(found.variables)) if found.at[n]]
    for place in moving[:: max(1, len(moving) // 6)]:
        measured = _difference(machine, found.variables[place], measure)
        error = np.abs(found.derivatives[:, place] - measured) * abs(found.at[place])
        assert np.all(error <= 1e-8 * scale), found.variables[place]


def test_forced_torques_follow_what_excites():
    """Linear in the one torque that excites; an order, speeds of discs and the speeds that are looked at
    are refused.
    """
    found = lw.gradient(lw.read(DAMPER), ["forced_vibration.shaft_torque_vibratory"])
    column = found.variables.index("train.excitations.gas.harmonics.0.torque")
    assert found.elasticities[:, column] == pytest.approx(1.0, rel=1e-12)
    assert "train.run.speed_min" in found.refused
    assert "train.excitations.gas.harmonics.0.order" in found.refused
    with pytest.raises(InputError, match="orders that coincide"):
        lw.gradient(_hysteretic(TURBINE), ["forced_vibration"], ["train.gears.high_last.ratio"])
    with pytest.raises(InputError, match="modal_damping"):
        lw.gradient(lw.read(TURBINE), ["forced_vibration"])
    with pytest.raises(InputError, match="driveline"):
        lw.gradient(lw.read(YOKE), ["forced_vibration"])
