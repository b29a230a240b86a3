from studies import figure5, labelled_offices
from studies.figure5 import report  # noqa: F401

TITLE = 'Figure 5 at all resolutions and supports'
ABOUT = figure5.ABOUT
DATA, PROGRAMS = (labelled_offices.SET,), figure5.PROGRAMS
RESOLUTIONS = range(3, 13)
SUPPORTS = (0.1, 0.2, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8)  # m


def units(context):
    return figure5.grid(context, RESOLUTIONS, SUPPORTS)
