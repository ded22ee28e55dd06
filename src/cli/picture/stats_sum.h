/* stats_sum.h: what several renders did, as parts of one picture or as its two eyes. */
#ifndef TC_CLI_STATS_SUM_H
#define TC_CLI_STATS_SUM_H

#include "tetcast.h"

/* Adds what one render did to *sum, which is that of those before; the first one is copied. Times, rays, steps, passes
 * and what was sent are added up, of bytes and of what is most the largest holds; what was not measured in one is not
 * in the sum. Fragments by pass are left out: passes of one part are none of another. */
void tc_stats_sum_add(tc_render_stats *sum, const tc_render_stats *one, bool first);

#endif
