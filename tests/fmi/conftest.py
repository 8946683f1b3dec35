"""FMUs of machines, each made and unpacked once."""

from collections.abc import Callable
from pathlib import Path

import pytest
from fmus import unpack

import linkwright as lw
from linkwright.machine.machine import Machine

Unpacked = Callable[..., Path]


@pytest.fixture(scope="session")
def unpacked(tmp_path_factory: pytest.TempPathFactory) -> Unpacked:
    known: dict[tuple[str, str, tuple[object, ...]], Path] = {}

    def folder(machine: Machine | str, version: str = "3.0", **options: object) -> Path:
        machine = lw.read(machine) if isinstance(machine, str) else machine
        key = machine.name, version, (*options.items(), hash(machine.model_dump_json()))
        if key not in known:
            home = tmp_path_factory.mktemp("fmu")
            lw.fmu(machine, version=version, **options).write(home / "machine.fmu")
            known[key] = unpack(home / "machine.fmu", home / "unpacked")
        return known[key]

    return folder
