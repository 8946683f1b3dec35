"""What a study of torsion says beside its numbers, and peaks between the speeds of a run."""

from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError

ENGINE: dict[str, Any] = {
    "bore": 0.1,
    "crank_radius": 0.05,
    "throws": [0.0],
    "firing_order": [1],
    "rod": {"length": 0.18, "mass": 1.2, "distribution": 0.5},
    "piston_mass": 0.9,
    "throw_inertia": 0.02,
    "gas": {"kind": "wiebe", "compression_ratio": 16, "mean_effective_pressure": 6e5},
}


def machine(**train: Any) -> lw.Machine:
    run = {"speed_min": 20.0, "speed_max": 200.0, "points": 40, "loads_follow": True}
    return lw.Machine.model_validate({"format": 1, "name": "train", "train": {"run": run, **train}})


def light() -> lw.Machine:
    return machine(
        discs={"a": {"inertia": 1.0}},
        shafts={"s": {"between": ["a", "ground"], "stiffness": 1e4, "loss_factor": 1e-3}},
        excitations={"e": {"on": "a", "harmonics": [{"order": 1, "torque": 3.0}]}},
    )


def engine(torque: float) -> lw.Machine:
    return machine(
        engine=ENGINE,
        discs={"flywheel": {"inertia": 2.0}},
        shafts={"s": {"between": ["throw_1", "flywheel"], "stiffness": 2e5, "loss_factor": 0.02}},
        loads={"brake": {"on": "flywheel", "torque": torque, "speed": 200.0, "exponent": 0.0}},
    )


def test_a_sharp_peak_between_the_speeds_is_found() -> None:
    study = lw.torsion_study(light())
    assert study.peaks is not None
    # M/η at ω² = k/J, times |1 + iη| for the torque with its damping; no speed of the run is near.
    assert study.peaks.vibratory[0] == pytest.approx(3.0 / 1e-3, rel=1e-5)
    assert study.peaks.speed[0] == pytest.approx(100.0, rel=1e-6)
    assert study.forced is not None
    assert study.forced.shaft_torque_vibratory.max() < 0.5 * study.peaks.vibratory[0]


def test_loads_that_ask_for_something_else_are_told() -> None:
    bore, stroke = 0.1, 0.1
    mean = 6e5 * 3.141592653589793 / 4 * bore**2 * stroke / (4 * 3.141592653589793)
    assert not [text for text in lw.torsion_study(engine(mean)).warnings if "loads were scaled" in text]
    (told,) = [text for text in lw.torsion_study(engine(10 * mean)).warnings if "loads were scaled" in text]
    assert "scaled by 0.1 " in told


def test_loads_damp_as_much_as_they_take() -> None:
    from linkwright.torsion import excited_train

    made = engine(100.0)
    assert made.train is not None
    brake = made.train.loads["brake"].model_copy(update={"exponent": 1.0})
    ten = brake.model_copy(update={"torque": 1000.0})
    one, other = (
        excited_train(
            made.model_copy(update={"train": made.train.model_copy(update={"loads": {"brake": load}})})
        )
        for load in (brake, ten)
    )
    # Both are scaled to what the engine gives, and so is their slope.
    assert other.torques.damping == pytest.approx(one.torques.damping, rel=1e-12)
    assert one.torques.damping[-1] == pytest.approx(-one.torques.mean[-1] / one.torques.speeds, rel=1e-12)


def test_loads_stay_as_given_unless_they_shall_follow() -> None:
    made = engine(10.0)
    assert made.train is not None
    assert made.train.run is not None
    run = made.train.run.model_copy(update={"loads_follow": False})
    study = lw.torsion_study(made.model_copy(update={"train": made.train.model_copy(update={"run": run})}))
    assert study.excited is not None
    assert study.forced is not None
    # Mean effective pressure times the swept volume over two revolutions, less the load.
    left = 6e5 * np.pi / 4 * 0.1**2 * 0.1 / (4 * np.pi) - 10.0
    np.testing.assert_allclose(study.excited.torques.surplus, left, rtol=1e-9)
    np.testing.assert_array_equal(study.excited.torques.load_factor, 1.0)
    # The shaft carries the load and what speeds the flywheel up with all the rest.
    J = study.excited.referred.inertia
    wanted = 10.0 + left * 2.0 / J.sum()
    np.testing.assert_allclose(study.forced.mean_torques[-1], wanted, rtol=1e-9)
    assert f"{left:+.5g} N m of the engine accelerates the train" in study.balance
    assert "loads were scaled by" in lw.torsion_study(made).balance


def test_a_curve_that_ends_below_the_mean_torque_is_told() -> None:
    made = machine(
        discs={"a": {"inertia": 1.0}, "b": {"inertia": 2.0}},
        couplings={"c": {"between": ["a", "b"], "twist": [0, 0.1], "torque": [0, 50], "damping": 1.0}},
        loads={
            "fan": {
                "on": "b",
                "torque": 80.0,
                "speed": 200.0,
                "harmonics": [{"order": 3, "share": 0.1}],
            }
        },
    )
    assert any("curve ends at 50 N m" in text for text in lw.torsion_study(made).warnings)


@pytest.mark.parametrize("entry", ["throws", "banks"])
def test_degrees_without_a_unit_are_refused(entry: str) -> None:
    angles = {"throws": [0.0, 90.0], "banks": [-45.0, 45.0]}[entry]
    with pytest.raises(MachineError, match=rf"train\.engine\.{entry}") as raised:
        machine(engine={**ENGINE, entry: angles, "firing_order": [1, 2], "stiffness": 1e6})
    assert "deg" in str(raised.value)


def test_the_speed_of_service_is_one_of_the_run() -> None:
    made = light()
    assert made.train is not None
    assert made.train.run is not None
    run = made.train.run.model_copy(update={"speed_rated": 77.7})
    assert 77.7 in run.speeds
    assert len(run.speeds) == 40
    assert (run.speeds[1:] > run.speeds[:-1]).all()
