/* render_report.h: what a render measured, as the --stats JSON and as the metadata of its image. */
#ifndef TC_CLI_RENDER_REPORT_H
#define TC_CLI_RENDER_REPORT_H

#include "cli/input_cache.h"
#include "cli/picture/render_options.h"

/* A median with its extremes; NAN where not measured. */
typedef struct tc_spread {
    double median, low, high;
} tc_spread;

/* Median, least and greatest of the values that were measured (finite, not negative); value is sorted. */
void tc_spread_of(tc_spread *out, double *value, size_t n);

/* Everything that a run of `render` found out. */
typedef struct tc_render_run {
    const tc_render_command *options;
    const char *frame_text; /* "tetcast:frame" of the files: by which a batch knows them again; NULL: they have none */
    tc_mesh *mesh;
    tc_mesh_report report;
    tc_transfer *tf;
    double range[2]; /* of scalars, that tf is laid over */
    tc_camera camera;
    tc_render_options render;
    struct tc_look_parts *look; /* what render.look points to */
    tc_image *image; /* before its background is laid under it */

    tc_input_seen seen;
    double ms_read, ms_write, ms_total; /* NAN: not measured */
    tc_render_stats first;              /* the first frame: it paid for packing, upload, table, programs */
    tc_render_stats count;              /* of the counted frame where there is one, else of the last */
    tc_spread frame, first_hit, march, readback;
    int frames; /* timed ones */
    tc_choose_report choice; /* where chosen is set */
    bool chosen;
    tc_verify_result verify;
    bool verified, counted;
    tc_image *errors; /* of tc_verify_image; NULL without --error-image */
    tc_error lost; /* rays that the stepper "planes" lost: said at the end; code TC_OK where there are none */
    bool measured; /* there are numbers for --stats */
    tc_ink ink;    /* of title, bar and axes; AUTO: measured in the picture */
    bool broken;   /* the audit found cells in which other than two faces held the ray: said at the end, too */
} tc_render_run;

/* New reference, or NULL when memory ran out. */
json_t *tc_render_stats_json(const tc_render_run *run);

/* Of several steps: what is common to them, with the mesh of the first, whose run this is. */
json_t *tc_render_shared_json(const tc_render_run *run);
/* One of them; time NAN: none. set_up: its mesh was set up, else values were put onto the one before. */
json_t *tc_render_step_json(const tc_render_run *run, int step, double time, bool set_up);
/* Peak memory so far. */
void tc_render_memory_json(json_t *out);

/* Texts for the image file: command, scene, camera, transfer function, version, field, notes, verify. */
#define TC_META_MAX 16
typedef struct tc_meta {
    tc_text_pair pair[TC_META_MAX];
    char *owned[TC_META_MAX];
    size_t n;
} tc_meta;
void tc_meta_make(tc_meta *out, const tc_render_run *run, int argc, char **argv);
/* One more; owned comes from malloc and goes with meta; NULL: nothing is added. */
void tc_meta_add(tc_meta *meta, const char *key, char *owned);
void tc_meta_finish(tc_meta *meta);

/* The scene file that makes the picture again (docs/formats.md), whole in one line, from malloc; NULL: memory ran out. */
char *tc_scene_text(const tc_render_run *run);

/* The field's name as shown to people; never NULL. */
const char *tc_run_field(const tc_render_run *run);
/* The unit distance in force: as given, else the mesh's. */
double tc_run_unit_distance(const tc_render_run *run);

#endif
