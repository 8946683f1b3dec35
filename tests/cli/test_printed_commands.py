"""The commands that README and documentation print work as printed, in an empty folder.

Those of README run with the extras that it tells to install, and no package of development.

`make test` runs them with the wheel, installed in an environment of its own (`make wheel-test`); the package
is then not that of the clone.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import subprocess
import sys
from http.cookiejar import CookieJar
from pathlib import Path
from urllib.request import HTTPCookieProcessor, ProxyHandler, build_opener

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright.app.application import COMMANDS, GROUPS

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
# Commands of the cases are run, and their numbers compared, in `tests/cases`.
PAGES = sorted(page for page in (ROOT / "docs").rglob("*.md") if page.name != "cases.md")

_FENCED = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
# Of a clone, or of what a reader has at hand; studies of a well are run by tests/rods.
_ELSEWHERE = ("train.toml", "--chunks", "tapers.toml", "speed.toml", "counterbalance.toml", "motors.toml")
# Serves until it is interrupted; `tests/studio` opens it.
_ENDLESS = "linkwright studio"
# Commands whose machine cannot do it, as the page says.
_FINDINGS = ("check press.toml --set mechanism.cranks.A.radius=",)


def commands(page: Path) -> list[str]:
    blocks = _FENCED.findall(page.read_text(encoding="utf-8"))
    lines = [line.removeprefix("$ ") for _, text in blocks for line in text.splitlines()]
    printed = [line for line in lines if line.startswith("linkwright ") and not line.startswith(_ENDLESS)]
    return [each for each in printed if not any(word in each for word in _ELSEWHERE)]


def prepared(page: Path, folder: Path) -> None:
    text = page.read_text(encoding="utf-8")
    if "one_cart.toml" in text:
        machine = next(block for kind, block in _FENCED.findall(text) if kind == "toml")
        (folder / "one_cart.toml").write_text(machine, encoding="utf-8")
    for kind, block in _FENCED.findall(text):
        # A file whose first line is its name.
        if kind in ("toml", "csv") and (name := re.match(rf"# (\w+\.{kind})\n", block)):
            (folder / name[1]).write_text(block[name.end() :], encoding="utf-8")
    if "flywheel.csv" in text:
        # Eight cylinders that fire at one strength, over two revolutions.
        rows = [f"{n}, {1500 * (1 + 0.01 * np.cos(n * np.pi / 90)):.6f}" for n in range(721)]
        (folder / "flywheel.csv").write_text("\n".join(["angle [deg], speed [rpm]", *rows]) + "\n")
    if "card.csv" in text:
        # The predicted card of the page's well, or of that of the library.
        well = folder / "well.toml"
        motion = lw.rod_string(lw.read(well if well.exists() else "rod_string"), accuracy=0.02)
        step = len(motion.rod_load) // 200
        rows = [f"{x:.5f}, {F:.1f}" for x, F in zip(motion.rod_position, motion.rod_load, strict=True)]
        (folder / "card.csv").write_text("\n".join(["position [m], load [N]", *rows[::step]]) + "\n")
    if "--cards day" in text:
        (folder / "day").mkdir()
        for hour in ("08", "14"):
            (folder / "day" / f"{hour}.csv").write_bytes((folder / "card.csv").read_bytes())
    if "rod.dxf" in text:
        drawing = ROOT / "examples" / "drawn_connecting_rod" / "rod.dxf"
        (folder / "rod.dxf").write_bytes(drawing.read_bytes())
    if "trial.csv" in text:
        (folder / "trial.csv").write_text("speed [rpm], line [MPa]\n60, 21.5\n76, 90\n90, 30\n")


def code_and_output(words: list[str]) -> tuple[int, str]:
    done = invoke(*words)
    return done.exit_code, done.output


@pytest.mark.parametrize("page", [page for page in PAGES if commands(page)], ids=lambda page: page.stem)
def test_commands_work_as_printed(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    prepared(page, tmp_path)
    for line in commands(page):
        words = shlex.split(line, comments=True)[1:]
        code, output = code_and_output(words)
        wrong = 2 if any(each in " ".join(words) for each in _FINDINGS) else 0
        assert code == wrong, f"{line}\n{output}"


def in_the_demo(*lines: str) -> list[str]:
    (extras,) = set(re.findall(r"'linkwright\[(.*?)\]'", README.read_text(encoding="utf-8")))
    return [sys.executable, str(ROOT / "tests" / "samples" / "demo_environment.py"), extras, *lines]


def test_readme_from_top_to_bottom(tmp_path: Path) -> None:
    prepared(README, tmp_path)
    lines = commands(README)
    done = subprocess.run(in_the_demo(*lines), cwd=tmp_path, capture_output=True, text=True, check=False)
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert [(line, code) for line, code, _ in answers] == [(line, 0) for line in lines], (
        answers[-1:],
        done.stderr,
    )
    assert (tmp_path / "out" / "roller_two_carts" / "report.html").is_file()
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.skipif(os.name == "nt", reason="needs signals of Unix")
def test_studio_of_the_readme_answers(tmp_path: Path) -> None:
    prepared(README, tmp_path)
    (line,) = re.findall(rf"^{_ENDLESS} [\w.]+", README.read_text(encoding="utf-8"), re.MULTILINE)
    # Who started the tests may have let them ignore interrupts.
    server = subprocess.Popen(
        in_the_demo(f"{line} --no-browser"),
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    try:
        assert server.stdout is not None
        address = server.stdout.readline().removeprefix("Linkwright studio: ").strip()
        assert address.startswith("http://127.0.0.1:")
        visitor = build_opener(ProxyHandler({}), HTTPCookieProcessor(CookieJar()))
        with visitor.open(address.partition("#")[0], timeout=60) as page:
            assert page.status == 200
            assert "<title>" in page.read().decode()
    finally:
        server.send_signal(signal.SIGINT)
        _, told = server.communicate(timeout=60)
    assert "Traceback" not in told
    assert server.returncode == 130


def test_packages_of_development_are_hidden(tmp_path: Path) -> None:
    script = (
        "import demo_environment as d; d.hide(['report']); import typst\ntry: import pytest, linkwright\n"
    )
    script += "except ModuleNotFoundError as error: print(error.name)"
    here = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tests" / "samples"), *sys.path])}
    done = subprocess.run(
        [sys.executable, "-c", script], env=here, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "pytest"


def outputs(page: Path) -> list[tuple[str, list[str]]]:
    """Commands of a page and the lines printed below each; without those of a record that the reader has."""
    found = []
    for kind, text in _FENCED.findall(page.read_text(encoding="utf-8")):
        first, *below = text.splitlines()
        lines = [_spaced(line) for line in below if _spaced(line).strip("… ")]
        if kind == "text" and first.startswith("$ linkwright ") and lines and ".csv" not in first:
            found.append((first.removeprefix("$ "), lines))
    return found


def _spaced(line: str) -> str:
    return " ".join(line.replace("─", " ").split())


@pytest.mark.parametrize(
    "page", [page for page in [README, *PAGES] if outputs(page)], ids=lambda page: page.stem
)
def test_output_is_as_printed(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    # Wide enough for no cell to be broken.
    monkeypatch.setattr("linkwright.kernel.command.console._WIDTH", 130)
    prepared(page, tmp_path)
    blocks = _FENCED.findall(page.read_text(encoding="utf-8"))
    for line, printed in outputs(page):
        if "train.toml" in line:
            train = next(text for kind, text in blocks if kind == "toml" and "[train.gears]" in text)
            (tmp_path / "train.toml").write_text(train, encoding="utf-8")
        _, output = code_and_output(shlex.split(line)[1:])
        told = {_spaced(one) for one in output.splitlines()}
        assert [one for one in printed if one not in told] == [], line


@pytest.mark.parametrize("words", ["-h", "--version", "--show-completion bash", "new engine", "papers 1 -h"])
def test_what_every_user_tries(words: str) -> None:
    code, output = code_and_output(words.split())
    assert code == 0, output
    assert output.strip()


@pytest.mark.parametrize("name", [*COMMANDS, *GROUPS])
def test_every_command_has_help(name: str) -> None:
    code, output = code_and_output([name, "-h"])
    assert code == 0, output
    assert "Options:" in output


@pytest.mark.parametrize(
    "program", [[sys.executable, "-m", "linkwright"], [str(Path(sys.executable).with_name("linkwright"))]]
)
def test_the_program_itself(program: list[str], tmp_path: Path) -> None:
    words = [*program, "run", "flywheel_four_stroke", "--json"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout)["machine"]


@pytest.mark.skipif("LINKWRIGHT_WHEEL" not in os.environ, reason="of `make wheel-test`")
def test_the_package_is_that_of_the_wheel() -> None:
    assert not Path(lw.__file__).is_relative_to(ROOT / "python")
