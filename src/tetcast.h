/* tetcast.h: the one public header of libtetcast.
 *
 * tetcast casts rays through tetrahedral meshes (Weiler, Kraus, Merz, Ertl 2003). A program makes a mesh (from
 * arrays, from a file, or synthetic), prepares it once, makes a transfer function and a camera, and renders to a
 * float image or into a framebuffer of a GL context that it owns.
 *
 * Conventions: every function that can fail returns a tc_status and fills *err (may be NULL) with one sentence.
 * The library never prints, never exits, keeps no globals. Objects come from *_create / *_read and go with
 * *_destroy(T **), which accepts NULL and nulls the pointer. `const` pointers are borrowed for the call.
 */
#ifndef TETCAST_H
#define TETCAST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define TC_API __attribute__((visibility("default")))
#else
#define TC_API
#endif

#define TC_VERSION_STRING "0.1.0"

/* ------------------------------------------------------------------------------------------ status and talk */

typedef enum tc_status {
    TC_OK = 0,
    TC_E_ARG = -1,    /* an argument is out of its range */
    TC_E_MEMORY = -2, /* memory or GPU memory ran out */
    TC_E_FILE = -3,   /* a file could not be read or written */
    TC_E_MESH = -4,   /* the mesh cannot be rendered */
    TC_E_GL = -5,     /* no GL context, or GL failed */
    TC_E_WORKER = -6, /* a helper program failed */
    TC_E_LOST = -7,   /* a ray was lost: an error of ours, the picture is not to be trusted */
    TC_E_EMPTY = -8,  /* nothing would be seen */
    TC_E_CANCEL = -9, /* the caller asked to stop */
    TC_E_ACCURACY = -10, /* no setting reaches the error that was asked for */
    TC_E_MOVED = -11 /* the mesh in the file is not the one that was to take its values */
} tc_status;

typedef struct tc_error {
    tc_status code;
    char text[1024]; /* one sentence: the file, what is wrong, the remedy */
} tc_error;

typedef enum tc_level { TC_WARNING = 0, TC_INFO = 1, TC_DEBUG = 2 } tc_level;

/* How the library talks. Each function may be NULL. Called from the thread that called the library. */
typedef struct tc_log {
    void (*message)(void *user, tc_level level, const char *text);
    void (*progress)(void *user, const char *what, double fraction); /* fraction < 0: not known */
    void *user;
} tc_log;

TC_API const char *tc_version(void);

/* ------------------------------------------------------------------------------------------------------ mesh */

typedef enum tc_association { TC_ANY_DATA = 0, TC_POINT_DATA = 1, TC_CELL_DATA = 2 } tc_association;

typedef struct tc_mesh tc_mesh;

/* A mesh as plain arrays, borrowed for the call of tc_mesh_create. */
typedef struct tc_mesh_arrays {
    size_t n_vertex;
    const double *vertex; /* [n_vertex][3] */
    size_t n_tet;
    const int32_t *tet;   /* [n_tet][4] vertex ids, either orientation */
    const double *scalar; /* [n_vertex] or [n_tet] by association; NULL: no field (0 everywhere) */
    tc_association association;
    const char *field_name; /* may be NULL */
} tc_mesh_arrays;

/* Copies the arrays into a new mesh. Errors: TC_E_ARG, TC_E_MEMORY, TC_E_MESH (an id out of range; names the tet). */
TC_API tc_status tc_mesh_create(tc_mesh **out, const tc_mesh_arrays *arrays, tc_error *err);
TC_API void tc_mesh_destroy(tc_mesh **mesh);

/* New values on the same mesh, prepared or not; scalar has the length of the arrays that made the mesh, in their order, and
 * may be of the other association than before. A renderer that holds the mesh packs and uploads the values alone.
 * Errors: TC_E_ARG; TC_E_MESH (points at one place that were merged since their values were equal now have different ones:
 * make the mesh anew); TC_E_MEMORY. On failure the mesh is as it was. Cost: O(vertices), or O(tets) for cell data. */
TC_API tc_status tc_mesh_set_scalar(tc_mesh *mesh, const double *scalar, tc_association association, tc_error *err);

typedef enum tc_reentry { TC_REENTRY_AUTO = 0, TC_REENTRY_CONVEXIFY = 1, TC_REENTRY_PEEL = 2 } tc_reentry;

typedef struct tc_prepare_options {
    tc_reentry reentry;       /* how rays cross gaps; AUTO: convexify, and peel if that fails */
    double convexify_limit_s; /* time limit of the TetGen helper; 0: 120 s */
    int threads;              /* 0: all cores */
    size_t once_pixels;       /* of the one picture that this is for; 0: more may follow. AUTO then peels where that is
                                 sooner than filling the gaps; a later call with 0 fills them */
} tc_prepare_options;

/* Checks and repairs the mesh, orders it along a Hilbert curve, links neighbours and fills gaps. Must precede
 * rendering; a second call with another reentry redoes only the gaps. Errors: TC_E_MESH, TC_E_MEMORY, TC_E_WORKER
 * (only with TC_REENTRY_CONVEXIFY). Cost: O(n log n) time. */
TC_API tc_status tc_mesh_prepare(tc_mesh *mesh, const tc_prepare_options *options, const tc_log *log, tc_error *err);

/* What a mesh is and what was done to it. Counts of repairs are 0 before tc_mesh_prepare. */
typedef struct tc_mesh_report {
    size_t n_vertex, n_tet;      /* after repair, without imaginary ones */
    size_t n_imaginary;          /* imaginary tets */
    size_t n_steiner;            /* points TetGen added, in imaginary tets only */
    size_t n_boundary_face;      /* faces of real tets without a real neighbour */
    size_t n_component;          /* face-connected parts */
    size_t dropped_degenerate;   /* tets, of a file cells, that repeated vertices so that nothing was left */
    size_t dropped_nonfinite;    /* tets with a non-finite vertex */
    size_t dropped_duplicate;    /* tets equal to another one */
    size_t reoriented;           /* tets, of a file cells, turned to positive volume */
    size_t zero_volume;          /* tets of zero volume, kept */
    size_t merged_vertices;      /* coincident points merged */
    size_t unused_vertices;      /* points no tet, of a file no cell, uses; dropped */
    size_t unlinked_faces;       /* faces with three cells, or two on one side: treated as boundaries */
    size_t faces_of_many;        /* of them, those with three cells or more */
    size_t faces_one_side;       /* of them, those between two cells on one side, which overlap */
    size_t nonfinite_scalars;    /* NaN or Inf values */
    size_t nonfinite_cells;      /* tets with such a value, at a corner or their own: transparent, or has_nan_color */
    bool convex;                 /* the real tets alone fill their hull */
    tc_reentry reentry;          /* what is in force: CONVEXIFY or PEEL */
    char reentry_why[256];       /* why not the asked way; "" if it is */
    double bounds[6];            /* xmin xmax ymin ymax zmin zmax */
    double scalar_range[2];      /* of finite values */
    double longest_edge;         /* of real tets */
    double volume;               /* sum over real tets */
    tc_association association;
    double ms_check, ms_adjacency, ms_order, ms_convexify; /* NaN: not measured, nothing of the kind was done */
    size_t source_cells;         /* cells of the file before splitting, 3-D only; n_tet for meshes from arrays */
} tc_mesh_report;

TC_API void tc_mesh_get_report(tc_mesh_report *out, const tc_mesh *mesh);

/* The length over which opacity acts when tc_render_options.unit_distance is 0: bounds diagonal / cbrt(cells), with
 * the cells of the file before splitting (source_cells), as ParaView does; in the mesh's unit, always above 0. */
TC_API double tc_default_unit_distance(const tc_mesh *mesh);

/* ------------------------------------------------------------------------------------------------------ files */

typedef struct tc_read_options {
    const char *field;          /* "NAME", "NAME:COMPONENT", "NAME:magnitude"; NULL: the first array there is */
    tc_association association; /* TC_ANY_DATA: point data first */
    bool has_time, has_step;
    double time;                /* nearest step at or before it; has_time */
    int step;                   /* 0-based, negative from the end; has_step */
    int refine;                 /* splits each curved (quadratic) simplex 1:8 this many times first; 0 none */
    double idle_limit_s;        /* the reader is stopped after this long without progress; 0: 60 s */
    bool all_ranges;            /* read every array for its range, not only the one taken; always so without field */
    bool keep_reader;           /* tetcast-read goes on until the mesh is destroyed, for tc_mesh_read_values */
} tc_read_options;

/* One array a file offers. */
typedef struct tc_array_info {
    const char *name;
    tc_association association;
    int components; /* 0: not read */
    double lo, hi; /* finite range; of the magnitude where components > 1; lo > hi when nothing is finite; NaN: not read */
} tc_array_info;

/* One block of a file of several, by what the cell array of block numbers that is made for such files calls it: the last of
 * the arrays, "ObjectId" (Exodus II: the block's id) or "vtkCompositeIndex" (VTK's flat index in the tree of blocks). */
typedef struct tc_block_info {
    int64_t number;
    const char *name; /* NULL: it has none */
} tc_block_info;

/* One kind of cell a file holds. */
typedef struct tc_cell_info {
    const char *type; /* "hexahedron", "quadratic_tetra", … */
    int dimension;    /* 3: rendered; 0..2: left out */
    size_t count;
} tc_cell_info;

/* What a file held, as the reader saw it. Strings and arrays belong to the mesh. */
typedef struct tc_source {
    const char *path, *format, *reader; /* "bluntfin.vtu", "VTK XML unstructured grid", "vtkXMLUnstructuredGridReader" */
    const char *field;                  /* the array that was taken, as "NAME:magnitude"; NULL: none */
    size_t n_point, n_cell;
    size_t n_array;
    const tc_array_info *array;
    size_t n_block; /* 0: one block, or the file has an array of such numbers itself */
    const tc_block_info *block;
    size_t n_cell_type;
    const tc_cell_info *cell_type;
    size_t n_time;
    const double *time; /* [n_time] */
    int step;           /* the step that was read, -1: the file has none */
    size_t dropped_cells;   /* 2-D, 1-D, 0-D and broken cells left out */
    bool linearised;        /* quadratic cells became linear tets */
    int refine;             /* levels of refinement applied */
    size_t n_note;
    const char *const *note; /* sentences a user should see */
    double ms_read;
    size_t helper_peak_bytes;
} tc_source;

/* Reads one step of a file through tetcast-read. Chooses the format by content, then extension.
 * Errors: TC_E_FILE (unreadable, no 3-D cells, missing array: lists those there are), TC_E_WORKER. */
TC_API tc_status tc_mesh_read(tc_mesh **out, const char *path, const tc_read_options *options, const tc_log *log,
                              tc_error *err);
/* Another step or field of a mesh that tc_mesh_read made, prepared or not, from the same file or from another with the same
 * points and cells: only values are taken, so that all that was prepared stays, and the mesh's source and report are of
 * this step. Points and cells are compared bit by bit, through a hash of 64 bits.
 *   moved  NULL, or gets on TC_E_MOVED, and only then, the mesh of that step as tc_mesh_read would make it, not prepared
 * What tc_mesh_source gave for the mesh before is no longer valid. tetcast-read goes on until the mesh is destroyed, with
 * the idle_limit_s that it was started with: that of later options is not looked at while it runs.
 * Errors: as tc_mesh_read; TC_E_ARG (the mesh was not read from a file); TC_E_MOVED (points or cells are others, or points
 * at one place that were merged have different values now). On failure mesh is as it was. Cost: reading the file,
 * comparing 3 doubles a point and the cells' point numbers, O(vertices) or O(tets); cells are not split again. */
TC_API tc_status tc_mesh_read_values(tc_mesh **moved, tc_mesh *mesh, const char *path, const tc_read_options *options,
                                     const tc_log *log, tc_error *err);

/* tc_mesh_read_values on a thread of its own, so that the next step is read while this one is rendered. begin returns at
 * once; path and the texts of options are copied. Until the end mesh stays as it is and may be rendered and prepared; calls
 * that need its reader (tc_field_read, tc_mesh_read_values, tc_mesh_destroy) wait for it. prepare, may be NULL: a mesh that
 * moved is also prepared on that thread.
 * Errors: TC_E_ARG (also: a step is being read ahead for mesh already), TC_E_MEMORY; the others are told at the end. */
typedef struct tc_mesh_ahead tc_mesh_ahead;
TC_API tc_status tc_mesh_ahead_begin(tc_mesh_ahead **out, tc_mesh *mesh, const char *path, const tc_read_options *options,
                                     const tc_prepare_options *prepare, tc_error *err);
/* Waits for it, and puts the values onto mesh, the one of begin; *ahead is freed, whatever the result, and what was to be said
 * goes to log now. moved, status and errors as of tc_mesh_read_values, and those of tc_mesh_prepare (then *moved is NULL).
 * mesh NULL: what was read is not wanted any more; it is waited for, nothing is told, and the mesh, which may be gone, keeps
 * its values. */
TC_API tc_status tc_mesh_ahead_end(tc_mesh **moved, tc_mesh *mesh, tc_mesh_ahead **ahead, const tc_log *log,
                                   tc_error *err);

/* What a step's mesh will be like, found without making a mesh, and without splitting cells unless some may lose corners or
 * get points by it (polyhedra, folded and collapsed cells, curved ones that are refined). As the report of the prepared mesh,
 * to the bit, but that cells which are there twice with different cell data count with both. */
typedef struct tc_survey {
    tc_status status;    /* TC_OK, or why the step could not be read; the rest is then zeros */
    char why[256];       /* that in a sentence */
    double range[2];     /* of finite values, as tc_mesh_report.scalar_range; lo > hi: none is finite; 0, 0: no field */
    double bounds[6];    /* as tc_mesh_report.bounds */
    size_t source_cells; /* as tc_mesh_report.source_cells */
    double time;         /* of the step; NAN: the file has no times */
} tc_survey;

/* Surveys steps of a file in one go: out [n_step] of step [n_step]; step NULL: n_step is 1, the step of options. A step that
 * cannot be read is no error: its status tells.
 * Errors: TC_E_FILE, TC_E_WORKER (no step of the file can be read: as the first of them), TC_E_ARG. Cost: reading each step's
 * points and values, in a tetcast-read that is started for it and keeps the file open. */
TC_API tc_status tc_mesh_survey(tc_survey *out, const int *step, size_t n_step, const char *path,
                                const tc_read_options *options, const tc_log *log, tc_error *err);
/* The same of the steps of a series of files: out [n] of path [n], of each the step of options. */
TC_API tc_status tc_mesh_survey_files(tc_survey *out, const char *const *path, size_t n, const tc_read_options *options,
                                      const tc_log *log, tc_error *err);

/* NULL for a mesh made from arrays. */
TC_API const tc_source *tc_mesh_source(const tc_mesh *mesh);

/* ------------------------------------------------------------------------------------------------------ cache */

/* What a prepared mesh depends on: the bytes of its file, every setting of reading and preparing that changes the result,
 * and the builds of library and helpers. Of a dataset of several files (all but VTK's XML files without pieces and legacy
 * VTK) also names, sizes and times of all files in and below its folder, cache files, pictures, .csv and .json left out. */
typedef struct tc_cache_key {
    uint64_t word[2];
} tc_cache_key;

/* read and prepare may be NULL, as for tc_mesh_read and tc_mesh_prepare. To be made before the file is read, and again
 * after: only if both are equal was it read as it is.
 * Errors: TC_E_FILE (the file cannot be read; what belongs to the dataset cannot be told: it names files outside of its
 * folder, one was changed less than 50 ms ago, or there are more than 20 000), TC_E_MEMORY. Cost: reads the file once, some
 * GB/s; a stat and some bytes of each file of a folder. What HDF5 or OpenFOAM files include from outside of their folder
 * is not seen. */
TC_API tc_status tc_cache_key_make(tc_cache_key *out, const char *path, const tc_read_options *read,
                                   const tc_prepare_options *prepare, tc_error *err);
/* Writes a mesh that was read and prepared to the file `cache`: beside it, then renamed, so that readers and other writers
 * see an old or a new one. The mesh must hold the values that key stands for: not after tc_mesh_set_scalar or
 * tc_mesh_read_values. A file that neither is a cache file nor has a name that ends in .tccache is not written over.
 * Errors: TC_E_ARG (not prepared, or made from arrays), TC_E_FILE, TC_E_MEMORY. */
TC_API tc_status tc_mesh_save(const tc_mesh *mesh, const char *cache, const tc_cache_key *key, int threads, tc_error *err);
/* A mesh as it was saved, prepared; call tc_mesh_prepare all the same: it does nothing, or tries again what a helper could
 * not do then. path, of the mesh's file, is for tc_source. Times of the report, ms_read and helper_peak_bytes are not
 * measured (NaN, 0). What was wrong with the mesh goes to log again.
 * Errors: TC_E_FILE (no such file, another key, cut short or damaged: says which), TC_E_MEMORY. Cost: reads the file once. */
TC_API tc_status tc_mesh_load(tc_mesh **out, const char *cache, const tc_cache_key *key, const char *path, int threads,
                              const tc_log *log, tc_error *err);

/* -------------------------------------------------------------------------------------------------- synthetic */

typedef struct tc_synth_info {
    const char *name, *what, *field; /* "heatsink", one line, the analytic field in words */
} tc_synth_info;

/* The generators; *n gets their count. Static memory. */
TC_API const tc_synth_info *tc_synth_list(size_t *n);
/* Builds a synthetic dataset of about n_cells tets (0: its default). Errors: TC_E_ARG (unknown name: lists some),
 * TC_E_MESH (the dataset whose index is out of range), TC_E_MEMORY. */
TC_API tc_status tc_synth_create(tc_mesh **out, const char *name, size_t n_cells, uint64_t seed, tc_error *err);
/* Writes the real tets and the field of a mesh as a VTU file (raw appended data); whole or not at all. */
TC_API tc_status tc_mesh_write_vtu(const tc_mesh *mesh, const char *path, tc_error *err);

/* ------------------------------------------------------------------------------------------ transfer function */

typedef struct tc_transfer tc_transfer;

typedef struct tc_transfer_options {
    const char *color_map; /* name of a built-in map, a ParaView preset (.json, .xml), or the text of one, which begins with
                              { or [; NULL: "Cool to Warm" */
    const char *preset;    /* which map of a file that holds several; NULL: the first; refused of a built-in map */
    const char *opacity;   /* file, "S:A,S:A,…", "linear", "geom", "sigmoid"; NULL: the preset's own, else linear 0 to 0.3 */
    bool has_range;
    double range[2];       /* the scalars that the map spans; has_range, else data_range */
    double data_range[2];  /* of the field */
    bool log;              /* the map is laid over log10 of the scalar */
} tc_transfer_options;

/* Errors: TC_E_FILE, TC_E_ARG (unknown name: the nearest ones). */
TC_API tc_status tc_transfer_create(tc_transfer **out, const tc_transfer_options *options, tc_error *err);

/* One knot of a piecewise linear function: scalar, colour (display space, 0..1), attenuation per unit distance. */
typedef struct tc_knot {
    double s, r, g, b, a;
} tc_knot;

/* From knots, ascending in s; two knots at one s make a step. Outside, the end knots' values hold. */
TC_API tc_status tc_transfer_from_knots(tc_transfer **out, const tc_knot *knot, size_t n, tc_error *err);
/* The knots in force, borrowed. */
TC_API const tc_knot *tc_transfer_knots(const tc_transfer *tf, size_t *n);
/* The greatest attenuation that it gives to values from lo to hi, ends included. */
TC_API double tc_transfer_peak(const tc_transfer *tf, double lo, double hi);
TC_API const char *tc_transfer_name(const tc_transfer *tf);
/* Writes a ParaView preset (.json, or .xml by extension). */
TC_API tc_status tc_transfer_write(const tc_transfer *tf, const char *path, tc_error *err);
TC_API void tc_transfer_destroy(tc_transfer **tf);
/* Names of the built-in maps; *n gets their count. */
TC_API const char *const *tc_transfer_builtin(size_t *n);
typedef struct tc_text_pair tc_text_pair;
/* All maps of color_map, as of tc_transfer_options, in their order: of each its name (key) and, as value, a preset of it
 * alone in clean JSON, which that option takes again; points are in order, IndexedColors are points. Those that cannot be
 * used are left out. *out [*n] is one block from malloc with all texts in it. Errors: as tc_transfer_create. Cost: reads
 * the file once. */
TC_API tc_status tc_transfer_presets(tc_text_pair **out, size_t *n, const char *color_map, tc_error *err);

/* A function that errors and times are measured with: "smooth", "knots12", "spike" or "steps". */
typedef struct tc_standard_function {
    const char *name, *what;
} tc_standard_function;
/* All of them; *n gets their count. Static memory. */
TC_API const tc_standard_function *tc_transfer_standard_list(size_t *n);
/* Lays one over the data's range [2]. Errors: TC_E_ARG (unknown name: lists them), TC_E_MEMORY. */
TC_API tc_status tc_transfer_standard(tc_transfer **out, const char *name, const double range[2], tc_error *err);

/* ----------------------------------------------------------------------------------------------------- camera */

/* ParaView's camera. The image's vertical extent is view_angle degrees (perspective) or 2*parallel_scale. */
typedef struct tc_camera {
    double position[3], focal_point[3], view_up[3];
    double view_angle;     /* degrees */
    double parallel_scale; /* half the view's height in the mesh's unit */
    bool parallel;
    double clip_near, clip_far; /* only what lies between these distances before the eye's plane, along the view, is seen,
                                   in the mesh's unit; both 0: all that is before the eye, in
                                   parallel projection, too */
    double window_center[2]; /* what is in the picture's middle, in halves of its width and height right of and above the
                                direction of projection, as vtkCamera's WindowCenter: eyes of a stereo pair look past
                                each other so */
} tc_camera;

/* Whole box in view from direction (from focal point to eye), as vtkRenderer::ResetCamera does. Sets all of the camera,
 * clip_near, clip_far and window_center to 0, but not `parallel`: that is kept as it is, so set it yourself in a new one.
 *   bounds [6], direction [3], up [3]; aspect = width / height. */
TC_API void tc_camera_reset(tc_camera *camera, const double *bounds, const double *direction, const double *up,
                            double view_angle, double aspect);
TC_API void tc_camera_azimuth(tc_camera *camera, double degrees);
TC_API void tc_camera_elevation(tc_camera *camera, double degrees);
TC_API void tc_camera_roll(tc_camera *camera, double degrees);
TC_API void tc_camera_zoom(tc_camera *camera, double factor);

#include "tetcast_image.h"
#include "tetcast_look.h"
#include "tetcast_figure.h"
#include "tetcast_probe.h"

/* ----------------------------------------------------------------------------------------------------- render */

/* How a segment's colour and opacity are found (docs/architecture.md, "Segment integrals"): TABLE, the 2003 paper's
 * three-dimensional table; INTEGRAL, one-dimensional running integrals; EXACT, linear piece by linear piece of the
 * function; AUTO, the cheapest of the last two that is expected to err by less than a quarter of an 8-bit step. */
typedef enum tc_integrator {
    TC_INTEGRATOR_AUTO = 0,
    TC_INTEGRATOR_TABLE = 1,
    TC_INTEGRATOR_INTEGRAL = 2,
    TC_INTEGRATOR_EXACT = 3,
} tc_integrator;
typedef enum tc_table_format { TC_TABLE_AUTO = 0, TC_TABLE_8 = 8, TC_TABLE_16F = 16, TC_TABLE_32F = 32 } tc_table_format;

/* How a ray finds its way out of a cell. PLANES is the paper's own arithmetic (Weiler et al. 2003, eq. 1 and 2, in float):
 * it loses rays, and is here to be compared with. */
typedef enum tc_stepper { TC_STEPPER_SIGNS = 0, TC_STEPPER_PLANES = 1 } tc_stepper;

/* Bits of a channel of what rays have gathered so far. */
typedef enum tc_state_format { TC_STATE_AUTO = 0, TC_STATE_16F = 16, TC_STATE_32F = 32 } tc_state_format;
enum { TC_SAMPLES_ADAPTIVE = -1 };

typedef struct tc_renderer tc_renderer;

/* Where the pictures are made. */
typedef struct tc_renderer_options {
    const char *gl;     /* "auto", "osmesa", "egl"; NULL: auto. Ignored by the driver "reference" */
    const char *driver; /* "auto", "pingpong", "compute", "reference"; NULL: auto */
    void *(*get_proc_address)(const char *name); /* not NULL: a context the host owns and has made current */
    int threads;        /* 0: all cores */
    size_t keep_bytes;  /* of walks that may be kept: a view of a mesh that comes again, with other values or another function,
                           is then not walked again. In software renderers, of plain pictures of point data by the integrators
                           TABLE and INTEGRAL, which are the same bit by bit; 0: none */
    bool keep_at_once;  /* every view comes again, four times and more: its walk is kept from its first picture on. Else from
                           the second with other values, or the third; keeping takes as long as two pictures */
} tc_renderer_options;

/* options NULL: all defaults. Driver auto takes pingpong in a software GL and compute on a GPU; where no GL context can be
 * made it says so to log and takes reference, but only if neither a gl nor a host's context was asked for. gl auto takes EGL on a GPU, else OSMesa, else
 * EGL in software. A context of the renderer's own is made current on the calling thread, by this call and by each
 * that renders, and stays so; whatever was current before is not put back. A renderer is used by one thread at a time;
 * several renderers may live beside each other. With get_proc_address the host's context must be current in every call
 * that takes the renderer.
 * Errors: TC_E_ARG (unknown gl or driver: lists them; reference with a host's context), TC_E_GL (no context, or one
 * before OpenGL 4.3: says why), TC_E_MEMORY. Cost: making a context, 10 to some 100 ms. */
TC_API tc_status tc_renderer_create(tc_renderer **out, const tc_renderer_options *options, const tc_log *log,
                                    tc_error *err);
/* tc_renderer_create on a thread of its own: begins and returns at once; options (with the texts it points to) is borrowed
 * until the end. Not in a host's context. Errors: TC_E_ARG, TC_E_MEMORY. */
typedef struct tc_renderer_start tc_renderer_start;
TC_API tc_status tc_renderer_begin(tc_renderer_start **out, const tc_renderer_options *options, tc_error *err);
/* Waits for it, and is then as tc_renderer_create, but for the context: none is made current on the calling thread before
 * the first call that renders. What tc_renderer_create had to say goes to log now. *start is freed. out NULL: the renderer
 * is not wanted any more. */
TC_API tc_status tc_renderer_end(tc_renderer **out, tc_renderer_start **start, const tc_log *log, tc_error *err);
/* From the next picture on as keep_bytes and keep_at_once of tc_renderer_options; 0: pictures neither go along walks that are
 * kept nor are walks kept, but those that are there stay, for when bytes are given again. */
TC_API void tc_renderer_keep(tc_renderer *renderer, size_t keep_bytes, bool keep_at_once);
/* Frees the walks that are kept: the views that they are of will not come again. A host's context must be current. */
TC_API void tc_renderer_forget(tc_renderer *renderer);
/* Frees what is in the GL context, and the context if it is the renderer's own. A host's context must be current. */
TC_API void tc_renderer_destroy(tc_renderer **renderer);

/* A picture's settings; zero-initialise, then tc_render_defaults. */
typedef struct tc_render_options {
    int width, height;
    int whole_width, whole_height; /* of the picture that this one is a part of, which camera is of; 0: it is whole */
    int part_x, part_y;            /* the left upper pixel of the part in it, from its left upper one */
    tc_integrator integrator;
    int table_size[3];            /* s_front, s_back, length; 0: 128 128 256 */
    tc_table_format table_format;
    double unit_distance;         /* 0: bounds diagonal / cbrt(cells) */
    int integral_order;           /* of INTEGRAL: 1: a segment has one colour, its mean; 2: with the drift from front to
                                     back; 0: auto, and INTEGRAL may go on as EXACT where it could not hold its error */
    double integral_split;        /* of INTEGRAL: segments are cut to at most this optical depth; 0: auto */
    double opacity_stop;          /* a ray ends at this alpha; 1: never; 0: auto, 0.999, with EXACT 0.9999 */
    int steps_per_pass;           /* K at most; 0: auto; software renderers take fewer where a step may be long */
    int z_update_every;           /* of pingpong: passes between z-locks, 1 … 65536, rounded up to even; 0: auto; -1: never lock */
    bool count;                   /* count steps, fragments per pass (costs time) */
    tc_stepper stepper;
    bool audit;                   /* the walk checks itself (costs time): tc_render_stats.audit_broken, tc_render_audit;
                                     not by the driver "reference", which does not walk */
    bool has_nan_color;           /* cells with a value that is not finite show nan_color; otherwise they are transparent */
    double nan_color[4];          /* r, g, b, attenuation per unit distance */
    int samples;                  /* rays a pixel: 0, 1: one through its middle; 4, 16: through a grid in it, their mean;
                                     TC_SAMPLES_ADAPTIVE: 4, and 16 in their place where they differ by more than
                                     1/32 in a channel. More than 1: not with audit */
    tc_state_format state_format; /* of colour and opacity between passes; AUTO: 32F */
    const struct tc_look *look;   /* borrowed; NULL: the plain density emitter */
    const char *without;          /* names of effects (tc_explained_effect) that are left out though the scene calls for them,
                                     with spaces around each, to see what they cost; without a model rays only walk. NULL:
                                     none. Not by the driver "reference" */
} tc_render_options;

TC_API void tc_render_defaults(tc_render_options *options);

/* What a render did. Negative or NaN means: not measured. With several rays a pixel times, passes, rays and steps are
 * sums over all of their frames, and fragments_per_pass goes on from one frame to the next. */
typedef struct tc_render_stats {
    char context[32], gl_renderer[128], gl_version[64], driver[16], stepper[16], integrator[16];
    char integrator_why[256];
    char effects[256];   /* in force, with ", " between their names */
    double opacity_stop; /* in force; 1: never */
    int integral_order;  /* in force, -1: none */
    int samples;         /* rays a pixel: 1, 4, 16 or TC_SAMPLES_ADAPTIVE */
    int state_bits;      /* a channel of colour and opacity between passes */
    int64_t refined;     /* adaptive sampling: pixels of 16 rays */
    double ms_pack, ms_upload, ms_table, ms_compile, ms_first_hit, ms_march, ms_frame, ms_readback;
    double gpu_bytes_mesh, gpu_bytes_other, gpu_bytes_table, gpu_bytes_state; /* cells + vertices; boundary; tables; state */
    double bytes_kept;     /* of walks that are kept (tc_renderer_options.keep_bytes) */
    bool kept;             /* the rays of this picture went along one */
    double gpu_bytes_sent; /* of the mesh and its values, for this frame: 0 where the renderer held both */
    int steps_per_pass, z_update_every, passes, z_updates, layers; /* layers: entries peeled, 1 when convex */
    int64_t rays, rays_lost, steps, steps_max;
    int64_t audit_broken;   /* visited cells in which other than two faces held the ray */
    size_t n_fragments_per_pass;
    const int64_t *fragments_per_pass; /* belongs to the renderer, until its next call */
} tc_render_stats;

/* Renders to out (made by the call). The mesh must be prepared; it, tf and camera are borrowed. Mesh, function and
 * programs stay uploaded in the renderer until another one is given, so a second frame costs first hit and march only.
 * In a host's context (get_proc_address) the GL state is put back as in tc_render_gl.
 * Errors: TC_E_ARG (an option out of its range or not the driver's, a mesh that is not prepared, a camera without a
 * direction), TC_E_LOST (out is still made, for diagnosis), TC_E_MESH (too many cells for the driver), TC_E_GL,
 * TC_E_MEMORY. */
TC_API tc_status tc_render(tc_image **out, tc_render_stats *stats, tc_renderer *renderer, const tc_mesh *mesh,
                           const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options,
                           const tc_log *log, tc_error *err);
/* The same into the framebuffer object `framebuffer` (0: the window) of the current, host-owned context, over what it
 * holds: premultiplied (ONE, ONE_MINUS_SRC_ALPHA), into its lower left options->width x options->height pixels, with
 * neither depth nor scissor test. The GL state that the renderer touches is put back, on failure too; errors of the
 * host's that are pending (glGetError) are dropped. No query of the host's for samples passed or primitives may be
 * active.
 * Errors: TC_E_ARG (as tc_render; a renderer whose driver does not use GL), TC_E_LOST (nothing is drawn; so
 * TC_STEPPER_PLANES draws only where it happens to lose no ray: use tc_render to see what it makes), TC_E_MESH, TC_E_GL,
 * TC_E_MEMORY. */
TC_API tc_status tc_render_gl(unsigned framebuffer, tc_render_stats *stats, tc_renderer *renderer, const tc_mesh *mesh,
                              const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options,
                              const tc_log *log, tc_error *err);

/* What one ray of the last picture did (tc_render with options.audit; not by the driver "reference"). */
typedef struct tc_audit_ray {
    float length, length_real; /* sums of all its segments and of those in real cells, in the mesh's unit */
    uint32_t cells;            /* cells visited */
    uint32_t hash;             /* sum of tc_audit_hash(index) over them, whatever their order; by the prepared mesh's order */
    uint32_t broken;           /* of them, those in which other than two faces held it; not with TC_STEPPER_PLANES */
} tc_audit_ray;

/* murmur3's finalizer (Appleby) of the cell's index + 1. */
static inline uint32_t tc_audit_hash(uint32_t cell)
{
    uint32_t h = cell + 1;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
}

/* out [height][width] of the last picture, row 0 at the top.
 * Errors: TC_E_ARG (it was not audited, or rendering it failed otherwise than with TC_E_LOST), TC_E_GL, TC_E_MEMORY. */
TC_API tc_status tc_render_audit(tc_audit_ray *out, tc_renderer *renderer, tc_error *err);

typedef struct tc_verify_result {
    size_t pixels, ill_posed; /* that were looked at; of them, ill-posed */
    double max_abs_error, p999_abs_error, mean_abs_error; /* without the ill-posed rays */
    double worst_error_ill_posed;
    int worst_x, worst_y;
    int64_t rays_lost; /* -1 from tc_verify: a picture does not tell; tc_render_stats.rays_lost is the count */
    double p9999_abs_error; /* as p999_abs_error: at most 1 channel in 10 000 errs by more */
    size_t n_all;           /* pixels of the picture */
    double confidence;      /* 0.95: of 100 draws of pixels, at least 95 give a true unseen_share */
    double unseen_share;    /* of the pixels that were not looked at, at most this share errs by more than max_abs_error and
                               is not ill-posed; 0 when all were looked at, 1 when nothing can be said; NAN: not a draw */
} tc_verify_result;

/* Re-traces n pixels of image (before its background; chosen with seed, n >= all pixels: all) with the
 * double-precision reference and compares in float. options and camera are those of the picture; opacity_stop is not
 * applied: the truth has no early end, so the error of stopping is in the result. options->width and height are the
 * picture's. A pixel of 4 or 16 rays (options->samples) is compared with the mean of the same rays; one sampled adaptively
 * with that of 16. Ill-posed rays, whose true colour jumps when they are shifted by a rounding error, are counted apart.
 * Errors: TC_E_ARG (as tc_render; sizes differ), TC_E_MEMORY. Cost: on all cores, O(cells log cells) to build a
 * hierarchy that is not kept (about 130 bytes a tet at the peak), then O(log cells + segments) for each pixel. */
TC_API tc_status tc_verify(tc_verify_result *out, const tc_image *image, size_t n, uint64_t seed, const tc_mesh *mesh,
                           const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options,
                           const tc_log *log, tc_error *err);
/* tc_verify that also makes an image of the errors, of the picture's size; errors may be NULL. Of a pixel that was looked at
 * r, g and b hold the absolute errors of these channels, or that of alpha where it is larger: the largest of the three is
 * the pixel's error. Channels that are not finite hold FLT_MAX. Its alpha is 1 where the pixel was looked at, 0.5 where it
 * is ill-posed, 0 where it was not looked at. On an error no image is made. */
TC_API tc_status tc_verify_image(tc_verify_result *out, tc_image **errors, const tc_image *image, size_t n, uint64_t seed,
                                 const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                                 const tc_render_options *options, const tc_log *log, tc_error *err);

/* ------------------------------------------------------------------------------------------------------ study */

/* One setting of one knob of a study. */
typedef struct tc_study_setting {
    const char *knob, *name, *what; /* "table", "table8-128x256", one line; names are unique */
} tc_study_setting;
/* All of them, in the order in which a study takes them; *n gets their count. Static memory. */
TC_API const tc_study_setting *tc_study_settings(size_t *n);

/* What one setting did in one view of one scene. Not measured: NAN, -1, "". */
typedef struct tc_study_row {
    char scene[64], function[32];
    int view; /* from 0 */
    double azimuth, elevation; /* degrees, from +z */
    const char *knob, *setting; /* of tc_study_settings */
    int frames;
    double ms_median, ms_min, ms_max; /* of tc_render_stats.ms_frame */
    char truth[8]; /* "ray": through the pixel's middle; "area": mean of 8 x 8 rays over the pixel */
    int64_t pixels, ill_posed;
    double max_error, p9999_error, p999_error, mean_error, ill_posed_error; /* the last: worst of the ill-posed */
    double bytes_table, bytes_state, steps_per_ray;
    int64_t steps, fragments, rays, rays_lost;
    int passes, z_updates, steps_per_pass, z_update_every, integral_order, state_bits;
    double opacity_stop;
    char integrator[16], driver[16], stepper[16], reentry[16], samples[12];
    char note[192]; /* why something was not measured, or what is special */
} tc_study_row;

typedef struct tc_study_options {
    const char *folder;  /* of the results; made, but not its parents */
    bool restart;        /* forget what an earlier study left in it */
    const char *request; /* what else the results depend on, in the caller's words (inputs, fields); NULL: nothing */
    const char *knobs;   /* comma-separated knobs and settings; NULL: all. "default" is always among them */
    int width, height;   /* 0: 256 */
    int views;           /* 0: 8 */
    int frames;          /* timed of each setting and view; 0: 5 */
    size_t verify;       /* pixels a view, chosen with seed; 0: all */
    uint64_t seed;
    double unit_distance; /* as of tc_render_options */
    const char *gl;       /* as of tc_renderer_options; a GL context is needed */
    int threads;          /* 0: all cores */
    int n_scene;          /* pairs of mesh and function that will be given, for progress; 0: not known */
    bool (*row)(void *user, const tc_study_row *row); /* called after each row is written; false: stop. May be NULL */
    void *user;
} tc_study_options;

typedef struct tc_study tc_study;

/* Opens a folder of results, new or to go on with. What is in it stays valid whenever the process ends: rows are written
 * whole, view by view, to results.csv. options is copied, log borrowed until tc_study_close.
 * Errors: TC_E_ARG (an unknown knob, a size; the folder holds a study that was asked for otherwise), TC_E_FILE,
 * TC_E_GL, TC_E_MEMORY. */
TC_API tc_status tc_study_open(tc_study **out, const tc_study_options *options, const tc_log *log, tc_error *err);
/* Is there nothing left to measure of this pair? Then its mesh is not needed. */
TC_API bool tc_study_has(const tc_study *study, const char *scene, const char *function);
/* Measures every setting in every view: frames of one view are interleaved over the settings, so that what else the
 * machine does hits all of them alike. scene and function name the results (letters, digits, ._-; others become _).
 * mesh must be prepared, range of its values finite; its gaps are prepared anew where a knob asks for it and in the end
 * as they were. Errors: as tc_render and tc_verify; TC_E_CANCEL (row said so). Cost: see docs/accuracy.md. */
TC_API tc_status tc_study_scene(tc_study *study, const char *scene, tc_mesh *mesh, const char *function,
                                const tc_transfer *tf, tc_error *err);
/* Writes summary.csv (a row for each pair and setting: medians and maxima over the views, and whether it is on the
 * front of error against time), study.json, and the data and gnuplot scripts of the plots. *plots gets the number of
 * scripts, plot-0 … in tc_study_plot. Errors: TC_E_FILE, TC_E_MEMORY. */
TC_API tc_status tc_study_report(tc_study *study, size_t *plots, tc_error *err);
/* Name of a script's file in the folder, NULL beyond the last. */
TC_API const char *tc_study_plot(const tc_study *study, size_t i);
TC_API void tc_study_close(tc_study **study);

/* ----------------------------------------------------------------------------------------------------- choose */

/* An error or a frame time to stay below, instead of knobs; at least one of them. */
typedef struct tc_choose_request {
    double error;      /* largest difference of a channel from the truth, 0 … 1, that a pixel may have; 0: any */
    double frame_ms;   /* milliseconds a frame may take; 0: any */
    size_t verify;     /* pixels of the picture that are traced again by the reference; 0: 4096 */
    uint64_t seed;     /* of these pixels */
    int threads;       /* 0: all cores */
    bool no_cache;     /* measure anew, keep nothing */
    const char *cache; /* folder of what is kept; NULL: $TETCAST_CACHE, else $XDG_CACHE_HOME/tetcast, else ~/.cache/tetcast */
} tc_choose_request;

/* What was chosen, and why. Not measured: NAN. */
typedef struct tc_choose_report {
    char setting[128]; /* "running integrals of second order, opacity stop 0.998" */
    char why[512];     /* one sentence, with the numbers */
    bool cached;       /* the calibration was kept by an earlier run */
    bool in_time;      /* no frame_ms was asked for, or it is kept */
    size_t rays;       /* of the calibration */
    int candidates;    /* settings that were calibrated */
    int tried;         /* pictures that were checked until one held */
    double calibrated_error; /* of the setting, largest over the rays of the calibration */
    double ms_calibrate;     /* that the calibration took, in this run or an earlier one */
    double ms;               /* of a frame with the setting: median of a few */
    double margin;     /* of the budget that is kept back for noise: a setting fits whose median is below (1 - margin) T */
    double best_error, best_ms;   /* of the most accurate setting; best_ms where it was timed */
    char best_setting[128];
    double error;            /* of the picture with the setting: largest of the sampled pixels and the suspects */
    tc_verify_result verify; /* of the sampled pixels, as of tc_verify */
    size_t suspects;         /* pixels that were traced besides: those that differ most, of all, from the picture of the most
                                accurate setting */
    double suspect_error;    /* their largest error */
} tc_choose_report;

/* Chooses integrator, order, split and opacity stop for this mesh, function and view. What options decides is kept:
 * an integrator other than AUTO, and of the others each that is not 0. In: size, samples and whatever else is to hold; out:
 * the chosen knobs. All settings are calibrated once for a mesh and a function: their largest error against the reference over
 * three views (camera, and two of the whole mesh across it) in small pictures; the result is kept in a file of a few
 * kilobytes.
 *   error:    the cheapest by measured frame time of the settings whose calibrated error is below it by a margin. The
 *             picture is then made and checked; a setting that fails is followed by the next one.
 *   frame_ms: the most accurate setting whose median frame time, in this view and size, is below it by a margin; where
 *             none is, the fastest, with a warning to log.
 *   both:     the error is kept; where that takes longer than frame_ms in_time is false, with a warning to log.
 * The driver "reference" has nothing to choose: its picture is checked against the error all the same.
 * Errors: as tc_render; TC_E_ARG (neither or a wrong one was asked for); TC_E_ACCURACY (no setting reaches the error: says
 * which error can be reached and what that takes; options stays as it was). Cost: a calibration takes a second or a few on
 * a mesh of 10^5 tets; the check of a picture a few frames and 4096 rays of the reference. */
TC_API tc_status tc_choose(tc_render_options *options, tc_choose_report *report, tc_renderer *renderer,
                           const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                           const tc_choose_request *request, const tc_log *log, tc_error *err);

/* One context or driver of this build. */
typedef struct tc_backend_info {
    const char *kind, *name; /* "context" or "driver" */
    bool works;
    char why[256];           /* renderer string, or why it is missing */
} tc_backend_info;
/* Tries every one. out [capacity]; *n gets the count. */
TC_API tc_status tc_backends(tc_backend_info *out, size_t capacity, size_t *n, tc_error *err);

/* Peak resident bytes of this process and of its helpers so far. */
TC_API void tc_memory_peak(size_t *self_bytes, size_t *helper_bytes);

#ifdef __cplusplus
}
#endif
#endif
