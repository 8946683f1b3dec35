"""Drives: the machine reduced to its crank, steady motion and its speed fluctuation, run-up, run-down.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio, studies and derivatives read them |
| `batch` | Steady motion of thousands to millions of machines that differ in some entries |
| `warnings` | What the designer of a machine should know although it runs: sentences with numbers |
| `characteristic` | The motor's characteristic and the mean load that it works against |
| `commands` | ``linkwright transient``: motion in time |
| `crank_speed` | At which speed of the crank a command computes, and where that speed comes from |
| `cycle_motion` | Position, velocity, acceleration of everything over the cycle, with exact extremes |
| `evenness` | Coefficients δ, H and k_p; their limit at constant energy |
| `fallback` | Where does a machine come to in time whose steady motion was not found? |
| `figures` | Figures of a drive over angle and time, and of its motor, with their captions |
| `figures_of_cycle` | Figures of sliders, rockers and coupler points over the cycle |
| `gradient` | Derivatives of steady motion by entries of the machine |
| `gradient_at_constant_energy` | Derivatives of δ, H and k_p at constant energy |
| `gradient_in_time` | Derivatives of run-up and run-down by entries of the machine |
| `load_checks` | Whether the loads of a machine can be computed all round, and repeat every revolution |
| `model/` | Motors, gearbox, coupling, brake, flywheel |
| `motion_events` | What happens during a motion in time, and the extremes of its speed and acceleration |
| `obstacles` | What stands in the way of its analyses, and the entries that would mend it |
| `reduction` | What inertia and what load does the crank feel? |
| `run_up` | Run-up from rest, and run-down with the motor off |
| `steady_state` | How does it turn in the long run? |
| `step_method` | What does the published step method give instead? |
| `study` | What is known of a drive: reduction to the crank, steady motion, run-up, run-down |
| `tables` | Results of a drive as tables of text, for the page and for the terminal |
| `tables_in_time` | A motion in time as tables of text |
| `tables_of_cycle` | Extremes of sliders, rockers and coupler points over the cycle as a table |
| `transient` | How does it move from here on? |
| `words` | Formulas and assumptions of a report |
"""

from linkwright import exports

__getattr__ = exports(globals())
