"""What all descriptions share: they are frozen, know their keys, and report all their faults at once."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, ClassVar, NoReturn, Self

from pydantic import (
    AfterValidator,
    AliasChoices,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    ValidationError,
    model_validator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError

from linkwright.kernel.errors import InputError, show
from linkwright.kernel.limits import NAME, TITLE
from linkwright.kernel.public.arguments import shown
from linkwright.kernel.public.immutable import held, refuse


class Description(BaseModel):
    """A part of the description of a machine; all numbers are SI."""

    # Only the machine as a whole is usually validated; building each part on its own as well costs a tenth of
    # the time of a start.
    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True, defer_build=True)

    # Whether its entries are shown among those of the part that it belongs to.
    shown_with_part: ClassVar[bool] = False

    def with_entries(self, entries: Mapping[str, Any]) -> Self:
        """Copy with some entries exchanged [SI], unchecked, so that an entry may be an array over many
        machines.

        A description that completes its own entries completes them anew.

        Raises InputError: there is no such entry.
        """
        if not isinstance(entries, Mapping):
            raise InputError(f"entries: found {shown(entries)}, expected a table of name → value")
        known = type(self).model_fields
        if strange := [name for name in entries if name not in known]:
            remedy = suggestion(str(strange[0]), known) or f"one of {', '.join(known)}"
            raise InputError(f"entries: found {shown(strange[0])}, expected an entry of the part; {remedy}")
        return self.model_copy(update={name: held(value) for name, value in entries.items()})

    def __setattr__(self, name: str, value: object) -> NoReturn:
        """Refuse the change: a description may be part of many machines, and of their compiled programs."""
        refuse(self, name, f'.with_entries({{"{name}": value}})' if name in type(self).model_fields else "")

    def __delattr__(self, name: str) -> NoReturn:
        """Refuse the change likewise."""
        self.__setattr__(name, None)

    def model_post_init(self, context: Any, /) -> None:
        """Hold tables that nobody writes to."""
        for name, value in self.__dict__.items():
            if type(value) is dict:
                self.__dict__[name] = held(value)


def wrong(found: str, expected: str, remedy: str = "") -> PydanticCustomError:
    """One fault in words, in the form that pydantic collects with all others."""
    context = {"found": found, "expected": expected, "remedy": remedy}
    return PydanticCustomError("problem", "found {found}, expected {expected}", context)


def fault(*place: str | int, found: object = None, expected: str, remedy: str = "") -> InitErrorDetails:
    """One fault at a place, keys from the reporting description down: found, expected, and a remedy."""
    text = "nothing" if found is None else show(found)
    return InitErrorDetails(type=wrong(text, expected, remedy), loc=place, input=found)


def _whole(value: object) -> object:
    """Reject true and "3", of which pydantic would make a whole number."""
    if isinstance(value, bool | str):
        raise wrong(show(value), "a whole number")
    return value


def formerly(old: str, new: str) -> AliasChoices:
    """The keys of an entry, as `validation_alias`: its own, and that of older files, which mean the same."""
    return AliasChoices(new, old)


Whole = Annotated[int, BeforeValidator(_whole)]


def raise_faults(title: str, faults: Iterable[InitErrorDetails]) -> None:
    """Raise all faults at once; do nothing if there are none."""
    listed = list(faults)
    if listed:
        raise ValidationError.from_exception_data(title, listed)


def faults_of(error: ValidationError) -> list[InitErrorDetails]:
    """The faults that an error holds, to be raised again together with others."""
    return [
        InitErrorDetails(
            type=PydanticCustomError(detail["type"], detail["msg"], detail.get("ctx")),
            loc=detail["loc"],
            input=detail["input"],
        )
        for detail in error.errors()
    ]


class CheckedDescription(Description):
    """A description whose entries have to fit together."""

    @model_validator(mode="after")
    def _entries_fit(self) -> Self:
        raise_faults(type(self).__name__, self._faults())
        return self

    def _faults(self) -> Iterator[InitErrorDetails]:
        return iter(())


def close_match(name: str, known: Iterable[str]) -> str:
    """The question whether a similar name was meant, or its words in another order; empty if none was."""
    from difflib import get_close_matches

    names = list(known)
    words = sorted(name.split("_"))
    reordered = [name for name in names if sorted(name.split("_")) == words]
    close = reordered or get_close_matches(name, names, n=3, cutoff=0.6)
    return "did you mean " + " or ".join(f'"{word}"' for word in close) + "?" if close else ""


def suggestion(name: str, known: Iterable[str]) -> str:
    """The known names that a misspelt one may stand for; all of them if they are few."""
    listed = list(dict.fromkeys(known))
    close = close_match(name, listed)
    if close:
        return close
    # A dozen names still fit on a line or two.
    if 0 < len(listed) <= 12:
        return "there is " + ", ".join(f'"{name}"' for name in listed)
    return ""


def _checked_name(name: str) -> str:
    if not name.strip() or "." in name or not name.isprintable():
        remedy = "points separate the parts of an address" if "." in name else ""
        raise wrong(show(name), "a name of printable characters, without a point", remedy)
    if '"' in name and "'" in name:
        remedy = "a part of an address stands in quotes of one kind"
        raise wrong(show(name), "a name without both kinds of quotes", remedy)
    if len(name) > NAME.most:
        raise wrong(show(name), NAME.words, "shorten it")
    return name


def _checked_title(title: str) -> str:
    if not title.isprintable():
        raise wrong(show(title), "a text of printable characters, on one line")
    if len(title) > TITLE.most:
        raise wrong(show(title), TITLE.words, "shorten it; the rest may stand in `description`")
    return title


Name = Annotated[str, AfterValidator(_checked_name)]
Title = Annotated[str, AfterValidator(_checked_title)]
