"""Speed: scenes, and how long their steps take here and in other engines, with figures of quality."""
