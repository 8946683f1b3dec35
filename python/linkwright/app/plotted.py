"""What `plot` of machines, studies and sweeps draws, in a notebook or for a file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from matplotlib.figure import Figure

from linkwright.app.curves import chosen, curves_figure
from linkwright.app.report.scene import moving_scene
from linkwright.app.report.sketch import sketch_figure
from linkwright.app.study import Study, study
from linkwright.kernel.errors import InputError
from linkwright.kernel.figure.figure_of import figure_of
from linkwright.machine.machine import Machine
from linkwright.studies.sweep import Sweep
from linkwright.torsion.study import TorsionStudy


@figure_of.register
def machine_figure(machine: Machine, *names: str, over: str | None = None) -> Figure:
    """Curves of a machine by name; without names its drawing, or the scheme of its train."""
    if names:
        return study_figure(study(machine), *names, over=over)
    if machine.is_train_alone:
        from linkwright.torsion.figures.scheme import scheme_figure
        from linkwright.torsion.modes.scheme import scheme

        return scheme_figure(scheme(machine))
    scene = moving_scene(machine, None)
    # A topper or a diagram of torques has no linkage: the first figure of its study tells most of it.
    return study_figure(study(machine)) if scene is None else sketch_figure(scene)


@figure_of.register
def study_figure(results: Study, *names: str, over: str | None = None) -> Figure:
    """Curves of a study by name; without names the first figure of its report."""
    if names:
        return curves_figure(chosen(results, names, over))
    first = next(results.figures(), None)
    if first is None:
        raise InputError(f"{results.machine.name}: its study has no figures")
    return first.figure


@figure_of.register
def torsion_figure(results: TorsionStudy, name: str, over: str | None = None) -> Figure:
    """A figure of the report of a train by its name."""
    from linkwright.torsion.figures.captions import torsion_figures

    known = {drawn.name: drawn for drawn in torsion_figures(results)}
    if name not in known:
        raise InputError(f"found no figure {name!r} of this train, expected one of {', '.join(known)}")
    return known[name].figure


@figure_of.register
def sweep_figure(swept: Sweep, *names: str, over: str | None = None) -> Figure:
    """A response of a sweep over what varies, as `linkwright sweep show` draws it."""
    from linkwright.studies.commands.sweep import shown_of
    from linkwright.studies.figures import figures as drawn
    from linkwright.studies.folder import opened

    rows = shown_of(opened(Path(swept.path)))
    for name in names:
        if name not in rows.responses:
            raise InputError(f"found no response {name!r}, expected one of {', '.join(rows.responses)}")
    return next(iter(drawn(replace(rows, responses=names or rows.responses)).values()))
