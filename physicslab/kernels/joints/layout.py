"""How rows of joints are packed into an array of numbers and one of whole numbers."""

from typing import Any

from physicslab.kernels import always_inlined

ROWS, COORDINATES, ENTRIES, HOLDING, POWERED, DRIVEN, RANK, FIRST = range(8)
"""The first whole numbers: how many rows; how many coordinates move; how many entries the envelope of the
matrix has; the accounts of what holds, of motors, and of what drives bodies, or -1; how many rows are
independent, as it was found last. Then ``PLACES`` numbers a row."""
ENDS = 4
"""How many ends a row has: A and B of its first term, and of its second."""
MEASURE, ROLE, NUMBER, BEGIN, AT, PLACES = 8, 10, 11, 12, 13, 14
"""The whole numbers of a row. First, of each end, where x and the angle are, as the packed coordinates have
them; -1 for what is not there, and for an angle that never changes. Then what both terms measure, or -1; its
role; its number among all rows of joints; its first neighbour in the envelope; where its entries are
there."""
ANCHOR_A, ANCHOR_B, AXIS, SCALE, ANGLE_A, TERM = 0, 2, 4, 6, 7, 9
"""The numbers of a term: anchors at A and B in the bodies' own frames [m]; the axis; the factor; the angles
of A and B [rad], where they never change."""
OFFSET, TARGET, GIVEN = 18, 19, 20
"""The numbers of a row, behind those of its two terms: what is taken from these, and the speed of a motor.
Behind all rows are the inverse masses of the coordinates, then their rates of damping [1/s], ``STATE``
numbers a row, the matrix, its factor, and room for a number of each coordinate."""
ERROR, RATE, LAMBDA, RIGHT, SHARE, CHANGE, STATE = range(12, 19)
"""The state of a row, behind its gradient by x, y and angle of each end: the error g [m or rad]; Jdot v
[1/s^2 of that]; the force [N or N m]; the right side; its pivot's share of the diagonal; how the force
changes."""


def room_of(rows: int, coordinates: int, entries: int) -> tuple[int, int]:
    """Return how many numbers and how many whole numbers so many rows, coordinates and entries take."""
    return (GIVEN + STATE) * rows + 3 * coordinates + 2 * entries, FIRST + PLACES * rows


@always_inlined
def first_state(whole: Any) -> Any:
    """Return where the states of the rows begin."""
    return GIVEN * whole[ROWS] + 2 * whole[COORDINATES]


@always_inlined
def first_entry(whole: Any) -> Any:
    """Return where the matrix begins; so many entries behind, its factor does."""
    return (GIVEN + STATE) * whole[ROWS] + 2 * whole[COORDINATES]


@always_inlined
def first_room(whole: Any) -> Any:
    """Return where the room for a number of each coordinate begins."""
    return first_entry(whole) + 2 * whole[ENTRIES]


@always_inlined
def inverse_of(numbers: Any, whole: Any, place: Any) -> float:
    """Return the inverse mass of a coordinate; zero of what is fixed, and of an angle that never changes."""
    if 0 <= place < whole[COORDINATES]:
        return numbers[GIVEN * whole[ROWS] + place]  # type: ignore[no-any-return]
    return 0.0
