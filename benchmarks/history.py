"""What the time machine costs: recording, as a share of a step, and scrubbing, in ms a seek.

``uv run python benchmarks/history.py``: a run of 4,000 discs with and without a history, in turns; then a
minute of 465 boxes, gone through forwards and backwards.
"""

from __future__ import annotations

import time

import numpy as np

from physicslab.history import History
from physicslab.lab.bench.catalogue import SCENES

TURNS, STEPS = 80, 30


def recording() -> None:
    """Print how many times as long steps take with a history, in turns of 30 steps, each first in turn.

    Key frames come every few turns: they are in the mean over all, and not in the median of a turn.
    """
    plain, history = SCENES["pile_4000"].build(), History(SCENES["pile_4000"].build())
    for _ in range(4 * STEPS):
        plain.step()
        history.step()
    ratios, spent = [], np.zeros(2)
    for turn in range(TURNS):
        times = np.zeros(2)
        for n in (0, 1) if turn % 2 else (1, 0):
            step = (plain.step, history.step)[n]
            began = time.process_time()
            for _ in range(STEPS):
                step()
            times[n] = time.process_time() - began
        spent += times
        ratios.append(times[1] / times[0])
    low, middle, high = np.quantile(ratios, (0.1, 0.5, 0.9))
    print(f"pile_4000: a step with a history / without: mean {spent[1] / spent[0]:.3f}, median {middle:.3f}")
    print(
        f"  of {TURNS} turns, 8 of 10 from {low:.3f} to {high:.3f}; key frames {history.size / 2**20:.0f} MiB"
    )


def scrubbing() -> None:
    """Print how long a seek takes from place to place nearby, in a minute of 465 boxes."""
    history = History(SCENES["pyramid_30"].build())
    history.step(steps=3600)
    spent = []
    for step in np.random.default_rng(1).integers(0, 3600, 40).tolist():  # where none was sought before
        began = time.process_time()
        history.seek(step)
        spent.append(1e3 * (time.process_time() - began))
    p50, p95 = np.quantile(spent, (0.5, 0.95))
    print(f"pyramid_30: seeks to anywhere: median {p50:.2f}, p95 {p95:.2f}, max {max(spent):.1f} ms")
    for start, stride in ((3000, -1), (2000, 1), (1500, -4), (600, 3)):
        history.seek(start)
        spent = []
        for k in range(1, 101):
            began = time.process_time()
            history.seek(start + k * stride)
            spent.append(1e3 * (time.process_time() - began))
        p50, p95 = np.quantile(spent, (0.5, 0.95))
        times = f"median {p50:.2f}, p95 {p95:.2f}, max {max(spent):.1f} ms"
        print(f"pyramid_30: seeks by {stride:+d} from {start}: {times}")
    print(f"  key frames {history.size / 2**20:.0f} MiB")


if __name__ == "__main__":
    recording()
    scrubbing()
