"""Islands at rest, and what wakes them."""
