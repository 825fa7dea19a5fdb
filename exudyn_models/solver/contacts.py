"""The friction contacts of a model.

They are stored in ``mbs.sys`` by the names of their connectors, because objects can be deleted and ``mbs.Reset``
starts their numbers again.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from exudyn_models.forces.axial_pairs import AxialStick, RowLaw
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.slip_kinematics import Kinds
from exudyn_models.forces.stick_dampers import StickDampers
from exudyn_models.solver.items import at_assembly
from reference_model.systems import FloatArray

_CONTACTS, _SUPPORTS = "friction contacts", "radial supports"


@dataclass(eq=False, kw_only=True)
class Connector:
    """A connector with a ``name``.

    The ``places`` of its coordinates and the ``power`` (W) as a function of time (s) hold until the next assembly.
    """

    name: str = ""
    places: list[slice] = field(default_factory=list)
    power: Callable[[float], float] | None = None

    def forget(self) -> None:
        """Forget places and power."""
        self.places.clear()
        self.power = None


class Lockable(Connector):
    """A connector whose directions of slip constraints may lock."""

    def lock_name(self, direction: int) -> str:
        """Return the name of the constraint that locks a direction of slip."""
        return f"{self.name}, lock {direction}"


@dataclass(eq=False)
class Coupling(Lockable):
    """A part between rotors, such as a gear or a one-way clutch."""

    stick: RowLaw


@dataclass(eq=False)
class Contact(Lockable):
    """Friction contact between two nodes with ``reference`` coordinates, shape (n,).

    ``functions`` contains its "force" and "jacobian". ``stick`` is None if the contact is regularised. ``built_in``
    contacts are Exudyn's coordinate connectors.
    """

    kinds: Kinds
    reference: FloatArray
    factors: LoadAndCoefficient
    functions: dict[str, Any]
    stick: AxialStick | None
    built_in: bool

    @property
    def dampers(self) -> StickDampers:
        """Equivalent dampers while a regularised contact sticks."""
        return StickDampers(self.kinds, self.reference, self.factors)


def register(mbs: Any, contact: Contact | Coupling) -> None:
    """Store a contact or coupling in its model, and choose the name of its connector."""
    known = mbs.sys.setdefault(_CONTACTS, {})
    contact.name = f"friction contact {len(known)}"
    known[contact.name] = contact
    at_assembly(mbs, contact.forget)


def register_support(mbs: Any) -> Connector:
    """Store a support in its model; return it with its connector's name."""
    known: list[Connector] = mbs.sys.setdefault(_SUPPORTS, [])
    known.append(connector := Connector(name=f"radial support {len(known)}"))
    at_assembly(mbs, connector.forget)
    return connector


def places_of(mbs: Any, connector: Connector, item: Any) -> list[slice]:
    """Return slices of the coordinates of a connector in an assembled model, added as ``item``.

    Raises ``ValueError`` if it was deleted.
    """
    if not connector.places:
        places = np.array(mbs.systemData.GetObjectLTGODE2(present_item(mbs, connector, item)))
        runs = np.split(places, 1 + np.flatnonzero(np.diff(places) != 1))
        connector.places = [slice(int(run[0]), int(run[-1]) + 1) for run in runs]
    return connector.places


def coordinates_of(mbs: Any, connector: Connector, item: Any) -> list[int]:
    """Return the places of the coordinates of a connector, as in ``places_of``."""
    return [place for own in places_of(mbs, connector, item) for place in range(own.start, own.stop)]


def motion_of(mbs: Any, connector: Connector, item: Any, configuration: Any) -> tuple[FloatArray, FloatArray]:
    """Return coordinates without reference values and their rates, at half the cost of the nodes' own outputs.

    Other arguments and errors are the same as in ``places_of``.
    """
    data, places = mbs.systemData, places_of(mbs, connector, item)
    q, q_t = (read(configuration, False) for read in (data.GetODE2Coordinates, data.GetODE2Coordinates_t))
    return np.concatenate([q[place] for place in places]), np.concatenate([q_t[place] for place in places])


def contacts_of(mbs: Any) -> dict[int, Contact]:
    """Return the contacts of a model by the present object numbers of their connectors."""
    return {item: contact for item, contact in _known(mbs).items() if isinstance(contact, Contact)}


def laws_of(mbs: Any) -> dict[int, RowLaw]:
    """Return the laws of contacts with exact stick and of couplings, by the numbers of their connectors."""
    return {item: contact.stick for item, contact in _known(mbs).items() if contact.stick is not None}


def _known(mbs: Any) -> dict[int, Contact | Coupling]:
    known: dict[str, Contact | Coupling] = mbs.sys.get(_CONTACTS, {})
    numbers = _numbers(mbs) if known else {}
    return {numbers[name]: contact for name, contact in known.items() if name in numbers}


def find_again(mbs: Any) -> None:
    """Find the locks of all contacts again.

    Raises ``ValueError`` if a contact has lost its locks.
    """
    contacts: list[Contact | Coupling] = list(mbs.sys.get(_CONTACTS, {}).values())
    numbers = _numbers(mbs) if contacts else {}
    for contact in contacts:
        if contact.stick is None or contact.name not in numbers:
            continue
        names = [contact.lock_name(direction) for direction in range(len(contact.stick.constraints))]
        if not numbers.keys() >= set(names):
            raise ValueError(
                f"object {numbers[contact.name]}, {contact.name!r}: constraints that let it stick exactly were "
                "deleted; delete the contact as well, or keep the objects that its function has added"
            )
        contact.stick.use([numbers[name] for name in names])


def _numbers(mbs: Any) -> dict[str, int]:
    objects = range(mbs.systemData.NumberOfObjects())
    return {mbs.GetObjectParameter(item, "name"): item for item in objects}


def present_item(mbs: Any, connector: Connector, item: Any) -> Any:
    """Return the present object number of a connector added as ``item``.

    Raises ``ValueError`` if it was deleted.
    """
    count = mbs.systemData.NumberOfObjects()
    for number in (item, *range(count)):  # mostly the first
        if int(number) < count and mbs.GetObjectParameter(number, "name") == connector.name:
            return number
    raise ValueError(
        f"{connector.name!r} was deleted: it cannot be changed or measured; keep objects that sensors or an energy "
        "balance use"
    )
