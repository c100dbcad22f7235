"""Which bodies a body touches."""

from physicslab.ecs.component import Component, component, field

OWN, OTHERS, NONE = "own", "others", "none"


@component
class Layer(Component):
    """Puts a body into a layer, and says which others it touches. A body without touches all that touch it.

    Two bodies touch if each touches the layer of the other. The bounds hold every body.
    """

    number: int = field(default=1, minimum=1, maximum=99, fixed=True, meaning="the layer that it is in")
    touches: str = field(
        default=OWN, choices=(OWN, OTHERS, NONE), fixed=True,
        meaning="bodies of its own layer and those without one; or of all layers but its own; or none",
    )  # fmt: skip
