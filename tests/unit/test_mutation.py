"""The mutation run: its sample, its changes, and the list of changes that nothing can notice."""

from __future__ import annotations

import pytest

from tests.mutation.equivalent import is_equivalent, listed
from tests.mutation.mutants import changed, mutants_of
from tests.mutation.results import ROOT, sample


def test_a_larger_sample_begins_with_the_smaller_one() -> None:
    small, large = (sample("mechanization", size, 1) for size in (5, 12))
    assert large[:5] == small and len(set(large)) == 12
    assert sample("mechanization", 5, 2) != small


def test_a_change_is_one_place() -> None:
    source = "a = b + 2.0 * c\nif a < -1.0 and b:\n    d = min(a, 3)\n"
    found = {changed(source, place) for place in range(8)}
    assert len(found) == 8
    assert "a = b - 2.0 * c\nif a < -1.0 and b:\n    d = min(a, 3)" in found
    assert "a = b + 2.2 * c\nif a < -1.0 and b:\n    d = min(a, 3)" in found
    assert "a = b + 2.0 * c\nif a < +1.0 and b:\n    d = min(a, 3)" in found
    assert "a = b + 2.0 * c\nif a < -1.0 or b:\n    d = min(a, 3)" in found
    assert "a = b + 2.0 * c\nif a < -1.0 and b:\n    d = max(a, 3)" in found


@pytest.mark.parametrize("place", range(len(listed())))
def test_the_list_names_changes_of_the_code_as_it_is(place: int) -> None:
    entry = listed()[place]
    alone = (entry,)
    same = [m for m in mutants_of(ROOT / entry["file"], ROOT) if is_equivalent(m, alone)]
    lines = {m.line for m in same}
    assert len(lines) == 1, f"{entry['what']!r} is a change of {len(lines)} lines of {entry['file']}"
    assert len(entry["why"]) > 30
