"""What a world holds: arrays and what must be true of them."""
