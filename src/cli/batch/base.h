/* base.h: what all frames of a batch have in common: the steps of the dataset, and ranges, unit distance and the box in view
 * that are found from the first step or from all. */
#ifndef TC_CLI_BATCH_BASE_H
#define TC_CLI_BATCH_BASE_H

#include "cli/batch/batch_scene.h"
#include "cli/batch/digest.h"
#include "cli/batch/load.h"

typedef struct tc_batch_base {
    size_t n_step; /* of the dataset, at least 1 */
    bool stepped;  /* its one file has steps to be asked for */
    double *time;  /* [n_step]; NAN: none */
    tc_loader loader; /* holds the first step, of the first field */
    int first;        /* that step: number 0, or, where that cannot be read, one after it */
    char identity[TC_IDENTITY]; /* of its file before it was read */
    double bounds[6]; /* the box that cameras see: of the first step, or of all */
    double unit[2];   /* of the first step; of all */
    size_t n_field;
    double (*range)[2][2];  /* [n_field] of the first step, and of all; lo > hi: not found */
    char **field_name;      /* [n_field] as the file calls them */
    double ms_survey;       /* NAN: none was needed */
} tc_batch_base;

/* Reads the first step that can be read, and says what its reader noted. -1, or the exit code of an error that was
 * printed; whatever it is, tc_batch_base_finish frees what is there. */
int tc_batch_base_open(tc_batch_base *out, const tc_batch_scene *scene, tc_talk *talk);
/* Ranges, unit and box, with a pass over step [n] of the dataset where the options ask for what all of them have. A step that
 * cannot be read is left out of it. The same codes. */
int tc_batch_base_survey(tc_batch_base *base, const tc_batch_scene *scene, const int *step, size_t n, tc_talk *talk);
/* A step of the dataset with a field. */
tc_load tc_batch_load(const tc_batch_base *base, const tc_batch_scene *scene, int step, size_t field);
void tc_batch_base_finish(tc_batch_base *base);

/* What a range, the unit distance or the box of a look is found from; TC_OVER_AUTO: it was given. */
tc_over tc_range_over(const tc_batch_command *look);
tc_over tc_unit_over(const tc_batch_command *look);
tc_over tc_camera_over(const tc_batch_command *look);
/* The range [2] of a look of this field, lo > hi: not found, and its unit distance; where they are found from the step
 * itself, those of the first. */
const double *tc_base_range(const tc_batch_base *base, const tc_batch_command *look, size_t field);
double tc_base_unit(const tc_batch_base *base, const tc_batch_command *look);

#endif
