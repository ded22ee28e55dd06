/* table.h: what the cases gave: as JSON case by case, and as a table of meshes. */
#ifndef TC_TESTS_HARD_TABLE_H
#define TC_TESTS_HARD_TABLE_H

#include "invariants.h"

typedef struct hard_row {
    char mesh[64], treatment[200];
    size_t cells, cases, failed, refused; /* refused: functions or meshes, with a sentence */
    hard_result sum;                      /* counts added up, errors the worst */
} hard_row;

typedef struct hard_table hard_table;

tc_status hard_table_create(hard_table **out, const char *context, tc_error *err);
void hard_table_destroy(hard_table **table);

/* The row that the following cases belong to. Errors: TC_E_MEMORY. */
tc_status hard_table_begin(hard_table *table, const hard_mesh *mesh, tc_error *err);
tc_status hard_table_add(hard_table *table, const hard_result *r, tc_error *err);
/* A function or mesh was refused, as it must be. */
void hard_table_refuse(hard_table *table);
/* How many meshes (0), views (1) and functions (2) at least one picture was made of. */
void hard_table_used(size_t out[3], const hard_table *table);
/* Everything, added up. */
const hard_row *hard_table_total(const hard_table *table);

/* One row a mesh, and the totals. Errors: TC_E_FILE. */
tc_status hard_table_write_markdown(const hard_table *table, const char *path, tc_error *err);
/* {"context", "total", "meshes": [...], "cases": [...]}. Errors: TC_E_FILE, TC_E_MEMORY. */
tc_status hard_table_write_json(const hard_table *table, const char *path, tc_error *err);

#endif
