"""The settings on the review page: how much room their first sight takes."""

from __future__ import annotations

from typing import Any

from review import Review

# Heights of the panel for every operator, with `said` of its settings in the file; the page alone, without the server.
HEIGHTS = """(said) => {
    const { model } = ringlet, recipe = model.documents.recipe;
    const places = [...recipe.stages.filter(({ place }) => place[0] !== 'shape').map(({ place }) => place[0])];
    recipe.values = { ...recipe.values, shape: model.welcome.operators.map(op => ({ op })) };
    const heights = {};
    const measure = (name, place) => {
        recipe.said = {};
        model.choose('recipe', ['hairs']);
        const fields = () => [...document.querySelectorAll('.settings > .fields > .field')];
        model.choose('recipe', place);
        const table = Object.fromEntries(
            fields().slice(-said || Infinity).map(one => [one.dataset.setting.split('.').at(-1), {}]));
        let at = recipe.said;
        place.forEach((part, k) => at = at[part] = k + 1 < place.length ? {} : table);
        model.tell('document');
        heights[name] = document.querySelector('.settings').scrollHeight;
    };
    for (const name of places) measure(name, [name]);
    model.welcome.operators.forEach((op, k) => measure(op, ['shape', k]));
    return heights;
}"""


def test_the_first_sight_of_every_operator_is_short(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    for said in (0, 9):  # the examples set up to 9 settings of an operator
        heights = review.page.evaluate(HEIGHTS, said)
        assert len(heights) > 25
        assert {name: height for name, height in heights.items() if height > 640} == {}
    assert not review.errors
