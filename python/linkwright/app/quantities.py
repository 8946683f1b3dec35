"""What quantities there are: of a result, and of a whole study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import shown
from linkwright.kernel.quantities import DeclaredQuantity, quantities_of
from linkwright.kernel.result import Result


@public
def quantities(of: Any) -> tuple[DeclaredQuantity, ...]:
    """The quantities of a result or of a study: words, symbols, units, and whether they are curves.

    Parameters
    ----------
    of : Result, type, Study or TorsionStudy
        A result, its class, or a study, which has several.

    Returns
    -------
    tuple of DeclaredQuantity
        In the order of the declarations. Names are those of the attributes and of the keys of ``--json``; in
        a study the analysis stands before them: ``"steady_state.unevenness"``.

    Raises
    ------
    InputError
        It is none of these.

    Notes
    -----
    Of a class, a unit that depends on the machine is given as such: the lift of a cam has ``"m or rad"``.

    Examples
    --------
    >>> import linkwright as lw
    >>> steady = lw.steady_state(lw.read("roller_two_carts"))
    >>> {each.name: each.unit for each in lw.quantities(steady)}["torque_motor_rms"]
    'N m'
    """
    if isinstance(of, type) and issubclass(of, Result):
        return tuple(quantities_of(of))
    if isinstance(of, Result):
        return tuple(
            quantity._replace(unit=of.unit_of(quantity.name)) for quantity in quantities_of(type(of))
        )
    return tuple(
        quantity._replace(name=f"{name}.{quantity.name}", over=quantity.over and f"{name}.{quantity.over}")
        for name, result in _parts(of).items()
        for quantity in quantities(result)
    )


def _parts(study: Any) -> Mapping[str, Result]:
    from linkwright.app.study import Study

    if isinstance(study, Study):
        return study.results()
    if isinstance(study, type) or not is_dataclass(study):
        raise InputError(f"of: found {shown(study)}, expected a result, its class, or a study")
    parts = {field.name: getattr(study, field.name) for field in fields(study)}
    return {name: part for name, part in parts.items() if isinstance(part, Result)}
