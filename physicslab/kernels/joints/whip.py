"""How fast bodies turn about the anchors of joints, where light ones hold heavy ones."""

import math

from physicslab.kernels import Numbers, kernel
from physicslab.kernels.joints.blocks import ENDS, FIRST, TERM, TERMS, Joints, JointsTuple


@kernel
def fastest_whip(plain: JointsTuple, angular: Numbers, inverse_mass: Numbers, unequal: float) -> float:
    """Return the largest r w^2 / R [1/s^2] of bodies that turn by w about an anchor at r.

    R is the longer of the two arms of the joint. Blocks whose masses differ by no more than ``unequal`` times
    are left out.
    """
    joints, largest = Joints(*plain), 0.0
    nodes, terms, body = joints.nodes, joints.terms, joints.body
    for block in range(len(joints.groups) - 1):
        first, end = joints.groups[block, FIRST], joints.groups[block + 1, FIRST]
        lightest, heaviest = 0.0, math.inf
        for e in range(nodes[first, ENDS], nodes[end, ENDS]):
            inverse = inverse_mass[body[e]]
            if inverse > 0.0:
                lightest, heaviest = max(lightest, inverse), min(heaviest, inverse)
        if lightest <= unequal * heaviest:
            continue
        fastest = 0.0
        for t in range(nodes[first, TERMS], nodes[end, TERMS]):
            n = terms[t, TERM]
            a, b = angular[joints.a[n]], angular[joints.b[n]]
            arm_a = math.hypot(joints.anchor_a[n, 0], joints.anchor_a[n, 1])
            arm_b = math.hypot(joints.anchor_b[n, 0], joints.anchor_b[n, 1])
            arm = max(arm_a, arm_b)
            if arm > 0.0:
                fastest = max(fastest, (arm_a * a * a + arm_b * b * b) / arm)
        largest = max(largest, fastest)
    return largest
