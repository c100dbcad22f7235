"""Every problem, in one explicit list; and reference problems that the engine cannot compute, and why."""

from physicslab.lab.accuracy.andrews import ANDREWS
from physicslab.lab.accuracy.forces import ATTRACTED, FIELDS
from physicslab.lab.accuracy.joints import JOINED, LIMITED
from physicslab.lab.accuracy.points import POINTS
from physicslab.lab.accuracy.touching import FRICTION, IMPACTS
from physicslab.lab.case import Catalogue

PROBLEMS = Catalogue((*POINTS, *FIELDS, *JOINED, ANDREWS, *LIMITED, *ATTRACTED, *IMPACTS, *FRICTION))
"""Every problem by name, from the simplest on; families are those of one source."""

LEFT_OUT = {
    "plummer100": "its figures do not contain the hundred places it starts from; see crowd100",
    "galperin_n5": "314,159 collisions, of which only the number is on record",
}
"""Reference problems that are not among these, by name, and why."""
