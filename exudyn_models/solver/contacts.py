"""The friction contacts of a model.

They are stored in ``mbs.sys`` by the names of their connectors, because objects can be deleted and ``mbs.Reset``
starts their numbers again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from exudyn_models.forces.axial_pairs import AxialStick
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.slip_kinematics import Kinds
from exudyn_models.forces.stick_dampers import StickDampers
from reference_model.systems import FloatArray

_CONTACTS = "friction contacts"


@dataclass(eq=False)
class Contact:
    """Friction contact between two nodes with ``reference`` coordinates, shape (n,).

    ``functions`` contains its "force" and "jacobian". ``stick`` is None if the contact is regularised. ``built_in``
    contacts are objects ``ObjectConnectorCoordinateSpringDamperExt``.
    """

    kinds: Kinds
    reference: FloatArray
    factors: LoadAndCoefficient
    functions: dict[str, Any]
    stick: AxialStick | None
    built_in: bool
    name: str = ""

    @property
    def dampers(self) -> StickDampers:
        """Equivalent dampers while a regularised contact sticks."""
        return StickDampers(self.kinds, self.reference, self.factors)

    def lock_name(self, direction: int) -> str:
        """Return the name of the constraint that locks a direction of slip."""
        return f"{self.name}, lock {direction}"


def register(mbs: Any, contact: Contact) -> None:
    """Store a contact in its model, and choose the name of its connector."""
    known = mbs.sys.setdefault(_CONTACTS, {})
    contact.name = f"friction contact {len(known)}"
    known[contact.name] = contact


def contacts_of(mbs: Any) -> dict[int, Contact]:
    """Return the contacts of a model by the present object numbers of their connectors.

    Updates the locks, and deactivates those of deleted contacts. Raises ``ValueError`` if a contact has lost its
    locks.
    """
    known: dict[str, Contact] = mbs.sys.get(_CONTACTS, {})
    if not known:
        return {}
    numbers = {mbs.GetObject(item)["name"]: item for item in range(mbs.systemData.NumberOfObjects())}
    for contact in known.values():
        if contact.stick is not None:
            _renew_locks(mbs, contact, contact.stick, numbers)
    return {numbers[name]: contact for name, contact in known.items() if name in numbers}


def present_item(mbs: Any, contact: Contact, item: Any) -> Any:
    """Return the object number of a contact's connector, at first ``item``; raise ``ValueError`` if it is gone."""
    count = mbs.systemData.NumberOfObjects()
    for number in (item, *range(count)):
        if int(number) < count and mbs.GetObjectParameter(number, "name") == contact.name:
            return number
    raise ValueError(f"{contact.name!r} was deleted: it cannot be changed or measured")


def _renew_locks(mbs: Any, contact: Contact, stick: AxialStick, numbers: dict[str, int]) -> None:
    names = [contact.lock_name(direction) for direction in range(len(stick.locks))]
    found = tuple(numbers[name] for name in names if name in numbers)
    if contact.name not in numbers:
        for lock in found:
            mbs.SetObjectParameter(lock, "activeConnector", False)
    elif len(found) < len(names):
        raise ValueError(
            f"object {numbers[contact.name]}, {contact.name!r}: constraints that let it stick exactly were deleted; "
            "delete the contact as well, or keep the objects that add_ring_friction has added"
        )
    else:
        stick.locks = found
