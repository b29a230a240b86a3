"""The studies that experiments/run knows: each module with a TITLE here is one.

    TITLE = 'Figure 7: recognition rate over distance'
    ABOUT = 'What is measured and how to read it, in two sentences.'
    DATA = ('distance',)        sets that it takes from --data where they are there; left out: simulator alone
    PROGRAMS = ('rimod-detect', 'rimod-modeler')   whose change makes its results stale (these if left out)
    def units(context): ...     list of Unit
    def report(context, rows): ...  all units' rows -> the sentences of what was found, computed from the rows;
                                    draws with context.figure(..), writes context.table(..)

The results of a unit are kept until one of PROGRAMS, the data, the unit's settings or the code of the module
other than report() and functions named report_* change.
"""
import dataclasses
import typing


@dataclasses.dataclass
class Unit:
    """A small piece of a study that runs on its own."""
    key: str                                      # names its file; letters, digits, - _ . + only
    work: typing.Callable[[], typing.List[dict]]  # rows; values are numbers, texts, booleans or None
    settings: typing.Any = None                   # what the result depends on beside the code; JSON can hold it
