"""Finds the clumps of finished hairs: hairs that run side by side from root to tip.

The distance of two hairs is the root mean square of the distances between points at the same place along them, towards
the tip more than at the root. Clumps are the components that remain of the minimum spanning tree of mutual
reachability distances (Campello et al. 2013) when its long edges are cut. Where these edges are of one kind, as between
wide curls, hairs are of one clump that are among each other's neighbours before the largest gap of their distances.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree
from scipy.spatial import KDTree

from ringlet.data.errors import UserError

PLACES = 12  # points of a hair that are compared
NEIGHBOURS = 12  # of a hair, among which edges of the tree are sought
CORE = 3  # the neighbour whose distance is the core distance of a hair
APART = 3.0  # least ratio of the distances between and within clumps
GAP = 1.25  # least ratio of the distances of a neighbour and of the next one at the end of a clump
LARGEST = 0.25  # of the hairs, which a clump may have: without gaps nearly all hairs are one
NAMES = ("guide_curve_index", "clumpid", "lock", "guide_id")  # attributes that number clumps
MOST_LOCKS = 5000  # hairs without clumps that become a lock each; more are divided into as many

Array = NDArray[np.float64]


@dataclass
class Clumps:
    """Which clump each hair belongs to, and the hair in its middle.

    of:     index of the clump of each hair, shape (hairs,)
    middle: hair in the middle of each clump, shape (clumps,)
    source: how they were found: the name of an attribute, ``shape``, ``count`` or ``each``
    """

    of: NDArray[np.int64]
    middle: NDArray[np.int64]
    source: str

    def __len__(self) -> int:
        return len(self.middle)


def find_clumps(points: Array, lengths: Array, curve: dict[str, NDArray], count: int | None = None) -> Clumps:
    """Finds clumps by an attribute that numbers them, or by the shapes of hairs.

    points:  evenly spaced by arc length [m], shape (hairs, k, 3)
    lengths: of the hairs [m], shape (hairs,)
    curve:   attributes of the hairs
    count:   number of clumps that is asked for; by default as many as there are

    Raises UserError for more clumps than hairs.
    """
    if count is not None and count > len(points):
        raise UserError(f"locks is {count}, but there are {len(points)} hairs; ask for at most as many")
    features = _features(points)
    named = next((name for name in NAMES if _numbers_clumps(curve.get(name), len(points))), None)
    if count is not None:
        of, source = _divided(features, count), "count"
    elif named is not None:
        of, source = np.asarray(np.unique(curve[named], return_inverse=True)[1]), named
    elif len(points) > NEIGHBOURS and (found := _by_shape(features)) is not None:
        of, source = found, "shape"
    elif len(points) <= MOST_LOCKS:
        of, source = np.arange(len(points)), "each"
    else:
        of, source = _divided(features, MOST_LOCKS), "count"
    of = np.asarray(np.unique(of, return_inverse=True)[1], np.int64)
    return Clumps(of, _middles(features, lengths, of), source)


def each_alone(hairs: int) -> Clumps:
    """Each hair as a clump of its own."""
    return Clumps(np.arange(hairs), np.arange(hairs), "each")


def _numbers_clumps(values: NDArray | None, hairs: int) -> bool:
    """Whether an attribute holds whole numbers, one for each of several hairs."""
    if values is None or values.ndim != 1 or len(values) != hairs or values.dtype.kind not in "iu":
        return False
    return 1 < len(np.unique(values)) < hairs


def _features(points: Array) -> Array:
    """Coordinates whose Euclidean distance is that of hairs [m], shape (hairs, 3 · PLACES)."""
    at = np.linspace(0.0, points.shape[1] - 1.0, PLACES)
    i = np.minimum(at.astype(int), points.shape[1] - 2)
    t = (at - i)[None, :, None]
    sampled = (1.0 - t) * points[:, i] + t * points[:, i + 1]
    weight = np.linspace(0.5, 1.0, PLACES)
    weight = np.sqrt(weight / weight.sum())
    return (sampled * weight[None, :, None]).reshape(len(points), -1)


def _by_shape(features: Array) -> NDArray[np.int64] | None:
    """Components of the tree without its long edges, or by gaps; None where there are none."""
    hairs = len(features)
    found, rows = KDTree(features).query(features, k=min(NEIGHBOURS + 1, hairs))
    distance, index = np.asarray(found, np.float64), np.asarray(rows, np.int64)
    core = distance[:, min(CORE, distance.shape[1] - 1)]
    start = np.repeat(np.arange(hairs), distance.shape[1] - 1)
    end = index[:, 1:].ravel()
    length = np.maximum(np.maximum(distance[:, 1:].ravel(), core[start]), core[end]) + 1e-12
    tree = minimum_spanning_tree(coo_array((length, (start, end)), shape=(hairs, hairs)).tocsr()).tocoo()
    cut = _cut(np.log(tree.data))
    if cut is None:
        return _by_gaps(features, distance[:, 1:], index[:, 1:])
    kept = tree.data <= np.exp(cut)
    graph = coo_array((tree.data[kept], (tree.row[kept], tree.col[kept])), shape=(hairs, hairs))
    of = connected_components(graph, directed=False)[1].astype(np.int64)
    return _without_strays(features, of)


def _by_gaps(features: Array, distance: Array, index: NDArray[np.integer]) -> NDArray[np.int64] | None:
    """Components of hairs that are neighbours of each other before a gap; None where nearly all hairs are one.

    distance, index: of the neighbours of each hair, the nearest first, shape (hairs, k)
    """
    hairs, most = distance.shape
    step = distance[:, 1:] / np.maximum(distance[:, :-1], 1e-12)
    step[:, : CORE - 1] = 0.0  # a hair and its nearest neighbours are of one clump
    end = step.argmax(axis=1)
    size = np.where(step.max(axis=1) > GAP, end + 1, most)
    before = np.arange(most) < size[:, None]
    pairs = np.repeat(np.arange(hairs), size), index[before]
    near = coo_array((np.ones(len(pairs[0])), pairs), shape=(hairs, hairs)).tocsr()
    of = connected_components(near.minimum(near.T), directed=False)[1].astype(np.int64)
    if np.bincount(of).max() > LARGEST * hairs:
        return None
    return _without_strays(features, of)


def _cut(values: Array) -> float | None:
    """Threshold between two kinds of values (Otsu 1979); None where they do not differ by ``APART``."""
    ordered = np.sort(values)
    n = np.arange(1, len(ordered))
    low = np.cumsum(ordered)[:-1] / n
    high = (ordered.sum() - np.cumsum(ordered)[:-1]) / (len(ordered) - n)
    between = n * (len(ordered) - n) * (high - low) ** 2
    best = int(between.argmax())
    if high[best] - low[best] < np.log(APART):
        return None
    return float(0.5 * (ordered[best] + ordered[best + 1]))


def _without_strays(features: Array, of: NDArray[np.int64]) -> NDArray[np.int64]:
    """Clumps of which those of a hair alone are joined to the clump of the nearest hair that has one."""
    alone = np.bincount(of)[of] == 1
    if alone.all() or not alone.any():
        return of
    nearest = KDTree(features[~alone]).query(features[alone])[1]
    of = of.copy()
    of[alone] = of[~alone][nearest]
    return of


def _divided(features: Array, count: int) -> NDArray[np.int64]:
    """A number of clumps of hairs that are near one another (k-means)."""
    if count >= len(features):
        return np.arange(len(features))
    chosen = np.linspace(0, len(features) - 1, count).astype(int)
    return kmeans2(features, features[chosen], iter=12, minit="matrix", missing="warn")[1].astype(np.int64)


def _middles(features: Array, lengths: Array, of: NDArray[np.int64]) -> NDArray[np.int64]:
    """The hair of each clump that is nearest to the mean, among the longer ones."""
    count = int(of.max()) + 1
    sizes = np.bincount(of, minlength=count)
    means = np.stack([np.bincount(of, column, count) / sizes for column in features.T], axis=1)
    off = np.linalg.norm(features - means[of], axis=1)
    longest = np.zeros(count)
    np.maximum.at(longest, of, lengths)
    short = lengths < 0.97 * longest[of]
    order = np.lexsort((off, short, of))
    return order[np.searchsorted(of[order], np.arange(count))]
