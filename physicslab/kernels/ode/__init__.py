"""Methods that integrate ordinary differential equations."""
