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

from linkwright import LinkwrightError

# Processor time that a call may take [s]: far more than any needs, far less than anyone would wait. On a
# machine with much else to do a call waits, which is no fault of its own.
SECONDS = 60.0

# The same for a case that integrates by other means as well [s].
LONGEST = 120.0

# Who takes no processor time either waits endlessly: this many times as long on the clock is a deadlock,
# however much else there is to do.
CLOCK = 20.0


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
    except Hang as hang:
        raise PromiseError(str(hang), inputs) from None
    except KeyboardInterrupt:
        raise
    # A panic of the core reaches Python as a BaseException.
    except BaseException as error:
        raise PromiseError(f"{type(error).__name__}: {error}", inputs) from error


@contextmanager
def deadline(seconds: float) -> Iterator[None]:
    """Raise `Hang` in a body that has taken that much processor time.

    Only the main thread is interrupted, and only where there are timers, which Windows has not.
    """
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "setitimer"):
        yield
        return
    limits = (
        (signal.ITIMER_PROF, signal.SIGPROF, seconds, "of processor time"),
        (signal.ITIMER_REAL, signal.SIGALRM, CLOCK * seconds, "on the clock"),
    )
    words = {number: f"no answer within {limit:g} s {of}" for _, number, limit, of in limits}

    def over(number: int, _frame: FrameType | None) -> None:
        raise Hang(words[number])

    before = [signal.signal(number, over) for _, number, _, _ in limits]
    try:
        for timer, _, limit, _ in limits:
            signal.setitimer(timer, limit)
        yield
    finally:
        for (timer, number, _, _), handler in zip(limits, before, strict=True):
            signal.setitimer(timer, 0.0)
            signal.signal(number, handler)
