"""The ways to advance a state by a step."""
