/* tetcast_look.h: what a picture shows of a mesh, and how: optical model, isosurfaces, light, colour by a second field,
 * clipping, selection, geometry. Included by tetcast.h.
 *
 * A tc_look that is all zeros is the plain density emitter, and costs nothing: what a look does not call for is not compiled,
 * packed, uploaded or passed (docs/adding_an_effect.md). The definitions below are those that the renderer and the
 * reference caster, which share no code, both follow. Lengths, positions and directions are in the mesh's unit and frame. */
#ifndef TETCAST_LOOK_H
#define TETCAST_LOOK_H

#ifndef TETCAST_H
#error "include tetcast.h, which includes this file"
#endif

/* ------------------------------------------------------------------------------------------------------ fields */

/* Values of an array on a mesh, beside its scalar: to colour by, to select cells by. Belongs to that mesh as it is
 * prepared now: after another tc_mesh_prepare that changes the order, make it anew (TC_E_ARG says so). */
typedef struct tc_field tc_field;

/* value [n_vertex] or [n_tet] of the arrays that made the mesh, in their order, as for tc_mesh_set_scalar; copied. name may be
 * NULL. The mesh must be prepared. Of points at one place that were merged the first one's value holds.
 * Errors: TC_E_ARG, TC_E_MEMORY. Cost: O(vertices) or O(tets). */
TC_API tc_status tc_field_create(tc_field **out, const tc_mesh *mesh, const double *value, tc_association association,
                                 const char *name, tc_error *err);
/* Another array of the file, at the step of options, that the mesh was read from (as tc_mesh_read_values, but the mesh keeps
 * its values). The mesh must be prepared. Errors: as tc_mesh_read_values. */
TC_API tc_status tc_field_read(tc_field **out, tc_mesh *mesh, const char *path, const tc_read_options *options,
                               const tc_log *log, tc_error *err);
TC_API void tc_field_destroy(tc_field **field);
/* Finite range [2] (both 0 where nothing is finite); association and name may be NULL. */
TC_API void tc_field_info(double range[2], tc_association *association, const char **name, const tc_field *field);

/* ------------------------------------------------------------------------------------------------------- look */

/* How light and matter act along a ray (Max 1995). a is attenuation per unit distance U, c colour; l = length / U.
 *   DENSITY_EMITTER  c is emitted in proportion to a, and absorbed (Williams and Max 1992)
 *   EMISSION         light alone: rgb = integral of c a dl, alpha 0: it is added to what lies behind
 *   ABSORPTION       density emitter whose colours are all 0
 *   XRAY             density emitter whose colours are all 1
 *   MAXIMUM, MINIMUM the largest, least scalar that the ray meets
 *   AVERAGE          the mean of the scalar over the ray's length in the mesh
 *                    of these three the picture is the function's colour there, alpha 1; the function's opacity is not used;
 *                    where the ray meets no cell, or only cells whose values are not finite, it is transparent. AVERAGE of
 *                    a length of zero: transparent
 *   SURFACES         isosurfaces alone; the function's opacity is not used
 *   DEPTH            no colours but numbers, of the place where what the density emitter's ray has gathered first has an
 *                    opacity of depth_opacity (isosurfaces and geometry count): r is its distance from the eye's plane along
 *                    the view (as of clip_near), g the scalar there (of geometry 0), b 0, a 1. All 0 where the ray stays
 *                    clearer. In the part of a cell that reaches it (cells are cut by clipping, and where surfaces lie),
 *                    with transmittances T0 > T >= T1 before it, wanted and behind it, the place is at ln(T0/T) / ln(T0/T1)
 *                    of its length (T1 = 0: at its beginning), the scalar linear between its ends, or 0 where it has the
 *                    colour of missing values; numbers beyond floats are the largest float. One ray a pixel; no light, no
 *                    color_field, no integrator but EXACT (or AUTO), no state of 16 bits; opacity_stop is not looked at */
typedef enum tc_model {
    TC_MODEL_DENSITY_EMITTER = 0,
    TC_MODEL_EMISSION = 1,
    TC_MODEL_ABSORPTION = 2,
    TC_MODEL_MAXIMUM = 3,
    TC_MODEL_SURFACES = 4,
    TC_MODEL_XRAY = 5,
    TC_MODEL_MINIMUM = 6,
    TC_MODEL_AVERAGE = 7,
    TC_MODEL_DEPTH = 8,
} tc_model;

/* The surface on which the scalar has this value, where a ray crosses it inside of a cell: between a cell's entry (scalar
 * s0) and exit (s1) if (s0 < value) != (s1 < value), at the place where the scalar, linear between them, has the value. A
 * cell boundary at which the scalar jumps (a gap, cells that do not share vertices) is no surface. Not with cell data.
 * A crossing adds, before what lies behind it, its colour times opacity, and leaves 1 - opacity of the light. */
typedef struct tc_iso {
    double value;
    double opacity;  /* 0 … 1 */
    bool has_color;  /* else the function's colour at value (the right one at a step), or with a color_field that
                        field's colour at the crossing */
    double color[3];
} tc_iso;

/* Where the light's direction comes from, and how strong it is. */
typedef struct tc_light {
    bool head;           /* from the eye, along each ray; direction is not used */
    double direction[3]; /* from the mesh to the light; any length above 0 */
    double color[3];
} tc_light;

/* Light on what is seen. With n the unit normal, L the unit direction to a light of colour I, V that to the eye (against the
 * ray), H = (L + V) / |L + V|, a colour c becomes
 *     c' = c (ambient + diffuse sum I max(n.L, 0)) + specular sum I max(n.H, 0)^power over lights with n.L > 0
 * (nothing of specular where L + V = 0). n is -g/|g|, g the gradient of the scalar; two-sided, n is turned to have n.V >= 0
 * (n.V = 0: as it is). Where g = 0 or is not finite c' = c.
 *   CELL    g is the cell's own: for point data of its linear interpolation, for cell data of the plane fitted by least
 *           squares through its value and those of its up to four real neighbours at their centroids (the least one, where
 *           they leave a direction open)
 *   VERTEX  g at a vertex is the mean of g of the real tets around it, weighted by their volumes (a plain mean where all
 *           are 0); in a cell it is interpolated linearly
 * A volume is lit at the two ends of the ray's part in each cell (as it is cut by clipping), and the mean of both c' -
 * linear in c - holds for all of that part. c' there is c + m (lit - c) with m = |g| / (|g| + magnitude R/D), R the
 * scalar's range, D the bounds' diagonal, so that flat regions do not sparkle. An isosurface is lit at the crossing, with m =
 * 1. A cell of which a value is not finite has g = 0, and counts in no mean. */
typedef enum tc_gradient { TC_GRADIENT_NONE = 0, TC_GRADIENT_CELL = 1, TC_GRADIENT_VERTEX = 2 } tc_gradient;

typedef struct tc_shade {
    tc_gradient gradient; /* NONE: no light at all, colours as they are */
    bool volume, surfaces; /* what is lit */
    double ambient, diffuse, specular, power;
    bool one_sided;
    double magnitude;
    int n_light;           /* 0: one white head light */
    const tc_light *light; /* [n_light] */
} tc_shade;

/* Keeps the points x with normal . x >= offset. */
typedef struct tc_plane {
    double normal[3], offset;
} tc_plane;

/* Keeps whole cells: those whose value (cell data), or all of whose vertices' values (point data), lie in one and the same of
 * the ranges, ends included. What is not finite lies in none. The others are stepped through, as gaps are. */
typedef struct tc_select {
    const tc_field *field; /* NULL: the mesh's scalar */
    int n_range;
    const double (*range)[2]; /* [n_range] */
} tc_select;

/* Triangles and lines in the picture, in depth order with the volume and with each other: flat colour, lit by the shade's
 * lights and coefficients where `lit` (two-sided, by the triangle's own normal; not where the shade's gradient is NONE), over
 * what lies behind. Planes and the box do not cut it. MAXIMUM, MINIMUM and AVERAGE lie behind all of it. Of translucent
 * fragments at one depth that of the earlier geometry is the nearer, and its triangles before its lines.
 *   vertex [n_vertex][3], within 10^4 diagonals of the mesh; triangle [n_triangle][3], line [n_line][2] vertex ids
 *   width  pixels: a line covers the pixels whose middles lie no farther than half of it from its picture, in the depth of
 *          its point nearest to them there, nearer to the eye by a length that looks as long as its width, so that lines on
 *          a surface are not lost in it. Lines are not lit, and not drawn by the driver "reference". */
typedef struct tc_geometry {
    size_t n_vertex, n_triangle, n_line;
    const double *vertex;
    const int32_t *triangle, *line;
    double color[3], opacity, width;
    bool lit;
} tc_geometry;

typedef struct tc_look {
    tc_model model;
    double depth_opacity; /* of DEPTH, 0 … 1; 0: 0.5; 1: all but 1e-16 of the light is held back */
    int n_iso;
    const tc_iso *iso; /* [n_iso] values all different */
    tc_shade shade;
    /* Colour by one field, opacity by another: color_function gives the colours, by color_field, and the picture's own function
     * the attenuation, by the mesh's scalar. A cell of which the color_field has a value that is not finite is as one whose
     * scalar is not. Point data are interpolated linearly in a cell, cell data are the cell's. */
    const tc_field *color_field;
    const tc_transfer *color_function;
    int n_plane;
    const tc_plane *plane; /* [n_plane] all must keep a point: a convex region; cells are cut */
    bool has_box;
    double box[6]; /* xmin xmax ymin ymax zmin zmax: keeps what lies inside */
    int n_select;
    const tc_select *select; /* [n_select] all must keep a cell */
    int n_geometry;
    const tc_geometry *geometry; /* [n_geometry] */
} tc_look;

/* ambient 0.2, diffuse 0.8, specular 0.2, power 20, magnitude 1, lights volume and surfaces; gradient NONE. */
TC_API void tc_shade_defaults(tc_shade *shade);

/* The edges of the mesh's bounding box, the boundary's triangles, or their edges, each once: of the real tets. Arrays are made
 * by the call, for tc_geometry_finish; colours and width are set to black, opaque, 1 pixel, lit for triangles.
 * Errors: TC_E_ARG (not prepared), TC_E_MEMORY. Cost: O(boundary faces). */
typedef enum tc_mesh_part { TC_PART_OUTLINE = 0, TC_PART_WIREFRAME = 1, TC_PART_SURFACE = 2 } tc_mesh_part;
TC_API tc_status tc_geometry_from_mesh(tc_geometry *out, const tc_mesh *mesh, tc_mesh_part part, tc_error *err);
/* The triangles (polygons are split) and lines of a file, through tetcast-read. Errors: as tc_mesh_read. */
TC_API tc_status tc_geometry_read(tc_geometry *out, const char *path, const tc_log *log, tc_error *err);
TC_API void tc_geometry_finish(tc_geometry *geometry);

/* Why a look cannot be made of this mesh and function: NULL, or a sentence in why [capacity] that names what is wrong and the
 * remedy (values out of range, isosurfaces of cell data, a field of another mesh, what excludes each other). */
TC_API const char *tc_look_wrong(char *why, size_t capacity, const tc_look *look, const tc_mesh *mesh);

/* ----------------------------------------------------------------------------------------------------- explain */

/* One row of the table of effects, for the last picture. */
typedef struct tc_explained_effect {
    char name[32];
    const char *what; /* one line; static */
    bool model;       /* one of those of tc_model */
    bool in_force;
    char why[160];    /* it is, or is not */
    double gpu_bytes; /* that it holds, besides what every picture needs; 0 where it is not in force */
} tc_explained_effect;

/* A program or a texture of the last picture, and its size: of a program the bytes of its text. */
typedef struct tc_explained_size {
    char name[48];
    double bytes;
} tc_explained_size;

enum { TC_EXPLAINED_MOST = 32 };
typedef struct tc_explanation {
    int n_effect, n_program, n_texture;
    tc_explained_effect effect[TC_EXPLAINED_MOST];
    tc_explained_size program[TC_EXPLAINED_MOST], texture[TC_EXPLAINED_MOST];
} tc_explanation;

/* What the renderer's last picture called for, and why. In a host's context the context must be current.
 * Errors: TC_E_ARG (no picture was made, or the driver does not use GL). */
struct tc_renderer;
TC_API tc_status tc_render_explain(tc_explanation *out, struct tc_renderer *renderer, tc_error *err);

#endif
