"""How the pictures are shown: choices are checked, and told to every page."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from app.session.display import Display


def test_a_choice_is_changed_in_a_copy():
    first = Display()
    assert first.with_(angle="deg", scale="log").angle == "deg"
    assert first == Display()


@pytest.mark.parametrize(
    "wrong",
    [{"transfer": "nothing"}, {"exaggeration": 0.0}, {"angle": "mil"}, {"theme": "blue"}, {"no_such": 1}],
)
def test_what_is_not_offered_is_refused(wrong: dict[str, object]):
    with pytest.raises(ValidationError):
        Display().with_(**wrong)
