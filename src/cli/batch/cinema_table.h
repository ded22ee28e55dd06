/* cinema_table.h: what the files of cinema.h share: the table in memory. */
#ifndef TC_CLI_BATCH_CINEMA_TABLE_H
#define TC_CLI_BATCH_CINEMA_TABLE_H

#include "cli/batch/cinema.h"
#include "cli/batch/csv.h"

typedef struct tc_cinema_cell {
    const char *text; /* of texts and files */
    double number;
    long long integer;
    bool missing;
} tc_cinema_cell;

/* One row; the texts of its cells lie behind them. */
typedef struct tc_cinema_row {
    size_t n; /* cells */
    tc_cinema_cell cell[];
} tc_cinema_row;

/* An entry of the hash table over the rows that this run added. */
typedef struct tc_cinema_slot {
    size_t row; /* index + 1; 0: free */
    size_t key;
} tc_cinema_slot;

struct tc_cinema {
    char *cdb; /* without slashes at its end */
    tc_cinema_column column[TC_CINEMA_COLUMNS_MAX];
    size_t n, n_parameters;
    bool alone, drop_missing;
    tc_cinema_row **own; /* [n_own] what this run added; NULL: replaced since; n_live are not */
    size_t n_own, n_live, capacity;
    tc_cinema_slot *slot; /* [n_slot], a power of two; n_taken are not free */
    size_t n_slot, n_taken;
    size_t n_others; /* rows in data.csv that are not of this run, when it was last read */
};

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
tc_status
tc_cinema_fail(tc_error *err, tc_status code, const char *format, ...);

/* A copy of n cells; NULL: memory ran out. The caller frees it with free(). */
tc_cinema_row *tc_cinema_row_make(const tc_cinema_cell *cell, size_t n);
void tc_cinema_rows_free(tc_cinema_row **row, size_t n);

/* Order of two tc_cinema_row *, for qsort_r with the table as the last argument. */
int tc_cinema_row_compare(const void *a, const void *b, void *cinema);

/* Has this run added a row with the same parameters or the same file? */
bool tc_cinema_is_replaced(const tc_cinema *cinema, const tc_cinema_row *row);

/* The rows of a data.csv, whose text is changed. Errors as tc_cinema_open. The caller frees them. */
tc_status tc_cinema_rows_read(tc_cinema_row ***out, size_t *n, const tc_cinema *cinema, char *text, size_t bytes,
                              tc_error *err);
void tc_cinema_rows_write(tc_csv_text *out, const tc_cinema *cinema, tc_cinema_row *const *row, size_t n);

#endif
