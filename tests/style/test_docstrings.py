"""Docstrings say what is there: every public name has one, its parameters are those of the signature."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from types import ModuleType
from typing import Any

import pytest

import linkwright as lw
from linkwright.kernel.description.base import Description

# Modules whose functions and classes are documented in full: what a user calls.
PUBLIC_PACKAGES = (
    "machine",
    "linkages",
    "drive",
    "kinetostatics",
    "cam",
    "torsion",
    "pumping",
    "rods",
    "topping",
    "synthesis",
    "sizing",
    "studies",
    "kernel",
    "app",
)

_SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)
_ENTRY = re.compile(r"^(\*{0,2}\w[\w, *]*?)\s*(?::\s*(.+))?$")
_ARRAY = re.compile(r"\bndarray\b|\barray_like\b")
_SHAPE = re.compile(r"shape \(|\([\w +,]+\)")


def modules() -> Iterator[ModuleType]:
    for found in pkgutil.walk_packages(lw.__path__, "linkwright."):
        last = found.name.rsplit(".", 1)[-1]
        if not last.startswith("_"):
            yield importlib.import_module(found.name)


def own(module: ModuleType) -> Iterator[tuple[str, Any]]:
    """Public functions and classes that a module defines."""
    for name, member in vars(module).items():
        is_own = getattr(member, "__module__", None) == module.__name__
        if is_own and not name.startswith("_") and (inspect.isfunction(member) or inspect.isclass(member)):
            yield f"{module.__name__}.{name}", member


def callables() -> Iterator[tuple[str, Any]]:
    for module in modules():
        for name, member in own(module):
            yield name, member
            if inspect.isclass(member):
                for method, function in vars(member).items():
                    if inspect.isfunction(function) and not method.startswith("_"):
                        yield f"{name}.{method}", function


EVERYTHING = dict(callables())


def section(docstring: str, wanted: str) -> str | None:
    """Text of a section of a docstring; None if there is no such section."""
    parts = _SECTION.split(inspect.cleandoc(docstring))
    found = dict(zip(parts[1::2], parts[2::2], strict=True))
    return found.get(wanted)


def entries(text: str) -> dict[str, str]:
    """Names of a section → what stands behind their colon; names that share a line are taken apart."""
    found: dict[str, str] = {}
    for line in text.splitlines():
        if line and not line[0].isspace() and (match := _ENTRY.match(line)):
            for name in match[1].split(","):
                found[name.strip().lstrip("*")] = match[2] or ""
    return found


def arguments(function: Callable[..., Any]) -> set[str]:
    return set(inspect.signature(function).parameters) - {"self", "cls"}


def differences(name: str, member: Any) -> list[str]:
    text = section(member.__doc__ or "", "Parameters")
    if text is None:
        return []
    documented = set(entries(text))
    given = arguments(member)
    return [f"{name}: {each} is documented, not there" for each in sorted(documented - given)] + [
        f"{name}: {each} is there, not documented" for each in sorted(given - documented)
    ]


def test_all_public_names_have_docstrings() -> None:
    assert [name for name, member in EVERYTHING.items() if not inspect.getdoc(member)] == []


def test_parameters_are_those_of_the_signature() -> None:
    wrong = [line for name, member in EVERYTHING.items() for line in differences(name, member)]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("name", [name for name in lw.__all__ if name != "__version__"])
def test_public_functions_are_documented_in_full(name: str) -> None:
    member = getattr(lw, name)
    if not inspect.isfunction(member):
        return
    assert section(member.__doc__ or "", "Parameters" if name.startswith("write") else "Returns") is not None
    if arguments(member):
        assert section(member.__doc__ or "", "Parameters") is not None


def test_arrays_have_shapes() -> None:
    wrong = []
    for name, member in EVERYTHING.items():
        if not name.startswith(tuple(f"linkwright.{part}" for part in PUBLIC_PACKAGES)):
            continue
        wrong += [f"{name}: {each}" for each in _without_shape(member.__doc__ or "")]
    assert not wrong, "\n".join(wrong)


def _without_shape(docstring: str) -> list[str]:
    """Arrays of a docstring whose shape is said neither for them, nor once for the whole section."""
    body = inspect.cleandoc(docstring)
    head = body.split("\n\n", 1)[0]
    wrong = []
    for title in ("Parameters", "Attributes", "Returns"):
        arrays = [
            (key, kind) for key, kind in entries(section(body, title) or "").items() if _ARRAY.search(kind)
        ]
        # One shape serves the arrays after it, and a shape in the first sentence serves all.
        known = bool(_SHAPE.search(head))
        for key, kind in arrays:
            known = known or "shape" in kind or "as " in kind
            if not known and "optional" not in kind:
                wrong.append(f"{key} ({title})")
    return wrong


def test_attributes_of_results_are_documented() -> None:
    wrong = []
    for name, member in EVERYTHING.items():
        text = section(member.__doc__ or "", "Attributes") if inspect.isclass(member) else None
        if text is None or not is_dataclass(member):
            continue
        there = {each.name for each in fields(member) if not each.name.startswith("_")}
        there |= {key for key, value in inspect.getmembers(member) if isinstance(value, property)}
        wrong += [f"{name}: {each} is documented, not there" for each in sorted(set(entries(text)) - there)]
        # What is inherited is documented where it is from.
        own = vars(member).get("__annotations__", {})
        missing = {each.name for each in fields(member) if each.name in own} - set(entries(text))
        wrong += [f"{name}: {each} is not documented" for each in sorted(missing) if not each.startswith("_")]
    assert not wrong, "\n".join(wrong)


def test_entries_of_descriptions_are_described() -> None:
    wrong = []
    for name, member in EVERYTHING.items():
        if inspect.isclass(member) and issubclass(member, Description):
            wrong += [
                f"{name}.{key}"
                for key, field in member.model_fields.items()
                if key != "kind" and not field.description
            ]
    assert not wrong, "\n".join(wrong)


def test_a_wrong_docstring_is_found() -> None:
    def sample(a: float, b: float) -> float:
        """Sample.

        Parameters
        ----------
        a, c : float
            Numbers.
        """
        return a + b

    assert differences("sample", sample) == [
        "sample: c is documented, not there",
        "sample: b is there, not documented",
    ]
    assert _without_shape("X.\n\nParameters\n----------\nx : ndarray\n    Numbers.") == ["x (Parameters)"]
