"""The motion of a pin or a disc, written once for interpreted and compiled runs.

The functions are plain Python on numbers and tuples. numba compiles them when a compiled run is requested.

- ``forces``: support, damper, friction and the equations of motion;
- ``rest``, ``limit``: friction at rest, release, and the beginning of slip;
- ``steps``: a step of either method, used by ``slip`` and ``stiff``;
- ``surfaces``: the kinks of the forces, and the end of a pivot;
- ``recording``: the motion at the requested times;
- ``run``, ``memory``: the sequence of phases, in calls of bounded length;
- ``single``, ``units``: one trajectory in SI units.
"""
