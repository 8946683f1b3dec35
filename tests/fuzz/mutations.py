"""Texts that somebody might have written by mistake: files, tables and formulas, changed here and there."""

from __future__ import annotations

import re
from collections.abc import Callable

from numpy.random import Generator

# What stands in the place of a value: numbers at and beyond every edge, texts that are nearly quantities,
# other types of TOML.
VALUES = (
    *("0", "-0.0", "-1", "1", "0.5", "3", "7", "1e-320", "1e-300", "1e-30", "1e-9", "1e9", "1e30", "1e300"),
    *("1e308", "1e309", "nan", "inf", "-inf", "9223372036854775807", "-9223372036854775808", "0x" + "f" * 40),
    *("true", "false", '""', "[]", "{}", "[1, 2]", "[[1, 2], [3]]", "1979-05-27T07:32:00Z", "{ a = 1 }"),
    *('"3"', '"3 m"', '"-3 mm"', '"1,5 m"', '"1 000 kg"', '"1e400 m"', '"5 parsec"', '"10 %"', '"１ m"'),
    *('"1 rad/s**9**9**9"', '"m"', '"nan kg"', '"inf deg"', '"1e308 km"', '"90 deg"', '"100 rpm"', '"1 kW"'),
    *(
        '"[/x]"',
        '"$\\\\frac$"',
        '"A"',
        '"../../x.csv"',
        '"\\u0000"',
        '"\\u202e"',
        "'''\n'''",
        '"' + "x" * 3000 + '"',
    ),
)

CHARACTERS = "\x00\x07\t\n\r\"'\\[]{}=.,#$<&é€\U0001f600\u2028\ufeff0-+e_"

_ENTRY = re.compile(r"^(\s*[\w.\"-]+\s*=\s*)(.+)$")
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_WORD = re.compile(r"[A-Za-z_]\w+")

Mutation = Callable[[str, Generator], str]


def mutated(text: str, random: Generator, mutations: tuple[Mutation, ...], most: int = 3) -> str:
    """A text after one to ``most`` mutations."""
    for _ in range(random.integers(1, most + 1)):
        text = mutations[random.integers(len(mutations))](text, random)
    return text


def of_lines(change: Callable[[list[str], int, Generator], None]) -> Mutation:
    """A mutation of one line of the text: ``change`` works on the list of lines at an index."""

    def mutation(text: str, random: Generator) -> str:
        lines = text.split("\n")
        change(lines, int(random.integers(len(lines))), random)
        return "\n".join(lines)

    return mutation


def _drop(lines: list[str], k: int, random: Generator) -> None:
    del lines[k : k + int(random.integers(1, 4))]


def _repeat(lines: list[str], k: int, random: Generator) -> None:
    lines.insert(int(random.integers(len(lines))), lines[k])


def _swap(lines: list[str], k: int, random: Generator) -> None:
    other = int(random.integers(len(lines)))
    lines[k], lines[other] = lines[other], lines[k]


def _value(lines: list[str], k: int, random: Generator) -> None:
    """Another value in the next line that has one."""
    for at in [*range(k, len(lines)), *range(k)]:
        if entry := _ENTRY.match(lines[at]):
            lines[at] = entry[1] + VALUES[random.integers(len(VALUES))]
            return


def _number(lines: list[str], k: int, random: Generator) -> None:
    """Another size of a number in the next line that has one; its unit stays."""
    for at in [*range(k, len(lines)), *range(k)]:
        numbers = list(_NUMBER.finditer(lines[at]))
        if numbers:
            number = numbers[random.integers(len(numbers))]
            factor = (-1.0, 0.0, 0.5, 2.0, 10.0, 1e-3, 1e3, 1e-9, 1e9, 1e150)[random.integers(10)]
            lines[at] = (
                lines[at][: number.start()] + f"{float(number[0]) * factor!r}" + lines[at][number.end() :]
            )
            return


def _word(lines: list[str], k: int, random: Generator) -> None:
    """A word of one line in the place of a word of another: keys, names and units that belong elsewhere."""
    words = _WORD.findall("\n".join(lines))
    found = list(_WORD.finditer(lines[k]))
    if words and found:
        word = found[random.integers(len(found))]
        other = words[random.integers(len(words))]
        lines[k] = lines[k][: word.start()] + other + lines[k][word.end() :]


def _key(lines: list[str], k: int, random: Generator) -> None:
    lines.insert(k, f"{_some(lines, random)} = {VALUES[random.integers(len(VALUES))]}")


def _head(lines: list[str], k: int, random: Generator) -> None:
    lines.insert(k, f"[{_some(lines, random)}.{_some(lines, random)}]")


def _some(lines: list[str], random: Generator) -> str:
    words = _WORD.findall("\n".join(lines)) or ["x"]
    return str(words[random.integers(len(words))])


def _cut(text: str, random: Generator) -> str:
    return text[: random.integers(len(text) + 1)]


def _character(text: str, random: Generator) -> str:
    at, drop = random.integers(len(text) + 1), random.integers(0, 2)
    return text[:at] + CHARACTERS[random.integers(len(CHARACTERS))] + text[at + drop :]


# Of machine files: mostly such that the file still reads, since most of the program lies behind the reader.
MACHINE_FILE: tuple[Mutation, ...] = (
    *(of_lines(_value), of_lines(_value), of_lines(_number), of_lines(_number), of_lines(_number)),
    *(of_lines(_word), of_lines(_word), of_lines(_drop), of_lines(_repeat), of_lines(_swap)),
    *(of_lines(_key), of_lines(_head), _cut, _character),
)

TABLE: tuple[Mutation, ...] = (
    *(
        of_lines(_number),
        of_lines(_word),
        of_lines(_drop),
        of_lines(_repeat),
        of_lines(_swap),
        _cut,
        _character,
    ),
    *(
        lambda text, random, part=part: text.replace(",", part, int(random.integers(1, 4)))
        for part in (";", ",,", ",nan,", ",inf,", '","', ",1e400,", ",0x10,", "\t", ",\r\n", ",=1+1,")
    ),
)

FORMULA: tuple[Mutation, ...] = (
    _character,
    _cut,
    *(
        lambda text, random, part=part: _inserted(text, part, random)
        for part in (
            "(",
            ")",
            "^",
            "**",
            "/0",
            "-",
            "sin(",
            "1e308",
            "nan",
            "where(",
            ",",
            "phi",
            "omega",
            "t",
            "^^",
            "9^9^9^9",
        )
    ),
)


def _inserted(text: str, part: str, random: Generator) -> str:
    at = random.integers(len(text) + 1)
    return text[:at] + part + text[at:]
