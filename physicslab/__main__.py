"""``python -m physicslab`` is the installed command, and the script of archives and frozen programs."""

import sys
from multiprocessing import freeze_support

from physicslab.cli import main

if __name__ == "__main__":
    freeze_support()  # a frozen program is also what its worker processes run
    sys.exit(main())
