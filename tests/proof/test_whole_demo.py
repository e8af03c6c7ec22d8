"""All ringlets of the demo spring as the shot asks, in contact; `make test` has 30 of them in the hop."""

import numpy as np
from bouncing import clip, shot_and_groom


def test_the_demo_bounces_as_it_is_asked(tmp_path):
    """Opens and closes seen at once, at the frequency asked for within 15 % in the median; contact makes no whips."""
    shot, groom = shot_and_groom(tmp_path, 170)
    alone = shot.model_copy(update={"contact": shot.contact.model_copy(update={"on": False})})
    bouncing, free = clip(tmp_path, shot, groom), clip(tmp_path, alone, groom)
    words = bouncing.words
    opens, closes, bounce = words["opens"].found, words["closes"].found, words["bounce"]
    assert np.median(opens) > 0.08 and np.percentile(opens, 90) > 0.15
    assert np.median(closes) < -0.08 and np.percentile(closes, 10) < -0.15
    assert abs(np.nanmedian(bounce.found) / np.nanmedian(bounce.asked) - 1) < 0.15
    assert bouncing.whips < 0.5 * free.whips
