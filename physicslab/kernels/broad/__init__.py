"""Which bodies are near each other."""
