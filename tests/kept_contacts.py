"""Contacts as a file would keep them."""

from physicslab.contacts.memory import kept_rows
from physicslab.state.contacts import Contacts


def kept_contacts(contacts: Contacts) -> list[list[float]]:
    """Return the rows of all pairs of which something is kept."""
    contacts.sync()
    return [row for row in kept_rows(contacts) if row is not None]
