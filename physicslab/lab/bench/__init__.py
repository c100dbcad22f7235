"""Speed: scenes, how long their steps take here and in other engines, and what comes of them."""
