"""LLVM code for kernels, as short as what they do.

numba writes for ``a[i, j]`` some forty instructions: the array is stored and loaded again, one word after the
other. It passes 7 or 9 words for an array, and stores variables again and again. LLVM removes all of that,
but to write, read and remove it took much of the time that compiling took. Here an item is read in
ten instructions; functions that only kernels call are passed an array as its address and lengths; what is
assigned once is no variable in memory; and what was taken apart to be put together again is left out.

The bits of results are the same: every operation on numbers is as numba writes it.
"""

from collections.abc import Sequence
from typing import Any

from llvmlite import ir
from llvmlite.ir.instructions import (
    CastInstr,
    ExtractValue,
    GEPInstr,
    ICMPInstr,
    InsertValue,
    LoadInstr,
    PhiInstr,
    SelectInstr,
    SwitchInstr,
)  # fmt: skip
from numba.core import cgutils, types
from numba.core.analysis import compute_cfg_from_blocks, compute_use_defs, must_use_alloca
from numba.core.datamodel.manager import DataModelManager
from numba.core.datamodel.models import ArrayModel
from numba.core.datamodel.registry import default_manager
from numba.core.ir import UNDEFINED, Assign
from numba.core.lowering import Lower
from numba.np.numpy_support import as_dtype

from physicslab.kernels.inference import signature_of_call

_DATA, _SHAPE = 4, 5
"""Where the address and the lengths are in numba's structure of an array."""


# ---- values that are put together and taken apart ----------------------------------------------------------


class _Builder(ir.IRBuilder):  # type: ignore[misc]
    """Writes instructions; a part of what was just put together is that part."""

    def extract_value(self, agg: Any, idx: int | Sequence[int], name: str = "") -> Any:
        """Return a part of a structure."""
        path = list(idx) if isinstance(idx, (tuple, list)) else [idx]
        while path and isinstance(agg, InsertValue):
            at = list(agg.indices)
            if path[: len(at)] == at:
                agg, path = agg.value, path[len(at) :]
            elif at[: len(path)] == path:
                break  # only a part of that part was put in here
            else:
                agg = agg.aggregate
        return super().extract_value(agg, path, name) if path else agg


_WITHOUT_EFFECT = (CastInstr, ExtractValue, GEPInstr, ICMPInstr, InsertValue, LoadInstr, SelectInstr)
_OF_INTEGERS = frozenset(("add", "sub", "mul", "and", "or", "xor"))


def _drop_unused(function: ir.Function) -> None:
    """Remove instructions whose values are not used."""
    uses: dict[int, int] = {}
    for block in function.blocks:
        for each in block.instructions:
            for operand in _operands(each):
                uses[id(operand)] = uses.get(id(operand), 0) + 1
    for block in reversed(function.blocks):
        kept = []
        for each in reversed(block.instructions):
            removable = isinstance(each, _WITHOUT_EFFECT) or each.opname in _OF_INTEGERS
            if removable and not uses.get(id(each)):
                for operand in each.operands:
                    uses[id(operand)] -= 1
            else:
                kept.append(each)
        if len(kept) < len(block.instructions):
            block.instructions[:] = reversed(kept)


def _operands(instruction: Any) -> list[Any]:
    """Return the values that an instruction uses."""
    if isinstance(instruction, PhiInstr):
        return [value for value, _ in instruction.incomings]
    if isinstance(instruction, SwitchInstr):
        return [instruction.value, *(value for value, _ in instruction.cases)]
    return list(instruction.operands)


# ---- arrays as arguments -----------------------------------------------------------------------------------


class _AddressAndLengths(ArrayModel):  # type: ignore[misc]
    """An array whose items follow each other, as an argument: where it begins, and its lengths."""

    def get_argument_type(self) -> Any:
        """Return the types of what is passed."""
        whole = self.get_value_type()
        return (whole.elements[_DATA], tuple(whole.elements[_SHAPE].elements))

    def as_argument(self, builder: Any, value: Any) -> Any:
        """Return what is passed for an array."""
        lengths = range(self._fe_type.ndim)
        return (
            builder.extract_value(value, _DATA),
            tuple(builder.extract_value(value, [_SHAPE, axis]) for axis in lengths),
        )

    def from_argument(self, builder: Any, value: Any) -> Any:
        """Return the array of what was passed."""
        data, lengths = value
        whole = self.get_value_type()
        word = whole.elements[2]
        step: Any = word(as_dtype(self._fe_type.dtype).itemsize)
        empty, number, size = ir.Constant(whole, ir.Undefined), None, step
        array = builder.insert_value(empty, ir.Constant(whole.elements[0], None), 0)
        array = builder.insert_value(array, ir.Constant(whole.elements[1], None), 1)
        array = builder.insert_value(array, size, 3)
        array = builder.insert_value(array, data, _DATA)
        for axis in reversed(range(len(lengths))):
            array = builder.insert_value(array, lengths[axis], [_SHAPE, axis])
            array = builder.insert_value(array, step, [_SHAPE + 1, axis])
            number = lengths[axis] if number is None else builder.mul(number, lengths[axis])
            step = builder.mul(step, lengths[axis]) if axis else step
        return builder.insert_value(array, number, 2)


def _model_of(manager: Any, array: Any) -> Any:
    return (_AddressAndLengths if _is_plain(array) else ArrayModel)(manager, array)


_short_models = DataModelManager().chain(default_manager)
_short_models.register(types.Array, _model_of)


def with_short_arguments(context: Any) -> Any:
    """Return a context in which functions are given arrays as their addresses and lengths."""
    return context.subtarget(data_model_manager=_short_models)


def caller_of(fndesc: Any, library: Any, short: bool) -> Any:
    """Return what writes a call of a function that only kernels call; if it fails what calls it does too."""

    def call(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        own = with_short_arguments(context) if short else context
        function = own.declare_function(builder.module, fndesc)
        place = cgutils.alloca_once(builder, own.get_return_type(fndesc.restype))
        arguments = own.get_arg_packer(fndesc.argtypes).as_arguments(builder, values)
        _, failure, *_ = builder.function.args
        code = builder.call(function, [place, failure, *arguments])
        with cgutils.if_unlikely(builder, builder.icmp_unsigned("!=", code, code.type(0))):
            builder.ret(code)
        return own.get_returned_value(builder, fndesc.restype, builder.load(place))

    call.signature = fndesc.argtypes  # type: ignore[attr-defined]
    call.libs = (library,)  # type: ignore[attr-defined]
    return call


# ---- items of arrays ---------------------------------------------------------------------------------------


def _is_plain(array: Any) -> bool:
    """Whether a type is that of an array whose items follow each other."""
    return type(array) is types.Array and array.layout == "C" and array.ndim > 0


def _numbers_of(array: Any, index: Any) -> Sequence[Any]:
    """Return the types of as many numbers as an index consists of, if it is that of an item; else nothing."""
    numbers: Any = getattr(index, "types", (index,))
    plain = _is_plain(array) and len(numbers) == array.ndim
    return numbers if plain and all(isinstance(number, types.Integer) for number in numbers) else ()


def _address(context: Any, builder: Any, value: Any, numbers: Sequence[Any], index: Any) -> Any:
    """Return the address of an item; negative numbers count from the end."""
    place: Any = None
    for axis, number in enumerate(numbers):
        at = index[axis]
        at = context.cast(builder, at, number, types.intp if number.signed else types.uintp)
        known = isinstance(at, ir.Constant) and at.constant >= 0
        if axis or not (known or not number.signed):
            length = builder.extract_value(value, [_SHAPE, axis])
            if number.signed and not known:
                negative = builder.icmp_signed("<", at, at.type(0))
                at = builder.select(negative, builder.add(at, length), at)
            place = at if place is None else builder.add(builder.mul(place, length), at)
        else:
            place = at
    return builder.gep(builder.extract_value(value, _DATA), [place])


class KernelLower(Lower):  # type: ignore[misc]
    """Writes the code of a kernel."""

    @property
    def convention(self) -> Any:
        """The context by which this function is given its arguments."""
        return self.context

    @property
    def call_conv(self) -> Any:
        """The convention of calls of this function."""
        return self.convention.call_conv

    def setup_function(self, fndesc: Any) -> None:
        """Begin a function."""
        self.function = self.convention.declare_function(self.module, fndesc)
        self.entry_block = self.function.append_basic_block("entry")
        self.builder = _Builder(self.entry_block)
        self.call_helper = self.call_conv.init_call_helper(self.builder)

    def lower_normal_function(self, fndesc: Any) -> None:
        """Write a function."""
        super().lower_normal_function(fndesc)
        _drop_unused(self.function)

    def _find_singly_assigned_variable(self) -> None:
        """Find variables that need no place in memory: assigned once, on every way to where they are used."""
        if self.flags.nrt:
            super()._find_singly_assigned_variable()  # what counts references goes by places
            return
        self._singly_assigned_vars, self._blk_local_varmap = set(), {}
        blocks = self.func_ir.blocks
        found, in_memory = compute_use_defs(blocks), must_use_alloca(blocks)
        dominators = compute_cfg_from_blocks(blocks).dominators()
        assigned: dict[str, list[int]] = {}
        for offset, block in blocks.items():
            for each in block.find_insts(Assign):
                assigned.setdefault(each.target.name, []).append(offset)
        used: dict[str, list[int]] = {}
        for offset, names in found.usemap.items():
            for name in names:
                used.setdefault(name, []).append(offset)
        for name, places in assigned.items():
            (place, *more), users = places, used.get(name, [])
            if more or name in in_memory:
                continue
            if all(place < user and place in dominators[user] for user in users):
                self._singly_assigned_vars.add(name)

    def storevar(self, value: Any, name: str, argidx: int | None = None) -> None:
        """Assign a value to a variable."""
        if self.flags.nrt or name in self._singly_assigned_vars:
            super().storevar(value, name, argidx)
        else:
            self._alloca_var(name, self.typeof(name))
            self.builder.store(value, self.getvar(name))

    def delvar(self, name: str) -> None:
        """End the life of a variable, which matters where references are counted."""
        if self.flags.nrt:
            super().delvar(name)

    def lower_expr(self, resty: Any, expr: Any) -> Any:
        """Write what computes a value."""
        if expr.op in ("getitem", "static_getitem"):
            index = expr.index if expr.op == "getitem" else expr.index_var
            array = self.typeof(expr.value.name)
            numbers = () if index is None else _numbers_of(array, self.typeof(index.name))
            if numbers:
                value = self._load_item(array, self._address_of(expr.value, index, numbers))
                return self.context.cast(self.builder, value, array.dtype, resty)
        return super().lower_expr(resty, expr)

    def lower_binop(self, resty: Any, expr: Any, op: Any) -> Any:
        """Write what an operator does with two numbers."""
        if expr.static_lhs is not UNDEFINED or expr.static_rhs is not UNDEFINED:
            return super().lower_binop(resty, expr, op)
        context, signature = self.context.typing_context, self.fndesc.calltypes[expr]
        function, sides = context.resolve_value_type(op), (expr.lhs, expr.rhs)
        values = [
            self.context.cast(self.builder, self.loadvar(side.name), self.typeof(side.name), kind)
            for side, kind in zip(sides, signature.args, strict=True)
        ]
        found = signature_of_call(context, function, signature.args)
        value = self.context.get_function(function, found)(self.builder, values)
        return self.context.cast(self.builder, value, signature.return_type, resty)

    def lower_setitem(self, target: Any, index: Any, value: Any, signature: Any) -> Any:
        """Write what changes an item."""
        array = self.typeof(target.name)
        numbers = _numbers_of(array, self.typeof(index.name))
        if not numbers:
            return super().lower_setitem(target, index, value, signature)
        given = self.context.cast(
            self.builder, self.loadvar(value.name), self.typeof(value.name), array.dtype
        )
        align = None if array.aligned else 1
        place = self._address_of(target, index, numbers)
        return self.context.pack_value(self.builder, array.dtype, given, place, align=align)

    def _address_of(self, array: Any, index: Any, numbers: Sequence[Any]) -> Any:
        value, at = self.loadvar(array.name), self.loadvar(index.name)
        several = isinstance(self.typeof(index.name), types.BaseTuple)
        parts = [self.builder.extract_value(at, i) for i in range(len(numbers))] if several else [at]
        return _address(self.context, self.builder, value, numbers, parts)

    def _load_item(self, array: Any, place: Any) -> Any:
        if array.dtype == types.boolean:
            return self.builder.icmp_unsigned("!=", self.builder.load(place), ir.IntType(8)(0))
        align = None if array.aligned else 1
        return self.context.unpack_value(self.builder, array.dtype, place, align=align)


class InnerLower(KernelLower):
    """Writes the code of a function that only kernels call."""

    @property
    def convention(self) -> Any:
        """The context by which this function is given its arguments: short, if it counts no references."""
        return self.context if self.flags.nrt else with_short_arguments(self.context)
