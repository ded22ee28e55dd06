/* mesh.h: the tetrahedral mesh that every other part reads.
 *
 * Double precision. Real tets come first, imaginary ones (convexification, Williams 1992; Weiler et al. 2003, 3.4)
 * follow. After tc_mesh_prepare: every tet has positive orientation (dot(cross(b-a, c-a), d-a) >= 0), no tet repeats a
 * vertex, adjacency is an involution, only faces with equal vertex sets on opposite sides are linked, cells and
 * vertices follow a Hilbert curve. */
#ifndef TC_MESH_MESH_H
#define TC_MESH_MESH_H

#include "core/status.h"

/* What a reader repaired before the mesh was made; the report counts it with tc_mesh_prepare's own repairs. */
typedef struct tc_file_repairs {
    size_t degenerate;    /* cells that repeat so many points that nothing is left */
    size_t turned;        /* cells of negative volume */
    size_t unused_points; /* points of no cell */
    size_t merged_points; /* points replaced by one at the same place */
} tc_file_repairs;

struct tc_mesh {
    size_t n_vertex;    /* Steiner points last */
    double *vertex;     /* [n_vertex][3] */
    size_t n_tet;       /* real tets */
    size_t n_imaginary; /* imaginary tets, after the real ones */
    int32_t *tet;       /* [n_tet + n_imaginary][4] */
    int32_t *neighbour; /* [n_tet + n_imaginary][4]; face f lies opposite vertex f; -1 outside; NULL before prepare */

    double *scalar; /* [n_vertex] (TC_POINT_DATA; 0 at Steiner points) or [n_tet] (TC_CELL_DATA) */
    tc_association association;
    char *field_name; /* NULL: no field */

    /* From the arrays that made the mesh to this order: -1 dropped. NULL before prepare (identity). */
    size_t n_vertex_source, n_tet_source;
    int32_t *vertex_of_source; /* [n_vertex_source] */
    int32_t *tet_of_source;    /* [n_tet_source] */

    bool prepared;
    tc_reentry asked;       /* by the last tc_mesh_prepare */
    size_t once_peeled;     /* as of the options by which it peels for one picture; 0: otherwise */
    bool gaps_may_do;       /* they were not filled since a helper failed, which it may not do another time */
    uint64_t serial;        /* changes with geometry: a renderer uploads again when it does */
    uint64_t scalar_serial; /* changes with values */
    tc_mesh_report report;

    tc_file_repairs file; /* zero for arrays */
    tc_source *source;    /* what the file held; NULL for arrays; a block of its own, free() */
    void *source_memory;  /* everything source points into: one block, free() */
    uint64_t source_hash; /* of the arrays that a file's points and cells became, by tetcast-read; 0: from no file */
    struct tc_worker *reader; /* tetcast-read, kept for tc_mesh_read_values; NULL: it is started when it is needed */
    struct tc_mesh_ahead *ahead; /* what has the reader now (tc_mesh_ahead_begin); NULL: nothing */
    void (*ahead_wait)(struct tc_mesh_ahead *);  /* waits until it has given the reader back */
    void (*ahead_leave)(struct tc_mesh_ahead *); /* … and tells it that the mesh is gone */
};

/* Sets the report's scalar_range, nonfinite_scalars and nonfinite_cells from the values; both ends are 0 when none is
 * finite. */
void tc_mesh_measure_scalar(tc_mesh *mesh);
/* Sets the report's bounds (of finite vertices), longest_edge and volume from the real tets; an edge or volume that
 * is not finite is left out. The sums do not depend on the number of threads. Errors: TC_E_MEMORY. */
tc_status tc_mesh_measure(tc_mesh *mesh, int threads, tc_error *err);
/* Says what became of cells that do not fit together, as tc_mesh_prepare does. */
void tc_mesh_say_defects(const tc_log *log, const tc_mesh_report *report);
/* Values of the source's cells [n_tet_source] in this mesh's order, out [n_tet]. Cost: O(cells), all cores. */
void tc_mesh_scatter_cells(double *out, const tc_mesh *mesh, const double *value);
/* A number that no other call of this process gives: for serial and scalar_serial. */
uint64_t tc_mesh_new_serial(void);

#endif
