"""A study: every analysis that a machine allows, what it cannot do, and what its designer should know.

What fails becomes a finding, and the study goes on with what does not depend on it. A subject is imported
when the machine has its table.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any
from warnings import warn

from linkwright.app.subjects import ANALYSES
from linkwright.drive.steady_state import require_accuracy
from linkwright.drive.step_method import whole_steps
from linkwright.kernel.findings import Findings
from linkwright.kernel.public import public
from linkwright.kernel.result import Result, finite
from linkwright.machine.analysis import Results
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.kernel.figure.style import CaptionedFigure
    from linkwright.kernel.page.table import Table

_NAMES = {analysis.name for analysis in ANALYSES}

# Name of a result before → its name.
_FORMERLY = {analysis.formerly: analysis.name for analysis in ANALYSES if analysis.formerly}


class Study(Results):
    """All that is known about a machine: its results by the name of their analysis, as a mapping.

    Results are attributes as well, ``study.steady_state``, None where there is none.

    Attributes
    ----------
    machine : Machine
    findings, warnings : tuple of str
        What the machine cannot do, and what its designer should know, in sentences.
    accuracy : float
        Relative accuracy of the steady speed.
    cams, cam_sizes, loaded_cams : tuple of CamProfile, LeastSizes, LoadedCam
        Its cams, how small each might be, and under load: ``"cam"`` among the results, or ``"cam.NAME"`` if
        there are several, ``"cam_sizes"`` and ``"cam_force"`` likewise.
    attempt : Transient or None
        The motion from the start to the stall, where the run-up fails on the way.
    """

    def __getitem__(self, name: str) -> Result:
        """A result by its name."""
        return super().__getitem__(_now(name) if name not in self._results else name)

    def __getattr__(self, name: str) -> Any:
        """A result by its name; None where the analysis has none."""
        return super().__getattr__(_now(name))

    def _without(self, name: str) -> None:
        if name not in _NAMES:
            raise AttributeError(f"a study has no {name}; it has {', '.join(self)}")

    @property
    def cams(self) -> tuple[Any, ...]:
        """The cams."""
        return self.each("cam")

    @property
    def cam_sizes(self) -> tuple[Any, ...]:
        """How small each cam might be."""
        return self.each("cam_sizes")

    @property
    def loaded_cams(self) -> tuple[Any, ...]:
        """The cams under load."""
        return self.each("cam_force")

    def results(self) -> dict[str, Result]:
        """The results that there are, by analysis."""
        return dict(self)

    def showing(self, what: str) -> Iterator[Any]:
        """What the analyses show of themselves, such as their ``"tables"``, in their order."""
        return self.shown(ANALYSES, what)

    def tables(self) -> list[Table]:
        """All results as tables of text: those of the analyses in their order, numerical details last."""
        return [*self.showing("tables"), *self.showing("details")]

    def figures(self) -> Iterator[CaptionedFigure]:
        """The figures that there are results for, with their captions."""
        return self.showing("figures")

    def plot(self, *names: str, over: str | None = None) -> Figure:
        """Curves by name as a figure, an axis for each unit; the first figure of the report without names.

        Parameters
        ----------
        *names : str
            Curves as `linkwright plot` lists them, such as ``"ram.velocity"``.
        over : str, optional
            What they run over, such as ``"time"``; the crank angle without it.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``figure.savefig(path)`` writes it.

        Raises
        ------
        InputError
            There is no such curve, or nothing to draw.
        """
        from linkwright.kernel.figure.figure_of import plotted_figure

        return plotted_figure(self, *names, over=over)

    def _repr_html_(self) -> str:
        from linkwright.kernel.page.notebook import study_html

        return study_html(self, self)

    def __repr__(self) -> str:
        """The machine, and what is known of it."""
        return f"Study({self.machine.name!r}: {', '.join(self)})"

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Name, results, findings and warnings, ready for JSON.

        Parameters
        ----------
        curves : bool
            Whether arrays are included.

        Returns
        -------
        dict
            SI numbers under the names of the results' attributes; None in place of a number that is not
            finite. The findings stand first among the warnings too.
        """
        return {
            "machine": self.machine.name,
            "results": finite(results_to_dict(self, curves=curves)),
            "findings": list(self.findings),
            "warnings": [*self.findings, *self.warnings],
        }


def _now(name: str) -> str:
    if name not in _FORMERLY:
        return name
    warn(f"study.{name} is now study.{_FORMERLY[name]}", DeprecationWarning, stacklevel=3)
    return _FORMERLY[name]


def results_to_dict(study: Study, *, curves: bool) -> dict[str, Any]:
    """All results for JSON; those that were renamed under their former names too, for this release."""
    results = {name: result.to_dict(curves=curves) for name, result in study.items()}
    return results | {old: results[new] for old, new in _FORMERLY.items() if new in results}


@public
def study(machine: Machine, *, accuracy: float = 1e-10, step: float | None = None) -> Study:
    """Study a machine: reduction, steady motion, run-up, and run-down if there is a brake.

    Parameters
    ----------
    machine : Machine
        The machine; motor, bodies and loads may be missing.
    accuracy : float
        Relative accuracy of the steady speed, 1e-13 to 1e-2.
    step : float, optional
        Step of the crank angle [rad] for the step method beside the exact solution; without it, none.

    Returns
    -------
    Study
        What could be computed, and findings in place of what could not.

    Raises
    ------
    InputError
        The accuracy or the step makes no sense.
    """
    require_accuracy(accuracy)
    if step is not None:
        whole_steps(step)
    if machine.is_train_alone and not machine.has_mounted_mechanisms:
        # Nothing but torsional vibration, which is a study of its own: the error says so.
        compile_machine(machine)
    known, findings = Study(machine, accuracy, step), Findings()
    for analysis in ANALYSES:
        if analysis.is_of_study and analysis.applies(machine):
            known.add(analysis, findings)
    known.close(findings)
    return known
