"""List the built-in scenes: name, number of bodies and description."""

from argparse import Namespace

from physicslab.commands.output import JsonOutput
from physicslab.components import Transform
from physicslab.scenes import SCENES


def execute(arguments: Namespace) -> int:
    """Print a line for each scene, or write them as JSON."""
    output = JsonOutput(arguments.json)
    rows = [
        {
            "name": scene.name,
            "title": scene.title,
            "bodies": len(scene.contents().batch(Transform)),
            "description": scene.description,
        }
        for scene in SCENES.values()
    ]
    output.write({"scenes": rows})
    if output.leaves_stdout:
        width = max(len(name) for name in SCENES)
        for row in rows:
            print(f"{row['name']:<{width}}  {row['bodies']:>5}  {row['description']}")
    return 0
