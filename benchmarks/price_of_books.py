"""Time steps beside those of a build in which nothing is booked.

``uv run python benchmarks/price_of_books.py [SCENE ...] [--rounds N] [--kernels DIR]`` steps each scene of
the benchmark in two processes, of which one compiles its kernels with every booking left out. They take
turns, in blocks of equal length, after the scene has settled, and end with the same bits. Printed are medians
of the CPU time of a step [us], of calls of ``World.run`` and of single steps, and medians of the ratios block
by block. Kernels without bookings are kept in DIR (default: a temporary one; compiling takes a minute).
"""

from __future__ import annotations

import argparse
import hashlib
import os
import statistics
import subprocess
import sys
import tempfile
import time
from typing import Any

DEFAULT = (
    "circles_10", "pyramid_30", "pyramid_60", "pile_1000", "pile_4000", "gas_2000", "funnel", "heap",
    "chains", "tumbler",
)  # fmt: skip
TURN_S = 0.02
"""CPU time of a turn [s]: long enough for the clock, short enough for noise to be the same for both."""


def leave_out_books() -> None:
    """Replace every function that books by one that does nothing, before any kernel is compiled."""
    import physicslab.stepping.substeps  # noqa: F401 (so that all kernels of contacts are there)
    from physicslab import world
    from physicslab.kernels import float64x8, inlined
    from physicslab.kernels.constraint.pair import PairVelocity
    from physicslab.kernels.solver import impact_log, impulse, soft, work
    from physicslab.kernels.wide import solve
    from physicslab.state.account import Account
    from physicslab.stepping import soft as stepper

    @inlined
    def nothing(*_: Any) -> None:
        pass

    @inlined
    def no_work(*_: Any) -> tuple[float, float]:
        return 0.0, 0.0

    @inlined
    def no_motion(*_: Any) -> Any:
        still = float64x8.everywhere(0.0)
        return PairVelocity(still, still, still, still, still, still)

    @inlined
    def no_more(along: Any, *_: Any) -> Any:
        return along

    @inlined
    def follow(
        contacts: Any, near: Any, now: Any, inverse: Any, acting: Any, h: float
    ) -> tuple[float, float]:
        impulse.follow_drift(contacts, now, h)
        return 0.0, 0.0

    in_place = {
        work.note_velocities: nothing, work.take_means: nothing, work.book_slots: nothing,
        work.book_gravity: nothing, work.book_damping: nothing, work.book_solved: follow,
        work.book_relaxed: no_work, solve.work_of: no_more, solve.mean_velocities: no_motion,
        impact_log.book_impact: nothing,
        soft._balance: nothing, soft._keep_book: nothing,
    }  # fmt: skip
    for name, module in list(sys.modules.items()):
        if name.startswith("physicslab.kernels."):
            for key, value in list(vars(module).items()):
                if getattr(value, "py_func", None) is not None and value in in_place:
                    setattr(module, key, in_place[value])
    for module in (world, stepper):
        for name in ("open_account", "close_account"):
            if hasattr(module, name):
                setattr(module, name, lambda *_: None)
    Account.begin_step = lambda self: None  # type: ignore[method-assign]


def serve(name: str, books: bool) -> None:
    """Step a scene by blocks, as told on stdin; answer with CPU times of a step [s], last with a digest."""
    if not books:
        leave_out_books()
    from physicslab.components import Transform, Velocity
    from physicslab.lab.bench.catalogue import SCENES

    scene = SCENES[name]
    world = scene.build()
    world.run(steps=round(scene.seconds / world.simulation.dt))
    world.step()
    print("ready", flush=True)
    for line in sys.stdin:
        how, count = line.split()
        steps, began = int(count), time.process_time()
        if how == "run":
            world.run(steps=steps)
        else:
            for _ in range(steps):
                world.step()
        print((time.process_time() - began) / max(steps, 1), flush=True)
    transform, velocity = world.table(Transform), world.table(Velocity)
    columns = transform["position"], transform["angle"], velocity["linear"], velocity["angular"]
    print(hashlib.sha256(b"".join(column.tobytes() for column in columns)).hexdigest())


def measure(name: str, rounds: int, kernels: str) -> str:
    """Return a line of the table for a scene."""
    without = {**os.environ, "PHYSICSLAB_KERNELS": kernels}
    servers = [
        subprocess.Popen(
            [sys.executable, __file__, "--serve", name, role], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            text=True, env=environment,
        )
        for role, environment in (("with", None), ("without", without))
    ]  # fmt: skip

    def ask(server: subprocess.Popen[str], how: str, steps: int) -> float:
        assert server.stdin is not None and server.stdout is not None
        print(how, steps, file=server.stdin, flush=True)
        return float(server.stdout.readline())

    for server in servers:
        assert server.stdout is not None
        assert server.stdout.readline() == "ready\n", f"{name} could not be stepped"
    cells = [f"{name:12}"]
    for how in ("run", "step"):
        block = max(1, min(2000, round(TURN_S / max([ask(server, how, 3) for server in servers]))))
        turns = [[ask(server, how, block) for server in servers] for _ in range(rounds)]
        one, other = (1e6 * statistics.median(times) for times in zip(*turns, strict=True))
        ratio = statistics.median(a / b for a, b in turns)
        more = 1e6 * statistics.median(a - b for a, b in turns)
        cells.append(f"{how:5} {one:9.1f} {other:9.1f} us  ratio {ratio:.3f}  {more:+8.2f} us")
    digests = {server.communicate()[0] for server in servers}
    return "  ".join([*cells, "same bits" if len(digests) == 1 else "OTHER BITS"])


def main() -> None:
    """Print a line for each scene: with books, without, and what they cost."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"of the benchmark; {', '.join(DEFAULT)}")
    parser.add_argument("--rounds", type=int, default=40, help="turns of each kind (default: 40)")
    parser.add_argument("--kernels", metavar="DIR", help="where kernels without bookings are kept")
    parser.add_argument("--serve", nargs=2, metavar=("SCENE", "ROLE"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        serve(options.serve[0], options.serve[1] == "with")
        return
    with tempfile.TemporaryDirectory() as temporary:
        for name in options.scenes or DEFAULT:
            print(measure(name, options.rounds, options.kernels or temporary), flush=True)


if __name__ == "__main__":
    main()
