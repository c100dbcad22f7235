"""Operations on contacts: listing pairs, wide constraints, waking sleeping bodies, reports."""
