# SPDX-License-Identifier: MIT
"""The rounding that a path permits, from geometry alone.

Points within a twentieth of the junction deviation `d` of the line past them, at the same feed on both
sides, are no corners. Any other corner turns the direction by `c`, the difference of two unit vectors.
The arc that touches both lines and passes the corner at `d` has the radius `R = d s / (1 - s)`, `s` the
sine of half the angle between the lines; while it turns it advances by `l = R |c|`. So the speed `v` at
the corner is at most `v^2 = a l / |c|` of every axis, `c` and `a` those of the axis: at constant speed
the velocity changes evenly over `l`, and the path is off the corner by `|c| l / 8`, no more than `d`.

Acceleration along the path comes on top. With it, the change of direction may take longer, as long as the
path stays within `d` on either side of the lines: the direction turns over `p` before the corner and `q`
behind it, so the curvature there is `c / (p + q)`. `p` and `q` are at most

* half of the line: the corner of a finely divided curve is a piece of that curve, from the middle of one
  line to the middle of the next;
* `l`; and 17/16 of the other side, or `3 l / 8` and half of that: a rounding on one side alone leaves
  the line for good. Of one corner, with `l / 2`, the path would be off no farther; but of corners near each
  other, to one side, the pins would show more than the limit of the acceleration.

The path is off its lines by what a rounding of one corner may have, with `l / 2` in place of `3 l / 8`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from passo.path import PathSettings

Line = tuple[Sequence[float], float | None]  # target in mm, feed in mm/s or None

STRAIGHT = 1e-7  # change of direction that is none
SHARE = 1 / 20  # of the junction deviation, by which a point may be off and still be no corner
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
        before, behind = _rounding(self.length, self.arc, lambda other: (self.arc + other) / 2)
        least, most = np.minimum(before, behind), np.maximum(before, behind)
        found = np.minimum(size * np.maximum((least + most) / 16, (most - least) / 4), self.deviation)
        found = np.where(self.alone, self.deviation, found)
        return np.abs(self.turn @ directions.T) * (found / np.maximum(size, STRAIGHT))[:, None]


def points_of(
    lines: Sequence[Line], axes: int, begin: Sequence[float] | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The points of the lines that have a length, and the feeds of these."""
    points = np.array([list(begin or [0.0] * axes), *(list(target) for target, _ in lines)], float)
    feed = np.array([np.inf if feed is None else feed for _, feed in lines], float)
    kept = [0]
    far = (np.abs(np.diff(points, axis=0)) > SHORTEST).any(axis=1)  # from the point before
    for i in range(1, len(points)):
        if far[i - 1] if kept[-1] == i - 1 else np.abs(points[i] - points[kept[-1]]).max() > SHORTEST:
            kept.append(i)
    return points[kept], feed[np.array(kept[1:], int) - 1]


def corners_of(points: np.ndarray, feed: np.ndarray, off: float) -> np.ndarray:
    """The points that are corners, with both ends: those between are near the line past them.

    Of lines of several feeds only a straight one is one, as with LinuxCNC's `G64 P Q`.
    """
    kept, first, last = [0], 0, len(points) - 1
    begins = _begin_lines(points, np.where(feed[1:] == feed[:-1], off, SHORTEST))
    while first < last:
        end = first + 1
        while end < last and begins[first]:
            if not _is_line(points[first : end + 2], _most_off(feed[first : end + 1], off)):
                break
            end += 1
        kept.append(end)
        first = end
    return np.array(kept)


def _most_off(feed: np.ndarray, off: float) -> float:
    return off if (feed == feed[0]).all() else SHORTEST


def _begin_lines(points: np.ndarray, off: np.ndarray) -> np.ndarray:
    """Of each point but the last two: whether it and the two behind it may be of one line."""
    whole, first = points[2:] - points[:-2], points[1:-1] - points[:-2]
    square = np.sum(whole**2, axis=1)
    side = first - (np.sum(first * whole, axis=1) / np.maximum(square, STRAIGHT**2))[:, None] * whole
    return np.linalg.norm(side, axis=1) <= off * 2


def _is_line(points: np.ndarray, off: float) -> bool:
    whole = points[-1] - points[0]
    length = np.linalg.norm(whole)
    if length <= off:
        return False
    along = (points - points[0]) @ whole / length
    side = np.linalg.norm(points - points[0] - along[:, None] * whole / length, axis=1)
    return bool((side <= off).all() and (np.diff(along) > 0).all())


def _rounding(
    length: np.ndarray, arc: np.ndarray, most: Callable[[np.ndarray], np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """How far each corner is rounded before and behind it; `most` of one side, by the other one."""
    before, behind = np.minimum(length[:-1] / 2, arc), np.minimum(length[1:] / 2, arc)
    return np.minimum(before, most(behind)), np.minimum(behind, most(before))


def arc_length(turn: np.ndarray, junction_deviation: float) -> np.ndarray:
    """What the arcs within the deviation advance by while they turn."""
    cosine = np.minimum(np.linalg.norm(turn, axis=1) / 2, 1)
    sine = np.sqrt(1 - cosine**2)
    return 2 * junction_deviation * sine * (1 + sine) / np.maximum(cosine, STRAIGHT)


def rounded(lines: Sequence[Line], settings: PathSettings, begin: Sequence[float] | None = None) -> Rounded:
    """The path and its roundings."""
    permitted = float(settings.junction_deviation)
    points, feed = points_of(lines, len(settings.axes), begin)
    kept = corners_of(points, feed, permitted * SHARE)
    delta = np.diff(points[kept], axis=0)
    length = np.linalg.norm(delta, axis=1)
    unit = delta / length[:, None]
    turn = np.diff(unit, axis=0)
    arc = arc_length(turn, permitted)
    before, behind = _rounding(
        length, arc, lambda other: np.maximum(other * 17 / 16, arc * 3 / 8 + other / 2)
    )
    return Rounded(
        *(points, feed, kept, unit, length, np.cumsum(length), turn, arc, before, behind, permitted)
    )
