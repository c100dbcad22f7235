"""Where a vertex is what is nearest of a core: between the normals of both faces that meet there."""

from physicslab.kernels import inlined
from physicslab.kernels.geometry.shapes import Shapes, face


@inlined
def beside_vertex(shapes: Shapes, row: int, k: int, x: float, y: float) -> tuple[float, float]:
    """Return how far a place is beyond both faces that meet at vertex k of a row, along each [m].

    The place is seen from the vertex, in the body's own directions [m]. Where both are positive, the vertex
    is what is nearest to it.
    """
    count = shapes.vertices[row]
    before_x, before_y, _, _ = face(shapes, row, (k + count - 1) % count)
    after_x, after_y, _, _ = face(shapes, row, k)
    return before_x * y - before_y * x, after_y * x - after_x * y
