"""Turn a world of KDE Step into a scene file, and name what it leaves out."""

from argparse import Namespace
from pathlib import Path

from physicslab.commands import FAILED, CommandError
from physicslab.commands.opening import tell_losses
from physicslab.commands.output import Output
from physicslab.ecs.text import printable, shortened
from physicslab.files.replace import create_file, reason_of
from physicslab.files.scene import is_step, load_scene, scene_bytes


def execute(arguments: Namespace) -> int:
    """Write the scene to a new file; on stderr a line for each thing that is not taken."""
    label = shortened(printable(arguments.file), 200)
    if not is_step(arguments.file):
        raise CommandError(f"{label}: must be a world of KDE Step, whose name ends in .step")
    out = arguments.out or str(Path(arguments.file).with_suffix(".json"))
    output = Output("--out", out)
    losses: list[str] = []
    world = load_scene(arguments.file, losses)
    content = scene_bytes(world, out)
    if output.to_stdout:
        output.write(content)
    else:
        try:
            create_file(Path(out), content)
        except FileExistsError as error:
            raise CommandError(f"{printable(out)}: is there already; --out names another file") from error
        except OSError as error:
            raise CommandError(f"{printable(out)}: cannot be written: {reason_of(error)}", FAILED) from error
        print(f"{printable(out)}: entities: {len(world.entities())}; not taken: {len(losses)}")
    tell_losses(losses)
    return 0
