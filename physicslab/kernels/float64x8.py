"""Eight numbers as one: what the processor adds, multiplies and compares at once.

A formula over :class:`Wide` numbers reads like one over plain ones. LLVM turns each operation into vector
instructions of whatever width the machine has, and need not find out for itself that a loop may be
vectorised. Only kernels make such numbers: they are in registers, and in arrays eight in a row.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from llvmlite import ir
from numba import float64, int64, types
from numba.core.typing.templates import ConcreteTemplate, infer_global
from numba.extending import intrinsic, lower_builtin, models, register_model

from physicslab.kernels import Numbers, Rows, Vectors
from physicslab.kernels.wide_layout import WIDE


class Wide:
    """Eight float64 values. A plain number beside one is used eight times."""

    if TYPE_CHECKING:

        def __add__(self, other: Wide | float) -> Wide: ...
        def __radd__(self, other: float) -> Wide: ...
        def __sub__(self, other: Wide | float) -> Wide: ...
        def __rsub__(self, other: float) -> Wide: ...
        def __mul__(self, other: Wide | float) -> Wide: ...
        def __rmul__(self, other: float) -> Wide: ...
        def __truediv__(self, other: Wide | float) -> Wide: ...
        def __rtruediv__(self, other: float) -> Wide: ...
        def __neg__(self) -> Wide: ...
        def __lt__(self, other: Wide | float) -> Mask: ...
        def __gt__(self, other: Wide | float) -> Mask: ...


class Mask:
    """Eight booleans."""

    if TYPE_CHECKING:

        def __and__(self, other: Mask) -> Mask: ...
        def __or__(self, other: Mask) -> Mask: ...


# ---- types for numba ---------------------------------------------------------------------------------------

_DOUBLE, _PLACE = ir.DoubleType(), ir.IntType(32)
_DOUBLES, _BITS = ir.VectorType(_DOUBLE, WIDE), ir.VectorType(ir.IntType(1), WIDE)


class _Numbers(types.Type):
    def __init__(self) -> None:
        super().__init__(name="Wide")


class _Booleans(types.Type):
    def __init__(self) -> None:
        super().__init__(name="Mask")


@register_model(_Numbers)
class _NumbersModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _DOUBLES)


@register_model(_Booleans)
class _BooleansModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _BITS)


_wide, _mask = _Numbers(), _Booleans()
_BOTH = (_wide, _wide), (_wide, float64), (float64, _wide)


def _spread(builder: Any, value: Any) -> Any:
    """Eight times the same value; what is wide already stays as it is."""
    if value.type == _DOUBLES:
        return value
    one = builder.insert_element(ir.Constant(_DOUBLES, ir.Undefined), value, _PLACE(0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(_PLACE, WIDE), [0] * WIDE))


def _define(
    symbol: Any, result: Any, operands: tuple[tuple[Any, ...], ...], emit: Callable[..., Any]
) -> None:
    """Define an operator of Python for such operands; ``emit`` writes its instruction."""

    class Template(ConcreteTemplate):
        key = symbol
        cases: ClassVar[Any] = [result(*kinds) for kinds in operands]

    infer_global(symbol)(Template)
    for kinds in operands:

        @lower_builtin(symbol, *kinds)
        def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            values = arguments
            if _wide in signature.args:
                values = [_spread(builder, value) for value in arguments]
            return emit(builder, *values)


_define(operator.add, _wide, _BOTH, lambda build, x, y: build.fadd(x, y))
_define(operator.sub, _wide, _BOTH, lambda build, x, y: build.fsub(x, y))
_define(operator.mul, _wide, _BOTH, lambda build, x, y: build.fmul(x, y))
_define(operator.truediv, _wide, _BOTH, lambda build, x, y: build.fdiv(x, y))
_define(operator.neg, _wide, ((_wide,),), lambda build, x: build.fneg(x))
_define(operator.lt, _mask, _BOTH, lambda build, x, y: build.fcmp_ordered("<", x, y))
_define(operator.gt, _mask, _BOTH, lambda build, x, y: build.fcmp_ordered(">", x, y))
_define(operator.and_, _mask, ((_mask, _mask),), lambda build, x, y: build.and_(x, y))
_define(operator.or_, _mask, ((_mask, _mask),), lambda build, x, y: build.or_(x, y))


# ---- functions of wide numbers -----------------------------------------------------------------------------


def _lesser_type(context: Any, x: Any, y: Any) -> Any:
    """Return the lesser of two, slot by slot."""
    return _of_kind(x, y)(x, y), lambda c, build, s, both: _picked(build, "<", *both)


def _greater_type(context: Any, x: Any, y: Any) -> Any:
    """Return the greater of two, slot by slot."""
    return _of_kind(x, y)(x, y), lambda c, build, s, both: _picked(build, ">", *both)


def _choose_type(context: Any, mask: Any, x: Any, y: Any) -> Any:
    """Return x in the slots where the mask is true, and y in the others."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        x, y = (
            (_spread(build, value) for value in arguments[1:])
            if mask == _mask
            else _alike(build, *arguments[1:])
        )
        return build.select(arguments[0], x, y)

    return (_wide if mask == _mask else _of_kind(x, y))(mask, x, y), generate


def _of_kind(x: Any, y: Any) -> Any:
    """Return the type of a result of two numbers: wide, if either is."""
    return _wide if _wide in (x, y) else float64


def _alike(build: Any, x: Any, y: Any) -> tuple[Any, Any]:
    return (_spread(build, x), _spread(build, y)) if _DOUBLES in (x.type, y.type) else (x, y)


def _picked(build: Any, order: str, x: Any, y: Any) -> Any:
    x, y = _alike(build, x, y)
    return build.select(build.fcmp_ordered(order, x, y), x, y)


def _root_type(context: Any, x: Any) -> Any:
    """Return square roots."""
    return _wide(x), _intrinsic("sqrt")


def _size_type(context: Any, x: Any) -> Any:
    """Return absolute values."""
    return _wide(x), _intrinsic("fabs")


def _intrinsic(name: str) -> Callable[..., Any]:
    """Return a generator of a call to one of LLVM's intrinsics."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        eight = ir.FunctionType(_DOUBLES, [_DOUBLES])
        called = build.module.declare_intrinsic(f"llvm.{name}.v{WIDE}f64", fnty=eight)
        return build.call(called, arguments)

    return generate


def _everywhere_type(context: Any, x: Any) -> Any:
    """Return one number in all slots."""
    return _wide(x), lambda c, build, s, arguments: _spread(build, arguments[0])


def _sum_type(context: Any, x: Any) -> Any:
    """Return the sum of all slots, one after the other."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        total = build.extract_element(arguments[0], _PLACE(0))
        for slot in range(1, WIDE):
            total = build.fadd(total, build.extract_element(arguments[0], _PLACE(slot)))
        return total

    return float64(x), generate


def _mask_bits_type(context: Any, mask: Any) -> Any:
    """Return a mask as the bits of an integer: 0 where all are false."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        return build.zext(build.bitcast(arguments[0], ir.IntType(WIDE)), ir.IntType(64))

    return int64(mask), generate


# ---- wide numbers in arrays --------------------------------------------------------------------------------


def _data(context: Any, build: Any, kind: Any, array: Any) -> Any:
    return context.make_array(kind)(context, build, array).data


def _eight(build: Any, data: Any, at: Any) -> Any:
    return build.bitcast(build.gep(data, [at]), _DOUBLES.as_pointer())


def _take_type(context: Any, array: Any, at: Any) -> Any:
    """Return the eight numbers of an array that start at a place."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        data = _data(context, build, signature.args[0], arguments[0])
        return build.load(_eight(build, data, arguments[1]), align=8)

    return _wide(array, at), generate


def _put_type(context: Any, array: Any, at: Any, value: Any) -> Any:
    """Write eight numbers into an array, from a place on."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        data = _data(context, build, signature.args[0], arguments[0])
        build.store(_spread(build, arguments[2]), _eight(build, data, arguments[1]), align=8)
        return context.get_dummy_value()

    return types.void(array, at, value), generate


def _rows(context: Any, build: Any, signature: Any, arguments: Any) -> list[Any]:
    """Read the eight row numbers of the arguments (array, rows, first row number)."""
    rows = _data(context, build, signature.args[1], arguments[1])
    first = build.gep(rows, [arguments[2]])
    return [build.load(build.gep(first, [ir.IntType(64)(slot)])) for slot in range(WIDE)]


def _fetch_type(context: Any, array: Any, at: Any) -> Any:
    """Fetch the line of eight numbers of an array that starts at a place into the nearest cache."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        address, whole = ir.IntType(8).as_pointer(), ir.IntType(32)
        line = _eight(build, _data(context, build, signature.args[0], arguments[0]), arguments[1])
        of_function = ir.FunctionType(ir.VoidType(), [address, whole, whole, whole])
        prefetch = build.module.declare_intrinsic("llvm.prefetch.p0", fnty=of_function)
        # To be read, into the nearest cache, as data.
        build.call(prefetch, [build.bitcast(line, address), whole(0), whole(3), whole(1)])
        return context.get_dummy_value()

    return types.void(array, at), generate


def _take_numbers_type(context: Any, numbers: Any, rows: Any, first: Any) -> Any:
    """Return the numbers of eight rows: numbers[rows[first]] and so on."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        data = _data(context, build, signature.args[0], arguments[0])
        gathered = ir.Constant(_DOUBLES, ir.Undefined)
        for slot, row in enumerate(_rows(context, build, signature, arguments)):
            gathered = build.insert_element(gathered, build.load(build.gep(data, [row])), _PLACE(slot))
        return gathered

    return _wide(numbers, rows, first), generate


def _put_numbers_type(context: Any, numbers: Any, rows: Any, first: Any, value: Any) -> Any:
    """Give eight rows their numbers."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        data = _data(context, build, signature.args[0], arguments[0])
        for slot, row in enumerate(_rows(context, build, signature, arguments)):
            build.store(build.extract_element(arguments[3], _PLACE(slot)), build.gep(data, [row]))
        return context.get_dummy_value()

    return types.void(numbers, rows, first, value), generate


def _shuffled(build: Any, x: Any, y: Any, places: Sequence[int]) -> Any:
    return build.shuffle_vector(x, y, ir.Constant(ir.VectorType(_PLACE, len(places)), list(places)))


def _vector_at(build: Any, data: Any, row: Any) -> Any:
    place = build.gep(data, [build.mul(row, ir.IntType(64)(2))])
    return build.bitcast(place, ir.VectorType(_DOUBLE, 2).as_pointer())


def _take_vectors_type(context: Any, vectors: Any, rows: Any, first: Any) -> Any:
    """Return the first and second coordinates of eight rows of an array (n, 2)."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        data = _data(context, build, signature.args[0], arguments[0])
        parts = [
            build.load(_vector_at(build, data, row), align=8)
            for row in _rows(context, build, signature, arguments)
        ]
        while len(parts) > 2:
            width = 2 * parts[0].type.count
            parts = [
                _shuffled(build, x, y, range(width)) for x, y in zip(parts[::2], parts[1::2], strict=True)
            ]
        first, second = parts
        both = [_shuffled(build, first, second, range(side, 2 * WIDE, 2)) for side in (0, 1)]
        return context.make_tuple(build, signature.return_type, both)

    return types.UniTuple(_wide, 2)(vectors, rows, first), generate


def _put_vectors_type(context: Any, vectors: Any, rows: Any, first: Any, x: Any, y: Any) -> Any:
    """Give eight rows of an array (n, 2) their coordinates."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        data = _data(context, build, signature.args[0], arguments[0])
        x, y = arguments[3], arguments[4]
        for slot, row in enumerate(_rows(context, build, signature, arguments)):
            build.store(_shuffled(build, x, y, [slot, WIDE + slot]), _vector_at(build, data, row), align=8)
        return context.get_dummy_value()

    return types.void(vectors, rows, first, x, y), generate


def _put_pairs_type(context: Any, vectors: Any, first: Any, x: Any, y: Any) -> Any:
    """Give eight rows of an array (n, 2), one after the other, their coordinates."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        data = _data(context, build, signature.args[0], arguments[0])
        x, y = arguments[2], arguments[3]
        for half in range(2):
            slots = range(half * WIDE // 2, (half + 1) * WIDE // 2)
            mixed = _shuffled(build, x, y, [place for slot in slots for place in (slot, WIDE + slot)])
            row = build.add(arguments[1], ir.IntType(64)(half * WIDE // 2))
            place = build.gep(data, [build.mul(row, ir.IntType(64)(2))])
            build.store(mixed, build.bitcast(place, _DOUBLES.as_pointer()), align=8)
        return context.get_dummy_value()

    return types.void(vectors, first, x, y), generate


type _Some = Wide | float
_inline: Any = intrinsic
lesser: Any = _inline(_lesser_type)
greater: Any = _inline(_greater_type)
choose: Any = _inline(_choose_type)
root: Callable[[Wide], Wide] = _inline(_root_type)
everywhere: Callable[[float], Wide] = _inline(_everywhere_type)
sum_of: Callable[[Wide], float] = _inline(_sum_type)
size_of: Callable[[Wide], Wide] = _inline(_size_type)
mask_bits: Callable[[Mask], int] = _inline(_mask_bits_type)
take: Callable[[Numbers, int], Wide] = _inline(_take_type)
put: Callable[[Numbers, int, _Some], None] = _inline(_put_type)
fetch: Callable[[Numbers | Rows, int], None] = _inline(_fetch_type)
take_numbers: Callable[[Numbers, Rows, int], Wide] = _inline(_take_numbers_type)
put_numbers: Callable[[Numbers, Rows, int, Wide], None] = _inline(_put_numbers_type)
take_vectors: Callable[[Vectors, Rows, int], tuple[Wide, Wide]] = _inline(_take_vectors_type)
put_vectors: Callable[[Vectors, Rows, int, Wide, Wide], None] = _inline(_put_vectors_type)
put_pairs: Callable[[Vectors, int, Wide, Wide], None] = _inline(_put_pairs_type)
