"""A crank throw as a frame of beams, and as a solid of cubes: two models that know nothing of its formulas.

x goes along the shaft, y along the crank from the shaft to the pin, z across.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import splu

from linkwright.torsion import CrankThrow

Floats = NDArray[np.float64]


def _beam(length: float, EA: float, GJ: float, EI: tuple[float, float], GA: tuple[float, float]) -> Floats:
    """Timoshenko's beam along its first axis, (12, 12); EI and GA for bending along the second and third."""
    K = np.zeros((12, 12))
    for at, value in ((0, EA / length), (3, GJ / length)):
        K[np.ix_([at, at + 6], [at, at + 6])] += value * np.array([[1, -1], [-1, 1]])
    for along, about, sign, B, S in ((1, 5, 1, EI[0], GA[0]), (2, 4, -1, EI[1], GA[1])):
        shear, L = 12 * B / (S * length**2), length
        k = (
            B
            / (L**3 * (1 + shear))
            * np.array(
                [
                    [12, 6 * L, -12, 6 * L],
                    [6 * L, (4 + shear) * L**2, -6 * L, (2 - shear) * L**2],
                    [-12, -6 * L, 12, -6 * L],
                    [6 * L, (2 - shear) * L**2, -6 * L, (4 + shear) * L**2],
                ]
            )
        )
        turn = np.diag([1, sign, 1, sign])
        places = [along, about, along + 6, about + 6]
        K[np.ix_(places, places)] += turn @ k @ turn
    return K


def _arm(offset: Floats) -> Floats:
    """Motion of a point from that of another one, `offset` away from it on a rigid arm, (6, 6)."""
    x, y, z = offset
    T = np.eye(6)
    T[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return T


def _turned(K: Floats, axes: Floats) -> Floats:
    """A beam whose own axes are the rows of `axes`."""
    T = np.kron(np.eye(4), axes)
    return T.T @ K @ T


def frame_stiffness(throw: CrankThrow) -> Floats:
    """Stiffness of web, pin and web as beams, of the motion at the second web against the first, (6, 6).

    The webs are bars in their middle planes, from the axis of the shaft to that of the pin; the pin reaches
    from face to face and is joined to them by rigid arms of half their thickness.
    """
    R, L, h, B = throw.radius, throw.pin.length, throw.web.thickness, throw.web.breadth
    E, G, d, bore = throw.elastic_modulus, throw.shear_modulus, throw.pin.diameter, throw.pin.inner_diameter
    F, moment = np.pi / 4 * (d**2 - bore**2), np.pi / 64 * (d**4 - bore**4)
    # Shear factor 1.2 for the pin too, and the torsion of the web, as the formula for k has them.
    pin = _beam(L, E * F, 2 * G * moment, (E * moment,) * 2, (G * F / 1.2,) * 2)
    twist = G * (B * h) ** 3 / (3.6 * (B * B + h * h))
    # Own axes of a web: along the crank, along the shaft, across.
    web = _beam(R, E * h * B, twist, (E * B * h**3 / 12, E * h * B**3 / 12), (G * h * B / 1.2,) * 2)
    up = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]])
    down = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    K = np.zeros((24, 24))
    K[:12, :12] += _turned(web, up)
    arms = np.block(
        [
            [_arm(np.array([h / 2, 0, 0])), np.zeros((6, 6))],
            [np.zeros((6, 6)), _arm(np.array([-h / 2, 0, 0]))],
        ]
    )
    K[6:18, 6:18] += arms.T @ pin @ arms
    K[12:, 12:] += _turned(web, down)
    inner, outer = slice(6, 18), slice(18, 24)
    return K[outer, outer] - K[outer, inner] @ np.linalg.solve(K[inner, inner], K[inner, outer])


def _cube(nu: float) -> Floats:
    """A cube of side 1 and E = 1 with incompatible modes (Wilson), those taken out, (24, 24)."""
    lam, mu = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    C = np.diag([2 * mu] * 3 + [mu] * 3)
    C[:3, :3] += lam
    corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], float)
    K = np.zeros((33, 33))
    for p in corners / np.sqrt(3):
        f = 1 + corners * p
        slopes = corners * np.column_stack([f[:, 1] * f[:, 2], f[:, 0] * f[:, 2], f[:, 0] * f[:, 1]]) / 4
        g = np.vstack([slopes, np.diag(-4 * p)])
        b = np.zeros((6, 33))
        for n, (x, y, z) in enumerate(g):
            b[:, 3 * n : 3 * n + 3] = [[x, 0, 0], [0, y, 0], [0, 0, z], [y, x, 0], [0, z, y], [z, 0, x]]
        K += b.T @ C @ b / 8
    return K[:24, :24] - K[:24, 24:] @ np.linalg.solve(K[24:, 24:], K[24:, :24])


def solid_compliance(throw: CrankThrow, side: float) -> float:
    """Twist per torque of a throw of cubes, from the middle of a journal to the next, free to shift.

    Cubes on the surface are as stiff as they are full. Both ends turn as rigid discs. Of the two halves
    beside the plane of the crank one is enough: in that plane nothing moves but across it.
    """
    full, origin, side = _full(throw, side)
    at = np.argwhere(full > 0.02)
    steps = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    shape = tuple(np.array(full.shape) + 1)
    flat = np.ravel_multi_index(np.moveaxis(at[:, None] + steps, -1, 0), shape)
    used, members = np.unique(flat, return_inverse=True)
    nodes = np.column_stack(np.unravel_index(used, shape))
    cube = _cube(throw.elastic_modulus / (2 * throw.shear_modulus) - 1) * throw.elastic_modulus * side
    rows = (3 * members.reshape(-1, 8)[:, :, None] + np.arange(3)).reshape(-1, 24)
    values = full[tuple(at.T)][:, None, None] * cube
    pairs = (np.repeat(rows, 24, axis=1).ravel(), np.tile(rows, (1, 24)).ravel())
    K = csr_matrix((values.ravel(), pairs), shape=(3 * len(used),) * 2)
    held = np.repeat(nodes[:, :1] == 0, 3, axis=1)
    held[:, :2] |= nodes[:, 2:] == 0
    places = (nodes - [full.shape[0], origin, 0]) * side
    return _end_compliance(K, places, held.ravel(), nodes[:, 0] == full.shape[0]) / 2


def _end_compliance(K: csr_matrix, places: Floats, held: NDArray[np.bool_], last: NDArray[np.bool_]) -> float:
    """Twist per torque at the last face, rigid and free to shift and tilt across the crank."""
    motions = np.zeros((3 * len(places), 3))
    across = np.stack([_arm(each)[:3] for each in places[last]])[:, :, [2, 3, 4]]
    motions.reshape(-1, 3, 3)[last] = across
    free = ~(held | np.repeat(last, 3))
    # Symmetric and positive: factors without pivoting, in an order that keeps them thin.
    order = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    motions[free] = splu(K[free][:, free].tocsc(), **order).solve(-(K @ motions)[free])
    return float(np.linalg.inv(motions.T @ (K @ motions))[1, 1])


def _full(throw: CrankThrow, side: float) -> tuple[Floats, int, float]:
    """How full each cube is, where the axis of the shaft lies along the crank, and the side that fits."""
    journal, pin, h, R = throw.journal, throw.pin, throw.web.thickness, throw.radius
    n = round(throw.length / side)
    side = throw.length / n
    low, high = throw.web_centre - throw.web_length / 2, throw.web_centre + throw.web_length / 2
    half = max(throw.web.breadth, journal.diameter, pin.diameter) / 2
    j_0, m = int(np.ceil(max(-low, journal.diameter / 2) / side)), int(np.ceil(half / side))
    j_1 = int(np.ceil(max(high, R + pin.diameter / 2) / side))
    fine = (np.arange(4) + 0.5) / 4
    x, y, z = (((np.arange(a, b)[:, None] + fine) * side).ravel() for a, b in ((0, n), (-j_0, j_1), (0, m)))
    Y, Z = np.meshgrid(y, z, indexing="ij")

    def ring(r: Floats, d: float, bore: float) -> NDArray[np.bool_]:
        return (r < d / 2) & (r >= bore / 2)

    plates = (
        ring(np.hypot(Y, Z), journal.diameter, journal.inner_diameter),
        (low < Y) & (high > Y) & (np.abs(Z) < throw.web.breadth / 2),
        ring(np.hypot(Y - R, Z), pin.diameter, pin.inner_diameter),
    )
    from_middle = np.abs(x - throw.length / 2).reshape(n, 4)
    spans = (
        from_middle > pin.length / 2 + h,
        (from_middle <= pin.length / 2 + h) & (from_middle > pin.length / 2),
        from_middle <= pin.length / 2,
    )
    full = np.zeros((n, j_0 + j_1, m))
    for plate, span in zip(plates, spans, strict=True):
        share = plate.reshape(j_0 + j_1, 4, m, 4).mean(axis=(1, 3))
        full += span.mean(axis=1)[:, None, None] * share
    return full, j_0, side
