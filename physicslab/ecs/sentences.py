"""The sentences of the engine: why it does what it does, and what would help; each by its code.

A reason is made of its code and the values of its gaps; ``run --json`` has the words below, and beside
them code and values; a window says it in its language.
"""

from collections.abc import Iterable
from functools import reduce

from physicslab.languages.sentence import Sentence

SENTENCES = {
    "everything_sleeps": "everything sleeps",
    "stays_awake": "bodies do not fall asleep",
    "other_method_asked": "{method} was asked for, and between impacts bodies move in closed form",
    "damped": "velocities are damped",
    "held": "a body is held",
    "nowhere": "something moves that is nowhere",
    "turns": "{body} is a {shape} that may turn (Mass.fixed_rotation would keep it as it is)",
    "many_pairs": "more than {limit} pairs may meet",
    "many_bodies": "more than {limit} bodies move",
    "no_bounce": "some pairs do not bounce",
    "lying_on_each_other": "bodies rest on each other",
    "everything_rests": "everything rests",
    "system_absent_for_rest": "{system} is not among the systems, which moves what rests",
    "joined": "joints hold bodies together, which are left to rigid contacts",
    "attraction": "bodies attract each other",
    "not_uniform": "the force of {system} is no uniform acceleration",
    "acts_within_step": "{system} acts within the step",
    "soft_before": "soft contacts were chosen before the scene was saved",
    "sleeping_asked": "sleeping was asked for, and with rigid contacts nothing sleeps",
    "within_steps_asked": "collisions within steps were asked for, and rigid contacts locate them",
    "many_touch": "more than {limit} bodies can touch",
    "fast_forces": "forces act at {rate} rad/s, which rigid contacts would follow in many steps",
    "other_method_than_rigid": "{method} was asked for, and rigid contacts go by dop853",
    "asked_for": "asked for",
    "rigid_refused": "rigid was asked for, and {obstacle}",
    "few_touch": "few bodies touch",
    "joint_events": "{joint}: its events are located in time",
    "system_absent": "{system} is not among the systems",
    "one_island": "an island itself",
    "islands": "{count} islands are too far apart to meet, and no force couples them",
    "came_near": "bodies came near each other",
    "nothing_integrates": "nothing moves the bodies",
    "contact_systems_absent": "the systems for contacts are not all there",
    "drag_on_held": "drag acts on a body that is held",
    "couples_all": "{system} acts between all bodies",
    "couples_driven": "{system} acts between bodies that move at given speeds",
    "one_body": "at most one body moves",
    "all_near": "all bodies that move are near each other, or coupled",
    "many_islands": "more than {limit} islands would cost more than one",
    "large_islands": "islands of more than {limit} bodies are advanced together",
    "costly_islands": "rigid contacts in all islands would take longer than in one of {limit} bodies",
    "islands_all_soft": "with soft contacts islands are advanced together",
    "joints_without_end": (
        "joints hold bodies by forces that grow without limit, or from one event to the next"
    ),
    "events_without_end": "rigid contacts lead from one event to the next without end",
    "nothing_touches": "nothing can touch",
    "jumps_in_python": "the force of {system} has no compiled kernel, and jumps",
    "chosen_before": "{method} was chosen before the scene was saved",
    "closed_form_between_impacts": "between impacts bodies move in closed form",
    "beside_contacts": "{obstacle}; between contacts {bodies} move by {method}: {how}",
    "joint_equations": "joints hold bodies; their equations ({count}) are solved with those of the motion",
    "too_fast": "{rate} rad/s is too fast to be followed: the motion between steps is lost",
    "own_events": "rigid contacts locate their own events",
    "few_bounce": "few bodies, which bounce",
    "forces_alone": "{method} was asked for, which advances bodies under forces alone, and {obstacle}",
    "velocity_may_matter_in_python": (
        "the force of {system} has no compiled kernel, and forces may depend on velocities"
    ),
    "in_python": "the force of {system} has no compiled kernel",
    "molecules": "{count} molecules: symplectic; {steps} steps of omega h = {phase}",
    "tolerance": "tolerance {value}",
    "by_places_and_time": "smooth, and go by places and the time",
    "all_bodies": "all bodies",
    "sprung_bodies": "bodies with springs or drag",
    "can_touch": "bodies can touch",
    "nothing_moves": "nothing moves",
    "joint_limits": "joints have limits: the step follows events",
    "exact_refused": "exact was asked for, and {obstacle}",
    "closed_form": "{forces}: solved in closed form",
    "softened": "{count} bodies attract each other, softened",
    "step_follows": "{why}: the step follows them",
    "velocity_forces": "forces depend on velocities, and {why}; {tolerance}",
    "step_follows_it": "{why}: the step follows it",
    "rigid_events": "contacts are rigid: the step follows events",
    "no_closed_form": "exact was asked for, and there is no closed form: {why}",
    "conservative": "conservative and smooth",
    "and_in_python": "{obstacle}, and the force of {system} has no compiled kernel",
    "velocity_in_python": "the force of {system} has no compiled kernel, and forces depend on velocities",
    "resolved_springs": "steps of omega h = {phase}, and {method} where springs turn fast",
    "beyond": "{method} for the rest: {why}",
    "both": "{one}; {other}",
    "magnetic": "the magnetic field turns velocities exactly; steps of omega h = {phase}",
    "many_molecules": "many molecules; {steps} steps of omega h = {phase}",
    "follows_motion": "the step follows the motion",
    "many_followed": "many bodies; steps of omega h = {phase}",
    "resolved": "steps of omega h = {phase}",
    "contradiction": "joints did not close: they contradict each other or a limit, or pull a light body hard",
    "no_forces": "no contact forces keep all laws (Painleve's paradox, or bodies that are jammed)",
    "unresolved": "an impact has no solution",
    "many_points": "more than {limit} points touch",
    "stalled": "events follow each other almost without time between them",
    "segment_not_finite": "a segment of motion is not finite",
    "too_fast_for_short_steps": "bodies are too fast for short steps",
    "squares_not_finite": "squares of speeds or accelerations are not finite",
    "three_bodies": "a limit or a motor acts on more than two bodies",
    "compiled_contacts": "bodies can touch, and nothing looks at substeps",
    "planets": "planets attract each other",
    "motion_damped": "motion is damped",
    "drag_held": "drag acts on what a spring holds",
    "acts": "{system} acts",
    "way_booked": "the work of a force along the way of bodies is booked",
    "system_by_system": "nothing can touch, so that each system is called by itself",
    "computed_in_python": "the force of {system} is computed in Python",
    "sub_integrated": "what springs and drag act on is sub-integrated",
    "mass_too_small": "a mass is too small for its inverse to be a number",
    "quadratic_drag": "there is quadratic drag",
    "off_line": "{body} does not stay on the line of its springs",
    "force_without_closed_form": "the force of {system} has no closed form",
    "joins_two": "the spring of {body} joins two bodies that move",
    "driven_on_spring": "the spring of {body} pulls a body that moves at a given speed",
    "turned_by_spring": "the spring of {body} holds its body beside the middle, and turns it",
    "through_end": "{body} may swing through the fixed end of its spring",
    "overlap": "bodies overlap by {share} of their size",
    "joints_overlap": "bodies overlap, or are beyond what joints allow, by {share} of their size",
    "all_joined": "all pairs that could meet are on joints, and pass through each other",
    "joined_or_in_layers": (
        "all pairs that could meet are on joints, or in layers that do not touch, and pass through each other"
    ),
    "about": "{entity}: {what}",
    "figure": "{what}: {figure}",
    "figure_and_limit": "{what}: {figure}, well up to {limit}",
    "because": "{what}, as {because}",
    "would_help": "{what}; {setting} would help",
    "no_help": "{what}; no setting is known to help",
    "no_breaking": "no joint that breaks",
    "moved_by_hand": "no joint holds what is in the hand",
    "no_shape": "no Shape in the scene",
    "shapes_stay": "nothing that has a Shape moves",
    "one_shape": "only one Shape in the scene, and no bounds",
    "no_electric_field": "electric_field is 0",
    "no_magnetic_field": "magnetic_field is 0",
    "charges_close": "charges may come close",
    "no_coulomb_constant": "coulomb_constant is 0",
    "few_charges": "fewer than two charges act on each other",
    "gravity_off": "gravity is switched off",
    "no_moving_mass": "nothing that moves has Mass",
    "gravity_zero": "gravity is zero",
    "few_attract": "fewer than two bodies attract each other",
    "no_constant_of_gravity": "G is 0",
    "planets_close": "planets may come close",
    "no_component": "no {components} in the scene",
    "into_medium": "bodies may come into a medium",
    "nothing_in_medium": "nothing that has a Shape moves in the medium",
    "molecules_collide": "molecules collide",
    "few_molecules": "fewer than two molecules act on each other",
    "no_molecule_moves": "no molecule moves",
    "sleeping_off": "sleeping is switched off",
    "charges": "charges act on each other",
    "impacts_located": "impacts are located exactly",
    "few_awake": "at most {limit} bodies can move: simulating them costs little",
    "compressed_to_nothing": "a spring may be pressed together to nothing",
    "thrust_turns": "a thrust turns with its body",
    "joint_limit": "a {joint} has a limit, or a motor that may stall",
    "energy_from_nowhere": "press on each other, and contacts have given energy that comes from nowhere",
    "and_lost_by_now": "{why}; {energy} J of the energy is an error by now",
    "moved_apart": "energy was added by moving bodies apart that overlapped",
    "energetic_impacts": (
        "impacts obey Stronge's law (the normal force gives back e^2 of the work of the "
        "approach), as Newton's with friction would have made energy"
    ),
    "lowered_restitution": (
        "impacts of several points at once have a lower restitution, as Newton's law with "
        "friction would have made energy"
    ),
    "divided": "steps are longer than the scene's, and are divided into so many",
    "far_away": "is so far from the origin that its contacts cannot be resolved",
    "pressed_in": "is pressed into another body deeper than contacts can hold",
    "unlike_masses": "masses that differ less",
    "chain_turned": "vertices of a chain in the other order, if bodies come from its left, which is solid,",
    "no_overlap_at_start": "bodies that do not overlap at the start",
    "or_smaller_dt": "{setting}, or a smaller simulation.dt",
    "mass_ratio": "carries a body so much heavier that contacts cannot hold it (mass ratio)",
    "welded_on": "has a body welded on that is so much heavier that contacts cannot carry it (mass ratio)",
    "passes_sizes": "passes so many sizes of a body in a substep that impacts after the first may be missed",
    "turns_far": "turns so far in a substep that its corners may hit anywhere",
    "falls_far": (
        "gravity carries bodies so many sizes of the smallest in a substep that they may pass others"
    ),
    "smaller_dt": "a smaller simulation.dt",
    "left_to_soft": "steps were left to soft contacts",
    "by_impulses": "steps were made by impulses in 32 parts, an error of order one",
    "nearer_origin": "a place nearer to the origin",
    "shorter_step": "a shorter step",
    "storm": "is part of a storm of impacts: so many follow each other within a step",
    "step_takes_long": "a step takes long: {why}",
    "slow_step": "the step to t = {time} s took {seconds} s: {why} ({figures})",
    "impacts_made": "{count} impacts",
    "evaluations": "{count} force evaluations",
    "evaluations_by": "{count} force evaluations by {method}",
    "size_of_step": "{bodies} entities, {pairs} near pairs, {substeps} substeps",
    "at_time": "at t = {time} s: {what}",
    "after_time": "{what} (after t = {time} s)",
    "not_finite": "{body}: {component} is no longer finite at t = {time} s; {help}",
    "too_far": "{body}: {component} is beyond {limit} m at t = {time} s; {help}",
    "smaller_steps_may_help": "a smaller dt or more substeps may help",
    "velocity_changes_fast": "{body}: Velocity changes too fast: {why}",
    "falls_into": (
        "{body} falls into {other}, and the pull between points grows without limit: "
        "physics.softening > 0 keeps it finite"
    ),
    "forces_not_finite": "forces are no longer finite at t = {time} s",
    "evaluations_exhausted": (
        "{most} force evaluations do not make a step of {step} s at a tolerance of {tolerance}; a larger "
        "tolerance, a smaller dt or the integrator implicit_midpoint may help"
    ),
    "no_step_short_enough": (
        "no step is short enough for a tolerance of {tolerance}: a force changes at once, as where "
        "planets meet (softening > 0 keeps it finite), or a spring has no length or is too stiff"
    ),
    "implicit_unsolved": "no part of the implicit step of {step} s has a solution; more substeps may help",
    "forces_without_limit": "joints hold bodies by forces that grow without limit",
    "event_to_event": "rigid contacts go from one event to the next",
    "much_to_compute": "there is much to compute",
    "fewer": "fewer bodies or substeps",
    "impact_after_impact": "one impact follows another",
    "shorter_dt": "a shorter dt",
    "larger_tolerance": "a larger simulation.tolerance",
    "forces_change_fast": "forces change so fast that it is divided into many",
    "smaller_dt_or_fewer": "a smaller simulation.dt, or fewer bodies",
    "soft_contacts": (
        "contacts are soft; a stack that barely stands may fall, and contacts are off by about so much"
    ),
    "undetermined": (
        "collide at one moment: momentum, restitution and friction leave open how more than two share the "
        "impulse; here all act at once, and a tiny difference in time may change the outcome (moments)"
    ),
    "light_to_turn": "turns too easily for its joints to be solved with all digits (mass * arm^2 / inertia)",
    "idle_joint": "joins what no force moves, and does nothing",
    "contradicts": "contradicts other joints: not all can be kept",
    "does_not_hold": "does not hold what it joins",
    "soft_joints": "gives a little, as joints are soft; what they hold is off by about so much",
    "gives_way": "gives way as a spring does: more joints hold each other than are solved at once",
    "bounces_alone": "bounces as if without its joints, which take the energy that this leaves along them",
    "redundant": "holds what other joints hold already: how they share the load is not determined (rows)",
    "blocked_motor": "has a motor that does nothing, as other joints hold what it would move",
    "mass_at_one_end": "a Mass and a Velocity at one end",
    "ends_in_one_place": "has both ends in one place, where a distance has no direction",
    "one_joint_less": "one joint less",
    "fewer_joints": "fewer joints in one piece",
    "a_pin": "a Pin",
    "many_evaluations": (
        "force evaluations are made in a step: something is followed that is too fast to be seen"
    ),
    "lost_phase": "oscillates out of phase by now, by the error of the method",
    "not_followed": "is too fast to be followed (omega h): its motion between steps is not shown",
    "order_one": "{force}: {method} has order 1 where a force depends on velocities",
    "flies_apart": "is too stiff for the step (omega h): it flies apart",
    "coarse": "is resolved coarsely (omega h): its energy swings",
    "idle_charge": "has a Charge on which no field acts, as all constants and fields of charges are 0",
    "idle_thrust": "has a Thrust that moves nothing: a body with Mass and Velocity would be pushed",
    "one_place": "is in the place of another body: {law} has no direction there, and leaves the two out",
    "law_of_gravity": "gravity",
    "coulomb": "Coulomb's law",
    "molecule_force": "the force of molecules",
    "apart": "places apart",
    "apart_or_softened": "places apart, or physics.softening > 0,",
    "velocity_and_mass": "a Velocity and a Mass",
    "too_near": "{body} is nearer than numbers tell",
    "steps_of": "{why}; {steps} steps of omega h = {phase}",
    "charges_alone": "charges",
    "attraction_of_two": "attraction between two bodies",
    "uniform_gravity": "uniform gravity",
    "anchored_springs": "springs to fixed points",
    "linear_drag": "linear drag",
    "no_force": "no force alone",
    "and": "{one} and {other}",
    "or": "{one} or {other}",
    "forces_alone_act": "{forces} alone",
}
"""English words by codes, gaps as ``{name}``; codes do not change where words do."""


def sentence(code: str, /, **values: object) -> Sentence:
    """Return the sentence of a code, its gaps filled.

    Raises
    ------
    KeyError
        If there is no such code, or a gap has no value.

    >>> sentence("many_bodies", limit=32)
    'more than 32 bodies move'
    """
    return Sentence(SENTENCES[code], code, **values)


def listed(code: str, parts: Iterable[str]) -> str:
    """Return names or sentences in a row, by the sentence of two: ``"and"``, ``"or"`` or ``"both"``.

    >>> listed("or", ["Rod", "Rope", "Pin"])
    'Rod or Rope or Pin'
    """
    return reduce(lambda one, other: sentence(code, one=one, other=other), parts)
