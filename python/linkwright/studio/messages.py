"""What a page may ask: the shape of every request, read here and nowhere else.

What has another shape is refused in words; the rest of the studio meets only what is written here.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    TypeAdapter,
    ValidationError,
    model_validator,
)

from linkwright.kernel.errors import InputError

# Integers of TOML have 64 bits.
_INTEGER = 2**63

# Letters of a value that a message quotes.
_SHOWN = 40


def _plain(value: Any) -> Any:
    """An entry for a file: finite numbers, texts, lists and tables; files know no null."""
    match value:
        case bool() | str():
            return value
        case float() if math.isfinite(value):
            return value
        case int() if -_INTEGER <= value < _INTEGER:
            return value
        case list():
            return [_plain(part) for part in value]
        case dict():
            return {key: _plain(part) for key, part in value.items()}
    raise ValueError("expected finite numbers, texts, lists and tables")


# Far beyond any quantity, and with a square that is a number.
Number = Annotated[float, Field(ge=-1e100, le=1e100, allow_inf_nan=False)]
Value = Annotated[Any, AfterValidator(lambda value: None if value is None else _plain(value))]
Limits = dict[str, tuple[Number, Number]]  # address → lower and upper limit [SI]
# Response → at least, at most [SI]; null for no such limit.
Bounds = dict[str, tuple[Number | None, Number | None]]
Place = Literal["", "library", "template", "folder"]


class Request(BaseModel):
    """What every request has."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)


class Enter(Request):
    """The first message of a socket."""

    ask: Literal["enter"]
    key: str


class Pull(Request):
    """A joint, or a point of a curve, that is dragged."""

    point: str
    x: Number
    y: Number
    angle: Number  # of the crank in the drawing [rad]
    pixel: Annotated[Number, Field(ge=0)] = 0.0  # size of a pixel [m]
    locked: list[str] = []
    free: Limits | None = None


class Reach(Request):
    """A result that is pulled."""

    of: str
    value: Number
    free: Limits
    bounds: Bounds = {}


class Merge(Request):
    """Two joints that become one."""

    joint: str
    into: str


class Add(Request):
    """An element more; `size`: of the drawing [m], `picked`: point that was picked last."""

    kind: str
    size: Annotated[Number, Field(gt=0)]
    picked: str = ""


class Spot(Request):
    """An end of a link that is drawn [m]; at a point of the drawing, its name."""

    x: Number
    y: Number
    point: str = ""


class Draw(Request):
    """Links and cylinders that were drawn with the mouse."""

    links: list[tuple[Spot, Spot, Literal["link", "driving", "passive"]]]
    angle: Number  # of the crank in the drawing [rad]
    pixel: Annotated[Number, Field(gt=0)]  # size of one [m]


class Compute(Request):
    """The machine with changes; `held`: they go on."""

    ask: Literal["compute"]
    held: bool = False
    text: str | None = None
    place: Place = ""
    name: str = ""
    set: dict[str, Value] = {}
    drag: Pull | None = None
    reach: Reach | None = None
    merge: Merge | None = None
    add: Add | None = None
    draw: Draw | None = None


class Variation(Request):
    """An entry of a sweep or a search, with its limits [SI]."""

    address: str
    low: Number
    high: Number
    steps: Annotated[int, Field(ge=2)] | None = None


class Search(Request):
    """A sweep or a search."""

    ask: Literal["search"]
    kind: Literal["sweep", "optimise"]
    response: str
    bounds: Bounds = {}
    entries: list[Variation]
    direction: Literal["minimise", "maximise"] = "minimise"
    machines: Annotated[int, Field(ge=1)] = 2000

    @model_validator(mode="after")
    def _steps(self) -> Self:
        if self.kind == "sweep" and any(entry.steps is None for entry in self.entries):
            raise ValueError("expected steps of every entry")
        return self


class Speak(Request):
    """Language and units of what is said from now on."""

    ask: Literal["language"]
    code: str
    units: list[str] = []


class Bare(Request):
    """What needs no further words."""

    ask: Literal["end search", "end export", "stop", "gallery"]


class Variant(Request):
    """A machine that was pinned."""

    name: str
    text: str


class Export(Request):
    """A file of the machine."""

    ask: Literal["export"]
    kind: Literal["html", "pdf", "gif", "mp4", "dxf", "svg", "png"]
    of: Literal["study", "torsion"] = "study"
    sections: list[str] = []
    company: str = ""
    units: list[str] = []
    variants: list[Variant] = []
    seconds: Number = 4.0
    angle: Number = 0.0
    command: str = ""


class SlopesOf(Request):
    """Derivatives of a result."""

    ask: Literal["slopes"]
    response: str


class File(Request):
    """A machine to open, or its picture for the gallery."""

    ask: Literal["open", "thumbnail"]
    place: Place
    name: str


class Save(Request):
    """A text to write; `replace`: whether the file may be there, or the text that it must have then."""

    ask: Literal["save"]
    name: str
    text: str
    replace: bool | str = False


Asked = Annotated[
    Enter | Compute | Search | Speak | Bare | Export | SlopesOf | File | Save, Field(discriminator="ask")
]
_READER: TypeAdapter[Any] = TypeAdapter(Asked)


def read(text: bytes) -> Any:
    """The request of a message, one of `Asked`; an `InputError` that says what else it has."""
    try:
        return _READER.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise InputError(_words(first["type"], first["loc"], first["msg"], first["input"])) from None


def _words(kind: str, at: tuple[int | str, ...], message: str, found: Any) -> str:
    if kind == "json_invalid":
        return "request: found letters that no file can hold, or tables within tables too deep; take them out"
    if kind.startswith("union_tag"):
        return f"request {found.get('ask')!r}: no such request"
    where = ".".join(map(str, at))
    if kind == "missing":
        return f"request {where}: expected an entry"
    quoted = repr(found)
    shown = quoted if len(quoted) <= _SHOWN else f"{quoted[:_SHOWN]}…"
    expected = message.removeprefix("Value error, ").replace("Input should be ", "expected ")
    return f"request {where}: found {shown}, {expected}"
