"""Random turning-moment diagrams: tables of a machine file."""

from __future__ import annotations

import numpy as np

_RIM = 'rim = { density = "7200 kg/m^3", stress = "4 MPa", width_ratio = 2 }'


def formula(rng: np.random.Generator) -> str:
    terms = [f"c{k}*cos({k}*phi + p{k})" for k in range(1, 5)]
    constants = ", ".join(
        f"c{k} = {rng.uniform(100, 900):.6g}, p{k} = {rng.uniform(-3, 3):.6g}" for k in range(1, 5)
    )
    torque = f'torque = "m + {" + ".join(terms)}", constants = {{ m = 1500, {constants} }}'
    return f'driver = {{ kind = "formula", {torque} }}\nunevenness = 0.02\nradius_of_gyration = 0.7\n{_RIM}'


def table(rng: np.random.Generator) -> str:
    """A load by a table, in lines or steps, on a shaft with an inertia."""
    angles = np.sort(rng.uniform(0.1, 6.2, 7)).round(6).tolist()
    torques = rng.uniform(50, 900, 7).round(6).tolist()
    between = rng.choice(["linear", "steps"])
    return (
        f'load = {{ kind = "table", angle = {angles}, torque = {torques}, between = "{between}" }}\n'
        f"inertia = 30\nrim = {{ density = 7200, radius = 0.4 }}"
    )


def areas(rng: np.random.Generator) -> str:
    areas = rng.uniform(20, 90, 6) * [1, -1, 1, -1, 1, -1]
    areas[-1] -= areas.sum()
    return f"areas = {areas.tolist()}\narea_scale = 12\nunevenness = 0.03\ninertia = 1.5"
