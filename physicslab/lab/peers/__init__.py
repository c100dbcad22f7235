"""A world's scene in other engines, to compare with: pymunk and Box2D, which need not be installed."""
