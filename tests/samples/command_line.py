"""The command line in the process of the tests."""

from __future__ import annotations

from typing import Any

from click.testing import CliRunner, Result

from linkwright.app.application import application


def invoke(*words: object, **options: Any) -> Result:
    """Run a command; `options` are those of click."""
    return CliRunner().invoke(application(), [str(word) for word in words], **options)
