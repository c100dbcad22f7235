"""What graphs and meters show: names, units and values of quantities."""

import math
from pathlib import Path

import pytest
from desk import empty_world

from physicslab.commands.numbers import __doc__ as _  # noqa: F401
