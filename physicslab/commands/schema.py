"""Write the JSON Schema of scene files, by which editors complete and check them."""

from argparse import Namespace

from physicslab.commands.output import Output
from physicslab.files.json_text import json_bytes
from physicslab.files.schema import scene_schema


def execute(arguments: Namespace) -> int:
    """Write it."""
    Output("--out", arguments.out).write(json_bytes(scene_schema()))
    return 0
