"""Problems with known answers, and what error each method makes on them for how much work."""
