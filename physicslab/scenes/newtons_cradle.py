"""Five balls on strings, in a row."""

from physicslab.ecs.config import SimulationConfig
from physicslab.prefabs import pendulum
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_RADIUS = 0.25
_GAP = 1e-4


@Scene(
    title="Newton's cradle",
    description="One ball goes in and one comes out: momentum and energy together leave no other way.",
    view=(-3.2, 0.4, 3.2, 4.2),
    moment=0.8,
    teaches=("momentum", "energy", "collisions"),
    tags=("springs", "solid bodies"),
    # The strings are springs of 224 rad/s, which eight substeps follow closely.
    simulation=SimulationConfig(substeps=8),
)
def newtons_cradle(world: Contents) -> None:
    for i in range(5):
        pendulum(
            world, ((i - 2) * (2.0 * _RADIUS + _GAP), 4.0), length=3.0, angle=-0.6 if i == 0 else 0.0,
            radius=_RADIUS, stiffness=50_000.0, damping=20.0, restitution=1.0, friction=0.0,
            name=f"ball {i + 1}",
        )  # fmt: skip
