"""Whether the compiled core speaks the language of this package: a stale one would compute wrong numbers."""

from __future__ import annotations

from linkwright.kernel.errors import CoreError

# As `FORMAT` in `crates/linkwright-core/src/plan/mod.rs`: the two change together.
FORMAT = 15


def check_format(core: object) -> None:
    """Refuse a core that was built from other sources.

    Parameters
    ----------
    core : module
        The compiled core.

    Raises
    ------
    CoreError
        Its number is another one, or it has none.
    """
    found = getattr(core, "FORMAT", None)
    if found != FORMAT:
        raise CoreError(found, FORMAT, str(getattr(core, "__file__", "linkwright._core")))
