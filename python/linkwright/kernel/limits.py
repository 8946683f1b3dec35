"""How much of everything there may be: each limit once, with its reason; `docs/limits.md` prints them.

A limit is far beyond what a machine has, and within what a computer of a few gigabytes answers in a minute.
What passes it is refused with its place, its value and the limit, before memory or time are spent on it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limit:
    """The maximum number of something."""

    most: int  # how many there may be
    of: str  # what is counted, after "at most 500"
    reason: str  # why no more

    @property
    def words(self) -> str:
        """Such as "at most 500 discs"."""
        return f"at most {grouped(self.most)} {self.of}"


def grouped(number: int) -> str:
    """A whole number with its digits in threes."""
    return f"{number:,}".replace(",", " ")


FILE_BYTES = Limit(1_000_000, "bytes in a machine file", "a machine file has a few kB")
DEPTH = Limit(32, "keys inside one another", "the deepest key of a machine has eight")
ENTRIES = Limit(1_000, "entries in a table", "names are looked up among all others")
LIST = Limit(10_000, "values in a list of a machine file", "longer lists belong in a file of points")
TEXT = Limit(10_000, "characters in a text", "a description of some pages")
NAME = Limit(100, "characters in a name or key", "a name appears in tables, figures and file names")
TITLE = Limit(300, "characters in the name of a machine", "it heads tables and reports")
POINT_BYTES = Limit(20_000_000, "bytes in a file of points", "200 bytes a row")
MESH_BYTES = Limit(200_000_000, "bytes in a mesh", "a million elements")
LOGO_BYTES = Limit(2_000_000, "bytes in a logo", "it appears in every report")
ROWS = Limit(
    100_000, "rows in a file of points", "a record of a hundred revolutions, a thousand samples each"
)
FORMULA = Limit(400, "numbers, names and signs in a formula", "a few lines; longer curves belong in a table")
PROBLEMS = Limit(10, "problems in a message", "what fits on a screen")
MESSAGE_LINE = Limit(400, "characters in a line of a message", "some lines of a terminal")
SENTENCES = Limit(20, "findings, and as many warnings, on the terminal", "what fits on a screen")
TABLE_ROWS = Limit(60, "rows of a table on the terminal", "what fits on some screens")
TABLES = Limit(40, "tables on the terminal", "what fits on some screens")
DISCS = Limit(500, "discs in a train", "the cost of modes grows with the cube of their number")
THROWS = Limit(100, "throws of a crankshaft", "large engines have a dozen")
HARMONICS = Limit(500, "harmonics of a torque", "gas and inertia torques are known to order 48")
ORDER = Limit(
    1_000,
    "cycles per revolution in an excitation order, or revolutions per cycle",
    "teeth of gears have some hundred, and a hunting tooth meets another after as many revolutions",
)
RESPONSE = Limit(
    4_000_000,
    "orders, discs and speeds multiplied in a forced response",
    "they take 3 GB",
)
FORCES = Limit(
    60_000_000,
    "crank angles, equations and unknowns multiplied in a solution for forces",
    "their matrices take half a gigabyte, and a few copies of them",
)
LAW_POINTS = Limit(3_000, "points of a motion law", "their equations are solved as one dense system")
VIBRATIONS = Limit(25_000, "vibrations of a follower per revolution", "each is examined separately")
STEPS = Limit(36_000, "steps per revolution, for the step method", "a step of 0.01°")
ROWS_OUT = Limit(100_000, "rows in a table that is written", "more than any machine tool reads")
ROOTS = Limit(20_000_000, "heads, or roots and phases multiplied, in a field", "an hour on one core")
FIELD_VARIANTS = Limit(100_000, "variants of a knife over a field", "each is a pass over all roots")
CAM_VARIANTS = Limit(50_000_000, "variants of a cam in a search", "a table of them fits into memory")
SHOWN = Limit(1_000, "best variants that are shown", "each is analysed exactly")
PATH_POINTS = Limit(4_000_000, "points and population multiplied in a search", "they take a gigabyte")
TRIALS = Limit(100_000_000, "population and generations multiplied in a search", "a day on one core")
SWEEP_ROWS = Limit(1_000_000_000, "rows in a sweep", "a hundred gigabytes of results")
LEVELS = Limit(1_000_000, "levels of a variable in a grid", "they are held in memory; sobol has none")
LATIN_ROWS = Limit(
    1_000_000,
    "rows in a Latin hypercube",
    "each variable keeps the order of all rows in memory; sobol has none",
)
SAMPLES = Limit(200_000, "samples of a manoeuvre of a train", "8 MB for each disc and five shafts")
ANSWER = Limit(100_000, "characters in an answer to an assistant", "what a language model reads at once")
ANSWER_ROWS = Limit(1_000, "rows of a sweep in an answer to an assistant", "more are for a folder of files")
OUTPUT = Limit(100_000_000, "bytes in what a command answers to an assistant", "curves have a few MB")

ALL = tuple(limit for limit in list(globals().values()) if isinstance(limit, Limit))
