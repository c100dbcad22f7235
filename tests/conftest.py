"""What every test module shares."""

from hypothesis import settings

# No deadline: the first example of a test may load kernels.
settings.register_profile("physicslab", deadline=None, max_examples=40)
settings.load_profile("physicslab")
