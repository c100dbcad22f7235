"""``python -m physicslab`` is the installed command."""

import sys

from physicslab.cli import main

if __name__ == "__main__":
    sys.exit(main())
