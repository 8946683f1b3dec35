"""What all tests share: random cases are always the same ones, and a busy machine is no failure."""

import os

# Tests run beside each other: threads of linear algebra would only wait for one another, busily. It counts
# before NumPy is imported, and for the processes that tests start.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings
from sizes import DEEP, cases

settings.register_profile("same cases, any speed", derandomize=True, deadline=None)
settings.register_profile("other cases each time", max_examples=1000, deadline=None)
settings.load_profile("other cases each time" if DEEP else "same cases, any speed")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What sizes its cases by `cases` has more of them in `make test-deep`, which runs what is `deep`."""
    for item in items:
        if getattr(getattr(item, "module", None), "cases", None) is cases:
            item.add_marker(pytest.mark.deep)
