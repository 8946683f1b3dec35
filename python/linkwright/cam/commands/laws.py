"""``linkwright cam …``: a machine's cams; the motion laws of cams, compared."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, to_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later

Names = Annotated[
    list[str] | None,
    Option(
        "--law",
        '"NAME: KEY=VALUE, …"',
        'A single law, optionally with parameters, such as "modified_sine: share=0.2" or "combined: '
        'start=0.2, ramp=cycloidal". Repeatable.',
    ),
]
To = Annotated[
    FolderOutput, to_folder("Write cam_laws.json and the laws in one figure, as SVG and PNG, there.")
]

# Lines that can still be distinguished in one figure; without --law, these.
_DRAWN = ("parabolic", "cycloidal", "modified_trapezoid", "modified_sine", "polynomial_3_4_5", "minimum_jerk")


def laws(law: Names = None, *, to: To) -> None:
    """Factors of the motion laws, for a rise between two dwells.

    Maximum velocity, acceleration, jerk, and velocity times acceleration, and the integrals of the squares,
    with theoretical lower bounds.
    """
    from linkwright.cam.law_factors import law_factors
    from linkwright.cam.laws.catalogue import BOUNDS, LAWS

    wanted = [_read(text) for text in law] if law else [_LawChoice(name, name, {}) for name in LAWS]
    chosen = {word.words: word for word in wanted}
    shapes = {words: LAWS[law.name].normalised(**law.parameters) for words, law in chosen.items()}
    factors = {words: law_factors(shape) for words, shape in shapes.items()}
    drawn = {words: shape for words, shape in shapes.items() if law or words in _DRAWN}
    results = {
        words: {
            **factors[words].to_dict(),
            "parameters": LAWS[one.name].parameters | one.parameters,
            "source": LAWS[one.name].source,
        }
        for words, one in chosen.items()
    }
    answer = Answer(
        machine=None,
        results={"cam_laws": results, "cam_law_bounds": {bound.name: bound._asdict() for bound in BOUNDS}},
        tables=[later("cam.tables:law_table", factors), later("cam.tables:bound_table")],
        results_file="cam_laws.json",
        figures={"cam_laws": later("cam.figures.cam:motion_laws_figure", drawn)},
    )
    to.hand_over(answer)


class _LawChoice(NamedTuple):
    """A requested law: its words, its name, and the parameters that differ from the usual ones."""

    words: str
    name: str
    parameters: dict[str, Any]


def _read(text: str) -> _LawChoice:
    """A law of ``NAME`` or ``NAME: KEY=VALUE, …``, checked as a section of a machine file is."""
    from pydantic import TypeAdapter, ValidationError

    from linkwright.cam.laws.catalogue import LAWS
    from linkwright.cam.model.motion_section import AnyLaw
    from linkwright.kernel.description.base import suggestion

    name, _, rest = (part.strip() for part in text.partition(":"))
    if name not in LAWS:
        remedy = suggestion(name, LAWS) or "there is " + ", ".join(LAWS)
        raise InputError(f'--law: found "{name}", expected the name of a law; {remedy}')
    usual = LAWS[name].parameters
    given: dict[str, Any] = {}
    for entry in filter(None, (part.strip() for part in rest.split(","))):
        key, sign, value = (part.strip() for part in entry.partition("="))
        if not sign or key not in usual:
            listed = ", ".join(f"{key}={value}" for key, value in usual.items()) or "no parameters"
            raise InputError(f'--law: found "{entry}", and {name} has {listed}')
        given[key] = _value(value)
    try:
        TypeAdapter(AnyLaw).validate_python({"kind": name, **given})
    except ValidationError as error:
        fault = error.errors()[0]
        parameters = ", ".join(f"{key}={value}" for key, value in given.items())
        raise InputError(f'--law: {name}: found "{parameters}": {fault["msg"]}') from None
    return _LawChoice(text if given else name, name, given)


def _value(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
