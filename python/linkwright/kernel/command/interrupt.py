"""An interrupt from the keyboard ends the command line with exit code 130, whatever it is doing.

Until the commands are imported it ends the program on the spot: nothing has been written, and an exception in
the middle of an import may come out as any other error. After that it is a `KeyboardInterrupt`, so that files
are left as they should be.
"""

from __future__ import annotations

# What `signal` is made of, in the interpreter itself; `signal` imports enumerations and collections first.
import _signal as signal  # type: ignore[import-not-found]
import os
import sys

from linkwright import end_on_the_spot

# As in `typing`. Whoever interrupts a start before this file is run gets Python's own traceback, so nothing
# large is imported until then.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from sys import UnraisableHookArgs
    from types import FrameType, TracebackType
    from typing import NoReturn

# What a shell reports for a program that was interrupted.
EXIT_CODE = 130


class Interrupts:
    """What is done about interrupts; a program that was started to ignore them does so."""

    def __init__(self) -> None:
        self.came = False

    def __enter__(self) -> Interrupts:
        """Begin to listen, before anything is imported."""
        self.heard = signal.getsignal(signal.SIGINT) in (signal.default_int_handler, end_on_the_spot)
        if self.heard:
            signal.signal(signal.SIGINT, end_on_the_spot)
        return self

    def raise_from_now_on(self) -> None:
        """Raise `KeyboardInterrupt` on an interrupt."""
        if self.heard:
            sys.unraisablehook = _end_or_tell
            signal.signal(signal.SIGINT, self._raise)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the program if it was interrupted, whatever error came of that."""
        if self.heard:
            signal.signal(signal.SIGINT, end_on_the_spot)
        is_done = isinstance(error, SystemExit) and not error.code
        if self.came and error is not None and not is_done:
            # Not by an exception: where the interrupt came inside an `exec`, as in many imports, Python would
            # end a program that was started by ``-m`` by the signal, with another code.
            sys.stderr.flush()
            os._exit(EXIT_CODE)

    def _raise(self, number: int, frame: FrameType | None) -> NoReturn:
        self.came = True
        raise KeyboardInterrupt


def _end_or_tell(unraisable: UnraisableHookArgs) -> None:
    """An interrupt where nothing can be raised, as in a finaliser, would be lost."""
    if issubclass(unraisable.exc_type, KeyboardInterrupt):
        os._exit(EXIT_CODE)
    sys.__unraisablehook__(unraisable)
