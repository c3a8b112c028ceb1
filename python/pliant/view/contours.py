"""Triangles in NumPy: filled contours of a field, and surface stretch."""
import numpy as np


class Mesh:
    """Triangles with the vertices that they use, numbered from 0."""

    def __init__(self, triangles, vertices):
        used = np.zeros(vertices, bool)
        used[triangles] = True
        self.numbers = np.flatnonzero(used)  # of the vertices, in the arrays that they come from
        renumbered = np.cumsum(used) - 1
        self.triangles = renumbered[triangles].astype(np.uint32)


def filled(points, triangles, values, levels):
    """Splits triangles along the contours of a field that is linear in each of them: band k has levels[k - 1] <= values <= levels[k].

    points: [n, 3], values: [n], levels: ascending. The points with those on the contours, and the triangles of the len(levels) + 1 bands.
    """
    band = np.searchsorted(levels, values)[triangles]  # of the corners
    lowest, highest = band.min(axis=1), band.max(axis=1)
    crossed = lowest != highest
    whole = [triangles[~crossed & (lowest == k)] for k in range(len(levels) + 1)]
    triangles, lowest, above, bands = triangles[crossed], lowest[crossed], triangles[:0], []
    for k, level in enumerate(levels):
        points, values, below, above = split(points, np.concatenate([above, triangles[lowest == k]]), values, level)
        bands.append(np.concatenate([whole[k], below]))
    return points, [*bands, np.concatenate([whole[-1], above])]


def split(points, triangles, values, level):
    """Points and values with those at the level, the triangles below it and those above."""
    higher = values[triangles] > level
    count = higher.sum(axis=1)
    below, above = triangles[count == 0], triangles[count == 3]
    crossed = (count == 1) | (count == 2)
    if not crossed.any():
        return points, values, below, above
    mixed, odd_is_above = triangles[crossed], count[crossed] == 1
    lone = np.where(odd_is_above, higher[crossed].argmax(axis=1), (~higher[crossed]).argmax(axis=1))
    row = np.arange(len(mixed))
    a, b, c = (mixed[row, (lone + k) % 3].astype(np.int64) for k in range(3))  # a on one side, b and c on the other
    # One point for each edge, also where two triangles share it: the surface stays closed and its shading smooth.
    ends = np.concatenate([np.stack([np.minimum(a, b), np.maximum(a, b)]), np.stack([np.minimum(a, c), np.maximum(a, c)])], axis=1)
    keys, number = np.unique(ends[0] * len(points) + ends[1], return_inverse=True)
    first, second = np.divmod(keys, len(points))
    share = ((level - values[first]) / (values[second] - values[first]))[:, None]
    added = len(points) + number.reshape(2, -1)
    points = np.concatenate([points, points[first] + share.astype(points.dtype) * (points[second] - points[first])])
    values = np.concatenate([values, np.full(len(keys), level, values.dtype)])
    corner = np.stack([a, added[0], added[1]], axis=1)
    rest = np.concatenate([np.stack([added[0], b, c], axis=1), np.stack([added[0], c, added[1]], axis=1)])
    twice = np.concatenate([odd_is_above, odd_is_above])
    below = np.concatenate([below, corner[~odd_is_above], rest[twice]])
    above = np.concatenate([above, corner[odd_is_above], rest[~twice]])
    return points, values, below, above


def stretch(rest, now, triangles):
    """At each vertex the largest principal stretch of the surface: the mean over its triangles, weighted by their areas at rest."""

    def metric(x):
        e, f = x[triangles[:, 1]] - x[triangles[:, 0]], x[triangles[:, 2]] - x[triangles[:, 0]]
        return (e * e).sum(axis=1), (e * f).sum(axis=1), (f * f).sum(axis=1)

    (a, b, c), (d, e, f) = metric(rest.astype(float)), metric(now.astype(float))
    det = a * c - b * b  # four times the square of the area
    flat = det <= 1e-12 * a * c
    safe = np.where(flat, 1, det)
    # Eigenvalues of the 2 x 2 matrix rest^-1 now: the squares of the stretches.
    half = (c * d - 2 * b * e + a * f) / (2 * safe)
    product = (d * f - e * e) / safe
    most = np.where(flat, 1, np.sqrt(half + np.sqrt(np.maximum(half * half - product, 0))))
    weight = np.sqrt(np.where(flat, 0, safe))
    total = np.bincount(triangles.ravel(), np.repeat(weight, 3), len(rest))
    mean = np.bincount(triangles.ravel(), np.repeat(weight * most, 3), len(rest)) / np.where(total > 0, total, 1)
    return np.where(total > 0, mean, 1)
