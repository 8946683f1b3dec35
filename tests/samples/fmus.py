"""FMUs as an importing tool has them: unpacked, instantiated, advanced, by fmpy, alike for both versions."""

from __future__ import annotations

import itertools
import stat
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any
from zipfile import ZipFile

import fmpy
from fmpy.fmi2 import FMU2Model, FMU2Slave
from fmpy.fmi3 import FMU3Model, FMU3Slave
from fmpy.model_description import ModelDescription, read_model_description
from sizes import DEEP

# Content that a test unpacks at most, and how much smaller it may be packed.
_BYTES_MAX = 200_000_000


class BadArchiveError(Exception):
    """An archive that would write beside its folder, or more than it may."""


def unpack(path: Path, folder: Path) -> Path:
    """Unpack an FMU; one with paths outside, links or too much content is a `BadArchiveError`."""
    with ZipFile(path) as archive:
        if sum(info.file_size for info in archive.infolist()) > _BYTES_MAX:
            raise BadArchiveError("too much content")
        for info in archive.infolist():
            place = PurePosixPath(info.filename)
            if "\\" in info.orig_filename or place.is_absolute() or ".." in place.parts:
                raise BadArchiveError(f"{info.orig_filename}: a path outside of the archive")
            if stat.S_ISLNK(info.external_attr >> 16):
                raise BadArchiveError(f"{info.filename}: a link")
        archive.extractall(folder)
    return folder


@lru_cache(maxsize=4)
def described(folder: Path) -> ModelDescription:
    """The description of an FMU that was unpacked: to read it takes longer than to instantiate the FMU."""
    return read_model_description(str(folder), validate=False)


def combined(names: Sequence[str], versions: Sequence[str]) -> list[tuple[str, str]]:
    """Names with versions of FMI: all pairs in `make test-deep`, else each name with one version in turn."""
    if DEEP:
        return list(itertools.product(names, versions))
    return list(zip(names, itertools.cycle(versions)))


class Opened:
    """An instance of an FMU: variables by name, calls the same in both versions."""

    def __init__(self, folder: Path, *, exchange: bool = False, logged: list[str] | None = None) -> None:
        self.description = described(folder)
        self.exchange, self.log = exchange, [] if logged is None else logged
        self.is_3 = self.description.fmiVersion.startswith("3")
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        interface = self.description.modelExchange if exchange else self.description.coSimulation
        kinds: Any = (
            (FMU3Model if exchange else FMU3Slave) if self.is_3 else (FMU2Model if exchange else FMU2Slave)
        )
        self.fmu = kinds(
            guid=self.description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=interface.modelIdentifier,
            instanceName="test",
        )
        if self.is_3:
            self.fmu.instantiate(logMessage=self._logged3, loggingOn=True)
        else:
            self.fmu.instantiate(callbacks=self._callbacks2(), loggingOn=True)

    def _logged3(self, environment: Any, status: int, category: bytes, message: bytes) -> None:
        self.log.append(message.decode())

    def _callbacks2(self) -> Any:
        from fmpy.fmi2 import (
            calloc,
            fmi2CallbackAllocateMemoryTYPE,
            fmi2CallbackFreeMemoryTYPE,
            fmi2CallbackFunctions,
            fmi2CallbackLoggerTYPE,
            free,
        )

        def logged(environment: Any, name: bytes, status: int, category: bytes, message: bytes) -> None:
            self.log.append(message.decode())

        # Kept as long as the instance: the library calls them.
        self._callbacks = fmi2CallbackFunctions(
            fmi2CallbackLoggerTYPE(logged),
            fmi2CallbackAllocateMemoryTYPE(calloc),
            fmi2CallbackFreeMemoryTYPE(free),
        )
        return self._callbacks

    def start(self, values: Mapping[str, float | bool] = {}, *, tolerance: float | None = None) -> None:
        """Initialise with start values; in model exchange, events of the start are done."""
        self.set(values)
        if self.is_3:
            self.fmu.enterInitializationMode(tolerance=tolerance, startTime=0.0)
        else:
            self.fmu.setupExperiment(tolerance=tolerance, startTime=0.0)
            self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        if self.exchange:
            self.settle()
            self.fmu.enterContinuousTimeMode()

    def settle(self) -> None:
        """Iterate over discrete states until nothing changes."""
        for _ in range(20):
            if self.is_3:
                (again, *_rest) = self.fmu.updateDiscreteStates()
            else:
                (again, *_rest) = self.fmu.newDiscreteStates()
            if not again:
                return
        raise AssertionError("the events of an instant do not end")

    def _reference(self, name: str) -> list[int]:
        return [self.variables[name].valueReference]

    def set(self, values: Mapping[str, float | bool]) -> None:
        """Set variables by name."""
        for name, value in values.items():
            if isinstance(value, bool):
                self.fmu.setBoolean(self._reference(name), [value])
            else:
                (self.fmu.setFloat64 if self.is_3 else self.fmu.setReal)(self._reference(name), [value])

    def get(self, *names: str) -> list[float]:
        """Numbers by name."""
        read = self.fmu.getFloat64 if self.is_3 else self.fmu.getReal
        return list(read([self.variables[name].valueReference for name in names]))

    def flag(self, name: str) -> bool:
        """A truth value by name."""
        return bool(self.fmu.getBoolean(self._reference(name))[0])

    def step(self, time: float, length: float) -> None:
        """One communication step."""
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=length)

    def run(self, times: Sequence[float], *names: str) -> list[list[float]]:
        """Numbers at times, the first of which is now."""
        rows = [self.get(*names)]
        for start, end in itertools.pairwise(times):
            self.step(float(start), float(end) - float(start))
            rows.append(self.get(*names))
        return rows

    def along(self, unknowns: Sequence[str], known: str) -> list[float]:
        """Derivatives of variables by one."""
        references = [self.variables[name].valueReference for name in unknowns]
        by = self._reference(known)
        if self.is_3:
            return list(self.fmu.getDirectionalDerivative(references, by, [1.0], len(references)))
        return list(self.fmu.getDirectionalDerivative(references, by, [1.0]))

    def kept(self) -> bytes:
        """The state of the instance as bytes."""
        if self.is_3:
            state = self.fmu.getFMUState()
            data: bytes = self.fmu.serializeFMUState(state)
            self.fmu.freeFMUState(state)
            return data
        state = self.fmu.getFMUstate()
        data = self.fmu.serializeFMUstate(state)
        self.fmu.freeFMUstate(state)
        return data

    def restore(self, data: bytes) -> None:
        """The instance as it was."""
        if self.is_3:
            state = self.fmu.deserializeFMUState(data)
            self.fmu.setFMUState(state)
            self.fmu.freeFMUState(state)
        else:
            state = self.fmu.deSerializeFMUstate(data)
            self.fmu.setFMUstate(state)
            self.fmu.freeFMUstate(state)

    def close(self) -> None:
        """Terminate and free."""
        self.fmu.terminate()
        self.fmu.freeInstance()


@contextmanager
def opened(folder: Path, **options: Any) -> Iterator[Opened]:
    """An instance that is freed in the end."""
    instance = Opened(folder, **options)
    try:
        yield instance
    finally:
        instance.close()


def simulated(folder: Path, kind: str, stop: float, step: float, names: Sequence[str], **options: Any) -> Any:
    """A simulation by fmpy: a structured array over time."""
    return fmpy.simulate_fmu(
        str(folder),
        fmi_type=kind,
        stop_time=stop,
        output_interval=step,
        output=list(names),
        validate=False,
        **options,
    )
