/* kept.h: walks that are kept: where each ray of a view goes through a mesh depends on neither values nor function, so
 * a view that is rendered again with others need not be walked again. A view is recorded when it comes for the second
 * time with other values, or for the third, or at once if it is said to come often; then pictures of it sum up the
 * records in one pass (record.frag, stepper_kept.glsl, kept.frag) and are the same bit by bit. Software renderers alone,
 * where the walk is most of the time; plain pictures of point data on meshes without peeling. Memory is bounded: what
 * does not fit is walked as ever, and nothing that is kept gives way. */
#ifndef TC_GPU_KEPT_H
#define TC_GPU_KEPT_H

#include "gpu/job.h"

enum { TC_KEPT_VIEWS = 256 };

/* A face that a ray meets (record.frag). */
typedef struct tc_kept_face {
    int32_t vertex[3];
    float weight[3]; /* of the ray in it, their sum anything */
    float length;    /* since the record before */
} tc_kept_face;

/* What is kept of one view. */
typedef struct tc_kept_view {
    tc_frame frame;
    int width, height, rect[4];    /* rect: pixels outside have no ray */
    uint64_t scalar_serial;        /* of the first picture */
    int seen;                      /* pictures so far */
    bool other, recorded, refused; /* other: values were not always the first picture's */
    int64_t rays;                  /* that meet the mesh */
    GLuint first;                  /* RG32I: 1 + a ray's first record, the one behind its last; 0 0: none */
    size_t n_record;
    int cells; /* the most that a ray goes through: where they are not all in one pass, sums are rounded elsewhere */
    GLuint record;           /* buffer of tc_kept_face [n_record] */
    tc_texture_buffer pairs; /* RG32F, for each: its scalar, by the values of values_serial; its length */
    uint64_t values_serial;
    size_t bytes;
} tc_kept_view;

typedef struct tc_kept {
    size_t most; /* bytes; 0: nothing is kept */
    bool at_once; /* a view comes often: it is recorded when it is seen for the first time */
    uint64_t mesh_serial;
    int n;
    tc_kept_view *view; /* [n] */
    size_t bytes;
    float *scalar; /* [n_vertex] as they are uploaded, by values_serial */
    uint64_t values_serial;
} tc_kept;

/* The view of this picture, which is counted as seen; NULL: it is none that can be kept. Forgets what is of another
 * mesh. */
tc_kept_view *tc_kept_find(tc_kept *kept, const tc_job *job, uint64_t mesh_serial, uint64_t scalar_serial, int width,
                           int height);
/* Is it to be recorded now? */
bool tc_kept_due(const tc_kept *kept, const tc_kept_view *view);
/* Records the view whose frame and proposals the job has: finds first hits and walks every ray. Where this cannot be
 * done (no room, a hull that rounding folds, a walk that is too long) the view is refused, which is no error. Binds
 * framebuffers. Errors: TC_E_GL, TC_E_MEMORY. */
tc_status tc_kept_record(tc_kept *kept, tc_kept_view *view, const tc_job *job, tc_error *err);
/* The records' scalars, if they are not by these values: found here, where it takes a tenth of what a shader needs.
 * Errors: TC_E_GL, TC_E_MEMORY. */
tc_status tc_kept_values(tc_kept *kept, tc_kept_view *view, const tc_job *job, uint64_t scalar_serial, int threads,
                         tc_error *err);
/* The picture along job->kept, whole, into the state's result; its rays, and those that did not come to their ends. Binds
 * framebuffers. Errors: TC_E_GL. */
tc_status tc_kept_draw(tc_job_result *out, const tc_job *job, tc_error *err);
void tc_kept_clear(tc_kept *kept, const tc_gl *gl);

#endif
