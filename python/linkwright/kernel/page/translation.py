"""A content of a page in a language, its figures too."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any

from linkwright.kernel.reader.language import Language

if TYPE_CHECKING:
    from linkwright.kernel.page.content import Content

# Entries that are read by programs, or that only their author may change.
_KEPT = frozenset(
    {
        *("name", "file", "command", "scenes", "text", "about", "source", "heading", "language", "names"),
        "groups",
    }
)


def in_language(content: Content, to: Language) -> Content:
    """A content in a language; its figures are changed in place, and names of the machine's parts stay."""
    if to.code == "en":
        return content
    names = {part.name for _, parts in content.groups for part in parts if part.is_named} | {*content.names}
    texts = {
        text: words
        for text, words in to.texts.items()
        if text in to.titles or not ("{}" in text or text in to.keys)
    }
    title = replace(to, texts=texts)(content.title)
    if title == content.title:
        names.add(title)
    named = replace(to, names=frozenset(names))
    changed: Content = _changed(content, named)
    groups = [
        (to.heading(group), [_part(part, to, named) for part in parts]) for group, parts in content.groups
    ]
    scenes = {name: scene | {"labels": _labels(scene, named)} for name, scene in content.scenes.items()}
    return replace(changed, title=title, groups=groups, language=to, scenes=scenes)


def _labels(scene: dict[str, Any], named: Language) -> dict[str, str]:
    """Names of the parts of a moving drawing whose label differs: parts that the file does not name."""
    names = {part["name"] for part in scene.get("parts", ()) if part.get("name")}
    return {name: label for name in sorted(names) if (label := named.label(name)) != name}


def _part(part: Any, to: Language, named: Language) -> Any:
    entries = [one._replace(word=to.entry(one.word), value=named.entry(one.value)) for one in part.entries]
    name = part.name if part.is_named else ": ".join(map(to.entry, part.name.split(": ")))
    return part._replace(name=name, entries=entries)


def _changed(value: Any, to: Language) -> Any:
    from matplotlib.figure import Figure

    from linkwright.kernel.reader.axes import translated_figure

    if isinstance(value, str):
        return to.label(value)
    if isinstance(value, Figure):
        return translated_figure(value, to)
    if is_dataclass(value) and not isinstance(value, type):
        entries = {one.name: getattr(value, one.name) for one in fields(value) if one.init}
        return replace(value, **{name: _entry(name, entry, to) for name, entry in entries.items()})
    if hasattr(value, "_fields"):
        return type(value)(*(_entry(name, getattr(value, name), to) for name in value._fields))
    if isinstance(value, (list, tuple)):
        return type(value)(_changed(one, to) for one in value)
    if callable(value):
        return _drawn(value, to)
    return value


def _entry(name: str, entry: Any, to: Language) -> Any:
    if name == "unit":
        return to.unit(entry)
    return entry if name in _KEPT else _changed(entry, to)


def _drawn(draw: Callable[[], Any], to: Language) -> Callable[[], Any]:
    return lambda: _changed(draw(), to)
