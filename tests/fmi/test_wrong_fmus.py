"""Wrong input: machines that cannot be exported, damaged archives, wrong calls: each an error, no crash."""

from __future__ import annotations

import re
import shutil
import stat
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from command_line import invoke
from conftest import Unpacked
from fmus import BadArchiveError, Opened, opened, unpack

import linkwright as lw

VERSIONS = ("2.0", "3.0")

# Machine, overrides → what the message says.
REFUSED = {
    "topper": ((), "without a [mechanism]"),
    "v_diesel": ((), "train without a [mechanism]"),
    "topper_crank": ((), "constant_speed"),
    "cam_constant_breadth": ((), "no masses"),
    "rod_string_card": ((), "rod string"),
    "servo_press": ((), "servo axes"),
    "excavator_bucket": ((), "cylinders"),
    "roller_two_carts": (("drive.gearbox.reverse=0",), "self-locking"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_machine_that_cannot_be_exported(name: str, tmp_path: Path) -> None:
    """Exit code 2, a message with the remedy, no file."""
    overrides, words = REFUSED[name]
    sets = [word for entry in overrides for word in ("--set", entry)]
    result = invoke("fmu", name, *sets, "--out", tmp_path / "m.fmu")
    assert result.exit_code == 2
    assert words in result.stderr
    assert not (tmp_path / "m.fmu").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--fmi", "1"], "--fmi"),
        (["--accuracy", "1"], "accuracy"),
        (["--accuracy", "nan"], "accuracy"),
        (["--from-angle", "1 m"], "--from-angle"),
        (["--from-speed", "1e99"], "speed"),
    ],
)
def test_wrong_options(options: list[str], words: str, tmp_path: Path) -> None:
    """An option out of range is named, with exit code 2."""
    result = invoke("fmu", "roller_two_carts", *options, "--out", tmp_path / "m.fmu")
    assert result.exit_code == 2
    assert words in result.stderr
    assert not (tmp_path / "m.fmu").exists()


def test_a_missing_library_is_said(tmp_path: Path) -> None:
    """Without the library of this computer, the message says which file is missing and how it is built."""
    from linkwright.fmi.library import libraries

    with pytest.raises(lw.InputError, match="make fmu"):
        libraries(tmp_path)


@pytest.mark.skipif(sys.platform != "linux", reason="ldd is of Linux")
def test_the_library_needs_no_python(unpacked: Unpacked) -> None:
    """The library stands on the C library alone."""
    (library,) = (unpacked("roller_two_carts") / "binaries").rglob("*.so")
    listed = subprocess.run(["ldd", str(library)], capture_output=True, text=True, check=True).stdout
    names = {line.split()[0].rsplit("/", 1)[-1].split(".")[0] for line in listed.splitlines()}
    assert names <= {"linux-vdso", "libc", "libm", "libgcc_s", "ld-linux-x86-64", "libpthread", "libdl"}


def _copy(folder: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(folder, tmp_path / "copy"))


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("damage", ["missing", "empty", "cut", "noise", "zeros"])
def test_a_damaged_machine_is_refused(version: str, damage: str, unpacked: Unpacked, tmp_path: Path) -> None:
    """An FMU whose machine is missing or damaged is not instantiated; a message says why."""
    folder = _copy(unpacked("roller_two_carts", version), tmp_path)
    machine = folder / "resources" / "machine.lw"
    data = machine.read_bytes()
    if damage == "missing":
        machine.unlink()
    else:
        noise = bytes((7 * k * k + 13) % 251 for k in range(len(data)))
        machine.write_bytes(
            {"empty": b"", "cut": data[: len(data) // 2], "noise": noise, "zeros": bytes(len(data))}[damage]
        )
    log: list[str] = []
    with pytest.raises(Exception, match=r"(?i)instantiate"):
        Opened(folder, logged=log)
    assert log
    assert all(message.strip() for message in log)


@pytest.mark.parametrize("version", VERSIONS)
def test_single_changed_bytes_do_not_crash(version: str, unpacked: Unpacked, tmp_path: Path) -> None:
    """A machine with one changed byte is refused, or runs; the library never ends the process."""
    folder = _copy(unpacked("roller_one_cart", version), tmp_path)
    machine = folder / "resources" / "machine.lw"
    data = machine.read_bytes()
    refused = 0
    for at in range(0, len(data), max(1, len(data) // 40)):
        machine.write_bytes(data[:at] + bytes([data[at] ^ 0x5A]) + data[at + 1 :])
        try:
            unit = Opened(folder)
        except Exception:
            refused += 1
        else:
            unit.fmu.freeInstance()
    assert refused > 0


@pytest.mark.parametrize("version", VERSIONS)
def test_another_token_is_refused(version: str, unpacked: Unpacked, tmp_path: Path) -> None:
    """A description with another GUID does not fit the library's machine."""
    folder = _copy(unpacked("roller_two_carts", version), tmp_path)
    path = folder / "modelDescription.xml"
    token = lw.fmu(lw.read("roller_two_carts"), version=version).token
    path.write_text(path.read_text(encoding="utf-8").replace(token, "{0}"), encoding="utf-8")
    with pytest.raises(Exception, match=r"(?i)instantiate"):
        Opened(folder)


@pytest.mark.parametrize("version", VERSIONS)
def test_wrong_references_and_values(version: str, unpacked: Unpacked) -> None:
    """Unknown references, NaN, a negative brake, an output that is set: an error and a message."""
    log: list[str] = []
    with opened(unpacked("roller_two_carts", version), logged=log) as unit:
        unit.start()
        read = unit.fmu.getFloat64 if unit.is_3 else unit.fmu.getReal
        write = unit.fmu.setFloat64 if unit.is_3 else unit.fmu.setReal
        for reference in (12345, 2**32 - 1, 65536 * 7 + 60000):
            with pytest.raises(Exception, match=r"(?i)get"):
                read([reference])
        brake, torque, output = (
            unit.variables[name].valueReference for name in ("brake_torque", "external_torque", "torque_load")
        )
        for reference, value in (
            (torque, float("nan")),
            (torque, float("inf")),
            (brake, -1.0),
            (output, 1.0),
        ):
            count = len(log)
            with pytest.raises(Exception, match=r"(?i)set"):
                write([reference], [value])
            assert len(log) > count
        unit.step(0.0, 0.1)


@pytest.mark.parametrize("version", VERSIONS)
def test_numbers_beyond_the_range_of_the_file(version: str, unpacked: Unpacked) -> None:
    """What a machine file may not have, an FMU does not take: a message states value and range of the XML."""
    wrong = {
        "bodies.ram.mass": (-5.0, 1e300),
        "drive.gearbox.efficiency": (0.0, 2.0),
        "drive.flywheel.inertia": (-1.0,),
        "brake_torque": (-1.0,),
        "load_coupling": (-1.0,),
        "external_torque": (1e300,),
        "crank_speed": (1e300, -1e300),
        "crank_angle": (1e30,),
    }
    log: list[str] = []
    with opened(unpacked("press_from_rest", version), logged=log) as unit:
        before = unit.get(*wrong)
        for name, values in wrong.items():
            for value in values:
                with pytest.raises(Exception, match=r"(?i)set"):
                    unit.set({name: value})
                variable = unit.variables[name]
                low, high = float(variable.min), float(variable.max)
                assert not low <= value <= high
                found = [float(x) for x in re.findall(r"(?:found|from|to) (\S+?)(?=,|\s|$)", log[-1])]
                assert found == [value, low, high]
        assert unit.get(*wrong) == before
        unit.start()
        unit.step(0.0, 0.1)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("tolerance", [float("nan"), -1e-6, 1.0, float("inf")])
def test_a_tolerance_that_is_none(version: str, tolerance: float, unpacked: Unpacked) -> None:
    """A tolerance that no step can keep is an error with a message, not the default in silence."""
    log: list[str] = []
    unit = Opened(unpacked("roller_one_cart", version), logged=log)
    with pytest.raises(Exception, match=r"(?i)setupExperiment|enterInitializationMode"):
        unit.start(tolerance=tolerance)
    assert "the tolerance is" in log[-1]
    unit.fmu.freeInstance()


@pytest.mark.parametrize("version", VERSIONS)
def test_wrong_order_of_calls(version: str, unpacked: Unpacked) -> None:
    """A step before initialisation, one backwards or of no finite length: an error; then it goes on."""
    early = Opened(unpacked("roller_two_carts", version))
    with pytest.raises(Exception, match=r"(?i)doStep"):
        early.step(0.0, 0.1)
    early.fmu.freeInstance()
    with opened(unpacked("roller_two_carts", version)) as unit:
        unit.start()
        unit.step(0.0, 0.1)
        for time, length in ((0.1, -0.05), (0.1, float("nan")), (0.1, float("inf")), (7.0, 0.1)):
            with pytest.raises(Exception, match=r"(?i)doStep"):
                unit.step(time, length)
        unit.step(0.1, 0.1)


@pytest.mark.skipif(sys.platform != "linux", reason="the name of the library")
def test_null_pointers(unpacked: Unpacked) -> None:
    """Null in place of an instance or an array is an error status, no crash."""
    (library,) = (unpacked("roller_two_carts") / "binaries").rglob("*.so")
    code = f"""
import ctypes
lib = ctypes.CDLL({str(library)!r})
for name in ("fmi3GetFloat64", "fmi3SetFloat64"):
    assert getattr(lib, name)(None, None, ctypes.c_size_t(1), None, ctypes.c_size_t(1)) >= 3, name
for name in ("fmi2GetReal", "fmi2SetReal"):
    assert getattr(lib, name)(None, None, ctypes.c_size_t(1), None) >= 3, name
assert lib.fmi2DoStep(None, ctypes.c_double(0), ctypes.c_double(1), 0) >= 3
assert lib.fmi3Terminate(None) >= 3 and lib.fmi2Reset(None) >= 3
lib.fmi2FreeInstance(None); lib.fmi3FreeInstance(None)
lib.fmi2Instantiate.restype = ctypes.c_void_p
assert lib.fmi2Instantiate(None, 1, None, None, None, 0, 0) is None
"""
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("trick", ["../outside", "/tmp/outside", "a/../../outside", "back\\slash"])
def test_paths_outside_of_an_archive(trick: str, tmp_path: Path) -> None:
    """An archive with a path outside is not unpacked."""
    with zipfile.ZipFile(tmp_path / "bad.fmu", "w") as archive:
        info = zipfile.ZipInfo("name")
        info.filename = info.orig_filename = trick
        archive.writestr(info, "x")
    with pytest.raises(BadArchiveError):
        unpack(tmp_path / "bad.fmu", tmp_path / "into")


def test_links_in_an_archive(tmp_path: Path) -> None:
    """An archive with a symbolic link is not unpacked."""
    with zipfile.ZipFile(tmp_path / "bad.fmu", "w") as archive:
        info = zipfile.ZipInfo("resources/machine.lw")
        info.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(info, "/etc/hostname")
    with pytest.raises(BadArchiveError):
        unpack(tmp_path / "bad.fmu", tmp_path / "into")


def test_a_cut_archive(tmp_path: Path) -> None:
    """Half of an FMU is no archive."""
    data = lw.fmu(lw.read("roller_one_cart")).data
    (tmp_path / "bad.fmu").write_bytes(data[: len(data) // 2])
    with pytest.raises(zipfile.BadZipFile):
        unpack(tmp_path / "bad.fmu", tmp_path / "into")
