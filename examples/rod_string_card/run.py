"""How full is the barrel of a pump, and what does it lift, by the card of the load cell at the surface?"""

from pathlib import Path

import linkwright as lw

HERE = Path(__file__).parent
INCH, POUND, DAY = 0.0254, 4.4482216, 86_400


def diagnosis(machine: lw.Machine):
    """The card at the pump, with the damping fitted."""
    card = lw.read_card(HERE / "card.csv")
    return lw.diagnose_card(machine, card.position, card.load)


def study(machine: lw.Machine) -> dict[str, float]:
    """Fillage, plunger stroke, fluid load and production; damping of the rods."""
    found = diagnosis(machine)
    return {
        "fillage": found.fillage,
        "plunger_stroke_in": found.plunger_stroke / INCH,
        "fluid_load_lbf": found.fluid_load / POUND,
        "production_m3_per_day": found.production * DAY,
        "damping_factor": found.damping_factor,
        "harmonics": found.harmonics,
    }


def figure(machine: lw.Machine):
    """The measured card, and that of the pump."""
    from matplotlib.figure import Figure

    found = diagnosis(machine)
    drawing = Figure(figsize=(7, 5), layout="constrained")
    surface, pump = drawing.subplots(2, sharex=True)
    card = lw.read_card(HERE / "card.csv")
    surface.plot(card.position, card.load / 1e3, ".", markersize=3, label="samples")
    surface.plot(
        found.rod_position + card.position.min(), found.rod_load / 1e3, label="harmonics above the noise"
    )
    surface.set(ylabel="load of the polished rod [kN]")
    surface.legend()
    pump.plot(found.position[-1] - found.position[-1].min(), found.load[-1] / 1e3)
    pump.axvline(found.fillage * found.plunger_stroke, color="grey", linestyle="--")
    pump.set(xlabel="position above the bottom of the stroke [m]", ylabel="load of the pump [kN]")
    for axes in (surface, pump):
        axes.grid(alpha=0.3)
    return drawing


if __name__ == "__main__":
    example = lw.read(HERE / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:22} {value:.6g}")
    figure(example).savefig(HERE / "figure.png", dpi=120)
    print(f"{HERE / 'figure.png'}")
