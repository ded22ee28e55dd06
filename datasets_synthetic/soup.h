/* soup.h: soups that grow tet by tet, and what is done to whole soups. */
#ifndef TC_DATASETS_SYNTHETIC_SOUP_H
#define TC_DATASETS_SYNTHETIC_SOUP_H

#include "synth.h"

/* Adds to *soup (which may hold something). A failure is kept until tc_builder_done; zero-initialise but soup. */
typedef struct tc_builder {
    tc_synth_soup *soup;
    size_t vertex_room, tet_room;
    enum { TC_BUILDER_FINE = 0, TC_BUILDER_MEMORY, TC_BUILDER_IDS } failure;
} tc_builder;

/* The new vertex's number; 0 after a failure. */
int32_t tc_builder_vertex(tc_builder *b, double x, double y, double z);
void tc_builder_tet(tc_builder *b, int32_t v0, int32_t v1, int32_t v2, int32_t v3);
/* Tet v0 v1 v2 v3, or with v2 and v3 swapped when odd. */
void tc_builder_tet_turned(tc_builder *b, int32_t v0, int32_t v1, int32_t v2, int32_t v3, bool odd);
/* Errors: TC_E_MEMORY; TC_E_ARG when 32-bit ids are too few. */
tc_status tc_builder_done(const tc_builder *b, tc_error *err);

/* Adds the vertices and tets of more; values of neither are kept. Errors: TC_E_MEMORY, TC_E_ARG. */
tc_status tc_soup_append(tc_synth_soup *soup, const tc_synth_soup *more, tc_error *err);
/* Makes one of vertices at equal coordinates, and drops those that no tet uses. Tets that repeat a vertex by that are
 * dropped too. Errors: TC_E_MEMORY. Cost: O(n log n). */
tc_status tc_soup_weld(tc_synth_soup *soup, tc_error *err);
/* Room for values at vertices, to be filled by the caller. Errors: TC_E_MEMORY. */
tc_status tc_soup_values(tc_synth_soup *soup, tc_association association, tc_error *err);

/* Turns a point by one radian about the axis (1, 2, 3): no coordinate of a turned box is exact. */
void tc_point_turn(double *out, const double *p);
/* The inverse. */
void tc_point_turn_back(double *out, const double *p);

#endif
