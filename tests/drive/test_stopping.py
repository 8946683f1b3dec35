"""A signal stops every long call soon; a forked process computes what its parent does."""

from __future__ import annotations

import contextlib
import multiprocessing
import signal
import time
from collections.abc import Callable, Iterator
from types import FrameType

import numpy as np
import pytest

import linkwright as lw
from linkwright import Machine

ONE_CART = "machines/roller_one_cart.toml"

# When the signal comes, and how long a call may go on: a second is promised, four leave room for a busy
# machine. Every call below takes longer if nothing stops it.
SIGNAL, PATIENCE = 0.1, 4.0

pytestmark = pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs timers of Unix")


class StopError(Exception):
    """What the handler of the signal raises."""


def _stop(number: int, frame: FrameType | None) -> None:
    raise StopError


@pytest.fixture
def alarm() -> Iterator[None]:
    before = signal.signal(signal.SIGALRM, _stop)
    yield
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def steady_motion_of_many() -> None:
    lw.steady_states(lw.read(ONE_CART), {"bodies.cart1.mass": np.linspace(400, 600, 3_000_000)})


def search_of_cams() -> None:
    radii = np.linspace(0.2, 0.4, 200_000)
    lw.search_cams(lw.read("machines/roller_cam.toml"), entries={"base_radius": radii}, per_turn=100_000)


def heads_in_a_field() -> None:
    lw.topper_field(lw.read("machines/topper.toml"), fine=200_000)


def motion_in_time() -> None:
    lw.transient(lw.read(ONE_CART), duration=2000.0, accuracy=1e-12)


def curves_of_steady_motion() -> None:
    lw.steady_state(lw.read(ONE_CART), n=3_000_000)


def forced_vibration() -> None:
    machine = lw.read("machines/v8_diesel.toml")
    lw.forced_vibration(machine, np.linspace(50, 200, 1_000_000))


def torsion_in_time() -> None:
    shaft = {"kind": "shaft", "between": ["a", "b"], "stiffness": 1e6}
    train = {
        "discs": {"a": {"inertia": 1.0}, "b": {"inertia": 1.0}},
        "shafts": {"s": {key: value for key, value in shaft.items() if key != "kind"}},
        "transient": {"duration": 1e5, "events": [{"kind": "torque", "on": "a", "torque": 1.0, "time": 0.0}]},
    }
    lw.torsion_transient(Machine.model_validate({"format": 1, "name": "two discs", "train": train}))


def third_derivatives() -> None:
    lw.kinematics(lw.read(ONE_CART), np.linspace(0, 6, 3_000_000), third=True)


LONG: list[Callable[[], None]] = [
    steady_motion_of_many,
    search_of_cams,
    heads_in_a_field,
    motion_in_time,
    curves_of_steady_motion,
    forced_vibration,
    torsion_in_time,
    third_derivatives,
]


@pytest.mark.usefixtures("alarm")
@pytest.mark.parametrize("call", LONG)
def test_a_signal_stops_a_long_call(call: Callable[[], None]) -> None:
    start = time.monotonic()
    signal.setitimer(signal.ITIMER_REAL, SIGNAL)
    with contextlib.suppress(StopError):
        call()
    assert time.monotonic() - start < PATIENCE


def _speeds() -> np.ndarray:
    found = lw.steady_states(lw.read(ONE_CART), {"bodies.cart1.mass": np.linspace(400, 600, 600)})
    return found.speed_max


def _in_a_fork(queue: multiprocessing.Queue) -> None:
    queue.put(_speeds())


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="needs fork")
# Python warns of forks where threads are at work.
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_process_computes_the_same_bits() -> None:
    # The threads that do this do not come along.
    here = _speeds()
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    children = [context.Process(target=_in_a_fork, args=(queue,)) for _ in range(2)]
    for child in children:
        child.start()
    try:
        for _ in children:
            np.testing.assert_array_equal(queue.get(timeout=60), here)
    finally:
        for child in children:
            child.kill()
