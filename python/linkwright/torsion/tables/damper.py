"""Table of a damper for a mode of a train, and the damper as it stands in a machine file."""

from __future__ import annotations

from linkwright.kernel.page.table import Row, Table
from linkwright.torsion.damper.damper_design import DamperDesign


def damper_table(found: DamperDesign) -> Table:
    """The damper by the mode alone and the best for the train, side by side."""
    values = (
        ("damping", "c [N m s/rad]", found.damping, found.damping_best),
        ("stiffness", "k [N m/rad]", found.stiffness, found.stiffness_best),
        ("loss factor", "η", found.loss_factor, found.loss_factor_best),
        ("largest magnification", "", found.magnification_rule, found.magnification_best),
    )
    rows: list[Row] = [
        (word, symbol, f"{rule:.6g}", f"{best:.6g}") for word, symbol, rule, best in values if best > 0
    ]
    title = (
        f"Damper on {found.on} for mode {found.mode}, {found.natural_frequency:.6g} Hz; its ring of "
        f"{found.ring_inertia:.6g} kg m² is {100 * found.mass_ratio:.4g} % of what swings there"
    )
    return Table("damper", title, ("", "", "by the mode alone", "best for the train"), rows)


def damper_lines(found: DamperDesign) -> str:
    """The best damper as a table of a machine file. TOML."""
    entries = [f'on = "{found.on}"', f'kind = "{"viscous" if found.kind == "viscous" else "tuned"}"']
    entries.append(f"ring_inertia = {found.ring_inertia!r}")
    best = {
        "damping": found.damping_best,
        "stiffness": found.stiffness_best,
        "loss_factor": found.loss_factor_best,
    }
    entries += [f"{key} = {float(f'{value:.6g}')!r}" for key, value in best.items() if value > 0]
    return "\n".join(["[train.dampers.damper]", *entries]) + "\n"
