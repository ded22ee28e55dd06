/* cinema.h: the table of a Cinema database, Spec D ("dietrich", version 1.2; what is written is one of 1.1 as long as
 * no first value of a column is missing): a folder NAME.cdb with data.csv, a row for each set of parameters and the
 * files that were made with them. Several processes may add rows to one database at a time: each save merges what is in
 * data.csv. */
#ifndef TC_CLI_BATCH_CINEMA_H
#define TC_CLI_BATCH_CINEMA_H

#include "tetcast.h"

typedef struct tc_cinema tc_cinema;

enum { TC_CINEMA_COLUMNS_MAX = 64 };

typedef enum tc_cinema_type {
    TC_CINEMA_FLOAT = 0,
    TC_CINEMA_INTEGER,
    TC_CINEMA_TEXT,
    TC_CINEMA_FILE /* a path, as seen from the .cdb folder */
} tc_cinema_type;

typedef struct tc_cinema_column {
    const char *name; /* UTF-8, none twice; of files it begins with FILE, of others it does not */
    tc_cinema_type type;
} tc_cinema_column;

/* A value of a row; the column's type says which member counts. */
typedef struct tc_cinema_value {
    bool missing;  /* none of the others counts */
    double number; /* NaN is a missing value */
    long long integer;
    const char *text; /* of texts and files; NULL: missing */
} tc_cinema_value;

/* Would Cinema's readers, which guess a column's type, take this value of a text or file column for a text? If not (a
 * number, "nan", nothing, not UTF-8), *why says so with the remedy. why may be NULL. */
bool tc_cinema_text_ok(const char *text, char *why, size_t capacity);

/* Opens or begins the database `cdb` (a folder, made if it is not there; its name ends in .cdb), and counts the rows
 * that it has. Nothing is written yet, but it is tried whether writing will work. column  [n] parameters (one at
 * least), then files; copied alone   no other process adds rows meanwhile: a file system without locks is then no error
 * Errors: TC_E_ARG (columns, name), TC_E_FILE (no such folder; not writable; no locks; data.csv has other columns or is
 * damaged: it stays as it is), TC_E_MEMORY. Free with tc_cinema_destroy. */
tc_status tc_cinema_open(tc_cinema **out, const char *cdb, const tc_cinema_column *column, size_t n, bool alone,
                         tc_error *err);
void tc_cinema_destroy(tc_cinema **cinema);

/* Adds a row; it replaces rows with the same parameters and rows that name the same file in the same column, those that
 * data.csv holds, too. value: [n], copied. Errors: TC_E_ARG (an infinite number, a text that tc_cinema_text_ok refuses,
 * nothing but missing values, a path from the root), TC_E_MEMORY. O(1). Not thread-safe. */
tc_status tc_cinema_add(tc_cinema *cinema, const tc_cinema_value *value, tc_error *err);

/* From the next save on, rows in data.csv whose files are not there (or are empty) are left out. Off at first. */
void tc_cinema_drop_missing(tc_cinema *cinema, bool on);

/* Rows that the next save will write, as far as is known without reading data.csv again. */
size_t tc_cinema_count(const tc_cinema *cinema);

/* Writes the union of what data.csv holds now and what was added: rows in the order of their values, columns from left
 * to right, numbers by value, texts by bytes, missing values last. The bytes do not depend on who added what when.
 * Beside data.csv and under a lock, then renamed; waits up to 60 s for the lock. Without any row there is no data.csv.
 * Errors: TC_E_FILE (disk full, lock, damaged data.csv, …), TC_E_MEMORY; the file is then as it was, nothing stays
 * beside it, and what was added goes with the next save. O(rows log rows). */
tc_status tc_cinema_save(tc_cinema *cinema, tc_error *err);

#endif
