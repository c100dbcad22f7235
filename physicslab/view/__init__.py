"""Drawing and controls of the window; some modules import pygame, the others must not."""

import os

# Or pygame would greet the user on stdout, where a report may be.
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
