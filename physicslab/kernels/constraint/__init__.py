"""Constraints between two bodies: the algebra of a pair, and the law of impact."""
