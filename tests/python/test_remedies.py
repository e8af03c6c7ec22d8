"""The advice of messages is followed, and they are gone."""

from __future__ import annotations

import re
import shutil

import messages
import pytest
import remedies
import remedies_files
import remedies_live
import remedies_review
import remedies_takes

import ringlet

ROWS = remedies.ROWS + remedies_files.ROWS + remedies_live.ROWS + remedies_review.ROWS + remedies_takes.ROWS

UNTRIED = 2  # messages whose advice no row follows


@pytest.fixture
def inputs(pipeline, tmp_path, monkeypatch) -> None:
    """A copy of the small example with its groom and its cache, as the current folder."""
    shutil.copytree(pipeline, tmp_path / "copy")
    monkeypatch.chdir(tmp_path / "copy")


@pytest.mark.usefixtures("inputs")
@pytest.mark.parametrize("row", ROWS, ids=[row.part for row in ROWS])
def test_advice_that_is_followed_helps(row):
    said = refusal(row.wrong)
    assert re.search(messages.pattern(row.part), said), said
    row.right()


def refusal(act) -> str:
    """The message of what is refused; the error, which keeps files open, is gone."""
    try:
        act()
    except ringlet.UserError as error:
        return str(error)
    pytest.fail("is not refused")


def test_few_messages_have_advice_that_is_not_tried():
    tried = {row.part: messages.texts_with(row.part) for row in ROWS}
    assert {part: found for part, found in tried.items() if len(found) != 1} == {}
    assert len(messages.texts().keys() - {text for [text] in tried.values()}) <= UNTRIED


def test_every_message_has_advice():
    assert [text for text in messages.texts() if not messages.ADVICE.search(text)] == []
