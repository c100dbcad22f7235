"""What is near, what touches, and with what impulse: shared by the systems that find, resolve and show contacts."""


class Contacts:
    """(In the making.)

    Attributes that others may rely on:
    candidate_pairs: int  pairs that the broad phase found near each other
    count: int            pairs that touch
    max_penetration: float  deepest overlap now [m]
    """

    def __init__(self) -> None:
        self.candidate_pairs = 0
        self.count = 0
        self.max_penetration = 0.0
