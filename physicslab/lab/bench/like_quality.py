"""Others at like quality: in steps so short that their overlaps and joints are no worse than PhysicsLab's.

At their usual settings others may be faster only because they leave deeper overlaps. So each is run again
from the start in steps of a half, a quarter, ... of the usual length, with contacts as stiff as those allow,
until no figure of quality is worse than PhysicsLab's in the same steps.
"""

from physicslab.lab.bench.engine import OtherEngine
from physicslab.lab.bench.measure import Judge
from physicslab.lab.bench.result import Alike, EngineResult, SceneResult, Times, take_turns
from physicslab.lab.jobs import Job
from physicslab.lab.peers.peer import Peer

BLOCK, PORTION, WARM = 5, 2, 2
"""Steps of a turn, turns between two looks at the quality, and steps before the timing, in which kernels are
loaded and pairs are listed for the first time. Scenes that no engine is fit for take seconds a step."""
_SLOP = 0.01
"""A figure below it is treated as zero [m]: twice the slop of pymunk and of Box2D."""
_FINEST = 64
"""Most parts of a usual step."""
_SLOWEST = 8.0
"""Time by PhysicsLab's from which on a peer is not run in shorter steps still."""


def _is_alike(found: EngineResult, ours: EngineResult) -> bool:
    """Return whether no figure of quality is worse than PhysicsLab's."""
    return not found.failure and all(
        figure is not None and figure <= max(_SLOP, ours.quality.get(name) or 0.0)
        for name, figure in found.quality.items()
    )


def run_alike(result: SceneResult, peer: type[Peer], ours: Times) -> Job[Alike | None]:
    """Run a peer, that has been run at its usual settings, in shorter steps until it is as right.

    Parameters
    ----------
    result : SceneResult
        Results at usual settings, PhysicsLab's among them.
    peer : type of Peer
        Which engine.
    ours : Times
        The time of the same steps in PhysicsLab.

    Returns
    -------
    Alike, optional
        The first length of step at which it is as right, or the last that was tried; ``None`` where it
        cannot hold the scene.
    """
    usual = result.engines[peer.title]
    if usual.failure or usual.times_ours is None:
        return None
    found = Alike(1, usual.times_ours, _is_alike(usual, result.ours))
    while not found.is_reached and found.finer < _FINEST and found.times_ours < _SLOWEST:
        found = yield from _run(result, peer, 2 * found.finer, ours)
    return found


def _run(result: SceneResult, peer: type[Peer], finer: int, ours: Times) -> Job[Alike]:
    """Run a peer in shorter steps, as far as it is as right as PhysicsLab."""
    engine = OtherEngine(result.scene.build(), peer, finer)
    here = SceneResult(result.scene, engines={peer.title: EngineResult(peer.title)})
    judge, found = Judge(here), here.engines[peer.title]
    engine.run(WARM)
    judge.begin([engine])
    steps, spent, reached = 0, 0.0, True
    for (times,) in take_turns([engine], len(ours.step), BLOCK, PORTION):
        judge.look([engine], "throughout")
        steps, spent, reached = len(times.step), sum(times.step), _is_alike(found, result.ours)
        yield 1.0
        if not reached:
            break
    return Alike(finer, spent / sum(ours.step[:steps]), reached)
