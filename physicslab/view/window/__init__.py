"""The state of the window, which the systems of a frame share: clock, hand, view, messages."""
