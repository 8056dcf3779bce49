"""Scenes, simulations and results of the remote-sensing suite in Python.

Write a Scene and a Simulation, have the programs prepare and render them, read the results as xarray:

    scene.prepare("lawn.h5"); result = simulation.render("out"); result["camera"].radiance

The programs check what is written; what they refuse is an InputError with file, line and message.
"""
from ._version import __version__
from .chips import write_chips
from .envi import EnviHeader, FormatError, open_envi, read_header, read_values
from .errors import (Finding, InputError, Interrupted, ProgramBug, ProgramError, ProgramMissing, ProgramWarning,
                     UsageError)
from .fitted import FittedFunction, direction, open_sqt
from .library import set_threads
from .lidar import Lidar, OpenLidar, open_lidar, open_response, read_points, response_of
from .lit import LitScene, Radiance, open_simulation
from .netcdf import write_netcdf
from .programs import Found, Run, find_program, run_program, version, where_is
from .results import Result
from .scene import (Material, Medium, Object, Origin, Placement, PreparedScene, Report, Scene, box, check_scene, cylinder, disk,
                    layer, mesh, plane, prepare_scene, sphere, terrain)
from .simulation import (Atmosphere, Band, Fisheye, FrameCamera, Lamp, Moon, Orthographic, Output, Points, Sensor, Simulation,
                         Sky, Sun, bands, render)
from .temperatures import open_temperatures
from .traced import Hits, TracedScene, open_scene
from .tree import Curve, CurveFile, CurveLike, Keys, OpenKeys

__all__ = [
    "Atmosphere", "Band", "Curve", "CurveFile", "CurveLike", "EnviHeader", "Finding", "Fisheye", "FittedFunction",
    "FormatError", "Found", "FrameCamera", "Hits", "InputError", "Interrupted", "Keys", "Lamp", "Lidar", "LitScene", "Material", "Medium", "Moon", "Object",
    "OpenKeys", "OpenLidar", "Origin", "Orthographic", "Output", "Placement", "Points", "PreparedScene", "ProgramBug", "ProgramError",
    "ProgramMissing", "ProgramWarning", "Radiance", "Report", "Result", "Run", "Scene", "Sensor", "Simulation", "Sky", "Sun",
    "TracedScene", "UsageError", "bands", "box", "check_scene", "cylinder", "direction", "disk", "find_program", "layer",
    "mesh", "open_envi", "open_lidar", "open_response", "open_scene", "open_simulation", "open_sqt", "open_temperatures", "plane", "prepare_scene", "read_header",
    "read_points", "read_values", "render", "response_of", "run_program", "set_threads", "sphere", "terrain", "version", "where_is", "write_chips", "write_netcdf",
]
