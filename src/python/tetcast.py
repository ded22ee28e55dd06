"""tetcast for Python: pictures of tetrahedral meshes, numpy arrays in and out. Reference: docs/python.md.

    mesh = tetcast.Mesh(points, cells, scalars)
    image = tetcast.render(mesh, cmap="Viridis", opacity=[0, 0.1, 2], camera="iso")  # H x W x 4 float32
    tetcast.save(image, "mesh.png")

Names are PyVista's where it has them. Opacity is attenuation per opacity_unit_distance, as in ParaView. Pixels are
premultiplied. What goes wrong is tetcast.Error (a ValueError where an argument is wrong), in one sentence; warnings go
through `warnings` as tetcast.Warning, other talk through the logger "tetcast".
"""

import ctypes
import json
import os
import threading
import weakref

import numpy as np

import _tetcast as c
from _tetcast import CONSTANTS, ArgumentError, Error, Warning

__all__ = [
    "ArgumentError", "Camera", "Error", "Mesh", "Renderer", "TransferFunction", "Warning", "color_maps", "read",
    "read_image", "render", "save", "straight", "synth", "to_uint8",
]
__version__ = c.lib.tc_version().decode()

_ASSOCIATIONS = {None: 0, "point": 1, "cell": 2}
_REENTRY = {"auto": 0, "convexify": 1, "peel": 2}
_INTEGRATORS = {"auto": 0, "table": 1, "integral": 2, "exact": 3}
_SAMPLES = {1: 1, 4: 4, 16: 16, "adaptive": CONSTANTS["TC_SAMPLES_ADAPTIVE"]}
_MODELS = {
    name: CONSTANTS["TC_MODEL_" + field] for name, field in (
        ("density-emitter", "DENSITY_EMITTER"), ("emission", "EMISSION"), ("absorption", "ABSORPTION"),
        ("mip", "MAXIMUM"), ("minip", "MINIMUM"), ("average", "AVERAGE"), ("xray", "XRAY"),
        ("isosurface", "SURFACES"), ("depth", "DEPTH"))
}
_SHADES = {False: 0, None: 0, True: 2, "cell": 1, "vertex": 2}
# PyVista's camera positions: the direction from the mesh to the eye, and what is up.
_VIEWS = {
    "xy": ((0, 0, 1), (0, 1, 0)), "yx": ((0, 0, -1), (1, 0, 0)), "xz": ((0, -1, 0), (0, 0, 1)),
    "zx": ((0, 1, 0), (1, 0, 0)), "yz": ((1, 0, 0), (0, 0, 1)), "zy": ((-1, 0, 0), (0, 1, 0)),
    "iso": ((1, 1, 1), (0, 0, 1)),
}
_COLORS = {"white": (1, 1, 1, 1), "black": (0, 0, 0, 1), "transparent": (0, 0, 0, 0), None: (0, 0, 0, 0)}


def _choice(what, value, choices):
    try:
        return choices[value]
    except (KeyError, TypeError):
        names = ", ".join(repr(name) for name in choices if name is not None)
        raise ArgumentError(f"{what} is {value!r}; it can be {names}") from None


def _numbers(what, values, shape=None):
    """Contiguous float64, without a copy where values already are. shape: what it must be, None: any length."""
    if isinstance(values, np.ma.MaskedArray):
        values = values.astype(np.float64).filled(np.nan)
    try:
        made = np.asarray(values)
    except ValueError:
        made = np.empty(0, object)
    if made.dtype.kind not in "fiub":
        raise ArgumentError(f"{what}: numbers are needed, not {made.dtype.name}")
    if shape is not None and (len(shape) != made.ndim or any(n not in (None, m) for n, m in zip(shape, made.shape))):
        wanted = " x ".join("n" if n is None else str(n) for n in shape)
        raise ArgumentError(f"{what} has the shape {made.shape}; {wanted} is needed")
    return np.ascontiguousarray(made, np.float64)


def _triple(what, values):
    made = _numbers(what, values, (3,))
    if not np.isfinite(made).all():
        raise ArgumentError(f"{what} is {tuple(made.tolist())}; it must be finite")
    return made


def _pointer(array):
    return None if array is None else ctypes.c_void_p(array.ctypes.data)


# ------------------------------------------------------------------------------------------------------------ mesh


class Mesh:
    """A tetrahedral mesh with a scalar field, prepared for rendering.

    points (n, 3) float64, cells (m, 4) int32 and scalars float64 are handed over without a copy in Python where they
    have that type and are contiguous, else converted once; the library has copies of its own. scalars has a value for
    each point or each cell; association ("point", "cell") is needed only where there are as many of both. threads 0: all
    cores. Cost: O(n log n). Several threads may render a mesh at once, but not while it is given new values.
    """

    def __init__(self, points, cells, scalars=None, association=None, name=None, *, reentry="auto", threads=0):
        points = _numbers("points", points, (None, 3))
        with np.errstate(all="ignore"):
            suspect = not np.isfinite(points.sum())
        if suspect:
            bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
            if len(bad):
                raise ArgumentError(f"points: {len(bad)} of {len(points)} are not finite, the first is {bad[0]}; "
                                    "remove them and the cells that use them")
        cells = _cells(cells, len(points))
        self._shape, self._path = (len(points), len(cells)), None
        values, kind = None, _choice("association", association, _ASSOCIATIONS) or 1
        if scalars is not None:
            values, kind = self._values(scalars, association)
        arrays = c.tc_mesh_arrays(
            n_vertex=len(points), vertex=_pointer(points), n_tet=len(cells), tet=_pointer(cells),
            scalar=_pointer(values), association=kind, field_name=None if name is None else str(name).encode())
        handle = ctypes.c_void_p()
        c.call("tc_mesh_create", ctypes.byref(handle), ctypes.byref(arrays))
        self._take(handle, reentry, threads)

    @classmethod
    def _wrap(cls, handle, reentry, threads, path=None):
        mesh = cls.__new__(cls)
        mesh._shape, mesh._path = None, path
        mesh._take(handle, reentry, threads)
        return mesh

    def _take(self, handle, reentry, threads):
        self._handle = handle
        self._finalizer = weakref.finalize(self, c.free, "tc_mesh_destroy", handle.value)
        self._finalizer.atexit = False  # the memory goes with the process
        self._prepare, self._report = (reentry, threads), None
        options = c.tc_prepare_options(reentry=_choice("reentry", reentry, _REENTRY), threads=int(threads))
        c.call("tc_mesh_prepare", self._handle, ctypes.byref(options), c.LOG)
        c.tell()

    def _values(self, scalars, association):
        n_points, n_cells = self._shape
        values = _numbers("scalars", scalars, (None,))
        kind = _choice("association", association, _ASSOCIATIONS)
        if kind == 0:
            kind = 1 if len(values) == n_points else 2
        if len(values) != (n_points, n_cells)[kind - 1]:
            raise ArgumentError(f"scalars has {len(values)} values; the mesh has {n_points} points and {n_cells} cells"
                                + (f", and values of {association}s were asked for" if association else ""))
        return values, kind

    def set_scalars(self, scalars, association=None):
        """New values on the same mesh: nothing is prepared anew, and a renderer uploads the values alone."""
        if self._shape is None:
            raise ArgumentError("the mesh is of a file, whose points and cells are split: use read_values for another "
                                "step or array, or make a Mesh of arrays")
        values, kind = self._values(scalars, association)
        c.call("tc_mesh_set_scalar", self._handle, _pointer(values), kind)
        self._report = None

    def read_values(self, scalars=None, step=None, time=None, association=None, path=None):
        """Another step or array of the mesh's file (or of path): where points and cells are the same, only values are
        read and the mesh stays prepared; otherwise this Mesh becomes that step's, and is prepared anew. What is not given
        is as of tetcast.read: the first array, the first step."""
        if self._path is None:
            raise ArgumentError("the mesh is not of a file: use set_scalars")
        path = self._path if path is None else os.fspath(path)
        moved = ctypes.c_void_p()
        options = _read_options(scalars, step, time, association)
        try:
            c.call("tc_mesh_read_values", ctypes.byref(moved), self._handle, c.encoded(path), ctypes.byref(options),
                   c.LOG)
        except Error:
            if not moved.value:
                raise
            self._finalizer()
            self._take(moved, *self._prepare)
        self._path, self._report = path, None
        c.tell()

    @property
    def report(self):
        """What the mesh is and what was repaired: the fields of tc_mesh_report in a dict, without what was not measured."""
        if self._report is None:
            report = c.tc_mesh_report()
            c.lib.tc_mesh_get_report(ctypes.byref(report), self._handle)
            made = c.as_dict(report)
            made["association"] = {1: "point", 2: "cell"}.get(report.association)
            made["reentry"] = next(name for name, value in _REENTRY.items() if value == report.reentry)
            self._report = made
        return dict(self._report)

    @property
    def bounds(self):
        """xmin, xmax, ymin, ymax, zmin, zmax."""
        return self.report["bounds"]

    @property
    def n_points(self):
        """As many as were given; of a file those that cells use, after splitting."""
        return self._shape[0] if self._shape else self.report["n_vertex"]

    @property
    def n_cells(self):
        """As many as were given; of a file its three-dimensional cells before splitting."""
        return self._shape[1] if self._shape else self.report["source_cells"]

    @property
    def scalar_range(self):
        """Of finite values."""
        return self.report["scalar_range"]

    @property
    def unit_distance(self):
        """The length over which opacity acts where opacity_unit_distance is not given."""
        return c.lib.tc_default_unit_distance(self._handle)

    @property
    def source(self):
        """What the file held: path, format, field, arrays [(name, association)], times, step. None without a file."""
        found = c.lib.tc_mesh_source(self._handle)
        if not found:
            return None
        s = found.contents
        made = {name: (getattr(s, name) or b"").decode("utf-8", "replace") for name in ("path", "format", "field")}
        made["arrays"] = [(array.name.decode("utf-8", "replace"), {1: "point", 2: "cell"}.get(array.association))
                          for array in s.array[:s.n_array]]
        made["times"], made["step"] = s.time[:s.n_time], s.step
        return made

    def camera(self, cpos="xy", window_size=(512, 512), view_angle=30, parallel_projection=False):
        """A camera that sees the whole mesh: cpos "xy", "yx", "xz", "zx", "yz", "zy", "iso", or direction to the eye."""
        return Camera._fit(self, cpos, _size(window_size), view_angle, parallel_projection)

    def render(self, *arguments, **options):
        """tetcast.render of this mesh."""
        return render(self, *arguments, **options)

    def save(self, path):
        """Writes tetrahedra and field as a VTU file."""
        c.call("tc_mesh_write_vtu", self._handle, c.encoded(path))

    def __repr__(self):
        low, high = self.scalar_range
        return f"<tetcast.Mesh: {self.n_points} points, {self.n_cells} cells, scalars {low:g} to {high:g}>"


def _cells(cells, n_points):
    made = np.asarray(cells)
    if made.dtype.kind not in "iu":
        raise ArgumentError(f"cells: whole numbers are needed, not {made.dtype.name}")
    if made.ndim != 2 or made.shape[1] != 4:
        raise ArgumentError(f"cells has the shape {made.shape}; n x 4 point ids of tetrahedra are needed"
                            + ("; of cells that begin with their number of points give cells[:, 1:]"
                               if made.ndim == 2 and made.shape[1] == 5 else ""))
    if made.dtype.itemsize > 4 or made.dtype.kind == "u":  # ids that int32 would change
        wrong = np.flatnonzero((made < 0).any(axis=1) | (made >= n_points).any(axis=1))
        if len(wrong):
            raise ArgumentError(f"cells: cell {wrong[0]} {made[wrong[0]].tolist()} names a point that is not there; "
                                f"ids of the {n_points} points begin at 0")
    return np.ascontiguousarray(made, np.int32)


def _read_options(scalars, step, time, association):
    options = c.tc_read_options(
        field=None if scalars is None else str(scalars).encode(),
        association=_choice("association", association, _ASSOCIATIONS))
    if step is not None and time is not None:
        raise ArgumentError("give either a step or a time")
    if step is not None:
        options.has_step, options.step = True, int(step)
    if time is not None:
        options.has_time, options.time = True, float(time)
    return options


def read(path, scalars=None, step=None, time=None, association=None, *, reentry="auto", threads=0):
    """A Mesh of a file: VTK, Exodus II, EnSight, OpenFOAM, CGNS, PVD and others (docs/formats.md).

    scalars: "NAME", "NAME:COMPONENT" or "NAME:magnitude", default the first array; step from 0 (negative: from the end), or
    the last step at or before time."""
    path = os.fspath(path)
    options = _read_options(scalars, step, time, association)
    handle = ctypes.c_void_p()
    c.call("tc_mesh_read", ctypes.byref(handle), c.encoded(path), ctypes.byref(options), c.LOG)
    return Mesh._wrap(handle, reentry, threads, path)


def synth(name, n_cells=0, seed=0, *, reentry="auto", threads=0):
    """A synthetic Mesh of about n_cells tetrahedra; `tetcast synth --list` names them."""
    handle = ctypes.c_void_p()
    c.call("tc_synth_create", ctypes.byref(handle), c.encoded(name), n_cells, seed)
    return Mesh._wrap(handle, reentry, threads)


# ---------------------------------------------------------------------------------------------------------- camera


def _field(name, what):
    def get(self):
        value = getattr(self._c, name)
        return tuple(value) if isinstance(value, ctypes.Array) else value

    def put(self, value):
        setattr(self._c, name, tuple(_triple(what, value)) if name in ("position", "focal_point", "view_up") else value)

    return property(get, put, doc=what)


class Camera:
    """ParaView's camera. Mesh.camera makes one that sees the whole mesh."""

    position = _field("position", "where the eye is")
    focal_point = _field("focal_point", "what it looks at")
    view_up = _field("view_up", "the direction that is up in the picture")
    view_angle = _field("view_angle", "of the picture's height, in degrees")
    parallel_scale = _field("parallel_scale", "half the picture's height in the mesh's unit, of a parallel projection")
    parallel_projection = _field("parallel", "whether rays are parallel")

    def __init__(self, position, focal_point, view_up, view_angle=30, parallel_projection=False, parallel_scale=1):
        self._c = c.tc_camera(view_angle=view_angle, parallel=bool(parallel_projection), parallel_scale=parallel_scale)
        self.position, self.focal_point, self.view_up = position, focal_point, view_up

    @classmethod
    def _fit(cls, mesh, cpos, size, view_angle=30, parallel=False):
        if isinstance(cpos, str):
            direction, up = _choice("cpos", cpos.lower(), _VIEWS)
        else:
            direction = _triple("cpos", cpos)
            if not direction.any():
                raise ArgumentError("cpos: the direction to the eye has no length")
            up = (0, 1, 0) if direction[0] == direction[1] == 0 else (0, 0, 1)
        camera = cls.__new__(cls)
        camera._c = c.tc_camera(parallel=bool(parallel))
        vectors = [np.array(v, np.float64) for v in (mesh.bounds, direction, up)]
        c.lib.tc_camera_reset(ctypes.byref(camera._c), *map(_pointer, vectors), view_angle, size[0] / size[1])
        return camera

    def azimuth(self, degrees):
        """Turns the eye about the focal point, around view_up."""
        c.lib.tc_camera_azimuth(ctypes.byref(self._c), degrees)

    def elevation(self, degrees):
        """Turns the eye about the focal point, up."""
        c.lib.tc_camera_elevation(ctypes.byref(self._c), degrees)

    def roll(self, degrees):
        """Turns the picture."""
        c.lib.tc_camera_roll(ctypes.byref(self._c), degrees)

    def zoom(self, factor):
        """Above 1: narrows what is seen."""
        c.lib.tc_camera_zoom(ctypes.byref(self._c), factor)

    def copy(self):
        """Another camera that looks the same way."""
        made = Camera.__new__(Camera)
        made._c = c.tc_camera.from_buffer_copy(self._c)
        return made

    def __repr__(self):
        return f"tetcast.Camera({self.position}, {self.focal_point}, {self.view_up}, {self.view_angle})"


def _camera(camera, mesh, size):
    """A Camera of what PyVista calls a camera position, too."""
    if isinstance(camera, Camera):
        return camera
    if camera is None or isinstance(camera, str):
        return Camera._fit(mesh, "xy" if camera is None else camera, size)
    if np.shape(camera) == (3, 3):
        return Camera(*camera)
    if np.shape(camera) == (3,):
        return Camera._fit(mesh, camera, size)
    raise ArgumentError(f"camera is {camera!r}; give a tetcast.Camera, one of {', '.join(_VIEWS)}, the direction to the "
                        "eye, or (position, focal_point, view_up)")


# ----------------------------------------------------------------------------------------------- transfer function


def color_maps():
    """Names of the built-in colour maps."""
    n = ctypes.c_size_t()
    names = c.lib.tc_transfer_builtin(ctypes.byref(n))
    return [names[i].decode() for i in range(n.value)]


def _range(clim, data_range):
    """The scalars a map is laid over; of a single one a little around it, as the library does."""
    if clim is None:
        low, high = data_range if np.isfinite(data_range).all() and data_range[0] <= data_range[1] else (0.0, 1.0)
    else:
        low, high = (-abs(clim), abs(clim)) if np.ndim(clim) == 0 else _numbers("clim", clim, (2,)).tolist()
    if not (np.isfinite([low, high]).all() and low <= high):
        raise ArgumentError(f"clim is {low:g}, {high:g}; it must be finite and ascending")
    if low == high:
        widen = abs(low) / 1024 or 0.5
        return low - widen, high + widen
    return float(low), float(high)


def _color_text(cmap, log_scale, clim):
    """What the library takes as a colour map, and the range it is over (None: that of clim)."""
    if cmap is None or isinstance(cmap, (str, os.PathLike)):
        return c.encoded(cmap), None
    span = None
    if callable(cmap):  # matplotlib's
        colors = _numbers("cmap", np.asarray(cmap(np.linspace(0, 1, 256)))[..., :3], (None, 3))
    else:
        colors = _numbers("cmap", cmap)
    if colors.ndim != 2 or colors.shape[1] not in (3, 4) or len(colors) < 2 or not np.isfinite(colors).all():
        raise ArgumentError(f"cmap has the shape {colors.shape}; a name, a file, n x 3 finite colours r, g, b (n at "
                            "least 2) or n x 4 knots s, r, g, b are needed")
    x = np.arange(len(colors), dtype=np.float64)
    if colors.shape[1] == 4:
        x, colors = colors[:, 0], colors[:, 1:]
        if (np.diff(x) < 0).any() or x[0] == x[-1] or (log_scale and x[0] <= 0):
            raise ArgumentError("cmap: the scalars s of the knots s, r, g, b must ascend" + (
                " and be above 0" if log_scale else "") + "; of colours r, g, b, a give cmap[:, :3]")
        span = None if clim is not None else (float(x[0]), float(x[-1]))
        x = np.log10(x) if log_scale else x
    if colors.min() < 0 or colors.max() > 1:
        raise ArgumentError("cmap: colours must lie in 0 … 1; divide those of 8 bits by 255")
    points = np.column_stack([x, colors]).ravel().tolist()
    return json.dumps([{"Name": "from Python", "ColorSpace": "RGB", "RGBPoints": points}]).encode(), span


def _opacity_text(opacity, span, log_scale):
    if opacity is None or isinstance(opacity, (str, os.PathLike)):
        return c.encoded(opacity)
    values = _numbers("opacity", opacity)
    if values.ndim == 0 or values.shape == (1,):
        values = np.full(2, values.ravel()[0])
    if values.ndim == 1 and len(values) > 1:
        if log_scale and span[0] > 0:
            places = np.logspace(np.log10(span[0]), np.log10(span[1]), len(values))
            places[0], places[-1] = span
        else:
            places = np.linspace(*span, len(values))
        values = np.column_stack([places, values])
    good = values.ndim == 2 and values.shape[1] == 2 and len(values) and np.isfinite(values).all()
    if not good or values[:, 1].min() < 0:
        raise ArgumentError(f"opacity has the shape {values.shape}; a name, a file, one attenuation, n of them over clim, "
                            "or n x 2 pairs scalar, attenuation are needed, finite and not below 0")
    return ",".join(f"{s!r}:{a!r}" for s, a in values.tolist()).encode()


class TransferFunction:
    """Colour and attenuation of the scalar; give it to render as cmap. Parameters as of tetcast.render; data_range is what
    clim is where it is not given."""

    def __init__(self, cmap=None, opacity=None, clim=None, log_scale=False, data_range=(0, 1), preset=None):
        self._make(_transfer_request(cmap, opacity, clim, log_scale, data_range, preset))

    @classmethod
    def _of(cls, request):
        made = cls.__new__(cls)
        made._make(request)
        return made

    def _make(self, request):
        self._request = request
        color_map, preset, opacity, span, data_range, log_scale = request[:6]
        options = c.tc_transfer_options(color_map=color_map, preset=preset, opacity=opacity, log=log_scale)
        options.has_range = span is not None
        options.range = span or (0, 0)
        options.data_range = data_range
        handle = ctypes.c_void_p()
        c.call("tc_transfer_create", ctypes.byref(handle), ctypes.byref(options))
        self._handle = handle
        weakref.finalize(self, c.free, "tc_transfer_destroy", handle.value).atexit = False

    @property
    def name(self):
        return c.lib.tc_transfer_name(self._handle).decode("utf-8", "replace")

    @property
    def knots(self):
        """(n, 5) float64: s, r, g, b, attenuation per unit distance; linear between, a step at two equal s. A copy."""
        n = ctypes.c_size_t()
        knots = c.lib.tc_transfer_knots(self._handle, ctypes.byref(n))
        return np.ctypeslib.as_array(ctypes.cast(knots, ctypes.POINTER(ctypes.c_double)), (n.value, 5)).copy()


def _transfer_request(cmap, opacity, clim, log_scale, data_range, preset):
    """Everything a TransferFunction depends on: equal requests make equal functions. Files count by size and time."""
    data_range = tuple(float(v) for v in data_range)
    text, span = _color_text(cmap, log_scale, clim)
    if clim is not None:
        span = _range(clim, data_range)
    if log_scale and span is None and not data_range[0] > 0:
        raise ArgumentError(f"log_scale needs scalars above 0, not from {data_range[0]:g}; give clim=(LO, HI) with LO "
                            "above 0")
    opacity_text = _opacity_text(opacity, span or _range(None, data_range), log_scale)
    files = []
    for name in (cmap, opacity):
        if isinstance(name, (str, os.PathLike)) and os.path.exists(name):
            state = os.stat(name)
            files.append((state.st_size, state.st_mtime_ns))
    return (text, c.encoded(preset), opacity_text, span, data_range, bool(log_scale), tuple(files))


# ---------------------------------------------------------------------------------------------------------- images


class _Pixels:
    """Keeps a picture of the library as long as an array that shows it."""

    def __init__(self, image):
        struct = ctypes.cast(image, ctypes.POINTER(c.tc_image)).contents
        self.__array_interface__ = {
            "shape": (struct.height, struct.width, 4), "typestr": np.dtype(np.float32).str,
            "data": (struct.rgba, False), "version": 3
        }
        weakref.finalize(self, c.free, "tc_image_destroy", image.value).atexit = False


def _image_array(image):
    return np.asarray(_Pixels(image))


def _image_struct(image):
    """A tc_image over an array's memory, and the array that must outlive it."""
    array = np.asarray(image)
    if array.dtype.kind != "f" or array.ndim != 3 or array.shape[2] != 4 or not array.size:
        raise ArgumentError(f"the image has the shape {array.shape} of {array.dtype.name}; H x W x 4 floats as render "
                            "makes them are needed")
    array = np.ascontiguousarray(array, np.float32)
    return c.tc_image(width=array.shape[1], height=array.shape[0], rgba=_pointer(array)), array


def straight(image):
    """A copy whose colours are not multiplied by alpha; 0 where alpha is."""
    made = np.array(image, np.float32)
    np.divide(made[..., :3], made[..., 3:], out=made[..., :3], where=made[..., 3:] > 0)
    made[..., :3][made[..., 3] <= 0] = 0
    return made


def to_uint8(image):
    """H x W x 4 uint8, not premultiplied, as a PNG file holds the picture."""
    return (np.clip(straight(image), 0, 1) * np.float32(255) + np.float32(0.5)).astype(np.uint8)


def save(image, path, metadata=None, *, bits=0, quality=0, level=0):
    """Writes .png, .exr, .tif or .jpg, whole or not at all. metadata: a dict of texts. bits a channel (PNG 8, 16; EXR 32,
    16), quality of JPEG (1 to 100), level of PNG's compression (1 to 9, -1 none); 0: the format's default."""
    struct, _array = _image_struct(image)
    pairs = [(str(key).encode(), str(value).encode()) for key, value in (metadata or {}).items()]
    meta = (c.tc_text_pair * len(pairs))(*pairs)
    if not (bits or quality or level):
        c.call("tc_image_write", ctypes.byref(struct), c.encoded(path), meta, len(pairs), c.LOG)
    else:
        encoding = c.tc_image_encoding(bits=bits, quality=quality, level=level)
        writer = ctypes.c_void_p()
        c.call("tc_image_writer_create", ctypes.byref(writer))
        try:
            c.call("tc_image_writer_save", writer, ctypes.byref(struct), c.encoded(path), ctypes.byref(encoding), meta,
                   len(pairs), c.LOG)
        finally:
            c.free("tc_image_writer_destroy", writer.value)
    c.tell()


def read_image(path):
    """A picture's file as render makes pictures: H x W x 4 float32, premultiplied."""
    image = ctypes.c_void_p()
    c.call("tc_image_read", ctypes.byref(image), c.encoded(path))
    return _image_array(image)


# ---------------------------------------------------------------------------------------------------------- render


def _size(window_size):
    try:
        width, height = (int(n) for n in window_size)
    except (TypeError, ValueError):
        width = height = 0
    if not (0 < width <= 1 << 30 and 0 < height <= 1 << 30):
        raise ArgumentError(f"window_size is {window_size!r}; width and height in pixels are needed")
    return width, height


def _color(what, color):
    """Four numbers, not premultiplied."""
    if color is None or isinstance(color, str):
        text = color.lower() if color else color
        if text in _COLORS:
            return _COLORS[text]
        if text.startswith("#") and len(text) == 7 and not set(text[1:]) - set("0123456789abcdef"):
            return tuple(int(text[i:i + 2], 16) / 255 for i in (1, 3, 5)) + (1,)
    elif np.shape(color) in ((3,), (4,)):
        made = tuple(_numbers(what, color).tolist()) + (1.0,)
        if all(0 <= v <= 1 for v in made):
            return made[:4]
    raise ArgumentError(f"{what} is {color!r}; three or four numbers in 0 … 1, \"#rrggbb\", \"white\", \"black\" or "
                        "\"transparent\" are needed")


def _look(model, shade, isosurfaces, light):
    """tc_look, or None where the picture is plain, and what it points to."""
    look = c.tc_look(model=_choice("model", model, _MODELS))
    values = [] if isosurfaces is None else np.unique(np.atleast_1d(_numbers("isosurfaces", isosurfaces))).tolist()
    isos = (c.tc_iso * len(values))(*[c.tc_iso(value=value, opacity=1) for value in values])
    look.n_iso, look.iso = len(values), ctypes.cast(isos, ctypes.c_void_p)
    gradient = _choice("shade", shade, _SHADES)
    light = {name: value for name, value in light.items() if value is not None}
    if light and not gradient:
        raise ArgumentError(f"{', '.join(light)}: there is light only with shade=True")
    if gradient:
        c.lib.tc_shade_defaults(ctypes.byref(look.shade))
        look.shade.gradient = gradient
        for name, value in light.items():
            setattr(look.shade, name, value)
    return (look if look.model or values or gradient else None), isos


class Renderer:
    """Makes pictures, and keeps between them what stays: the mesh and the transfer function on the GPU, programs. Another
    frame of the same mesh costs the rays alone. It belongs to the thread that made it; each thread may have its own.

    gl "osmesa", "egl"; driver "pingpong", "compute", "reference"; None: chosen. threads 0: all cores."""

    def __init__(self, gl=None, driver=None, threads=0):
        options = c.tc_renderer_options(gl=c.encoded(gl), driver=c.encoded(driver), threads=int(threads))
        handle = ctypes.c_void_p()
        c.call("tc_renderer_create", ctypes.byref(handle), ctypes.byref(options), c.LOG)
        self._handle, self._thread = handle, threading.get_ident()
        self._finalizer = weakref.finalize(self, c.free, "tc_renderer_destroy", handle.value)
        self._finalizer.atexit = False  # the GL context goes with the process
        self._transfer = self._last = None
        self._threads = int(threads)
        self._stats = {}
        c.tell()

    def close(self):
        """Frees what is on the GPU; the renderer is not used any more. Also at the end of a `with`."""
        self._finalizer()

    def __enter__(self):
        return self

    def __exit__(self, *_error):
        self.close()

    @property
    def stats(self):
        """Of the last picture: the fields of tc_render_stats in a dict, without those that were not measured."""
        return dict(self._stats)

    def _function(self, mesh, cmap, opacity, clim, log_scale, preset):
        if isinstance(cmap, TransferFunction):
            if opacity is not None or clim is not None or log_scale or preset is not None:
                raise ArgumentError("cmap is a TransferFunction, which has its own opacity, clim, log_scale and preset")
            return cmap
        request = _transfer_request(cmap, opacity, clim, log_scale, mesh.scalar_range, preset)
        if self._transfer is None or self._transfer._request != request:
            self._transfer = TransferFunction._of(request)
        return self._transfer

    def render(self, mesh, cmap=None, clim=None, opacity=None, opacity_unit_distance=None, *, camera=None,
               window_size=(512, 512), background=None, log_scale=False, shade=False, ambient=None, diffuse=None,
               specular=None, specular_power=None, model="density-emitter", isosurfaces=None, nan_color=None,
               nan_opacity=1.0, preset=None, samples=1, integrator="auto", opacity_stop=0, count=False):
        """A picture of mesh: H x W x 4 float32, premultiplied; row 0 is the top. Parameters: docs/python.md."""
        if not self._finalizer.alive:
            raise ArgumentError("the renderer was closed")
        if threading.get_ident() != self._thread:
            raise ArgumentError("a renderer belongs to the thread that made it; make one in each thread")
        if not isinstance(mesh, Mesh):
            raise ArgumentError(f"mesh is a {type(mesh).__name__}; give a tetcast.Mesh, as of tetcast.read")
        options = c.tc_render_options()
        c.lib.tc_render_defaults(ctypes.byref(options))
        size = _size(window_size)
        options.width, options.height = size
        options.integrator = _choice("integrator", integrator, _INTEGRATORS)
        options.samples = _choice("samples", samples, _SAMPLES)
        options.opacity_stop, options.count = opacity_stop, bool(count)
        if opacity_unit_distance is not None:
            options.unit_distance = float(opacity_unit_distance)
            if not (np.isfinite(options.unit_distance) and options.unit_distance > 0):
                raise ArgumentError(f"opacity_unit_distance is {opacity_unit_distance!r}; a length above 0 is needed")
        if nan_color is not None:
            options.has_nan_color = True
            options.nan_color = (*_color("nan_color", nan_color)[:3], float(nan_opacity))
        light = {"ambient": ambient, "diffuse": diffuse, "specular": specular, "power": specular_power}
        look, isos = _look(model, shade, isosurfaces, light)
        options.look = None if look is None else ctypes.addressof(look)
        behind = _color("background", background)
        function = self._function(mesh, cmap, opacity, clim, log_scale, preset)
        camera = _camera(camera, mesh, size).copy()
        image, stats = ctypes.c_void_p(), c.tc_render_stats()
        try:
            c.call("tc_render", ctypes.byref(image), ctypes.byref(stats), self._handle, mesh._handle, function._handle,
                   ctypes.byref(camera._c), ctypes.byref(options), c.LOG)
        except Error:
            if image.value:  # rays were lost: such a picture is not given out
                c.free("tc_image_destroy", image.value)
            raise
        made = _image_array(image)
        if behind[3] > 0:
            over = np.array(behind, np.float32)
            over[:3] *= over[3]
            c.lib.tc_image_background(image, _pointer(over))
        self._stats = {
            name: value for name, value in c.as_dict(stats).items()
            if isinstance(value, str) or value >= 0 or name == "samples"
        }
        del self._stats["n_fragments_per_pass"]
        if stats.n_fragments_per_pass:
            self._stats["fragments_per_pass"] = stats.fragments_per_pass[:stats.n_fragments_per_pass]
        self._last = weakref.ref(made), behind, weakref.ref(mesh), function, camera, options, look, isos
        c.tell()
        return made

    def verify(self, image, pixels=4096, seed=0):
        """Traces so many pixels of the last picture again in double precision, and says how wrong it is: the fields of
        tc_verify_result in a dict. The picture must have been made without a background."""
        if self._last is None or self._last[0]() is not image:
            raise ArgumentError("only the last picture of this renderer can be verified")
        _made, behind, mesh, function, camera, options, _look_kept, _isos = self._last
        mesh = mesh()
        if mesh is None:
            raise ArgumentError("the picture's mesh is gone; keep it until the picture is verified")
        if behind[3] > 0:
            raise ArgumentError("a picture over a background cannot be verified; render it without one")
        struct, _array = _image_struct(image)
        result = c.tc_verify_result()
        c.call("tc_verify", ctypes.byref(result), ctypes.byref(struct), pixels, seed, mesh._handle, function._handle,
               ctypes.byref(camera._c), ctypes.byref(options), c.LOG)
        c.tell()
        made = c.as_dict(result)
        del made["rays_lost"]  # of a picture not known; see stats
        return made


_of_thread = threading.local()


def render(mesh, cmap=None, clim=None, opacity=None, opacity_unit_distance=None, **options):
    """A picture of mesh: H x W x 4 float32, premultiplied; row 0 is the top. Parameters: Renderer.render, docs/python.md.
    Uses a renderer that is kept for the calling thread, so that another picture of the same mesh costs little."""
    if not hasattr(_of_thread, "renderer"):
        _of_thread.renderer = Renderer()
    return _of_thread.renderer.render(mesh, cmap, clim, opacity, opacity_unit_distance, **options)
