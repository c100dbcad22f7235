"""The pictures of a run of a lesson, at most so many, taken while its samples are."""

from physicslab.diagnostics.energy import measure_account
from physicslab.export.recording import RunRecorder
from physicslab.world import World

INSTANTS = 240
"""Pictures of a run at most."""


class Film:
    """The pictures of a run: every sample, and every second of them whenever there are too many."""

    def __init__(self) -> None:
        self._seen: list[tuple[World, RunRecorder]] = []
        self._kept: list[int] = []
        self._samples, self._stride = 0, 1

    def watch(self, world: World) -> None:
        """Take a sample."""
        if not self._seen:
            self._seen.append((world, RunRecorder(world)))
        if self._samples % self._stride == 0:
            self._keep()
        self._samples += 1
        if len(self._kept) > INSTANTS:
            self._stride *= 2
            self._seen[0][1].keep(range(0, len(self._kept), 2))
            self._kept = self._kept[::2]

    def ended(self, samples: range) -> tuple[World, RunRecorder, list[int]]:
        """Return the world at the end, its pictures within these samples of the run, and which those are."""
        if self._kept[-1] != self._samples - 1:
            self._samples -= 1
            self._keep()
        kept = [number for number in self._kept if number in samples]
        self._seen[0][1].keep(range(len(kept)))
        return *self._seen[0], kept

    def _keep(self) -> None:
        world, recorder = self._seen[0]
        recorder.write(world, measure_account(world))
        self._kept.append(self._samples)
