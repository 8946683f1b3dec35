"""What a case must never do, and how it is watched.

An answer, an input error and a finding are all right. Everything else is a fault of the product: another
exception, a warning of numpy, a panic, a hang, a law of mechanics that does not hold.
"""

from __future__ import annotations

import signal
import threading
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import FrameType

from linkwright.kernel.errors import LinkwrightError

# Far more than any case needs on a busy machine, far less than anyone would wait.
SECONDS = 60.0

# A case that integrates by other means as well, or runs a command, takes longer.
LONGEST = 120.0


class PromiseError(Exception):
    """A promise that did not hold, with what is needed to see it again.

    Parameters
    ----------
    what : str
        The promise and the numbers.
    inputs : mapping of str to str or bytes
        Name and content of each file, and ``command`` for what was called.
    """

    def __init__(self, what: str, inputs: Mapping[str, str | bytes] | None = None) -> None:
        super().__init__(what)
        self.what = what
        self.inputs = dict(inputs or {})


class Hang(BaseException):
    """The time is over. No `Exception`, so that nothing on the way takes it for an ordinary failure."""


@contextmanager
def watched(inputs: Mapping[str, str | bytes], seconds: float = SECONDS) -> Iterator[None]:
    """Let a body answer or raise one of Linkwright's errors; turn anything else into `PromiseError`."""
    try:
        with warnings.catch_warnings(), deadline(seconds):
            warnings.simplefilter("error")
            yield
    except (LinkwrightError, PromiseError):
        raise
    except Hang:
        raise PromiseError(f"no answer within {seconds:g} s", inputs) from None
    except KeyboardInterrupt:
        raise
    # A panic of the core reaches Python as a BaseException.
    except BaseException as error:
        raise PromiseError(f"{type(error).__name__}: {error}", inputs) from error


@contextmanager
def deadline(seconds: float) -> Iterator[None]:
    """Raise `Hang` in the body when the time is over; only the main thread can be interrupted."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def over(_signal: int, _frame: FrameType | None) -> None:
        raise Hang

    before = signal.signal(signal.SIGALRM, over)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
