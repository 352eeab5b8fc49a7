"""How a picture is cut into parts, and how long they take: numbers only, nothing is rendered here."""
from __future__ import annotations

import heapq
import math
from dataclasses import dataclass

# What a part holds while it is on its way: bytes of sums for each of its pixels (docs/farm.md).
BYTES_PER_PIXEL = 48
# A band of rows that large is cut in two.
MOST_BYTES = 64 << 20
# Of a part's time, what its start may take.
MOST_OVERHEAD = 0.05


@dataclass(frozen=True)
class Part:
    """Pixels [x0, x1) x [y0, y1), and of each the samples [first, last)."""
    x0: int
    x1: int
    y0: int
    y1: int
    first: int
    last: int

    def flags(self) -> list[str]:
        """Of `whit render`."""
        return ["--crop-pixels", str(self.x0), str(self.x1), str(self.y0), str(self.y1),
                "--sample-range", f"{self.first}:{self.last}"]

    def work(self) -> int:
        """Samples of pixels."""
        return (self.x1 - self.x0) * (self.y1 - self.y0) * (self.last - self.first)


@dataclass(frozen=True)
class TimeModel:
    """Seconds of a worker: `fixed` for every part (start, reading, building, writing), `per_sample` for one sample of every
    pixel: the model of `whit cost`."""
    fixed: float
    per_sample: float

    def seconds(self, part: Part, pixels: int) -> float:
        return self.fixed + self.per_sample * part.work() / pixels


def bands(height: int, width: int) -> list[tuple[int, int]]:
    """Rows, in as few bands of whole tiles (16 rows) as keep a part's sums small."""
    rows = max(16, MOST_BYTES // (BYTES_PER_PIXEL * width) // 16 * 16)
    count = math.ceil(height / rows)
    step = math.ceil(height / count / 16) * 16
    return [(y, min(y + step, height)) for y in range(0, height, step)]


def cut(width: int, height: int, samples: int, workers: int, model: TimeModel) -> list[Part]:
    """Parts in the order in which they are to be given out: first large ones, then smaller and smaller, so that the last ends
    with the others (factoring: Flynn Hummel, Schonberg and Flynn, 1992: in each round half of what is left, one part for each
    worker); none so small that its start takes more than a twentieth of its time."""
    rows = bands(height, width)
    left = [samples] * len(rows)  # samples of each band
    per_unit = model.per_sample / len(rows)
    least = max(1, math.ceil(model.fixed / MOST_OVERHEAD / per_unit)) if per_unit > 0 else samples
    parts = []
    while sum(left) > 0:
        chunk = max(least, math.ceil(sum(left) / (2 * workers)))
        for _ in range(workers):
            band = max(range(len(rows)), key=lambda b: left[b])
            if left[band] == 0:
                break
            n = min(chunk, left[band])
            if left[band] - n < least:  # no rest that is hardly worth its start
                n = left[band]
            first = samples - left[band]
            parts.append(Part(0, width, *rows[band], first, first + n))
            left[band] -= n
    return parts


def schedule(seconds: list[float], workers: int) -> float:
    """When the last of some jobs ends, each given to the first worker that is free, in their order."""
    free = [0.0] * workers
    heapq.heapify(free)
    for each in seconds:
        heapq.heappush(free, heapq.heappop(free) + each)
    return max(free)


def simulate(parts: list[Part], workers: int, model: TimeModel, pixels: int) -> float:
    """Seconds until the last part has ended, by the time model."""
    return schedule([model.seconds(p, pixels) for p in parts], workers)


# Shares for each worker where they are worth their starts: so many that the last ends with the others.
SHARES_EACH = 4


@dataclass
class ShareCost:
    """What shares of passes take, by those that there were: seconds of each start, and of one sample of one pixel."""
    fixed: float = 0
    per_sample: float = 0

    def note(self, samples: float, shares: int, seconds: float, rendering: float) -> None:
        """A pass of so many samples: the seconds of all shares, and those of them that were rendering. The last pass says
        most of the next, which is of nearly the same pixels."""
        self.fixed = max(0.0, seconds - rendering) / shares
        self.per_sample = rendering / max(samples, 1.0)


def count_of_shares(samples: float, tiles: int, workers: int, cost: ShareCost) -> int:
    """Into how many shares to cut a pass of so many samples: one for each worker, but none that takes less than its start;
    and several for each, where starts are then no more than a twentieth."""
    if cost.per_sample == 0:
        return max(1, min(workers, tiles))
    starts = samples * cost.per_sample / max(cost.fixed, 1e-9)
    count = max(min(workers, starts), min(SHARES_EACH * workers, MOST_OVERHEAD * starts))
    return max(1, min(tiles, int(count)))
