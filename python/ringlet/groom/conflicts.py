"""Messages about what a groom has that its recipe can hardly mean."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.groom.operators.operator import grid, unit
from ringlet.groom.operators.tied import TO_TIE
from ringlet.groom.recipe import Recipe
from ringlet.groom.scalp import Scalp

MUCH_LONGER = 2.0  # factor on the length of a lock that a displacement is not expected to exceed
STEEPLY_INWARD = -0.5  # cosine between a root's normal and the start of its lock
MANY = 0.1  # share of locks; single ones that hang steeply, or over an edge, are laid along the scalp and need no word
START = 0.02  # of a lock [m]: further along, hair that lies on a head is under the tangent plane of its root


def without_place(recipe: Recipe, guides: Curves, locks: Curves) -> list[str]:
    """One message for each edit of a guide or a lock that does not exist."""
    sculpted = _missing({sculpt.guide for sculpt in recipe.sculpt}, guides)
    edited = _missing({edit.lock for edit in recipe.edit}, locks)
    return [
        *(f"guide {guide} was sculpted but is no longer there; its shape is kept until it is" for guide in sculpted),
        *(
            f"lock {lock} was edited but is no longer there; its edit is kept: bring the lock back, or release the edit"
            for lock in edited
        ),
    ]


def _missing(ids: set[int], curves: Curves) -> list[int]:
    """Ids, ascending, of which there is no curve."""
    return sorted(ids - set(curves.ids.tolist())) if ids else []


def lengthened(name: str, before: Curves, after: Curves) -> Iterator[str]:
    """A message for an operator that displaces locks so far that they become much longer."""
    was, now = before.lengths(), after.lengths()
    if (much := now > MUCH_LONGER * was).any():
        lock = int(np.argmax(now / was))
        yield (
            f"{name} makes {much.sum()} of {len(was)} locks more than {MUCH_LONGER:g} times as long, lock "
            f"{after.ids[lock]} {now[lock]:.3g} instead of {was[lock]:.3g} m; lower its magnitude, raise its "
            "wavelength, or give it keep = 'length'"
        )


def inward(locks: Curves, scalp: Scalp) -> Iterator[str]:
    """A message where many locks start into the scalp: its faces may be turned inside out."""
    steep = np.einsum("ki,ki->k", unit(_starts(locks)), scalp.frames(locks)[:, :, 2]) < STEEPLY_INWARD
    steep &= locks.curve.get(TO_TIE, np.zeros(len(locks))) == 0.0  # hair that is led to a tie follows the curved skin
    if steep.mean() > MANY:
        yield (
            f"{steep.sum()} of {len(locks)} locks, such as {locks.ids[steep.argmax()]}, start into the scalp and are "
            f"laid along it; if they are outside of it, reverse the orientation of {scalp.mesh.name}"
        )


def _starts(locks: Curves) -> NDArray[np.float64]:
    """From the root of each lock to the mean of its points over ``START``, at least one, shape (count, 3) [m]."""
    points, most = grid(locks), 8
    while (run := _runs(points[:, :most]))[:, -1].min() < START and most < points.shape[1]:
        most *= 2
    near = (run < np.maximum(START, run[:, :1] * (1 + 1e-6))).astype(np.float64)
    return np.einsum("cn,cnk->ck", near, points[:, 1:most]) / near.sum(axis=1, keepdims=True) - locks.roots


def _runs(points: NDArray[np.floating]) -> NDArray[np.float64]:
    """Arc length from the root to every further point [m], shape (count, points - 1)."""
    x, y, z = np.moveaxis(points[:, 1:] - points[:, :-1], 2, 0)  # columns are faster than rows of three numbers
    return np.cumsum(np.sqrt(x * x + y * y + z * z), axis=1)


def not_strands(locks: Curves) -> Iterator[str]:
    """A message for locks that cannot be simulated."""
    try:
        locks.check_strands("locks")
    except UserError as error:
        yield f"{error}; as it is, the groom cannot be simulated"
