/* batch_scene.h: a scene of many pictures: its data over time, its looks (fields x transfer functions) and its views. */
#ifndef TC_CLI_BATCH_SCENE_H
#define TC_CLI_BATCH_SCENE_H

#include "cli/batch/batch_options.h"
#include "cli/batch/series.h"
#include "cli/batch/views.h"

typedef struct tc_batch_scene {
    char *path;                 /* of the scene file; NULL: a dataset was given */
    char *text, *folder;        /* of the file */
    bool data_whole;            /* data, which a ParaView state gave, lead from the current folder */
    json_t *json;
    tc_series series;
    tc_views views;
    size_t n_field, n_function;
    char **field, **function;   /* [n_field], [n_function] names, for {field} and {tf} */
    tc_batch_command *look;     /* [n_field][n_function] all options of each */
} tc_batch_scene;

/* Reads what the command line names, a scene file or a dataset, and the options over it. -1, or the exit code of an error that
 * was printed; whatever it is, tc_batch_scene_finish frees what is there. */
int tc_batch_scene_read(tc_batch_scene *out, tc_talk *talk, int argc, char **argv);
void tc_batch_scene_finish(tc_batch_scene *scene);

#endif
