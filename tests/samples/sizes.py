"""How many random cases: few in `make test`, many in `make test-deep`."""

import os

# Set by `make test-deep`, which runs the tests that are marked `deep`.
DEEP = os.environ.get("LINKWRIGHT_DEEP") == "1"


def cases(few: int, many: int) -> int:
    """How many to look at: a few find what is broken for most, many what is broken for some."""
    return many if DEEP else few
