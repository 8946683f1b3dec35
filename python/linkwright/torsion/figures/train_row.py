"""In which order the discs of a train stand beside each other in a figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence


def in_a_row(discs: Sequence[str], joined: Sequence[tuple[str, str]]) -> list[int]:
    """Places of the discs along a chain, from the end that is nearer to the first."""
    about: dict[str, list[str]] = {name: [] for name in discs}
    for a, b in joined:
        if a in about and b in about and b not in about[a]:
            about[a].append(b)
            about[b].append(a)
    ends = [name for name in discs if len(about[name]) < 2]
    if len(ends) != 2 or any(len(each) > 2 for each in about.values()):
        return list(range(len(discs)))
    # From the end that is nearer to the first disc of the file.
    row = min((_from(end, about) for end in ends), key=lambda each: each.index(discs[0]))
    place = {name: n for n, name in enumerate(discs)}
    return [place[name] for name in row] if len(row) == len(discs) else list(range(len(discs)))


def _from(end: str, about: Mapping[str, Sequence[str]]) -> list[str]:
    """The chain from one of its ends."""
    row, before = [end], ""
    while after := [name for name in about[row[-1]] if name != before]:
        before = row[-1]
        row.append(after[0])
    return row
