"""PhysicsLab: ``python main.py`` opens the sandbox; ``python main.py --help`` says what else there is."""

import sys

from physicslab.cli import main

if __name__ == "__main__":
    sys.exit(main())
