"""Pages that are computed while the documentation is built, hooks of MkDocs: gallery, papers, notebooks.

Each example has a page with its question, its picture, script, machine file and numbers with their sources;
each paper the page that ``linkwright papers`` writes; each notebook is executed. Nothing of it is stored:
pictures and numbers are those of the package that is documented.
"""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

import linkwright as lw

EXAMPLES = Path(__file__).parents[1] / "examples"
NOTEBOOKS = Path(__file__).with_name("notebooks")

# What a browser loads by itself, from elsewhere.
_ELSEWHERE = r"[^>]* (?:src|href)=\"(https?:[^\"]+)"
_LOADED = re.compile(rf"<(?:script|img|iframe|link(?![^>]* rel=\"canonical)){_ELSEWHERE}")

_ROW = re.compile(r"^\| \[(\w+)\]\(\1/run\.py\) \| (.*?) \| (.*?) \|$", re.MULTILINE)


class Example(NamedTuple):
    """An example: its folder, its question, and the calls that answer it."""

    name: str
    question: str
    analysis: str


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the computed pages to those that are written."""
    for place, content in (*gallery(), *papers(), *notebooks()):
        files.append(File.generated(config, place, content=content))
    return files


def on_post_page(output: str, **_: Any) -> str:
    """The page as it is; an error if it needs more than the folder that it is in."""
    if match := _LOADED.search(output):
        raise PluginError(f"the page loads {match[1]}; pages are read without a network")
    return output


def examples() -> list[Example]:
    """All examples in the order of their list."""
    listed = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    return [Example(*row) for row in _ROW.findall(listed)]


def gallery() -> Iterator[tuple[str, str | bytes]]:
    """The page of all examples, and picture and page of each."""
    cards = "\n".join(
        f"[![]({one.name}.png){{ loading=lazy }}<br>{one.question}]({one.name}.md)\n" for one in examples()
    )
    yield "gallery/index.md", f'# Gallery\n\n<div class="gallery" markdown>\n\n{cards}\n</div>\n'
    for one in examples():
        yield f"gallery/{one.name}.png", _picture(one.name)
        yield f"gallery/{one.name}.md", _page(one)


def _picture(name: str) -> bytes:
    """What the script of an example draws."""
    spec = importlib.util.spec_from_file_location(f"example_{name}", EXAMPLES / name / "run.py")
    assert spec is not None
    assert spec.loader is not None
    script: Any = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    picture = BytesIO()
    script.figure(lw.read(EXAMPLES / name / "machine.toml")).savefig(picture, format="png", dpi=110)
    return picture.getvalue()


def _page(one: Example) -> str:
    """Question, picture, numbers with their sources, machine file and script of an example."""
    files = {name: EXAMPLES / one.name / name for name in ("expected.toml", "machine.toml", "run.py")}
    numbers, machine, script = (path.read_text(encoding="utf-8") for path in files.values())
    return (
        f"# {one.question}\n\n![]({one.name}.png)\n\nAnalysis: {one.analysis}\n\n"
        f"## Script\n\n```python\n{script}```\n\n## Machine file\n\n```toml\n{machine}```\n\n"
        f"## Results, with the source of each number\n\n```toml\n{numbers}```\n"
    )


def papers() -> Iterator[tuple[str, str | bytes]]:
    """The list of the papers, and the page of each."""
    from linkwright.papers.page import page
    from linkwright.papers.paper import PAPERS, paper

    rows = []
    for number in PAPERS:
        one = paper(number)
        yield f"papers/paper{number}.html", page(one, one.figures())
        rows.append(f"| [{one.title}](paper{number}.html) | {len(one.rows)} |")
    table = "\n".join(rows)
    text = "Each value that a paper prints is computed with the methods of this package and compared."
    yield (
        "papers/index.md",
        f"# Papers\n\n{text}\n\n| paper | statements compared |\n| --- | --- |\n{table}\n",
    )


def notebooks() -> Iterator[tuple[str, str | bytes]]:
    """The page of each notebook with its results, its pictures, and the executed notebook itself."""
    import nbformat
    from nbconvert import MarkdownExporter
    from nbconvert.preprocessors import ExecutePreprocessor

    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        notebook = nbformat.read(path, as_version=4)
        ExecutePreprocessor(timeout=300, startup_timeout=300).preprocess(
            notebook, {"metadata": {"path": str(NOTEBOOKS)}}
        )
        resources = {"unique_key": path.stem, "output_files_dir": "."}
        text, results = MarkdownExporter().from_notebook_node(notebook, resources)
        yield f"notebooks/{path.stem}.md", f"{text}\n[The notebook]({path.stem}_executed.ipynb)\n"
        yield f"notebooks/{path.stem}_executed.ipynb", nbformat.writes(notebook)
        for name, data in results["outputs"].items():
            yield f"notebooks/{Path(name).name}", data
