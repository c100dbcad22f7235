"""Two balls on runs that end in a loop: one is fast enough for it."""

import math

from physicslab.prefabs import box, circle, loop
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_RADIUS, _BALL, _RUN = 1.0, 0.1, 2.5
"""Radii of the loops and of the balls, and length of the runs [m]."""


@Scene(
    title="Loop the loop",
    description="Balls without friction at 0.9 and 1.02 times the least speed, which is the root of 5 g r.",
    view=(-5.4, -0.6, 4.0, 2.6),
    moment=1.2,
    teaches=("circular motion", "energy"),
    tags=("solid bodies",),
    also="roller coaster",
)
def loop_the_loop(world: Contents) -> None:
    least = math.sqrt(5.0 * 9.81 * (_RADIUS - _BALL))
    for name, x, share in (("too slow", -2.4, 0.9), ("fast enough", 2.4, 1.02)):
        loop(world, (x, 0.0), radius=_RADIUS, run=_RUN, segments=72, friction=0.0, name=f"loop, {name}")
        box(world, (x - _RUN - 0.1, 0.4), width=0.2, height=1.2, static=True)
        start = x - _RUN + 0.3, _BALL
        circle(world, start, radius=_BALL, velocity=(share * least, 0.0), friction=0.0, name=name)
