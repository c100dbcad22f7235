"""How kernels, and the functions that only kernels call, are compiled: by what they need of numba's passes.

numba optimises every function with all that it calls, and makes machine code of it, before it is copied into
what calls it, where all of that is done again: of a function six calls deep, six times. Here a function that
only kernels call becomes LLVM's intermediate code, which is optimised once, in the kernel. The bits are the
same: no optimisation may change the rounding of an operation.
"""

from collections.abc import Callable
from typing import Any

from llvmlite.binding import Linkage
from numba.core import errors, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.ir_utils import build_definitions
from numba.core.rewrites.registry import rewrite_registry
from numba.core.ssa import reconstruct_ssa
from numba.core.transforms import canonicalize_cfg
from numba.core.typed_passes import (
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
    NopythonRewrites,
    PreLowerStripPhis,
)

from physicslab.kernels.inference import KernelInferer
from physicslab.kernels.lowering import InnerLower, KernelLower, caller_of

_errors: Any = errors  # not all of it is typed


class _InnerLibrary(JITCodeLibrary):  # type: ignore[misc]
    """The code of one function, to be copied into kernels together with that of all that it calls."""

    def finalize(self) -> None:
        """Let the code be copied, or left out of a kernel where all calls are inlined."""
        for library in self._linking_libraries:
            self._reload_init.update(library._reload_init)
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == Linkage.external:
                function.linkage = "linkonce_odr"
        self._finalize_dynamic_globals()
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """Return the code with that of all that it calls, each function once."""
        whole, waiting, seen = self._final_module.clone(), list(self._linking_libraries), {self}
        while waiting:
            library = waiting.pop()
            if library in seen:
                continue
            seen.add(library)
            if isinstance(library, _InnerLibrary):
                whole.link_in(library._final_module, preserve=True)
                waiting += library._linking_libraries
            else:
                whole.link_in(library._get_module_for_linking(), preserve=True)
        return whole


class _InnerLowering(NativeLowering):  # type: ignore[misc]
    """Makes intermediate code of a function, and lets others call it."""

    @property
    def lowering_class(self) -> Any:
        """The class that writes the code."""
        return InnerLower

    def run_pass(self, state: Any) -> bool:
        """Lower a function; its entry is a name for what calls it, and nothing that could run."""
        library = _InnerLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library, state.flags.no_compile = library, True
        returned = state.targetctx.data_model_manager[state.return_type]
        if not state.flags.nrt and returned.contains_nrt_meminfo():
            raise TypeError(f"{state.func_id.func_name} returns arrays: what counts references frees them")
        super().run_pass(state)
        library.finalize()
        entry, call = object(), caller_of(state.cr.fndesc, library, short=not state.flags.nrt)
        state.targetctx.insert_func_defn([(call, entry, call.signature)])
        state.cr = state.cr._replace(cfunc=entry)
        return True


class _KernelLowering(NativeLowering):  # type: ignore[misc]
    """Makes intermediate code of a kernel, and machine code of that."""

    @property
    def lowering_class(self) -> Any:
        """The class that writes the code."""
        return KernelLower


# Numba's passes follow the lives of variables, five times; without reference counts nothing needs that.


def _process(state: Any) -> None:
    """Bring the blocks of a function into the form that is expected; make constants where that is known."""
    if state.func_ir.is_generator:
        raise TypeError(f"{state.func_id.func_name} is a generator")
    blocks = state.func_ir.blocks = canonicalize_cfg(state.func_ir.blocks)
    for each in rewrite_registry.rewrites["before-inference"]:
        rewrite, waiting = each(state), list(blocks.items())
        while waiting:
            key, block = waiting.pop()
            if rewrite.match(state.func_ir, block, state.typemap, state.calltypes):
                blocks[key] = rewrite.apply()
                waiting.append((key, blocks[key]))


def _assign_once(state: Any) -> None:
    """Give each assignment a variable of its own."""
    state.func_ir = reconstruct_ssa(state.func_ir)
    state.func_ir._definitions = build_definitions(state.func_ir.blocks)


def _infer(state: Any) -> None:
    """Find the types of all variables."""
    warnings = _errors.WarningsFixer(_errors.NumbaWarning)
    infer = KernelInferer(state.typingctx, state.func_ir, warnings)
    stack, target = state.typingctx.callstack, state.targetctx.target
    with stack.register(target, infer, state.func_id, state.args), warnings:
        for index, (name, kind) in enumerate(zip(state.func_ir.arg_names, state.args, strict=True)):
            infer.seed_argument(name, index, kind)
        if state.return_type is not None:
            infer.seed_return(state.return_type)
        infer.build_constraint()
        infer.propagate(raise_errors=True)
        state.typemap, state.return_type, state.calltypes = infer.unify(raise_errors=True)


def _strip_phis(state: Any) -> None:
    """Assign to a variable where blocks end that lead to where its value depends on which of them did."""
    state.func_ir = PreLowerStripPhis()._strip_phi_nodes(state.func_ir)
    state.func_ir._definitions = build_definitions(state.func_ir.blocks)


def _pass(of_numba: type) -> Callable[[Any], Any]:
    return lambda state: of_numba().run_pass(state)


class _Passes:
    """Passes that run one after the other, without what numba writes down about each."""

    pipeline_name = "kernel"

    def __init__(self, passes: list[Callable[[Any], Any]]) -> None:
        self._passes = passes
        self.exec_times: dict[str, Any] = {}  # which numba takes over into what it keeps of a function

    def run(self, state: Any) -> None:
        """Run all passes on the state of a function."""
        for step in self._passes:
            step(state)


class KernelCompiler(Compiler):  # type: ignore[misc]
    """Compiles a kernel, which has no closures, no ``with`` and no exceptions."""

    lowering: type = _KernelLowering

    def define_pipelines(self) -> list[Any]:
        """Return numba's passes without those that change nothing in kernels."""
        of_references = [_pass(NopythonRewrites), _pass(IRLegalization)] if self.state.flags.nrt else []
        return [
            _Passes([
                _pass(untyped_passes.TranslateByteCode), _pass(untyped_passes.FixupArgs), _process,
                _pass(untyped_passes.InlineInlinables), _assign_once, _infer, _strip_phis,
                *of_references, _pass(self.lowering), _pass(NoPythonBackend),
            ])
        ]  # fmt: skip


class InnerCompiler(KernelCompiler):
    """Compiles a function as far as what calls it needs."""

    lowering = _InnerLowering
