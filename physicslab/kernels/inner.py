"""How kernels, and the functions that only kernels call, are compiled: by what they need of numba's passes.

numba optimises every function with all that it calls, and makes machine code of it, before it is copied into
what calls it, where all of that is done again: of a function six calls deep, six times. Here a function that
only kernels call becomes LLVM's intermediate code, which is optimised once, in the kernel. The bits are the
same: no optimisation may change the rounding of an operation.
"""

from typing import Any

from llvmlite.binding import Linkage
from numba.core import typed_passes, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.typed_passes import NativeLowering, NopythonRewrites

from physicslab.kernels.lowering import InnerLower, KernelLower, caller_of


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


@register_pass(mutates_CFG=True, analysis_only=False)
class _InnerLowering(NativeLowering):
    """Makes intermediate code of a function, and lets others call it."""

    _name = "inner_lowering"

    @property
    def lowering_class(self) -> Any:
        """What writes the code."""
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


@register_pass(mutates_CFG=True, analysis_only=False)
class _KernelLowering(NativeLowering):
    """Makes intermediate code of a kernel, and machine code of that."""

    _name = "kernel_lowering"

    @property
    def lowering_class(self) -> Any:
        """What writes the code."""
        return KernelLower


class _Passes(PassManager):  # type: ignore[misc]
    """Passes that run one after the other, without what numba writes down about each."""

    def run(self, state: Any) -> None:
        """Run all passes on the state of a function."""
        for step, _ in self.passes:
            step().run_pass(state)


class KernelCompiler(Compiler):  # type: ignore[misc]
    """Compiles a kernel, which has no closures, no ``with`` and no exceptions."""

    lowering: type = _KernelLowering

    def define_pipelines(self) -> list[Any]:
        """Return numba's passes without those that change nothing in kernels."""
        passes = _Passes("kernel")
        steps = [
            untyped_passes.TranslateByteCode, untyped_passes.FixupArgs, untyped_passes.IRProcessing,
            untyped_passes.GenericRewrites, untyped_passes.InlineInlinables, untyped_passes.ReconstructSSA,
            typed_passes.NopythonTypeInference, typed_passes.PreLowerStripPhis,
            *([NopythonRewrites] if self.state.flags.nrt else []),
            typed_passes.IRLegalization, self.lowering, typed_passes.NoPythonBackend,
        ]  # fmt: skip
        for step in steps:
            passes.add_pass(step, "")
        passes.finalize()
        return [passes]


class InnerCompiler(KernelCompiler):
    """Compiles a function as far as what calls it needs."""

    lowering = _InnerLowering
