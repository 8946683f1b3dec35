"""The bar that shows progress: only where somebody looks, and only once it takes long."""

from __future__ import annotations

import io

import pytest

from linkwright.kernel.command import console as module
from linkwright.kernel.command.console import bar


class Terminal(io.StringIO):
    """What is written to somebody who looks."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("patience", "looks", "is_shown"), [(0, True, True), (60, True, False), (0, False, False)]
)
def test_a_bar_is_shown(
    patience: float, looks: bool, is_shown: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    written = Terminal() if looks else io.StringIO()
    monkeypatch.setattr("sys.stderr", written)
    monkeypatch.setattr(module, "_PATIENCE", patience)
    with bar("heads") as watch:
        for step in range(5):
            watch(step / 4)
    assert ("heads" in written.getvalue()) == is_shown


def breaks_off() -> None:
    with bar("heads") as watch:
        watch(0.5)
        raise ValueError("halfway")


def test_a_bar_ends_with_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    written = Terminal()
    monkeypatch.setattr("sys.stderr", written)
    monkeypatch.setattr(module, "_PATIENCE", 0)
    with pytest.raises(ValueError, match="halfway"):
        breaks_off()
    # The cursor that a bar hides is shown again.
    assert "\x1b[?25h" in written.getvalue()
