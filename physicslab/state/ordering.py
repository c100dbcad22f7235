"""An order in which what is coupled is near: matrices of it are banded."""


def cuthill_mckee(neighbours: dict[int, set[int]]) -> list[int]:
    """Return the nodes in breadth-first order from a node of few neighbours.

    Cuthill & McKee, Proc. 24th National Conference of the ACM, 1969, 157.
    """
    chain: list[int] = []
    seen: set[int] = set()
    for start in sorted(neighbours, key=lambda node: (len(neighbours[node]), node)):
        if start in seen:
            continue
        seen.add(start)
        layer = [start]
        while layer:
            chain += layer
            following: list[int] = []
            for node in layer:
                fresh = neighbours[node] - seen
                following += sorted(fresh, key=lambda other: (len(neighbours[other]), other))
                seen |= fresh
            layer = following
    return chain
