"""Forces on a pin or a disc relative to the master disc, in scaled units.

- ``law``: the parameters;
- ``contact``, ``points``: friction of circles and of contact points;
- ``pivot``: rotation about a resting point;
- ``rates``: the equations of motion.
"""
