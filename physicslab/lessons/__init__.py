"""Lessons: read, run beside their theory, graded. The format is in ``docs/lessons.md``."""
