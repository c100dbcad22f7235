"""The motion of every body, with the energy and momentum of all, as a table: a row an instant and body."""

from typing import TextIO

from physicslab.components import Transform, Velocity
from physicslab.components.quantities import ENERGY_CAUSES, QUANTITIES
from physicslab.diagnostics.energy import Accounts
from physicslab.diagnostics.run_report import body_names
from physicslab.diagnostics.table_rows import TableRows
from physicslab.ecs.text import table_cell
from physicslab.world import World

_MOTION = ("x", "y", "angle", "velocity x", "velocity y", "angular velocity")
_KINETIC = ("kinetic energy of translation", "kinetic energy of rotation")
_ACCOUNTS = (*(f"account: {cause}" for cause in ENERGY_CAUSES), "error of energy")
_MOMENTUM = ("momentum x", "momentum y", "angular momentum")


def _headings(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(QUANTITIES[name].heading for name in names)


BODY_HEADER = ("time [s]", "entity", *_headings(_MOTION))
"""The columns that are a body's own."""


class TrajectoryWriter:
    """Writes the state of a world to a stream as CSV, a row for each body and call.

    The columns after a body's own are sums over the world, alike in all rows of an instant: kinetic energy
    of translation and of rotation, what each force stores, and the total [J]; momentum [kg m/s]; angular
    momentum about the origin [kg m^2/s]; what each account of energy has since the start, and the error [J].
    A number that is not finite is an empty cell. Numbers keep every bit; names are those of ``run --json``,
    with an apostrophe before one that a spreadsheet would compute.

    Parameters
    ----------
    stream : text stream
        Opened with ``newline=""``.
    world : World
        The world to write; its forces decide which potential energies have a column.
    for_excel : bool
        As :class:`TableRows` has it.
    """

    def __init__(self, stream: TextIO, world: World, *, for_excel: bool = False) -> None:
        world.synchronise()
        stored = (force.potential for force in world.schedule.forces)
        self._potentials = tuple(dict.fromkeys(("gravity", "spring", *filter(None, stored))))
        self._rows = TableRows(stream, for_excel=for_excel)
        potentials = (f"potential {name} [J]" for name in self._potentials)
        sums = (*_headings(_KINETIC), *potentials, *_headings(("total energy", *_MOMENTUM, *_ACCOUNTS)))
        self._rows.write([(*BODY_HEADER, *sums)])
        self._names: list[str] = []
        self._batch: object = None

    def write(self, world: World, account: Accounts) -> None:
        """Write a row for every entity that has a Transform, as it is now, with the accounts as they are."""
        batch = world.batch(Transform)
        if batch is not self._batch:
            self._batch, self._names = batch, [*map(table_cell, body_names(world).values())]
        transform, velocity = world.table(Transform), world.table(Velocity)
        sums = self._sums(account)
        bodies = zip(
            self._names, transform["position"][batch.rows].tolist(), transform["angle"][batch.rows].tolist(),
            velocity["linear"][batch.rows].tolist(), velocity["angular"][batch.rows].tolist(), strict=True,
        )  # fmt: skip
        self._rows.write(
            (world.time, name, x, y, angle, vx, vy, w, *sums) for name, (x, y), angle, (vx, vy), w in bodies
        )

    def _sums(self, account: Accounts) -> list[str]:
        """Return the columns of the whole world as text: they are the same for every body."""
        energy, now = account.parts, account.now
        stored = (energy.potential.get(name, 0.0) for name in self._potentials)
        kinetic = (energy.kinetic_linear, energy.kinetic_angular)
        return [*map(self._rows.number, (*kinetic, *stored, *now, *account.energy.values()))]
