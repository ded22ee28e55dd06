/* explain_measure.h: what each part of a frame costs, by leaving it out. */
#ifndef TC_CLI_EXPLAIN_MEASURE_H
#define TC_CLI_EXPLAIN_MEASURE_H

#include "cli/picture/render_report.h"

typedef struct tc_share {
    char name[48];
    double ms;
} tc_share;

/* Parts of a frame: first hits, the bare walk, the model, and the effects in their order. */
typedef struct tc_shares {
    int n;
    tc_share part[TC_EXPLAINED_MOST + 4];
    double sum, frame; /* of the parts; of whole frames, measured beside them and not used for them */
} tc_shares;

/* Renders frames with all effects, then with one after the other left out from the last to the model, until the bare
 * walk is left; in rounds over all of these, so that what else the machine does hits them alike. A part is the
 * difference of two medians. Errors: as tc_render. */
tc_status tc_shares_measure(tc_shares *out, const tc_explanation *explanation, tc_renderer *renderer,
                            const tc_render_run *run, const tc_log *log, tc_error *err);

#endif
