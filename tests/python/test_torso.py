"""The torso: the adult head over shoulders and a back, on which hair of 60 cm lies."""

from pathlib import Path

import numpy as np
from pxr import Usd, UsdValidation
from ringlet.groom.scalp import Scalp
from ringlet.io import problems, read_mesh

import ringlet

EXAMPLES = Path(__file__).parents[2] / "examples"
HEAD = EXAMPLES / "torso" / "head.usdc"


def test_it_has_the_scalp_of_the_adult_and_a_back_for_hair_of_60_cm():
    skin, shirt = read_mesh(HEAD, "/torso/skin"), read_mesh(HEAD, "/torso/shirt").points
    own = Scalp(skin, "scalp")
    adult = Scalp(read_mesh(EXAMPLES / "adult" / "head.usdc", "/adult/skin"), "scalp")
    places = adult.positions(*adult.sample(500, 1)[1:])
    assert np.linalg.norm(own.nearest(places)[0] - places, axis=1).max() < 1e-3
    assert skin.points[:, 1].max() - shirt[:, 1].min() > 0.6
    assert np.ptp(shirt[:, 0]) > 0.38  # shoulders


def test_the_file_is_valid_and_small():
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(Usd.Stage.Open(str(HEAD)))
    assert [error.GetErrorAsString() for error in errors] == [] == problems(HEAD)
    assert HEAD.stat().st_size < 1e6


def test_braids_of_60_cm_stay_out_of_skin_and_shirt():
    recipe = EXAMPLES / "looks" / "long_braids.recipe.toml"
    assert np.median(ringlet.build_groom(recipe).guides.lengths()) > 0.6
    found = ringlet.check_groom(recipe)["found"]
    assert found["scalp"]["places"] == found["body"]["places"] == 0
