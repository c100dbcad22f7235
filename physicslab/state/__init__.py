"""The state of a world: arrays and their invariants."""
