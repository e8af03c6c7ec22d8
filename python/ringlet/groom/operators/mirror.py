"""Mirroring of guides."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.quantities import Quantity, Section
from ringlet.groom.operators.operator import Context, unit
from ringlet.groom.part_line import Direction


class Mirror(Section):
    """Mirrors the guides of one side of a plane to the other side. Guides of that other side are removed; guides on the
    plane stay. The image of a guide has the id ``-1 - id``."""

    across: Direction = Field(default=(1.0, 0.0, 0.0), description="direction from the plane to the side that is kept")
    offset: Annotated[float, Quantity("m", -1.0, 1.0)] = Field(
        default=0.0,
        description="distance of the plane from the middle of the scalp along 'across', by default to the left of a "
        "head that faces +z",
    )
    seam: Annotated[float, Quantity("m", 0.0, 0.1)] = Field(
        default=0.002, description="guides with a root closer to the plane than this are on it"
    )
    tolerance: Annotated[float, Quantity("m", 0.0, 1.0)] = Field(
        default=0.01, description="largest distance of the image of a root from the scalp, onto which it is moved"
    )

    def both_sides(self, guides: Curves, context: Context) -> Curves:
        """Returns the kept guides and their images, bound to the scalp.

        Raises UserError when no guide is on the side that is kept.
        """
        across, scalp = unit(np.array(self.across)), context.scalp
        side = (guides.roots - scalp.middle) @ across - self.offset
        if not (side > -self.seam).any():
            raise UserError(
                "guides.mirror: there is no guide on the side that is kept; turn 'across' round, or bring 'offset' "
                "nearer to 0"
            )
        kept, off_plane = guides.take(side > -self.seam), guides.take(side >= self.seam)
        if len(off_plane) == 0:
            return kept
        height = (off_plane.points - scalp.middle) @ across - self.offset
        image = Curves(off_plane.points - 2.0 * height[:, None] * across, off_plane.offsets, -1 - off_plane.ids)
        image = scalp.bind(image, self.tolerance, "guides.mirror")
        on_scalp = scalp.positions(image.curve["root_triangle"], image.curve["root_barycentric"])
        image.points += np.repeat(on_scalp - image.roots, image.counts, axis=0)
        return Curves(
            np.concatenate([kept.points, image.points]),
            offsets_from_counts(np.concatenate([kept.counts, image.counts])),
            np.concatenate([kept.ids, image.ids]),
            {name: np.concatenate([kept.curve[name], image.curve[name]]) for name in image.curve},
        ).check("guides.mirror")
