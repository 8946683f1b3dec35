"""Rooms of the core use what stands below them, and no modules of it stand on each other.

Rooms that know no mechanism are crates, so that Cargo keeps them apart; the others lie in `linkwright-core`.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CRATES = ROOT / "crates"

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
    "rods": {"kernel"},
    "plan": {"kernel", "linkage", "drive"},
    "driveline": {"kernel", "linkage", "drive"},
    "derivatives": {"kernel", "linkage", "drive", "driveline"},
    # A machine for other simulation tools: what moves in time, and nothing of FMI.
    "exchange": {"kernel", "linkage", "drive", "plan", "driveline"},
}

# The borders have no kernels: they convert what crosses them.
BORDER = {"border", "py", "fmu"}


def source(room: str) -> Path:
    crate = CRATES / f"linkwright-{room}" / "src"
    return crate if crate.exists() else CRATES / "linkwright-core" / "src" / room


def sources(crates: Path) -> dict[Path, Module]:
    """Folders of sources, and the name under which the core offers each: that of a room, or none."""
    rooms = {path: path.parent.name.removeprefix("linkwright-") for path in crates.glob("linkwright-*/src")}
    return {path: () if room == "core" else (room,) for path, room in rooms.items() if room not in BORDER}


def modules(crates: Path) -> dict[Module, Path]:
    """Every module of the crates by its name in the core, and its file."""
    found = {}
    for root, room in sources(crates).items():
        for path in sorted(root.rglob("*.rs")):
            name = path.relative_to(root).with_suffix("").parts
            found[(*room, *(name[:-1] if name[-1] in ("mod", "lib") else name))] = path
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


def _offered(crate: str) -> Module:
    room = crate.removeprefix("linkwright_")
    return () if room == "core" else (room,)


def named(own: Module, path: Path, room: Module) -> Iterator[Module]:
    """Paths from the root of the core that a file of a room's crate names, in ``use`` or in its code."""
    text, is_folder = code(path), path.stem in ("mod", "lib")
    firsts = {"crate", "self", "super", r"linkwright_\w+", *_own_modules(text)}
    for match in re.finditer(rf"(?<![\w:])({'|'.join(sorted(firsts))})::", text):
        for parts in _paths(text[match.start() :]):
            base = own
            if parts[0].startswith("linkwright_"):
                yield (*_offered(parts[0]), *parts[1:])
                continue
            if parts[0] == "crate":
                base, parts = room, parts[1:]
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


def uses(crates: Path) -> dict[Module, set[Module]]:
    files, roots = modules(crates), sources(crates)
    texts = {own: code(path) for own, path in files.items()}
    given = methods_elsewhere(texts)
    found: dict[Module, set[Module]] = {}
    for own, path in files.items():
        room = next(room for root, room in roots.items() if path.is_relative_to(root))
        targets = {_module_of(name, files) for name in named(own, path, room)}
        calls = set(re.findall(r"(?:\.|\w::)(\w+)(?:::<[^()]*>)?\(", texts[own]))
        targets |= {given[name] for name in calls & given.keys()}
        found[own] = targets - {own, ()}
    return found


def _module_of(name: Module, files: dict[Module, Path]) -> Module:
    return max((name[:n] for n in range(len(name) + 1) if name[:n] in files), key=len, default=())


def wrong_doors(used: dict[Module, set[Module]]) -> list[str]:
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
    wrong = wrong_doors(uses(CRATES))
    assert not wrong, "\n".join(wrong)


def test_no_modules_stand_on_each_other() -> None:
    assert not circle(uses(CRATES))


def test_every_room_is_listed_and_stands() -> None:
    assert {name[0] for name in modules(CRATES) if name} == STANDS_ON.keys()
    assert not circle({(room,): {(below,) for below in belows} for room, belows in STANDS_ON.items()})


def test_every_door_is_used() -> None:
    doors = {(own[0], target[0]) for own, targets in uses(CRATES).items() if own for target in targets}
    assert doors >= {(room, below) for room, belows in STANDS_ON.items() for below in belows}


def test_every_room_has_its_map() -> None:
    missing = []
    for path in modules(CRATES).values():
        text = path.read_text(encoding="utf-8")
        told = "\n".join(line for line in text.splitlines() if line.startswith("//!"))
        public = re.findall(r"^pub mod (\w+);", text, re.MULTILINE)
        missing += [f"{path.relative_to(CRATES)}: {name}" for name in public if f"[`{name}`]" not in told]
    assert not missing, "\n".join(missing)


def test_modules_that_the_texts_name_exist() -> None:
    known = {"::".join(name) for name in modules(CRATES)}
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
    assert [name for name in named if not _exists(name)] == []


def _exists(name: str) -> bool:
    room, _, rest = name.partition("/")
    crate = CRATES / "linkwright-core"
    return any(
        path.exists() for path in (source(room) / rest, crate / name, CRATES / f"linkwright-{room}" / rest)
    )


HOUSE = {
    "core/src/lib.rs": "pub use linkwright_kernel as kernel;\npub mod cam;\npub mod drive;",
    "kernel/src/lib.rs": "pub mod real;\npub mod table;",
    "kernel/src/real.rs": "pub trait Real {}\n#[cfg(test)]\nmod tests { use linkwright_cam::Cam; }",
    "kernel/src/table.rs": "use crate::real::Real;",
    "core/src/cam/mod.rs": "pub mod shape;\npub struct Cam;",
    "core/src/cam/shape.rs": "use super::Cam;\nuse crate::kernel::{real::{Real, self}, real};",
    "core/src/drive/mod.rs": "pub mod plan;\npub mod reduce;",
    "core/src/drive/plan.rs": "pub struct Plan;",
    "core/src/drive/reduce.rs": "use super::plan::Plan;\nimpl Plan {\n    pub fn reduce<R>(&self) {}\n}",
}


PLAN = "pub struct Plan;\n"
REDUCES = {"drive::plan", "drive::reduce"}


@pytest.mark.parametrize(
    ("path", "text", "doors", "standing"),
    [
        ("kernel/src/real.rs", "// crate::cam::Cam", [], set()),
        ("kernel/src/real.rs", "use linkwright_core::cam::{shape, Cam};", ["cam", "cam::shape"], set()),
        ("kernel/src/real.rs", "use crate::table::Table;", [], {"kernel::real", "kernel::table"}),
        ("core/src/cam/shape.rs", "fn f() { crate::drive::plan::Plan }", ["drive::plan"], set()),
        (
            "core/src/cam/shape.rs",
            "fn f() { super::super::drive::reduce::f::<f64>() }",
            ["drive::reduce"],
            set(),
        ),
        ("core/src/cam/mod.rs", "mod shape;\nuse shape::Shape;\npub struct Cam;", [], {"cam", "cam::shape"}),
        (
            "core/src/cam/mod.rs",
            "mod shape;\nuse self::shape::*;\npub struct Cam;",
            [],
            {"cam", "cam::shape"},
        ),
        ("core/src/drive/plan.rs", f"use super::reduce::{{Row}};\n{PLAN}", [], REDUCES),
        ("core/src/drive/plan.rs", f"{PLAN}fn f(p: Plan) {{ p.reduce::<f64>() }}", [], REDUCES),
    ],
)
def test_wrong_uses_are_found(
    tmp_path: Path, path: str, text: str, doors: list[str], standing: set[str]
) -> None:
    for name, content in (HOUSE | {path: text}).items():
        file = tmp_path / f"linkwright-{name}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content)
    used = uses(tmp_path)
    own = path.removesuffix(".rs").split("src/")[1].replace("/", "::")
    own = own if path.startswith("core") else f"kernel::{own}"
    assert wrong_doors(used) == [f"{own} uses {door}" for door in doors]
    if not doors:
        assert set(circle(used)) == standing
