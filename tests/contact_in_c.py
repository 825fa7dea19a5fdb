"""The contact of the units in C, as ``contact.h`` declares it."""

import ctypes

Three = ctypes.c_double * 3


class Contact(ctypes.Structure):
    _fields_ = [
        ("inner", ctypes.c_double),
        ("outer", ctypes.c_double),
        ("points", ctypes.c_int),
        ("angle", ctypes.c_double),
        ("wear", ctypes.c_int),
        ("pressure", Three),
        ("friction", ctypes.c_double),
        ("static_ratio", ctypes.c_double),
        ("epsilon", ctypes.c_double),
    ]
