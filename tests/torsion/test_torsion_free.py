"""Free vibration of trains: closed forms, laws, and SciPy's solver on random trees."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh
from sizes import cases
from trains import Gear, Shaft, matrices, omega, text, train

import linkwright as lw
from linkwright import FindingError, InputError, MachineError

# Rounding of closed forms over a few operations.
ROUNDING = 1e-13


def test_two_discs() -> None:
    """ω² = k (J₁ + J₂)/(J₁J₂), amplitudes as the inertias, upside down."""
    found = train({"a": 2.0, "b": 5.0}, [("a", "b", 3e4)])
    assert omega(found) == pytest.approx([0.0, np.sqrt(3e4 * 7 / 10)], rel=ROUNDING)
    assert found.mode_shapes == pytest.approx(np.array([[1, 1], [1, -0.4]]), rel=ROUNDING)
    assert found.nodes[0] == ()
    ((at, share, distance),) = found.nodes[1]
    assert (at, distance) == ("s0", None)
    assert share == pytest.approx(1 / 1.4)


@pytest.mark.parametrize("n", [2, 7, 40])
def test_even_chain(n: int) -> None:
    """n equal discs and shafts: ω_m = 2√(k/J) sin(mπ/2n), θ_j ∝ cos(mπ(2j + 1)/2n)."""
    discs = {f"d{j}": 0.3 for j in range(n)}
    found = train(discs, [(f"d{j}", f"d{j + 1}", 8e3) for j in range(n - 1)])
    m = np.arange(n)
    wanted = 2 * np.sqrt(8e3 / 0.3) * np.sin(m * np.pi / (2 * n))
    assert omega(found) == pytest.approx(wanted, rel=1e-12, abs=1e-12)
    shapes = np.cos(np.outer(m, 2 * np.arange(n) + 1) * np.pi / (2 * n))
    cosine = np.einsum("mj,mj->m", shapes, found.mode_shapes) / (
        np.linalg.norm(shapes, axis=1) * np.linalg.norm(found.mode_shapes, axis=1)
    )
    assert np.abs(cosine) == pytest.approx(np.ones(n), abs=1e-12)
    assert np.abs(found.mode_shapes).max(axis=1) == pytest.approx(np.ones(n), rel=ROUNDING)
    # A mode has as many nodes as its number (Gantmacher and Krein: chains are oscillatory).
    assert [len(nodes) for nodes in found.nodes] == list(range(n))


def test_held_at_one_and_at_both_ends() -> None:
    """ω = 2√(k/J) sin((2m − 1)π/(4n + 2)) held at one end, 2√(k/J) sin(mπ/(2n + 2)) at both."""
    n = 5
    discs = {f"d{j}": 2.0 for j in range(n)}
    chain: list[Shaft] = [(f"d{j}", f"d{j + 1}", 50.0) for j in range(n - 1)]
    m = np.arange(1, n + 1)
    one: list[Shaft] = [*chain, ("ground", "d0", 50.0)]
    found = omega(train(discs, one))
    assert found == pytest.approx(10 * np.sin((2 * m - 1) * np.pi / (4 * n + 2)), rel=1e-12)
    both = omega(train(discs, [*one, ("d4", "ground", 50.0)]))
    assert both == pytest.approx(10 * np.sin(m * np.pi / (2 * n + 2)), rel=1e-12)


def test_geared_discs() -> None:
    """Motor and machine on their shafts behind a gear: the second side counts by 1/i²."""
    discs = {"motor": 0.4, "pinion": 0.05, "wheel": 1.1, "machine": 9.0}
    shafts = [("motor", "pinion", 2e4), ("wheel", "machine", 9e4)]
    found = train(discs, shafts, [("pinion", "wheel", 4.0, None)])
    J, k = np.array([0.4, 0.05 + 1.1 / 16, 9.0 / 16]), np.array([2e4, 9e4 / 16])
    # The cubic of three discs (Den Hartog, section 5.2) in λ = ω².
    b = k[0] / J[0] + k.sum() / J[1] + k[1] / J[2]
    c = k.prod() * J.sum() / J.prod()
    square = np.array([0, (b - np.sqrt(b * b - 4 * c)) / 2, (b + np.sqrt(b * b - 4 * c)) / 2])
    assert omega(found) == pytest.approx(np.sqrt(square), rel=1e-12)
    # Behind the gear every amplitude is smaller by the ratio, in its own sense of rotation.
    assert found.mode_shapes[:, 2] == pytest.approx(found.mode_shapes[:, 1] / 4, rel=ROUNDING)
    assert found.mode_shapes[0] == pytest.approx([1, 1, 0.25, 0.25], rel=ROUNDING)


@st.composite
def trees(draw: st.DrawFn) -> tuple[dict[str, float], list[Shaft], list[Gear]]:
    """Trains without loops, branched, with elastic meshes, free or held."""
    n = draw(st.integers(1, 12))
    number = st.floats(0.05, 20.0)
    discs = {f"d{j}": draw(number) for j in range(n)}
    shafts, gears = [], []
    for j in range(1, n):
        other = f"d{draw(st.integers(0, j - 1))}"
        if draw(st.booleans()):
            gears.append((f"d{j}", other, draw(st.floats(0.2, 5.0)), 1e3 * draw(number)))
        else:
            shafts.append((f"d{j}", other, 1e3 * draw(number)))
    if draw(st.booleans()):
        shafts.append((f"d{draw(st.integers(0, n - 1))}", "ground", 1e3 * draw(number)))
    return discs, shafts, gears


@given(trees())
@settings(max_examples=cases(150, 1500), deadline=None)
def test_laws_on_any_tree(case: tuple[dict[str, float], list[Shaft], list[Gear]]) -> None:
    discs = case[0]
    found, (J, K) = train(*case), matrices(*case)
    square, _ = eigh(K, J)
    top = max(square.max(), 1.0)
    # SciPy's error is a few units in the last place of the highest ω².
    assert omega(found) ** 2 == pytest.approx(square, rel=1e-10, abs=1e-12 * top)
    # Trace: the sum of all ω².
    assert (omega(found) ** 2).sum() == pytest.approx(np.trace(np.linalg.solve(J, K)), rel=1e-11)
    # Each shape solves the equation, the residual measured against the torques that meet in it.
    q = found.mode_shapes.T
    rest = K @ q - J @ q * omega(found) ** 2
    size = np.abs(K) @ np.abs(q) + J @ np.abs(q) * omega(found) ** 2
    assert (np.abs(rest) <= 1e-9 * size.max(axis=0)).all()
    # Orthogonal in J and in K.
    unit = q / np.sqrt(found.modal_inertia)
    assert unit.T @ J @ unit == pytest.approx(np.eye(len(discs)), abs=1e-8)
    assert unit.T @ K @ unit == pytest.approx(np.diag(omega(found) ** 2), abs=1e-8 * top)
    # Shares are shares, and potential energy is as large as kinetic.
    assert found.kinetic_shares.sum(axis=1) == pytest.approx(np.ones(len(discs)))
    moving = omega(found) > 0
    assert found.potential_shares.sum(axis=1) == pytest.approx(moving.astype(float))
    potential = np.einsum("im,ij,jm->m", q, K, q)
    assert found.modal_stiffness == pytest.approx(potential, rel=1e-8, abs=1e-9 * top)


@given(trees(), st.floats(0.1, 10.0))
@settings(max_examples=cases(50, 500), deadline=None)
def test_the_speed_that_is_referred_to_does_not_matter(
    case: tuple[dict[str, float], list[Shaft], list[Gear]], speed: float
) -> None:
    """A rigid stage with the first disc behind it: J i² and k i² there give the same frequencies."""
    discs, shafts, gears = case
    plain = omega(train(*case))
    inner = {name: J * speed**2 for name, J in discs.items()}
    stiffer = [(a, b, k * speed**2) for a, b, k in shafts]
    meshes = [(a, b, ratio, None if k is None else k * speed**2) for a, b, ratio, k in gears]
    # d0 turns `speed` times slower than the disc before it, whose inertia hardly counts.
    tiny = 1e-13 * inner["d0"] / speed**2
    geared = train({"front": tiny, **inner}, stiffer, [*meshes, ("front", "d0", speed, None)])
    assert omega(geared) == pytest.approx(plain, rel=1e-9, abs=1e-9)


def test_a_stiff_mesh_is_rigid() -> None:
    """ω tends to that of the rigid stage as 1/k."""
    discs = {"a": 0.4, "b": 0.05, "c": 1.1, "d": 9.0}
    shafts = [("a", "b", 2e4), ("c", "d", 9e4)]
    rigid = omega(train(discs, shafts, [("b", "c", 4.0, None)]))
    away = [
        np.abs(omega(train(discs, shafts, [("b", "c", 4.0, k)]))[:3] - rigid).max() for k in (1e8, 1e9, 1e10)
    ]
    assert away[0] / away[1] == pytest.approx(10, rel=0.01)
    assert away[2] < 1e-5 * rigid[1]


@pytest.mark.parametrize("held", [False, True])
def test_sensitivities_are_derivatives(held: bool) -> None:
    discs = {"a": 0.4, "b": 0.05, "c": 1.1, "d": 9.0}
    shafts: list[Shaft] = [("a", "b", 2e4), ("c", "d", 9e4)] + ([("d", "ground", 4e4)] if held else [])
    gears: list[Gear] = [("b", "c", 4.0, 7e4)]
    found = train(discs, shafts, gears)
    # Central differences: the error is a step of 1e-5 squared, and rounding over the step.
    step = 1e-5
    moving = slice(None) if held else slice(1, None)
    for n, name in enumerate(discs):
        up, down = (train({**discs, name: discs[name] * (1 + h)}, shafts, gears) for h in (step, -step))
        slope = 2 * np.log(omega(up)[moving] / omega(down)[moving]) / (2 * step)
        assert found.sensitivity_to_inertia[moving, n] == pytest.approx(slope, abs=1e-8)
    for n, (a, b, k) in enumerate(shafts):
        changed = [[*shafts[:n], (a, b, k * (1 + h)), *shafts[n + 1 :]] for h in (step, -step)]
        up, down = (train(discs, each, gears) for each in changed)
        slope = 2 * np.log(omega(up)[moving] / omega(down)[moving]) / (2 * step)
        assert found.sensitivity_to_stiffness[moving, n] == pytest.approx(slope, abs=1e-8)


def test_parallel_shafts_add_up() -> None:
    one = train({"a": 2.0, "b": 5.0}, [("a", "b", 7.0)])
    two = train({"a": 2.0, "b": 5.0}, [("a", "b", 3.0), ("b", "a", 4.0)])
    assert omega(two) == pytest.approx(omega(one), rel=ROUNDING)
    assert two.potential_shares[1] == pytest.approx([3 / 7, 4 / 7])


def test_a_ring_of_shafts() -> None:
    """n equal discs in a ring: ω_m = 2√(k/J) sin(mπ/n), in pairs; shapes of a pair are orthogonal."""
    n = 6
    discs = {f"d{j}": 2.0 for j in range(n)}
    found = train(discs, [(f"d{j}", f"d{(j + 1) % n}", 50.0) for j in range(n)])
    wanted = np.sort(10 * np.sin(np.arange(n) * np.pi / n))
    assert omega(found) == pytest.approx(wanted, abs=1e-12)
    q = found.mode_shapes
    assert q @ q.T == pytest.approx(np.diag((q**2).sum(axis=1)), abs=1e-12)


@pytest.mark.parametrize("loop", [False, True])
def test_rings_of_viscous_dampers_turn_alone(loop: bool) -> None:
    """No stiffness holds them: a zero frequency each, and the rest as if they were not there."""
    discs = {f"d{j}": 0.5 + j for j in range(4)}
    shafts: list[Shaft] = [(f"d{j}", f"d{j + 1}", 50.0 * (j + 1)) for j in range(3)]
    shafts += [("d3", "d1", 70.0)] if loop else []
    dampers = """
        [train.dampers.first]
        on = "d0"
        ring_inertia = 0.2
        damping = 3.0
        [train.dampers.second]
        on = "d2"
        ring_inertia = 0.4
        damping = 1.0
    """
    found = lw.free_vibration(lw.loads(text(discs, shafts) + dampers))
    plain = train(discs, shafts)
    assert found.natural_frequencies[:3].tolist() == [0.0, 0.0, 0.0]
    assert found.natural_frequencies[3:] == pytest.approx(plain.natural_frequencies[1:], rel=ROUNDING)
    whole, first, second = found.mode_shapes[:3]
    assert whole.tolist() == [1.0, 1.0, 1.0, 1.0, 0.0, 0.0]
    assert first.tolist() == [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    assert second.tolist() == [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    assert found.mode_shapes[3:, :4] == pytest.approx(plain.mode_shapes[1:], abs=1e-9)
    assert not found.mode_shapes[3:, 4:].any()
    assert found.potential_shares[3:].sum(axis=1) == pytest.approx(np.ones(3))
    assert not found.potential_shares[:3].any()


def test_equal_branches_are_orthogonal() -> None:
    """A hub with three equal branches: a pair of modes in which the hub is at rest."""
    discs = {"hub": 1.0, "a": 2.0, "b": 2.0, "c": 2.0}
    found = train(discs, [("hub", each, 18.0) for each in "abc"])
    assert omega(found) == pytest.approx([0, 3, 3, np.sqrt(9 + 54)], rel=1e-12)
    assert found.mode_shapes[1:3, 0] == pytest.approx(np.zeros(2), abs=1e-12)
    assert found.mode_shapes[1] @ found.mode_shapes[2] == pytest.approx(0, abs=1e-12)
    assert all(nodes[0].at == "hub" for nodes in found.nodes[1:3])


def test_tuned_branches_of_other_size() -> None:
    """k/J alike in both branches: they swing against each other, by their inertias, with the hub at rest."""
    discs = {"hub": 1.0, "small": 0.05000000000000001, "large": 0.4609375}
    found = train(discs, [("small", "hub", 50.0), ("large", "hub", 460.9375)])
    assert omega(found)[1] == pytest.approx(np.sqrt(1000), rel=1e-12)
    assert found.mode_shapes[1] == pytest.approx([0, 1, -0.05 / 0.4609375], abs=1e-12)


def test_sections_are_springs_in_a_row() -> None:
    """k = 1/Σ L/(G I_p); the node of equal halves lies where half the twist is."""
    machine = lw.loads("""
        format = 1
        name = "Stepped shaft"
        [train.discs]
        a = { inertia = "2 kg m^2" }
        b = { inertia = "2 kg m^2" }
        [train.shafts.s]
        between = ["a", "b"]
        shear_modulus = "80 GPa"
        sections = [
          { length = "300 mm", diameter = "40 mm" },
          { length = "500 mm", diameter = "60 mm", inner_diameter = "20 mm" },
        ]
    """)
    compliance = [0.3 / (80e9 * np.pi / 32 * 0.04**4), 0.5 / (80e9 * np.pi / 32 * (0.06**4 - 0.02**4))]
    found = lw.free_vibration(machine)
    assert omega(found)[1] == pytest.approx(np.sqrt(1 / sum(compliance)), rel=ROUNDING)
    (node,) = found.nodes[1]
    assert node.share == pytest.approx(0.5)
    assert node.distance == pytest.approx(0.3 * 0.5 * sum(compliance) / compliance[0])


def test_one_disc_on_a_shaft_to_the_ground() -> None:
    found = train({"a": 2.0}, [("ground", "a", 18.0)])
    assert omega(found) == pytest.approx([3.0], rel=ROUNDING)
    assert found.twists[0] == pytest.approx([-1.0])
    assert found.nodes == ((),)


def test_a_machine_without_train() -> None:
    with pytest.raises(InputError, match=r"no \[train\]"):
        lw.free_vibration(lw.loads('format = 1\nname = "x"\n[mechanism]\n'))


@pytest.mark.parametrize("value", [np.array([1.0, 2.0]), float("nan"), -1.0, 0.0])
@pytest.mark.parametrize("key", ["discs.a.inertia", "shafts.s0.stiffness", "gears.g0.ratio"])
def test_entries_exchanged_unchecked(key: str, value: object) -> None:
    machine = lw.loads(text({"a": 2.0, "b": 1.0}, [("ground", "a", 18.0)], [("a", "b", 2.0, None)]))
    with pytest.raises(MachineError, match=key.rsplit(".", 1)[0]):
        lw.free_vibration(lw.replace(machine, {f"train.{key}": value}))


def test_rigid_train_and_single_disc() -> None:
    """Nothing twists: the motion as a whole alone."""
    single = train({"a": 2.0}, [])
    assert (single.natural_frequencies, single.mode_shapes) == ([0.0], [[1.0]])
    rigid = train({"a": 2.0, "b": 1.0}, [], [("a", "b", 0.5, None)])
    assert rigid.natural_frequencies == pytest.approx([0.0])
    assert rigid.mode_shapes == pytest.approx(np.array([[0.5, 1.0]]))
    assert rigid.twists.shape == (1, 0)


def test_a_loop_of_stages_that_can_turn() -> None:
    """A pinion between two idlers that drive one wheel: both ways give the same ratio."""
    discs = {"pinion": 0.1, "left": 0.3, "right": 0.3, "wheel": 5.0, "load": 7.0}
    gears: list[Gear] = [("pinion", "left", 2.0, 4e5), ("pinion", "right", 2.0, 4e5)]
    gears += [("left", "wheel", 3.0, 9e5), ("right", "wheel", 3.0, 9e5)]
    shafts: list[Shaft] = [("wheel", "load", 2e5)]
    J, K = matrices(discs, shafts, gears)
    wanted = np.sqrt(np.maximum(eigh(K, J, eigvals_only=True), 0))
    assert omega(train(discs, shafts, gears)) == pytest.approx(wanted, rel=1e-9, abs=1e-3)


def test_a_train_alone_has_no_crank() -> None:
    machine = lw.loads(text({"a": 2.0}, [("ground", "a", 18.0)]))
    with pytest.raises(InputError, match="train without a"):
        lw.reduction(machine)


def test_holzer_of_a_chain_is_the_march() -> None:
    """Row by row: θ of the next disc is less by the sum of all torques before it over k."""
    J, k = [0.7, 1.9, 0.4, 2.2], [300.0, 900.0, 500.0]
    names = ["a", "b", "c", "d"]
    shafts = list(zip(names, names[1:], k, strict=False))
    machine = lw.loads(text(dict(zip(names, J, strict=True)), shafts))
    for frequency in (0.0, 1.3, 4.0, 11.0):
        square = (2 * np.pi * frequency) ** 2
        theta, total = [1.0], J[0] * square
        for n in range(3):
            theta.append(theta[-1] - total / k[n])
            total += J[n + 1] * square * theta[-1]
        found = lw.holzer_table(machine, frequency)
        assert found.amplitude == pytest.approx(theta, rel=1e-11)
        assert found.residual_torque == pytest.approx(total, rel=1e-11)
        assert found.shaft_torque == pytest.approx(np.cumsum(found.torque)[:3], rel=1e-10, abs=1e-12)


def test_holzer_leaves_nothing_at_natural_frequencies() -> None:
    discs = {"a": 0.4, "b": 0.05, "c": 1.1, "d": 9.0, "e": 0.3}
    shafts: list[Shaft] = [("a", "b", 2e4), ("c", "d", 9e4), ("c", "e", 5e3)]
    machine = lw.loads(text(discs, shafts, [("b", "c", 4.0, None)]))
    found = lw.free_vibration(machine)
    for frequency, shape in zip(found.natural_frequencies, found.mode_shapes, strict=True):
        table = lw.holzer_table(machine, frequency)
        assert table.amplitude == pytest.approx(shape / shape[0], rel=1e-8)
        # Rounding of torques that cancel: those of the stiffest shaft.
        assert abs(table.residual_torque) <= 1e-11 * 9e4


def test_holzer_residual_is_at_the_speed_of_its_disc() -> None:
    """Power in is power through: M θ at the end is Σ J ω² θ² less Σ k Δ²."""
    discs = {"a": 0.4, "b": 0.05, "c": 1.1, "d": 9.0}
    machine = lw.loads(text(discs, [("a", "b", 2e4), ("c", "d", 9e4)], [("b", "c", 4.0, 6e4)]))
    for end in discs:
        found = lw.holzer_table(machine, 20.0, end=end)
        work = found.residual_torque * found.amplitude[found.discs.index(end)]
        stored = found.torque @ found.amplitude - found.shaft_torque @ found.twist
        assert work == pytest.approx(stored, rel=1e-9)


def test_holzer_where_the_first_disc_cannot_move() -> None:
    """The branch c alone at √(k/J) holds the hub, so nothing at b moves a."""
    discs = {"a": 1.0, "hub": 1.0, "c": 2.0, "b": 1.0}
    machine = lw.loads(text(discs, [("a", "hub", 5.0), ("hub", "c", 18.0), ("hub", "b", 7.0)]))
    with pytest.raises(FindingError, match="another end"):
        lw.holzer_table(machine, 3.0 / (2 * np.pi))
    assert lw.holzer_table(machine, 3.0 / (2 * np.pi), end="c").amplitude[0] == 1.0


@pytest.mark.parametrize("frequency", [-1.0, np.nan, np.inf])
def test_holzer_frequency(frequency: float) -> None:
    with pytest.raises(InputError, match="frequency"):
        lw.holzer_table(lw.loads(text({"a": 2.0}, [("ground", "a", 18.0)])), frequency)


def test_holzer_end_that_is_none() -> None:
    with pytest.raises(InputError, match='end: found "x"'):
        lw.holzer_table(lw.loads(text({"a": 2.0}, [])), 1.0, end="x")
