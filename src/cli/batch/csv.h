/* csv.h: comma-separated values as RFC 4180 has them, read and written without regard to the locale. */
#ifndef TC_CLI_BATCH_CSV_H
#define TC_CLI_BATCH_CSV_H

#include <stdbool.h>
#include <stddef.h>

/* One value of a row that was read. */
typedef struct tc_csv_cell {
    const char *text; /* without its quotes; ends with a zero byte */
    bool quoted;      /* tells an empty text ("") from a missing value */
} tc_csv_cell;

/* Reads rows off a text in memory, which it changes: cells point into it. */
typedef struct tc_csv_reader {
    char *at, *end;
    long line; /* of the next row, from 1 */
} tc_csv_reader;

/* The text has `bytes` bytes; a byte-order mark before the first row is skipped. The text is the caller's. */
void tc_csv_begin(tc_csv_reader *reader, char *text, size_t bytes);

/* The next row: *n values, the first `capacity` of them in cell[]. Lines end with LF or CRLF, the last one, too: a row
 * without an end was cut. 1: a row; 0: no more; -1: the text is damaged, and *why says how (static). O(row). */
int tc_csv_next(tc_csv_reader *reader, tc_csv_cell *cell, size_t capacity, size_t *n, const char **why);

/* A text that grows. Zero-initialise; `failed` is set when memory runs out, and then stays. The caller frees data. */
typedef struct tc_csv_text {
    char *data;
    size_t n, capacity;
    bool failed;
} tc_csv_text;

void tc_csv_put(tc_csv_text *out, const char *bytes, size_t n);
/* One value, quoted where it has a comma, a quote, a line break or a blank at an end, or is empty. */
void tc_csv_put_value(tc_csv_text *out, const char *text);

/* A decimal number that reads as `value` again, with no more digits than were needed to write it where these were 15 or
 * less, and always with a decimal point ("30.0", "1.0e-05", "0.1");
 * "nan", "inf", "-inf". Zero has no sign. out: at least 32 bytes. */
void tc_csv_float(char *out, double value);

/* Is all of the text one decimal number ("nan" and "inf" in any capitals, too)? */
bool tc_csv_read_float(double *out, const char *text);
bool tc_csv_read_integer(long long *out, const char *text);

/* Would a reader that guesses types, in Python or JavaScript, take the text for a number (or for not-a-number)? */
bool tc_csv_like_number(const char *text);

bool tc_csv_is_utf8(const char *text);

#endif
