# /// script
# requires-python = ">=3.12"
# dependencies = ["physicslab"]
#
# [tool.uv.sources]
# physicslab = { path = ".", editable = true }
# ///
"""PhysicsLab: ``python main.py`` opens the sandbox; ``python main.py --help`` says what else there is."""

import sys

from physicslab.cli import main

if __name__ == "__main__":
    sys.exit(main())
