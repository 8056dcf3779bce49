"""The table of rows: every feature a world can have. A row that is added here is in worlds with all others.

make(draw, ...) gives the row's piece of the text; what it is given and what it answers is the same within a group:

  group        make is given         and answers
  spectrum     draw                  nothing; sets wavelength, level
  model        draw                  a material without temperature, opaque or matte
  temperature  draw, kelvin          entries of a material
  map          draw, material        the material with maps
  shape        draw, material        an object within a sphere of 1 m about the origin; closed with trait 'closed' in `what`
  phase        draw                  a phase function
  medium       draw, index           a medium for bodies of some metres
  thing        draw                  placements (a list) within a sphere of 1.4 m about the origin
  placing      draw, placement       the placement (of a thing), turned, moved, ...
  floor, fill  draw                  nothing; place what is under and around all things
  air, sky, light  draw              nothing; write into the simulation
  sensor       draw                  nothing; adds a sensor

`without`: rows and traits of relations that the row is never drawn with, with the reason beside it.
"""
from dataclasses import dataclass, field
from typing import Callable, FrozenSet

import rows_body
import rows_light
import rows_map
import rows_model
import rows_place
import rows_sensor


@dataclass(frozen=True)
class Row:
    name: str
    group: str
    make: Callable
    weight: float = 1
    without: FrozenSet[str] = field(default_factory=frozenset)
    what: FrozenSet[str] = field(default_factory=frozenset)


TABLE = {}
for module in (rows_model, rows_map, rows_body, rows_place, rows_light, rows_sensor):
    for entry in module.ROWS:
        row = Row(entry[0], entry[1], entry[2], entry[3].get("weight", 1) if len(entry) > 3 else 1,
                  frozenset(entry[3].get("without", ()) if len(entry) > 3 else ()),
                  frozenset(entry[3].get("what", ()) if len(entry) > 3 else ()))
        if row.name in TABLE:
            raise ValueError(f"two rows are called {row.name}")
        TABLE[row.name] = row
