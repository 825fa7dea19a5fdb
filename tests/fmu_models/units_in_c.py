"""Instances of units, called directly without FMI."""

import ctypes

import numpy as np


class Instance:
    """One instance of a model in a library with ``driver.c``."""

    def __init__(self, library, model, **values):
        self.library, self.model = library, model
        self.places = {one.name: i for i, one in enumerate(model.variables)}
        library.made.restype = ctypes.c_void_p
        library.said.restype, library.get.restype = ctypes.c_char_p, ctypes.c_double
        self.itself = ctypes.c_void_p(library.made())
        self.set(**values)

    def __getitem__(self, name):
        return self.library.get(self.itself, self.places[name])

    def __getattr__(self, name):
        return lambda *arguments: getattr(self.library, name)(self.itself, *arguments)

    def set(self, **values):
        return [
            self.library.set(self.itself, self.places[name], ctypes.c_double(value))
            for name, value in values.items()
        ]

    def started(self, time=0.0):
        assert self.library.initialise(self.itself, ctypes.c_double(time)) == 0, self.sentence
        return self

    @property
    def sentence(self):
        return self.library.said(self.itself).decode()

    def to(self, time):
        assert self.library.advance(self.itself, ctypes.c_double(time)) == 0, self.sentence

    def values(self, *names):
        return np.array([self[name] for name in names])

    @property
    def state(self):
        return self.values(*(one.name for one in self.model.states))

    @state.setter
    def state(self, x):
        self.put_states(np.asarray(x, dtype=float).ctypes.data_as(ctypes.POINTER(ctypes.c_double)))

    @property
    def rates(self):
        return self.values(*(one.name for one in self.model.derivatives))

    @property
    def changes(self):
        """Return times and modes of the events of an exact contact."""
        times, modes = np.zeros((2, 64))
        number = self.library.events(self.itself, *(self._pointer(one) for one in (times, modes)))
        return times[:number], modes[:number].astype(int)

    def along(self, **directions):
        """Return the derivatives of all variables in the given direction."""
        d = np.zeros(len(self.model.variables))
        for name, value in directions.items():
            d[self.places[name]] = value
        self.tangent(self._pointer(d))
        return dict(zip(self.places, d, strict=True))

    @staticmethod
    def _pointer(array):
        return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
