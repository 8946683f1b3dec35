"""Rooms of the core use what stands below them, and no modules of it stand on each other."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CRATE = ROOT / "crates" / "linkwright-core"
SOURCE = CRATE / "src"

Module = tuple[str, ...]

# What each room of the core stands on. Subjects know nothing of each other, but that a drive moves a
# linkage; the plan decodes what both consist of.
STANDS_ON: dict[str, set[str]] = {
    "kernel": set(),
    "linkage": {"kernel"},
    "drive": {"kernel", "linkage"},
    "cam": {"kernel"},
    "torsion": {"kernel"},
    "topper": {"kernel"},
    "plan": {"kernel", "linkage", "drive"},
}


def modules(root: Path) -> dict[Module, Path]:
    """Every module below the crate, and its file."""
    found = {}
    for path in sorted(root.rglob("*.rs")):
        name = path.relative_to(root).with_suffix("").parts
        name = name[:-1] if name[-1] in ("mod", "lib") else name
        found[name] = path
    return found


def code(path: Path) -> str:
    """The text of a file without its comments and without its unit tests, which stand at its end."""
    text = re.sub(r"//[^\n]*", "", path.read_text(encoding="utf-8"))
    return text.split("#[cfg(test)]")[0]


def _paths(tree: str) -> Iterator[Module]:
    """Paths of ``a::{b, c::{d, e}}``, which may have more text behind."""
    if match := re.match(r"(\w+)\s*(::\s*)?", tree):
        if not match[2]:
            yield (match[1],)
        else:
            yield from ((match[1], *rest) for rest in _paths(tree[match.end() :]) or [()])
    elif tree.startswith("{"):
        for branch in _branches(tree):
            yield from _paths(branch)
    else:
        # A glob, or the types of a generic function: what stands before is the path.
        yield ()


def _branches(tree: str) -> list[str]:
    """What stands between the commas of the braces at the start of a text."""
    branches, depth = [""], 0
    for letter in tree:
        depth += (letter == "{") - (letter == "}")
        if depth == 0:
            break
        if letter == "," and depth == 1:
            branches.append("")
        elif (letter, depth) != ("{", 1) or branches[-1]:
            branches[-1] += letter
    return [branch.strip() for branch in branches if branch.strip()]


def _own_modules(text: str) -> set[str]:
    """Modules that a file declares, which it may name without ``self``."""
    return set(re.findall(r"\bmod (\w+);", text))


def named(own: Module, path: Path) -> Iterator[Module]:
    """Paths from the root of the crate that a file names, in ``use`` or in its code."""
    text, is_folder = code(path), path.stem in ("mod", "lib")
    firsts = {"crate", "self", "super", *_own_modules(text)}
    for match in re.finditer(rf"(?<![\w:])({'|'.join(sorted(firsts))})::", text):
        for parts in _paths(text[match.start() :]):
            base = own
            if parts[0] == "crate":
                base, parts = (), parts[1:]
            elif parts[0] == "self":
                parts = parts[1:]
            while parts[:1] == ("super",):
                base, parts = base[:-1], parts[1:]
            if match[1] == "super" or is_folder or match[1] == "crate":
                yield (*base, *parts)


def _methods(text: str) -> Iterator[tuple[str, str, bool]]:
    """Type, method, and whether the type is defined elsewhere, of every block of methods."""
    defined = set(re.findall(r"\b(?:struct|enum|trait) (\w+)", text))
    for block in re.split(r"\n(?=impl\b)", text)[1:]:
        head = re.match(r"impl(?:<[^{]*?>)? (?:(\w+)(?:<[^{]*?>)? for )?(?:\w+::)*(\w+)", block)
        if head and not head[1]:
            body = block.split("\n}")[0]
            for name in re.findall(r"\bfn (\w+)", body):
                yield head[2], name, head[2] not in defined


def methods_elsewhere(texts: dict[Module, str]) -> dict[str, Module]:
    """Methods that a module gives to a type of another: to call them is to use it, without a ``use``.

    Names that several modules give say nothing.
    """
    givers: dict[str, set[Module]] = defaultdict(set)
    elsewhere: dict[str, Module] = {}
    for own, text in texts.items():
        for name in re.findall(r"\bfn (\w+)", text):
            givers[name].add(own)
        for _, name, is_elsewhere in _methods(text):
            if is_elsewhere:
                elsewhere[name] = own
    return {name: own for name, own in elsewhere.items() if len(givers[name]) == 1}


def uses(root: Path) -> dict[Module, set[Module]]:
    """Of every module the modules that it uses."""
    files = modules(root)
    texts = {own: code(path) for own, path in files.items()}
    given = methods_elsewhere(texts)
    found: dict[Module, set[Module]] = {}
    for own, path in files.items():
        targets = {_module_of(name, files) for name in named(own, path)}
        calls = set(re.findall(r"(?:\.|\w::)(\w+)(?:::<[^()]*>)?\(", texts[own]))
        targets |= {given[name] for name in calls & given.keys()}
        found[own] = targets - {own, ()}
    return found


def _module_of(name: Module, files: dict[Module, Path]) -> Module:
    """The innermost module that a path leads to."""
    return max((name[:n] for n in range(len(name) + 1) if name[:n] in files), key=len, default=())


def wrong_doors(used: dict[Module, set[Module]]) -> list[str]:
    """Uses of a room that does not stand below."""
    return [
        f"{'::'.join(own)} uses {'::'.join(target)}"
        for own, targets in sorted(used.items())
        for target in sorted(targets)
        if own and own[0] != target[0] and target[0] not in STANDS_ON[own[0]]
    ]


def circle(used: dict[Module, set[Module]]) -> list[str]:
    """Modules that stand on each other, the first named again at the end; none if there are none."""
    try:
        TopologicalSorter(used).prepare()
    except CycleError as error:
        return ["::".join(name) for name in error.args[1]]
    return []


def test_rooms_use_what_stands_below() -> None:
    wrong = wrong_doors(uses(SOURCE))
    assert not wrong, "\n".join(wrong)


def test_no_modules_stand_on_each_other() -> None:
    assert not circle(uses(SOURCE))


def test_every_room_is_listed_and_stands() -> None:
    assert {name[0] for name in modules(SOURCE) if name} == STANDS_ON.keys()
    assert not circle({(room,): {(below,) for below in belows} for room, belows in STANDS_ON.items()})


def test_every_door_is_used() -> None:
    doors = {(own[0], target[0]) for own, targets in uses(SOURCE).items() if own for target in targets}
    assert doors >= {(room, below) for room, belows in STANDS_ON.items() for below in belows}


def test_every_room_has_its_map() -> None:
    missing = []
    for path in modules(SOURCE).values():
        text = path.read_text(encoding="utf-8")
        told = "\n".join(line for line in text.splitlines() if line.startswith("//!"))
        public = re.findall(r"^pub mod (\w+);", text, re.MULTILINE)
        missing += [f"{path.relative_to(SOURCE)}: {name}" for name in public if f"[`{name}`]" not in told]
    assert not missing, "\n".join(missing)


def test_modules_that_the_texts_name_exist() -> None:
    known = {"::".join(name) for name in modules(SOURCE)}
    pages = {page: page.read_text(encoding="utf-8") for page in (ROOT / "docs").rglob("*.md")}
    heads = {
        page: re.search(r"^\*Core modules? ([^;]*?)[.;:][ *\n]", text, re.M) for page, text in pages.items()
    }
    named = [(page, name) for page, head in heads.items() if head for name in re.findall(r"`(.*?)`", head[1])]
    assert len(named) > 20
    assert [(page.name, name) for page, name in named if name not in known] == []


def test_files_that_the_architecture_names_exist() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8").split("### A crank radius")[1]
    named = re.findall(r"`([\w/]+\.rs)`", text)
    assert len(named) > 20
    assert [name for name in named if not ((SOURCE / name).exists() or (CRATE / name).exists())] == []


HOUSE = {
    "lib.rs": "pub mod cam;\npub mod drive;\npub mod kernel;",
    "kernel/mod.rs": "pub mod real;",
    "kernel/real.rs": "pub trait Real {}\n#[cfg(test)]\nmod tests { use crate::cam::Cam; }",
    "cam/mod.rs": "pub mod shape;\npub struct Cam;",
    "cam/shape.rs": "use super::Cam;\nuse crate::kernel::{real::{Real, self}, real};",
    "drive/mod.rs": "pub mod plan;\npub mod reduce;",
    "drive/plan.rs": "pub struct Plan;",
    "drive/reduce.rs": "use super::plan::Plan;\nimpl Plan {\n    pub fn reduce<R>(&self) {}\n}",
}


PLAN = "pub struct Plan;\n"
REDUCES = {"drive::plan", "drive::reduce"}


@pytest.mark.parametrize(
    ("path", "text", "doors", "standing"),
    [
        ("kernel/real.rs", "// crate::cam::Cam", [], set()),
        ("kernel/real.rs", "use crate::cam::{shape, Cam};", ["cam", "cam::shape"], set()),
        ("cam/shape.rs", "fn f() { crate::drive::plan::Plan }", ["drive::plan"], set()),
        ("cam/shape.rs", "fn f() { super::super::drive::reduce::f::<f64>() }", ["drive::reduce"], set()),
        ("cam/mod.rs", "mod shape;\nuse shape::Shape;\npub struct Cam;", [], {"cam", "cam::shape"}),
        ("cam/mod.rs", "mod shape;\nuse self::shape::*;\npub struct Cam;", [], {"cam", "cam::shape"}),
        ("drive/plan.rs", f"use super::reduce::{{Row}};\n{PLAN}", [], REDUCES),
        ("drive/plan.rs", f"{PLAN}fn f(p: Plan) {{ p.reduce::<f64>() }}", [], REDUCES),
    ],
)
def test_wrong_uses_are_found(
    tmp_path: Path, path: str, text: str, doors: list[str], standing: set[str]
) -> None:
    for name, content in (HOUSE | {path: text}).items():
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content)
    used = uses(tmp_path)
    own = path.removesuffix(".rs").replace("/", "::")
    assert wrong_doors(used) == [f"{own} uses {door}" for door in doors]
    if not doors:
        assert set(circle(used)) == standing
