"""Stiff, extreme and hostile cases: what is right, the limit, and what the engine makes of each."""
