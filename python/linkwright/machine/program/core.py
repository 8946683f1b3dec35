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

# What of a machine is asked for, and what the core answers.
Channel = _core.Channel
Reductions = _core.Reductions
SteadyMotion = _core.SteadyMotion
SteadySolution = _core.SteadySolution
SteadyCurves = _core.SteadyCurves
NoSteadyMotion = _core.NoSteadyMotion
