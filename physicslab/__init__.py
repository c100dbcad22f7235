"""PhysicsLab."""
