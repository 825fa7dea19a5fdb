"""The friction contacts of a model.

``add_ring_friction`` stores a ``Contact`` in ``mbs.sys`` under the name of its connector. Object numbers would be
ambiguous there, because ``mbs.sys`` survives ``mbs.Reset`` and objects can be deleted.
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


@dataclass(frozen=True, eq=False)
class Contact:
    """A friction contact between two nodes.

    Parameters
    ----------
    kinds : Kinds
        Kinds of the nodes of master and disc.
    reference : array of shape (n,)
        Their reference coordinates.
    factors : LoadAndCoefficient
        Load and sliding coefficient.
    functions : dict
        Its "force" and "jacobian" as user functions for Exudyn.
    stick : AxialStick or None
        Its exact stick, None if it is regularised.
    built_in : bool
        Whether its connector is Exudyn's ``ObjectConnectorCoordinateSpringDamperExt``.

    """

    kinds: Kinds
    reference: FloatArray
    factors: LoadAndCoefficient
    functions: dict[str, Any]
    stick: AxialStick | None
    built_in: bool

    @property
    def dampers(self) -> StickDampers:
        """Equivalent dampers of the contact while it sticks by its regularised law."""
        return StickDampers(self.kinds, self.reference, self.factors)


def register(mbs: Any, contact: Contact) -> str:
    """Store a contact in its model; return the name that its connector must have."""
    known = mbs.sys.setdefault(_CONTACTS, {})
    name = f"friction contact {len(known)}"
    known[name] = contact
    return name


def contacts_of(mbs: Any) -> dict[int, Contact]:
    """Return all contacts of a model by the object numbers of their connectors."""
    known = mbs.sys.get(_CONTACTS)
    if not known:
        return {}
    names = [mbs.GetObject(item)["name"] for item in range(mbs.systemData.NumberOfObjects())]
    return {item: known[name] for item, name in enumerate(names) if name in known}
