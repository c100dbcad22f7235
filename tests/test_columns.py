"""Components as rows of columns: one memory, checked values, handles that stay safe."""

import copy
import math
import pickle
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import (
    Drag,
    Mass,
    Material,
    Medium,
    Molecule,
    Name,
    Pin,
    Rod,
    Shape,
    Slot,
    Spring,
    Thrust,
    Trail,
    Transform,
    Velocity,
)
from physicslab.ecs.component import (
    COMPONENTS,
    Component,
    InvalidValue,
    Vector,
    component,
    field,
    local_components,
)
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.table import Table
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import circle
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System, at
from physicslab.world import World

with local_components():

    @component
    class Ion(Component):
        """An example of a contributor's component."""

        charge: float = field(default=0.0, unit="C", meaning="electric charge")
        field_there: Vector = field(default=(0.0, 0.0), unit="V/m", meaning="the field at the ion")
        count: int = field(default=0, minimum=0, meaning="pushes so far")
        sign: str = field(default="fixed", choices=("fixed", "free"), meaning="whether it may change")

    @component
    class Marker(Component):
        """A component without fields: its presence is all that it says."""


class IonSystem(System):
    """An example of a contributor's vectorised system."""

    needs = (Ion, Velocity)

    @at(Stage.FORCE)
    def push(self, world: World, h: float) -> None:
        rows, charge = world.batch(Ion, Velocity).rows, world.table(Ion)
        push = charge["charge"][rows, None] * charge["field_there"][rows]
        world.table(Velocity)["linear"][rows] += h * push
        charge["count"][rows] += 1


# ---- one memory --------------------------------------------------------------------------------------------


def test_a_handle_and_its_column_are_one_memory() -> None:
    world = World()
    entity = world.spawn(Transform((1, 2), 0.5), Mass(3.0, fixed_rotation=True), Shape.box(1, 2))
    transform, mass = world.component(entity, Transform), world.component(entity, Mass)
    row = world.entity_index.row_of[entity]

    transform.position = (3, 4)
    mass.mass = 5
    mass.fixed_rotation = False
    assert world.table(Transform)["position"][row].tolist() == [3.0, 4.0]
    assert world.table(Mass)["mass"][row] == 5.0
    assert not world.table(Mass)["fixed_rotation"][row]

    world.table(Transform)["position"][row] = 7, 8
    world.table(Transform)["angle"][row] = 0.25
    assert (transform.position, transform.angle) == (Vector2(7, 8), 0.25)


def test_handles_read_plain_python_values() -> None:
    world = World()
    entity = world.spawn(Transform(), Shape.circle(1), Mass(), Spring(anchor_b=(0, 1)), Ion())
    assert type(world.component(entity, Transform).position) is Vector2
    assert type(world.component(entity, Ion).count) is int
    assert type(world.component(entity, Mass).mass) is float
    assert world.component(entity, Mass).fixed_rotation is False
    assert world.component(entity, Shape).kind == "circle"
    assert world.component(entity, Spring).a is None


def test_detached_components_hold_their_values() -> None:
    spring = Spring(a=3, anchor_b=np.array([1, 2]), stiffness=7)
    assert (spring.a, spring.b, spring.anchor_b, spring.stiffness) == (3, None, Vector2(1, 2), 7.0)
    spring.stiffness = 8
    assert spring.values()["stiffness"] == 8.0
    assert repr(Velocity((1, 2))) == "Velocity(linear=Vector2(x=1.0, y=2.0), angular=0.0)"


def test_growing_moves_every_handle_along() -> None:
    world = World()
    handles = []
    for i in range(100):
        handles.append(Transform((i, -i), i))
        world.spawn(handles[-1])
        world.synchronise()
    assert [h.angle for h in handles] == list(range(100))
    handles[0].angle = 5
    assert world.table(Transform)["angle"][1] == 5.0


def test_release_keeps_the_last_values_and_blanks_the_row() -> None:
    table = Table(Transform, 4)
    table.resize(3, 4)
    first, second = Transform((1, 2), 3), Transform((4, 5), 6)
    table.adopt(10, first, 1)
    table.adopt(11, second, 2)
    table["angle"][1] = 9.0
    table.release(10)
    assert (first.position, first.angle) == (Vector2(1, 2), 9.0)
    assert table.present.tolist() == [False, False, True]
    assert table["position"].tolist() == [[0, 0], [0, 0], [4, 5]]
    first.angle = 1.0
    assert table["angle"].tolist() == [0.0, 0.0, 6.0]


def test_compact_moves_rows_and_handles_together() -> None:
    table = Table(Transform, 4)
    table.resize(4, 4)
    handle = Transform((1, 2), 3)
    table.adopt(10, handle, 3)
    table.compact(np.array([0, 3]), {10: 1})
    assert table["angle"].tolist() == [0.0, 3.0, 0.0, 0.0]
    assert table.present.tolist() == [False, True, False, False]
    assert handle.position == Vector2(1, 2)


def test_one_object_is_not_two_entities_component() -> None:
    world = World()
    shared = Transform()
    world.spawn(shared)
    second = world.spawn(shared)
    with pytest.raises(ValueError, match=f"entity {second}: this Transform object already belongs"):
        world.step()
    with pytest.raises(ValueError, match="already belongs"):
        world.step()
    world.add(second, Transform((1, 1)))
    world.step()
    assert world.component(second, Transform).position == Vector2(1, 1)


def test_a_field_less_component_is_followed_too() -> None:
    world = World()
    marked, shared = world.spawn(Marker(), Transform()), Marker()
    world.spawn(Transform())
    assert not world.table(Marker).present.any()  # columns follow where a batch is taken, or a step
    assert world.batch(Marker, Transform).entities.tolist() == [marked]
    world.spawn(shared)
    world.spawn(shared)
    with pytest.raises(ValueError, match="this Marker object already belongs"):
        world.synchronise()


# ---- checks ------------------------------------------------------------------------------------------------

REFUSED: list[tuple[type[Any], str, Any, str]] = [
    (Mass, "mass", 0.0, "Mass.mass = 0.0: must be a finite number > 0 kg"),
    (Mass, "mass", 1e-310, "must be a finite number > 0 kg, at least 1e-300"),
    (Mass, "mass", "1e-310 kg", "Mass.mass = '1e-310 kg': must be a finite number > 0 kg, at least 1e-300"),
    (Mass, "mass", -1, "Mass.mass = -1: must be a finite number > 0 kg"),
    (Mass, "mass", math.nan, "Mass.mass = nan: must be"),
    (Mass, "mass", math.inf, "Mass.mass = inf: must be"),
    (Mass, "mass", 10**400, "must be a finite number > 0 kg"),
    (Mass, "mass", "one", "Mass.mass = 'one': must be"),
    (Mass, "mass", True, "Mass.mass = True: must be"),
    (Mass, "mass", None, "Mass.mass = None: must be"),
    (Mass, "inertia", 0.0, "Mass.inertia = 0.0: must be a finite number > 0 kg m^2 or null"),
    (Mass, "fixed_rotation", 1, "Mass.fixed_rotation = 1: must be true or false"),
    (Material, "restitution", 1.5, "Material.restitution = 1.5: must be a finite number from 0 to 1"),
    (Material, "friction", -0.1, "Material.friction = -0.1: must be a finite number >= 0"),
    (Spring, "stiffness", -5.0, "Spring.stiffness = -5.0: must be a finite number >= 0 N/m"),
    (Trail, "length", 0, "Trail.length = 0: must be a finite number > 0 s"),
    (
        Transform,
        "position",
        (1, math.nan),
        "Transform.position = (1, nan): must be two finite numbers [x, y] m",
    ),
    (Transform, "position", (1, 2, 3), "must be two finite numbers"),
    (Transform, "position", 5.0, "must be two finite numbers"),
    (Transform, "position", "12", "must be two finite numbers"),
    (Transform, "position", b"12", "must be two finite numbers"),
    (Transform, "position", (True, 0), "must be two finite numbers"),
    (Transform, "position", np.array(5.0), "must be two finite numbers"),
    (Transform, "position", np.zeros((2, 2)), "must be two finite numbers"),
    (Transform, "position", Vector2(math.inf, 0), "must be two finite numbers"),
    (Ion, "count", 1.0, "Ion.count = 1.0: must be a whole number >= 0"),
    (Ion, "count", True, "Ion.count = True: must be a whole number >= 0"),
    (Ion, "count", 2**63, "must be a whole number >= 0"),
    (Ion, "sign", "odd", 'Ion.sign = \'odd\': must be one of "fixed", "free"'),
]


@pytest.mark.parametrize(("kind", "name", "value", "message"), REFUSED)
def test_a_bad_value_is_refused_by_name(kind: type[Any], name: str, value: Any, message: str) -> None:
    with pytest.raises(InvalidValue) as made:
        kind(**{name: value})
    assert message in str(made.value)
    assert (made.value.component, made.value.field) == (kind.__name__, name)

    handle = kind()
    before = handle.values()
    with pytest.raises(InvalidValue) as written:
        setattr(handle, name, value)
    assert str(written.value) == str(made.value)
    assert handle.values() == before


@pytest.mark.parametrize("value", [0, -1, 1.0, True, b"ball", 2**63])
def test_an_entity_is_a_positive_whole_number(value: Any) -> None:
    with pytest.raises(InvalidValue, match=r"Spring\.a = .*: must be an entity or null"):
        Spring(a=value)


def test_errors_travel_between_processes() -> None:
    error = InvalidValue("Mass", "mass", -1, "a finite number > 0 kg")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.component, again.value) == (str(error), "Mass", -1)


def test_sizes_belong_to_the_kind() -> None:
    with pytest.raises(
        InvalidValue, match=r"Shape\.radius = 0\.0: must be a finite number > 0 m for a circle"
    ):
        Shape("circle")
    with pytest.raises(InvalidValue, match=r"Shape\.width = 1\.0: must be left out: a circle has no width"):
        Shape("circle", radius=1.0, width=1.0)
    with pytest.raises(TypeError, match='Shape needs kind: one of "circle", "box"'):
        Shape()  # type: ignore[call-arg]


def test_sizes_belong_to_the_kind_when_written_too() -> None:
    world = World()
    shape = world.component(world.spawn(Transform(), Shape.circle(0.5)), Shape)
    with pytest.raises(InvalidValue, match=r"Shape\.radius = 0\.0"):
        shape.radius = 0.0
    with pytest.raises(InvalidValue, match="a circle has no width"):
        shape.width = 2.0
    assert (shape.radius, shape.width) == (0.5, 0.0)
    shape.radius = 0.75
    assert world.table(Shape)["radius"][1] == 0.75


def test_misspelt_and_fixed_fields() -> None:
    with pytest.raises(AttributeError):
        Transform().postion = (1, 2)  # type: ignore[attr-defined]
    with pytest.raises(TypeError, match="Transform has no field 'postion'; it has position, angle"):
        Transform(postion=(1, 2))  # type: ignore[call-arg]
    with pytest.raises(AttributeError, match=r"Shape\.kind is fixed"):
        Shape.circle(1).kind = "box"
    with pytest.raises(TypeError, match="at most 2 values, got 3"):
        Transform((0, 0), 0, 0)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"Transform\.angle was given twice"):
        Transform((0, 0), 0, angle=1)  # type: ignore[misc]


@given(st.floats(allow_nan=False, allow_infinity=False), st.floats(allow_nan=False, allow_infinity=False))
def test_every_finite_pair_comes_back_unchanged(x: float, y: float) -> None:
    velocity = Velocity((x, y))
    assert tuple(velocity.linear) == (x, y)
    velocity.linear = Vector2(y, x)
    assert tuple(velocity.linear) == (y, x)


# ---- derived fields ----------------------------------------------------------------------------------------


def test_inertia_comes_from_the_shape_until_it_is_given() -> None:
    world = World()
    mass = Mass(2.0)
    entity = world.spawn(Transform(), Velocity(), mass, Shape.circle(0.5))
    assert (mass.inertia, mass.is_given("inertia")) == (0.0, False)
    world.synchronise()
    assert mass.inertia == 0.25

    mass.mass = 4.0
    world.step()
    assert mass.inertia == 0.5
    world.add(entity, Shape.box(3, 4))
    world.step()
    assert mass.inertia == pytest.approx(4.0 * 25.0 / 12.0)

    mass.inertia = 9.0
    world.step()
    assert (mass.inertia, mass.is_given("inertia")) == (9.0, True)
    mass.inertia = None
    world.step()
    assert mass.inertia == pytest.approx(4.0 * 25.0 / 12.0)
    world.discard(entity, Shape)
    world.step()
    assert mass.inertia == 0.0


# ---- copies ------------------------------------------------------------------------------------------------

COPIES: list[Any] = [
    Transform((1, 2), 3), Mass(2.0), Mass(2.0, 5.0, True), Shape.box(1, 2), Spring(3, None, (1, 2)),
    Ion(1, (2, 3), 4, "free"), Marker(),
]  # fmt: skip


@pytest.mark.parametrize("original", COPIES, ids=repr)
def test_copies_are_detached_and_equal(original: Any) -> None:
    world = World(systems=())
    for number in range(1, 4):  # one of them is the end of a spring
        world.spawn(Name(f"{number}"))
    copies = [copy.copy(original), copy.deepcopy(original), pickle.loads(pickle.dumps(original))]
    world.spawn(Transform()) if type(original) is Transform else world.spawn(Transform(), copies[0])
    again = copy.copy(copies[0])
    world.spawn(again)
    for duplicate in (*copies, again):
        assert type(duplicate) is type(original)
        assert duplicate.given() == original.given()


def test_a_copy_lets_go_of_the_world() -> None:
    world = World()
    handle = world.component(world.spawn(Transform((1, 2))), Transform)
    duplicate = copy.copy(handle)
    handle.position = (3, 4)
    assert duplicate.position == Vector2(1, 2)


# ---- a contributor's component -----------------------------------------------------------------------------


def test_a_contributed_component_and_system_work_in_a_world() -> None:
    world = World(IonSystem(), simulation=SimulationConfig(dt=0.5))
    pushed = world.spawn(Transform(), Velocity(), Ion(2.0, (0, 3)))
    world.spawn(Transform(), Velocity())
    world.step(0.5)
    assert world.component(pushed, Velocity).linear == Vector2(0, 3.0)
    assert world.component(pushed, Ion).count == 4
    assert Ion.FIELDS[0].meaning == "electric charge"
    assert Ion.charge.__doc__ == "electric charge [C]"


def test_mistakes_in_a_component_are_reported_when_it_is_made() -> None:
    with pytest.raises(TypeError, match=r"Bare\.value: describe it with field"):

        @component
        class Bare(Component):
            value: float = 0.0

    with pytest.raises(TypeError, match=r"Untyped\.value: annotate it"):

        @component
        class Untyped(Component):
            value = field(default=0.0)

    with pytest.raises(TypeError, match="no column holds"):

        @component
        class Odd(Component):
            value: list[float] = field(default=0.0)

    with pytest.raises(InvalidValue, match=r"Low\.value = -1\.0: must be a finite number >= 0"):

        @component
        class Low(Component):
            value: float = field(default=-1.0, minimum=0.0)

    with pytest.raises(TypeError, match="no base class but Component"):

        @component
        class Grown(dict[str, int]):
            value: float = field(default=0.0)

    with pytest.raises(TypeError, match="no subclasses"):

        class Heavier(Mass):
            pass

    assert not {"Bare", "Untyped", "Odd", "Low", "Grown", "Heavier"} & COMPONENTS.keys()


def another(name: str, module: str) -> type[Any]:
    """Return a class as it is written somewhere else, before it becomes a component."""
    return type(name, (), {"__module__": module, "__qualname__": name, "__annotations__": {}})


def test_a_name_is_not_taken_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("physicslab.ecs.component._local", False)  # as outside of tests
    line = "component theirs.Mass: physicslab.components.mass.Mass has this name already, and "
    with pytest.raises(TypeError, match=f"^{line}scene files use it; choose another$"):
        component(another("Mass", "theirs"))
    assert COMPONENTS["Mass"] is Mass
    again = [component(another("Ballast", "notebook")) for _ in range(2)]
    assert COMPONENTS["Ballast"] is again[1], "a cell that is run again"


def test_an_example_may_have_the_name_of_a_built_in_component() -> None:
    """A component that is added one day turns no example and no foreign test red."""
    with local_components():
        mine = component(another("Mass", "a.tutorial"))
        assert COMPONENTS["Mass"] is mine
        world = World()
        entity = world.spawn(Transform(), mine(), Mass(2.0))
        assert world.component(entity, Mass).mass == 2.0
        late = component(another("Wing", "physicslab.components.wing"))
        component(another("Wing", "a.tutorial"))
    assert COMPONENTS["Mass"] is Mass
    assert "Wing" not in COMPONENTS and late.__name__ == "Wing"
    with local_components():
        late = component(another("Wing", "physicslab.components.wing"))
    assert COMPONENTS.pop("Wing") is late, "the package itself was imported meanwhile"


@pytest.mark.parametrize(
    ("kind", "name", "value"),
    [
        (Mass, "mass", -1.0), (Mass, "mass", math.nan), (Mass, "mass", math.inf), (Mass, "inertia", -1.0),
        (Material, "restitution", -1.0), (Material, "restitution", 1.5), (Material, "restitution", math.nan),
        (Material, "friction", -1.0), (Material, "friction", math.inf), (Spring, "stiffness", -1.0),
        (Spring, "damping", math.nan), (Spring, "rest_length", -1.0), (Drag, "linear", -1.0),
        (Drag, "quadratic", math.nan),
    ],
)  # fmt: skip
def test_a_number_written_to_a_column_is_refused_as_its_handle_refuses_it(
    kind: type[Component], name: str, value: float
) -> None:
    world = World(*standard_systems())
    for place in ((0.0, 0.0), (5.0, 0.0)):
        parts = Mass(2.0), Shape.circle(0.2), Material(0.5, 0.5), Drag(0.1), Spring(anchor_b=(0.0, 2.0))
        world.spawn(Transform(place), Velocity(), *parts, name=f"ball {place[0]:g}")
    world.step()
    before, row = world.time, world.entity_index.row_of[world.entity("ball 5")]
    kept = float(world.table(kind)[name][row])
    world.table(kind)[name][row] = value
    attempts: list[Callable[[], None]] = [world.step, lambda: world.run(steps=3), world.synchronise]
    for attempt in attempts:
        with pytest.raises(InvalidValue, match=rf"^ball 5: {kind.__name__}\.{name} = {value}: must be a fin"):
            attempt()
    assert world.time == before
    world.table(kind)[name][row] = kept
    world.step()


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
@pytest.mark.parametrize(
    ("kind", "name", "value", "line"),
    [
        (Rod, "length", math.nan, "Rod.length = nan: must be a finite number >"),
        (Pin, "max_torque", math.inf, "Pin.max_torque = inf: must be a finite number >= 0"),
        (Slot, "axis", 0.0, "Slot.axis = (0.0, 0.0): must be a direction"),
        (Medium, "density", -1.0, "Medium.density = -1.0: must be a finite number >= 0"),
        (Molecule, "depth", math.nan, "Molecule.depth = nan: must be a finite number >= 0"),
        (Thrust, "force", math.inf, "Thrust.force = [inf, inf]: must be two finite numbers"),
    ],
)
def test_what_a_handle_refuses_is_refused_in_a_column(
    contacts: str, kind: type[Any], name: str, value: float, line: str
) -> None:
    """Lengths that were no numbers were taken without a word, and an axis of no length was divided by."""
    world = World(simulation=SimulationConfig(contacts=contacts))
    bodies = [circle(world, (x, 1.0), radius=0.2) for x in (0.0, 1.0, 2.0)]
    world.spawn(Rod(None, bodies[0], anchor_a=(0.0, 2.0)))
    world.spawn(Pin(None, bodies[1], anchor_a=(1.0, 1.0), motor_speed=1.0, max_torque=1.0))
    world.spawn(Slot(None, bodies[2], anchor_a=(2.0, 1.0)))
    world.spawn(Transform((0.0, 1.0)), Shape.box(6.0, 2.0), Medium())
    for body in bodies:
        world.add(body, Molecule())
    world.add(bodies[0], Thrust((1.0, 0.0)))
    world.run(steps=2)
    table, before = world.table(kind), world.table(Transform)["position"].copy()
    table[name][np.flatnonzero(table.present)[-1]] = value
    for _ in range(2):
        with pytest.raises(InvalidValue, match=re.escape(line)):
            world.step()
    assert np.array_equal(world.table(Transform)["position"], before) and world.steps == 2
