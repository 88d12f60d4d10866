# SPDX-License-Identifier: MIT
"""The rounding that a path permits, from geometry alone.

Points near the line past them are no corners: within an eighth of the junction deviation `d`, and within
half of it where the feed changes, both of 0.01 mm at most; and within the tolerance of merging. A machine
that goes along that line is off the points by as much. Any other corner turns the direction by `c`, the
difference of two unit vectors. The arc that touches both lines and passes the corner at `d` has the
radius `R = d s / (1 - s)`, `s` the sine of half the angle between the lines; while it turns it advances
by `l = R |c|`. So the speed `v` at the corner is at most `v^2 = a l / |c|` of every axis, `c` and `a`
those of the axis: at constant speed the velocity changes evenly over `l`, and the path is off the corner
by `|c| l / 8`, no more than `d`.

Acceleration along the path comes on top. With it, the change of direction may take longer, as long as the
path stays within `d` on either side of the lines: the direction turns over `p` before the corner and `q`
behind it, so the curvature there is `c / (p + q)`. `p` and `q` are at most

* half of the line: the corner of a finely divided curve is a piece of that curve, from the middle of one
  line to the middle of the next;
* `l`; and of one side `l / 2` and half of the other one, since a rounding on one side alone leaves the
  line for good.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from passo.path import PathSettings

Line = tuple[Sequence[float], float | None]  # target in mm, feed in mm/s or None

STRAIGHT = 1e-7  # change of direction that is none
SHARE = 1 / 20  # of the junction deviation: the tolerance of merging
SAME_SHARE = 1 / 8  # by which a point may be off and still be no corner
FEED_SHARE = 1 / 2  # the same where the feed changes
MOST = 0.01  # mm: of which they are shares at most
NEARLY = 1 - 1e-9
SHORTEST = 1e-7  # mm: a line that is shorter is none


@dataclass(frozen=True)
class Rounded:
    """A path of lines, and the rounding of the corners between them."""

    points: np.ndarray  # of all lines that have a length, from the start on
    feed: np.ndarray  # of each of these lines; infinite for a rapid
    kept: np.ndarray  # numbers of the points that are ends of what follows
    unit: np.ndarray  # line x axis
    length: np.ndarray  # of each line
    end: np.ndarray  # of each line, along the path
    turn: np.ndarray  # corner x axis: the change of direction
    arc: np.ndarray  # of each corner: `l`
    before: np.ndarray  # `p`
    behind: np.ndarray  # `q`
    deviation: float

    @property
    def corner(self) -> np.ndarray:
        """The place of each corner along the path."""
        return self.end[:-1]

    @property
    def over(self) -> np.ndarray:
        """Of each corner: the length of its rounding; 0: the path has to rest there."""
        return self.before + self.behind

    @property
    def alone(self) -> np.ndarray:
        """Of each corner: no other one is near enough to matter."""
        return (self.before >= self.arc * NEARLY) & (self.behind >= self.arc * NEARLY)

    def off_along(self, directions: np.ndarray) -> np.ndarray:
        """corner x direction: by how much the path may be off the lines along it, on either side."""
        size = np.linalg.norm(self.turn, axis=1)
        least, most = np.minimum(self.before, self.behind), np.maximum(self.before, self.behind)
        found = np.minimum(size * np.maximum((least + most) / 16, (most - least) / 4), self.deviation)
        found = np.where(self.alone, self.deviation, found)
        return np.abs(self.turn @ directions.T) * (found / np.maximum(size, STRAIGHT))[:, None]

    def points_off(self, directions: np.ndarray) -> np.ndarray:
        """point x direction: by how much the points of the lines before and behind it are off these."""
        found = np.zeros((len(self.points), len(directions)))
        for first, last in zip(self.kept[:-1], self.kept[1:], strict=True):
            if last > first + 1:
                off = np.abs(_off_line(self.points[first : last + 1]) @ directions.T).max(axis=0)
                found[first : last + 1] = np.maximum(found[first : last + 1], off)
        return found


def points_of(
    lines: Sequence[Line], axes: int, begin: Sequence[float] | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The points of the lines that have a length, and the feeds of these."""
    points = np.array([list(begin or [0.0] * axes), *(list(target) for target, _ in lines)], float)
    feed = np.array([np.inf if feed is None else feed for _, feed in lines], float)
    kept = [0]
    for i in range(1, len(points)):
        if np.abs(points[i] - points[kept[-1]]).max() > SHORTEST:
            kept.append(i)
    return points[kept], feed[np.array(kept[1:], int) - 1]


def corners_of(points: np.ndarray, feed: np.ndarray, permitted: float) -> np.ndarray:
    """The points that are corners, with both ends: those between are near the line past them."""
    most = min(permitted, MOST)
    off = np.full(len(points), max(most * SAME_SHARE, permitted * SHARE))
    off[1:-1][feed[1:] != feed[:-1]] = most * FEED_SHARE
    off = np.maximum(off, SHORTEST)
    kept, first, last = [0], 0, len(points) - 1
    while first < last:
        end = first + 1
        while end < last and _is_line(points[first : end + 2], off[first + 1 : end + 1]):
            end += 1
        kept.append(end)
        first = end
    return np.array(kept)


def _off_line(points: np.ndarray) -> np.ndarray:
    """By how much points are off the line from the first to the last one, and how far along it they are."""
    whole = points[-1] - points[0]
    along = (points - points[0]) @ whole / np.maximum(whole @ whole, SHORTEST**2)
    return points - points[0] - along[:, None] * whole


def _is_line(points: np.ndarray, off: np.ndarray) -> bool:
    sizes = np.linalg.norm(np.diff(points, axis=0), axis=1)
    forward = (np.diff(points, axis=0)[1:] * np.diff(points, axis=0)[:-1]).sum(axis=1) >= 0
    whole = np.linalg.norm(points[-1] - points[0])
    side = np.linalg.norm(_off_line(points), axis=1)[1:-1]
    return bool((side <= off).all() and forward.all() and sizes.sum() - whole <= off.max())


def arc_length(turn: np.ndarray, junction_deviation: float) -> np.ndarray:
    """What the arcs within the deviation advance by while they turn."""
    cosine = np.minimum(np.linalg.norm(turn, axis=1) / 2, 1)
    sine = np.sqrt(1 - cosine**2)
    return 2 * junction_deviation * sine * (1 + sine) / np.maximum(cosine, STRAIGHT)


def rounded(lines: Sequence[Line], settings: PathSettings, begin: Sequence[float] | None = None) -> Rounded:
    """The path and its roundings."""
    permitted = float(settings.junction_deviation)
    points, feed = points_of(lines, len(settings.axes), begin)
    kept = corners_of(points, feed, permitted)
    delta = np.diff(points[kept], axis=0)
    length = np.linalg.norm(delta, axis=1)
    unit = delta / length[:, None]
    turn = np.diff(unit, axis=0)
    arc = arc_length(turn, permitted)
    before, behind = np.minimum(length[:-1] / 2, arc), np.minimum(length[1:] / 2, arc)
    before, behind = np.minimum(before, (arc + behind) / 2), np.minimum(behind, (arc + before) / 2)
    return Rounded(
        *(points, feed, kept, unit, length, np.cumsum(length), turn, arc, before, behind, permitted)
    )
