"""Fig. 5: equilibrium and whirl, stick phases, and the critical start."""

from compare.studies.pin.fig05.pictures import animate, draw
from compare.studies.pin.fig05.study import STUDY

STUDY.provides(figures=draw, animations=animate)
