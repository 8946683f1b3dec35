"""The compiled core, of which a program is made: refused here if it was built from other sources."""

from __future__ import annotations

from linkwright import _core
from linkwright.kernel.core.core_format import check_format

check_format(_core)

# What a program consists of, for those who read it.
Element = _core.Element
Line = _core.Line

# Outcomes of machines, and what each number means.
Status = _core.Status
SENTENCES: dict[int, str] = dict(_core.Status.sentences())

SteadyMotion = _core.SteadyMotion
NoSteadyMotion = _core.NoSteadyMotion
