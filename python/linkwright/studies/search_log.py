"""The log of a search: what was computed, so that a search that was stopped goes on by replaying it.

A search is a function of its seed and of the responses that it is given. Each line of the log is the result
of one computation, under a digest of its arguments. The same search asks for the same again: it reads the
log as far as that goes, and computes the rest. The first line is the digest of study and machine; a last
line that was cut off is dropped.
"""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import IO, Any

import numpy as np

from linkwright import __version__
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.files.output import unwritable
from linkwright.kernel.system import claims
from linkwright.machine.machine import Machine
from linkwright.machine.write import dumps
from linkwright.studies.engine import evaluate
from linkwright.studies.plan import StudyPlan
from linkwright.studies.rows import LAYOUT, Rows
from linkwright.studies.slopes import Slopes, slopes

# Layout of the lines of a log: 2 with how many machines derivatives took.
_LINES = 2

# A byte behind all that a log ever has: whoever claims it writes the log.
_CLAIMED = 1 << 30

# Steps of differences as a share of the range, where there are no exact derivatives.
_STEP = 1e-4


class SearchLog:
    """Computations of a search, each made once; from a file as far as they stand there.

    Raises InputError: the file is that of another study, or cannot be read or written.
    """

    def __init__(self, plan: StudyPlan, path: Path | None) -> None:
        self.known: dict[str, dict[str, Any]] = {}
        # Machines that were computed for this search, now or before it was stopped; and for what.
        self.count = 0
        self._counted: set[str] = set()
        self.file: IO[bytes] | None = None
        self._machine: tuple[Machine | None, str] = (None, "")
        if path is not None:
            self._open(path, self._digest(plan, "study", b""))

    def _open(self, path: Path, study: str) -> None:
        try:
            # As bytes: the place where it goes on is counted in them, with ends of lines as they are.
            self.file = path.open("a+b")
            if not claims(self.file, _CLAIMED, 1):
                raise InputError(
                    f"{path}: another search writes this log; wait until it ends, or name another file"
                )
            self.file.seek(0)
            data = self.file.read()
            lines = data.decode("utf-8").splitlines(keepends=True)
            complete = [line for line in lines if line.endswith("\n")]
            if complete and complete[0].strip() != study:
                raise InputError(
                    f"{path}: found the log of another search, or none; nothing was changed; name another"
                )
            self.known = dict(json.loads(line) for line in complete[1:])
            self.file.truncate(sum(len(line.encode()) for line in complete))
            self.file.write(b"" if complete else f"{study}\n".encode())
            self.file.flush()
        except InputError:
            self.close()
            raise
        except OSError as error:
            self.close()
            raise unwritable(path, error) from None
        except ValueError:
            self.close()
            raise InputError(
                f"{path}: found no log of a search; nothing was changed; name another file"
            ) from None

    def close(self) -> None:
        """Close the file."""
        if self.file is not None:
            self.file.close()

    def evaluate(self, plan: StudyPlan, values: Mapping[str, Floats]) -> Rows:
        """Responses of machines, as `engine.evaluate`."""
        asked = b"".join(np.ascontiguousarray(values[axis.name]).tobytes() for axis in plan.axes)

        def computed() -> dict[str, Any]:
            rows = evaluate(plan, values)
            columns = {name: column.tolist() for name, column in rows.columns.items()}
            rest = {"status": rows.status.tolist(), "reason": rows.reason.tolist(), "reasons": rows.reasons}
            rest |= {"fast_starts": rows.fast_starts.tolist(), "one_by_one": rows.one_by_one}
            return {"columns": columns, **rest}

        key = self._digest(plan, "rows", asked)
        line = self._line(key, computed)
        self._count_once(key, len(line["status"]))
        columns = {name: np.array(column, dtype=float) for name, column in line["columns"].items()}
        status, reason = np.array(line["status"], np.uint8), np.array(line["reason"], np.int32)
        fast_starts = np.array(line["fast_starts"], np.uint8)
        alone = Counter(line["one_by_one"])
        return Rows(columns, status, reason, list(line["reasons"]), fast_starts, alone)

    def slopes(self, plan: StudyPlan, shares: Floats) -> tuple[Floats, Floats, Slopes]:
        """Variables [SI] and their derivatives by the shares, (variables,) each; responses and slopes."""
        pairs = list(zip(plan.axes, shares, strict=True))
        at = np.array([axis.values(np.array([share]))[0] for axis, share in pairs], dtype=float)
        rates = np.array([axis.rate(value) for axis, value in zip(plan.axes, at, strict=True)])
        return at, rates, self._slopes(plan, at, _STEP * np.abs(rates))

    def _slopes(self, plan: StudyPlan, at: Floats, steps: Floats) -> Slopes:

        def computed() -> dict[str, Any]:
            there = slopes(plan, at, steps, machines.append)
            rates = {name: rate.tolist() for name, rate in there.slopes.items()}
            rest = {"exact": sorted(there.exact), "ties": there.ties, "machines": sum(machines)}
            return {"values": there.values, "slopes": rates, **rest}

        machines: list[int] = []
        key = self._digest(plan, "slopes", at.tobytes() + steps.tobytes())
        try:
            line = self._line(key, computed)
        except FindingError:
            self.count += sum(machines)
            raise
        self._count_once(key, line["machines"])
        rates = {name: np.array(rate) for name, rate in line["slopes"].items()}
        return Slopes(dict(line["values"]), rates, frozenset(line["exact"]), dict(line["ties"]))

    def _count_once(self, key: str, machines: int) -> None:
        self.count += 0 if key in self._counted else machines
        self._counted.add(key)

    def _line(self, key: str, compute: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        if key not in self.known:
            self.known[key] = compute()
            if self.file is not None:
                self._write(key)
        return self.known[key]

    def _write(self, key: str) -> None:
        assert self.file is not None
        try:
            self.file.write(json.dumps([key, self.known[key]]).encode() + b"\n")
            self.file.flush()
            os.fsync(self.file.fileno())
        except OSError as error:
            raise unwritable(Path(str(self.file.name)), error) from None

    def _digest(self, plan: StudyPlan, kind: str, asked: bytes) -> str:
        if self._machine[0] is not plan.machine:
            study = plan.study.model_dump_json(by_alias=True, exclude_unset=True)
            self._machine = plan.machine, f"{__version__} {LAYOUT} {_LINES}\n{study}\n{dumps(plan.machine)}"
        names = ",".join(axis.name for axis in plan.axes)
        return sha256(f"{kind}\n{names}\n{self._machine[1]}\n".encode() + asked).hexdigest()
