"""The world in figures: its energies, where they come from and go, its gravity, and how it is stepped."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from imgui_bundle import imgui
from imgui_bundle.imgui import ImVec2

from physicslab.components import Charge
from physicslab.components.made_of import SUBSTANCES
from physicslab.diagnostics.energy import ACCOUNT_WORDS, flows
from physicslab.ecs.config import COLLISIONS, CONTACTS, INTEGRATORS, PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import Field
from physicslab.ecs.vector import Vector2
from physicslab.history import SetPhysics, SetSimulation
from physicslab.integrators import Integrator
from physicslab.languages.sentence import Sentence
from physicslab.theme import Colour, Theme
from physicslab.view.canvas.quantities import quantity, round_quantity, without_rounding
from physicslab.view.controls.actions import gravity_in_words, has_gravity
from physicslab.view.controls.drawn import Drawn
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.desk import LEVELS
from physicslab.view.window.edits import Recipe
from physicslab.view.window.materials import UNSPECIFIED
from physicslab.view.window.window import Window
from physicslab.view.workbench.figures import Line, WorldFigures
from physicslab.view.workbench.number_field import NumberFields
from physicslab.world import World

# ---- energies ----------------------------------------------------------------------------------------------


_VISIBLE = 1e-3
"""Share of the energy exchanged below which a flow is left out of the words; other levels have its figure."""
_SMALL = 1e-9
"""Share that is not worth a word, even where there is nothing else."""
_VERBS = {True: "Given", False: "Taken"}
_ZERO_TIP = (
    "The energy of gravity is zero at y = 0 and negative below, that of bodies which attract each other zero "
    "infinitely far apart, that of a spring zero at its rest length: here, in graphs and in files"
)
_ERROR_TIP = (
    "The change without a cause. It comes from computing in steps, not from physics: "
    "shorter steps make it smaller"
)
_COLOURS = {"impacts": 4, "friction": 5, "damping": 6, "contact": 2, "overlap": 3, "fields": 1, "motors": 0}
"""Which of the colours of bodies an account has; they can be told apart by the colour-blind, too."""
_PAINTS = {"edits": "kinematic", "hand": "held", "thrust": "planet", "joints": "rope"}
"""Which colour of the theme another account has."""
_BEYOND = 0.25
"""Share of what is below zero that bars have room for above it."""
_LABEL, _SPOT = 0.85, 0.26
"""Height of the names below the bar, and radius of the spots before them, in heights of the text."""
_NAMED = 0.01
"""Share of all that is shown from which a part has its name."""


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a bar: its name, its energy [J], which may be below zero, and its colour."""

    name: str
    energy: float
    colour: Colour


def _visible(figures: WorldFigures) -> list[tuple[str, float]]:
    """Return the flows that are a visible share of the energy, or else the largest that is no rounding."""
    audit = figures.audit
    found = [flow for flow in flows(audit.notable) if abs(audit.share(flow[1])) >= _SMALL]
    visible = [flow for flow in found if abs(audit.share(flow[1])) >= _VISIBLE]
    return visible or sorted(found, key=lambda flow: -abs(flow[1]))[:1]


def _named(name: str, figures: WorldFigures) -> str:
    if name != "hand":
        return ACCOUNT_WORDS[name]
    if figures.held:
        return "in the hand"
    return "hand, driven bodies" if figures.driven else "hand"


def flow_words(figures: WorldFigures) -> str:
    """Return in one line what gave energy and what took some since the accounts began."""
    words: dict[bool, list[str]] = {True: [], False: []}
    for name, value in _visible(figures):
        words[value > 0.0].append(f"{_named(name, figures)} {_short(abs(value))}")
    sides = (f"{verb}: {', '.join(words[gives])}" for gives, verb in _VERBS.items() if words[gives])
    return ". ".join(sides) or "Nothing gives or takes energy"


def _short(energy: float) -> str:
    """Return an energy to three figures."""
    if 1e-3 <= energy < 1e5:
        return f"{float(f'{energy:.3g}'):g} J"
    return quantity(energy, "J")


def parts_of(figures: WorldFigures, theme: Theme) -> tuple[list[Part], list[Part]]:
    """Return of what the energy came, and where it is: two lists whose sums differ by the error alone.

    The energy at the start and the potential energy have the zero that all figures have, and may be below it.
    """
    audit = figures.audit
    came = [Part("at the start", audit.account.start.energy, theme.faint)]
    went = [
        Part("kinetic", audit.latest.kinetic, theme.velocity),
        Part("potential", audit.latest.stored, theme.force),
    ]
    for name, value in flows(audit.notable):
        own = Part(_named(name, figures), abs(value), _colour(name, theme))
        (came if value > 0.0 else went).append(own)
    return came, went


def _colour(name: str, theme: Theme) -> Colour:
    """Return the colour of an account."""
    paint: Colour = theme.bodies[_COLOURS[name]] if name in _COLOURS else getattr(theme, _PAINTS[name])
    return paint


def build_energies(ui: Ui, figures: WorldFigures, *, error: bool) -> None:
    """Build the energies, bars of where they come from and are, and the ``error`` if that is wanted."""
    _build_sums(ui, figures)
    came, went = parts_of(figures, ui.theme)
    if any(part is not came[0] for part in _seen(came)):  # the start alone says nothing
        _build_bar(ui, "Where the energy came from", came)
    _build_bar(ui, "Where the energy is now", went)
    ui.faint(flow_words(figures))
    if error:
        ui.row("Error of the method", _rounded(figures.audit.account.energy["numerical"]), _ERROR_TIP)


def _build_sums(ui: Ui, figures: WorldFigures) -> None:
    """Build kinetic, potential and total energy, each as a bar from the line that is zero for all three."""
    energy, theme = figures.energy, ui.theme
    rows = [("Kinetic energy", energy.kinetic, theme.velocity, "")]
    if energy.potential:
        rows.append(("Potential energy", energy.stored, theme.force, _ZERO_TIP))
        rows.append(("Total energy", energy.total, theme.normal_impulse, ""))
    low, high = (limit(0.0, *(value for _, value, _, _ in rows)) for limit in (min, max))
    high = max(high, -_BEYOND * low)  # what is below zero is seen to be
    scale = max(high - low, 1e-300)
    for label, value, colour, tip in rows:
        ui.bar(label, figures.joules(value), value / scale, colour, zero=-low / scale, tip=tip)


def _rounded(energy: float) -> str:
    """Return an error: of one figure there is enough."""
    written = round_quantity if energy and math.isfinite(energy) else quantity
    return written(energy, "J")


def _build_bar(ui: Ui, title: str, parts: list[Part]) -> None:
    """Build a bar as wide as the panel, in parts as long as their energies, and their names below it.

    Parts below zero lie to the left of a line, the others to its right.
    """
    whole = sum(abs(part.energy) for part in parts)
    if whole == 0.0:
        return
    ui.faint(title, wrapped=False)
    width, height = imgui.get_content_region_avail().x, round(0.7 * ui.size)
    corner, paper = imgui.get_cursor_screen_pos(), imgui.get_window_draw_list()
    end = ImVec2(corner.x + width, corner.y + height)
    paper.add_rect_filled(corner, end, packed(ui.theme.key))
    if not 0.0 < whole < math.inf:
        parts = []
    left = corner.x
    for part in sorted(parts, key=lambda part: part.energy >= 0.0):
        long = abs(part.energy) / whole * width
        if long >= 1.0:
            high = left + max(long - 1.0, 1.0)
            paper.add_rect_filled(
                ImVec2(left, corner.y), ImVec2(high, corner.y + height), packed(part.colour)
            )
        left += long
    zero = corner.x + sum(max(-part.energy, 0.0) for part in parts) / whole * width
    if zero > corner.x:
        ui.zero_line(zero, corner.y, height)
    imgui.dummy(ImVec2(width, height))
    figures = [f"{part.name} {quantity(part.energy, 'J')}" for part in parts]
    ui.tip(". ".join(("; ".join(figures), _ZERO_TIP)))
    _write_names(ui, _seen(parts))


def _seen(parts: Sequence[Part]) -> list[Part]:
    """Return the parts that are large enough in their bar to have a name."""
    whole = sum(abs(part.energy) for part in parts)
    return [part for part in parts if abs(part.energy) >= _NAMED * whole]


def _write_names(ui: Ui, parts: Sequence[Part]) -> None:
    """Write the names of parts in lines, each after a spot of its colour."""
    imgui.push_font(None, _LABEL * ui.size)
    radius = _SPOT * ui.size
    for n, part in enumerate(parts):
        words = ui.said(part.name) if part.energy >= 0.0 else f"{ui.said(part.name)} < 0"
        needed = ui.width(words) + 3.5 * radius
        if n:
            imgui.same_line(spacing=0.7 * ui.size)
            if imgui.get_content_region_avail().x < needed:
                imgui.new_line()
        place = imgui.get_cursor_screen_pos()
        middle = ImVec2(place.x + radius, place.y + 0.55 * imgui.get_font_size())
        imgui.get_window_draw_list().add_circle_filled(middle, radius, packed(part.colour))
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + 3.0 * radius)
        ui.faint(words, wrapped=False)
    imgui.pop_font()


# ---- the panel ---------------------------------------------------------------------------------------------


_PLANETS = {"Earth": 9.81, "Moon": 1.62, "Mars": 3.71, "Jupiter": 24.79, "none": 0.0}
"""The pull of gravity at the surface [m/s^2]; NASA's planetary fact sheets."""


def build_levels(ui: Ui, window: Window) -> None:
    """Build the choice of how much is shown."""
    width = (imgui.get_content_region_avail().x - 2 * imgui.get_style().item_spacing.x) / len(LEVELS)
    for n, (name, tip) in enumerate(LEVELS.items()):
        if n:
            imgui.same_line()
        if ui.button(name, tip, on=window.level == name, size=(width, 0.0)):
            window.level = name
    ui.gap(0.15)


def build_world(ui: Ui, world: World, figures: WorldFigures, window: Window) -> None:
    """Build the part for everyone: its energies, its gravity."""
    build_energies(ui, figures, error=window.level == "Explore")
    if window.level == "Engineer":  # *Measure* has it with its parts
        momentum = without_rounding(figures.momentum.linear.magnitude, figures.scales["kg m/s"])
        ui.row("Total momentum", quantity(momentum, "kg m/s"))
    ui.gap(0.2)
    _build_gravity(ui, world, window)


def _build_gravity(ui: Ui, world: World, window: Window) -> None:
    if not has_gravity(world):
        ui.row("Gravity", gravity_in_words(world))
        return
    physics = world.physics
    if physics.gravity_mode == "planet":
        now = "between bodies"
    elif physics.gravity_mode == "none" or not physics.gravity:
        now = "none"
    else:
        down = physics.gravity == Vector2(0.0, physics.gravity.y)
        now = next((name for name, g in _PLANETS.items() if down and -physics.gravity.y == g), "custom")
    ui.lead("Gravity")
    chosen = ui.choice("Gravity", now, [*_PLANETS, "between bodies"], "Gravity: choose a planet")
    ui.rows["Gravity"] = gravity_in_words(world)
    if chosen != now:
        window.do_next(_pull, chosen)
    ui.faint(gravity_in_words(world))


def _pull(world: World, window: Window, name: str) -> None:
    """Choose what pulls, by its name in the list."""
    if name == "between bodies":
        window.edits.do(SetPhysics({"gravity_mode": "planet"}))
    elif name == "none":
        window.edits.do(SetPhysics({"gravity_mode": "none"}))
    else:
        gravity = Vector2(0.0, -_PLANETS[name])
        window.edits.do(SetPhysics({"gravity_mode": "linear", "gravity": gravity}))


_IN_BARS = ("Kinetic energy", "Potential energy", "Total energy")


def build_figures(ui: Ui, lines: Sequence[Line], *, after_bars: bool) -> None:
    """Build lines of figures as they are; ``after_bars`` leaves out the energies that the bars have."""
    for line, then in zip(lines, [*lines[1:], None], strict=False):
        if after_bars and line.label in _IN_BARS:
            if then is not None and then.kind == "detail":
                ui.faint(line.label, wrapped=False)
            continue
        match line.kind:
            case "heading":
                ui.gap(0.2)
                ui.heading(line.label)
                if line.value:
                    ui.faint(line.value)
            case "gap":
                ui.gap(0.3)
            case "remark":
                ui.faint(line.label)
            case _:
                ui.row(line.label, line.value, lesser=line.kind == "detail")


# ---- settings, and what the next body is like --------------------------------------------------------------


_SLEEPING = {"auto": "auto", "yes": True, "no": False}
_NUMBERS = {
    "dt": ("Step", "Length of a step; the error falls with it"), "substeps": ("Substeps", "Parts of a step"),
    "linear_damping": ("Damping", "Share of the velocity that is lost a second"),
    "angular_damping": ("Damping of turns", "Share of the spin that is lost a second"),
    "G": ("Gravity constant G", "How strongly bodies attract each other"),
    "softening": ("Softening", "Nearer than this attraction grows no more: bodies that meet do not stop"),
    "coulomb_constant": ("Coulomb constant", "How strongly charges act on each other"),
    "magnetic_field": ("Magnetic field", "Out of the plane where positive"),
}  # fmt: skip
_CHOICES = {
    "integrator": ("Method", INTEGRATORS), "collisions": ("Collisions", COLLISIONS),
    "contacts": ("Contacts", CONTACTS), "sleeping": ("Sleep", tuple(_SLEEPING)),
}  # fmt: skip
_ROWS = ("dt", "substeps", *_CHOICES, "linear_damping", "angular_damping")
_OF_PLANETS = ("G", "softening")
"""Fields added where bodies attract each other."""
_OF_CHARGES = ("coulomb_constant", "magnetic_field")
"""Fields added where anything is charged; the electric field, a vector, comes after it."""


def build_settings(ui: Ui, numbers: NumberFields, world: World, window: Window) -> None:
    """Build a row for each of the step, the method, collisions, contacts, sleep and damping."""
    ui.gap(0.2)
    ui.heading("Settings")
    charged, attracted = bool(len(world.batch(Charge))), world.physics.gravity_mode == "planet"
    for name in (*_ROWS, *(_OF_PLANETS if attracted else ()), *(_OF_CHARGES if charged else ())):
        held = world.simulation if hasattr(world.simulation, name) else world.physics
        now = getattr(held, name)
        if name in _NUMBERS:
            _build_number(ui, numbers, window, held, name)
            continue
        words, choices = _CHOICES[name]
        numbers.label(ui, name, words, Field(name, "choice"))
        now = next(word for word, value in _SLEEPING.items() if value == now) if name == "sleeping" else now
        chosen = ui.choice(words, now, choices)
        if chosen != now:
            window.do_next(_change, held, name, _SLEEPING[chosen] if name == "sleeping" else chosen)
        if name == "integrator":
            for plan in dict.fromkeys(world.plans):
                if now != plan.integrator.name:
                    method, why = plan.integrator.name, plan.reason
                    ui.faint(Sentence("{auto} takes {method}: {reason}", auto=now, method=method, reason=why))
                ui.faint(_cost(plan.integrator))
    if charged:
        _build_electric_field(ui, numbers, world, window)


def _cost(method: Integrator) -> str:
    """Return in words what a method costs, and what a shorter step gives."""
    many = "" if method.evaluations == 1 else "s"
    each = Sentence(f"{{n}} evaluation{many} of all forces a step", n=method.evaluations)
    if not method.evaluations:
        return "Solved in closed form: the step is only how often the motion is shown."
    if method.chooses_steps:
        return Sentence(
            "It costs at least {evaluations}, and divides steps until it keeps to the tolerance.",
            evaluations=each,
        )
    return Sentence(
        "It costs {evaluations}; half of it takes twice the time and leaves 1/{share} of the error. {energy}",
        evaluations=each, share=2**method.order,
        energy=Sentence("Energy does not drift." if method.symplectic else "Energy drifts."),
    )  # fmt: skip


def _build_electric_field(ui: Ui, numbers: NumberFields, world: World, window: Window) -> None:
    held, name = world.physics, "electric_field"
    spec = next(field for field in held.FIELDS if field.name == name)

    def commit(axis: int, new: float) -> None:
        spec.check((new, new))
        x, y = held.electric_field
        window.do_next(_change, held, name, Vector2(new, y) if axis == 0 else Vector2(x, new))

    numbers.vector_row(
        ui, name, "Electric field", spec, (held.electric_field.x, held.electric_field.y), commit
    )


def _build_number(
    ui: Ui, numbers: NumberFields, window: Window, held: PhysicsConfig | SimulationConfig, name: str
) -> None:
    words, tip = _NUMBERS[name]
    spec = replace(next(field for field in held.FIELDS if field.name == name), meaning=tip)

    def commit(new: float) -> None:
        spec.check(new)
        window.do_next(_change, held, name, new)

    numbers.row(ui, name, words, spec, getattr(held, name), commit, drags=False)


def _change(
    world: World, window: Window, held: PhysicsConfig | SimulationConfig, name: str, value: object
) -> None:
    """Change one setting; where it is refused, nothing is changed, and the reason is shown."""
    command = SetPhysics if isinstance(held, PhysicsConfig) else SetSimulation
    window.edits.do(command({name: value}))


_MADE_OF = Field("material", "choice", meaning="sets density, restitution, friction and colour")
_ZERO = {"size": "in turn"}
"""Words for a 0 that is no number: sizes that differ from one body to the next."""


def build_recipe(ui: Ui, numbers: NumberFields, drawn: Drawn, window: Window) -> None:
    """Build a row for each property that what is drawn next has by the recipe, under its title."""
    ui.rule(0.2)
    ui.heading(f"Next {drawn.title.split()[-1].lower()}")
    has = {"size": bool(drawn.per_size) or drawn.pours, "density": not drawn.is_fixed}
    numbers.label(ui, "new material", "Made of", _MADE_OF)
    now = window.recipe.material or UNSPECIFIED
    if (chosen := ui.choice("new material", now, (*SUBSTANCES, UNSPECIFIED))) != now:
        window.do_next(lambda _, window: window.put("recipe", window.recipe.of(chosen)))
    for spec in Recipe.FIELDS:
        if not has.get(spec.name, True):
            continue

        def commit(new: float, spec: Field = spec) -> None:
            spec.check(new)
            changed = replace(window.recipe, **{spec.name: new})  # type: ignore[arg-type]
            window.do_next(lambda _, window: window.put("recipe", changed))

        zero, value = _ZERO.get(spec.name, ""), getattr(window.recipe, spec.name)
        if zero and window.tool in window.sketch.ways:
            zero = "as drawn last"
        numbers.row(ui, f"new {spec.name}", spec.name.capitalize(), spec, value, commit, zero=zero)
