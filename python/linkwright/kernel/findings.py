"""What a study has to say: findings, what a machine cannot do, and warnings, what its designer should know.

A study hands one collector down to everything that it computes. An analysis that fails raises a
`FindingError`; one that succeeds may carry sentences of its own in ``findings``. Both are said, so none can
be left out by whoever asks for the result.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from linkwright.kernel.errors import FindingError

T = TypeVar("T")


@dataclass(frozen=True)
class Findings:
    """Collects sentences; the same one, or one of the same cause, counts once."""

    subject: str = ""  # what stands before each sentence that is collected, such as `"cam valve: "`
    # The findings and the warnings, in their order.
    said: list[str] = field(default_factory=list)
    beside: list[str] = field(default_factory=list)
    causes: set[str] = field(default_factory=set)  # of errors that have been said

    def about(self, subject: str) -> Findings:
        """The same collector, with a subject before what it collects."""
        return Findings(subject, self.said, self.beside, self.causes)

    def add(self, texts: Iterable[str]) -> None:
        """Collect findings."""
        self.said.extend(sentence(self.subject + text) for text in texts)

    def warn(self, texts: Iterable[str]) -> None:
        """Collect warnings."""
        self.beside.extend(sentence(self.subject + text) for text in texts)

    def of(self, analysis: Callable[..., T], *args: Any, **options: Any) -> T | None:
        """The result of an analysis, with its own findings collected; None, and a finding, if it fails."""
        return self._of(self.add, analysis, *args, **options)

    def beside_of(self, analysis: Callable[..., T], *args: Any, **options: Any) -> T | None:
        """The same for an analysis whose failure says nothing against the machine: it is a warning."""
        return self._of(self.warn, analysis, *args, **options)

    def _of(
        self, say: Callable[[Iterable[str]], None], analysis: Callable[..., T], *args: Any, **options: Any
    ) -> T | None:
        try:
            result = analysis(*args, **options)
        except FindingError as error:
            if not error.cause or error.cause not in self.causes:
                say([str(error)])
            self.causes.add(error.cause)
            return None
        say(getattr(result, "findings", ()))
        return result

    @property
    def findings(self) -> tuple[str, ...]:
        """What the machine cannot do, each once, in their order."""
        return tuple(dict.fromkeys(self.said))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What its designer should know, each once, in their order; not what is a finding already."""
        return tuple(text for text in dict.fromkeys(self.beside) if text not in self.said)


def sentence(text: str) -> str:
    """The text with a capital, unless it begins with an entry of the file, and a full stop."""
    start = text if _ENTRY.match(text) else f"{text[:1].upper()}{text[1:]}"
    return start.rstrip(".") + "."


# An entry of a machine file, such as ``turning_moment.areas``.
_ENTRY = re.compile(r"[a-z]+(?:_[a-z]+|\.\w+)+:")
