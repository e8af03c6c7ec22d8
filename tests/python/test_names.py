"""Different names stay different where they are made valid."""

from __future__ import annotations

import pytest
from ringlet.data.names import distinct, file_name, folded, identifier, unique
from similar_names import SIMILAR


@pytest.mark.parametrize("one, other", SIMILAR)
def test_similar_names_become_different_identifiers_and_files(one, other):
    for names in ([one, other], [other, one], [one, other, one]):
        made = distinct(names)
        assert len(set(made)) == len(names) and all(name == identifier(name) for name in made)
        files = distinct(names, file_name, folded)
        assert len({folded(name) for name in files}) == len(names)
        assert all(0 < len(name.encode()) < 255 for name in files)
        assert not any(set(name) & set('<>:"/\\|?*\t') for name in files)


def test_a_valid_name_stays_whichever_others_there_are():
    assert distinct(["a.1", "a_1", "a-1", "b"]) == ["a_1_2", "a_1", "a_1_3", "b"]
    assert distinct(["a", "A"], file_name, folded) == ["a", "A_2"]


def test_a_name_that_is_taken_gets_a_number():
    assert unique("a", []) == "a" and unique("a", ["a", "a_2"]) == "a_3"
    assert unique("A", ["a"]) == "A" and unique("A", ["a"], folded) == "A_2"
