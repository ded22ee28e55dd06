/* colors.h: a document's colours as the library interpolates them, kept until they change. */
#ifndef TC_EDIT_COLORS_H
#define TC_EDIT_COLORS_H

#include "edit/document.h"

typedef struct tc_edit_colors tc_edit_colors;

/* With nothing in it; NULL: memory is out. */
tc_edit_colors *tc_edit_colors_create(void);
void tc_edit_colors_destroy(tc_edit_colors **colors);
/* The document's colour at a place, as tc_document_color; colors may be NULL, when memory is out. Cost: all of the
 * document's colours are compared with those that are kept; where they differ, a function is made of them. */
void tc_edit_colors_at(double rgb[3], tc_edit_colors *colors, const tc_document *document, double x);

#endif
