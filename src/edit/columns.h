/* columns.h: a histogram as columns over the range of a document. */
#ifndef TC_EDIT_COLUMNS_H
#define TC_EDIT_COLUMNS_H

#include "edit/document.h"

/* Weights of n columns even over the places 0 to 1 of the document, by its range and logarithm: values are taken to lie
 * evenly within a bin, of which a column has the share that it cuts. Gives the largest; 0, and all are 0, when nothing
 * is there or memory is out. Cost: O(bins + n). */
double tc_columns_count(double *out, size_t n, const tc_histogram *histogram, const tc_document *document);
/* A height (0 to 1) of a column's weight; log: by the logarithm of 1 + its count, whatever the weights are. */
double tc_columns_height(const tc_histogram *histogram, double weight, double most, bool log);

#endif
