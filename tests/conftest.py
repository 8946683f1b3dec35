"""What all tests share: random cases are always the same ones, and a busy machine is no failure."""

import gc
import os
import re
from collections import Counter
from collections.abc import Generator
from pathlib import Path

# Tests run beside each other: threads of linear algebra would only wait for one another, busily. It counts
# before NumPy is imported, and for the processes that tests start.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings
from sizes import DEEP, cases, newest, random_cases, told

settings.register_profile("same cases, any speed", derandomize=True, deadline=None)
settings.register_profile("other cases each time", max_examples=1000, deadline=None)
settings.load_profile("other cases each time" if DEEP else "same cases, any speed")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What sizes its random cases has more of them in `make test-deep`, which runs what is `deep`."""
    for item in items:
        names = vars(getattr(item, "module", None) or object)
        if names.get("cases") is cases or names.get("random_cases") is random_cases:
            item.add_marker(pytest.mark.deep)


def pytest_runtest_logstart() -> None:
    """A test has no random case yet."""
    newest.clear()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    call: pytest.CallInfo[None],
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """A failed test tells its random case, and its machine as a file."""
    report = yield
    if report.failed and call.excinfo is not None:
        report.sections += told(call.excinfo.value).items()
    return report


def pytest_collection_finish() -> None:
    """What is imported by now stays: the collector of garbage does not go through it again and again."""
    gc.collect()
    gc.freeze()
    # Drawing makes many objects that live shortly; looking for cycles among them took a fifth of its time.
    gc.set_threshold(50_000, 20, 20)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Tests and seconds by folder, beside the budget that CONTRIBUTING.md gives each."""
    table = (config.rootpath / "CONTRIBUTING.md").read_text(encoding="utf-8")
    budgets = dict(re.findall(r"`(tests/\w+)` \| (\d+)", table))
    tests, seconds = Counter[str](), Counter[str]()
    for reports in terminalreporter.stats.values():
        for report in reports:
            if isinstance(report, pytest.TestReport):
                folder = Path(report.nodeid.partition("::")[0]).parent.as_posix()
                tests[folder] += report.when == "call"
                seconds[folder] += report.duration
    terminalreporter.write_line(f"\n{'folder':<24}{'tests':>6}{'seconds':>9}{'budget':>8}")
    for folder, spent in seconds.most_common():
        terminalreporter.write_line(
            f"{folder:<24}{tests[folder]:>6}{spent:>9.1f}{budgets.get(folder, ''):>8}"
        )
    if len(seconds) > 1:
        terminalreporter.write_line(f"{'all':<24}{tests.total():>6}{sum(seconds.values()):>9.1f}")
