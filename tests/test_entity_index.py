"""Which entity has which row: tables follow esper whatever is done to it."""

import esper
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physicslab.components import Held, Mass, Name, Thrust, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.world import World


def rows_and_handles_agree(world: World) -> None:
    """Check that every table holds just what esper holds, in the order of entity ids."""
    world.synchronise()
    with world.active():
        living = set(esper.get_entities())
        used = world.entity_index.entities[world.entity_index.entities > 0]
        assert used.tolist() == sorted(living)
        assert world.entity_index.row_of == {int(e): int(world.entity_index.lookup[e]) for e in used}
        for component in (Transform, Velocity, Mass, Held):
            table, holders = world.table(component), dict(esper.get_component(component))
            assert table.handles == holders
            assert world.entity_index.entities[table.present].tolist() == sorted(holders)
            assert world.batch(component).entities.tolist() == sorted(holders)
            for column in (table[spec.name] for spec in table.component.FIELDS):
                assert len(column) == len(world.entity_index)
                assert not column[~table.present].any()


def test_rows_are_in_order_of_entity_ids() -> None:
    world = World()
    entities = [world.spawn(Transform((i, 0))) for i in range(50)]
    for entity in entities[::3]:
        world.remove(entity)
    world.synchronise()
    world.spawn(Transform((99, 0)))
    rows_and_handles_agree(world)
    batch = world.batch(Transform)
    assert world.table(Transform)["position"][batch.rows, 0].tolist() == [i for i in range(50) if i % 3] + [
        99
    ]


def test_many_removals_close_up_and_keep_values() -> None:
    world = World()
    entities = [world.spawn(Transform((i, -i), i), Velocity((i, 0))) for i in range(100)]
    kept = entities[90:]
    handles = {entity: world.component(entity, Transform) for entity in kept}
    for entity in entities[:90]:
        world.remove(entity)
    rows_and_handles_agree(world)
    assert len(world.entity_index) == 1 + len(kept)
    for entity in kept:
        assert handles[entity].position == Vector2(entity - 1, 1 - entity)
        assert world.component(entity, Velocity).linear.x == entity - 1
    handles[kept[0]].angle = -1.0
    assert world.table(Transform)["angle"][1] == -1.0


def test_nothing_is_done_while_nothing_changed() -> None:
    world = World()
    entity = world.spawn(Transform(), Velocity())
    with world.active():
        assert world.entity_index.synchronise()
        assert not world.entity_index.synchronise()
        world.component(entity, Transform).position = (1, 2)
        assert not world.entity_index.synchronise()
        esper.add_component(entity, Mass())
        assert world.entity_index.synchronise()
        esper.add_component(entity, Name("ball"))
        assert world.entity_index.synchronise()


# ---- plain esper calls -------------------------------------------------------------------------------------


def test_created_with_esper() -> None:
    world = World()
    transform = Transform((1, 2))
    entity = esper.create_entity(transform, Mass(2))
    rows_and_handles_agree(world)
    transform.position = (3, 4)
    assert world.table(Transform)["position"][world.entity_index.row_of[entity]].tolist() == [3, 4]


def test_replaced_with_esper() -> None:
    world = World()
    old, new = Transform((1, 2)), Transform((3, 4))
    entity = esper.create_entity(old)
    world.synchronise()
    esper.add_component(entity, new)
    rows_and_handles_agree(world)
    old.position = (9, 9)
    assert new.position == world.component(entity, Transform).position == Vector2(3, 4)


def test_removed_with_esper() -> None:
    world = World()
    velocity = Velocity((1, 2))
    entity = esper.create_entity(Transform(), velocity)
    world.synchronise()
    assert esper.remove_component(entity, Velocity) is velocity
    rows_and_handles_agree(world)
    assert velocity.linear == Vector2(1, 2)
    assert not world.batch(Velocity)


@pytest.mark.parametrize("immediate", [True, False])
def test_deleted_with_esper(immediate: bool) -> None:
    world = World()
    transform = Transform((1, 2))
    entity, other = esper.create_entity(transform), esper.create_entity(Transform())
    world.synchronise()
    esper.delete_entity(entity, immediate=immediate)
    rows_and_handles_agree(world)
    assert world.entities() == [other]
    assert transform.position == Vector2(1, 2)


def test_deleting_what_is_not_there_fails_once_and_clearly() -> None:
    world = World()
    here, gone = world.spawn(Transform()), world.spawn(Transform())
    esper.delete_entity(12345)
    esper.delete_entity(gone)
    with pytest.raises(KeyError, match=r"delete_entity\(12345\): there is no such entity in this world"):
        world.step()
    world.step()
    rows_and_handles_agree(world)
    assert world.entities() == [here]


def test_clear_database() -> None:
    world = World()
    old = Transform((5, 5))
    for _ in range(4):
        esper.create_entity(Transform(), Velocity())
    esper.create_entity(old)
    world.synchronise()
    esper.clear_database()
    rows_and_handles_agree(world)
    assert len(world.entity_index) == 1 and old.position == Vector2(5, 5)

    again = esper.create_entity(Transform((7, 7)))
    assert again == 1
    rows_and_handles_agree(world)
    assert world.component(again, Transform).position == Vector2(7, 7)


def test_clear_database_between_two_looks() -> None:
    world = World()
    for entity in [world.spawn(Transform((i, 0)), Velocity()) for i in range(4)][:2]:
        world.remove(entity)
    world.synchronise()
    esper.clear_database()
    fresh = [esper.create_entity(Transform((10 + i, 0))) for i in range(3)]
    rows_and_handles_agree(world)
    assert [world.component(entity, Transform).position.x for entity in fresh] == [10, 11, 12]


def test_components_may_change_hands_in_one_go() -> None:
    world = World()
    one, two = Transform((1, 0)), Transform((2, 0))
    a, b = world.spawn(one), world.spawn(two)
    world.synchronise()
    world.add(a, two)
    world.add(b, one)
    rows_and_handles_agree(world)
    assert world.component(a, Transform).position.x == 2.0
    assert world.component(b, Transform).position.x == 1.0

    velocity = Velocity((3, 0))
    world.add(a, velocity)
    world.synchronise()
    world.add(b, world.discard(a, Velocity))
    rows_and_handles_agree(world)
    assert world.component(b, Velocity) is velocity and velocity.linear.x == 3.0


def test_foreign_components_are_left_alone_whatever_they_make_of_equality() -> None:
    class Inventory:
        def __eq__(self, other: object) -> bool:
            raise ValueError("the truth value of an inventory is ambiguous")

        __hash__ = None  # type: ignore[assignment]

    world = World()
    entity = world.spawn(Inventory(), Transform((1, 0)))
    rows_and_handles_agree(world)
    world.add(entity, Inventory())
    world.add(entity, Transform((2, 0)))
    rows_and_handles_agree(world)
    assert world.component(entity, Transform).position.x == 2.0


deeds = st.sampled_from(["spawn", "remove", "add", "discard", "delete", "step"])
changes = st.lists(st.tuples(deeds, st.integers(0, 30)))


@given(changes)
@settings(max_examples=60)
def test_whatever_is_done_rows_follow(done: list[tuple[str, int]]) -> None:
    world = World()
    expected: dict[int, float] = {}
    for count, (what, which) in enumerate(done):
        entities = world.entities()
        if what == "spawn" or not entities:
            expected[world.spawn(Transform((count, 0)), Velocity())] = count
            continue
        entity = entities[which % len(entities)]
        match what:
            case "remove":
                world.remove(entity)
                del expected[entity]
            case "delete":
                esper.delete_entity(entity)
                world.synchronise()
                del expected[entity]
            case "add":
                world.add(entity, Mass(1.0 + which))
            case "discard":
                world.discard(entity, Velocity)
            case "step":
                world.step(0.01)
    rows_and_handles_agree(world)
    assert {e: world.component(e, Transform).position.x for e in world.entities()} == expected


def test_rows_of() -> None:
    world = World()
    entities = [world.spawn(Transform()) for _ in range(3)]
    world.remove(entities[1])
    world.synchronise()
    asked = np.array([0, entities[0], entities[1], entities[2], 99])
    assert world.entity_index.rows_of(asked).tolist()[::4] == [0, -1]
    assert world.entity_index.entities[world.entity_index.rows_of(asked)[[1, 3]]].tolist() == [
        entities[0],
        entities[2],
    ]
    assert world.entity_index.rows_of(asked)[2] == -1


def test_no_table_is_made_for_a_component_that_no_entity_has() -> None:
    world = World()
    world.spawn(Transform((1, 0)))
    assert not len(world.batch(Thrust)) and not len(world.batch(Transform, Thrust))
    assert Thrust not in world.entity_index.tables
    body = world.spawn(Transform((2, 0)), Thrust())
    assert world.batch(Transform, Thrust).entities.tolist() == [body]
    world.remove(body)
    assert not len(world.batch(Thrust))
    rows_and_handles_agree(world)
