"""libtetcast's C interface for ctypes: structs as in tetcast.h, functions, errors, what the library says.

For tetcast.py alone. tests/python/test_headers.py compares all of it with the headers.
"""

import ctypes
import ctypes.util
import logging
import os
import sys
import sysconfig
import threading
import warnings
from ctypes import c_bool, c_char, c_char_p, c_double, c_int, c_int64, c_size_t, c_uint64, c_void_p

VERSION = "0.1"  # major.minor of the library that the structs below are of

# ------------------------------------------------------------------------------------------------------- constants

CONSTANTS = {
    "TC_OK": 0, "TC_E_ARG": -1, "TC_E_MEMORY": -2, "TC_E_FILE": -3, "TC_E_MESH": -4, "TC_E_GL": -5, "TC_E_WORKER": -6,
    "TC_E_LOST": -7, "TC_E_EMPTY": -8, "TC_E_CANCEL": -9, "TC_E_ACCURACY": -10, "TC_E_MOVED": -11,
    "TC_WARNING": 0, "TC_INFO": 1, "TC_DEBUG": 2,
    "TC_ANY_DATA": 0, "TC_POINT_DATA": 1, "TC_CELL_DATA": 2,
    "TC_REENTRY_AUTO": 0, "TC_REENTRY_CONVEXIFY": 1, "TC_REENTRY_PEEL": 2,
    "TC_INTEGRATOR_AUTO": 0, "TC_INTEGRATOR_TABLE": 1, "TC_INTEGRATOR_INTEGRAL": 2, "TC_INTEGRATOR_EXACT": 3,
    "TC_SAMPLES_ADAPTIVE": -1,
    "TC_MODEL_DENSITY_EMITTER": 0, "TC_MODEL_EMISSION": 1, "TC_MODEL_ABSORPTION": 2, "TC_MODEL_MAXIMUM": 3,
    "TC_MODEL_SURFACES": 4, "TC_MODEL_XRAY": 5, "TC_MODEL_MINIMUM": 6, "TC_MODEL_AVERAGE": 7, "TC_MODEL_DEPTH": 8,
    "TC_GRADIENT_NONE": 0, "TC_GRADIENT_CELL": 1, "TC_GRADIENT_VERTEX": 2,
}
STATUS = {value: name for name, value in CONSTANTS.items() if name == "TC_OK" or name.startswith("TC_E_")}

# --------------------------------------------------------------------------------------------------------- structs
# A struct's name is the header's. Enumerations are c_int; pointers that only pass through are c_void_p.

STRUCTS = []


def _struct(name, *fields):
    made = type(name, (ctypes.Structure,), {"_fields_": list(fields), "__doc__": name + " of tetcast's headers"})
    STRUCTS.append(made)
    return made


tc_error = _struct("tc_error", ("code", c_int), ("text", c_char * 1024))
MESSAGE = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p)
tc_log = _struct("tc_log", ("message", MESSAGE), ("progress", c_void_p), ("user", c_void_p))
tc_mesh_arrays = _struct(
    "tc_mesh_arrays", ("n_vertex", c_size_t), ("vertex", c_void_p), ("n_tet", c_size_t), ("tet", c_void_p),
    ("scalar", c_void_p), ("association", c_int), ("field_name", c_char_p))
tc_prepare_options = _struct(
    "tc_prepare_options", ("reentry", c_int), ("convexify_limit_s", c_double), ("threads", c_int),
    ("once_pixels", c_size_t))
tc_mesh_report = _struct(
    "tc_mesh_report",
    *[(name, c_size_t) for name in (
        "n_vertex", "n_tet", "n_imaginary", "n_steiner", "n_boundary_face", "n_component", "dropped_degenerate",
        "dropped_nonfinite", "dropped_duplicate", "reoriented", "zero_volume", "merged_vertices", "unused_vertices",
        "unlinked_faces", "faces_of_many", "faces_one_side", "nonfinite_scalars", "nonfinite_cells")],
    ("convex", c_bool), ("reentry", c_int), ("reentry_why", c_char * 256), ("bounds", c_double * 6),
    ("scalar_range", c_double * 2), ("longest_edge", c_double), ("volume", c_double), ("association", c_int),
    ("ms_check", c_double), ("ms_adjacency", c_double), ("ms_order", c_double), ("ms_convexify", c_double),
    ("source_cells", c_size_t))
tc_read_options = _struct(
    "tc_read_options", ("field", c_char_p), ("association", c_int), ("has_time", c_bool), ("has_step", c_bool),
    ("time", c_double), ("step", c_int), ("refine", c_int), ("idle_limit_s", c_double), ("all_ranges", c_bool),
    ("keep_reader", c_bool))
tc_array_info = _struct(
    "tc_array_info", ("name", c_char_p), ("association", c_int), ("components", c_int), ("lo", c_double),
    ("hi", c_double))
tc_source = _struct(
    "tc_source", ("path", c_char_p), ("format", c_char_p), ("reader", c_char_p), ("field", c_char_p),
    ("n_point", c_size_t), ("n_cell", c_size_t), ("n_array", c_size_t), ("array", ctypes.POINTER(tc_array_info)),
    ("n_block", c_size_t), ("block", c_void_p), ("n_cell_type", c_size_t), ("cell_type", c_void_p),
    ("n_time", c_size_t), ("time", ctypes.POINTER(c_double)), ("step", c_int), ("dropped_cells", c_size_t),
    ("linearised", c_bool), ("refine", c_int), ("n_note", c_size_t), ("note", ctypes.POINTER(c_char_p)),
    ("ms_read", c_double), ("helper_peak_bytes", c_size_t))
tc_transfer_options = _struct(
    "tc_transfer_options", ("color_map", c_char_p), ("preset", c_char_p), ("opacity", c_char_p), ("has_range", c_bool),
    ("range", c_double * 2), ("data_range", c_double * 2), ("log", c_bool))
tc_knot = _struct("tc_knot", *[(name, c_double) for name in "srgba"])
tc_camera = _struct(
    "tc_camera", ("position", c_double * 3), ("focal_point", c_double * 3), ("view_up", c_double * 3),
    ("view_angle", c_double), ("parallel_scale", c_double), ("parallel", c_bool), ("clip_near", c_double),
    ("clip_far", c_double), ("window_center", c_double * 2))
tc_image = _struct("tc_image", ("width", c_int), ("height", c_int), ("rgba", c_void_p))
tc_text_pair = _struct("tc_text_pair", ("key", c_char_p), ("value", c_char_p))
tc_image_encoding = _struct(
    "tc_image_encoding", ("bits", c_int), ("quality", c_int), ("level", c_int), ("depth", c_void_p))
tc_iso = _struct(
    "tc_iso", ("value", c_double), ("opacity", c_double), ("has_color", c_bool), ("color", c_double * 3))
tc_shade = _struct(
    "tc_shade", ("gradient", c_int), ("volume", c_bool), ("surfaces", c_bool), ("ambient", c_double),
    ("diffuse", c_double), ("specular", c_double), ("power", c_double), ("one_sided", c_bool), ("magnitude", c_double),
    ("n_light", c_int), ("light", c_void_p))
tc_look = _struct(
    "tc_look", ("model", c_int), ("depth_opacity", c_double), ("n_iso", c_int), ("iso", c_void_p), ("shade", tc_shade),
    ("color_field", c_void_p), ("color_function", c_void_p), ("n_plane", c_int), ("plane", c_void_p),
    ("has_box", c_bool), ("box", c_double * 6), ("n_select", c_int), ("select", c_void_p), ("n_geometry", c_int),
    ("geometry", c_void_p))
tc_renderer_options = _struct(
    "tc_renderer_options", ("gl", c_char_p), ("driver", c_char_p), ("get_proc_address", c_void_p), ("threads", c_int),
    ("keep_bytes", c_size_t), ("keep_at_once", c_bool))
tc_render_options = _struct(
    "tc_render_options", ("width", c_int), ("height", c_int), ("whole_width", c_int), ("whole_height", c_int),
    ("part_x", c_int), ("part_y", c_int), ("integrator", c_int), ("table_size", c_int * 3), ("table_format", c_int),
    ("unit_distance", c_double), ("integral_order", c_int), ("integral_split", c_double), ("opacity_stop", c_double),
    ("steps_per_pass", c_int), ("z_update_every", c_int), ("count", c_bool), ("stepper", c_int), ("audit", c_bool),
    ("has_nan_color", c_bool), ("nan_color", c_double * 4), ("samples", c_int), ("state_format", c_int),
    ("look", c_void_p), ("without", c_char_p))
tc_render_stats = _struct(
    "tc_render_stats", ("context", c_char * 32), ("gl_renderer", c_char * 128), ("gl_version", c_char * 64),
    ("driver", c_char * 16), ("stepper", c_char * 16), ("integrator", c_char * 16), ("integrator_why", c_char * 256),
    ("effects", c_char * 256), ("opacity_stop", c_double), ("integral_order", c_int), ("samples", c_int),
    ("state_bits", c_int), ("refined", c_int64),
    *[(name, c_double) for name in (
        "ms_pack", "ms_upload", "ms_table", "ms_compile", "ms_first_hit", "ms_march", "ms_frame", "ms_readback",
        "gpu_bytes_mesh", "gpu_bytes_other", "gpu_bytes_table", "gpu_bytes_state", "bytes_kept")],
    ("kept", c_bool), ("gpu_bytes_sent", c_double),
    *[(name, c_int) for name in ("steps_per_pass", "z_update_every", "passes", "z_updates", "layers")],
    *[(name, c_int64) for name in ("rays", "rays_lost", "steps", "steps_max", "audit_broken")],
    ("n_fragments_per_pass", c_size_t), ("fragments_per_pass", ctypes.POINTER(c_int64)))
tc_verify_result = _struct(
    "tc_verify_result", ("pixels", c_size_t), ("ill_posed", c_size_t), ("max_abs_error", c_double),
    ("p999_abs_error", c_double), ("mean_abs_error", c_double), ("worst_error_ill_posed", c_double), ("worst_x", c_int),
    ("worst_y", c_int), ("rays_lost", c_int64), ("p9999_abs_error", c_double), ("n_all", c_size_t),
    ("confidence", c_double), ("unseen_share", c_double))

# ------------------------------------------------------------------------------------------------------- functions

P = c_void_p  # any pointer: a handle, an array, or byref of a struct
FUNCTIONS = {
    "tc_version": (c_char_p,),
    "tc_mesh_create": (c_int, P, P, P),
    "tc_mesh_destroy": (None, P),
    "tc_mesh_set_scalar": (c_int, P, P, c_int, P),
    "tc_mesh_prepare": (c_int, P, P, P, P),
    "tc_mesh_get_report": (None, P, P),
    "tc_default_unit_distance": (c_double, P),
    "tc_mesh_read": (c_int, P, c_char_p, P, P, P),
    "tc_mesh_read_values": (c_int, P, P, c_char_p, P, P, P),
    "tc_mesh_source": (ctypes.POINTER(tc_source), P),
    "tc_mesh_write_vtu": (c_int, P, c_char_p, P),
    "tc_synth_create": (c_int, P, c_char_p, c_size_t, c_uint64, P),
    "tc_transfer_create": (c_int, P, P, P),
    "tc_transfer_knots": (ctypes.POINTER(tc_knot), P, P),
    "tc_transfer_name": (c_char_p, P),
    "tc_transfer_builtin": (ctypes.POINTER(c_char_p), P),
    "tc_transfer_destroy": (None, P),
    "tc_camera_reset": (None, P, P, P, P, c_double, c_double),
    "tc_camera_azimuth": (None, P, c_double),
    "tc_camera_elevation": (None, P, c_double),
    "tc_camera_roll": (None, P, c_double),
    "tc_camera_zoom": (None, P, c_double),
    "tc_image_destroy": (None, P),
    "tc_image_background": (None, P, P),
    "tc_image_write": (c_int, P, c_char_p, P, c_size_t, P, P),
    "tc_image_read": (c_int, P, c_char_p, P),
    "tc_image_writer_create": (c_int, P, P),
    "tc_image_writer_save": (c_int, P, P, c_char_p, P, P, c_size_t, P, P),
    "tc_image_writer_destroy": (None, P),
    "tc_shade_defaults": (None, P),
    "tc_renderer_create": (c_int, P, P, P, P),
    "tc_renderer_destroy": (None, P),
    "tc_render_defaults": (None, P),
    "tc_render": (c_int, P, P, P, P, P, P, P, P, P),
    "tc_verify": (c_int, P, P, c_size_t, c_uint64, P, P, P, P, P, P),
}

# --------------------------------------------------------------------------------------------------------- library


def library_places():
    """Files that may be the library, best first; those that do not exist are passed over."""
    here = os.path.dirname(os.path.realpath(__file__))
    name = "libtetcast.so.0"
    installed = os.path.normpath(os.path.join(here, "..", ".."))  # lib of PREFIX/lib/python3/dist-packages
    return [
        os.path.join(here, name),
        os.path.join(installed, sysconfig.get_config_var("MULTIARCH") or "", name),
        os.path.join(installed, name),
        os.path.join(os.path.dirname(installed), "lib64", name),
        os.path.join(installed, "build", name),  # of a clone of the repository, as make leaves it
    ]


def load():
    """The library with its functions declared. ImportError says where it was looked for."""
    asked = os.environ.get("TETCAST_LIBRARY")
    found = asked or next((path for path in library_places() if os.path.exists(path)), None)
    found = found or ctypes.util.find_library("tetcast") or "libtetcast.so.0"
    try:
        library = ctypes.CDLL(found)  # not PyDLL: other Python threads run while the library works
    except OSError as error:
        raise ImportError(
            f"libtetcast cannot be loaded from {found} ({error}); "
            "install tetcast, or name the library's file in TETCAST_LIBRARY") from None
    for name, (result, *arguments) in FUNCTIONS.items():
        try:
            function = getattr(library, name)
        except AttributeError:
            raise ImportError(f"{found} has no {name}: it is of another version than this module") from None
        function.restype, function.argtypes = result, arguments
    version = library.tc_version().decode()
    if not version.startswith(VERSION + "."):
        raise ImportError(f"{found} is version {version}, but this module is for {VERSION}; install both together")
    return library


lib = load()

# ------------------------------------------------------------------------------------------------- errors and talk


class Error(Exception):
    """What the library could not do, in one sentence; status is the name of its tc_status, as "TC_E_FILE"."""

    def __init__(self, text, status="TC_E_ARG"):
        super().__init__(text)
        self.status = status


class ArgumentError(Error, ValueError):
    """An argument is wrong."""


class Warning(UserWarning):
    """The library warns of what a picture does not show as asked."""


logger = logging.getLogger("tetcast")
logger.addHandler(logging.NullHandler())
_said = threading.local()  # the library talks on the thread that called it


@MESSAGE
def _message(_user, level, text):
    # Nothing may be raised through C: what is said is kept until the call is over.
    try:
        _said.__dict__.setdefault("lines", []).append((level, text.decode("utf-8", "replace")))
    except KeyboardInterrupt:
        _said.interrupted = True
    except BaseException:  # no memory: the line is lost
        pass


_log = tc_log(message=_message)
LOG = ctypes.byref(_log)


def tell(failed=False):
    """Hands on what the library said during calls of this thread: warnings to `warnings`, the rest to the logger."""
    lines = _said.__dict__.pop("lines", ())
    if _said.__dict__.pop("interrupted", False):
        raise KeyboardInterrupt
    for level, text in lines:
        if level == CONSTANTS["TC_WARNING"] and not failed:
            depth, frame = 2, sys._getframe(1)
            while frame.f_back and frame.f_globals.get("__name__") in ("tetcast", __name__):
                depth, frame = depth + 1, frame.f_back
            warnings.warn(text, Warning, stacklevel=depth)
        else:
            logger.log({0: logging.WARNING, 1: logging.INFO}.get(level, logging.DEBUG), "%s", text)


def call(name, *arguments):
    """Calls a function whose last parameter is the error; raises Error. Does not tell()."""
    error = tc_error()
    status = getattr(lib, name)(*arguments, ctypes.byref(error))
    if status == CONSTANTS["TC_OK"]:
        return
    tell(failed=True)
    text = error.text.decode("utf-8", "replace") or f"{name} failed"
    if status == CONSTANTS["TC_E_ARG"]:
        raise ArgumentError(text)
    raise Error(text, STATUS.get(status, str(status)))


def free(destroy, address):
    """Ends an object of the library, by the name of its function."""
    getattr(lib, destroy)(ctypes.byref(c_void_p(address)))


def encoded(text):
    """bytes for C of a str, or of a path; None stays None."""
    if text is None:
        return None
    made = os.fsencode(text)
    if b"\0" in made:
        raise ArgumentError(f"{text!r} contains a zero character, which no name may")
    return made


def as_dict(struct):
    """A struct's fields as Python values, without those that were not measured (NaN or, of stats, negative)."""
    made = {}
    for name, kind in struct._fields_:
        value = getattr(struct, name)
        if isinstance(value, bytes):
            value = value.decode("utf-8", "replace")
        elif isinstance(value, ctypes.Array):
            value = tuple(value)
        elif isinstance(value, float) and value != value:
            continue
        elif not isinstance(value, (bool, int, float)):
            continue
        made[name] = value
    return made
