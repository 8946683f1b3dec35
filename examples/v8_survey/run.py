"""Does the crankshaft of the V-8 last by IACS UR M53, and how far off is a torsiograph curve?

The maker may round its fillets otherwise: fatigue is looked at over their radius too.
"""

from pathlib import Path

import numpy as np

import linkwright as lw

RADII = (3e-3, 4e-3, 5e-3, 7e-3)


def crankshaft(machine: lw.Machine, radius: float) -> dict[str, float]:
    """Acceptability factor Q of pin fillet, journal fillet and oil bore with other fillets."""
    fillets = {"train.engine.fatigue.pin_fillet": radius, "train.engine.fatigue.journal_fillet": radius}
    (found,) = lw.crankshaft_fatigue(lw.replace(machine, fillets))
    return {one.place.replace(" ", "_"): one.acceptability for one in found.places}


def study(machine: lw.Machine) -> dict[str, float]:
    """Factors and Q of the crankshaft as it is; measured and computed peak of the torsiograph."""
    done = lw.torsion_study(machine)
    (found,), (overlay,) = done.fatigue, done.overlays
    (peak,) = overlay.peaks
    names = {"α_B": "alpha_B", "β_B": "beta_B", "β_Q": "beta_Q", "α_T": "alpha_T", "β_T": "beta_T"}
    numbers = {plain: float(found.factors[name]) for name, plain in names.items()}
    numbers |= {f"Q_{one.place.replace(' ', '_')}": one.acceptability for one in found.places}
    numbers |= {f"strength_{n}": one.strength / 1e6 for n, one in enumerate(found.places[:2])}
    numbers["Q_with_3_mm"] = crankshaft(machine, 3e-3)["crank_pin_fillet"]
    numbers |= {"peak_measured_rpm": peak.speed * 30 / np.pi, "peak_rpm": peak.speed_computed * 30 / np.pi}
    return numbers | {"peak_deg": float(np.degrees(peak.value_computed)), "difference": peak.value_difference}


def figure(machine: lw.Machine):
    """Q over the radius of the fillets, with what the rule asks for."""
    from linkwright.kernel.figure.style import INK, LINES, panels, styled

    @styled
    def drawn():
        drawing, (axes,) = panels(1, height=3.0)
        found, radii = [crankshaft(machine, radius) for radius in RADII], [1e3 * radius for radius in RADII]
        for place, colour in zip(("crank_pin_fillet", "journal_fillet"), LINES, strict=False):
            axes.plot(radii, [one[place] for one in found], "o-", color=colour, label=place.replace("_", " "))
        axes.axhline(1.15, linestyle="--", color=INK, label="required")
        axes.set(xlabel="radius of the fillets [mm]", ylabel="acceptability factor Q", ylim=(0, None))
        axes.legend()
        return drawing

    return drawn()


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:20} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
