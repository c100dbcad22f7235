"""Joints: their measures and the forces that hold them, in smooth motion and beside contacts."""
