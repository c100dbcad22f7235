"""List the built-in scenes: name, number of bodies and description."""

from argparse import Namespace

from physicslab.commands.output import Output
from physicslab.components import Transform
from physicslab.files.json_text import json_bytes
from physicslab.scenes import SCENES


def execute(arguments: Namespace) -> int:
    """Print a line for each scene, or write them as JSON."""
    output = None if arguments.json is None else Output("--json", arguments.json)
    rows = [
        {
            "name": scene.name,
            "title": scene.title,
            "bodies": len(scene.contents().batch(Transform)),
            "description": scene.description,
        }
        for scene in SCENES.values()
    ]
    if output is not None:
        output.write(json_bytes({"scenes": rows}))
    if output is None or not output.to_stdout:
        width = max(len(name) for name in SCENES)
        for row in rows:
            print(f"{row['name']:<{width}}  {row['bodies']:>5}  {row['description']}")
    return 0
