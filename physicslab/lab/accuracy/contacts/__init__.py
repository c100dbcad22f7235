"""The second page of the accuracy lab: what rests, slides, rolls, topples and strikes."""
