"""Media: what floats, sinks, is slowed by a fluid or carried along by its flow."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Medium, Shape, Transform, Velocity
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.sentences import sentence
from physicslab.ecs.vector import rotated
from physicslab.kernels.accounts import DAMPING, FIELDS
from physicslab.kernels.forces.medium import NUMBERS, OUTLINE, ROOM, medium
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.shapes import cores_of
from physicslab.state.state import State
from physicslab.systems.drag import AT_REST
from physicslab.systems.system import ForceSystem

_BODIES = (Shape, Transform, Velocity, Mass)


class MediumSystem(ForceSystem):
    """Lifts what is within a medium by the weight of the fluid there, and drags it along.

    Buoyancy stores energy; the drag against the fluid is in the account damping, what a flow gives in fields.
    """

    needs = (Medium, Shape, Transform)
    kernels = (medium,)
    potential = "medium"
    rounding = 1e-13
    turns = bends = couples_nothing = True

    def attach(self, state: State) -> None:
        """Check that each medium has a Shape and stays where it is.

        Raises
        ------
        InvalidValue
            If one moves, or has no Shape.
        """
        for entity in state.batch(Medium).entities.tolist():
            lacks = not (state.has(entity, Shape) and state.has(entity, Transform))
            if lacks or state.has(entity, Velocity) or state.component(entity, Shape).kind == "chain":
                allowed = (
                    "with a Transform and a Shape that is no chain, and without a Velocity: a medium stays"
                )
                density = state.component(entity, Medium).density
                raise InvalidValue(f"{state.label(entity)}: Medium", "density", density, allowed)

    def why_left_out(self, state: State) -> str | None:
        """Needed where there is a medium, and something with a Shape that moves in it."""
        reason = super().why_left_out(state)
        if reason is None and not len(state.batch(*_BODIES)):
            return sentence("nothing_in_medium")
        return reason

    def turned(self, state: State) -> NDArray[np.int64]:
        """Return the rows of all bodies."""
        return state.batch(*_BODIES).rows

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return buoyancy and drag for compiled integrators."""
        rows, media = state.batch(*_BODIES).rows, state.batch(*self.needs).rows
        rows = rows[(layout.place[rows] >= 0) & (state.bodies.inverse_mass[rows] > 0.0)]
        gravity = np.array(self._gravity(state))
        fluids, outlines = self._fluids(state, media, gravity), _outlines(state, rows)
        # The torque on a body that cannot turn is taken by what keeps it so.
        own = state.bodies.shapes.reach[rows], state.bodies.inverse_inertia[rows] > 0.0, outlines
        parameters = np.concatenate(
            ((0.0, *gravity), fluids.ravel(), np.column_stack(own).ravel(), np.zeros(ROOM))
        )
        where = np.stack((layout.place[rows], layout.turn[rows]), axis=1)
        behind = 2 + where.size
        indices = np.concatenate(((len(rows), len(media)), where.ravel(), (-1, -1, -1)))
        books = ((FIELDS, behind), (DAMPING, behind + 1)) if len(rows) else ()
        return PackedForce(medium, parameters, indices, work_slots=books, dissipation_slot=behind + 2)

    def _gravity(self, state: State) -> tuple[float, float]:
        """Return the gravity that weighs on fluids [m/s^2]: that of planets does not."""
        physics = state.physics
        return (physics.gravity.x, physics.gravity.y) if physics.gravity_mode == "linear" else (0.0, 0.0)

    def _fluids(
        self, state: State, rows: NDArray[np.int64], gravity: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return the numbers and the outline of each medium (n, NUMBERS + OUTLINE)."""
        table, transform, outlines = state.table(Medium), state.table(Transform), _outlines(state, rows)
        position, angle = transform["position"][rows], transform["angle"][rows]
        found = np.empty((len(rows), NUMBERS + OUTLINE))
        corners = outlines[:, 2:].reshape(-1, 8, 2)
        turned = np.stack([rotated(corners[:, k], angle) for k in range(8)], axis=1)
        radius = outlines[:, 1]
        level = (turned @ gravity).min(axis=1) - radius * np.hypot(*gravity) + position @ gravity
        half = np.abs(turned).max(axis=1) + radius[:, None]
        numbers = (
            position, angle, half, table["density"][rows], table["viscosity"][rows],
            table["quadratic"][rows], table["flow"][rows], level,
        )  # fmt: skip
        found[:, :NUMBERS], found[:, NUMBERS:] = np.column_stack(numbers), outlines
        return found

    def inputs(self, state: State, layout: StateLayout) -> bytes:
        """Return all numbers of media, where they are, and the sizes of all shapes."""
        sizes = b"".join(state.table(Shape)[spec.name].tobytes() for spec in Shape.FIELDS)
        media, transform = state.batch(*self.needs).rows, state.table(Transform)
        places = transform["position"][media].tobytes() + transform["angle"][media].tobytes()
        return self.settings(state) + sizes + places

    def settings(self, state: State) -> bytes:
        """Return all numbers of media."""
        table, rows = state.table(Medium), state.batch(*self.needs).rows
        return b"".join(table[spec.name][rows].tobytes() for spec in Medium.FIELDS)

    def rates(self, state: State) -> NDArray[np.float64]:
        """Return for each row how fast it would bob in the densest medium, or slow down there [1/s]."""
        table, media = state.table(Medium), state.batch(*self.needs).rows
        rows, rates = state.batch(*_BODIES).rows, np.zeros(len(state.entity_index))
        width, inverse = 2.0 * state.bodies.shapes.reach[rows], state.bodies.inverse_mass[rows]
        lift = float(table["density"][media].max(initial=0.0)) * float(np.hypot(*self._gravity(state)))
        flow = np.hypot(*table["flow"][media].T).max(initial=0.0)
        speed = np.maximum(np.hypot(*state.table(Velocity)["linear"][rows].T) + flow, AT_REST)
        drag = (
            table["viscosity"][media].max(initial=0.0)
            + 2.0 * table["quadratic"][media].max(initial=0.0) * speed
        )
        rates[rows] = np.maximum(np.sqrt(lift * width * inverse), np.pi * width * drag * inverse)
        return rates

    def regions(self, state: State) -> NDArray[np.float64]:
        """Return the boxes around all media."""
        media = state.batch(*self.needs).rows
        numbers = self._fluids(state, media, np.zeros(2))
        place, half = numbers[:, :2], numbers[:, 3:5]
        return np.hstack((place - half, place + half))

    def rounding_floor(self, state: State) -> float:
        """Return that of the lift of a body that is wholly in the densest medium."""
        rows, bodies = state.batch(*_BODIES).rows, state.bodies
        densest = float(state.table(Medium)["density"][state.batch(*self.needs).rows].max(initial=0.0))
        reach = bodies.shapes.reach[rows]
        give = np.maximum(bodies.inverse_mass[rows], reach * bodies.inverse_inertia[rows])
        lift = densest * float(np.hypot(*self._gravity(state))) * np.pi * reach * reach
        return self.rounding * float((lift * give).max(initial=0.0))

    def depends_on_velocity(self, state: State) -> bool:
        """Whether any medium is viscous, or drags by the square of the speed."""
        table, rows = state.table(Medium), state.batch(*self.needs).rows
        return bool((table["viscosity"][rows] > 0.0).any() or (table["quadratic"][rows] > 0.0).any())

    def why_singular(self, state: State) -> str | None:
        """Return that forces bend where the outline of a body comes into a medium."""
        return sentence("into_medium")

    def potential_energy(self, state: State) -> float:
        """Return the sum of density times the integral of g . x - level over what is displaced [J]."""
        return self.energy_found(state)


def _outlines(state: State, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the shapes of rows as outlines (n, OUTLINE), unturned and about their centres."""
    cores = cores_of(state.table(Shape), rows)
    numbers = cores.vertices, cores.radius, cores.corners.reshape(len(rows), 2 * cores.corners.shape[1])
    return np.column_stack(numbers)
